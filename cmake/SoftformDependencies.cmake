# Every outside library that softform links, found once, here.
# Used by the build and, installed, by find_package(softform).
include(CMakeFindDependencyMacro)
find_dependency(Eigen3 3.4)
find_dependency(OpenMP)
find_dependency(fmt)
find_dependency(nlohmann_json)
find_dependency(CHOLMOD)
find_dependency(OpenSSL)
find_dependency(nanoflann)
find_dependency(CGAL 5.5)
find_dependency(VTK 9.1 COMPONENTS CommonCore CommonDataModel IOXML)

# Every outside library that softform links, found once, here.
# Used by the build and, installed, by find_package(softform).
include(CMakeFindDependencyMacro)
find_dependency(Eigen3 3.4)
find_dependency(OpenMP)
find_dependency(fmt)
find_dependency(nlohmann_json)
find_dependency(CLI11)
find_dependency(CHOLMOD)
find_dependency(OpenSSL)
find_dependency(nanoflann)
find_dependency(TBB)
find_dependency(Ceres)
find_dependency(NLopt)
find_dependency(CGAL 5.5)
find_dependency(VTK 9.1 COMPONENTS CommonCore CommonDataModel IOXML)
if(SOFTFORM_APPS)
  # For softform-render alone; in this scope, because VTK's imported targets are seen only where they were found.
  find_dependency(VTK 9.1 COMPONENTS CommonColor CommonCore CommonDataModel FiltersCore FiltersSources ImagingCore IOImage IOXML
    RenderingCore RenderingFreeType RenderingOpenGL2)
  set(SOFTFORM_RENDER_LIBRARIES ${VTK_LIBRARIES})
endif()

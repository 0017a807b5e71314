# lib3mf 1.8, which writes 3MF files for 3D printers: target 3MF::3MF.
find_path(3MF_INCLUDE_DIR Model/COM/NMR_DLLInterfaces.h PATH_SUFFIXES lib3mf)
find_library(3MF_LIBRARY 3MF)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(3MF REQUIRED_VARS 3MF_LIBRARY 3MF_INCLUDE_DIR)

if(3MF_FOUND AND NOT TARGET 3MF::3MF)
  add_library(3MF::3MF UNKNOWN IMPORTED)
  set_target_properties(3MF::3MF PROPERTIES
    IMPORTED_LOCATION ${3MF_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES ${3MF_INCLUDE_DIR})
endif()
mark_as_advanced(3MF_INCLUDE_DIR 3MF_LIBRARY)

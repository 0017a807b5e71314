# cmake --install, and an exported target for find_package(softform).
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/softform)

install(TARGETS softform EXPORT softformTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY src/softform DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.hpp")
install(EXPORT softformTargets NAMESPACE softform:: DESTINATION ${package_dir})

configure_package_config_file(cmake/softformConfig.cmake.in ${CMAKE_BINARY_DIR}/softformConfig.cmake
  INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${CMAKE_BINARY_DIR}/softformConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES
  ${CMAKE_BINARY_DIR}/softformConfig.cmake
  ${CMAKE_BINARY_DIR}/softformConfigVersion.cmake
  cmake/SoftformDependencies.cmake
  cmake/Find3MF.cmake
  cmake/FindCHOLMOD.cmake
  cmake/FindIPOPT.cmake
  cmake/FindMUMPS.cmake
  DESTINATION ${package_dir})

# Programs for users; the experiments belong to the checkout.
foreach(program softform_cli softform-datasets softform-render)
  if(TARGET ${program})
    install(TARGETS ${program} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  endif()
endforeach()

install(DIRECTORY datasets/ DESTINATION ${CMAKE_INSTALL_DATADIR}/softform OPTIONAL)
install(FILES LICENSE README.md DESTINATION ${CMAKE_INSTALL_DOCDIR})

include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

install(TARGETS strongpoint_methods strongpoint_problems EXPORT strongpoint-targets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY methods problems DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/strongpoint
        FILES_MATCHING PATTERN "*.hpp")
install(EXPORT strongpoint-targets NAMESPACE strongpoint::
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/strongpoint)
configure_package_config_file(cmake/strongpoint-config.cmake.in
  ${CMAKE_CURRENT_BINARY_DIR}/strongpoint-config.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/strongpoint)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/strongpoint-config-version.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/strongpoint-config.cmake
              ${CMAKE_CURRENT_BINARY_DIR}/strongpoint-config-version.cmake
              cmake/FindUmfpack.cmake cmake/FindSpqr.cmake cmake/FindGmsh.cmake cmake/FindLapacke.cmake
              cmake/FindMetis.cmake cmake/FindMumps.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/strongpoint)

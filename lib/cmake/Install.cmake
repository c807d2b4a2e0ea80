include(CMakePackageConfigHelpers)

get_property(awmr_libraries GLOBAL PROPERTY AWMR_LIBRARIES)
install(TARGETS ${awmr_libraries} EXPORT awmr-targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
  FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(TARGETS awmr_cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(EXPORT awmr-targets NAMESPACE awmr:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/awmr)

configure_package_config_file(lib/cmake/awmr-config.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/awmr-config.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/awmr)
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/awmr-config-version.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/awmr-config.cmake
  ${CMAKE_CURRENT_BINARY_DIR}/awmr-config-version.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/awmr)

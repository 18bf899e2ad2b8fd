# calib_core for other people's C++: headers, static libraries and the CMake package `touchcal` with the component calib_core;
# all of it in the installation component `dev`, which is the Debian package touchcal-dev.
include(CMakePackageConfigHelpers)

# All that calib_core is made of. Where it is an interface of several libraries, these belong to it.
if(NOT CALIB_CORE_LIBRARIES)
  set(CALIB_CORE_LIBRARIES calib_core)
  get_target_property(type calib_core TYPE)
  if(type STREQUAL "INTERFACE_LIBRARY")
    get_target_property(layers calib_core INTERFACE_LINK_LIBRARIES)
    list(FILTER layers INCLUDE REGEX "^calib_")
    list(APPEND CALIB_CORE_LIBRARIES ${layers})
  endif()
endif()

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/touchcal)
install(TARGETS ${CALIB_CORE_LIBRARIES} EXPORT touchcal-targets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/calib_core DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/touchcal COMPONENT dev
  FILES_MATCHING PATTERN "*.hpp" PATTERN internal EXCLUDE)
install(EXPORT touchcal-targets NAMESPACE touchcal:: DESTINATION ${package_folder} COMPONENT dev)
configure_package_config_file(touchcal-config.cmake.in ${CMAKE_CURRENT_BINARY_DIR}/touchcal-config.cmake
  INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${CMAKE_CURRENT_BINARY_DIR}/touchcal-config-version.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/touchcal-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/touchcal-config-version.cmake
  DESTINATION ${package_folder} COMPONENT dev)

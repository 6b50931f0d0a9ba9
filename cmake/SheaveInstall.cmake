# Installs the command, and the library of SheaveLibrary.cmake for find_package(sheave) and for pkg-config.
include(CMakePackageConfigHelpers)

set(package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/sheave")
install(
  DIRECTORY "${SHEAVE_INCLUDE_DIR}/sheave"
  DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}"
  COMPONENT development
  FILES_MATCHING
  PATTERN "*.h")
install(
  TARGETS sheave_library
  EXPORT sheave-targets
  ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT development)
install(
  EXPORT sheave-targets
  NAMESPACE sheave::
  DESTINATION "${package_dir}"
  COMPONENT development)
configure_package_config_file(cmake/sheave-config.cmake.in "${CMAKE_CURRENT_BINARY_DIR}/sheave-config.cmake"
                              INSTALL_DESTINATION "${package_dir}")
write_basic_package_version_file("${CMAKE_CURRENT_BINARY_DIR}/sheave-config-version.cmake"
                                 COMPATIBILITY SameMinorVersion)
install(
  FILES "${CMAKE_CURRENT_BINARY_DIR}/sheave-config.cmake"
        "${CMAKE_CURRENT_BINARY_DIR}/sheave-config-version.cmake"
  DESTINATION "${package_dir}"
  COMPONENT development)
# The prefix as seen from the file itself, so that an installed tree can be moved.
string(REGEX REPLACE "[^/]+" ".." SHEAVE_PC_PREFIX "${CMAKE_INSTALL_LIBDIR}/pkgconfig")
configure_file(cmake/sheave.pc.in "${CMAKE_CURRENT_BINARY_DIR}/sheave.pc" @ONLY)
install(
  FILES "${CMAKE_CURRENT_BINARY_DIR}/sheave.pc"
  DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig"
  COMPONENT development)
if(TARGET sheave)
  install(TARGETS sheave RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}" COMPONENT command)
endif()

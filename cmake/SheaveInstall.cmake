# What a C++ program needs for find_package(sheave) and sheave::engine, sheave::cable, sheave::scenes, sheave::live, sheave::measure.
include(CMakePackageConfigHelpers)

set(package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/sheave")
set(installed)
foreach(folder IN ITEMS engine cable scenes live measure)
  if(TARGET sheave_${folder})
    list(APPEND installed sheave_${folder})
    install(
      DIRECTORY "${PROJECT_SOURCE_DIR}/${folder}"
      DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/sheave"
      COMPONENT development
      FILES_MATCHING
      PATTERN "*.h"
      PATTERN "third_party" EXCLUDE)
  endif()
endforeach()

if(installed)
  install(
    DIRECTORY "${PROJECT_SOURCE_DIR}/sheave"
    DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/sheave"
    COMPONENT development)
  install(
    TARGETS ${installed}
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
endif()
if(TARGET sheave)
  install(TARGETS sheave RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}" COMPONENT command)
endif()

# What a C++ program needs for find_package(sheave): sheave::sheave, which is all of it, or one of sheave::engine, sheave::cable,
# sheave::scenes, sheave::live, sheave::measure, sheave::statics.
include(CMakePackageConfigHelpers)

set(package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/sheave")
set(installed)
foreach(folder IN ITEMS engine cable scenes live measure statics)
  if(TARGET sheave_${folder})
    list(APPEND installed sheave_${folder})
  endif()
endforeach()

# What programs include; these headers are installed, with those that they include, and no others.
set(SHEAVE_PUBLIC_HEADERS
    sheave/sheave.h
    scenes/format.h
    scenes/generators.h
    scenes/observables.h
    scenes/validate.h
    live/session.h
    measure/error_estimate.h
    statics/equilibrium.h
    statics/modes.h
    measure/reference_run.h
    measure/run_error.h
    measure/timing.h)
set(waiting ${SHEAVE_PUBLIC_HEADERS})
set(public_headers)
while(waiting)
  list(POP_FRONT waiting header)
  if(header IN_LIST public_headers)
    continue()
  endif()
  # Solvers and integrators are nobody's business.
  if(header MATCHES "^engine/(solvers|integrators|dynamics)/|^cable/certificate/")
    message(FATAL_ERROR "${header} is internal, but a public header includes it")
  endif()
  list(APPEND public_headers "${header}")
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/${header}")
  file(STRINGS "${PROJECT_SOURCE_DIR}/${header}" lines REGEX "^#include \"")
  foreach(line IN LISTS lines)
    string(REGEX REPLACE "^#include \"([^\"]+)\".*" "\\1" included "${line}")
    list(APPEND waiting "${included}")
  endforeach()
endwhile()

if(installed)
  add_library(sheave_all INTERFACE)
  add_library(sheave::sheave ALIAS sheave_all)
  set_target_properties(sheave_all PROPERTIES EXPORT_NAME sheave)
  target_link_libraries(sheave_all INTERFACE ${installed})
  list(APPEND installed sheave_all)
  foreach(header IN LISTS public_headers)
    cmake_path(GET header PARENT_PATH folder)
    install(
      FILES "${PROJECT_SOURCE_DIR}/${header}"
      DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/sheave/${folder}"
      COMPONENT development)
  endforeach()
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
  # The prefix as seen from the file itself, so that an installed tree can be moved.
  string(REGEX REPLACE "[^/]+" ".." SHEAVE_PC_PREFIX "${CMAKE_INSTALL_LIBDIR}/pkgconfig")
  get_target_property(definitions sheave_engine INTERFACE_COMPILE_DEFINITIONS)
  set(SHEAVE_PC_DEFINITIONS "")
  foreach(definition IN LISTS definitions)
    if(definition)
      string(APPEND SHEAVE_PC_DEFINITIONS " -D${definition}")
    endif()
  endforeach()
  get_property(SHEAVE_PC_LIBRARIES GLOBAL PROPERTY SHEAVE_PC_LIBRARIES)
  configure_file(cmake/sheave.pc.in "${CMAKE_CURRENT_BINARY_DIR}/sheave.pc" @ONLY)
  install(
    FILES "${CMAKE_CURRENT_BINARY_DIR}/sheave.pc"
    DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig"
    COMPONENT development)
endif()
if(TARGET sheave)
  install(TARGETS sheave RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}" COMPONENT command)
endif()

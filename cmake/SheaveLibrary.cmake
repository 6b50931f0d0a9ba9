# The library for programs of others: the target sheave::sheave, in a build and when installed. It is one archive, libsheave.a,
# with the headers in include/sheave, which programs include as <sheave/...>.

# The folders whose sources are in it, by their dependencies. No other place lists them.
set(SHEAVE_LIBRARY_FOLDERS engine cable statics scenes live measure)
# Headers for programs. These are public, with those that they include, and no others.
set(SHEAVE_PUBLIC_HEADERS
    sheave/sheave.h
    scenes/control/scene_supervisor.h
    scenes/format.h
    scenes/generators.h
    scenes/observables.h
    scenes/quantity_list.h
    scenes/validate.h
    live/session.h
    measure/error_estimate.h
    statics/equilibrium.h
    statics/joint_space.h
    statics/modes.h
    statics/place_joints.h
    statics/start_at_rest.h
    measure/reference_run.h
    measure/run_error.h
    measure/timing.h)

set(objects)
foreach(folder IN LISTS SHEAVE_LIBRARY_FOLDERS)
  if(NOT TARGET sheave_${folder})
    message(FATAL_ERROR "${folder}: no target sheave_${folder}")
  endif()
  # CMake counts precompiled headers as objects.
  list(APPEND objects "$<FILTER:$<TARGET_OBJECTS:sheave_${folder}>,EXCLUDE,[.][gp]ch$>")
endforeach()

# Sources include headers by their path from the root of the repository, programs by the same path below sheave/. The copies for
# programs are made when CMake runs, and CMake runs again when a header changes.
set(SHEAVE_INCLUDE_DIR "${PROJECT_BINARY_DIR}/include")
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
  string(REGEX REPLACE "^sheave/" "" place "${header}")
  set(place "${SHEAVE_INCLUDE_DIR}/sheave/${place}")
  file(READ "${PROJECT_SOURCE_DIR}/${header}" text)
  string(REGEX REPLACE "(^|\n)#include \"(sheave/)?([^\"]+)\"" "\\1#include <sheave/\\3>" text "${text}")
  set(old "")
  if(EXISTS "${place}")
    file(READ "${place}" old)
  endif()
  # Whoever includes a header that stays the same is not compiled again.
  if(NOT text STREQUAL old)
    file(WRITE "${place}" "${text}")
  endif()
endwhile()
# A header that is public no longer.
file(GLOB_RECURSE made RELATIVE "${SHEAVE_INCLUDE_DIR}/sheave" "${SHEAVE_INCLUDE_DIR}/sheave/*.h")
foreach(header IN LISTS made)
  if(NOT header IN_LIST public_headers AND NOT "sheave/${header}" IN_LIST public_headers)
    file(REMOVE "${SHEAVE_INCLUDE_DIR}/sheave/${header}")
  endif()
endforeach()

# Whether the archive can be closed against the program's copies of inline functions (CloseObjects.cmake). Sanitizers and counters
# of coverage register their objects at the linker, and are for our own tests.
set(SHEAVE_CLOSED OFF)
if(CMAKE_NM AND CMAKE_OBJCOPY AND NOT (SHEAVE_SANITIZE OR SHEAVE_FUZZ OR SHEAVE_COVERAGE))
  execute_process(COMMAND "${CMAKE_LINKER}" --help OUTPUT_VARIABLE help ERROR_QUIET)
  if(CMAKE_EXECUTABLE_FORMAT STREQUAL "ELF" AND help MATCHES "--force-group-allocation")
    set(SHEAVE_CLOSED ON)
  endif()
endif()

if(SHEAVE_CLOSED)
  set(closed "${PROJECT_BINARY_DIR}/closed/sheave.o")
  file(MAKE_DIRECTORY "${PROJECT_BINARY_DIR}/closed")
  add_custom_command(
    OUTPUT "${closed}"
    COMMAND "${CMAKE_COMMAND}" "-DLINKER=${CMAKE_LINKER}" "-DNM=${CMAKE_NM}" "-DOBJCOPY=${CMAKE_OBJCOPY}"
            "-DSTRIP=$<CONFIG:Release,MinSizeRel>" "-DOUTPUT=${closed}"
            -P "${PROJECT_SOURCE_DIR}/cmake/CloseObjects.cmake" -- "${objects}"
    DEPENDS "${objects}" "${PROJECT_SOURCE_DIR}/cmake/CloseObjects.cmake"
    COMMENT "Closing libsheave"
    COMMAND_EXPAND_LISTS VERBATIM)
  set_source_files_properties("${closed}" PROPERTIES EXTERNAL_OBJECT ON GENERATED ON)
  set(objects "${closed}")
endif()
# The target sheave is the command.
add_library(sheave_library STATIC ${objects})
add_library(sheave::sheave ALIAS sheave_library)
set_target_properties(sheave_library PROPERTIES EXPORT_NAME sheave OUTPUT_NAME sheave LINKER_LANGUAGE CXX)
target_compile_features(sheave_library INTERFACE cxx_std_20)
target_include_directories(sheave_library INTERFACE $<BUILD_INTERFACE:${SHEAVE_INCLUDE_DIR}>
                                                    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(nlohmann_json 3.11 REQUIRED)
find_package(fmt REQUIRED)
get_property(links GLOBAL PROPERTY SHEAVE_LIBRARY_LINKS)
get_property(SHEAVE_PC_LIBRARIES GLOBAL PROPERTY SHEAVE_PC_LIBRARIES)
target_link_libraries(sheave_library INTERFACE Eigen3::Eigen nlohmann_json::nlohmann_json fmt::fmt ${links})
set(SHEAVE_PC_FLAGS "")
if(NOT SHEAVE_CLOSED)
  # The program's copies of inline functions may replace ours, so they must be compiled as ours are.
  get_target_property(definitions sheave_engine INTERFACE_COMPILE_DEFINITIONS)
  target_compile_options(sheave_library INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-ffp-contract=off>)
  set(SHEAVE_PC_FLAGS " -ffp-contract=off")
  if(definitions)
    target_compile_definitions(sheave_library INTERFACE ${definitions})
    list(TRANSFORM definitions PREPEND " -D")
    string(APPEND SHEAVE_PC_FLAGS ${definitions})
  endif()
endif()

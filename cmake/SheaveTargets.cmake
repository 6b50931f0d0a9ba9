# The house rules for targets: flags, include root, precompiled headers, one library per folder.

set(SHEAVE_WARNINGS
    -Wall
    -Wextra
    -Wpedantic
    -Wshadow
    -Wconversion
    -Wnon-virtual-dtor
    -Woverloaded-virtual
    -Wcast-qual
    -Wimplicit-fallthrough)
if(SHEAVE_WARNINGS_AS_ERRORS)
  list(APPEND SHEAVE_WARNINGS -Werror)
endif()
# The same meaning of -Wconversion in both compilers.
list(APPEND SHEAVE_WARNINGS -Wno-sign-conversion)
if(SHEAVE_UNITY AND CMAKE_CXX_COMPILER_ID MATCHES "Clang")
  # Of sources that are compiled together clang warns of every local name that another one has, too; GCC's builds keep the warning.
  list(REMOVE_ITEM SHEAVE_WARNINGS -Wshadow)
endif()
if(SHEAVE_SANITIZE AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # Instrumented code confuses GCC's data-flow warnings into false alarms inside Eigen; the plain builds keep them.
  list(APPEND SHEAVE_WARNINGS -Wno-maybe-uninitialized -Wno-array-bounds -Wno-stringop-overflow -Wno-null-dereference)
endif()

set(SHEAVE_PCH_HEADERS
    <Eigen/Core>
    <Eigen/Geometry>
    <algorithm>
    <array>
    <cmath>
    <cstddef>
    <cstdint>
    <functional>
    <limits>
    <map>
    <memory>
    <optional>
    <span>
    <string>
    <string_view>
    <unordered_map>
    <utility>
    <variant>
    <vector>)

# Static libraries may end in a module of Python; WebAssembly has none, and pays for it.
set(SHEAVE_PIC ON)
if(SHEAVE_WEB)
  set(SHEAVE_PIC OFF)
endif()

function(sheave_target_flags target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_compile_options(${target} PRIVATE $<$<COMPILE_LANGUAGE:CXX>:${SHEAVE_WARNINGS}>)
endfunction()

# sheave_cold(<target> <folder>)
# Code outside of the steps of simulations takes most of a build's time: at -O1 and without line tables a quarter less.
function(sheave_cold target folder)
  if(folder IN_LIST SHEAVE_SANITIZE_UNOPTIMISED)
    target_compile_options(${target} PRIVATE -O0)
  elseif(NOT SHEAVE_WEB)
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1> $<$<CONFIG:Release>:-g0>)
  endif()
endfunction()

# sheave_json_headers(<target> <folder>)
# One precompiled header for the cold targets that read and write JSON. It serves one degree of optimisation, that of the scenes.
function(sheave_json_headers target folder)
  if(NOT SHEAVE_PCH)
    return()
  endif()
  if(NOT TARGET sheave_json_header)
    set(stub "${PROJECT_BINARY_DIR}/json_header_stub.cpp")
    file(GENERATE OUTPUT "${stub}" CONTENT "// Keeps the library non-empty.\n")
    add_library(sheave_json_header OBJECT "${stub}")
    set_target_properties(sheave_json_header PROPERTIES POSITION_INDEPENDENT_CODE ${SHEAVE_PIC})
    sheave_target_flags(sheave_json_header)
    sheave_cold(sheave_json_header scenes)
    target_link_libraries(sheave_json_header PRIVATE sheave::engine nlohmann_json::nlohmann_json fmt::fmt)
    target_precompile_headers(sheave_json_header PRIVATE ${SHEAVE_PCH_HEADERS} <nlohmann/json.hpp> <fmt/format.h>)
  endif()
  foreach(name IN ITEMS scenes ${folder})
    list(FIND SHEAVE_SANITIZE_UNOPTIMISED ${name} place_${name})
  endforeach()
  if((place_scenes EQUAL -1) EQUAL (place_${folder} EQUAL -1))
    set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ${SHEAVE_PIC})
    target_precompile_headers(${target} REUSE_FROM sheave_json_header)
  endif()
endfunction()

# sheave_library(<folder> LINKS <targets...> [LINKS_PRIVATE <targets...>]
#                [COLD] [PCH_FROM <target>] [GENERATED <sources...>])
# makes the static library sheave_<folder>, alias sheave::<folder>, of all sources below the folder. COLD: no step of a simulation runs
# through it (sheave_cold). It is for our own targets; programs of others link sheave::sheave (SheaveLibrary.cmake).
# A folder without sources yet makes no target.
function(sheave_library folder)
  cmake_parse_arguments(arg "COLD" "PCH_FROM" "LINKS;LINKS_PRIVATE;GENERATED" ${ARGN})
  set(dir "${PROJECT_SOURCE_DIR}/${folder}")
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS "${dir}/*.cpp" "${dir}/*.h")
  list(FILTER sources EXCLUDE REGEX "/third_party/")
  set(units ${sources})
  list(FILTER units INCLUDE REGEX "\\.cpp$")
  if(NOT units)
    message(STATUS "${folder}: no sources yet, target skipped")
    return()
  endif()
  set(target sheave_${folder})
  add_library(${target} STATIC ${sources} ${arg_GENERATED})
  add_library(sheave::${folder} ALIAS ${target})
  set_target_properties(${target} PROPERTIES POSITION_INDEPENDENT_CODE ${SHEAVE_PIC})
  # In larger units the compiler inlines less: a step took 3 % more instructions. Sanitized libraries need not be fast.
  if(folder MATCHES "^(engine|cable)$" AND NOT SHEAVE_SANITIZE)
    set_target_properties(${target} PROPERTIES UNITY_BUILD_BATCH_SIZE 8)
    # GCC inlines until a unit has grown by 40 %. Which functions that leaves out depends on the sources that a unit has by chance.
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
      target_compile_options(${target} PRIVATE "SHELL:--param inline-unit-growth=200")
    endif()
  endif()
  sheave_target_flags(${target})
  # Objects of a project that asks for optimisation at the link could not be closed (SheaveLibrary.cmake).
  set_target_properties(${target} PROPERTIES INTERPROCEDURAL_OPTIMIZATION OFF)
  target_include_directories(${target} PUBLIC "${PROJECT_SOURCE_DIR}")
  target_include_directories(${target} PRIVATE "${SHEAVE_GENERATED_DIR}")
  foreach(link IN LISTS arg_LINKS)
    if(TARGET ${link})
      target_link_libraries(${target} PUBLIC ${link})
    endif()
  endforeach()
  if(arg_LINKS_PRIVATE)
    target_link_libraries(${target} PRIVATE ${arg_LINKS_PRIVATE})
  endif()
  # Loops over flat arrays (engine/math/packs.h): -O2 makes packs of next to none of them.
  set(kernels ${units})
  list(FILTER kernels INCLUDE REGEX "_kernels\\.cpp$")
  set_source_files_properties(
    ${kernels} PROPERTIES COMPILE_OPTIONS "$<$<CONFIG:Release>:-O3>" SKIP_PRECOMPILE_HEADERS ON
                          SKIP_UNITY_BUILD_INCLUSION ON)
  if(arg_COLD)
    sheave_cold(${target} ${folder})
    sheave_json_headers(${target} ${folder})
    return()
  endif()
  if(folder IN_LIST SHEAVE_SANITIZE_UNOPTIMISED)
    target_compile_options(${target} PRIVATE -O0)
    # A precompiled header serves one degree of optimisation.
    set(arg_PCH_FROM "")
  endif()
  if(SHEAVE_PCH AND TARGET "${arg_PCH_FROM}")
    target_precompile_headers(${target} REUSE_FROM ${arg_PCH_FROM})
  elseif(SHEAVE_PCH)
    target_precompile_headers(${target} PRIVATE ${SHEAVE_PCH_HEADERS})
  endif()
endfunction()

# Links those of the targets that exist, so that a folder without sources yet breaks nothing.
function(sheave_link_available target)
  foreach(link IN LISTS ARGN)
    if(TARGET ${link})
      target_link_libraries(${target} PRIVATE ${link})
    endif()
  endforeach()
endfunction()

# Flags, include root and sanitizer defaults of an executable.
function(sheave_executable_settings target)
  sheave_target_flags(${target})
  target_include_directories(${target} PRIVATE "${PROJECT_SOURCE_DIR}" "${SHEAVE_GENERATED_DIR}")
  if(SHEAVE_SANITIZE)
    target_sources(${target} PRIVATE "${PROJECT_SOURCE_DIR}/cmake/sanitizer_defaults.cpp")
    set_source_files_properties(
      "${PROJECT_SOURCE_DIR}/cmake/sanitizer_defaults.cpp" TARGET_DIRECTORY ${target}
      PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
  endif()
endfunction()

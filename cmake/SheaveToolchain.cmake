# Speeds up building; nothing here changes what is built.

find_program(SHEAVE_CCACHE ccache)
if(SHEAVE_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  # Without this sloppiness ccache never reuses a result that depends on a precompiled header.
  set(CMAKE_CXX_COMPILER_LAUNCHER
      "${CMAKE_COMMAND}" -E env CCACHE_SLOPPINESS=pch_defines,time_macros "${SHEAVE_CCACHE}")
  set(CMAKE_C_COMPILER_LAUNCHER "${SHEAVE_CCACHE}")
endif()

# Most of a build's time goes into the same headers and templates again and again, so many sources of a folder are compiled at a
# time. Names in unnamed namespaces must therefore differ within a folder. Batches of 8 take a third more time in all; a
# developer who changes one source often may prefer them.
if(SHEAVE_UNITY)
  set(CMAKE_UNITY_BUILD ON)
  set(SHEAVE_UNITY_BATCH 24 CACHE STRING "How many sources of a folder are compiled at a time")
  set(CMAKE_UNITY_BUILD_BATCH_SIZE ${SHEAVE_UNITY_BATCH})
endif()

# GCC collects its garbage again and again, a tenth to a fifth of the time, although a unit needs less than 2 GB in all.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  add_compile_options("$<$<COMPILE_LANGUAGE:CXX>:SHELL:--param ggc-min-expand=1000 --param ggc-min-heapsize=2000000>")
endif()

# emscripten brings its own linker.
if(SHEAVE_WEB)
  return()
endif()

include(CheckLinkerFlag)
find_program(SHEAVE_MOLD mold)
find_program(SHEAVE_LLD ld.lld)
foreach(linker IN ITEMS mold lld)
  string(TOUPPER ${linker} upper)
  if(SHEAVE_${upper})
    check_linker_flag(CXX "-fuse-ld=${linker}" SHEAVE_LINKS_WITH_${upper})
    if(SHEAVE_LINKS_WITH_${upper})
      add_link_options("-fuse-ld=${linker}")
      break()
    endif()
  endif()
endforeach()

if(SHEAVE_SANITIZE)
  # Set for the whole tree, third-party C included: a mixture of instrumented and plain objects misses errors.
  add_compile_options(-fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer)
  # Checks that a preset leaves out.
  if(SHEAVE_SANITIZE_NOT)
    add_compile_options(-fno-sanitize=${SHEAVE_SANITIZE_NOT})
  endif()
  add_link_options(-fsanitize=address,undefined)
endif()
if(SHEAVE_FUZZ)
  # Tells the fuzzer which branches an input takes and, in campaigns, what is compared; its own main program comes with the link.
  add_compile_options(${SHEAVE_FUZZ_FLAGS})
endif()
if(SHEAVE_COVERAGE)
  add_compile_options(-fprofile-instr-generate -fcoverage-mapping)
  add_link_options(-fprofile-instr-generate)
endif()

# cmake -DLINKER=<ld> -DNM=<nm> -DOBJCOPY=<objcopy> -DSTRIP=<bool> -DOUTPUT=<object> -P CloseObjects.cmake -- <object>...
# joins objects to one whose inline functions and templates nobody else can replace.
#
# A linker keeps one copy of an inline function or of a template's instance, for the whole program, and takes the first that it
# finds. A program that is compiled for AVX, or with fused multiply-adds, would put its copies of Eigen's functions into our
# solver, and results would depend on who links. Here every copy of ours becomes local to the object. Tables of virtual functions
# and type information stay global, because programs derive from our classes and refer to them, but the copy of the library is the
# one that counts.
foreach(variable IN ITEMS LINKER NM OBJCOPY STRIP OUTPUT)
  if(NOT DEFINED ${variable})
    message(FATAL_ERROR "CloseObjects.cmake needs -D${variable}=...")
  endif()
endforeach()

set(objects)
set(listed FALSE)
math(EXPR last "${CMAKE_ARGC} - 1")
foreach(i RANGE ${last})
  if(listed)
    list(APPEND objects "${CMAKE_ARGV${i}}")
  elseif(CMAKE_ARGV${i} STREQUAL "--")
    set(listed TRUE)
  endif()
endforeach()

function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# Groups of sections, which the linker would drop for a program's group of the same name, become plain sections.
set(options -r --force-group-allocation)
if(STRIP)
  list(APPEND options --strip-debug)
endif()
run("${LINKER}" ${options} -o "${OUTPUT}.joined" ${objects})

execute_process(COMMAND "${NM}" --defined-only --format=posix "${OUTPUT}.joined" OUTPUT_VARIABLE symbols
                COMMAND_ERROR_IS_FATAL ANY)
# W, V and u are the kinds of symbols of which a linker keeps one copy.
string(REGEX MATCHALL "[^\n ]+ [WVu] " shared "${symbols}")
list(TRANSFORM shared REPLACE " .*" "")
set(classes ${shared})
list(FILTER classes INCLUDE REGEX "^_ZT[VITS]N?K?6sheave")
list(JOIN shared "\n" text)
file(WRITE "${OUTPUT}.shared" "${text}\n")
list(JOIN classes "\n" text)
file(WRITE "${OUTPUT}.classes" "${text}\n")
# Unique symbols (u) can be made weak, and only weak ones can be made local.
run("${OBJCOPY}" "--weaken-symbols=${OUTPUT}.shared" "${OUTPUT}.joined")
run("${OBJCOPY}" "--localize-symbols=${OUTPUT}.shared" "${OUTPUT}.joined")
run("${OBJCOPY}" "--globalize-symbols=${OUTPUT}.classes" "${OUTPUT}.joined")
file(RENAME "${OUTPUT}.joined" "${OUTPUT}")

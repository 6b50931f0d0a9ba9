# cmake -DINPUT=<file> -DOUTPUT=<source.cpp> -DNAME=<identifier> -P EmbedFile.cmake
# turns a file into a C++ array. String literals, because compilers read them far faster than lists of numbers.
foreach(variable IN ITEMS INPUT OUTPUT NAME)
  if(NOT DEFINED ${variable})
    message(FATAL_ERROR "EmbedFile.cmake needs -D${variable}=...")
  endif()
endforeach()

file(READ "${INPUT}" bytes HEX)
file(SIZE "${INPUT}" size)
if(size EQUAL 0)
  message(FATAL_ERROR "${INPUT} is empty")
endif()
get_filename_component(name "${INPUT}" NAME)
string(REPEAT "[0-9a-f]" 64 line)
string(REGEX REPLACE "(${line})" "\\1\n" bytes "${bytes}")
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "\\\\x\\1" bytes "${bytes}")
string(REGEX REPLACE "([^\n]+)" "    \"\\1\"" bytes "${bytes}")

file(
  WRITE "${OUTPUT}.part"
  "// Generated from ${name}.
#include \"${NAME}.h\"

namespace sheave {
namespace {
const unsigned char bytes[] =
${bytes};
}  // namespace

extern const unsigned char* const ${NAME} = bytes;
extern const std::size_t ${NAME}_size = ${size};
}  // namespace sheave
")
file(RENAME "${OUTPUT}.part" "${OUTPUT}")

# sheave_header_package(<package> <folder> <header> <target> [<definition>])
# is the body of a find module for a build for another machine. The system's package is made for the machine that builds, but the
# headers alone are enough. /usr/include itself must not be searched, because it has the C library of that machine. The target
# therefore gets a folder with a link to the headers of the package.
include(FindPackageHandleStandardArgs)

macro(sheave_header_package package folder header target)
  find_path(SHEAVE_${package}_HEADERS "${folder}/${header}" PATHS /usr/include /usr/local/include NO_CMAKE_FIND_ROOT_PATH)
  find_package_handle_standard_args(${package} REQUIRED_VARS SHEAVE_${package}_HEADERS)
  if(${package}_FOUND AND NOT TARGET ${target})
    file(MAKE_DIRECTORY "${CMAKE_BINARY_DIR}/headers")
    file(CREATE_LINK "${SHEAVE_${package}_HEADERS}/${folder}" "${CMAKE_BINARY_DIR}/headers/${folder}" SYMBOLIC)
    add_library(${target} INTERFACE IMPORTED GLOBAL)
    set_target_properties(${target} PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${CMAKE_BINARY_DIR}/headers"
                                               INTERFACE_COMPILE_DEFINITIONS "${ARGN}")
  endif()
endmacro()

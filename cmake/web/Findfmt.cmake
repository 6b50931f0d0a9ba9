# The system's package is a library for the machine that builds; its headers alone are enough.
# /usr/include itself must not be searched: it has the machine's own C library.
find_path(FMT_HEADERS fmt/format.h PATHS /usr/include /usr/local/include NO_CMAKE_FIND_ROOT_PATH)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(fmt REQUIRED_VARS FMT_HEADERS)
if(fmt_FOUND AND NOT TARGET fmt::fmt)
  file(MAKE_DIRECTORY "${CMAKE_BINARY_DIR}/headers")
  file(CREATE_LINK "${FMT_HEADERS}/fmt" "${CMAKE_BINARY_DIR}/headers/fmt" SYMBOLIC)
  add_library(fmt::fmt INTERFACE IMPORTED GLOBAL)
  set_target_properties(
    fmt::fmt PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${CMAKE_BINARY_DIR}/headers"
                        INTERFACE_COMPILE_DEFINITIONS FMT_HEADER_ONLY)
endif()

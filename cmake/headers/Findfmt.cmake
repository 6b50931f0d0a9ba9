include("${CMAKE_CURRENT_LIST_DIR}/SheaveHeaderPackage.cmake")
sheave_header_package(fmt fmt format.h fmt::fmt FMT_HEADER_ONLY)

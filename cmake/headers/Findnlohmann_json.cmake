include("${CMAKE_CURRENT_LIST_DIR}/SheaveHeaderPackage.cmake")
sheave_header_package(nlohmann_json nlohmann json.hpp nlohmann_json::nlohmann_json)

# Untested. Use as an overlay port inside of a checkout: vcpkg install sheave --overlay-ports=packaging/vcpkg
set(SOURCE_PATH "${CURRENT_PORT_DIR}/../..")
vcpkg_cmake_configure(
  SOURCE_PATH "${SOURCE_PATH}"
  OPTIONS -DSHEAVE_RENDER=OFF -DSHEAVE_TESTS=OFF -DSHEAVE_BENCH=OFF -DSHEAVE_PYTHON=OFF -DSHEAVE_WARNINGS_AS_ERRORS=OFF)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(CONFIG_PATH lib/cmake/sheave)
vcpkg_fixup_pkgconfig()
vcpkg_copy_tools(TOOL_NAMES sheave AUTO_CLEAN)
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug/include")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE")

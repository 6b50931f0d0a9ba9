"""Untested recipe for Conan 2: conan create packaging/conan, inside of a checkout."""

import os

from conan import ConanFile
from conan.tools.build import check_min_cppstd
from conan.tools.cmake import CMake, CMakeToolchain, CMakeDeps, cmake_layout
from conan.tools.files import copy


class SheaveConan(ConanFile):
    name = "sheave"
    version = "0.2.0"
    license = "MIT"
    description = "Rigid bodies and cable joints"
    package_type = "static-library"
    settings = "os", "arch", "compiler", "build_type"
    requires = "eigen/3.4.0", "fmt/9.1.0", "nlohmann_json/3.11.2", "cli11/2.3.2"

    def export_sources(self):
        root = os.path.join(self.recipe_folder, "..", "..")
        for pattern in ("CMakeLists.txt", "LICENSE", "cmake/*", "engine/*", "cable/*", "sheave/*",
                        "scenes/*", "live/*", "measure/*", "statics/*", "command/*"):
            copy(self, pattern, root, self.export_sources_folder)

    def layout(self):
        cmake_layout(self)

    def validate(self):
        check_min_cppstd(self, 20)

    def generate(self):
        CMakeDeps(self).generate()
        toolchain = CMakeToolchain(self)
        for part in ("RENDER", "TESTS", "BENCH", "PYTHON", "WARNINGS_AS_ERRORS"):
            toolchain.cache_variables[f"SHEAVE_{part}"] = False
        toolchain.generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        CMake(self).install()
        copy(self, "LICENSE", self.source_folder, os.path.join(self.package_folder, "licenses"))

    def package_info(self):
        self.cpp_info.libs = ["sheave"]

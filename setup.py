"""Builds the Python package: CMake makes the compiled half.

    venv/bin/pip install --no-build-isolation .      docs/how-to/python.md tells how to make the environment

With SHEAVE_MODULE, a compiled half that is there already, nothing is compiled.
"""

import os
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = Path(__file__).resolve().parent


class CMakeBuild(build_ext):
    """Lets CMake build what is compiled, and puts it where setuptools looks for it."""

    def build_extension(self, ext):
        target = Path(self.get_ext_fullpath(ext.name)).resolve()
        target.parent.mkdir(parents=True, exist_ok=True)
        made = os.environ.get("SHEAVE_MODULE") or self.compiled()
        self.copy_file(str(made), str(target))

    def compiled(self):
        build = Path(os.environ.get("SHEAVE_BUILD_DIR", ROOT / "build" / "python-package"))
        options = [f"-DPython_EXECUTABLE={sys.executable}", "-DCMAKE_BUILD_TYPE=Release",
                   "-DSHEAVE_PYTHON=ON", "-DSHEAVE_TESTS=OFF", "-DSHEAVE_BENCH=OFF",
                   "-DSHEAVE_WARNINGS_AS_ERRORS=OFF"]
        subprocess.run(["cmake", "-S", ROOT, "-B", build, "-G", "Ninja", *options], check=True)
        subprocess.run(["cmake", "--build", build, "--target", "sheave_python"], check=True)
        made = next((build / "python" / "sheave").glob("_sheave*.so"), None)
        if made is None:
            raise SystemExit("sheave: the module has not been built; are pybind11 and Python's "
                             "headers there? tools/install-dependencies installs them")
        return made


setup(ext_modules=[Extension("sheave._sheave", sources=[])], cmdclass={"build_ext": CMakeBuild})

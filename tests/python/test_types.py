"""Stubs that say what is there, and examples that keep to them."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import ROOT

import sheave

INI = ROOT / "examples/python/mypy.ini"


def run(*command):
    """Where the package is built, so that stubs and module are side by side."""
    folder = Path(sheave.__file__).absolute().parents[1]
    environment = dict(os.environ, MYPYPATH=str(folder))
    done = subprocess.run([sys.executable, "-m", *command], cwd=folder, env=environment,
                          capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_stubs_are_true():
    pytest.importorskip("mypy")
    # Of classes only their metaclass, which is pybind11's, is let pass.
    allowed = ROOT / "tests/python/stubtest-allowlist.txt"
    run("mypy.stubtest", "sheave._sheave", "--mypy-config-file", str(INI), "--allowlist",
        str(allowed))


def test_package_and_examples_are_typed():
    pytest.importorskip("mypy")
    run("mypy", "--config-file", str(INI), "-p", "sheave")
    run("mypy", "--config-file", str(INI), *map(str, sorted(INI.parent.glob("*.py"))))

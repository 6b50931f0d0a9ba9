"""What the tests share: where things are, and small scenes."""

import os
from pathlib import Path

import pytest

import sheave

ROOT = Path(__file__).resolve().parents[2]
SCENES = sorted(
    path.relative_to(ROOT).as_posix()
    for folder in ("analytic", "paper", "machines", "stress")
    for path in (ROOT / "scenes" / folder).glob("*.json")
)
INVALID = sorted(path.relative_to(ROOT).as_posix() for path in
                 (ROOT / "scenes" / "invalid").glob("*.json"))

ATWOOD = {
    "format": "sheave-scene/1", "gravity": [0, -10, 0], "duration": 1,
    "bodies": [
        {"name": "wheel", "mobility": "rotor", "mass": 1,
         "shape": {"type": "cylinder", "radius": 0.5, "length": 0.1}},
        {"name": "light", "mobility": "slider", "axis": [0, 1, 0], "mass": 1,
         "position": [-0.5, -2, 0]},
        {"name": "heavy", "mobility": "slider", "axis": [0, 1, 0], "mass": 2,
         "position": [0.5, -2, 0]}],
    "cables": [{"name": "cable", "links": [
        {"type": "attachment", "body": "light"},
        {"type": "rolling", "body": "wheel", "winding": "clockwise"},
        {"type": "attachment", "body": "heavy"}]}],
}


@pytest.fixture
def atwood():
    """Two weights over a wheel."""
    return sheave.load(ATWOOD)


@pytest.fixture
def root(monkeypatch):
    """The root of the repository, as the working folder."""
    monkeypatch.chdir(ROOT)
    return ROOT


@pytest.fixture
def command():
    """Path of the program `sheave`."""
    path = os.environ.get("SHEAVE_COMMAND", str(ROOT / "build/release/tools/sheave"))
    if not os.access(path, os.X_OK):
        pytest.skip("the command has not been built")
    return path

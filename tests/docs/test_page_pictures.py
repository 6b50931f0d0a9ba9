"""Pictures of pages are what the commands that stand above them make (dev/page-pictures)."""

import importlib.machinery
import importlib.util
import os
import pathlib
import shutil

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
LOADER = importlib.machinery.SourceFileLoader("page_pictures", str(ROOT / "dev/page-pictures"))
page_pictures = importlib.util.module_from_spec(importlib.util.spec_from_loader("page_pictures", LOADER))
LOADER.exec_module(page_pictures)

BLOCKS = page_pictures.blocks()
PNG = b"\x89PNG\r\n\x1a\n"


def test_there_are_pictures():
    assert {page.name for page, _, _ in BLOCKS} >= {"modes.md", "plots.md", "ropes.md", "statics.md", "sweeps.md"}


@pytest.mark.parametrize("page, commands, name", BLOCKS, ids=[name for _, _, name in BLOCKS])
def test_a_picture_is_there_and_in_its_page(page, commands, name):
    kept = ROOT / name
    assert kept.is_file() and kept.stat().st_size <= page_pictures.MOST_BYTES
    assert f"]({os.path.relpath(kept, page.parent)})" in page.read_text(encoding="utf-8")


@pytest.mark.parametrize("page, commands, name", BLOCKS, ids=[name for _, _, name in BLOCKS])
def test_its_commands_make_it(page, commands, name, tmp_path):
    if shutil.which("gnuplot") is None:
        pytest.skip("gnuplot is not installed")
    # Short runs of a sweep make a map as well as long ones.
    if "sheave sweep " in commands and " --of " not in commands:
        commands = commands.replace("sheave sweep ", "sheave sweep --duration 0.2 ")
    picture = page_pictures.draw(page, commands, name, tmp_path)
    assert picture.read_bytes().startswith(PNG)


def test_what_makes_no_picture_is_told(tmp_path):
    with pytest.raises(ValueError, match="has not been made"):
        page_pictures.draw(ROOT / "docs/how-to/plots.md", "true docs/pictures/a.png\n", "docs/pictures/a.png", tmp_path)

"""The programs of examples/python, and the listings of the documents."""

import importlib.util

import pytest
from conftest import ROOT

FOLDER = ROOT / "examples/python"
# What makes the slow ones short.
ARGUMENTS = {"crane_sweep": (6, 4), "learn_to_stop": (6, 48)}


@pytest.mark.parametrize("path", sorted(FOLDER.glob("*.py")), ids=lambda path: path.stem)
def test_an_example_runs(path, tmp_path, capsys):
    specification = importlib.util.spec_from_file_location(path.stem, path)
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    figure = tmp_path / "figure.png"
    module.main(str(figure), *ARGUMENTS.get(path.stem, ()))
    assert figure.stat().st_size > 5000
    assert capsys.readouterr().out

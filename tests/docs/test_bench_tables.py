"""Tables of bench/ have a date and a machine, and one command makes them again."""

import pathlib
import re
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
# README.md has no measurements of its own; IMPORT.md names models of others and its own command.
PAGES = sorted(path.name for path in (ROOT / "bench").glob("*.md") if path.name not in ("README.md", "IMPORT.md"))
DATE = re.compile(r"^Measured on \d{4}-\d\d-\d\d, sheave \d+\.\d+\.\d+, \S.*\.$", re.MULTILINE)


def test_one_command_makes_all_tables():
    listed = subprocess.run([ROOT / "bench/tables/all", "--list"], text=True, capture_output=True, check=True).stdout
    assert sorted(line.split()[0] for line in listed.splitlines()) == PAGES


@pytest.mark.parametrize("name", [*PAGES, "IMPORT.md"])
def test_a_table_has_its_date_and_machine(name):
    text = (ROOT / "bench" / name).read_text(encoding="utf-8")
    head = "\n".join(text.splitlines()[:14])
    if name == "IMPORT.md":
        assert re.search(r"^Measured on \d{4}-\d\d-\d\d, ", head, re.MULTILINE)
    else:
        assert DATE.search(head), head

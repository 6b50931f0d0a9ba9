"""The page of known faults says what the command says.

Each row of its tables ends with a command. A fault that the command tells of has its words in the third column, between
quotation marks: they are printed, in a summary that is `doubtful` or in a warning. A fault that is silent has a scene whose
checks hold the closed form: one of them fails. The options in the fourth column are a way round: with them the words are
not printed, and no check fails. So a fault that is mended and still listed fails here.
"""

import os
import pathlib
import re
import shlex
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
COMMAND = pathlib.Path(os.environ.get("SHEAVE_COMMAND", ROOT / "build/release/tools/sheave"))
PAGE = ROOT / "docs/reference/known-faults.md"
SCENES = ROOT / "tests/faults"


def rows():
    """[(when, words, way round, command)] of the page's tables."""
    found = []
    for line in PAGE.read_text(encoding="utf-8").splitlines():
        cells = [cell.strip() for cell in line.strip("|").split(" | ")] if line.startswith("| ") else []
        if len(cells) == 6 and cells[0] != "symptom":
            command = re.fullmatch(r"`sheave (.*)`", cells[5].rstrip(" |"))
            assert command, f"no command at the end of: {line}"
            found.append((cells[0], cells[2], cells[3], shlex.split(command.group(1))))
    return found


ROWS = rows()


def run(arguments):
    return subprocess.run([COMMAND, *arguments], cwd=ROOT, text=True, capture_output=True, timeout=300, check=False)


def failing_checks(made):
    return re.findall(r"^  FAIL .*", made.stdout, re.MULTILINE)


def test_every_scene_is_on_the_page():
    named = {word for _, _, _, command in ROWS for word in command if word.startswith("tests/faults/")}
    assert named == {str(scene.relative_to(ROOT)) for scene in SCENES.glob("*.json")}
    assert len(ROWS) >= 20


@pytest.mark.parametrize("symptom, words, way, command", ROWS, ids=[row[0][:60] for row in ROWS])
def test_a_fault_shows_as_the_page_says(symptom, words, way, command):
    made = run(command)
    quoted = re.findall(r'"([^"]+)"', words)
    printed = " ".join((made.stdout + made.stderr).split())
    if words.startswith("**silent**"):
        assert "--check" in command and made.returncode == 1 and failing_checks(made), made.stdout
        assert "doubtful" not in printed, "it is not silent"
    else:
        assert quoted, f"no words of the command: {words}"
        for said in quoted:
            assert said in printed, f"{said!r} is not in:\n{made.stdout}{made.stderr}"


@pytest.mark.parametrize("symptom, words, way, command", [row for row in ROWS if "`--" in row[2]],
                         ids=[row[0][:60] for row in ROWS if "`--" in row[2]])
def test_the_way_round_helps(symptom, words, way, command):
    options = shlex.split(re.search(r"`(--[^`]+)`", way).group(1))
    # An option that is given twice is wrong usage; the way round replaces it.
    for option in options[::2]:
        if option in command and option != "--set":
            place = command.index(option)
            command = command[:place] + command[place + 2:]
    made = run([*command, *options])
    printed = " ".join((made.stdout + made.stderr).split())
    assert made.returncode == 0, made.stdout + made.stderr
    assert not failing_checks(made), made.stdout
    for said in re.findall(r'"([^"]+)"', words):
        assert said not in printed, f"{said!r} is still in:\n{made.stdout}{made.stderr}"

"""Commands on pages run and print the lines of the page.

* The commands of a ```console block run in a folder with the scenes, end with exit code 0 and
  print the lines below them. "..." stands for any lines. Numbers may differ by a hundred-thousandth, because pages show more
  digits than the tests of physics hold.
* In a block without a language, lines that run `sheave` on a scene of the repository, or on `crane.json`, end with exit
  code 0. Commands that take minutes are left out (LEFT_OUT), and those that draw pictures of pages run elsewhere (test_page_pictures.py).
* A block below <!-- file: NAME --> is part of that file; NAME is relative to the page. A block below the words `NAME.json`
  is a scene, and the commands of the page find it under that name.
* Commands in the text name existing scenes, and options of the command.
"""

import functools
import os
import pathlib
import re
import subprocess
import textwrap

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
COMMAND = pathlib.Path(os.environ.get("SHEAVE_COMMAND", ROOT / "build/release/tools/sheave"))
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
CONSOLE = re.compile(r"^ *```console\n(.*?)^ *```", re.DOTALL | re.MULTILINE)
PLAIN = re.compile(r"^ *```(?:text)?\n(.*?)^ *```", re.DOTALL | re.MULTILINE)
# Commands that take minutes, or need the file of an earlier one or emscripten.
LEFT_OUT = re.compile(r"sheave (trade|stress)|view .*--live|--speed 0.1|latin-hypercube|\.\.\.|half\.state|session\.jsonl")
PART = re.compile(r"<!-- file: (\S+) -->\n```\w+\n(.*?)^```", re.DOTALL | re.MULTILINE)
NAMED = re.compile(r"`([\w-]+\.json)`[^`]*?\n```json\n(.*?)^```", re.DOTALL | re.MULTILINE)
NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?(?![\w])")
RELATIVE, ABSOLUTE = 1e-5, 1e-6


def sessions(page):
    """[(command, lines below it)] of a page's console blocks."""
    found = []
    for block in CONSOLE.findall(page.read_text(encoding="utf-8")):
        for line in textwrap.dedent(block).splitlines():
            if line.startswith("$ "):
                found.append((line[2:], []))
            else:
                found[-1][1].append(line)
    return found


def same_line(shown, printed):
    """Are two lines the same but for spaces and the last digits of numbers?"""
    if " ".join(NUMBER.sub("#", shown).split()) != " ".join(NUMBER.sub("#", printed).split()):
        return False
    pairs = zip(map(float, NUMBER.findall(shown)), map(float, NUMBER.findall(printed)))
    return all(abs(a - b) <= ABSOLUTE + RELATIVE * abs(a) for a, b in pairs)


def fault(shown, printed):
    """The first shown line that is not printed in its place, or None."""
    place, gap = 0, False
    for line in shown:
        if line == "...":
            gap = True
            continue
        while gap and place < len(printed) and not same_line(line, printed[place]):
            place += 1
        if place >= len(printed) or not same_line(line, printed[place]):
            return line
        place, gap = place + 1, False
    return None if gap or place == len(printed) else f"nothing below {shown[-1]!r}"


@pytest.fixture(scope="module")
def shell(tmp_path_factory):
    """Runs a command of a page where the page's files are."""
    folder = tmp_path_factory.mktemp("pages")
    (folder / "bin").mkdir()
    (folder / "bin" / "sheave").symlink_to(COMMAND)
    for name in ("scenes", "docs", "build", "examples", "dev", "tools", "tests"):
        (folder / name).symlink_to(ROOT / name)
    (folder / "tutorial").symlink_to(ROOT / "docs" / "tutorial")
    (folder / "crane.json").symlink_to(ROOT / "scenes/machines/crane.json")
    for page in PAGES:
        for name, text in NAMED.findall(page.read_text(encoding="utf-8")):
            (folder / name).write_text(text, encoding="utf-8")
    environment = {**os.environ, "PATH": f"{folder / 'bin'}:{os.environ['PATH']}"}

    @functools.cache
    def run_once(command):
        return subprocess.run(["bash", "-c", command], cwd=folder, env=environment, text=True, capture_output=True,
                              stdin=subprocess.DEVNULL, timeout=600, check=False)

    # A command that stands on several pages runs once.
    return lambda command: run_once(command.replace("build/release/tools/sheave", "sheave"))


def test_a_wrong_listing_is_found():
    assert fault(["a 1.00000", "..."], ["a 1.000001", "b"]) is None
    assert fault(["a 1.001", "..."], ["a 1.0", "b"]) == "a 1.001"
    assert fault(["...", "c", "..."], ["a", "b"]) == "c"
    assert fault(["a"], ["a", "b"]) is not None


CASES = [(page, command, shown) for page in PAGES for command, shown in sessions(page)
         if not command.startswith(("sudo", "sheave live"))]


def test_there_are_listings():
    assert len([page for page, _, _ in CASES if page.parent.name == "tutorial"]) >= 10


@pytest.mark.parametrize("page, command, shown", CASES,
                         ids=[f"{page.relative_to(ROOT)}: {command}"[:90] for page, command, _ in CASES])
def test_a_command_prints_what_the_page_says(page, command, shown, shell):
    # Two seconds of a small video tell as much as twenty of a large one.
    made = shell(command + " --duration 2 --width 320 --height 180" if "--video" in command else command)
    assert made.returncode == 0, f"exit code {made.returncode}: {made.stderr}"
    printed = made.stdout.splitlines()
    assert fault(shown, printed) is None, f"{fault(shown, printed)!r} is not in:\n{made.stdout}"


def plain_commands(page):
    """Commands of a page's blocks without a language that run `sheave` on a scene of the repository or on crane.json."""
    found = []
    for block in PLAIN.findall(page.read_text(encoding="utf-8")):
        lines = [line.strip() for line in block.replace("\\\n", " ").splitlines()]
        found += [re.sub(r"\s{2,}", " ", line) for line in lines
                  if re.match(r"(build/release/tools/)?sheave \w+ .*(\bscenes/[\w/-]+\.json|\bcrane\.json\b)", line)
                  and not LEFT_OUT.search(line) and "docs/pictures/" not in line]
    return found


PLAIN_CASES = [(page, command) for page in PAGES for command in plain_commands(page)]


def test_there_are_plain_commands():
    assert len(PLAIN_CASES) >= 20


@pytest.mark.parametrize("page, command", PLAIN_CASES,
                         ids=[f"{page.relative_to(ROOT)}: {command}"[:90] for page, command in PLAIN_CASES])
def test_a_plain_command_runs(page, command, shell):
    # A page is opened by whoever reads it.
    # A few frames of a film tell as much as a thousand.
    short = " --duration 0.3" if " render " in command and re.search("--(video|png|glb)", command) else ""
    # A small film of a mode tells as much as a large one.
    short += " --width 320 --height 180" if " modes " in command and "--video" in command else ""
    # So do short runs of a sweep.
    short += " --duration 0.2" if " sweep " in command and " --of " not in command else ""
    made = shell(command.replace(" --open", "") + short)
    assert made.returncode == 0, f"exit code {made.returncode}: {made.stderr}"


PARTS = [(page, name, text) for page in PAGES for name, text in PART.findall(page.read_text(encoding="utf-8"))]


@pytest.mark.parametrize("page, name, text", PARTS, ids=[f"{page.relative_to(ROOT)}: {name}" for page, name, _ in PARTS])
def test_a_part_of_a_file_is_in_it(page, name, text):
    whole = " ".join((page.parent / name).read_text(encoding="utf-8").split())
    assert " ".join(text.split()) in whole


def commands_in(page):
    """`sheave ...` in a page's text, with the options and scenes it names."""
    text = page.read_text(encoding="utf-8")
    return sorted({match for match in re.findall(r"`(?:build/release/tools/)?sheave ((?:run|render|validate|trade|stress|bench) [^`|\n]*)`", text)})


def test_scenes_and_options_in_pages_are_there(shell):
    options = {name: set(re.findall(r"--[\w-]+", shell(f"sheave {name} --help").stdout))
               for name in ("run", "render", "validate", "trade", "stress", "bench")}
    faults = []
    for page in PAGES:
        for command in commands_in(page):
            name = command.split()[0]
            for option in re.findall(r"(?<=\s)--[\w-]+", command):
                if option not in options[name]:
                    faults.append(f"{page.relative_to(ROOT)}: sheave {command}: no option {option}")
            for scene in re.findall(r"\bscenes/[\w/-]+\.json", command):
                if not (ROOT / scene).exists():
                    faults.append(f"{page.relative_to(ROOT)}: sheave {command}: no {scene}")
    assert not faults, "\n".join(faults)


def test_the_page_of_commands_is_what_the_help_says():
    made = subprocess.run([str(ROOT / "dev/command-pages"), str(COMMAND)], text=True, capture_output=True, check=True)
    assert made.stdout == (ROOT / "docs/reference/commands.md").read_text(encoding="utf-8"), \
        "run: dev/command-pages build/release/tools/sheave > docs/reference/commands.md"

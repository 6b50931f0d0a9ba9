"""Manual pages and completions that are made from the command's own help."""

import os
import pathlib
import shutil
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
COMMAND = pathlib.Path(os.environ.get("SHEAVE_COMMAND", ROOT / "build/release/tools/sheave"))


def completion(shell):
    return subprocess.run([COMMAND, "completion", shell], text=True, capture_output=True, check=True).stdout


@pytest.mark.parametrize("words, expected", [
    (["sheave", "val"], "validate"),
    (["sheave", "generate", "hil"], "hilbert"),
    (["sheave", "generate", "hilbert", "--ord"], "--order"),
    (["sheave", "run", "--estim"], "--estimate-error"),
])
def test_bash_completes(words, expected, tmp_path):
    script = tmp_path / "sheave.bash"
    script.write_text(completion("bash"), encoding="utf-8")
    made = subprocess.run(["bash", "-c", 'source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _sheave; '
                           'printf "%s\\n" "${COMPREPLY[@]}"', "bash", script, *words],
                          text=True, capture_output=True, check=True, cwd=tmp_path)
    assert made.stdout.split() == [expected]


@pytest.mark.parametrize("shell, words", [("fish", "sheave run --estim"), ("zsh", "")])
def test_other_shells_read_their_scripts(shell, words, tmp_path):
    if shutil.which(shell) is None:
        pytest.skip(f"{shell} is not installed")
    script = tmp_path / "script"
    script.write_text(completion(shell), encoding="utf-8")
    if shell == "zsh":
        subprocess.run(["zsh", "-n", script], check=True)
        return
    made = subprocess.run(["fish", "-c", f"source {script}; complete -C '{words}'"], text=True, capture_output=True,
                          check=True, env={**os.environ, "HOME": str(tmp_path)})
    assert "--estimate-error" in made.stdout


def test_manual_pages_say_what_the_help_says(tmp_path):
    subprocess.run([ROOT / "dev/man-pages", COMMAND, tmp_path], check=True)
    names = {page.name for page in tmp_path.iterdir()}
    assert {"sheave.1", "sheave-run.1", "sheave-completion.1"} <= names
    text = (tmp_path / "sheave-run.1").read_text(encoding="utf-8")
    assert "estimate\\-error" in text and ".SH SYNOPSIS" in text
    if shutil.which("mandoc"):
        made = subprocess.run(["mandoc", "-T", "lint", "-W", "warning", *sorted(tmp_path.iterdir())], text=True,
                              capture_output=True, check=False)
        assert made.stdout == ""

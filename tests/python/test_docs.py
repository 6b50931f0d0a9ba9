"""Every listing of docs/how-to/python.md does what it says."""

import contextlib
import io
import re

import pytest
from conftest import ROOT

PAGE = (ROOT / "docs/how-to/python.md").read_text(encoding="utf-8")
LISTINGS = re.findall(r"```python\n(.*?)```\n(?:\n```output\n(.*?)```)?", PAGE, re.DOTALL)


def test_there_are_listings():
    assert len(LISTINGS) == PAGE.count("```python") >= 8


@pytest.mark.parametrize("code, output", LISTINGS)
def test_a_listing_does_what_it_says(code, output, root):
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(compile(code, "docs/how-to/python.md", "exec"), {"__name__": "listing"})
    assert printed.getvalue() == output

"""Every listing of the pages about Python does what it says."""

import contextlib
import io
import re

import pytest
from conftest import ROOT

PAGES = {"docs/how-to/python.md": 8, "docs/how-to/robotics.md": 1}
TEXTS = {page: (ROOT / page).read_text(encoding="utf-8") for page in PAGES}
LISTINGS = [(page, code, output) for page, text in TEXTS.items()
            for code, output in re.findall(r"```python\n(.*?)```\n(?:\n```output\n(.*?)```)?", text,
                                           re.DOTALL)]


@pytest.mark.parametrize("page, least", PAGES.items())
def test_there_are_listings(page, least):
    count = sum(own == page for own, _, _ in LISTINGS)
    assert count == TEXTS[page].count("```python") >= least


@pytest.mark.parametrize("page, code, output", LISTINGS)
def test_a_listing_does_what_it_says(page, code, output, root):
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(compile(code, page, "exec"), {"__name__": "listing"})
    assert printed.getvalue() == output

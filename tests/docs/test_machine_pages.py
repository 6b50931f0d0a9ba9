"""The pages of whole machines are short: at most 400 words each, with their code."""

from pathlib import Path

import pytest

FOLDER = Path(__file__).resolve().parents[2] / "docs" / "how-to"
MOST_WORDS = 400


@pytest.mark.parametrize("name", ["container-crane", "koepe-elevator", "ropeway", "tandem-lift", "h-bot"])
def test_a_page_has_at_most_400_words(name):
    assert len((FOLDER / f"{name}.md").read_text().split()) <= MOST_WORDS

"""Anything is called with anything: errors that tell, no crash, nothing changed by what was refused.

Short here; dev/fuzz-python does the same for as long as one wants.
"""

import pytest
from random_calls import Caller


@pytest.mark.parametrize("seed", range(8))
def test_random_calls(seed):
    Caller(seed).run(300)

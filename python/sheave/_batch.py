"""Many worlds at once."""

from __future__ import annotations

import itertools
import math
import operator
import os
from typing import TYPE_CHECKING, Any, List, Mapping, Optional

import numpy as np

from . import _sheave
from ._errors import ArgumentError, shown
from ._load import SceneLike, json_text, overrides_of, source_of

if TYPE_CHECKING:
    import numpy.typing as npt


def whole_number(value: Any, name: str, least: int) -> int:
    """The value as an integer >= `least`; raises ArgumentError otherwise."""
    try:
        number = operator.index(value)
    except Exception:
        number = least - 1
    if number < least:
        raise ArgumentError(f"{name}: must be an integer of at least {least}, was {shown(value)}")
    return number


def list_of(values: Any, most: int) -> Optional[List[Any]]:
    """The first `most` + 1 items of an iterable; None for a text, a mapping or no iterable."""
    if isinstance(values, (str, bytes, Mapping)):
        return None
    try:
        items = values.tolist() if isinstance(values, np.ndarray) else values
        return list(itertools.islice(items, most + 1))
    except Exception:
        return None


class Batch(_sheave.Batch):
    """n worlds of one scene, stepped on all cores; results are arrays of n rows.

    `vary` maps JSON pointers of settings to arrays with one value per world:
    {"/bodies/drum/mass": array}. The results do not depend on the number of threads. A world that
    diverges is marked in `diverged` and is not stepped any more; the others continue.
    """

    __slots__ = ("_made",)

    def __init__(self, scene: SceneLike, n: int, vary: Optional[Mapping[str, Any]] = None,
                 set: Optional[Mapping[str, Any]] = None, threads: Optional[int] = None):
        n = whole_number(n, "n", 1)
        varied = {}
        if vary is not None and not isinstance(vary, Mapping):
            raise ArgumentError("vary: must be a dict from JSON pointers to values, one for each "
                                f"world, was {shown(vary)}")
        for pointer, values in (vary or {}).items():
            listed = list_of(values, n)
            if listed is None or len(listed) != n:
                raise ArgumentError(f"vary: {pointer} must have {n} values, one for each world, "
                                    f"was {shown(values)}")
            varied[str(pointer)] = [json_text(value, str(pointer)) for value in listed]
        if threads is None:
            threads = len(os.sched_getaffinity(0))
        super().__init__(*source_of(scene), n, overrides_of(set), varied, threads)
        self._made = True

    def run(self, until: Optional[float] = None) -> None:
        """Steps all worlds until the time `until` [s]; None: the scene's duration."""
        end = self.duration if until is None else until
        if isinstance(end, bool) or not isinstance(end, (int, float)) or not math.isfinite(end):
            raise ArgumentError(f"until: must be a finite number [s], or None, was {shown(until)}")
        if end / self.dt > 9e15:  # a double cannot count single steps
            raise ArgumentError(f"until: must be at most 9e15 steps away, {9e15 * self.dt:g} s, was {end!r}")
        steps = round(max(end / self.dt, 0.0))
        while True:
            left = np.maximum(steps - self.steps, 0)
            left[self.diverged | self.stopped] = 0
            count = int(left.max(initial=0))
            if count == 0:
                return
            count = int(left[left > 0].min())
            self.step(count, left > 0)

    def record(self, names: "list[str]", steps: Optional[int] = None,
               every: int = 1) -> "npt.NDArray[np.float64]":
        """Steps and records observables: at the start and after every `every` steps.

        Returns an array of the shape (n, rows, names).
        """
        every = whole_number(every, "every", 1)
        if steps is not None:
            steps = whole_number(steps, "steps", 0)
        else:
            steps = max(round(self.duration / self.dt) - int(self.steps.max()), 0)
        rows = [self.observe(names)]
        for _ in range(steps // every):
            self.step(every)
            rows.append(self.observe(names))
        return np.stack(rows, axis=1)

    def __repr__(self) -> str:
        if not hasattr(self, "_made"):
            return "<Batch of a scene that was refused>"
        return f"<Batch of {len(self)} worlds on {self.threads} threads>"

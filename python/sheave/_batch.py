"""Many worlds at once."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, Mapping, Optional

import numpy as np

from . import _sheave
from ._errors import ArgumentError
from ._load import SceneLike, json_text, overrides_of, source_of

if TYPE_CHECKING:
    import numpy.typing as npt


class Batch(_sheave.Batch):
    """n worlds of one scene, stepped on all cores; results are arrays of n rows.

    `vary` gives settings by their JSON pointers, each with one value per world:
    {"/bodies/drum/mass": array}. The number of threads changes nothing but the time it takes. A
    world that diverges is marked in `diverged` and steps no more; the others go on.
    """

    __slots__ = ()

    def __init__(self, scene: SceneLike, n: int, vary: Optional[Mapping[str, Any]] = None,
                 set: Optional[Mapping[str, Any]] = None, threads: Optional[int] = None):
        varied = {}
        for pointer, values in (vary or {}).items():
            if isinstance(values, str) or not hasattr(values, "__len__") or len(values) != n:
                raise ArgumentError(f"vary: {pointer} must have {n} values, one for each world, "
                                    f"was {values!r}"[:300])
            listed = values.tolist() if isinstance(values, np.ndarray) else list(values)
            varied[str(pointer)] = [json_text(value, str(pointer)) for value in listed]
        if threads is None:
            threads = len(os.sched_getaffinity(0))
        super().__init__(*source_of(scene), n, overrides_of(set), varied, threads)

    def run(self, until: Optional[float] = None) -> None:
        """Steps all worlds until this time [s], or for the scene's duration."""
        steps = round((self.duration if until is None else until) / self.dt)
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
        """Steps, and keeps quantities: (n, rows, names), at the start and every `every` steps."""
        if steps is None:
            steps = max(round(self.duration / self.dt) - int(self.steps.max()), 0)
        rows = [self.observe(names)]
        for _ in range(steps // every):
            self.step(every)
            rows.append(self.observe(names))
        return np.stack(rows, axis=1)

    def __repr__(self) -> str:
        return f"<Batch of {len(self)} worlds on {self.threads} threads>"

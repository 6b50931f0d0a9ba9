"""Quantities over time."""

from __future__ import annotations

from collections.abc import Mapping as AbstractMapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, Iterator, List, Mapping

import numpy as np

from ._errors import UnknownNameError

if TYPE_CHECKING:
    import numpy.typing as npt

    Array = npt.NDArray[np.float64]


class Recording(AbstractMapping):  # type: ignore[type-arg]
    """Arrays by the names of observables, all with the length of `time`."""

    def __init__(self, names: List[str], rows: "Array", units: List[str]):
        self._names = names
        self._rows = rows
        self._units = MappingProxyType(dict(zip(names, units)))

    @property
    def units(self) -> Mapping[str, str]:
        """Units by the same names: "N", "rad/s"; empty for a dimensionless number."""
        return self._units

    @property
    def time(self) -> "Array":
        """The times of the rows [s]."""
        return self._rows[:, 0]

    def __getitem__(self, name: str) -> "Array":
        if not isinstance(name, str):
            raise UnknownNameError(f"name: must be a string, was {type(name).__name__}")
        if name == "t" and name not in self._names:
            return self.time
        if name not in self._names:
            raise UnknownNameError(
                f'"{name}" has not been recorded; recorded are: ' + ", ".join(self._names))
        return self._rows[:, 1 + self._names.index(name)]

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)

    def __array__(self, dtype: Any = None) -> Any:
        return self._rows[:, 1:] if dtype is None else self._rows[:, 1:].astype(dtype)

    def to_pandas(self) -> Any:
        """A DataFrame with the time as its index."""
        import pandas

        index = pandas.Index(self.time, name="t")
        return pandas.DataFrame(self._rows[:, 1:].copy(), index=index, columns=self._names)

    def plot(self, axes: Any = None, **options: Any) -> Any:
        """Draws all observables over time with matplotlib, with separate axes for each unit.

        Returns the axes; several ones as an array, in the order of the units' first appearance.
        `axes`: existing axes to draw into, one per unit. Other options go to matplotlib's plot().
        """
        from ._plotting import plot_recording

        return plot_recording(self, axes, options)

    def __repr__(self) -> str:
        return f"<Recording of {', '.join(self._names)}: {len(self.time)} rows>"

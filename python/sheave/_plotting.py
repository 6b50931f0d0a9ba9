"""Figures, made with matplotlib if it is installed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Dict, List

import numpy as np

from ._errors import ArgumentError

if TYPE_CHECKING:
    from ._recording import Recording


def new_axes(count: int) -> Any:
    """`count` axes with a common time, in a new figure that opens no window."""
    size = (7.0, 4.0) if count == 1 else (7.0, 1.2 + 2.2 * count)
    try:
        from matplotlib import pyplot

        figure = pyplot.figure(figsize=size, layout="constrained")
    except ImportError:
        from matplotlib.figure import Figure

        figure = Figure(figsize=size, layout="constrained")
    return figure.subplots(count, 1, sharex=True, squeeze=False)[:, 0]


def y_label(names: List[str], unit: str) -> str:
    """The label of an axis: the kind of quantity, if there is only one, and the unit."""
    kinds = {name.rsplit(".", 1)[-1] for name in names}
    what = kinds.pop().replace("_", " ") if len(kinds) == 1 else ""
    return f"{what} [{unit}]".strip() if unit else what


def plot_recording(recording: "Recording", axes: Any, options: Dict[str, Any]) -> Any:
    """Draws a line for each quantity, with separate axes for each unit."""
    by_unit: Dict[str, List[str]] = {}
    for name in recording:
        by_unit.setdefault(recording.units[name], []).append(name)
    count = max(1, len(by_unit))
    drawn = new_axes(count) if axes is None else np.atleast_1d(np.asarray(axes, dtype=object))
    if drawn.ndim != 1 or len(drawn) != count:
        units = ", ".join(f"[{unit or '1'}]" for unit in by_unit)
        raise ArgumentError(f"axes: must be {count}, one for each unit ({units}), was {axes!r}")
    for (unit, names), one in zip(by_unit.items(), drawn):
        for name in names:
            one.plot(recording.time, recording[name], label=name, **options)
        one.set_ylabel(y_label(names, unit))
        one.legend()
    for one in drawn:
        one.grid(True, alpha=0.3)
    drawn[-1].set_xlabel("time [s]")
    return drawn[0] if count == 1 else drawn

"""Figures, with matplotlib if it is there."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Dict

if TYPE_CHECKING:
    from ._recording import Recording


def new_axes() -> Any:
    """Axes in a figure of their own, without asking for a window."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.0, 4.0), layout="constrained")
    try:
        from matplotlib import pyplot
    except ImportError:
        return figure.add_subplot()
    return pyplot.figure(figsize=(7.0, 4.0), layout="constrained").add_subplot()


def plot_recording(recording: "Recording", axes: Any, options: Dict[str, Any]) -> Any:
    """A line for each quantity."""
    if axes is None:
        axes = new_axes()
    for name in recording:
        axes.plot(recording.time, recording[name], label=name, **options)
    axes.set_xlabel("time [s]")
    if len(recording) > 0:
        axes.legend()
    axes.grid(True, alpha=0.3)
    return axes

"""Sheave: rigid bodies and cables.

>>> import sheave
>>> sim = sheave.load("scenes/paper/pulley.json")
>>> sim.run()
True
>>> sim.cables["cable"].tension(0)

docs/how-to/python.md tells all of it.
"""

from ._batch import Batch
from ._edit import Edit
from ._environment import Bounds, VectorEnvironment
from ._errors import (
    ArgumentError,
    DivergenceError,
    EditError,
    Error,
    Fault,
    SceneError,
    StaleError,
    StateError,
    UnknownNameError,
)
from ._model import Model
from ._part import Part
from ._recording import Recording
from ._sheave import LiveBody, LiveCable, LiveJoint, Snapshot, __version__, has_render
from ._simulation import Simulation, load
from ._statics import Modes, Statics
from .parts import *  # noqa: F401,F403
from .parts import __all__ as _parts

__all__ = [
    "ArgumentError",
    "Batch",
    "Bounds",
    "DivergenceError",
    "Edit",
    "EditError",
    "Error",
    "Fault",
    "LiveBody",
    "LiveCable",
    "LiveJoint",
    "Model",
    "Modes",
    "Part",
    "Recording",
    "SceneError",
    "Simulation",
    "Snapshot",
    "StaleError",
    "StateError",
    "Statics",
    "UnknownNameError",
    "VectorEnvironment",
    "__version__",
    "has_render",
    "load",
]
__all__ += _parts

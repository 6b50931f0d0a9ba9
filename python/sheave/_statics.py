"""Results of statics and of vibrations."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Dict, List, Mapping, Optional, Tuple

import numpy as np

if TYPE_CHECKING:
    import numpy.typing as npt

    Array = npt.NDArray[np.float64]
    Poles = npt.NDArray[np.complex128]


@dataclass(frozen=True, eq=False)
class Statics:
    """An equilibrium near the pose of a simulation."""

    stability: str
    """"stable", "neutral" or "unstable"."""
    eigenvalues: "Array"
    """Squares of the angular frequencies of all motions [1/s2], ascending; negative: unstable."""
    tensions: "Array"
    """Of all spans, in the order of Simulation.span_names [N], (spans,)."""
    positions: "Array"
    """Of the bodies' centres of mass, in the order of Simulation.body_names [m], (bodies, 3)."""
    orientations_xyzw: "Array"
    """Of the bodies, unit quaternions x, y, z, w, (bodies, 4)."""
    qpos: "Optional[Array]"
    """Coordinates, in the order of Simulation.coordinate_names [m or rad], (n,); None if the machine
    is too large for coordinates."""
    supports: Dict[str, Tuple[float, float, float]]
    """Forces of bearings, guides and fixings on bodies [N]; "world": of the ground on the world."""
    slack_spans: Dict[str, float]
    """Spans without tension, and by how much each is too long [m]."""
    redundant: int
    """Number of redundant constraints, whose forces are not unique; the smallest ones are given."""
    friction_holds: bool
    """Whether dry friction carries load; its force depends on the way to the rest."""
    force_error: float
    """Residual force / largest force."""
    length_error: float
    """Residual of constraints / size of the scene."""


@dataclass(frozen=True, eq=False)
class Modes:
    """Vibrations about the pose of a simulation, as if it were at rest; k motions."""

    frequencies: "Array"
    """[Hz], (k,); 0 for a motion without stiffness, and for an unstable one."""
    damping_ratios: "Array"
    """Fractions of critical damping, (k,)."""
    eigenvalues: "Array"
    """Squares of the angular frequencies [1/s2], ascending, (k,); negative: unstable."""
    poles: "Poles"
    """Of the damped machine, motions exp(p t) [1/s], by magnitude, (2 k,)."""
    shapes: "Array"
    """Displacements along the bodies' degrees of freedom, with modal mass 1, (freedoms, k)."""
    freedom_names: List[str]
    """Names of the rows of shapes: "<body>.x", "<body>.turn_z", ..."""
    joint_shapes: "Array"
    """Changes of the coordinates in the order of Simulation.coordinate_names, (n, k)."""
    bodies: List[str]
    """Per motion: the body with the largest part of the kinetic energy; empty: none."""
    imbalance: float
    """Unbalanced part of the forces; modes are meaningful only if this is small."""
    error: float
    """Error of the stiffness by finite differences / its largest entry."""
    friction_slides: bool
    """A cable or contact slides with friction; the analysis holds it in place."""


def statics_of(values: Mapping[str, Any]) -> Statics:
    """The result of statics from the values of the compiled half."""
    known = dict(values)
    for name in ("eigenvalues", "tensions"):
        known[name] = np.asarray(known[name], float)
    return Statics(**known)


def modes_of(values: Mapping[str, Any]) -> Modes:
    """The result of modes from the values of the compiled half."""
    known = dict(values)
    known["poles"] = np.asarray(known["poles"], complex)
    return Modes(**known)

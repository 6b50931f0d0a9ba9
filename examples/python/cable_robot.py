"""A cable robot follows a path: inverse kinematics in NumPy, two winches that are set to angles.

The free cable of a drum of radius r at distance d from the platform is l = sqrt(d^2 - r^2) long and
leaves the drum in a direction that turns with the platform; by both the drum has to turn.
"""

import sys

import numpy as np
import numpy.typing as npt

import sheave

Array = npt.NDArray[np.float64]
RADIUS, DURATION = 0.2, 6.0  # m, s


def path(time: Array) -> Array:
    """A figure of eight, from rest to rest: points (x, y) for times."""
    turn = 2 * np.pi * time / DURATION
    phase = turn - np.sin(turn)
    return np.stack([0.5 * np.sin(phase), -1.0 + 0.15 * np.sin(2 * phase)], axis=-1)


def drum_angle(side: int, points: Array) -> Array:
    """How the drum on the side -1 or 1 has to stand for the platform to be there."""
    way = points - np.array([1.5 * side, 1.0])
    lean = np.arcsin(RADIUS / np.linalg.norm(way, axis=-1))
    angle: Array = -side * (1 / np.tan(lean) + np.arctan2(way[..., 1], -side * way[..., 0]) + lean)
    return angle


def build() -> sheave.Model:
    """Two drums and a platform."""
    model = sheave.Model(duration=DURATION, step=sheave.Step(dt=0.01))
    start = path(np.zeros(()))
    platform = model.add(sheave.Body("platform", mobility="planar", mass=2,
                                     position=(start[0], start[1], 0),
                                     shape=sheave.Box(size=(0.3, 0.1, 0.3))))
    for side, name in ((-1, "left"), (1, "right")):
        drum = model.add(sheave.Body(
            f"{name} drum", mobility="rotor", mass=5, position=(1.5 * side, 1, 0), drive="angle",
            drive_values=[0], shape=sheave.Cylinder(radius=RADIUS, length=0.2)))
        model.add(sheave.Cable(name, links=[
            sheave.SpoolLink(body=drum, stored_length=3,
                             winding="counter-clockwise" if side < 0 else "clockwise"),
            sheave.AttachmentLink(body=platform)]))
    return model


def main(figure: str = "") -> float:
    """The largest distance from the path [m]."""
    sim = build().simulation()
    drums = [(side, sim.bodies[f"{name} drum"]) for side, name in ((-1, "left"), (1, "right"))]
    first = {side: drum_angle(side, path(np.zeros(()))) for side, _ in drums}

    def lead(own: sheave.Simulation) -> None:
        end = np.asarray(own.time + own.dt)
        for side, drum in drums:
            drum.set_angle(float(drum_angle(side, path(end)) - first[side]), over=own.dt)

    recording = sim.record(["platform.x", "platform.y"], before_step=lead)
    way = np.stack([recording["platform.x"], recording["platform.y"]], axis=-1)
    error = float(np.abs(way - path(recording.time)).max())
    print(f"the platform keeps to its path within {1e6 * error:.3f} micrometres")
    assert error < 0.01
    if figure:
        from matplotlib import pyplot

        axes = pyplot.figure(figsize=(5, 4), layout="constrained").add_subplot()
        axes.plot(*path(recording.time).T, "k--", label="path")
        axes.plot(*way.T, label="platform")
        axes.set_aspect("equal")
        axes.legend()
        axes.figure.savefig(figure)
    return error


if __name__ == "__main__":
    main(*sys.argv[1:])

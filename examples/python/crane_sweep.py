"""A thousand cranes at once: how fast to luff so that the load does not swing.

The luffing crane of scenes/machines/crane.json, each with its own time to speed up its luff winch
and its own time at full speed, by which the winch turns by 27 rad in all. What is left of the swing
is the range of the load's distance from the boom's tip, afterwards.
"""

import sys
from pathlib import Path

import numpy as np

import sheave

SCENE = Path(__file__).resolve().parents[2] / "scenes/machines/crane.json"
BEGIN, TURN = 1.0, 27.0  # s, rad


def main(figure: str = "", ramps: int = 40, cruises: int = 25) -> float:
    """The least swing [m]."""
    ramp, cruise = (a.ravel() for a in np.meshgrid(np.linspace(1.5, 8, ramps),
                                                   np.linspace(0, 6, cruises), indexing="ij"))
    speed = TURN / (ramp + cruise)
    zero = np.zeros_like(ramp)
    times = np.stack([zero, zero + BEGIN, BEGIN + ramp, BEGIN + ramp + cruise,
                      BEGIN + 2 * ramp + cruise], axis=1)
    # Where there is no time at full speed the table has one point less: keep points apart.
    times[:, 3] = np.maximum(times[:, 3], times[:, 2] + 1e-3)
    times[:, 4] = np.maximum(times[:, 4], times[:, 3] + 1e-3)
    values = np.stack([zero, zero, speed, speed, zero], axis=1)
    cranes = sheave.Batch(SCENE, len(ramp), vary={
        "/bodies/luff winch/drive_times": times, "/bodies/luff winch/drive_values": values})
    cranes.run(float(times[:, 4].max()))
    rows = cranes.record(["hook.x", "tip sheave.x"], round(7.0 / cranes.dt), every=3)
    swing = np.ptp(rows[:, :, 0] - rows[:, :, 1], axis=1)
    best = int(np.argmin(swing))
    print(f"{len(swing)} cranes: the swing is between {swing.min():.3f} and {swing.max():.3f} m;\n"
          f"least with {ramp[best]:.2f} s to speed up and {cruise[best]:.2f} s at full speed")
    assert not cranes.diverged.any() and swing.min() < 0.3 * swing.max()
    if figure:
        from matplotlib import pyplot

        axes = pyplot.figure(figsize=(6, 4), layout="constrained").add_subplot()
        mesh = axes.pcolormesh(ramp.reshape(ramps, cruises), cruise.reshape(ramps, cruises),
                               swing.reshape(ramps, cruises), shading="nearest")
        axes.plot(ramp[best], cruise[best], "r*")
        axes.set_xlabel("time to speed up [s]")
        axes.set_ylabel("time at full speed [s]")
        axes.figure.colorbar(mesh, label="swing [m]")
        axes.figure.savefig(figure)
    return float(swing.min())


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "", *map(int, sys.argv[2:]))

"""System identification: the friction of a rope over a post, from a recorded run.

A "measured" run is made with coefficients that nobody tells the fit, and with noise. SciPy's least
squares finds them by running the model again and again.
"""

import sys
from typing import Dict

import numpy as np
import numpy.typing as npt
from scipy.optimize import least_squares

import sheave

Array = npt.NDArray[np.float64]
TRUE = np.array([0.18, 0.9])  # capstan coefficient, drag [N s/m]


def scene() -> Dict[str, object]:
    """Two weights on a rope over a post; friction holds back the heavier one."""
    model = sheave.Model(duration=0.6, gravity=(0, -9.81, 0))
    light = model.add(sheave.Body("light", mobility="slider", axis=(0, 1, 0), mass=1,
                                  position=(-0.1, -2, 0)))
    heavy = model.add(sheave.Body("heavy", mobility="slider", axis=(0, 1, 0), mass=3,
                                  position=(0.1, -1, 0)))
    post = model.add(sheave.Body("post", mobility="static",
                                 shape=sheave.Cylinder(radius=0.1, length=0.2)))
    model.add(sheave.Cable("rope", links=[
        sheave.AttachmentLink(body=light),
        sheave.RollingLink(body=post, winding="clockwise", friction=0.1),
        sheave.AttachmentLink(body=heavy)]))
    return model.to_dict()


def run(coefficients: Array) -> Array:
    """How the heavier weight falls: its heights, (steps,)."""
    sim = sheave.load(scene(), set={"/cables/rope/links/1/friction": coefficients[0],
                                    "/bodies/heavy/damping": coefficients[1]})
    return sim.record(["heavy.y"])["heavy.y"]


def main(figure: str = "") -> Array:
    """What the fit finds."""
    noise = np.random.default_rng(1).normal(0.0, 2e-4, run(TRUE).shape)
    measured = run(TRUE) + noise
    fit = least_squares(lambda x: run(x) - measured, x0=[0.05, 0.1], bounds=(1e-3, 5.0),
                        diff_step=1e-4)
    print(f"friction {fit.x[0]:.3f} (was {TRUE[0]}), drag {fit.x[1]:.2f} N s/m (was {TRUE[1]}), "
          f"after {fit.nfev} runs")
    assert abs(fit.x[0] - TRUE[0]) < 0.01
    if figure:
        from matplotlib import pyplot

        axes = pyplot.figure(figsize=(6, 4), layout="constrained").add_subplot()
        axes.plot(measured, ".", markersize=3, label="measured")
        axes.plot(run(fit.x), label="fitted")
        axes.set_xlabel("step")
        axes.set_ylabel("height [m]")
        axes.legend()
        axes.figure.savefig(figure)
    found: Array = fit.x
    return found


if __name__ == "__main__":
    main(*sys.argv[1:])

"""A winch keeps the tension of its rope while the wind on a boat gets stronger.

A PID controller in Python, called before each step: it reads the tension and sets the winch's
speed. A controller of the scene ("type": "pid") would do the same; one's own can be anything.
"""

import sys

import sheave

WANTED = 100.0  # N


def build() -> sheave.Model:
    """A drum at the quay, a boat on a line."""
    model = sheave.Model(gravity=(0, 0, 0), duration=6, step=sheave.Step(dt=0.001))
    drum = model.add(sheave.Body("drum", mobility="rotor", mass=5, drive="speed",
                                 drive_values=[0],
                                 shape=sheave.Cylinder(radius=0.2, length=0.1)))
    boat = model.add(sheave.Body("boat", mobility="slider", axis=(1, 0, 0), mass=200,
                                 position=(10, 0.2, 0)))
    model.add(sheave.Cable("rope", compliance=5e-5, damping=10, links=[
        sheave.SpoolLink(body=drum, winding="clockwise", stored_length=50),
        sheave.AttachmentLink(body=boat)]))
    return model


class Pid:
    """Sets the winch's speed by the rope's tension."""

    def __init__(self, sim: sheave.Simulation) -> None:
        self.winch = sim.bodies["drum"]
        self.boat = sim.bodies["boat"]
        self.rope = sim.cables["rope"]
        self.sum = 0.0

    def __call__(self, sim: sheave.Simulation) -> None:
        """Before each step."""
        wind = 100.0 + max(0.0, 20.0 * (sim.time - 3.0))
        error = self.rope.tension(0) - WANTED
        self.sum += error * sim.dt
        self.boat.set_force((wind, 0, 0))
        self.winch.set_speed(-(0.07 * error + 5.0 * self.sum))


def main(figure: str = "") -> float:
    """The tension at the end [N]."""
    sim = build().simulation()
    recording = sim.record(["rope.0.tension"], every=10, before_step=Pid(sim))
    tension = float(recording["rope.0.tension"][-1])
    print(f"the boat is at {sim.bodies['boat'].position[0]:.2f} m, the tension is {tension:.2f} N")
    assert abs(tension - WANTED) < 1.0
    if figure:
        axes = recording.plot()
        axes.set_ylabel("tension [N]")
        axes.figure.savefig(figure)
    return tension


if __name__ == "__main__":
    main(*sys.argv[1:])

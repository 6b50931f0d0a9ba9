"""A learning loop: the trolley of a crane learns to stop its swinging load.

The cross-entropy method, with NumPy alone: a linear law of four numbers, a batch of worlds for each
generation, the best eighth of which is the middle of the next.
"""

import sys
import time

import numpy as np
import numpy.typing as npt

import sheave

Array = npt.NDArray[np.float64]
LENGTH = 3.0  # m


def build() -> sheave.Model:
    """A trolley on a rail, and a load that swings below it."""
    model = sheave.Model(duration=8, step=sheave.Step(dt=0.02, substeps=2))
    trolley = model.add(sheave.Body("trolley", mobility="slider", axis=(1, 0, 0), mass=10,
                                    shape=sheave.Box(size=(0.6, 0.3, 0.4))))
    load = model.add(sheave.Body("load", mobility="planar", mass=5,
                                 position=(LENGTH * np.sin(0.6), -LENGTH * np.cos(0.6), 0),
                                 shape=sheave.Sphere(radius=0.2)))
    model.add(sheave.Cable("rope", links=[sheave.AttachmentLink(body=trolley),
                                          sheave.AttachmentLink(body=load)]))
    return model


def features(seen: Array) -> Array:
    """What the law looks at: place and speed of the trolley, lean of the rope and its rate."""
    x, v, load_x, load_v = seen.T
    return np.stack([x, v, (load_x - x) / LENGTH, (load_v - v) / LENGTH], axis=1)


def rollout(env: sheave.VectorEnvironment, laws: Array, steps: int) -> Array:
    """What each law earns in a run of its own."""
    seen, _ = env.reset()
    earned = np.zeros(env.num_envs)
    for _ in range(steps):
        actions = np.einsum("nk,nk->n", laws, features(seen))[:, None]
        seen, rewards, _, _, _ = env.step(actions)
        earned += rewards
    return earned


def reward(seen: Array, actions: Array) -> Array:
    """Nothing is lost only by a load at rest in the middle."""
    cost: Array = (features(seen) ** 2 * [1.0, 0.2, 10.0, 2.0]).sum(axis=1)
    earned: Array = -cost - 1e-5 * (actions**2).sum(axis=1)
    return earned


def main(figure: str = "", generations: int = 12, population: int = 96) -> float:
    """By what the best law is better than none at all."""
    env = sheave.VectorEnvironment(
        build(), population, ["trolley.x", "trolley.vx", "load.x", "load.vx"], ["trolley.force_x"],
        -200.0, 200.0, reward, steps_per_action=4, most_steps=100)
    random = np.random.default_rng(0)
    mean, spread = np.zeros(4), np.full(4, 100.0)
    nothing = rollout(env, np.zeros((population, 4)), 100)[0]
    history = []
    begin = time.monotonic()
    for _ in range(generations):
        laws = random.normal(mean, spread, (population, 4))
        earned = rollout(env, laws, 100)
        best = laws[np.argsort(earned)[-population // 8:]]
        mean, spread = best.mean(axis=0), best.std(axis=0) + 1.0
        history.append(earned.max())
    final = rollout(env, np.broadcast_to(mean, (population, 4)), 100)[0]
    swing = np.abs(env.batch.observe("load.vx")[0])
    print(f"without a law the load costs {-nothing:.1f}, with what was learned {-final:.1f};"
          f" at the end it moves by {swing:.4f} m/s ({time.monotonic() - begin:.1f} s)")
    assert final > 0.5 * nothing
    if figure:
        from matplotlib import pyplot

        axes = pyplot.figure(figsize=(6, 4), layout="constrained").add_subplot()
        axes.plot(-np.array(history), "o-")
        axes.axhline(-nothing, color="gray", linestyle="--", label="without a law")
        axes.set_xlabel("generation")
        axes.set_ylabel("cost of the best")
        axes.legend()
        axes.figure.savefig(figure)
    return float(final / nothing)


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "", *map(int, sys.argv[2:]))

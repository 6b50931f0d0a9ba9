"""A batch with the interface of vector environments for reinforcement learning."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Callable, Dict, NamedTuple, Optional, Sequence, Tuple

import numpy as np

from ._batch import Batch
from ._errors import ArgumentError
from ._load import SceneLike

if TYPE_CHECKING:
    import numpy.typing as npt

    Array = npt.NDArray[np.float64]
    Flags = npt.NDArray[np.bool_]


class Bounds(NamedTuple):
    """Lower and upper bounds of the entries of a row."""

    low: Any
    high: Any

    @property
    def shape(self) -> Tuple[int, ...]:
        """Shape of a row."""
        return tuple(self.low.shape)

    def sample(self, count: int, random: np.random.Generator) -> "Array":
        """Uniform random rows within the bounds, which must be finite."""
        return random.uniform(self.low, self.high, (count, *self.shape))


class VectorEnvironment:
    """n worlds with the conventions of Gymnasium's vector environments, and plain arrays.

    observations: names of quantities. actions: names of controls (docs/how-to/control.md), with the
    bounds `low` and `high`. reward(observations, actions) gives n numbers; terminated(observations)
    n truth values. A world that has ended, or has taken `most_steps` actions, is reset by the next
    step(), which then does nothing else to it (Gymnasium's next-step autoreset).
    """

    def __init__(
        self,
        scene: SceneLike,
        n: int,
        observations: Sequence[str],
        actions: Sequence[str],
        low: Any,
        high: Any,
        reward: Callable[["Array", "Array"], "Array"],
        terminated: Optional[Callable[["Array"], "Flags"]] = None,
        steps_per_action: int = 1,
        most_steps: int = 1000,
        vary: Optional[Any] = None,
        threads: Optional[int] = None,
        on_reset: Optional[Callable[[Batch, "Flags", np.random.Generator], object]] = None,
    ) -> None:
        self.batch = Batch(scene, n, vary=vary, threads=threads)
        self.observations = list(observations)
        self.actions = list(actions)
        shape = (len(self.actions),)
        try:
            self.action_space = Bounds(np.broadcast_to(np.asarray(low, float), shape),
                                       np.broadcast_to(np.asarray(high, float), shape))
        except (TypeError, ValueError):
            raise ArgumentError(f"low, high: must be a number, or one for each of the {shape[0]} "
                                f"actions, were {low!r}, {high!r}") from None
        unbounded = np.full(len(self.observations), np.inf)
        self.observation_space = Bounds(-unbounded, unbounded)
        self.num_envs = n
        self._reward = reward
        self._terminated = terminated
        self._steps_per_action = steps_per_action
        self._most_steps = most_steps
        self._on_reset = on_reset
        self._random = np.random.default_rng()
        self._taken = np.zeros(n, int)
        self._ended = np.zeros(n, bool)
        self.batch.observe(self.observations)

    def reset(self, *, seed: Optional[int] = None,
              mask: Optional["Flags"] = None) -> Tuple["Array", Dict[str, Any]]:
        """Resets all worlds, or those selected by the mask."""
        if seed is not None:
            self._random = np.random.default_rng(seed)
        chosen = np.ones(self.num_envs, bool) if mask is None else np.asarray(mask)
        self.batch.reset(chosen)
        self._taken[chosen] = 0
        self._ended[chosen] = False
        if self._on_reset is not None:
            self._on_reset(self.batch, chosen, self._random)
        return self.batch.observe(self.observations), {}

    def step(
        self, actions: Any
    ) -> Tuple["Array", "Array", "Flags", "Flags", Dict[str, Any]]:
        """Applies actions. Returns observations, rewards, terminated, truncated and infos."""
        given = np.asarray(actions, float)
        if given.shape != (self.num_envs, len(self.actions)):
            raise ArgumentError(f"actions: must have the shape {(self.num_envs, len(self.actions))}"
                                f", had {given.shape}")
        begins = self._ended.copy()
        if begins.any():
            self.reset(mask=begins)
        moves = ~begins
        given = np.clip(given, self.action_space.low, self.action_space.high)
        for k, name in enumerate(self.actions):
            self.batch.set(name, given[:, k], mask=moves)
        self.batch.step(self._steps_per_action, moves)
        self._taken[moves] += 1
        seen = self.batch.observe(self.observations)
        terminated = self.batch.diverged | self.batch.stopped
        if self._terminated is not None:
            terminated = terminated | self._terminated(seen)
        terminated = terminated & moves
        rewards = np.where(moves, self._reward(seen, given), 0.0)
        truncated = (self._taken >= self._most_steps) & ~terminated & moves
        self._ended = terminated | truncated
        return seen, rewards, terminated, truncated, {"diverged": self.batch.diverged}

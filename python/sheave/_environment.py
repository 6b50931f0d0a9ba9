"""A batch with the interface of vector environments for reinforcement learning."""

from __future__ import annotations

from typing import (
    TYPE_CHECKING,
    Any,
    Callable,
    Dict,
    Mapping,
    NamedTuple,
    Optional,
    Sequence,
    Tuple,
)

import numpy as np

from ._batch import Batch, whole_number
from ._errors import ArgumentError, shown
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

    @property
    def dtype(self) -> "np.dtype[np.float64]":
        """Type of the entries."""
        return np.dtype(np.float64)

    def sample(self, count: int, random: np.random.Generator) -> "Array":
        """Uniform random rows within the bounds, which must be finite."""
        return random.uniform(self.low, self.high, (count, *self.shape))


def _bounds(low: Any, high: Any, count: int) -> Bounds:
    """The bounds of `count` actions; a number is the bound of all."""
    try:
        bounds = Bounds(np.broadcast_to(np.asarray(low, float), (count,)),
                        np.broadcast_to(np.asarray(high, float), (count,)))
    except (TypeError, ValueError):
        raise ArgumentError(f"low, high: must be a number, or one for each of the {count} "
                            f"actions, were {shown(low)}, {shown(high)}") from None
    if not np.all(bounds.low <= bounds.high):  # also NaN
        raise ArgumentError("low, high: low must be at most high for every action, were "
                            f"{shown(low)}, {shown(high)}")
    return bounds


class VectorEnvironment:
    """n worlds with the conventions of Gymnasium's vector environments, and plain arrays.

    observations: names of quantities. actions: names of controls (docs/how-to/control.md), with the
    bounds `low` <= `high`. reward(observations, actions) gives n numbers; terminated(observations)
    n truth values. Both are called once when the environment is made, so that results of another
    shape are refused there, as wrong names and bounds are. A world that has ended, or has taken `most_steps` actions, is reset by
    the next step(), which then does nothing else to it (Gymnasium's next-step autoreset).

    action_space and observation_space are those of one world, as single_action_space and
    single_observation_space are.
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
        self.action_space = _bounds(low, high, len(self.actions))
        nowhere = np.zeros(n, bool)
        for name in self.actions:
            self.batch.set(name, 0.0, mask=nowhere)  # refuses a wrong name before the first step
        unbounded = np.full(len(self.observations), np.inf)
        self.observation_space = Bounds(-unbounded, unbounded)
        self.num_envs = n
        self._reward = reward
        self._terminated = terminated
        self._steps_per_action = whole_number(steps_per_action, "steps_per_action", 1)
        self._most_steps = whole_number(most_steps, "most_steps", 1)
        self._on_reset = on_reset
        self._random = np.random.default_rng()
        self._taken = np.zeros(n, int)
        self._ended = np.zeros(n, bool)
        seen = self.batch.observe(self.observations)
        self._row("reward", self._reward(seen, np.clip(np.zeros((n, *shape)), *self.action_space)))
        if self._terminated is not None:
            self._row("terminated", self._terminated(seen))

    @property
    def single_action_space(self) -> Bounds:
        """Bounds of the actions of one world."""
        return self.action_space

    @property
    def single_observation_space(self) -> Bounds:
        """Bounds of the observations of one world."""
        return self.observation_space

    def _row(self, name: str, values: Any) -> Any:
        """The values of a user's function, which must be one for each world."""
        row = np.asarray(values)
        if row.shape != (self.num_envs,) or row.dtype.kind not in "biuf":
            raise ArgumentError(f"{name}: must give {self.num_envs} numbers, an array of the shape "
                                f"({self.num_envs},), gave the shape {row.shape} of {row.dtype}")
        return row

    def reset(self, *, seed: Optional[int] = None, options: Optional[Mapping[str, Any]] = None,
              mask: Optional["Flags"] = None) -> Tuple["Array", Dict[str, Any]]:
        """Resets all worlds, or those selected by the mask.

        `seed` decides everything random in on_reset, of this and of later resets. `options` may
        have the mask as Gymnasium does: {"reset_mask": mask}.
        """
        if options is not None and not isinstance(options, Mapping):
            raise ArgumentError(f"options: must be a dict or None, was {shown(options)}")
        for key in options or {}:
            if key != "reset_mask":
                raise ArgumentError(f"options: may have \"reset_mask\" alone, had {shown(key)}")
        if options is not None and "reset_mask" in options:
            if mask is not None:
                raise ArgumentError("mask: must be left out if options has a \"reset_mask\"")
            mask = options["reset_mask"]
        if seed is not None:
            self._random = np.random.default_rng(whole_number(seed, "seed", 0))
        chosen = np.ones(self.num_envs, bool) if mask is None else np.asarray(mask)
        if chosen.shape != (self.num_envs,) or chosen.dtype != bool:
            raise ArgumentError(f"mask: must be {self.num_envs} truth values, was {shown(mask)}")
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
        try:
            given = np.asarray(actions, float)
        except (TypeError, ValueError):
            raise ArgumentError(f"actions: must be numbers, were {shown(actions)}") from None
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
            ended = self._row("terminated", self._terminated(seen))
            terminated = terminated | ended.astype(bool)
        terminated = terminated & moves
        rewards = np.where(moves, self._row("reward", self._reward(seen, given)), 0.0)
        truncated = (self._taken >= self._most_steps) & ~terminated & moves
        self._ended = terminated | truncated
        return seen, rewards, terminated, truncated, {"diverged": self.batch.diverged}

    def close(self) -> None:
        """Nothing has to be closed; for programs that expect Gymnasium's method."""

"""A world that lives: python/bindings/ has most of it."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping as AbstractMapping
from typing import (
    Any,
    Callable,
    Dict,
    Generic,
    Iterator,
    List,
    Mapping,
    Optional,
    Sequence,
    TypeVar,
    Union,
)

from . import _sheave
from ._edit import Edit
from ._errors import ArgumentError, EditError, shown
from ._load import SceneLike, overrides_of, source_of
from ._recording import Recording
from ._sheave import LiveBody, LiveCable, LiveJoint

Thing = TypeVar("Thing")
Callback = Callable[["Simulation"], object]


class Things(AbstractMapping, Generic[Thing]):  # type: ignore[type-arg]
    """The bodies, joints or cables of a simulation, by their names, in the order of the world."""

    def __init__(self, kind: str, find: Callable[[str], Thing], all_of: Callable[[], List[Any]]):
        self._kind = kind
        self._find = find
        self._all_of = all_of

    def __getitem__(self, name: str) -> Thing:
        return self._find(name)

    def __iter__(self) -> Iterator[str]:
        return iter([thing.name for thing in self._all_of()])

    def __len__(self) -> int:
        return len(self._all_of())

    def __contains__(self, name: object) -> bool:
        return any(thing.name == name for thing in self._all_of())

    def __repr__(self) -> str:
        return f"<{self._kind}: {', '.join(self) or 'none'}>"


class Simulation(_sheave.Simulation):
    """A world that is stepped, read and steered while it runs.

    Make one with sheave.load(). Bodies, joints and cables are handles that tell when what they
    refer to is no more. What is set is part of the state: hash, snapshot and restore hold.
    """

    __slots__ = ()  # a name that is misspelt must not become an attribute

    def __init__(self, scene: SceneLike, set: Optional[Mapping[str, Any]] = None):
        super().__init__(*source_of(scene), overrides_of(set))

    @property
    def bodies(self) -> "Things[LiveBody]":
        """By their names."""
        return Things("bodies", self.body, self._bodies)

    @property
    def joints(self) -> "Things[LiveJoint]":
        """By their names."""
        return Things("joints", self.joint, self._joints)

    @property
    def cables(self) -> "Things[LiveCable]":
        """By their names."""
        return Things("cables", self.cable, self._cables)

    def edit(self, changes: Optional[Callable[[Edit], object]] = None) -> Edit:
        """Changes what the world is made of, all or nothing.

        >>> with sim.edit() as edit:
        ...     edit.add_body({"name": "ball", "mobility": "free", "mass": 1,
        ...                    "shape": {"type": "sphere", "radius": 0.1}})
        ...     edit.remove_cable("rope")

        or `sim.edit(function)`, which is called with the Edit. What it does to energy and to the
        lengths of cables stands in its `report`.
        """
        edit = Edit(self._make_changes)
        if changes is None:
            return edit
        if not callable(changes):
            raise ArgumentError(f"changes: must be a function of the edit, was {changes!r}")
        with edit:
            changes(edit)
        return edit

    def _make_changes(self, text: str) -> Dict[str, Any]:
        answer = json.loads(self._answer(f'{{"type": "edit", "changes": {text}}}'))
        if answer["ok"]:
            return {"energy": answer["energy"],
                    "cables": {one["cable"]: one["added"] for one in answer["cables"]}}
        faults = [
            {key: fault[key] for key in ("pointer", "column", "code", "message", "value", "allowed")
             if key in fault}
            for fault in answer["errors"]
        ]
        lines = [f"{fault.get('pointer', '')}: {fault['message']}"
                 + (f"; was {fault['value']}" if fault.get("value") else "")
                 + (f"; allowed: {fault['allowed']}" if fault.get("allowed") else "")
                 for fault in faults]
        raise EditError("\n".join(lines), faults)

    def record(
        self,
        names: Sequence[str],
        steps: Optional[int] = None,
        every: int = 1,
        *,
        before_step: Optional[Callback] = None,
        before_substep: Optional[Callback] = None,
    ) -> Recording:
        """Steps, and keeps quantities: those at the start and after every `every` steps.

        Without `steps` until the end of the scene's duration. A trigger may end it earlier.
        """
        try:  # once: what gives its items may give others the next time
            listed = [names] if isinstance(names, str) else list(names)
        except Exception:
            raise ArgumentError(f"names: must be a list of strings, was {shown(names)}") from None
        rows = self._record(listed, steps, every, before_step, before_substep)
        return Recording(listed, rows, [self.unit(name) for name in listed])

    def plot(self, *names: str, steps: Optional[int] = None, every: int = 1, axes: Any = None,
             **options: Any) -> Any:
        """Records quantities and draws them over time with matplotlib: Recording.plot()."""
        return self.record(list(names), steps, every).plot(axes=axes, **options)

    def save_state(self, path: Union[str, "os.PathLike[str]"]) -> None:
        """Writes the state into a file, as `sheave run --save-state` does."""
        with open(path, "wb") as file:
            file.write(self.state_bytes())

    def load_state(self, path: Union[str, "os.PathLike[str]"]) -> None:
        """Puts a saved state in."""
        with open(path, "rb") as file:
            self.set_state_bytes(file.read())

    def video(self, path: Union[str, "os.PathLike[str]"], duration: Optional[float] = None,
              fps: float = 60.0, width: int = 1280, height: int = 720,
              progress: Optional[Callable[[float], object]] = None) -> None:
        """Steps, and writes a video with ffmpeg. `progress` is told what share is done."""
        from ._video import write_video

        write_video(self, path, duration, fps, width, height, progress)

    def _repr_png_(self) -> Optional[bytes]:
        return self.png() if _sheave.has_render else None

    def __repr__(self) -> str:
        return (f"<Simulation \"{self.title}\": {len(self.bodies)} bodies, {len(self.joints)} "
                f"joints, {len(self.cables)} cables, at {self.time:g} s>")


def load(scene: SceneLike, set: Optional[Mapping[str, Any]] = None) -> Simulation:
    """The simulation of a scene, with its controllers and triggers.

    `scene` is the path of a file, a JSON text, a dict or a sheave.Model. `set` replaces settings by
    their JSON pointers: {"/bodies/drum/mass": 3}. Raises SceneError with all faults.
    """
    return Simulation(scene, set)

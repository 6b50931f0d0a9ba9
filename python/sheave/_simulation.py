"""The Python part of a live simulation; most of it is in python/bindings/."""

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
    Tuple,
    TypeVar,
    Union,
)

from . import _sheave
from ._edit import Edit
from ._errors import ArgumentError, EditError, shown
from ._load import SceneLike, overrides_of, source_of
from ._recording import Recording
from ._sheave import LiveBody, LiveCable, LiveJoint
from ._statics import Modes, Statics, modes_of, statics_of

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

    sheave.load() makes a simulation. Bodies, joints and cables are handles, which raise StaleError
    once their object has been removed. Control values are part of the state, so hash, snapshot
    and restore include them.
    """

    # Besides this one no attribute can be set: a misspelt name must not become an attribute.
    __slots__ = ("_made",)

    def __init__(self, scene: SceneLike, set: Optional[Mapping[str, Any]] = None):
        super().__init__(*source_of(scene), overrides_of(set))
        self._made = True

    @property
    def bodies(self) -> "Things[LiveBody]":
        """The bodies by their names."""
        return Things("bodies", self.body, self._bodies)

    @property
    def joints(self) -> "Things[LiveJoint]":
        """The joints by their names."""
        return Things("joints", self.joint, self._joints)

    @property
    def cables(self) -> "Things[LiveCable]":
        """The cables by their names."""
        return Things("cables", self.cable, self._cables)

    def edit(self, changes: Optional[Callable[[Edit], object]] = None) -> Edit:
        """Changes the structure of the world: all changes are made, or none.

        >>> with sim.edit() as edit:
        ...     edit.add_body({"name": "ball", "mobility": "free", "mass": 1,
        ...                    "shape": {"type": "sphere", "radius": 0.1}})
        ...     edit.remove_cable("rope")

        or `sim.edit(function)`, which calls the function with the Edit. The edit's `report` has its
        effects on the energy and on the lengths of cables.
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
        """Steps and records observables at the start and after every `every` steps.

        `steps` None: until the end of the scene's duration. A trigger may end the run earlier.
        """
        try:  # iterate only once: a second iteration may give other items
            listed = [names] if isinstance(names, str) else list(names)
        except Exception:
            raise ArgumentError(f"names: must be a list of strings, was {shown(names)}") from None
        rows = self._record(listed, steps, every, before_step, before_substep)
        return Recording(listed, rows, [self.unit(name) for name in listed])

    def plot(self, *names: str, steps: Optional[int] = None, every: int = 1, axes: Any = None,
             **options: Any) -> Any:
        """Records observables and draws them over time with matplotlib: Recording.plot()."""
        return self.record(list(names), steps, every).plot(axes=axes, **options)

    def statics(self, *, move: bool = False, load_steps: int = 1) -> Statics:
        """The equilibrium near the present pose, with drives held in place.

        The simulation stays as it is, or with `move` goes to the equilibrium. `load_steps`: number
        of steps in which the loads grow from 0. Raises Error if no equilibrium is found.
        """
        return statics_of(self._statics(move, load_steps))

    def modes(self) -> Modes:
        """Natural frequencies, damping and shapes about the present pose."""
        return modes_of(self._modes())

    def save_state(self, path: Union[str, "os.PathLike[str]"]) -> None:
        """Writes the state into a file, as `sheave run --save-state` does."""
        with open(path, "wb") as file:
            file.write(self.state_bytes())

    def load_state(self, path: Union[str, "os.PathLike[str]"]) -> None:
        """Sets the simulation to a state from a file."""
        with open(path, "rb") as file:
            self.set_state_bytes(file.read())

    def video(self, path: Union[str, "os.PathLike[str]"], duration: Optional[float] = None,
              fps: float = 60.0, width: int = 1280, height: int = 720,
              progress: Optional[Callable[[float], object]] = None) -> None:
        """Steps and writes a video with ffmpeg. `progress` is called with the completed share."""
        from ._video import write_video

        write_video(self, path, duration, fps, width, height, progress)

    def __reduce__(self) -> Tuple[Any, ...]:
        """For pickle and copy: the scene and the state; events and warnings begin anew."""
        return _again, (type(self), self._scene_text(), self.state_bytes())

    def _repr_png_(self) -> Optional[bytes]:
        return self.png() if _sheave.has_render else None

    def __repr__(self) -> str:
        # A debugger shows the object whose scene was refused; it has no world.
        if not hasattr(self, "_made"):
            return "<Simulation of a scene that was refused>"
        return (f"<Simulation \"{self.title}\": {len(self.bodies)} bodies, {len(self.joints)} "
                f"joints, {len(self.cables)} cables, at {self.time:g} s>")


def _again(kind: Callable[[str], Simulation], scene: str, state: bytes) -> Simulation:
    """The simulation of a pickle."""
    simulation = kind(scene)
    simulation.set_state_bytes(state)
    return simulation


def load(scene: SceneLike, set: Optional[Mapping[str, Any]] = None) -> Simulation:
    """The simulation of a scene, with its controllers and triggers.

    `scene` is the path of a file, a JSON text, a dict or a sheave.Model. `set` maps JSON pointers
    of settings to new values: {"/bodies/drum/mass": 3}. Raises SceneError with all faults.
    """
    return Simulation(scene, set)

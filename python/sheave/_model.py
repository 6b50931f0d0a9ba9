"""Models built in Python."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any, Dict, List, Mapping, Optional, Sequence, Type, TypeVar, Union

from . import _sheave, parts
from ._errors import ArgumentError
from ._load import SceneLike, json_text, overrides_of, source_of
from ._part import Part, to_plain
from ._simulation import Simulation

LISTS: Dict[str, Type[Part]] = {
    "parameters": parts.Parameter,
    "bodies": parts.Body,
    "joints": parts.Joint,
    "cables": parts.Cable,
    "controllers": parts.Controller,
    "loads": parts.Load,
    "triggers": parts.Trigger,
    "colliders": parts.Collider,
    "camera_path": parts.CameraKey,
    "annotations": parts.Annotation,
    "paint": parts.Paint,
    "checks": parts.Check,
}
SINGLE: Dict[str, Type[Part]] = {"step": parts.Step, "ground": parts.Ground, "camera": parts.Camera}
PLAIN = ("name", "description", "gravity", "duration", "start")
A = TypeVar("A", bound=Part)


class Model:
    """A scene that is built part by part.

    >>> model = sheave.Model(gravity=(0, -9.81, 0), duration=1)
    >>> ball = model.add(sheave.Body("ball", mobility="free", mass=1,
    ...                              shape=sheave.Sphere(0.1)))
    >>> sim = model.simulation()
    """

    __slots__ = (*PLAIN, *SINGLE, *LISTS)

    def __init__(self, gravity: Sequence[float] = (0.0, -9.81, 0.0), duration: float = 1.0,
                 name: Optional[str] = None, description: Optional[str] = None,
                 step: Optional[parts.Step] = None, start: Optional[str] = None) -> None:
        self.gravity = gravity
        self.duration = duration
        self.name = name
        self.description = description
        self.step = step
        self.start = start
        self.ground: Optional[parts.Ground] = None
        self.camera: Optional[parts.Camera] = None
        self.parameters: List[parts.Parameter] = []
        self.bodies: List[parts.Body] = []
        self.joints: List[parts.Joint] = []
        self.cables: List[parts.Cable] = []
        self.controllers: List[parts.Controller] = []
        self.loads: List[parts.Load] = []
        self.triggers: List[parts.Trigger] = []
        self.colliders: List[parts.Collider] = []
        self.camera_path: List[parts.CameraKey] = []
        self.annotations: List[parts.Annotation] = []
        self.paint: List[parts.Paint] = []
        self.checks: List[parts.Check] = []

    def __setattr__(self, name: str, value: Any) -> None:
        if name in LISTS and not isinstance(value, list):
            if not isinstance(value, tuple):
                raise ArgumentError(f"{name}: must be a list, was {value!r}"[:300])
            value = list(value)
        if name in SINGLE and not (value is None or isinstance(value, (SINGLE[name], Mapping))):
            raise ArgumentError(f"{name}: must be a {SINGLE[name].__name__}, a dict or None, "
                                f"was {value!r}"[:300])
        object.__setattr__(self, name, value)

    def add(self, part: A) -> A:
        """Adds a body, joint, cable, annotation, ... or step, ground or camera; returns it."""
        given: Any = part
        for name, own in LISTS.items():
            if isinstance(given, own):
                getattr(self, name).append(given)
                return part
        for name, own in SINGLE.items():
            if isinstance(given, own):
                setattr(self, name, given)
                return part
        raise ArgumentError("part: must be a body, joint, cable, controller, trigger, load, collider, "
                            "annotation, camera key, paint, check, parameter, step, ground or camera, "
                            f"was {part!r}")

    def to_dict(self) -> Dict[str, Any]:
        """The scene as a dict."""
        scene: Dict[str, Any] = {"format": "sheave-scene/1"}
        for name in PLAIN:
            if getattr(self, name) is not None:
                scene[name] = to_plain(getattr(self, name))
        for name in SINGLE:
            if getattr(self, name) is not None:
                scene[name] = whole(getattr(self, name))
        for name in LISTS:
            if getattr(self, name):
                scene[name] = [whole(part) for part in getattr(self, name)]
        return scene

    def to_json(self, indent: Optional[int] = None) -> str:
        """The scene as a text with `indent` spaces per level; None: in one line."""
        if indent is not None and (isinstance(indent, bool) or not isinstance(indent, int)
                                   or not 0 <= indent <= 100):
            raise ArgumentError(f"indent: must be an integer from 0 to 100, or None, was {indent!r}"[:300])
        return json.dumps(json.loads(json_text(self)), indent=indent)

    def save(self, path: Union[str, "os.PathLike[str]"]) -> None:
        """Writes the scene into a file."""
        Path(path).write_text(self.to_json(2) + "\n", encoding="utf-8")

    @classmethod
    def from_dict(cls, scene: Mapping[str, Any]) -> "Model":
        """The model of a scene."""
        model = cls(scene.get("gravity", (0.0, 0.0, 0.0)), scene.get("duration", 1.0))
        for key, value in scene.items():
            if key in LISTS:
                setattr(model, key, [LISTS[key].from_dict(one) for one in value])
            elif key in SINGLE:
                setattr(model, key, SINGLE[key].from_dict(value))
            elif key in PLAIN:
                setattr(model, key, value)
            elif key != "format":
                raise ArgumentError(f"a scene has no key {key!r}")
        return model

    @classmethod
    def load(cls, scene: SceneLike, set: Optional[Mapping[str, Any]] = None) -> "Model":
        """The checked model of a file, a text or a dict; raises SceneError with all faults."""
        return cls.from_dict(json.loads(_sheave.canonical(*source_of(scene), overrides_of(set))))

    def simulation(self, set: Optional[Mapping[str, Any]] = None) -> Simulation:
        """The simulation of the model; raises SceneError with all faults."""
        return Simulation(self, set)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Model):
            return NotImplemented
        return self.to_json() == other.to_json()

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return (f"<Model: {len(self.bodies)} bodies, {len(self.joints)} joints, "
                f"{len(self.cables)} cables>")


def whole(part: Any) -> Any:
    """A part of the scene itself, written in full, not a reference to one."""
    return part.to_dict() if isinstance(part, Part) else to_plain(part)

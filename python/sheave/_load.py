"""Scenes as paths, texts, dicts and models."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any, Dict, Mapping, NamedTuple, Optional, Protocol, Union

from ._errors import ArgumentError, SceneError

class HasDict(Protocol):
    """An object that can return its scene as a dict."""

    def to_dict(self) -> Dict[str, Any]:
        """The scene as a dict."""
        ...


SceneLike = Union[str, "os.PathLike[str]", Mapping[str, Any], HasDict]


class Source(NamedTuple):
    """A scene for the compiled module."""

    text: str
    name: str
    is_file: bool


def plain(value: Any) -> Any:
    """Converts NumPy arrays and numbers, and models, to types that json can write."""
    if hasattr(value, "tolist"):
        return value.tolist()
    if hasattr(value, "to_dict"):
        return value.to_dict()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, Mapping):
        return dict(value)
    raise TypeError(f"{type(value).__name__} cannot be written as JSON")


def json_text(value: Any, name: str = "scene") -> str:
    """The value as JSON; the error for a non-finite number contains `name`."""
    try:
        return json.dumps(value, default=plain, allow_nan=False)
    except (TypeError, ValueError, RecursionError) as error:
        raise ArgumentError(f"{name}: must consist of values that JSON has: {error}") from None


def source_of(scene: SceneLike) -> Source:
    """The text of a scene, or the path of its file."""
    if isinstance(scene, Mapping) or (hasattr(scene, "to_dict") and not isinstance(scene, type)):
        return Source(json_text(scene), "<dict>", False)
    if isinstance(scene, os.PathLike):
        return Source(os.fspath(scene), "", True)
    if isinstance(scene, str):
        if scene.lstrip().startswith("{") or "\n" in scene:
            return Source(scene, "<text>", False)
        return Source(scene, "", True)
    raise ArgumentError(
        "scene: must be a path, a JSON text, a dict or a sheave.Model, was " + repr(scene)[:80]
    )


def overrides_of(settings: Optional[Mapping[str, Any]]) -> Dict[str, str]:
    """The values as JSON texts, by JSON pointers of settings."""
    if settings is None:
        return {}
    if not isinstance(settings, Mapping):
        raise ArgumentError(
            "set: must be a dict from JSON pointers to values, was " + repr(settings)[:80]
        )
    return {str(pointer): json_text(value, str(pointer)) for pointer, value in settings.items()}


def read_text(path: Union[str, Path]) -> str:
    """The text of a user's file; raises SceneError if it cannot be read."""
    try:
        return Path(path).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise SceneError(f"{path}: {error}") from None

"""What is raised, and what it tells."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Iterable, Mapping, Optional, Tuple


@dataclass(frozen=True)
class Fault:
    """One thing that is wrong."""

    file: str = ""
    """Of the scene, or the option that has set the value."""
    line: int = 0
    """From 1; 0: it has no place in a text."""
    column: int = 0
    """From 1, in characters."""
    pointer: str = ""
    """JSON pointer of the setting, which may be missing."""
    code: str = "meaning"
    """Kind of the fault (docs/explanation/errors.md)."""
    message: str = ""
    value: str = ""
    """As it stands in the text, shortened."""
    allowed: str = ""
    """What would be right, if the message does not say it."""

    def __str__(self) -> str:
        place = self.file
        if self.line:
            place += f":{self.line}:{self.column}"
        parts = [part for part in (place, self.pointer) if part]
        if self.value:
            parts.append(f"value {self.value}")
        return ": ".join([*parts, self.message])


class Error(Exception):
    """Something that was asked for cannot be; nothing has changed."""

    faults: Tuple[Fault, ...]

    def __init__(self, message: str = "", faults: Optional[Iterable[Mapping[str, Any]]] = None):
        super().__init__(message)
        self.faults = tuple(Fault(**fault) for fault in faults or ())

    def __str__(self) -> str:
        return str(self.args[0]) if self.args else ""


class SceneError(Error, ValueError):
    """A scene that cannot be simulated; `faults` has all that is wrong with it."""


class EditError(Error, ValueError):
    """An edit that cannot be; `faults` has all that is wrong, with pointers into its changes."""


class ArgumentError(Error, TypeError, ValueError):
    """An argument that is not what is allowed."""


class UnknownNameError(Error, KeyError):
    """There is no body, joint, cable, quantity or control of this name."""


class StaleError(Error, ReferenceError):
    """What a handle refers to is no more."""


class StateError(Error, ValueError):
    """A state that does not belong to this world, or is none."""


class DivergenceError(Error, ArithmeticError):
    """A step has come to no state that means anything; the world is as it was before it."""


def shown(value: Any) -> str:
    """For a message, however it looks."""
    try:
        return repr(value)[:80]
    except Exception:
        return f"<{type(value).__name__}>"

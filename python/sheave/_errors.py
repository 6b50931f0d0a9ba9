"""The exceptions of sheave and the faults that they contain."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Iterable, Mapping, Optional, Tuple


@dataclass(frozen=True)
class Fault:
    """A single fault."""

    file: str = ""
    """The scene's file, or the option that set the value."""
    line: int = 0
    """From 1; 0: the fault has no position in a text."""
    column: int = 0
    """From 1, in characters."""
    pointer: str = ""
    """JSON pointer of the setting, which may be missing."""
    code: str = "meaning"
    """Kind of the fault (docs/explanation/errors.md)."""
    message: str = ""
    value: str = ""
    """The value as written in the text, shortened."""
    allowed: str = ""
    """The allowed values, if the message does not name them."""

    def __str__(self) -> str:
        place = self.file
        if self.line:
            place += f":{self.line}:{self.column}"
        parts = [part for part in (place, self.pointer) if part]
        if self.value:
            parts.append(f"value {self.value}")
        return ": ".join([*parts, self.message])


class Error(Exception):
    """A request was refused; nothing has changed."""

    faults: Tuple[Fault, ...]

    def __init__(self, message: str = "", faults: Optional[Iterable[Mapping[str, Any]]] = None):
        super().__init__(message)
        self.faults = tuple(Fault(**fault) for fault in faults or ())

    def __str__(self) -> str:
        return str(self.args[0]) if self.args else ""


class SceneError(Error, ValueError):
    """A scene cannot be simulated; `faults` lists all its faults."""


class EditError(Error, ValueError):
    """An edit was refused; `faults` lists all its faults, with pointers into its changes."""


class ArgumentError(Error, TypeError, ValueError):
    """An argument has a value that is not allowed."""


class UnknownNameError(Error, KeyError):
    """There is no body, joint, cable, observable or control with this name."""


class StaleError(Error, ReferenceError):
    """The body, joint or cable of a handle has been removed."""


class StateError(Error, ValueError):
    """The data is no state, or a state of another world."""


class DivergenceError(Error, ArithmeticError):
    """A step diverged; the world is in the state before that step."""


def shown(value: Any) -> str:
    """A short text of any value, for a message."""
    try:
        return repr(value)[:80]
    except Exception:
        return f"<{type(value).__name__}>"

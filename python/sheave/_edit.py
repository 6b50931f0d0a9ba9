"""Edits of live worlds."""

from __future__ import annotations

from types import TracebackType
from typing import Any, Callable, Dict, List, Optional, Type

from ._changes import Changes
from ._errors import Error
from ._load import json_text
from ._part import Part, to_plain


class Edit(Changes):
    """A list of changes: at the end of the `with` all of them are made, or none."""

    def __init__(self, make: Callable[[str], Dict[str, Any]]):
        self._make = make
        self._changes: List[Dict[str, Any]] = []
        self.report: Optional[Dict[str, Any]] = None
        """The effects of the edit: the change of the energy [J] and of cable lengths [m]."""

    def _add(self, kind: str, settings: Dict[str, Any]) -> None:
        if self.report is not None:
            raise Error("this edit has been made; begin a new one")
        change: Dict[str, Any] = {"type": kind}
        for name, value in settings.items():
            if name == "self" or value is None:
                continue
            # An added part is written in full; a part that the change refers to, by its name.
            is_whole = isinstance(value, Part) and kind == "add_" + name
            change[name.rstrip("_")] = value.to_dict() if is_whole else to_plain(value)
        self._changes.append(change)

    def make(self) -> None:
        """Makes the changes now; a `with` statement calls this at its end."""
        if self.report is not None:
            raise Error("this edit has been made; begin a new one")
        self.report = self._make(json_text(self._changes, "changes"))

    def __enter__(self) -> "Edit":
        return self

    def __exit__(self, kind: Optional[Type[BaseException]], error: Optional[BaseException],
                 trace: Optional[TracebackType]) -> None:
        if kind is None and self.report is None:
            self.make()

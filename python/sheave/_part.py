"""The base class of the parts of a model."""

from __future__ import annotations

import difflib
from typing import Any, ClassVar, Dict, Mapping, Tuple, Type, TypeVar, Union

from ._errors import ArgumentError
from ._load import json_text

BodyLike = Union[str, "Part"]
"""The name of a body, the body itself, or "world"."""

P = TypeVar("P", bound="Part")


def keys(names: str) -> Dict[str, str]:
    """The JSON keys of attribute names: `from_` is "from"."""
    return {name: name.rstrip("_") for name in names.split()}


class Part:
    """An object of a scene. Its attributes have the names of its keys and keep the given values.

    An attribute without a value has the default of the format. All values are checked together
    when the model is loaded.
    """

    _kind: ClassVar[str] = ""
    _type: ClassVar[str] = ""
    _keys: ClassVar[Dict[str, str]] = {}

    def __init__(self, given: Mapping[str, Any]) -> None:
        values = {self._keys[name]: value for name, value in given.items()
                  if name in self._keys and value is not None}
        object.__setattr__(self, "_values", values)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_") or name not in self._keys:
            raise AttributeError(self._unknown(name))
        return self.__dict__["_values"].get(self._keys[name])

    def __setattr__(self, name: str, value: Any) -> None:
        if name not in self._keys:
            raise AttributeError(self._unknown(name))
        values = self.__dict__["_values"]
        if value is None:
            values.pop(self._keys[name], None)
        else:
            values[self._keys[name]] = value

    def __delattr__(self, name: str) -> None:
        setattr(self, name, None)

    @classmethod
    def _unknown(cls, name: str) -> str:
        near = difflib.get_close_matches(name, cls._keys, 3)
        hint = f"; near it are {', '.join(near)}" if near else ""
        return f"{cls.__name__} has no setting {name!r}{hint}"

    def to_dict(self) -> Dict[str, Any]:
        """The part as an object of a scene."""
        values: Dict[str, Any] = {"type": self._type} if self._type else {}
        for key, value in self.__dict__["_values"].items():
            values[key] = to_plain(value)
        return values

    @classmethod
    def from_dict(cls: Type[P], values: Mapping[str, Any]) -> P:
        """The part of a scene's dict; for a base class such as Joint, "type" selects the class."""
        chosen = cls._class_of(values)
        known = {key: name for name, key in chosen._keys.items()}
        given = {}
        for key, value in values.items():
            if key == "type" and chosen._type:
                continue
            if key not in known:
                raise ArgumentError(chosen._unknown(str(key)))
            given[known[key]] = value
        made = chosen.__new__(chosen)
        Part.__init__(made, {})
        for name, value in given.items():
            setattr(made, name, chosen._parsed(name, value))
        return made

    @classmethod
    def _class_of(cls: Type[P], values: Mapping[str, Any]) -> Type[P]:
        types = [own for own in (cls, *cls.__subclasses__()) if own._type]
        if not types:
            return cls
        for own in types:
            if values.get("type") == own._type:
                return own
        raise ArgumentError(f"type: must be one of {', '.join(own._type for own in types)}, was "
                            f"{values.get('type')!r}")

    @classmethod
    def _parsed(cls, name: str, value: Any) -> Any:
        from . import parts

        nested = {"shape": parts.Shape, "shapes": parts.Shape, "links": parts.Link}.get(name)
        if nested is None or not isinstance(value, (Mapping, list, tuple)):
            return value
        if isinstance(value, Mapping):
            return nested.from_dict(value)
        return [one if isinstance(one, Part) else nested.from_dict(one) for one in value]

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Part) or type(self) is not type(other):
            return NotImplemented
        return json_text(self.to_dict()) == json_text(other.to_dict())

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        shown = ", ".join(f"{name}={self.__dict__['_values'][key]!r}"
                          for name, key in self._keys.items() if key in self.__dict__["_values"])
        return f"{type(self).__name__}({shown})"

    def __copy__(self: P) -> P:
        return self.__deepcopy__({})

    def __deepcopy__(self: P, memo: Dict[int, Any]) -> P:
        return type(self).from_dict(self.to_dict())

    def __reduce__(self) -> Tuple[Any, ...]:
        return (type(self).from_dict, (self.to_dict(),))


def to_plain(value: Any) -> Any:
    """The value in JSON types; a body that another part refers to becomes its name."""
    if isinstance(value, Part):
        return value.name if value._kind == "body" else value.to_dict()
    if isinstance(value, Mapping):
        return {str(key): to_plain(one) for key, one in value.items()}
    if isinstance(value, (list, tuple)):
        return [to_plain(one) for one in value]
    if hasattr(value, "tolist"):
        return value.tolist()
    return value

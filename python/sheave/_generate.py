"""Writes parts.py and _changes.py from the tables that scenes are read with.

    PYTHONPATH=build/release/python /usr/bin/python3 -m sheave._generate python/sheave
"""

from __future__ import annotations

import keyword
import sys
import textwrap
from pathlib import Path
from typing import Any, Dict, List

from . import _sheave

TYPES = {
    "number": "float",
    "integer": "int",
    "boolean": "bool",
    "text": "str",
    "vector": "Sequence[float]",
    "quaternion": "Sequence[float]",
    "body": "BodyLike",
    "numbers": "Sequence[float]",
    "vectors": "Sequence[Sequence[float]]",
    "texts": "Sequence[str]",
}
# Suffix of the class names of each kind.
SUFFIXES = {"joint": "Joint", "controller": "Controller", "load": "Load", "shape": "", "link": "Link"}
BASES = {"joint": "Joint", "controller": "Controller", "load": "Load", "shape": "Shape", "link": "Link"}
PLAIN = ["step", "body", "cable", "collider", "ground", "trigger", "camera", "camera key",
         "annotation", "paint", "check", "parameter",
         "rotation"]


def camel(words: str) -> str:
    """convex-hull: ConvexHull."""
    return "".join(word[:1].upper() + word[1:] for word in words.replace(" ", "-").split("-"))


def class_name(kind: str, variant: str) -> str:
    """Class name of a registered type, as in C++."""
    return camel(variant) + SUFFIXES[kind]


def identifier(name: str) -> str:
    """The argument name of a key; Python keywords such as `from` get an underscore."""
    return name + "_" if keyword.iskeyword(name) else name


def type_of_member(member: Dict[str, Any]) -> str:
    """The Python type of a member."""
    name = member["format"]
    own = {"body change": "Mapping[str, Any]", "step change": "Mapping[str, Any]"}.get(name)
    own = own or f"Union[{camel(name)}, Mapping[str, Any]]"
    return f"Sequence[{own}]" if member["list"] else own


def type_of_field(field: Dict[str, Any]) -> str:
    """The Python type of a field."""
    if field["kind"] == "choice":
        return "Literal[" + ", ".join(f'"{choice}"' for choice in field["choices"]) + "]"
    return TYPES[field["kind"]]


def description(field: Dict[str, Any]) -> str:
    """The meaning of a field, its allowed values and its default."""
    text = f"{field['meaning']} ({field['allowed']}"
    if field["required"]:
        text += "; required"
    elif field["default"]:
        text += f"; default: {field['default']}"
    return text + ")"


def wrapped(text: str, indent: str, hanging: str = "") -> List[str]:
    """The text in lines of at most 100 characters."""
    return textwrap.wrap(text, 100, initial_indent=indent, subsequent_indent=indent + hanging,
                         break_on_hyphens=False, break_long_words=False)


class Setting:
    """A key of an object of a scene."""

    def __init__(self, name: str, type_name: str, text: str, required: bool):
        self.name = name
        self.python_name = identifier(name)
        self.type_name = type_name
        self.text = text
        self.required = required


def settings_of(table: Dict[str, Any]) -> List[Setting]:
    """The keys of a format or of a variant, required ones first."""
    fields = [Setting(f["name"], type_of_field(f), description(f), f["required"])
              for f in table["fields"]]
    members = [Setting(m["name"], type_of_member(m), m["meaning"], m["required"])
               for m in table["members"]]
    return sorted(fields + members, key=lambda setting: not setting.required)


def documented(settings: List[Setting], indent: str) -> List[str]:
    """The lines of a docstring that describe the settings."""
    lines: List[str] = []
    for setting in settings:
        lines += wrapped(f"{setting.python_name}: {setting.text}", indent, "    ")
    return lines


def arguments(settings: List[Setting], indent: str) -> List[str]:
    """The arguments of a function; optional ones are keyword-only."""
    lines = [f"{indent}{s.python_name}: {s.type_name}," for s in settings if s.required]
    optional = [s for s in settings if not s.required]
    if optional:
        lines.append(f"{indent}*,")
    lines += [f"{indent}{s.python_name}: Optional[{s.type_name}] = None," for s in optional]
    return lines


def class_lines(name: str, base: str, kind: str, meaning: str, settings: List[Setting],
                type_name: str = "") -> List[str]:
    """A class with its docstring, its annotations and its constructor."""
    lines = ["", "", f"class {name}({base}):"]
    lines += wrapped('"""' + meaning[:1].upper() + meaning[1:] + ".", "    ")
    lines += ["", *documented(settings, "    "), '    """', ""]
    lines.append(f'    _kind = "{kind}"')
    if type_name:
        lines.append(f'    _type = "{type_name}"')
    words = textwrap.wrap(" ".join(s.python_name for s in settings), 80)
    lines += ["    _keys = keys(", *(f'        "{line} "' for line in words), "    )", ""]
    lines += [f"    {s.python_name}: {s.type_name if s.required else f'Optional[{s.type_name}]'}"
              for s in settings]
    lines += ["", "    def __init__(", "        self,", *arguments(settings, "        "),
              "    ) -> None:", "        super().__init__(locals())"]
    return lines


HEADER = '''"""{what}

Made by sheave._generate from the tables that scenes are read with: do not edit.
"""

from __future__ import annotations

from typing import Any, {typing}
'''


def parts_text() -> str:
    """The source of parts.py: the classes of a model's parts."""
    formats = _sheave.formats()
    lines = [HEADER.format(what="The parts of a model: bodies, shapes, joints, cables, links.",
                           typing="Literal, Mapping, Optional, Sequence, Union"),
             "from ._part import BodyLike, Part, keys"]
    for kind, base in BASES.items():
        meaning = formats[kind]["meaning"]
        lines += ["", "", f"class {base}(Part):",
                  f'    """{meaning[:1].upper() + meaning[1:]}."""', "", f'    _kind = "{kind}"']
        for variant in formats[kind]["variants"]:
            table = {"fields": formats[kind]["fields"] + variant["fields"],
                     "members": formats[kind]["members"] + variant["members"]}
            lines += class_lines(class_name(kind, variant["name"]), base, kind, variant["meaning"],
                                 settings_of(table), variant["name"])
    for kind in PLAIN:
        lines += class_lines(camel(kind), "Part", kind, formats[kind]["meaning"],
                             settings_of(formats[kind]))
    names = sorted([*BASES.values(), *map(camel, PLAIN),
                    *(class_name(kind, v["name"]) for kind in BASES
                      for v in formats[kind]["variants"])])
    lines += ["", "", "__all__ = [", *(f'    "{name}",' for name in names), "]", ""]
    return "\n".join(lines)


def changes_text() -> str:
    """The source of _changes.py: the methods of an edit."""
    change = _sheave.formats()["change"]
    used = sorted({camel(m["format"]) for v in change["variants"] for m in v["members"]
                   if not m["format"].endswith(" change")})
    lines = [HEADER.format(what="What can be changed of a world that lives.",
                           typing="Dict, Literal, Mapping, Optional, Sequence, Union"),
             "from ._part import BodyLike", f"from .parts import {', '.join(used)}", "", "",
             "class Changes:",
             '    """One method for each type of change (docs/how-to/editing.md)."""', "",
             "    def _add(self, kind: str, settings: Dict[str, Any]) -> None:",
             "        raise NotImplementedError"]
    for variant in change["variants"]:
        settings = settings_of(variant)
        meaning = variant["meaning"]
        lines += ["", f"    def {variant['name']}(", "        self,",
                  *arguments(settings, "        "), "    ) -> None:"]
        lines += wrapped('"""' + meaning[:1].upper() + meaning[1:] + ".", "        ")
        lines += ["", *documented(settings, "        "), '        """']
        lines.append(f'        self._add("{variant["name"]}", locals())')
    return "\n".join(lines) + "\n"


def main() -> None:
    """Writes both files into a folder."""
    folder = Path(sys.argv[1])
    (folder / "parts.py").write_text(parts_text(), encoding="utf-8")
    (folder / "_changes.py").write_text(changes_text(), encoding="utf-8")


if __name__ == "__main__":
    main()

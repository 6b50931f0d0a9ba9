"""Calls of everything that the module has, with anything: for test_fuzz.py and dev/fuzz-python.

A call may only come back, or raise what sheave promises: its own errors, or the TypeError of a
call that Python itself refuses. Whatever else it raises is a fault, and a simulation that a
refused call has changed is one, too.
"""

from __future__ import annotations

import copy
import gc
import inspect
import random
import re
from typing import Any, Callable, Dict, List

import numpy as np
from conftest import ATWOOD, ROOT

import sheave

# What Python says of calls that do not fit the signature; everything else must be sheave's own.
SIGNATURE = re.compile(r"argument|positional|keyword|incompatible (function|constructor)|takes|"
                       r"No constructor defined|readonly|setter|can't set|unhashable|not subscriptable|"
                       r"abstract|unsupported operand|not supported between")
# What needs files of its own, or opens windows; classes that are made by others, not by users.
LEFT_OUT = {"save_state", "load_state", "save", "video", "plot", "_repr_png_", "__reduce__",
            "Edit", "Fault", "Recording", "Bounds", "Part"}
SPECIAL = {"_record", "_answer", "__len__", "__eq__", "__hash__", "__repr__", "__iter__", "__copy__", "__getitem__"}
SLOW = {"step", "run", "record", "_record", "render", "png", "Batch", "VectorEnvironment"}
NUMBERS = (0, 1, -1, 2, 3, 7, 1000, 2**31, 2**63 - 1, -2**63, 2**64, 10**30, 0.0, -0.0, 0.5, 1e-300, 1e300, 1e9,
           -1e-3, float("nan"), float("inf"), True, 3 + 0j)
SETTABLE = (sheave.Simulation, sheave.Batch, sheave.Model, sheave.Part, sheave.LiveBody, sheave.LiveJoint,
            sheave.LiveCable, sheave.Snapshot)


class Strange:
    """An object whose special methods do what nobody expects."""

    def __init__(self, caller: "Caller"):
        self.caller = caller

    def act(self) -> Any:
        """Raises, or changes what the caller holds meanwhile."""
        kind = self.caller.random.randrange(4)
        if kind == 0:
            raise ZeroDivisionError("on purpose")
        if kind == 1:
            for values in self.caller.lists:
                values.clear()
        if kind == 2 and self.caller.depth < 2:
            self.caller.call_one()
        return self.caller.random.choice((0, 1, 2, 5))

    def __float__(self) -> float:
        return float(self.act())

    def __index__(self) -> int:
        return int(self.act())

    def __len__(self) -> int:
        return int(self.act())

    def __iter__(self) -> Any:
        return iter([self] * int(self.act()))

    def __getitem__(self, key: Any) -> Any:
        return self.act()

    def __call__(self, *given: Any) -> Any:
        return self.act()

    def __repr__(self) -> str:
        return self.caller.random.choice(["strange", "\ud800", "x" * 10000, "\n"])

    def __bool__(self) -> bool:
        return bool(self.act())


class Fault(AssertionError):
    """What a call must not do."""


class Caller:
    """Calls at random, the same for the same seed; `log` is told of each before it is made."""

    def __init__(self, seed: int, log: Callable[[str], object] = lambda line: None,
                 largest_steps: int = 20):
        self.random = random.Random(seed)
        self.log = log
        self.largest_steps = largest_steps
        self.depth = 0
        self.calls = 0
        self.raised: Dict[str, int] = {}
        self.lists: List[List[Any]] = []
        self.simulations = [sheave.load(scene) for scene in (
            ATWOOD, str(ROOT / "scenes/paper/pulley.json"),
            str(ROOT / "scenes/machines/brake-failure.json"))]
        self.objects: List[Any] = [*self.simulations, sheave.Batch(ATWOOD, 3, threads=2),
                                   sheave.Model(), sheave]
        self.names = sorted({name for sim in self.simulations
                             for name in (*sim.bodies, *sim.joints, *sim.cables, *sim.observables[:50])})

    def number(self) -> Any:
        if self.random.random() < 0.3:
            return self.random.uniform(-10, 10)
        return self.random.choice(NUMBERS)

    def string(self) -> str:
        return self.random.choice((
            self.random.choice(self.names), "", "world", "x", "\x00", "\ud800", "ä" * 300, "/bodies/heavy/mass",
            "heavy.force_y", "wheel.drive", "cable.0.tension", "{}", "[1", '{"format": "sheave-scene/1"}',
            "tension", "body", "first", "no-such-file.json", "/bodies/0", "angle", "t"))

    def array(self) -> Any:
        shape = tuple(self.random.choice((0, 1, 2, 3, 4, 7)) for _ in range(self.random.randrange(4)))
        kind = self.random.choice(("f8", ">f8", "f4", "i8", "?", "c16", "O", "U3", "u1", "M8[s]"))
        made = np.ones(shape, kind)
        if made.ndim and self.random.random() < 0.3:
            made = made[::-1].T
        return made

    def value(self, depth: int = 0) -> Any:
        kind = self.random.randrange(14)
        if kind < 4:
            return self.number()
        if kind < 6:
            return self.string()
        if kind == 6:
            return self.array()
        if kind == 7:
            return self.random.choice(self.objects)
        if kind == 8:
            return self.random.choice((None, b"", b"\x00" * 40, bytes(range(256)), bytearray(b"x"), range(3), int,
                                       sheave.Body, slice(None), np.float32(1), np.int64(3), lambda *given: None))
        if kind == 9:
            return Strange(self)
        if kind == 10:
            return copy.deepcopy(ATWOOD)
        if depth > 2:
            return self.number()
        if kind == 11:
            return {self.string(): self.value(depth + 1) for _ in range(self.random.randrange(4))}
        values = [self.value(depth + 1) if self.random.random() < 0.3 else self.number()
                  for _ in range(self.random.choice((0, 1, 2, 3, 3, 3, 4, 7)))]
        if kind == 12:
            self.lists = [*self.lists[-5:], values]
            return values
        return tuple(values)

    def arguments(self, own: Any, name: str) -> "tuple[List[Any], Dict[str, Any]]":
        given = [self.value() for _ in range(self.random.choice((0, 0, 1, 1, 2, 3)))]
        try:
            known = list(inspect.signature(own).parameters)
        except (TypeError, ValueError):
            known = re.findall(r"(\w+): ", getattr(own, "__doc__", None) or "")
        known = [one for one in known if one not in ("self", "args", "kwargs", "kw", "options")]
        if name == "answer":
            given = [self.string()]
        named = {one: self.value() for one in self.random.sample(known, min(len(known), self.random.randrange(3)))}
        if name in SLOW:
            given = [self.small(one) for one in given]
            named = {key: self.small(one) for key, one in named.items()}
            if name == "record":
                named.setdefault("steps", self.random.randrange(self.largest_steps))
            elif name == "run" and not given:
                named.setdefault("until", 0.1)
            elif name in ("render", "png"):
                named.setdefault("width", 16)
                named.setdefault("height", 16)
            elif name in ("Batch", "VectorEnvironment"):
                named.setdefault("threads", self.random.choice((1, 2, 3)))
        return given, named

    def small(self, value: Any) -> Any:
        """Numbers that are right but take long are made small; wrong ones stay."""
        if isinstance(value, (int, float)) and not isinstance(value, bool) and value > self.largest_steps:
            return value if value > 2**60 and value != 2**63 - 1 else self.random.randrange(self.largest_steps)
        return value

    def call_one(self) -> None:
        """One call, or attribute read or written, of something."""
        self.depth += 1
        try:
            thing = self.random.choice(self.objects)
            names = names_of(thing)
            if not names:
                return
            self.call(thing, self.random.choice(names))
        finally:
            self.depth -= 1

    def call(self, thing: Any, name: str) -> None:
        self.calls += 1
        kind = type(thing).__name__ if thing is not sheave else "sheave"
        simulation = thing if isinstance(thing, sheave.Simulation) else None
        before = self.hash_of(simulation)
        text = f"{kind}.{name}"
        nested = self.depth > 1
        try:
            if self.random.random() < 0.05 and isinstance(thing, SETTABLE):
                given = self.value()
                text += f" = {shown(given)}"
                self.log(text)
                setattr(thing, name, given)
                return
            own = getattr(thing, name)
            kept_there = (isinstance(thing, (sheave.Model, sheave.Part))
                          and not any(getattr(own, "__self__", None) is one for one in (thing, type(thing))))
            if not callable(own) or kept_there:  # what has been put there is not the module's to answer for
                self.keep(own)
                return
            given, named = self.arguments(own, name)
            if name.startswith("__"):  # operators, whose number of operands is Python's
                given, named = [self.value()] * (name in ("__eq__", "__getitem__")), {}
            text += f"({', '.join([*map(shown, given), *(f'{key}={shown(one)}' for key, one in named.items())])})"
            self.log(text)
            self.keep(own(*given, **named))
        except BaseException as error:  # noqa: B902 - what it is decides
            self.judge(text, error, simulation, before, nested)

    def hash_of(self, simulation: Any) -> Any:
        try:
            return None if simulation is None else simulation.hash
        except sheave.Error:
            return None

    def judge(self, text: str, error: BaseException, simulation: Any, before: Any, nested: bool) -> None:
        kind = type(error).__name__
        self.raised[kind] = self.raised.get(kind, 0) + 1
        if isinstance(error, Fault):
            raise error
        allowed = (isinstance(error, (sheave.Error, ZeroDivisionError))
                   or (isinstance(error, (TypeError, AttributeError)) and SIGNATURE.search(str(error)))
                   or (isinstance(error, AttributeError) and ("has no" in str(error) or " = " in text))
                   or isinstance(error, StopIteration))
        if not allowed or not str(error) and not isinstance(error, (ZeroDivisionError, StopIteration)):
            raise Fault(f"{text}: {kind}: {error}") from error
        # A step that is interrupted by what a callable raises keeps the steps before it.
        keeps = not re.search(r"\.(step|run|record|_record|edit)\b", text) and not nested
        if keeps and before is not None and "Strange" not in text and self.hash_of(simulation) != before:
            raise Fault(f"{text}: raised {kind} and has changed the state: {error}") from error

    def keep(self, value: Any) -> None:
        """Things that came of calls are called as well."""
        if isinstance(value, (BaseException, sheave.Fault)):
            return
        if type(value).__module__.startswith("sheave") and len(self.objects) < 40:
            self.objects.append(value)
        elif isinstance(value, np.ndarray):
            value.sum() if value.dtype.kind in "fiub" else None
            if len(self.objects) < 40 and self.random.random() < 0.1:
                self.lists = [*self.lists[-5:], list(value.ravel()[:5])]
        if len(self.objects) >= 40:
            del self.objects[self.random.randrange(6, len(self.objects))]

    def run(self, calls: int) -> None:
        """So many calls; then the simulations must still step."""
        for _ in range(calls):
            self.call_one()
            if self.random.random() < 0.002:
                gc.collect()
        for simulation in self.simulations:
            try:
                simulation.step(2)
            except (sheave.DivergenceError, ZeroDivisionError):
                pass


def names_of(thing: Any) -> List[str]:
    """What can be called or read of it that is sheave's own: not what mappings and tuples bring along."""
    if thing is sheave:
        return [name for name in sheave.__all__ if name not in LEFT_OUT
                and not (isinstance(getattr(sheave, name), type) and issubclass(getattr(sheave, name), BaseException))]
    owned = {name for kind in type(thing).__mro__ if kind.__module__.startswith("sheave") for name in vars(kind)}
    return sorted(name for name in {*owned, *vars_of(thing)} - LEFT_OUT
                  if not name.startswith("_") or name in SPECIAL)


def vars_of(thing: Any) -> List[str]:
    try:
        return list(vars(thing))
    except TypeError:
        return []


def shown(value: Any) -> str:
    """Of a call's arguments, for the log."""
    if isinstance(value, Strange):
        return "Strange()"
    try:
        text = repr(value)
    except Exception:  # noqa: BLE001 - repr of something strange inside
        text = f"<{type(value).__name__}>"
    return text.encode("ascii", "backslashreplace").decode()[:200].replace("\n", " ")

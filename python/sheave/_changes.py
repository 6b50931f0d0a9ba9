"""What can be changed of a world that lives.

Made by sheave._generate from the tables that scenes are read with: do not edit.
"""

from __future__ import annotations

from typing import Any, Dict, Literal, Mapping, Optional, Sequence, Union

from ._part import BodyLike
from .parts import Body, Cable, Collider, Joint, Link


class Changes:
    """One method for each type of change (docs/how-to/editing.md)."""

    def _add(self, kind: str, settings: Dict[str, Any]) -> None:
        raise NotImplementedError

    def add_body(
        self,
        body: Union[Body, Mapping[str, Any]],
    ) -> None:
        """Adds a body at the place of its definition; later changes of the edit may name it.

        body: as in scenes; position and velocity are those of now
        """
        self._add("add_body", locals())

    def add_joint(
        self,
        joint: Union[Joint, Mapping[str, Any]],
    ) -> None:
        """Adds a joint of the bodies as they are now, at its coordinates' zero.

        joint: as in scenes; points and directions are those of now
        """
        self._add("add_joint", locals())

    def add_cable(
        self,
        cable: Union[Cable, Mapping[str, Any]],
    ) -> None:
        """Adds a cable between bodies as they are now.

        cable: as in scenes
        """
        self._add("add_cable", locals())

    def add_collider(
        self,
        collider: Union[Collider, Mapping[str, Any]],
    ) -> None:
        """Makes a body touch others.

        collider: as in scenes
        """
        self._add("add_collider", locals())

    def change_body(
        self,
        body: str,
        settings: Mapping[str, Any],
    ) -> None:
        """Changes settings of a body; its pose and velocity stay.

        body: name of the body (a string; required)
        settings: the settings that change
        """
        self._add("change_body", locals())

    def remove_body(
        self,
        body: str,
    ) -> None:
        """Takes a body away, with its collider; joints, links and rotors that are on it must go
        before.

        body: name of the body (a string; required)
        """
        self._add("remove_body", locals())

    def remove_joint(
        self,
        joint: str,
    ) -> None:
        """Takes a joint away.

        joint: name of the joint (a string; required)
        """
        self._add("remove_joint", locals())

    def remove_cable(
        self,
        cable: str,
    ) -> None:
        """Takes a cable away.

        cable: name of the cable (a string; required)
        """
        self._add("remove_cable", locals())

    def remove_collider(
        self,
        body: str,
    ) -> None:
        """A body no longer touches any other.

        body: name of the body (a string; required)
        """
        self._add("remove_collider", locals())

    def detach(
        self,
        cable: str,
        end: Literal["first", "last"],
    ) -> None:
        """Detaches an end; at the end of the edit a loose end has left all links that do not hold
        it.

        cable: name of the cable (a string; required)
        end: the end ("first", "last"; required)
        """
        self._add("detach", locals())

    def attach(
        self,
        cable: str,
        end: Literal["first", "last"],
        body: str,
        *,
        point: Optional[Sequence[float]] = None,
    ) -> None:
        """Fixes a loose end to a point of a body.

        cable: name of the cable (a string; required)
        end: the end ("first", "last"; required)
        body: name of the body, or "world" (a string; required)
        point: in the body's frame ([x, y, z], numbers [m]; default: [0.0,0.0,0.0])
        """
        self._add("attach", locals())

    def split(
        self,
        cable: str,
        span: int,
        name: str,
        *,
        share: Optional[float] = None,
    ) -> None:
        """Makes two of a cable; one that is cut splits where it was cut.

        cable: name of the cable; the piece from its first link on keeps it (a string; required)
        span: the span in which it is split, behind this link, counted from 0 (an integer >= 0;
            required)
        name: name of the other piece (a string; required)
        share: share of that span before the split; default: 0.5 (a number 0 ... 1; default: 0.5)
        """
        self._add("split", locals())

    def open(
        self,
        cable: str,
        span: int,
        *,
        share: Optional[float] = None,
    ) -> None:
        """Makes an open cable with two loose ends of a belt; one that is cut opens where it was
        cut.

        cable: name of the belt (a string; required)
        span: the span in which it is opened, behind this link, counted from 0 (an integer >= 0;
            required)
        share: share of that span before the opening; default: 0.5 (a number 0 ... 1; default: 0.5)
        """
        self._add("open", locals())

    def join(
        self,
        cable: str,
        next: str,
    ) -> None:
        """Joins the loose last end of a cable to the loose first end of another, which is then part
        of it; a cable that is joined to itself becomes a belt.

        cable: name of the cable (a string; required)
        next: name of the other cable, or of the same (a string; required)
        """
        self._add("join", locals())

    def pay_out(
        self,
        cable: str,
        span: int,
        length: float,
    ) -> None:
        """Adds cable to a span, or removes cable.

        cable: name of the cable (a string; required)
        span: the span behind this link, counted from 0 (an integer >= 0; required)
        length: length added; below 0: removed (a number [m]; required)
        """
        self._add("pay_out", locals())

    def insert_link(
        self,
        cable: str,
        span: int,
        link: Union[Link, Mapping[str, Any]],
    ) -> None:
        """Leads a span over another link; the cable on the link comes from the span.

        cable: name of the cable (a string; required)
        span: the span behind this link, counted from 0 (an integer >= 0; required)
        link: as in scenes
        """
        self._add("insert_link", locals())

    def remove_link(
        self,
        cable: str,
        link: int,
    ) -> None:
        """Removes a link between the ends of a cable; the cable on it comes to the span.

        cable: name of the cable (a string; required)
        link: number of the link, from 0 (an integer >= 0; required)
        """
        self._add("remove_link", locals())

    def set_step(
        self,
        step: Mapping[str, Any],
    ) -> None:
        """Changes solver, integrator, substeps or iterations.

        step: the settings that change
        """
        self._add("set_step", locals())

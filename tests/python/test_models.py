"""Models that are built in Python."""

import copy
import inspect
import json
import pickle
import pydoc

import numpy as np
import pytest
from conftest import ATWOOD
from hypothesis import given, settings
from hypothesis import strategies as st

import sheave
from sheave import _generate, _sheave, parts


def atwood_model():
    model = sheave.Model(gravity=(0, -10, 0), duration=1)
    wheel = model.add(sheave.Body("wheel", mobility="rotor", mass=1,
                                  shape=sheave.Cylinder(radius=0.5, length=0.1)))
    light = model.add(sheave.Body("light", mobility="slider", axis=(0, 1, 0), mass=1,
                                  position=(-0.5, -2, 0)))
    heavy = model.add(sheave.Body("heavy", mobility="slider", axis=(0, 1, 0), mass=2,
                                  position=np.array([0.5, -2, 0])))
    model.add(sheave.Cable("cable", links=[
        sheave.AttachmentLink(body=light),
        sheave.RollingLink(body=wheel, winding="clockwise"),
        sheave.AttachmentLink(body=heavy)]))
    return model


def test_a_model_is_the_scene_that_it_says():
    sim, other = atwood_model().simulation(), sheave.load(ATWOOD)
    sim.step(20)
    other.step(20)
    assert sim.hash == other.hash


def test_models_are_saved_and_loaded(tmp_path):
    model = atwood_model()
    model.save(tmp_path / "atwood.json")
    again = sheave.Model.load(tmp_path / "atwood.json")
    assert again.simulation().hash == model.simulation().hash
    assert sheave.Model.load(again).to_json() == again.to_json()


def test_parts_are_changed_after_they_were_made():
    model = atwood_model()
    model.bodies[2].mass = 1.0
    assert model.bodies[2].mass == 1.0 and model.bodies[2].density is None
    sim = model.simulation()
    sim.step(10)
    assert sim.observe("heavy.vy") == pytest.approx(0.0, abs=1e-12)
    del model.bodies[2].mass
    with pytest.raises(sheave.SceneError, match="mass"):
        model.simulation()


@pytest.mark.parametrize("make", [copy.copy, copy.deepcopy,
                                  lambda part: pickle.loads(pickle.dumps(part))])
def test_parts_are_copied(make):
    part = sheave.Body("a", mobility="free", mass=1, shapes=[sheave.Box(size=(1, 1, 1))])
    other = make(part)
    assert other == part and other is not part
    other.mass = 2
    assert other != part and part.mass == 1
    assert part != 3


@pytest.mark.parametrize("name", ["mas", "typ", "shap"])
def test_unknown_settings_tell_what_is_near(name):
    body = sheave.Body("a", mobility="free")
    with pytest.raises(AttributeError, match="no setting"):
        setattr(body, name, 1)
    with pytest.raises(AttributeError, match="no setting"):
        getattr(body, name)
    with pytest.raises(TypeError):
        sheave.Body("a", mobility="free", **{name: 1})
    with pytest.raises(sheave.ArgumentError, match="no setting"):
        sheave.Body.from_dict({"name": "a", name: 1})


@pytest.mark.parametrize("part", [3, None, "body", {"name": "a"}, sheave.Box((1, 1, 1))])
def test_only_parts_are_added(part):
    with pytest.raises(sheave.ArgumentError, match="part: must be"):
        sheave.Model().add(part)


def test_faults_of_models_have_pointers():
    model = atwood_model()
    model.bodies[0].mass = -1
    with pytest.raises(sheave.SceneError) as caught:
        model.simulation()
    assert caught.value.faults[0].pointer == "/bodies/0/mass"


def test_types_choose_classes():
    joint = sheave.Joint.from_dict({"type": "hinge", "name": "h", "body_b": "b",
                                    "anchor": [0, 0, 0], "axis": [0, 0, 1]})
    assert isinstance(joint, sheave.HingeJoint) and joint.to_dict()["type"] == "hinge"
    with pytest.raises(sheave.ArgumentError, match="type: must be one of"):
        sheave.Joint.from_dict({"type": "hinj", "name": "h"})


def test_the_classes_are_those_of_the_tables():
    from pathlib import Path

    folder = Path(sheave.__file__).parent
    assert (folder / "parts.py").read_text() == _generate.parts_text()
    assert (folder / "_changes.py").read_text() == _generate.changes_text()


@pytest.mark.parametrize("name", parts.__all__)
def test_classes_say_what_the_reference_says(name):
    own = getattr(sheave, name)
    text = pydoc.render_doc(own)
    if own._keys:
        signature = inspect.signature(own)
        assert set(signature.parameters) == set(own._keys)
        for key in own._keys:
            assert f"{key}: " in own.__doc__
    assert name in text


def test_the_tables_are_there():
    formats = _sheave.formats()
    assert {"scene", "body", "cable", "joint", "link", "change"} <= set(formats)
    mass = next(f for f in formats["body"]["fields"] if f["name"] == "mass")
    assert mass["unit"] == "kg" and "> 0" in mass["allowed"]


numbers = st.floats(-1e3, 1e3, allow_subnormal=False)
positive = st.floats(1e-3, 1e3)
vectors = st.tuples(numbers, numbers, numbers)
names = st.text("abcxyz019_-", min_size=1, max_size=12)
shapes = st.one_of(
    st.builds(sheave.Box, size=st.tuples(positive, positive, positive), position=vectors),
    st.builds(sheave.Sphere, radius=positive, position=vectors),
    st.builds(sheave.Cylinder, radius=positive, length=positive),
    st.builds(sheave.Capsule, radius=positive, length=positive))
bodies = st.builds(
    sheave.Body, name=names, mobility=st.just("free"), mass=positive,
    position=vectors, velocity=vectors, shapes=st.lists(shapes, min_size=1, max_size=3),
    damping=st.none() | positive, force=st.none() | vectors)


@settings(max_examples=60, deadline=None)
@given(st.lists(bodies, max_size=4, unique_by=lambda body: body.name), vectors, positive)
def test_models_go_round(parts_of_it, gravity, duration):
    model = sheave.Model(gravity=gravity, duration=duration)
    for body in parts_of_it:
        model.add(body)
    again = sheave.Model.from_dict(json.loads(model.to_json()))
    assert again == model
    assert again.to_dict() == json.loads(model.to_json())
    # Through the library: what it reads and writes is the same world.
    written = sheave.Model.load(model)
    assert written.simulation().hash == model.simulation().hash
    assert sheave.Model.load(written).to_json() == written.to_json()


@settings(max_examples=40, deadline=None)
@given(names, st.lists(st.tuples(st.floats(-5, 5), st.floats(1, 5)), min_size=2, max_size=5,
                       unique_by=lambda p: round(p[0], 2)))
def test_cables_go_round(name, points):
    model = sheave.Model()
    links = [sheave.PinholeLink(body="world", point=(x, y, 0)) for x, y in points]
    links[0] = sheave.AttachmentLink(body="world", point=(*points[0], 0))
    links[-1] = sheave.AttachmentLink(body="world", point=(*points[-1], 0))
    model.add(sheave.Cable(name, links=links))
    again = sheave.Model.from_dict(model.to_dict())
    assert again == model and again.cables[0].links == links
    assert isinstance(again.cables[0].links[0], sheave.AttachmentLink)


json_values = st.recursive(
    st.none() | st.booleans() | numbers | st.text(max_size=8),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=8), inner,
                                                                max_size=3), max_leaves=10)
keys = st.sampled_from(sorted({f["name"] for f in _sheave.formats()["body"]["fields"]} |
                              {"shape", "shapes", "type", "links"}))


@settings(max_examples=150, deadline=None)
@given(st.dictionaries(keys, json_values, max_size=5), st.dictionaries(
    st.sampled_from(["gravity", "duration", "bodies", "cables", "joints", "step", "format"]),
    json_values, max_size=4))
def test_nonsense_is_refused_and_never_worse(body, scene):
    for nonsense in (scene, dict(ATWOOD, bodies=[*ATWOOD["bodies"], body])):
        try:
            sheave.load(nonsense).step()
        except sheave.Error as error:
            assert str(error)
    sim = sheave.load(ATWOOD)
    before = sim.hash
    try:
        with sim.edit() as edit:
            edit.add_body(body)
    except sheave.Error:
        assert sim.hash == before


@settings(max_examples=150, deadline=None)
@given(st.sampled_from([name for name in dir(sheave.Simulation) if not name.startswith("__")]),
       st.lists(json_values, max_size=3))
def test_methods_take_nonsense(name, arguments):
    if name in ("run", "video", "save_state", "load_state", "plot", "record", "_record", "step"):
        return
    sim = sheave.load(ATWOOD)
    own = getattr(sim, name)
    if not callable(own):
        return
    try:
        own(*arguments)
    except (sheave.Error, TypeError, ValueError, AttributeError):
        pass
    sim.step()


@pytest.mark.parametrize("name", ["step", "ground", "camera"])
def test_what_a_model_has_once_is_checked_when_it_is_set(name):
    model = sheave.Model()
    for wrong in ("", 3, int, sheave.Body):
        with pytest.raises(sheave.ArgumentError, match=f"{name}: must be a {name.capitalize()}, a dict or None"):
            setattr(model, name, wrong)
    setattr(model, name, {})
    setattr(model, name, None)
    assert getattr(model, name) is None

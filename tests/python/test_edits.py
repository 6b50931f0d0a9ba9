"""Worlds whose parts come and go."""

import pytest
from conftest import ATWOOD, ROOT

import sheave

BALL = {"name": "ball", "mobility": "free", "mass": 2, "position": [3, 0, 0],
        "shape": {"type": "sphere", "radius": 0.1}}


def test_bodies_come_and_go(atwood):
    with atwood.edit() as edit:
        edit.add_body(BALL)
    assert edit.report["energy"] == pytest.approx(0.0)
    atwood.step(6)
    assert atwood.bodies["ball"].velocity[1] == pytest.approx(-1.0)
    atwood.edit(lambda edit: edit.remove_body("ball"))
    assert list(atwood.bodies) == ["wheel", "light", "heavy"]


def test_parts_may_be_objects(atwood):
    ball = sheave.Body("ball", mobility="free", mass=2, position=(3, 0, 0),
                       shape=sheave.Sphere(radius=0.1))
    with atwood.edit() as edit:
        edit.add_body(ball)
        edit.add_joint(sheave.BallJoint("pin", body_b=ball, anchor=(3, 1, 0)))
        edit.add_cable(sheave.Cable("string", links=[
            sheave.AttachmentLink(body="world", point=(4, 1, 0)),
            sheave.AttachmentLink(body=ball)]))
        edit.add_collider(sheave.Collider(body=ball))
        edit.change_body("heavy", settings={"mass": 3})
        edit.set_step({"substeps": 2})
    atwood.step(3)
    assert atwood.joints["pin"].type == "ball"
    assert atwood.cables["string"].length == pytest.approx(2**0.5)
    assert atwood.bodies["heavy"].mass == 3


def test_cables_are_cut_apart_and_joined(atwood):
    atwood.step(3)
    length = atwood.cables["cable"].length
    with atwood.edit() as edit:
        edit.split("cable", 1, share=0.5, name="rest")
        edit.attach("rest", "first", body="world", point=(0.5, -1.3, 0))
    assert set(atwood.cables) == {"cable", "rest"}
    atwood.step(1)
    with atwood.edit() as edit:
        edit.detach("rest", "first")
        edit.remove_cable("cable")
    assert atwood.cables["rest"].loose_length("first") is not None
    assert length > 0


@pytest.mark.parametrize("change, text", [
    (lambda edit: edit.remove_body("nobody"), "there is no body"),
    (lambda edit: edit.remove_body("wheel"), "wheel"),
    (lambda edit: edit.add_body({"name": "x"}), "mass"),
    (lambda edit: edit.add_body(dict(BALL, mass=-1)), "must be > 0"),
    (lambda edit: edit.add_body(dict(BALL, wieght=1)), "weight|unknown"),
    (lambda edit: edit.add_body(dict(BALL, name="wheel")), "wheel"),
    (lambda edit: edit.pay_out("cable", 9, 1.0), "span"),
    (lambda edit: edit.set_step({"dt": 1}), "dt"),
])
def test_an_edit_is_done_whole_or_not_at_all(atwood, change, text):
    atwood.step(4)
    before = atwood.hash
    with pytest.raises(sheave.EditError, match=text) as caught:
        with atwood.edit() as edit:
            edit.add_body(dict(BALL, name="first"))
            change(edit)
    assert atwood.hash == before and "first" not in atwood.bodies
    # A part that is missed by another one is a fault of neither change alone.
    assert caught.value.faults[0].pointer.startswith("/changes/1") or "removed" in str(caught.value)
    atwood.step()


def test_what_is_raised_within_leaves_all_as_it_was(atwood):
    before = atwood.hash
    with pytest.raises(ZeroDivisionError):
        with atwood.edit() as edit:
            edit.remove_cable("cable")
            _ = 1 / 0
    assert atwood.hash == before and len(atwood.cables) == 1


def test_an_edit_is_made_once(atwood):
    with atwood.edit() as edit:
        edit.add_body(BALL)
    with pytest.raises(sheave.Error, match="has been made"):
        edit.remove_body("ball")
    with pytest.raises(sheave.Error, match="has been made"):
        edit.make()


@pytest.mark.parametrize("changes", [3, "remove", [1]])
def test_changes_must_be_a_function(atwood, changes):
    with pytest.raises(sheave.ArgumentError, match="changes"):
        atwood.edit(changes)


def test_what_json_cannot_say_is_refused(atwood):
    for bad in (object(), float("inf"), {1, 2}):
        with pytest.raises(sheave.ArgumentError, match="JSON"):
            with atwood.edit() as edit:
                edit.add_body(dict(BALL, mass=bad))


def test_edits_before_a_step_count_for_it(atwood):
    def hook(sim):
        if sim.steps == 2:
            with sim.edit() as edit:
                edit.add_body(BALL)

    atwood.step(5, before_step=hook)
    assert atwood.bodies["ball"].velocity[1] < 0.0


def test_controllers_find_what_they_control_again():
    sim = sheave.load(ROOT / "scenes/machines/load-at-a-height.json")
    other = sheave.load(ROOT / "scenes/machines/load-at-a-height.json")
    sim.step(20)
    with sim.edit() as edit:
        edit.add_body(dict(BALL, position=[90, 0, 0]))
    sim.step(20)
    other.step(40)
    for name in other.bodies:
        assert sim.bodies[name].position == pytest.approx(other.bodies[name].position, abs=1e-9)


def test_reset_undoes_edits(atwood):
    start = atwood.hash
    atwood.edit(lambda edit: edit.add_body(BALL))
    atwood.step(2)
    atwood.reset()
    assert atwood.hash == start and len(atwood.bodies) == 3
    assert atwood.observe("heavy.y") == ATWOOD["bodies"][2]["position"][1]

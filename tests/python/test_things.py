"""Bodies, joints and cables by handles, and their controls."""

import numpy as np
import pytest
from conftest import ATWOOD, ROOT

import sheave

MACHINE = {
    "format": "sheave-scene/1", "gravity": [0, -9.81, 0], "duration": 1,
    "bodies": [
        {"name": "winch", "mobility": "rotor", "mass": 5, "drive": "speed", "drive_values": [0],
         "position": [0, 3, 0], "shape": {"type": "cylinder", "radius": 0.2, "length": 0.1}},
        {"name": "motor", "mobility": "rotor", "mass": 5, "drive": "torque", "drive_values": [0],
         "position": [9, 3, 0], "shape": {"type": "cylinder", "radius": 0.2, "length": 0.1}},
        {"name": "servo", "mobility": "rotor", "mass": 5, "drive": "angle", "drive_values": [0],
         "position": [12, 3, 0], "shape": {"type": "cylinder", "radius": 0.2, "length": 0.1}},
        {"name": "load", "mobility": "planar", "mass": 10, "position": [0.2, 0, 0],
         "shape": {"type": "box", "size": [0.4, 0.4, 0.4]}},
        {"name": "cart", "mobility": "planar", "mass": 4, "position": [4, 0, 0],
         "shape": {"type": "box", "size": [1, 0.4, 0.4]}},
        {"name": "hand", "mobility": "kinematic", "position": [6, 2, 0]}],
    "joints": [
        {"type": "slider", "name": "rail", "body_b": "cart", "axis": [1, 0, 0],
         "anchor": [4, 0, 0], "drive": "speed", "drive_values": [0], "drive_limit": 50}],
    "cables": [
        {"name": "rope", "compliance": 1e-6, "links": [
            {"type": "spool", "body": "winch", "winding": "clockwise", "stored_length": 3},
            {"type": "attachment", "body": "load", "point": [0, 0.2, 0]}]},
        {"name": "tow", "links": [
            {"type": "attachment", "body": "hand", "feed_speed": 0},
            {"type": "pinhole", "body": "world", "point": [6, 4, 0], "friction": 0.1},
            {"type": "attachment", "body": "cart", "point": [0, 0.2, 0]}]}],
}


@pytest.fixture
def machine():
    return sheave.load(MACHINE)


def test_things_are_mappings(machine):
    assert list(machine.bodies) == ["winch", "motor", "servo", "load", "cart", "hand"]
    assert list(machine.joints) == ["rail"] and len(machine.cables) == 2
    assert "rope" in machine.cables and "chain" not in machine.cables
    assert dict(machine.cables)["rope"] == machine.cable("rope")
    assert machine.bodies["load"] != machine.bodies["cart"]
    assert len({machine.body("load"), machine.body("load")}) == 1
    assert "winch" in repr(machine.bodies) and "rope" in repr(machine.cable("rope"))
    assert machine.bodies.get("nobody") is None


@pytest.mark.parametrize("kind", ["body", "joint", "cable"])
def test_unknown_names_tell_what_there_is(machine, kind):
    with pytest.raises(sheave.UnknownNameError, match="there is no " + kind) as caught:
        getattr(machine, kind)("nothing")
    assert "there are:" in str(caught.value)


@pytest.mark.parametrize("name", [3, None, b"load", ["load"], "\ud800"])
@pytest.mark.parametrize("kind", ["body", "joint", "cable"])
def test_names_must_be_strings(machine, kind, name):
    with pytest.raises(sheave.ArgumentError, match="name: must be a string"):
        getattr(machine, kind)(name)


def test_bodies_tell_where_they_are(machine):
    load = machine.bodies["load"]
    assert load.position == (0.2, 0.0, 0.0)
    assert load.orientation == (1.0, 0.0, 0.0, 0.0)
    assert load.mass == 10 and load.mobility == "planar" and load.index == 3 and load.alive
    assert load.point((0, 0.2, 0)) == (0.2, 0.2, 0.0)
    machine.step(3)
    assert np.allclose(load.velocity, machine.velocities[load.index])


def test_a_winch_is_set_to_a_speed(machine):
    machine.bodies["winch"].set_speed(-2.0, over=0.1)
    machine.step(30)
    assert machine.bodies["winch"].angular_velocity[2] == pytest.approx(-2.0)
    machine.bodies["winch"].clear_drive()
    machine.step(2)
    assert machine.bodies["winch"].angular_velocity[2] == pytest.approx(0.0)


def test_a_motor_is_set_to_a_torque(machine):
    motor = machine.bodies["motor"]
    motor.set_torque(0.5)
    machine.step(60)
    inertia = 0.5 * 5 * 0.2**2
    assert motor.angular_velocity[2] == pytest.approx(0.5 / inertia * machine.time, rel=1e-9)


def test_a_servo_is_set_to_an_angle(machine):
    machine.bodies["servo"].set_angle(1.0, over=0.2, rate=0.0)
    machine.step(30)
    assert machine.bodies["servo"].angle == pytest.approx(1.0)


def test_a_drive_of_another_kind_is_refused(machine):
    with pytest.raises(sheave.Error, match="winch"):
        machine.bodies["winch"].set_torque(1.0)
    with pytest.raises(sheave.Error, match="load"):
        machine.bodies["load"].set_speed(1.0)


def test_forces_act_until_they_are_cleared(machine):
    with machine.edit() as edit:
        edit.remove_cable("rope")
    load = machine.bodies["load"]
    load.set_force((10 * 9.81 * 0, 10 * 9.81, 0))
    machine.step(10)
    assert np.allclose(load.velocity, 0.0, atol=1e-12)
    load.clear_force()
    machine.step(6)
    assert load.velocity[1] == pytest.approx(-9.81 * 0.1)
    load.set_force(torque=(0, 0, 1), frame="body")
    machine.step(1)
    assert load.angular_velocity[2] > 0


def test_a_hand_is_led(machine):
    machine.bodies["hand"].set_motion((6, 3, 0), velocity=(0, 1, 0), over=0.5)
    machine.step(30)
    assert machine.bodies["hand"].position[1] == pytest.approx(3.0)
    machine.bodies["hand"].clear_motion(over=0.5)
    machine.step(31)
    assert machine.bodies["hand"].position[1] == pytest.approx(2.0)


def test_a_joint_is_driven(machine):
    rail = machine.joints["rail"]
    assert rail.type == "slider" and rail.coordinates == ["travel"]
    rail.set_drive(0.5, coordinate="travel")
    rail.set_drive_limit(1e4)
    machine.step(20)
    report = rail.report()["coordinates"]["travel"]
    assert report["rate"] == pytest.approx(0.5, rel=1e-6)
    assert machine.observe("rail.travel") == pytest.approx(report["value"])
    assert len(rail.force) == len(rail.torque) == 3
    rail.clear_drive()
    rail.release()
    machine.step(1)
    assert rail.broken
    rail.lock()
    machine.step(1)
    assert not rail.broken


@pytest.mark.parametrize("coordinate", ["angle", 1, -1, 0.5, None])
def test_a_coordinate_that_is_not_there(machine, coordinate):
    with pytest.raises(sheave.ArgumentError, match="coordinate"):
        machine.joints["rail"].set_drive(1.0, coordinate=coordinate)


def test_cables_are_set(machine):
    rope, tow = machine.cables["rope"], machine.cables["tow"]
    machine.step(5)
    rope.set_compliance(1e-4)
    tow.set_friction(1, 0.3)
    tow.set_feed_speed(0, 0.2)
    before = tow.length
    machine.step(20)
    assert tow.length > before
    for clear in (rope.clear_compliance, rope.clear_breaking_tension):
        clear()
    tow.clear_friction(1)
    tow.clear_feed_speed(0)
    assert rope.pulls and rope.loose_length("last") is None
    assert rope.stored_length(0) == pytest.approx(3.0)
    assert rope.rest_length(0) == rope.rest_lengths[0]
    assert rope.tension() == rope.tensions[0] == rope.tension(span=0)
    report = rope.report()
    assert [link["type"] for link in report["links"]] == ["spool", "attachment"]
    # Of the moment, while tension() is of the last substep.
    assert report["spans"][0]["tension"] == machine.observe("rope.0.tension")


@pytest.mark.parametrize("call", [
    lambda rope: rope.set_compliance(0.0),
    lambda rope: rope.set_breaking_tension(-1.0),
    lambda rope: rope.set_wrap_friction(0.1),
    lambda rope: rope.set_friction(0, 0.1),
    lambda rope: rope.set_feed_speed(1, 0.1),
    lambda rope: rope.tension(7),
    lambda rope: rope.stored_length(9),
])
def test_what_a_cable_has_not_is_refused(machine, call):
    with pytest.raises(sheave.Error, match="rope|cable"):
        call(machine.cables["rope"])


NUMBERS = ["1", None, [1.0], {}, object()]


@pytest.mark.parametrize("value", NUMBERS)
@pytest.mark.parametrize("call", [
    lambda sim, value: sim.bodies["winch"].set_speed(value),
    lambda sim, value: sim.joints["rail"].set_drive(value),
    lambda sim, value: sim.cables["rope"].set_compliance(value),
    lambda sim, value: sim.set("winch.drive", value),
])
def test_numbers_must_be_numbers(machine, call, value):
    before = machine.hash
    with pytest.raises(sheave.ArgumentError, match="value: must be a number"):
        call(machine, value)
    assert machine.hash == before


@pytest.mark.parametrize("value", [[1, 2], "abc", None, 3, [1, 2, "x"], [1, 2, float("nan")],
                                   np.zeros((3, 1)), {1: 2}])
def test_vectors_must_be_vectors(machine, value):
    for call in (machine.bodies["load"].place, machine.bodies["load"].set_force,
                 machine.bodies["load"].point, machine.bodies["hand"].set_motion):
        with pytest.raises(sheave.ArgumentError, match="three finite numbers"):
            call(value)


def test_numbers_of_numpy_are_numbers(machine):
    machine.bodies["winch"].set_speed(np.float32(1.0))
    machine.bodies["load"].set_force(np.array([0, 1, 2]))
    machine.step(np.int64(2))
    assert machine.steps == 2


def test_not_finite_is_refused(machine):
    with pytest.raises(sheave.Error):
        machine.bodies["winch"].set_speed(float("nan"))
    with pytest.raises(sheave.ArgumentError, match="orientation"):
        machine.bodies["load"].place((0, 0, 0), orientation=(1, 1, 0, 0))
    with pytest.raises(sheave.ArgumentError, match="keep"):
        machine.bodies["load"].place((0, 0, 0), keep="slack")
    with pytest.raises(sheave.ArgumentError, match="frame"):
        machine.bodies["load"].set_force((0, 0, 0), frame="moon")


def test_placing_tells_what_it_does(machine):
    done = machine.bodies["load"].place((0.2, -1.0, 0), keep="tension")
    assert done["energy"] == pytest.approx(-10 * 9.81)
    assert done["cables"]["rope"] == pytest.approx(1.0, abs=1e-5)


def test_controls_by_name(machine):
    machine.set("winch.drive", -1.0)
    machine.set("load.force_x", 3.0)
    machine.step(5)
    assert machine.bodies["winch"].angular_velocity[2] == pytest.approx(-1.0)
    machine.clear("load.force_x")
    with pytest.raises(sheave.UnknownNameError, match="winch.drive"):
        machine.set("winch.drve", 1.0)
    machine.gravity = (0, 0, 0)
    assert machine.gravity == (0.0, 0.0, 0.0)
    machine.clear_gravity()
    assert machine.gravity == (0.0, -9.81, 0.0)


def test_controls_are_part_of_the_state():
    one, other = sheave.load(MACHINE), sheave.load(MACHINE)
    one.bodies["winch"].set_speed(-1.0)
    assert one.hash != other.hash
    other.set("winch.drive", -1.0)
    one.step(10)
    other.step(10)
    assert one.hash == other.hash


def test_handles_die_with_what_they_refer_to(machine):
    load, rope, rail = machine.bodies["load"], machine.cables["rope"], machine.joints["rail"]
    kept = machine.snapshot()
    with machine.edit() as edit:
        edit.remove_cable("rope")
        edit.remove_joint("rail")
        edit.remove_body("load")
    for thing in (load, rope, rail):
        assert not thing.alive and "removed" in repr(thing)
        with pytest.raises(sheave.StaleError, match="no more"):
            _ = thing.name
    for call in (lambda: load.position, lambda: load.set_force((0, 0, 1)), lambda: load.mass,
                 lambda: load.place((0, 0, 0)), lambda: rope.tension(), lambda: rope.tensions,
                 lambda: rope.report(), lambda: rail.force, lambda: rail.report(),
                 lambda: rail.set_drive(1.0), lambda: rail.release()):
        with pytest.raises(sheave.StaleError):
            call()
    machine.restore(kept)
    assert load.alive and load.name == "load"


def test_handles_keep_their_world_alive():
    load = sheave.load(MACHINE).bodies["load"]
    assert load.position == (0.2, 0.0, 0.0)

"""Coordinates of joints, and the questions of robotics."""

import numpy as np
import pytest
from conftest import ROOT

import sheave

Z = [0, 0, 1]


def two_links(**joint):
    """Two links of 1 m and 0.8 m in a plane, stretched along x."""
    return {
        "format": "sheave-scene/1", "gravity": [0, -10, 0], "duration": 1,
        "bodies": [
            {"name": "upper", "mobility": "planar", "mass": 2, "inertia": [1, 1, 0.3],
             "position": [0.5, 0, 0]},
            {"name": "lower", "mobility": "planar", "mass": 1.5, "inertia": [1, 1, 0.07],
             "position": [1.3, 0, 0]}],
        "joints": [
            {"type": "hinge", "name": "shoulder", "body_b": "upper", "anchor": [0, 0, 0],
             "axis": Z, **joint},
            {"type": "hinge", "name": "elbow", "body_a": "upper", "body_b": "lower",
             "anchor": [1, 0, 0], "axis": Z, **joint}],
    }


def hung():
    """A bar on a rigid rope and on a hinge."""
    return {
        "format": "sheave-scene/1", "gravity": [0, -10, 0], "duration": 1,
        "bodies": [{"name": "bar", "mobility": "planar", "mass": 2, "inertia": [1, 1, 0.2],
                    "position": [1, 0, 0]}],
        "joints": [{"type": "hinge", "name": "pin", "body_b": "bar", "anchor": [0, 0, 0],
                    "axis": Z}],
        "cables": [{"name": "rope", "links": [
            {"type": "attachment", "body": "world", "point": [1, 2, 0]},
            {"type": "attachment", "body": "bar"}]}],
    }


@pytest.fixture
def arm():
    return sheave.load(two_links())


def test_an_angle_reads_and_sets(arm):
    elbow = arm.joints["elbow"]
    elbow.angle = 0.5
    assert elbow.angle == pytest.approx(0.5, abs=1e-12)
    tip = arm.bodies["lower"].point((0.5, 0, 0))
    assert tip[:2] == pytest.approx((1 + 0.8 * np.cos(0.5), 0.8 * np.sin(0.5)), abs=1e-12)
    elbow.velocity = -2
    assert elbow.velocity == pytest.approx(-2, abs=1e-12)
    assert arm.bodies["lower"].angular_velocity[2] == pytest.approx(-2, abs=1e-12)


def test_travel_and_extension_read_and_set():
    sim = sheave.load({
        "format": "sheave-scene/1", "duration": 1, "gravity": [0, 0, 0],
        "bodies": [{"name": "box", "mass": 1, "inertia": [1, 1, 1], "position": [1, 0, 0]}],
        "joints": [
            {"type": "slider", "name": "rail", "body_b": "box", "anchor": [1, 0, 0],
             "axis": [1, 0, 0]},
            {"type": "distance", "name": "jack", "body_b": "box", "anchor_a": [0, 0, 0],
             "anchor_b": [1, 0, 0], "limit": "none"}]})
    assert sim.coordinate_names == ["rail.travel"]
    sim.joints["rail"].travel = 0.25
    assert sim.joints["jack"].extension == pytest.approx(0.25, abs=1e-12)
    sim.joints["jack"].extension = -0.5
    assert sim.bodies["box"].position == pytest.approx((0.5, 0, 0), abs=1e-12)
    with pytest.raises(AttributeError, match="no angle.*slider.*travel"):
        sim.joints["rail"].angle
    assert not hasattr(sim.joints["rail"], "angle")


def test_drive_force_is_an_attribute():
    sim = sheave.load(two_links(drive="angle", drive_values=[0]))
    sim.step()
    assert sim.joints["elbow"].drive_force == pytest.approx(
        sim.joints["elbow"].report()["coordinates"]["angle"]["drive_force"], rel=0)
    # 1.5 kg x 10 m/s2 at 0.3 m; drives hold it without a limit.
    assert sim.joints["elbow"].drive_force == pytest.approx(4.5, rel=1e-9)


def test_qpos_and_qvel_go_both_ways(arm):
    arm.qpos = [0.3, -0.4]
    arm.qvel = np.array([1.0, 2.0])
    assert arm.qpos == pytest.approx([0.3, -0.4], abs=1e-12)
    assert arm.qvel == pytest.approx([1, 2], abs=1e-12)
    velocity = arm.jacobian("lower", (0.5, 0, 0)) @ arm.qvel
    assert velocity[5] == pytest.approx(3, abs=1e-12)
    with pytest.raises(ValueError, match="read-only|assignment"):
        arm.positions[0, 0] = 1


def test_all_dynamics_agree_with_each_other(arm):
    arm.qpos = [0.3, -0.4]
    arm.qvel = [1.0, 2.0]
    acceleration = np.array([0.7, -0.2])
    force = arm.inverse_dynamics(acceleration)
    assert force == pytest.approx(
        arm.mass_matrix() @ acceleration + arm.bias_forces() - arm.passive_forces(), abs=1e-12)
    assert arm.forward_dynamics(force) == pytest.approx(acceleration, abs=1e-9)


def test_accelerations_are_those_of_small_steps():
    # A step's mean acceleration differs from that at its start in first order of the step.
    errors = []
    for dt in (2e-4, 1e-4):
        sim = sheave.load({**two_links(damping=0.3, stiffness=2), "step": {"dt": dt,
                                                                          "substeps": 1}})
        sim.qpos = [0.3, -0.4]
        sim.qvel = [1.0, 2.0]
        wanted = sim.forward_dynamics([0, 0])
        before = sim.qvel
        sim.step()
        errors.append(np.linalg.norm((sim.qvel - before) / dt - wanted))
    assert errors[0] / errors[1] == pytest.approx(2, abs=0.1)


def test_cables_give_their_arms(atwood):
    assert atwood.coordinate_names == ["wheel.turn", "light.along", "heavy.along"]
    # Each weight shortens the cable by its rise; the wheel moves it from one span to the other.
    assert atwood.moment_arms() == pytest.approx(np.array([[0, -1, -1]]), abs=1e-14)
    assert np.abs(atwood.moment_arms(True)[:, 0]) == pytest.approx([0.5, 0.5], abs=1e-14)
    atwood.step(5)
    # The rigid cable is taut, so its length stays, and tensions and inertia balance.
    assert atwood.cable_velocities() == pytest.approx([0], abs=1e-9)
    force = -atwood.moment_arms(True).T @ atwood.tensions
    a = 10 / 3.5
    assert atwood.forward_dynamics(force) == pytest.approx(
        [np.sign(atwood.qvel[0]) * a / 0.5, a, -a], rel=1e-6)


def test_cables_keep_length_or_tension():
    sim = sheave.load(hung())
    before = sim.hash
    with pytest.raises(sheave.Error, match="too short"):
        sim.joints["pin"].angle = -0.3
    assert sim.hash == before
    placed = sim.place({"pin": -0.3}, keep="tension")
    longer = np.hypot(1 - np.cos(0.3), 2 + np.sin(0.3)) - 2
    assert placed["cables"]["rope"] == pytest.approx(longer, abs=1e-10)
    assert sim.cable_lengths() == pytest.approx([2 + longer], abs=1e-10)


def test_statics_leaves_the_simulation_and_can_move_it():
    sim = sheave.load(hung())
    before = sim.hash
    rest = sim.statics()
    assert sim.hash == before
    # The rope holds the bar at its centre of mass, so the rope bears all of the weight.
    assert rest.tensions == pytest.approx([20], rel=1e-9)
    assert rest.stability == "stable"
    assert rest.qpos == pytest.approx([0], abs=1e-9)
    assert rest.positions.shape == (1, 3) and rest.orientations_xyzw.shape == (1, 4)
    sim.statics(move=True)
    assert sim.tensions == pytest.approx([20], rel=1e-9)


def test_statics_without_rest_is_an_error():
    ball = {"name": "ball", "mass": 1, "inertia": [1, 1, 1]}
    sim = sheave.load({"format": "sheave-scene/1", "duration": 1, "gravity": [0, -10, 0],
                       "bodies": [ball]})
    with pytest.raises(sheave.Error, match="no equilibrium was found"):
        sim.statics()


def test_modes_and_linearised_motion_of_a_pendulum():
    scene = two_links(damping=0.2)
    sim = sheave.load(scene)
    sim.place({"shoulder": -np.pi / 2})
    a, b = sim.linearised()
    mass = sim.mass_matrix()
    # Both links hang: K has (m1 c1 + m2 l1 + m2 c2) g, m2 c2 g.
    stiffness = 10 * np.array([[2 * 0.5 + 1.5 * 1.3, 1.5 * 0.3], [1.5 * 0.3, 1.5 * 0.3]])
    assert a[2:, :2] == pytest.approx(-np.linalg.solve(mass, stiffness), rel=1e-7)
    assert a[2:, 2:] == pytest.approx(-0.2 * np.linalg.inv(mass), rel=1e-7)
    assert b[2:] == pytest.approx(np.linalg.inv(mass), rel=1e-10)
    modes = sim.modes()
    squares = np.sort(np.linalg.eigvals(np.linalg.solve(mass, stiffness)).real)
    assert modes.eigenvalues == pytest.approx(squares, rel=1e-7)
    assert modes.frequencies == pytest.approx(np.sqrt(squares) / (2 * np.pi), rel=1e-7)
    assert modes.joint_shapes.T @ mass @ modes.joint_shapes == pytest.approx(np.eye(2), abs=1e-9)
    assert np.sort_complex(modes.poles) == pytest.approx(np.sort_complex(np.linalg.eigvals(a)),
                                                         rel=1e-6)
    assert len(modes.freedom_names) == len(modes.shapes)


def test_questions_do_not_change_the_run():
    path = ROOT / "scenes/machines/crane.json"
    asked, plain = sheave.load(path), sheave.load(path)
    for _ in range(10):
        asked.bias_forces()
        asked.moment_arms()
        asked.modes()
        asked.statics()
        asked.step()
        plain.step()
    assert asked.hash == plain.hash
    assert asked.certificate() == plain.certificate()


@pytest.mark.parametrize("wrong, message", [
    (lambda sim: sim.place({"knee": 1}), "no coordinate \"knee\"; there are: shoulder.angle"),
    (lambda sim: sim.place({"elbow": "x"}), "elbow: must be"),
    (lambda sim: sim.place(["elbow"]), "joints: must be a dict"),
    (lambda sim: sim.place({"elbow": float("nan")}), "number"),
    (lambda sim: sim.place({"elbow": 0}, keep="both"), "keep: must be"),
    (lambda sim: sim.inverse_dynamics([1, 2, 3]), "one for each of the 2 coordinates"),
    (lambda sim: sim.inverse_dynamics([1, float("inf")]), "finite"),
    (lambda sim: sim.jacobian("foot"), "foot"),
    (lambda sim: setattr(sim, "qvel", [1]), "coordinates"),
    (lambda sim: setattr(sim, "qpos", [1, float("nan")]), "number"),
    (lambda sim: sim.linearised(), "not at rest"),
    (lambda sim: sim.statics(load_steps=0), "load_steps"),
    (lambda sim: sim.step(before_substep=lambda own: own.mass_matrix()), "within a step"),
])
def test_wrong_calls_are_told_and_change_nothing(arm, wrong, message):
    before = arm.hash
    with pytest.raises(sheave.Error, match=message):
        wrong(arm)
    assert arm.hash == before


def test_loops_that_cannot_close_are_told():
    bars = [("crank", [0, 0.2, 0]), ("coupler", [0.5, 0.7, 0]), ("rocker", [1, 0.5, 0])]
    pins = [("a", None, "crank", [0, 0, 0]), ("b", "crank", "coupler", [0, 0.4, 0]),
            ("c", "coupler", "rocker", [1, 1, 0]), ("d", None, "rocker", [1, 0, 0])]
    sim = sheave.load({
        "format": "sheave-scene/1", "duration": 1, "gravity": [0, 0, 0],
        "bodies": [{"name": name, "mobility": "planar", "mass": 1, "inertia": [1, 1, 1],
                    "position": at} for name, at in bars],
        "joints": [{"type": "hinge", "name": name, **({"body_a": a} if a else {}), "body_b": b,
                    "anchor": at, "axis": Z} for name, a, b, at in pins]})
    assert sim.coordinate_names == ["a.angle"]
    sim.joints["a"].angle = 0.4
    ends = sim.bodies["crank"].point((0, 0.2, 0)), sim.bodies["coupler"].point((-0.5, -0.3, 0))
    assert ends[0] == pytest.approx(ends[1], abs=1e-12)
    with pytest.raises(sheave.Error, match="cannot be closed: a residual of"):
        sim.joints["d"].angle = -1.5


def test_edited_worlds_have_coordinates(atwood):
    with atwood.edit() as edit:
        edit.remove_cable("cable")
        edit.remove_body("light")
    assert atwood.coordinate_names == ["wheel.turn", "heavy.along"]
    assert atwood.moment_arms().shape == (0, 2)
    assert atwood.bias_forces() == pytest.approx([0, 20], abs=1e-12)


def luffing_boom(dt):
    """A boom on a universal joint, with a wheel on it whose rope holds a hook."""
    return {
        "format": "sheave-scene/1", "duration": 1, "gravity": [0, -10, 0],
        "step": {"dt": dt, "substeps": 1},
        "bodies": [
            {"name": "boom", "mass": 3, "inertia": [0.4, 0.5, 0.7], "position": [0.5, 0.5, 0]},
            {"name": "sheave", "mobility": "rotor", "mount": "boom", "mass": 1,
             "position": [1, 1, 0],
             "shape": {"type": "cylinder", "radius": 0.1, "length": 0.05}},
            {"name": "hook", "mass": 2, "inertia": [1, 1, 1], "position": [1.1, -1, 0]}],
        "joints": [{"type": "universal", "name": "foot", "body_b": "boom", "anchor": [0, 0, 0],
                    "axis_a": [1, 0, 0], "axis_b": Z}],
        "cables": [{"name": "rope", "compliance": 1e-3, "links": [
            {"type": "attachment", "body": "world", "point": [0, 1.1, 0]},
            {"type": "rolling", "body": "sheave", "winding": "clockwise"},
            {"type": "attachment", "body": "hook"}]}],
    }


def tilted_boom(dt):
    sim = sheave.load(luffing_boom(dt))
    sim.place({"foot.angle_a": 0.3, "foot.angle_b": -0.2}, keep="tension")
    sim.qvel = 0.3 * np.arange(1, 10)
    return sim


def test_a_wheel_on_a_tilted_boom_has_the_arms_of_differences():
    sim = tilted_boom(0.001)
    names, q, arms, here = sim.coordinate_names, sim.qpos, sim.moment_arms(), sim.snapshot()
    step = 1e-5  # the error of a central difference is of its square, and of rounding over it
    for i, name in enumerate(names):
        if "turn_" in name:
            continue
        lengths = []
        for way in (step, -step):
            sim.place({name: q[i] + way})
            lengths.append(sim.cable_lengths())
            sim.restore(here)
        assert (lengths[0] - lengths[1]) / (2 * step) == pytest.approx(arms[:, i], abs=1e-8), name


def test_a_cable_comes_back_from_a_way_to_and_fro():
    sim = tilted_boom(0.001)
    length, rest = sim.cable_lengths(), sim.rest_lengths.copy()
    sim.place({"foot.angle_a": -0.5, "foot.angle_b": 0.6})
    assert abs(sim.cable_lengths()[0] - length[0]) > 0.1
    sim.place({"foot.angle_a": 0.3, "foot.angle_b": -0.2})
    assert sim.cable_lengths() == pytest.approx(length, abs=1e-10)
    assert sim.rest_lengths == pytest.approx(rest, abs=1e-10)


def test_inertia_and_tensions_balance_in_space():
    # The means over a step differ from its start in first order of the step.
    errors = []
    for dt in (2e-5, 1e-5):
        sim = tilted_boom(dt)
        before, here = sim.qvel, sim.snapshot()
        sim.step()
        tensions, acceleration = sim.tensions.copy(), (sim.qvel - before) / dt
        sim.restore(here)
        errors.append(np.linalg.norm(sim.inverse_dynamics(acceleration)
                                     + sim.moment_arms(True).T @ tensions))
    assert errors[0] / errors[1] == pytest.approx(2, abs=0.1)
    assert errors[1] < 1e-3


def test_too_many_bodies_are_told():
    balls = [{"name": f"b{i}", "mass": 1, "inertia": [1, 1, 1], "position": [i, 0, 0]}
             for i in range(201)]
    sim = sheave.load({"format": "sheave-scene/1", "duration": 1, "gravity": [0, 0, 0],
                       "bodies": balls})
    with pytest.raises(sheave.Error, match="1206 degrees of freedom.*at most 1200"):
        sim.mass_matrix()
    with pytest.raises(sheave.Error, match="1206 degrees of freedom"):
        sim.place({"b0.x": 1})

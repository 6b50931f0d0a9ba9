"""Many worlds at once."""

import os
import signal
import threading

import numpy as np
import pytest
from conftest import ATWOOD, ROOT

import sheave

MASSES = np.linspace(1.5, 4.0, 6)


def batch(threads=2, n=6, scene=ATWOOD, **more):
    return sheave.Batch(scene, n, vary={"/bodies/heavy/mass": MASSES[:n]}, threads=threads, **more)


@pytest.mark.parametrize("threads", [1, 2, 3, 7])
@pytest.mark.parametrize("scene", ["analytic/atwood", "machines/load-at-a-height", "paper/gear"])
def test_is_a_loop_to_the_bit(threads, scene):
    path = ROOT / f"scenes/{scene}.json"
    first = sheave.load(path).body_names
    name = next(own for own in first if sheave.load(path).bodies[own].mobility != "static")
    values = [1.0, 2.0, 3.0, 5.0]
    pointer = f"/bodies/{name}/force"
    many = sheave.Batch(path, 4, vary={pointer: [[0, v, 0] for v in values]}, threads=threads)
    many.step(15)
    for i, value in enumerate(values):
        one = sheave.load(path, set={pointer: [0, value, 0]})
        one.step(15)
        assert f"{many.hashes[i]:016x}" == one.hash


@pytest.mark.parametrize("threads", [1, 3])
def test_with_a_tolerance_is_a_loop_to_the_bit(threads):
    # Each world chooses the lengths of its own substeps: the rope jerks the loads at different times.
    path = ROOT / "bench/tolerance/jerk.json"
    own = {"/step/tolerance": 1e-4}
    masses = [0.5, 1.0, 1.7, 3.0]
    many = sheave.Batch(path, 4, vary={"/bodies/load/mass": masses}, set=own, threads=threads)
    many.step(60)
    for i, mass in enumerate(masses):
        one = sheave.load(path, set={**own, "/bodies/load/mass": mass})
        one.step(60)
        assert f"{many.hashes[i]:016x}" == one.hash


def test_follows_the_closed_form():
    many = batch()
    many.run(0.5)  # later the lighter weight comes to the wheel
    a = (MASSES - 1.0) * 10.0 / (MASSES + 1.5)
    assert np.allclose(many.observe("heavy.vy"), -0.5 * a, rtol=1e-9)
    assert np.allclose(many.observe(["cable.0.tension", "cable.1.tension"]),
                       np.stack([10 + a, MASSES * (10 - a)], axis=1), rtol=1e-6)
    assert np.allclose(many.time, 0.5)


def test_results_have_a_row_for_each_world():
    many = batch()
    assert len(many) == 6 and many.positions.shape == (6, 3, 3)
    assert many.velocities.shape == many.angular_velocities.shape == (6, 3, 3)
    assert many.orientations_xyzw.shape == (6, 3, 4)
    assert many.observe([]).shape == (6, 0)
    assert np.isnan(many.observe("cable.0.tension")).all()
    rows = many.record(["heavy.y", "light.y"], 10, every=5)
    assert rows.shape == (6, 3, 2)
    assert np.array_equal(rows[:, -1], many.observe(["heavy.y", "light.y"]))
    assert "6 worlds" in repr(many) and "heavy.y" in many.observables


def test_each_world_has_its_warnings():
    scene = {"format": "sheave-scene/1", "duration": 1, "gravity": [0, -10, 0],
             "bodies": [{"name": "load", "mobility": "slider", "axis": [0, 1, 0], "mass": 2,
                         "position": [0, -2, 0]}],
             "cables": [{"name": "rope", "axial_stiffness": 1e4, "rest_lengths": [1], "links": [
                 {"type": "attachment", "body": "world"},
                 {"type": "attachment", "body": "load"}]}]}
    many = sheave.Batch(scene, 3, vary={"/cables/rope/rest_lengths": [[1.0], [1.996], [2.0]]})
    kinds = [[warning["kind"] for warning in many.warnings(i)] for i in range(3)]
    # The second hangs at 20 N, its rest: 1.996 m x 20 N / 1e4 N = 4 mm.
    assert kinds == [["strained_start"], [], ["unsettled_start"]]
    with pytest.raises(sheave.ArgumentError, match="world"):
        many.warnings(3)
    one = sheave.Batch(ROOT / "tests/import/models/arm26.xml", 2)
    assert one.warnings(1)[0]["kind"] == "import"


def test_the_duration_is_that_of_the_settings():
    many = sheave.Batch(ATWOOD, 2, vary={"/bodies/heavy/mass": [1.0, 2.0]}, set={"/duration": 0.25})
    assert many.duration == 0.25


def test_controls_are_set_world_by_world():
    many = batch()
    many.set("heavy.force_y", np.arange(6.0))
    many.set("light.force_y", 1.0, mask=np.arange(6) < 2)
    many.step(3)
    one = sheave.load(ATWOOD, set={"/bodies/heavy/mass": MASSES[1]})
    one.set("heavy.force_y", 1.0)
    one.set("light.force_y", 1.0)
    one.step(3)
    assert f"{many.hashes[1]:016x}" == one.hash
    many.clear("heavy.force_y")
    many.step()


def test_resets_some():
    many = batch()
    many.step(8)
    before = many.hashes
    chosen = np.array([True, False] * 3)
    many.reset(chosen)
    assert many.steps.tolist() == [0, 8] * 3
    many.step(8, chosen)
    assert np.array_equal(many.hashes, before)
    many.mark_start()
    many.step(2)
    many.reset()
    assert np.array_equal(many.hashes, before)


def test_states_are_kept():
    many = batch()
    many.step(4)
    kept, before = many.states(), many.hashes
    many.step(4)
    many.restore(kept)
    assert np.array_equal(many.hashes, before)
    many.step(1)
    many.restore(kept, np.arange(6) == 2)
    assert many.steps.tolist() == [5, 5, 4, 5, 5, 5]


def test_a_world_that_diverges_is_marked_and_others_go_on():
    many = batch()
    many.set("heavy.force_y", -1e300, mask=np.arange(6) == 3)
    many.step(30)
    assert many.diverged.tolist() == [False, False, False, True, False, False]
    assert "heavy" in many.divergence(3) or many.divergence(3)
    assert many.divergence(0) == ""
    assert np.isfinite(many.observe("heavy.y")).all()
    assert np.allclose(many.time[[0, 1, 2, 4, 5]], 0.5)
    many.reset(many.diverged)
    assert not many.diverged.any()


def test_a_world_that_is_stopped_waits():
    scene = dict(ATWOOD, triggers=[{"name": "low", "quantity": "heavy.y", "below": -2.5,
                                    "action": "stop"}])
    many = batch(scene=scene)
    many.run()
    assert many.stopped[-1] and not many.stopped[0] or many.stopped.all()
    steps = many.steps
    many.step(3, many.stopped)
    assert np.array_equal(many.steps, steps)
    many.reset()
    assert not many.stopped.any()


@pytest.mark.parametrize("arguments, text", [
    (dict(n=0), "n: must be"),
    (dict(n="3"), "n: must be"),
    (dict(n=2, threads=0), "threads: must be"),
    (dict(n=2, vary={"/bodies/heavy/mass": [1]}), "must have 2 values"),
    (dict(n=2, vary={"/bodies/heavy/mass": 3.0}), "must have 2 values"),
    (dict(n=2, vary={"/bodies/heavy/mass": "ab"}), "must have 2 values"),
    (dict(n=2, vary={"/bodies/heavy/mass": [1, object()]}), "JSON"),
])
def test_arguments_are_checked(arguments, text):
    with pytest.raises(sheave.ArgumentError, match=text):
        sheave.Batch(ATWOOD, **arguments)


@pytest.mark.parametrize("vary, text", [
    ({"/bodies/heavy/mass": [1, -1]}, "world 1"),
    ({"/bodies/hevy/mass": [1, 1]}, "heavy"),
    ({"/bodies/heavy/name": ["a", "b"]}, "no body|unknown"),
    ({"/bodies/light/mobility": ["slider", "free"]}, "."),
    ({"/cables": [[], ATWOOD["cables"]]}, "observables"),
])
def test_worlds_that_cannot_be_are_told(vary, text):
    with pytest.raises(sheave.SceneError, match=text):
        sheave.Batch(ATWOOD, 2, vary=vary)


@pytest.mark.parametrize("call, kind", [
    (lambda b: b.step(-1), sheave.ArgumentError),
    (lambda b: b.step(1, [True]), sheave.ArgumentError),
    (lambda b: b.step(1, np.ones(6)), sheave.ArgumentError),
    (lambda b: b.observe("nothing"), sheave.UnknownNameError),
    (lambda b: b.observe(3), sheave.ArgumentError),
    (lambda b: b.set("heavy.force_y", [1, 2]), sheave.ArgumentError),
    (lambda b: b.set("heavy.force_y", "1"), sheave.ArgumentError),
    (lambda b: b.set("heavy.force_q", 1), sheave.UnknownNameError),
    (lambda b: b.set(1, 1), sheave.ArgumentError),
    (lambda b: b.reset(3), sheave.ArgumentError),
    (lambda b: b.restore([b""] * 6), sheave.StateError),
    (lambda b: b.restore([1] * 6), sheave.ArgumentError),
    (lambda b: b.restore(3), sheave.ArgumentError),
    (lambda b: b.divergence(6), sheave.ArgumentError),
    (lambda b: b.divergence("a"), sheave.ArgumentError),
])
def test_bad_arguments_are_refused(call, kind):
    many = batch()
    before = many.hashes
    with pytest.raises(kind):
        call(many)
    assert np.array_equal(many.hashes, before)


def test_an_interruption_ends_a_batch():
    many = batch()
    timer = threading.Timer(0.2, lambda: os.kill(os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        while True:
            many.step(2000)
    many.step()


def environment(**more):
    return sheave.VectorEnvironment(
        ATWOOD, 5, ["heavy.y", "heavy.vy"], ["heavy.force_y"], -20.0, 20.0,
        reward=lambda seen, actions: -np.abs(seen[:, 0]),
        terminated=lambda seen: seen[:, 0] < -2.2, most_steps=30, **more)


def test_an_environment_keeps_the_conventions():
    env = environment(steps_per_action=2)
    seen, info = env.reset(seed=3)
    assert seen.shape == (5, 2) and info == {} and env.num_envs == 5
    assert env.action_space.shape == (1,) and env.observation_space.shape == (2,)
    actions = env.action_space.sample(5, np.random.default_rng(1))
    assert actions.shape == (5, 1)
    seen, rewards, terminated, truncated, info = env.step(actions)
    assert rewards.shape == terminated.shape == truncated.shape == (5,)
    assert env.batch.steps.tolist() == [2] * 5 and not info["diverged"].any()


def test_worlds_that_have_ended_begin_anew():
    env = environment()
    env.reset()
    forces = np.array([[-20.0], [0.0], [10.0], [10.0], [10.0]])
    ended = np.zeros(5, bool)
    for _ in range(31):
        _, _, terminated, truncated, _ = env.step(forces)
        begins, ended = terminated[0] and not ended[0], ended | terminated | truncated
        if begins:
            steps = env.batch.steps[0]
            _, rewards, terminated, _, _ = env.step(forces)
            assert env.batch.steps[0] == 0 and steps > 0 and rewards[0] == 0.0
            assert not terminated[0]
    assert ended.all()


def test_resets_may_be_random_and_follow_the_seed():
    def scatter(worlds, chosen, random):
        worlds.set("light.force_y", random.uniform(-1, 1, len(worlds)), mask=chosen)

    env = environment(on_reset=scatter)
    hashes = []
    for _ in range(2):
        env.reset(seed=7)
        env.step(np.zeros((5, 1)))
        hashes.append(env.batch.hashes)
    assert np.array_equal(*hashes)
    assert len(set(hashes[0].tolist())) == 5


@pytest.mark.parametrize("actions", [np.zeros(5), np.zeros((4, 1)), [[1, 2]] * 5, 0.0, "a", [["a"]] * 5])
def test_actions_must_fit(actions):
    env = environment()
    env.reset()
    with pytest.raises(sheave.ArgumentError, match="actions"):
        env.step(actions)


def test_bounds_must_fit():
    with pytest.raises(sheave.ArgumentError, match="low, high"):
        sheave.VectorEnvironment(ATWOOD, 2, ["heavy.y"], ["heavy.force_y"], [1, 2], 3.0,
                                 reward=lambda seen, actions: seen[:, 0])


@pytest.mark.parametrize("wrong, message", [
    ({"low": 2.0, "high": 1.0}, "low must be at most high"),
    ({"low": np.nan}, "low must be at most high"),
    ({"most_steps": 0}, "most_steps: must be an integer of at least 1, was 0"),
    ({"most_steps": "a"}, "most_steps: must be an integer"),
    ({"steps_per_action": 0}, "steps_per_action: must be an integer of at least 1, was 0"),
    ({"steps_per_action": 1.5}, "steps_per_action: must be an integer"),
])
def test_wrong_settings_are_refused_when_it_is_made(wrong, message):
    settings = {"low": -1.0, "high": 1.0, "reward": lambda seen, actions: seen[:, 0], **wrong}
    with pytest.raises(sheave.ArgumentError, match=message):
        sheave.VectorEnvironment(ATWOOD, 2, ["heavy.y"], ["heavy.force_y"], **settings)


def test_an_unknown_action_is_refused_when_it_is_made():
    with pytest.raises(sheave.UnknownNameError, match='near it are "heavy.force_y"'):
        sheave.VectorEnvironment(ATWOOD, 2, ["heavy.y"], ["heavy.forc_y"], -1, 1,
                                 reward=lambda seen, actions: seen[:, 0])


def test_checking_the_actions_changes_no_world():
    fresh = sheave.Batch(ATWOOD, 5)
    assert np.array_equal(environment().batch.hashes, fresh.hashes)


@pytest.mark.parametrize("options", [5, [1], {"seed": 1}])
def test_other_options_are_refused(options):
    with pytest.raises(sheave.ArgumentError, match="options"):
        environment().reset(options=options)


@pytest.mark.parametrize("reward", [lambda seen, actions: seen[:, :1], lambda seen, actions: 1.0,
                                    lambda seen, actions: ["a"] * 5])
def test_a_reward_of_another_shape_is_refused_when_it_is_made(reward):
    with pytest.raises(sheave.ArgumentError, match="reward: must give 5 numbers"):
        sheave.VectorEnvironment(ATWOOD, 5, ["heavy.y"], ["heavy.force_y"], -1, 1, reward=reward)


def test_an_end_of_another_shape_is_refused():
    with pytest.raises(sheave.ArgumentError, match="terminated: must give 5 numbers"):
        sheave.VectorEnvironment(ATWOOD, 5, ["heavy.y"], ["heavy.force_y"], -1, 1,
                                 reward=lambda seen, actions: seen[:, 0],
                                 terminated=lambda seen: seen < 0)


def test_resets_take_the_options_of_gymnasium():
    env = environment()
    assert env.single_action_space is env.action_space and env.action_space.dtype == float
    env.reset(seed=1, options={})
    env.step(np.ones((5, 1)))
    env.reset(options={"reset_mask": np.arange(5) < 2})
    assert env.batch.steps.tolist() == [0, 0, 1, 1, 1]
    env.close()
    for wrong in ({"seed": -1}, {"seed": [1]}, {"options": {"mass": 3}}, {"mask": [1, 2]},
                  {"options": {"reset_mask": np.ones(5, bool)}, "mask": np.ones(5, bool)}):
        with pytest.raises(sheave.ArgumentError):
            env.reset(**wrong)


def test_a_batch_in_a_forked_process_goes_on():
    batch = sheave.Batch(ATWOOD, 4, threads=2)
    batch.step(3)
    child = os.fork()
    if child == 0:
        batch.step(2)
        os._exit(0 if (batch.steps == 5).all() else 1)
    assert os.waitpid(child, 0)[1] == 0
    assert (batch.steps == 3).all()


def test_what_is_refused_in_one_world_is_done_in_none():
    batch = sheave.Batch(ATWOOD, 4)
    batch.step(2)
    before = batch.hashes
    with pytest.raises(sheave.Error, match="world 2"):
        batch.set("heavy.force_y", [1.0, 1.0, float("nan"), 1.0])
    assert (batch.hashes == before).all()
    states = batch.states()
    batch.step(3)
    before = batch.hashes
    with pytest.raises(sheave.StateError):
        batch.restore([*states[:3], b"nothing"])
    assert (batch.hashes == before).all()


@pytest.mark.parametrize("wrong", [np.array([]), "1", float("nan"), True, [1]])
def test_arguments_of_run_and_record_are_told(wrong):
    batch = sheave.Batch(ATWOOD, 2)
    with pytest.raises(sheave.ArgumentError, match="until: "):
        batch.run(wrong)
    if wrong is not True:
        with pytest.raises(sheave.ArgumentError, match="steps: "):
            batch.record(["heavy.y"], steps=wrong)
        with pytest.raises(sheave.ArgumentError, match="every: "):
            batch.record(["heavy.y"], steps=2, every=wrong)


class EmptiesItsList(list):
    """A list whose items, as they make themselves numbers or truth values, empty it."""

    class Item:
        def __init__(self, values):
            self.values = values

        def __float__(self):
            self.values.clear()
            return 1.0

        def __bool__(self):
            self.values.clear()
            return True

    def __init__(self, n):
        super().__init__()
        self.extend(self.Item(self) for _ in range(n))


def test_lists_that_change_as_they_are_read_are_taken_as_they_were():
    many = batch()
    many.set("light.force_y", EmptiesItsList(6))
    many.set("heavy.force_y", [np.float64(1.0), 2, 3.0, np.int32(4), True, 6.0])
    with pytest.raises(TypeError, match="mask: .*6 truth values"):
        many.set("light.force_y", 1.0, mask=EmptiesItsList(6))
    many.set("light.force_y", 1.0, mask=[True, np.False_, False, True, False, np.True_])
    for wrong in ([1.0] * 5, [[1.0]] * 6, ["1"] * 6, [None] * 6, b"123456", {}, [1.0, [2.0]] * 3):
        with pytest.raises((TypeError, ValueError), match="value"):
            many.set("light.force_y", wrong)
    for wrong in ([1] * 6, [True] * 5, [[True]] * 6, "tttttt", b"123456", 3):
        with pytest.raises((TypeError, ValueError), match="mask"):
            many.set("light.force_y", 1.0, mask=wrong)


def test_an_end_that_no_count_of_steps_reaches_is_refused():
    for runs in (batch(), sheave.load(ATWOOD)):
        with pytest.raises(sheave.Error, match="until: must be at most 9e15 steps away"):
            runs.run(until=1e30)


def test_names_are_a_list_of_strings():
    simulation = sheave.load(ATWOOD)
    for wrong in (np.array(1, dtype="u1"), [1], b"heavy.y", {1: 2}, 3):
        with pytest.raises((TypeError, sheave.Error), match="names"):
            simulation.record(wrong, 3)


class Unsized:
    """What says that it has a length, and has none."""

    def __len__(self):
        raise ZeroDivisionError("no length")

    def __iter__(self):
        raise ZeroDivisionError("no items")


@pytest.mark.parametrize("wrong", [np.array(1.0), Unsized(), b"12", {"a": 1, "b": 2}, iter([1.0] * 3), 1])
def test_varied_values_must_be_one_for_each_world(wrong):
    with pytest.raises(sheave.ArgumentError, match="/bodies/heavy/mass must have 2 values"):
        sheave.Batch(ATWOOD, 2, vary={"/bodies/heavy/mass": wrong})
    with pytest.raises(sheave.ArgumentError, match="vary: must be a dict"):
        sheave.Batch(ATWOOD, 2, vary=[wrong])


@pytest.mark.parametrize("wrong", [np.array(b"state"), Unsized(), b"12", 1, None, [b""], [b"", 2]])
def test_states_must_be_one_for_each_world(wrong):
    batch = sheave.Batch(ATWOOD, 2)
    before = batch.hashes
    with pytest.raises((sheave.ArgumentError, sheave.StateError)):
        batch.restore(wrong)
    assert (batch.hashes == before).all()


def test_positions_are_read_only():
    many = batch()
    for values in (many.positions, many.velocities, many.angular_velocities, many.orientations_xyzw):
        with pytest.raises(ValueError, match="read-only"):
            values[:] = 7.0


@pytest.mark.parametrize("mobility", ["planar", "rotor"])
def test_a_state_of_another_world_is_taken_as_it_is(mobility):
    scene = {"format": "sheave-scene/1", "duration": 1, "gravity": [0, 0, 0], "bodies": [
        {"name": "arm", "mobility": mobility, "mass": 1, "rotation": {"axis": [0, 0, 1], "degrees": 0},
         "shape": {"type": "box", "size": [1, 0.1, 0.1]}}]}
    many = sheave.Batch(scene, 2, vary={"/bodies/arm/rotation/degrees": [10.0, 40.0]})
    states = many.states()
    many.restore([states[0], states[0]])
    before = many.orientations_xyzw
    many.step()
    assert np.allclose(many.orientations_xyzw, before, atol=1e-15)
    assert np.allclose(many.orientations_xyzw[1], many.orientations_xyzw[0], atol=1e-15)

"""Stepping, reading, setting."""

import copy
import os
import pickle
import signal
import threading
import time

import numpy as np
import pytest
from conftest import ATWOOD, ROOT

import sheave

BELT = ROOT / "scenes/analytic/belt.json"

def test_moves_by_the_closed_form(atwood):
    atwood.run()
    # a = (m2 - m1) g / (m1 + m2 + I / r^2) with I = m r^2 / 2
    a = 10.0 / 3.5
    assert atwood.bodies["heavy"].velocity[1] == pytest.approx(-a, rel=1e-9)
    assert atwood.cables["cable"].tension(0) == pytest.approx(10.0 + a, rel=1e-6)
    assert atwood.time == pytest.approx(1.0)
    assert atwood.steps * atwood.dt == pytest.approx(1.0)


def test_energy_is_kept(atwood):
    before = atwood.energy["total"]
    atwood.run()
    assert atwood.energy["total"] == pytest.approx(before, rel=1e-9)


@pytest.mark.parametrize("scene", [
    ATWOOD,
    str(ROOT / "scenes/analytic/atwood.json"),
    ROOT / "scenes/analytic/atwood.json",
    (ROOT / "scenes/analytic/atwood.json").read_text(),
    sheave.Model.load(ATWOOD),
], ids=["dict", "str", "path", "text", "model"])
def test_loads_scenes_in_all_forms(scene):
    assert len(sheave.load(scene).bodies) == 3


def test_settings_are_replaced_by_pointers():
    sim = sheave.load(ATWOOD, set={"/bodies/heavy/mass": 1.0, "/gravity": np.array([0.0, -1, 0])})
    sim.step(10)
    assert sim.bodies["heavy"].velocity[1] == pytest.approx(0.0, abs=1e-12)
    assert sim.gravity == (0.0, -1.0, 0.0)


def test_a_setting_that_cannot_be_is_told_as_such():
    with pytest.raises(sheave.SceneError) as caught:
        sheave.load(ATWOOD, set={"/bodies/heavy/mass": -1})
    assert "/bodies/heavy/mass" in str(caught.value)
    assert caught.value.faults[0].code == "out-of-range"


def test_before_step_and_before_substep_set_controls(atwood):
    calls = []
    atwood.step(3, before_step=lambda sim: calls.append(sim.steps))
    assert calls == [0, 1, 2]
    substeps = []
    atwood.step(2, before_substep=lambda sim: substeps.append(sim.time))
    assert len(substeps) == 8  # four for each step
    force = atwood.bodies["light"].set_force
    before = atwood.bodies["light"].velocity[1]
    atwood.step(5, before_step=lambda sim: force((0, 100.0, 0)))
    assert atwood.bodies["light"].velocity[1] > before + 1.0


def test_callables_get_the_same_simulation(atwood):
    seen = []
    atwood.step(1, before_step=seen.append)
    assert seen == [atwood] and seen[0] is atwood


@pytest.mark.parametrize("where", ["before_step", "before_substep"])
def test_what_a_callable_raises_ends_the_step(atwood, where):
    atwood.step(5)
    before = atwood.hash

    def fails(sim):
        sim.bodies["light"].set_force((0, 1, 0)) if where == "before_substep" else None
        raise RuntimeError("a fault of ours")

    with pytest.raises(RuntimeError, match="a fault of ours"):
        atwood.step(5, **{where: fails})
    assert atwood.steps == 5
    assert atwood.hash == before
    assert atwood.step()


def test_an_error_in_the_third_step_keeps_the_first_two(atwood):
    def fails(sim):
        if sim.steps == 2:
            raise ValueError

    with pytest.raises(ValueError):
        atwood.step(5, before_step=fails)
    assert atwood.steps == 2


def test_a_step_within_a_step_is_refused(atwood):
    with pytest.raises(sheave.Error, match="from within"):
        atwood.step(1, before_substep=lambda sim: sim.step())
    with pytest.raises(sheave.Error):
        atwood.step(1, before_substep=lambda sim: sim.bodies["light"].place((0, 1, 0)))


def test_callables_do_not_change_what_is_computed():
    one, other = sheave.load(ATWOOD), sheave.load(ATWOOD)
    one.step(20)
    other.step(20, before_step=lambda sim: None, before_substep=lambda sim: None)
    assert one.hash == other.hash


def test_another_thread_cannot_use_what_steps():
    sim = sheave.load(ROOT / "scenes/paper/hand.json")
    refused = []
    thread = threading.Thread(target=lambda: sim.step(60))
    thread.start()
    while thread.is_alive():
        try:
            _ = sim.time
            sim.step()
        except sheave.Error as error:
            refused.append(str(error))
        time.sleep(0.0005)
    thread.join()
    assert not refused or "another thread" in refused[0]
    sim.step()


def test_two_simulations_step_in_two_threads():
    # A belt runs for ever; a weight on a rope comes to its wheel.
    sims = [sheave.load(BELT) for _ in range(2)]
    threads = [threading.Thread(target=sim.step, args=(500,)) for sim in sims]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert sims[0].hash == sims[1].hash
    assert sims[0].steps == 500


def test_an_interruption_ends_a_long_run():
    belt = sheave.load(BELT)
    timer = threading.Timer(0.2, lambda: os.kill(os.getpid(), signal.SIGINT))
    timer.start()
    begin = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        belt.step(2**40)
    assert time.monotonic() - begin < 20.0
    assert 0 < belt.steps
    assert belt.step()


def test_snapshots_go_back_to_the_bit(atwood):
    atwood.step(5)
    kept = atwood.snapshot()
    atwood.step(7)
    later = atwood.hash
    atwood.restore(kept)
    assert atwood.hash == kept.hash and atwood.steps == kept.steps == 5
    atwood.step(7)
    assert atwood.hash == later
    atwood.reset()
    assert atwood.steps == 0


def test_a_snapshot_of_another_world_is_refused(atwood):
    with pytest.raises(sheave.Error, match="another world"):
        atwood.restore(sheave.load(ATWOOD).snapshot())


def test_states_are_saved_and_loaded(atwood, tmp_path):
    atwood.step(9)
    atwood.save_state(tmp_path / "state")
    other = sheave.load(ATWOOD)
    other.load_state(tmp_path / "state")
    assert other.hash == atwood.hash
    with pytest.raises(sheave.StateError):
        other.set_state_bytes(b"nonsense")
    with pytest.raises(sheave.StateError):
        sheave.load(ROOT / "scenes/paper/pulley.json").load_state(tmp_path / "state")
    with pytest.raises(sheave.StateError, match="another dt"):
        sheave.load(ATWOOD, set={"/step": {"dt": 0.01}}).load_state(tmp_path / "state")


def test_states_that_have_been_changed_are_refused(atwood):
    atwood.step(3)
    good = atwood.state_bytes()
    other = sheave.load(ATWOOD)
    before = other.hash
    for place in range(len(good)):
        changed = bytearray(good)
        changed[place] ^= 1 + place % 255
        with pytest.raises(sheave.StateError):
            other.set_state_bytes(bytes(changed))
    assert other.hash == before
    # Those of versions without a checksum, and of other machines of this kind, are warned of.
    with pytest.warns(UserWarning, match="without a checksum"):
        other.set_state_bytes(b"SHSTATE2" + good[32:-16])
    assert other.hash == atwood.hash
    with pytest.warns(UserWarning, match="other settings"):
        sheave.load(ATWOOD, set={"/bodies/heavy/mass": 7}).set_state_bytes(good)


def test_steps_warn_of_what_they_could_not_do():
    sim = sheave.load({
        "format": "sheave-scene/1", "gravity": [0, 0, 0], "duration": 1, "step": {"dt": 0.01},
        "bodies": [{"name": "winch", "mobility": "rotor", "axis": [0, 0, 1], "mass": 1,
                    "shape": {"type": "cylinder", "radius": 0.1, "length": 0.1}, "drive": "speed",
                    "drive_times": [0, 0.02, 0.03], "drive_values": [1, 1, -1]}],
        "cables": [{"name": "rope", "links": [
            {"type": "spool", "body": "winch", "winding": "clockwise", "stored_length": 1},
            {"type": "attachment", "body": "world", "point": [0, -2, 0]}]}]})
    assert sim.warnings == []
    sim.step(20)
    assert [warning["kind"] for warning in sim.warnings] == ["stalled"]
    assert sim.warnings[0]["subject"] == "rope"
    assert "its drive draws more cable than there is" in sim.warnings[0]["message"]


DRAWN = {"format": "sheave-scene/1", "duration": 1, "gravity": [0, -10, 0],
         "bodies": [{"name": "load", "mobility": "slider", "axis": [0, 1, 0], "mass": 2,
                     "position": [0, -2, 0]}],
         "cables": [{"name": "rope", "axial_stiffness": 1e4, "rest_lengths": [1], "links": [
             {"type": "attachment", "body": "world"}, {"type": "attachment", "body": "load"}]}]}


def test_a_start_that_is_hardly_meant_is_told():
    sim = sheave.load(DRAWN)
    assert [warning["kind"] for warning in sim.warnings] == ["strained_start"]
    assert "stretched by 100 % in span 0" in sim.warnings[0]["message"]
    assert sheave.load(DRAWN, set={"/start": "pose"}).warnings == []
    slack = sheave.load(DRAWN, set={"/cables/rope/rest_lengths": [2]})  # hangs 4 mm lower at rest
    assert [warning["kind"] for warning in slack.warnings] == ["unsettled_start"]


def test_an_import_tells_of_its_gaps():
    sim = sheave.load(ROOT / "tests/import/models/arm26.xml")
    kinds = [warning["kind"] for warning in sim.warnings]
    assert kinds[0] == "import"
    assert sim.warnings[0]["message"]


def test_a_divergence_is_raised():
    sim = sheave.load(ATWOOD)
    sim.bodies["heavy"].set_force((0, -1e300, 0))
    with pytest.raises(sheave.DivergenceError, match="."):
        sim.step(100)
    assert np.isfinite(sim.positions).all()


def test_a_trigger_stops_the_run():
    scene = dict(ATWOOD, triggers=[{"name": "low", "quantity": "heavy.y", "below": -2.5,
                                    "action": "stop"}])
    sim = sheave.load(scene)
    assert sim.run() is False
    assert sim.stopped and sim.time < 1.0
    assert sim.bodies["heavy"].position[1] == pytest.approx(-2.5, abs=0.06)


def test_events_are_told():
    sim = sheave.load(ATWOOD)
    sim.cables["cable"].set_breaking_tension(1.0)
    sim.step(2)
    event = sim.events[0]
    assert event["kind"] == "cut" and event["name"] == "cable"
    sim.clear_events()
    assert sim.events == [] and sim.dropped_events == 0


def test_a_cut_acts_at_once(atwood):
    atwood.step(10)
    heavy, cable = atwood.bodies["heavy"], atwood.cables["cable"]
    before = heavy.velocity[1]
    cable.cut()
    atwood.step(10)
    # Free fall; each substep rounds the speed by about 1e-13 m/s.
    assert heavy.velocity[1] - before == pytest.approx(-10.0 * 10 * atwood.dt, abs=1e-10)
    assert cable.report()["cut"]
    assert [event["kind"] for event in atwood.events] == ["cut"]


def test_a_cable_can_be_drawn(atwood):
    atwood.step(10)
    cable = atwood.cables["cable"]
    line = cable.polyline(tolerance=1e-7)
    assert line.shape[1] == 3
    drawn = np.linalg.norm(np.diff(line, axis=0), axis=1).sum()
    report = cable.report()
    arcs = sum(link["stored_length"] for link in report["links"])
    # Chords with a sagitta of 1e-7 m on 0.5 m are shorter than their arc by a third of its share.
    assert drawn == pytest.approx(arcs + sum(s["length"] for s in report["spans"]), rel=1e-6)
    np.testing.assert_allclose(line[0], report["links"][0]["exit"], atol=1e-12)
    parts = [cable.polyline(k, tolerance=1e-7) for k in range(2)]
    np.testing.assert_array_equal(np.concatenate(parts), line)
    assert len(cable.polyline(1, tolerance=1e-2)) < len(parts[1])
    with pytest.raises(sheave.Error, match="has no span number 7"):
        cable.polyline(7)
    with pytest.raises(sheave.Error, match="above 0"):
        cable.polyline(tolerance=0)


def test_pieces_of_a_cut_cable_hang(atwood):
    atwood.step(10)
    cable = atwood.cables["cable"]
    cable.cut()
    atwood.step()
    piece = cable.polyline(1)
    # Plumb below its end, which is the last point.
    np.testing.assert_allclose(piece[:, 0], piece[-1, 0], atol=1e-12)
    assert piece[0, 1] < piece[-1, 1]
    with pytest.raises(ValueError, match="0 or 1, a piece of the cut cable"):
        cable.polyline()


def test_certificates_are_told(atwood):
    assert atwood.certificate() is None
    atwood.step(3)
    items = atwood.certificate()
    assert {"momentum", "length"} <= {item["kind"] for item in items}
    assert all(item["relative"] < 1e-6 for item in items)


def test_a_run_is_doubtful_as_the_command_says():
    # A driven drum that ten sweeps let run backwards.
    sim = sheave.load(ROOT / "dev/faults/a3-drum.json")
    assert not sim.doubtful
    sim.run()
    assert sim.doubtful and any(item["relative"] > 0.01 for item in sim.run_certificate())
    steady = sheave.load(ROOT / "scenes/analytic/atwood.json")
    steady.run()
    assert not steady.doubtful and steady.run_certificate()


def test_contacts_are_told():
    sim = sheave.load(ROOT / "scenes/analytic/sliding-box.json")
    sim.step(5)
    contact = sim.contacts()[0]
    assert contact["normal_force"] > 0.0 and len(contact["normal"]) == 3


def test_records_quantities(atwood):
    recording = atwood.record(["heavy.vy", "cable.0.tension"], 10, every=2)
    assert list(recording) == ["heavy.vy", "cable.0.tension"]
    assert recording.time.shape == recording["heavy.vy"].shape == (6,)
    assert np.isnan(recording["cable.0.tension"][0])
    assert np.asarray(recording).shape == (6, 2)
    frame = recording.to_pandas()
    assert frame["heavy.vy"].iloc[-1] == atwood.observe("heavy.vy")
    assert frame.index.name == "t"
    with pytest.raises(KeyError, match="heavy.vy"):
        recording["light.vy"]


def test_records_to_the_end_by_default(atwood):
    recording = atwood.record(["heavy.y"])
    assert recording.time[-1] == pytest.approx(1.0)
    assert len(atwood.record("heavy.y", 3).time) == 4


def test_a_recording_ends_at_an_edit(atwood):
    def edits(sim):
        if sim.steps == 3:
            with sim.edit() as edit:
                edit.remove_cable("cable")

    with pytest.raises(sheave.Error, match="an edit has changed"):
        atwood.record(["heavy.y"], 10, before_step=edits)


def test_plots(atwood, tmp_path):
    axes = atwood.plot("heavy.y", "light.y", steps=10)
    assert len(axes.lines) == 2
    axes.figure.savefig(tmp_path / "plot.png")
    assert (tmp_path / "plot.png").stat().st_size > 1000


def test_plots_have_axes_for_each_unit(atwood):
    from matplotlib.figure import Figure

    recording = atwood.record(["heavy.y", "cable.0.tension", "light.y", "cable.1.tension"], steps=10)
    assert dict(recording.units) == {"heavy.y": "m", "light.y": "m", "cable.0.tension": "N",
                                     "cable.1.tension": "N"}
    axes = recording.plot()
    assert [one.get_ylabel() for one in axes] == ["y [m]", "tension [N]"]
    assert [[line.get_label() for line in one.lines] for one in axes] == [
        ["heavy.y", "light.y"], ["cable.0.tension", "cable.1.tension"]]
    mine = Figure().subplots(2)
    assert recording.plot(axes=mine)[1] is mine[1]
    with pytest.raises(sheave.ArgumentError, match=r"axes: must be 2, one for each unit \(\[m\], \[N\]\)"):
        recording.plot(axes=mine[0])


def test_quantities_have_units(atwood):
    units = {name: atwood.unit(name) for name in atwood.observables}
    assert units["t"] == "s"
    assert units["heavy.qw"] == ""
    assert units["cable.link1.wrap_angle"] == "rad"
    assert units["energy.total"] == "J"
    with pytest.raises(sheave.UnknownNameError, match='did you mean "heavy'):
        atwood.unit("heavy.yv")
    with pytest.raises(sheave.ArgumentError, match="name: "):
        atwood.unit(3)


@pytest.mark.skipif(not sheave.has_render, reason="built without the renderer")
def test_pictures(atwood):
    pixels = atwood.render(160, 90)
    assert pixels.shape == (90, 160, 3) and pixels.dtype == np.uint8
    assert pixels.std() > 5.0
    assert atwood._repr_png_()[:4] == b"\x89PNG"
    with pytest.raises(sheave.ArgumentError, match="width"):
        atwood.render(3, 90)


@pytest.mark.skipif(not sheave.has_render, reason="built without the renderer")
def test_videos(atwood, tmp_path):
    shares = []
    atwood.video(tmp_path / "a.mp4", 0.1, 30, 160, 90, shares.append)
    assert (tmp_path / "a.mp4").stat().st_size > 500
    assert shares[-1] == 1.0
    with pytest.raises(sheave.ArgumentError, match="fps"):
        atwood.video(tmp_path / "b.mp4", fps=0)


def test_names_that_are_misspelt_are_no_attributes(atwood):
    for thing in (atwood, sheave.Batch(ATWOOD, 2), sheave.Model()):
        with pytest.raises(AttributeError, match="gravty"):
            thing.gravty = (0, 0, 0)


def test_a_video_leaves_the_simulation_at_its_end(atwood, tmp_path):
    other = sheave.load(ATWOOD)
    atwood.video(tmp_path / "a.mp4", 0.2, 10, 64, 64)
    other.run(0.2)
    assert atwood.hash == other.hash and atwood.events == other.events


def test_an_item_that_changes_its_list(atwood):
    force = [0.0, 0.0, 0.0]

    class Shrinks:
        def __float__(self):
            force.clear()
            return 1.0

    force[0] = Shrinks()
    with pytest.raises(sheave.ArgumentError, match="force"):
        atwood.bodies["heavy"].set_force(force)


def test_callbacks_must_be_functions(atwood):
    for name in ("before_step", "before_substep"):
        with pytest.raises(sheave.ArgumentError, match=f"{name}: must be a function"):
            atwood.step(**{name: 3})


def test_errors_have_a_class_of_their_own():
    for name in ("SceneError", "EditError", "ArgumentError", "UnknownNameError", "StaleError",
                 "StateError", "DivergenceError"):
        assert issubclass(getattr(sheave, name), sheave.Error)
    assert issubclass(sheave.UnknownNameError, KeyError)
    assert issubclass(sheave.ArgumentError, (TypeError, ValueError))


def test_a_recording_is_asked_by_names(atwood):
    recording = atwood.record(["heavy.y"], 2)
    for wrong in (1, None, np.array(["heavy.y", "t"]), ["heavy.y"]):
        with pytest.raises(sheave.UnknownNameError, match="name: must be a string"):
            recording[wrong]


def test_a_recording_keeps_its_own_names(atwood):
    names = ["heavy.y"]
    recording = atwood.record(names, 2)
    names[0] = 3
    assert repr(recording) == "<Recording of heavy.y: 3 rows>"
    with pytest.raises(sheave.ArgumentError, match="names: "):
        atwood.record(7)


def test_a_run_until_no_time_is_refused(atwood):
    atwood.step()
    with pytest.raises(sheave.ArgumentError, match="until: must be a time"):
        atwood.run(float("nan"))
    assert atwood.steps == 1


HANGING = {
    "format": "sheave-scene/1", "gravity": [0, -10, 0], "duration": 1,
    "bodies": [{"name": "load", "mobility": "slider", "axis": [0, 1, 0], "mass": 2, "position": [0, -1, 0]}],
    "cables": [{"name": "rope", "compliance": 0.002, "links": [
        {"type": "attachment", "body": "world"}, {"type": "attachment", "body": "load"}]}],
}


def test_a_scene_starts_at_rest():
    sim = sheave.load(HANGING, set={"/start": "rest"})
    assert sim.observe("load.y") == pytest.approx(-1.04, abs=1e-10)
    sim.step(20)
    assert sim.observe("load.y") == pytest.approx(-1.04, abs=1e-10)
    assert sim.cables["rope"].tension(0) == pytest.approx(20, rel=1e-9)
    sim.reset()
    assert sim.observe("load.y") == pytest.approx(-1.04, abs=1e-10)
    model = sheave.Model.from_dict({**HANGING, "start": "rest"})
    assert model.start == "rest"
    assert model.simulation().hash == sim.hash


def test_a_scene_without_a_rest_tells_why():
    stone = {"format": "sheave-scene/1", "gravity": [0, -10, 0], "duration": 1, "start": "rest",
             "bodies": [{"name": "stone", "mass": 1, "inertia": [1, 1, 1]}]}
    with pytest.raises(sheave.SceneError, match='"stone"'):
        sheave.load(stone)


@pytest.mark.parametrize("scene", ["scenes/machines/crane.json", "scenes/analytic/atwood.json"])
def test_a_pickled_simulation_goes_on_to_the_same_bits(scene):
    sim = sheave.load(ROOT / scene, set={"/step/substeps": 3})
    sim.step(7)
    for again in (pickle.loads(pickle.dumps(sim)), copy.deepcopy(sim)):
        assert type(again) is sheave.Simulation and again.hash == sim.hash
        again.step(5)
    sim.step(5)
    assert again.hash == sim.hash and again.title == sim.title


def test_an_edited_simulation_is_not_pickled(atwood):
    with atwood.edit() as edit:
        edit.remove_cable("cable")
    with pytest.raises(sheave.Error, match="edited cannot be pickled"):
        pickle.dumps(atwood)


def test_an_object_whose_scene_was_refused_can_be_shown():
    for kind, more in ((sheave.Simulation, ()), (sheave.Batch, (2,))):
        own = kind.__new__(kind)
        with pytest.raises(sheave.SceneError):
            own.__init__({}, *more)
        assert "refused" in repr(own)

"""Every scene of the repository, as the command has it."""

import json
import subprocess

import numpy as np
import pytest
from conftest import INVALID, ROOT, SCENES

import sheave

STEPS = 12


def hash_of_command(command, scene, steps):
    done = subprocess.run(
        [command, "run", scene, "--steps", str(steps), "--json"], cwd=ROOT, check=False,
        capture_output=True, text=True)
    return json.loads(done.stdout)["state_hash"]


@pytest.mark.parametrize("scene", SCENES)
def test_steps_to_the_same_bits_as_the_command(command, scene):
    sim = sheave.load(ROOT / scene)
    views = sim.positions, sim.tensions
    for _ in range(STEPS):
        sim.step()
    assert sim.hash == hash_of_command(command, scene, STEPS)
    # Views of the state are where they were, whatever the engine exchanges.
    fresh = sheave.load(ROOT / scene)
    fresh.set_state_bytes(sim.state_bytes())
    assert np.array_equal(views[0], fresh.positions)
    assert np.array_equal(views[1], fresh.tensions)


def test_runs_to_the_end_as_the_command(command):
    scene = "scenes/machines/load-at-a-height.json"
    sim = sheave.load(ROOT / scene)
    sim.run()
    done = subprocess.run([command, "run", scene, "--json"], cwd=ROOT, capture_output=True,
                          text=True, check=True)
    assert sim.hash == json.loads(done.stdout)["state_hash"]


@pytest.mark.parametrize("scene", SCENES[::3])
def test_a_model_comes_back_from_json(scene):
    model = sheave.Model.load(ROOT / scene)
    again = sheave.Model.from_dict(json.loads(model.to_json()))
    assert again == model
    sim, other = sheave.load(ROOT / scene), again.simulation()
    sim.step(3)
    other.step(3)
    assert sim.hash == other.hash


@pytest.mark.parametrize("scene", INVALID[::8])
def test_faults_of_scenes_name_their_place(scene):
    with pytest.raises(sheave.SceneError) as caught:
        sheave.load(ROOT / scene)
    fault = caught.value.faults[0]
    assert fault.file.endswith(scene)
    assert fault.line > 0 and fault.column > 0
    assert fault.message and fault.code
    assert str(fault) in str(caught.value) or fault.message in str(caught.value)


@pytest.mark.parametrize("scene", SCENES[::9])
def test_every_observable_can_be_asked_for(scene):
    sim = sheave.load(ROOT / scene)
    sim.step(2)
    values = sim.observe(sim.observables)
    assert values.shape == (len(sim.observables),)
    assert sim.observe("t") == sim.time


def test_expressions_are_observables(tmp_path):
    sim = sheave.load(ROOT / "scenes/analytic/atwood.json")
    sim.step(3)
    light, heavy = (sim.observe(f"{name}.y") for name in ("light", "heavy"))
    assert sim.observe("light.y - heavy.y") == light - heavy
    assert list(sim.observe(["hypot(light.y, 1)", "2 * light.y"])) == [
        pytest.approx((light * light + 1) ** 0.5, rel=1e-15), 2 * light]
    assert sim.unit("light.vy * cable.0.tension") == "W"
    recording = sim.record(["light.y + heavy.y"], steps=2)
    assert recording.units == {"light.y + heavy.y": "m"}
    assert recording["light.y + heavy.y"] == pytest.approx(light + heavy)
    with pytest.raises(sheave.UnknownNameError, match="column 9: . needs one unit"):
        sim.observe("light.y + light.vy")

"""Muscles of a scene: their excitation is a control, in one simulation and in a batch."""

import numpy as np
import pytest
import sheave

SCENE = {
    "format": "sheave-scene/1", "gravity": [0, 0, 0], "duration": 1, "step": {"dt": 0.001, "substeps": 1},
    "bodies": [{"name": "left", "mass": 1, "shape": {"type": "sphere", "radius": 0.1}},
               {"name": "right", "mass": 1e9, "position": [0.3, 0, 0], "shape": {"type": "sphere", "radius": 0.1}}],
    "cables": [{"name": "path", "compliance": 1e12, "most_wraps": 0,
                "links": [{"type": "attachment", "body": "left"}, {"type": "attachment", "body": "right"}]}],
    "loads": [{"type": "muscle", "name": "m", "cable": "path", "force": 50, "optimal_length": 0.2, "tendon_length": 0.1}],
}


def test_an_excitation_is_set_and_cleared():
    sim = sheave.load(SCENE)
    assert sim.muscles == {"m": {"activation": 0.0, "tension": 0.0}}
    sim.set("m.excitation", 1.0)
    sim.step(20)
    muscle = sim.muscles["m"]
    # -2 ln(1 - a) - 3/2 a = t / T: the closed form of the activation.
    a = muscle["activation"]
    assert -2 * np.log(1 - a) - 1.5 * a == pytest.approx(2.0, abs=0.02)
    assert 0 < muscle["tension"] < 50
    sim.clear("m.excitation")
    sim.step(500)
    assert sim.muscles["m"]["activation"] < 0.01
    with pytest.raises(sheave.Error, match="between 0 and 1"):
        sim.set("m.excitation", 2.0)
    with pytest.raises(sheave.Error, match="near it"):
        sim.set("n.excitation", 0.5)


def test_a_batch_has_one_excitation_per_world():
    batch = sheave.Batch(SCENE, 3)
    batch.set("m.excitation", [0.0, 0.5, 1.0])
    batch.step(30)
    x = batch.observe("left.vx")
    assert x[0] == 0 and 0 < x[1] < x[2]
    before = batch.observe("left.x").copy()
    with pytest.raises(sheave.Error, match="world 2"):
        batch.set("m.excitation", [1.0, 1.0, 7.0])
    other = sheave.Batch(SCENE, 3)
    other.set("m.excitation", [0.0, 0.5, 1.0])
    other.step(60)
    batch.step(30)
    # The refused values have changed no world.
    assert (batch.observe("left.x") == other.observe("left.x")).all()
    assert (batch.observe("left.x") != before)[1:].all()

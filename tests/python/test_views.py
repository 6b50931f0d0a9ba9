"""NumPy views of the state."""

import gc

import numpy as np
import pytest
from conftest import ATWOOD, ROOT

import sheave

NAMES = ["positions", "orientations_xyzw", "velocities", "angular_velocities", "angles",
         "tensions", "rest_lengths"]
MACHINES = ["analytic/atwood", "paper/pulley", "paper/hand", "machines/crane", "paper/gym",
            "analytic/tipping-box"]


@pytest.mark.parametrize("name", NAMES)
def test_views_share_the_memory_of_the_state(atwood, name):
    view = getattr(atwood, name)
    assert np.shares_memory(view, getattr(atwood, name))
    assert view.base is not None and not view.flags.writeable and view.dtype == np.float64
    with pytest.raises(ValueError):
        view[...] = 0.0
    with pytest.raises(ValueError):
        view.flags.writeable = True
    with pytest.raises(AttributeError):
        setattr(atwood, name, 1)


@pytest.mark.parametrize("scene", MACHINES)
@pytest.mark.parametrize("substeps", [1, 2, 3])
@pytest.mark.parametrize("integrator", ["xpbd", "rattle"])
def test_views_show_the_state_after_every_step(scene, substeps, integrator):
    settings = {"/step/substeps": substeps, "/step/integrator": integrator}
    sim = sheave.load(ROOT / f"scenes/{scene}.json", set=settings)
    plain = sheave.load(ROOT / f"scenes/{scene}.json", set=settings)
    views = {name: getattr(sim, name) for name in NAMES}
    columns = [f"{name}.vx" for name in sim.body_names if f"{name}.vx" in sim.observables]
    cables = [f"{name}.tension" for name in sim.span_names if "wrap" not in name]
    for k in range(5):
        sim.step()
        plain.step()
        if k == 2:
            sim.restore(sim.snapshot())
            plain.restore(plain.snapshot())
        for name, view in views.items():
            assert np.array_equal(view, getattr(sim, name))
        rows = [i for i, name in enumerate(sim.span_names) if "wrap" not in name]
        assert np.array_equal(views["tensions"][rows], sim.observe(cables))
        assert len(columns) == 0 or np.isfinite(sim.observe(columns)).all()
    # To be looked at changes nothing.
    assert sim.hash == plain.hash


def test_views_have_a_row_for_each(atwood):
    assert atwood.positions.shape == (3, 3) and atwood.orientations_xyzw.shape == (3, 4)
    assert atwood.angles.shape == (3,) and atwood.tensions.shape == (2,)
    assert atwood.body_names == ["wheel", "light", "heavy"]
    assert atwood.span_names == ["cable.0", "cable.1"]


def test_the_tensions_of_a_cable_are_a_part(atwood):
    atwood.step()
    own = atwood.cables["cable"].tensions
    assert np.shares_memory(own, atwood.tensions)
    assert own.tolist() == [atwood.cables["cable"].tension(k) for k in range(2)]


def test_views_outlive_their_simulation():
    sim = sheave.load(ATWOOD)
    sim.step(5)
    view, part = sim.positions, sim.positions[1]
    kept = view.copy()
    del sim
    gc.collect()
    others = [sheave.load(ATWOOD) for _ in range(20)]
    for other in others:
        other.step(3)
    assert np.array_equal(view, kept) and np.array_equal(part, kept[1])


def test_views_of_what_was_before_an_edit_stay_as_they_were(atwood):
    atwood.step(5)
    view = atwood.positions
    kept, before = view.copy(), atwood.snapshot()
    with atwood.edit() as edit:
        edit.add_body({"name": "ball", "mobility": "free", "mass": 1,
                       "shape": {"type": "sphere", "radius": 0.1}})
    atwood.step(5)
    assert np.array_equal(view, kept)
    assert atwood.positions.shape == (4, 3)
    assert not np.shares_memory(view, atwood.positions)
    atwood.restore(before)
    assert np.shares_memory(view, atwood.positions)
    atwood.step(1)
    assert np.array_equal(view, atwood.positions) and not np.array_equal(view, kept)


def test_a_world_without_cables_has_no_tensions():
    sim = sheave.load(ROOT / "scenes/analytic/pendulum.json")
    assert sim.tensions.shape == (0,) and sim.span_names == []
    sim.step()
    assert sim.tensions.sum() == 0.0


def test_a_world_of_nothing():
    sim = sheave.load({"format": "sheave-scene/1", "gravity": [0, 0, 0], "duration": 1,
                       "bodies": []})
    sim.step()
    assert sim.positions.shape == (0, 3) and sim.energy["total"] == 0.0

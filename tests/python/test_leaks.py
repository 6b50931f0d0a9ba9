"""Worlds that come and go take no memory along. dev/leak-python does the same 100,000 times."""

import gc
import os

import pytest
from conftest import ATWOOD

import sheave

PAGE = os.sysconf("SC_PAGESIZE")


def resident():
    """Memory of this process [bytes]."""
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * PAGE


def live_and_die(i):
    """One world from its making to its end, with views, handles, snapshots, edits and errors."""
    sim = sheave.load(ATWOOD)
    sim.step(3)
    view = sim.tensions
    kept = sim.snapshot()
    heavy = sim.bodies["heavy"]
    sim.step(1, before_step=lambda own: heavy.set_force((0, 1, 0)))
    sim.restore(kept)
    if i % 3 == 0:
        sim.record(["heavy.y", "cable.0.tension"], steps=2)
    if i % 5 == 0:
        with sim.edit() as edit:
            edit.add_body({"name": "ball", "mobility": "free", "mass": 1, "position": [3, 0, 0],
                           "shape": {"type": "sphere", "radius": 0.1}})
        sim.step()
    if i % 7 == 0:
        with pytest.raises(sheave.SceneError):
            sheave.load({"format": "sheave-scene/1", "gravity": [0, 1], "duration": -1})
        with pytest.raises(sheave.ArgumentError):
            heavy.set_force("up")
        with pytest.raises(ZeroDivisionError):
            sim.step(before_substep=lambda own: 1 / 0)
    if i % 50 == 0:
        batch = sheave.Batch(ATWOOD, 3, threads=2)
        batch.step(2)
        batch.restore(batch.states())
        batch.observe(["heavy.y"])
    return view[0]


def growth(worlds, log=lambda text: None):
    """By how much memory grows from the first tenth of the worlds to the last one [bytes]."""
    tenth = max(1, worlds // 10)
    begin = 0
    for i in range(worlds):
        live_and_die(i)
        if (i + 1) % tenth == 0:
            gc.collect()
            log(f"{i + 1:8} worlds: {resident() / 2**20:.2f} MiB")
        if i + 1 == tenth:
            begin = resident()
    return resident() - begin


@pytest.mark.skipif(not os.path.exists("/proc/self/statm"), reason="Linux tells the memory")
@pytest.mark.skipif("LD_PRELOAD" in os.environ, reason="sanitizers keep what is freed")
def test_memory_is_flat():
    # A state of this world is 1 KiB and more, so that one which is kept per world is 1.8 MiB here;
    # allocators round to pages and keep some.
    assert growth(2000) < 2**20

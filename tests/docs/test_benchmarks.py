"""IFToMM's benchmark problems: the references agree with published values, and the table says the same as a run."""

import importlib.machinery
import importlib.util
import math
import pathlib
import subprocess
import sys

import pytest

np = pytest.importorskip("numpy")
pytest.importorskip("scipy")

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench/benchmarks"))
import references  # noqa: E402

# Printed by the library of benchmarks with six digits: time [s], x and y [m].
A01 = ((0.5, -3.91049e-1, -9.20370e-1), (1.0, 9.86292e-1, -1.65011e-1), (2000.0, 8.14603e-1, -5.80019e-1))
A02 = ((0.05, 5.02096e-2, 9.98739e-1), (0.45, 5.93011e-1, 8.05194e-1), (4.95, -2.39180e-1, -9.70975e-1), (9.95, 1.25034e-1, 9.92152e-1),
       (10.95, -7.86084e-1, -6.18119e-1))
# By the Test Set for IVP Solvers after 0.03 s: beta, theta, gamma, phi, delta, omega, epsilon, and the rate of beta.
A03 = (15.81077119629904, -15.75637105984298, 0.04082224013073101, -0.5347301163226948, 0.5244099658805304, 0.5347301163226948,
       1.048080741042263, 1139.920302151208)


@pytest.mark.parametrize("time, x, y", A01)
def test_the_pendulum_agrees_with_the_library(time, x, y):
    # Half of the last digit of six.
    assert references.pendulum([time])[0] == pytest.approx((x, y), abs=6e-7)


@pytest.mark.parametrize("time, x, y", A02)
def test_forty_windows_agree_with_the_library(time, x, y):
    # Half of the last digit, and the error of the library's own run, 4e-6 m after 20 s.
    assert references.four_bars([time], 40)[0] == pytest.approx((x, y), abs=3e-6)


def test_two_windows_agree_with_a_published_run_that_is_extrapolated():
    # EXUDYN's places of B0 after 10 s with steps of 0.25 ms and 0.125 ms, a method of second order.
    half, full = np.array((0.3284552113, 0.9445195467)), np.array((0.3284573768, 0.9445187937))
    # The extrapolation from steps of twice that length differs by 1.3e-8 m: terms of higher order, and its solver's residual.
    assert references.four_bars([10.0], 2)[0] == pytest.approx(full + (full - half) / 3.0, abs=2e-8)


def test_the_squeezer_agrees_with_the_test_set():
    y = references.integrate(references.Squeezer().rates, list(references.SQUEEZER["start"]) + [0.0] * 7, [0.03])[0]
    beta, theta, gamma, phi, delta, omega, epsilon, rate = A03
    quarter = 0.5 * math.pi
    angles = (beta, beta + theta, gamma - quarter, phi + delta - quarter, delta, omega + epsilon, epsilon - quarter)
    # The crank has turned 2.5 times; 1e-12 per step in some thousand steps.
    assert y[:7] == pytest.approx(angles, abs=3e-9)
    assert y[7] == pytest.approx(rate, rel=1e-8)


def test_the_squeezer_keeps_its_balance_of_energy():
    one = references.Squeezer()
    start = list(references.SQUEEZER["start"]) + [0.0] * 7
    end = references.integrate(one.rates, start, [0.05])[0]
    assert one.energy(end) == pytest.approx(one.energy(np.array(start)), abs=1e-9)


@pytest.mark.parametrize("a", [0.0, 0.3, 1.0, 0.5 * math.pi, 2.5, math.pi])
def test_bricards_loop_closes(a):
    points, _, _, _, frame = references.Bricard().chain(a)
    assert points[5] == pytest.approx((0.0, 0.0, 1.0), abs=1e-15)
    assert frame @ (1.0, 0.0, 0.0) == pytest.approx((1.0, 0.0, 0.0), abs=1e-15)


def test_bricards_velocities_are_derivatives():
    one, step = references.Bricard(), 1e-6
    for a in (0.4, 1.7):
        before, after = one.chain(a - step)[0], one.chain(a + step)[0]
        for i, speed in enumerate(one.chain(a)[1]):
            middle = 0.5 * (after[i] + after[i + 1] - before[i] - before[i + 1]) / (2.0 * step)
            assert middle == pytest.approx(speed, abs=1e-9)


def test_bricards_period_is_that_of_its_energy():
    # dt = da sqrt(M / (2 (E - V))); a = pi/2 (1 - cos u) takes the singularities from both ends, where the motion turns back. The
    # trapezium rule converges faster than any power for a function that is even about both ends.
    one = references.Bricard()
    height = lambda a: sum(0.5 * (p[1] + q[1]) for p, q in zip(*(one.chain(a)[0][i:6 - 1 + i] for i in (0, 1))))
    count, total = 60, 0.0
    for k in range(1, count):
        u = math.pi * k / count
        a = 0.5 * math.pi * (1.0 - math.cos(u))
        total += 0.5 * math.pi * math.sin(u) * math.sqrt(one.inertia(a) / (2.0 * references.G * (height(0.0) - height(a))))
    ends = [0.5 * math.pi * math.sqrt(one.inertia(a) / (2.0 * abs(one.rates(0.0, (a, 0.0))[1]) * one.inertia(a) * 0.25 * math.pi))
            for a in (0.0, math.pi)]
    half = math.pi / count * (total + 0.5 * sum(ends))
    # Where the motion turns back, a is off by half of its acceleration times the square of the error of the time.
    a = references.integrate(one.rates, [0.0, 0.0], [half, 2.0 * half])
    assert a[:, 0] == pytest.approx((math.pi, 0.0), abs=1e-9)
    assert a[:, 1] == pytest.approx((0.0, 0.0), abs=1e-7)


def test_the_governor_loses_the_energy_that_its_dampers_take():
    one, g = references.Governor(), references.G

    def energy(angle, s, rate, speed):
        x, z = 0.5 * math.cos(angle), 1.0 - 0.5 * math.sin(angle) - s
        moment = 2.0 * (one.BALL + one.ROD * (0.25 + one.ACROSS))
        height = -2.0 * (one.BALL + 0.5 * one.ROD) * math.sin(angle) + one.SLIDER * s
        return (0.5 * one.momentum ** 2 / one.turning(angle)[0] + 0.5 * moment * rate ** 2 + 0.5 * one.SLIDER * speed ** 2
                + g * height + one.STIFFNESS * (math.hypot(x, z) - one.REST) ** 2)

    for state in ((0.5, 0.5, 0.3, -0.2), (0.3, 0.7, -0.8, 0.7), (0.9, 0.3, 0.1, 0.4)):
        rates, step = np.array(one.rates(0.0, state)), 1e-7
        change = (energy(*(state + step * rates)) - energy(*(state - step * rates))) / (2.0 * step)
        force, by_angle, by_s = one.spring(*state)
        stretch = by_angle * state[2] + by_s * state[3]
        # Rounding: 1e-16 of some 1e5 J over 2e-7 s, and the third derivative of the springs' energy times step squared.
        assert change == pytest.approx(-2.0 * one.DAMPING * stretch ** 2, abs=1e-3, rel=1e-6)


def table():
    path = str(ROOT / "bench/tables/benchmark-table")
    loader = importlib.machinery.SourceFileLoader("benchmark_table", path)
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(loader.name, loader))
    loader.exec_module(module)
    return module


def test_the_table_has_the_numbers_of_a_run():
    made = table()
    page = (ROOT / "bench/BENCHMARKS.md").read_text(encoding="utf-8")
    for name, options in (("A01", ("--substeps", "4")), ("A03", ("--integrator", "rattle", "--substeps", "8"))):
        problem = made.PROBLEMS[name]
        run = made.measure(problem, options)
        section = page.split(f"## {problem.title}\n", 1)[1].split("\n## ", 1)[0]
        row = next(line for line in section.splitlines() if line.startswith(f"| {options[-1]} |"))
        assert row.split("|")[2].strip() == made.number(run["error"])
        assert row.split("|")[4].strip() == made.number(run["drift"])


def test_windows_of_the_program_are_those_of_the_scene():
    ends = []
    for scene in ("scenes/analytic/iftomm-four-bars.json", "bench/benchmarks/four-bars.jsonnet"):
        made = subprocess.run([ROOT / "build/release/tools/sheave", "run", scene, "--duration", "0.5", "--quiet", "--out", "-",
                               "--columns", "upright 0.x,upright 2.y,coupler 1.x"], cwd=ROOT, text=True, capture_output=True, check=True)
        ends.append([float(value) for value in made.stdout.splitlines()[-1].split(",")])
    # Couplers are drawn beside each other in the scene, in line in the program; with their centres in the same places the motion is
    # that of the same rows up to rounding.
    assert ends[0] == pytest.approx(ends[1], abs=1e-12)

"""The independent solutions of tests/data/verification, reached through the FMU in fmpy.

Sliding: frequency within 1 %, peak-to-peak displacement within 3 %, mean friction within 1 %. Rolling:
traces within 3 % of their range up to the first slip, then frequency and amplitude as for sliding.
"""

import csv

import numpy as np
import pytest
from conftest import ROOT
from fmpy import simulate_fmu

DATA = ROOT / "tests" / "data" / "verification"
# Height, length [m], pressure [Pa], road speed [m/s].
SLIDES = {
    "slide-1": (0.010, 0.015, 250e3, 0.30),
    "slide-2": (0.010, 0.015, 400e3, 0.15),
    "slide-3": (0.006, 0.015, 250e3, 0.20),
    "slide-4": (0.010, 0.045, 250e3, 0.30),
}
# Height [m], end of the first stick [s], window of stick-slip [s], direction of the slips.
ROLLS = {
    "roll-1": (0.010, 6.1e-3, (6.5e-3, 11.8e-3), -1),
    "roll-2": (0.008, 4.4e-3, (8.5e-3, 21.2e-3), 1),
}
OUTPUTS = ["contact.force.x", "contact.force.z", "run_in.displacement.x"]


def columns(name):
    with open(DATA / f"{name}.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    return {key: np.array([float(row[key]) for row in rows]) for key in rows[0]}


def run(fmu, name, start_values, inputs, stop, step):
    names = ",".join(inputs.dtype.names)
    assert names.startswith("time"), name
    return simulate_fmu(
        str(fmu), start_time=0, stop_time=stop, step_size=step, output_interval=step,
        start_values={"wear.coefficient": 0.0, **start_values}, input=inputs, output=OUTPUTS,
    )


def stick_slip(t, u, window, sign=1):
    """Frequency of the upward crossings of the mean, peak-to-peak, and the times of the crossings."""
    inside = (t > window[0]) & (t < window[1])
    t, u = t[inside], sign * u[inside]
    u = u - u.mean()
    at = np.flatnonzero((u[:-1] < 0) & (u[1:] >= 0))
    crossings = t[at] - u[at] * (t[at + 1] - t[at]) / (u[at + 1] - u[at])
    return (len(crossings) - 1) / (crossings[-1] - crossings[0]), np.ptp(u), crossings


@pytest.mark.parametrize("name", SLIDES)
def test_sliding_through_fmpy_is_the_independent_solution(fmu, name):
    height, length, pressure, speed = SLIDES[name]
    expected = columns(name)
    stop, ramp = expected["t"][-1], 0.5e-3
    time = np.arange(0, stop + 20e-6, 5e-6)
    x = np.where(time < ramp, time**2 / (2 * ramp), time - ramp / 2) * -speed
    load = np.full_like(time, pressure * length * 0.015)
    inputs = np.rec.fromarrays([time, x, load], names=["time", "belt.x", "normal_load"])
    start = {"block.height": height, "block.length": length}
    found = run(fmu, name, start, inputs, stop, 20e-6)
    window = (0.4 * stop, stop)
    f0, a0, c0 = stick_slip(expected["t"], expected["edge_in_x"], window)
    f1, a1, c1 = stick_slip(found["time"], found["run_in.displacement.x"], window)

    def friction(t, fx, fz, crossings):
        whole = (t >= crossings[0]) & (t < crossings[-1])
        return fx[whole].sum() / fz[whole].sum()

    mu0 = friction(expected["t"], expected["Fx"], expected["Fz"], c0)
    mu1 = friction(found["time"], found["contact.force.x"], found["contact.force.z"], c1)
    assert f1 == pytest.approx(f0, rel=0.01)
    assert a1 == pytest.approx(a0, rel=0.03)
    assert mu1 == pytest.approx(mu0, rel=0.01)


@pytest.mark.parametrize("name", ROLLS)
def test_rolling_through_fmpy_is_the_independent_solution(fmu, name):
    height, first_slip, window, sign = ROLLS[name]
    expected, belt = columns(name), columns(f"{name}-belt")
    inputs = np.rec.fromarrays(
        [belt["time_s"], belt["belt_x_m"], belt["belt_z_m"], belt["belt_angle_rad"]],
        names=["time", "belt.x", "belt.z", "belt.angle"],
    )
    start = {
        "block.height": height, "drive.normal": 2,  # trajectory; fmpy takes enumerations by number
        "belt.x": belt["belt_x_m"][0], "belt.z": belt["belt_z_m"][0],
        "belt.angle": belt["belt_angle_rad"][0],
    }
    found = run(fmu, name, start, inputs, belt["time_s"][-1], 5e-6)
    before = expected["t"] < first_slip
    for ours, theirs in zip(OUTPUTS, ["Fx", "Fz", "edge_in_x"]):
        trace = np.interp(expected["t"], found["time"], found[ours])
        error = np.abs(trace - expected[theirs])[before].max() / np.ptp(expected[theirs])
        assert error < 0.03, f"{name} {theirs}: {error}"
    f0, a0, _ = stick_slip(expected["t"], expected["edge_in_x"], window, sign)
    f1, a1, _ = stick_slip(found["time"], found["run_in.displacement.x"], window, sign)
    assert f1 == pytest.approx(f0, rel=0.01)
    assert a1 == pytest.approx(a0, rel=0.03)

"""fmpy as a user runs it: results, states, errors, instances."""

import os
import subprocess
import sys
import threading
import zipfile

import fmpy
import numpy as np
import pytest
from fmpy.fmi1 import FMICallException

from conftest import COARSE, DYADIC, LOAD, Slave, assert_same, belt_x, grid, library


def test_same_steps_same_numbers_as_the_library(slave):
    points = grid(1000, 1e-5)
    expected = library(points)
    assert_same(slave().initialize().slide(points), expected)
    assert np.ptp(expected[:, 5]) > 1e-5, "the run-in edge moves: there is something to compare"


@pytest.mark.parametrize("seed", [1, 2])
def test_varying_steps_give_the_numbers_of_the_library(slave, seed):
    steps = np.random.default_rng(seed).uniform(1e-6, 3e-5, 400)
    points = [0.0, *(float(t) for t in np.cumsum(steps))]
    assert_same(slave().initialize().slide(points), library(points))


def test_simulate_fmu_agrees_with_the_library(fmu, outputs):
    points = grid(500, DYADIC)
    dtype = [("time", float), ("belt.x", float)]
    samples = np.array([(t, belt_x(t)) for t in points], dtype=dtype)
    result = fmpy.simulate_fmu(str(fmu), stop_time=points[-1], step_size=DYADIC,
                               output_interval=DYADIC,
                               start_values={**COARSE, "normal_load": LOAD}, input=samples,
                               output=outputs)
    rows = np.array([[row[name] for name in outputs] for row in result])[1:]
    assert len(rows) == 500
    assert_same(rows, library(points))


def test_a_state_resumes_bit_for_bit_through_bytes(slave):
    points = grid(300, 1e-5)
    first = slave().initialize()
    first.slide(points[:201])
    state = first.fmu.getFMUstate()
    kept = first.fmu.serializeFMUstate(state)
    expected = first.slide(points[200:])
    first.fmu.setFMUstate(state)
    first.fmu.freeFMUstate(state)
    np.testing.assert_array_equal(first.slide(points[200:]), expected)
    second = slave("other")
    second.fmu.setFMUstate(second.fmu.deSerializeFMUstate(kept))
    np.testing.assert_array_equal(second.slide(points[200:]), expected)


def test_reset_equals_a_new_instance_bit_for_bit(slave):
    points = grid(200, 1e-5)
    expected = slave().initialize().slide(points)
    used = slave().initialize(**{"friction.mu_inf": 0.7})
    used.slide(points[:50])
    used.fmu.reset()
    np.testing.assert_array_equal(used.initialize().slide(points), expected)


def test_instances_in_threads_give_the_same_bits(unpacked, description, monkeypatch):
    # fmpy changes to the library's folder and back while it loads; threads that do so at once may stay there.
    monkeypatch.chdir(os.getcwd())
    points = grid(200, 1e-5)
    results = {}

    def run(number):
        one = Slave(unpacked, description, f"block {number}")
        results[number] = one.initialize().slide(points)
        one.close()

    threads = [threading.Thread(target=run, args=(n,)) for n in range(6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for number in range(1, 6):
        np.testing.assert_array_equal(results[number], results[0])


@pytest.mark.parametrize("name, value", [
    ("belt.x", float("nan")), ("normal_load", -5.0), ("belt.angle", 7.0), ("block.height", 0.02)])
def test_bad_input_is_an_error_and_changes_nothing(slave, name, value):
    one = slave().initialize()
    before = one.slide(grid(20, 1e-5))[-1]
    with pytest.raises(FMICallException):
        one.set(name, value)
    np.testing.assert_array_equal(one.outputs(), before)


def test_a_tuned_parameter_takes_effect_in_the_next_step(slave):
    points = grid(1000, 1e-5)
    plain, tuned = slave().initialize(), slave().initialize()
    plain.slide(points[:500]), tuned.slide(points[:500])
    tuned.set("friction.mu_inf", 1.0)
    assert np.abs(tuned.slide(points[499:]) - plain.slide(points[499:])).max() > 0


def test_nothing_is_printed_and_the_host_is_left_alone(fmu):
    """A silent process with the same folder, locale and signal handlers after a run."""
    script = """
import fmpy, locale, os, signal, sys
state = lambda: (os.getcwd(), locale.setlocale(locale.LC_ALL), [signal.getsignal(s) for s in signal.valid_signals()])
locale.setlocale(locale.LC_ALL, "C")
before = state()
fmpy.simulate_fmu(sys.argv[1], stop_time=1e-3, step_size=1e-5,
                  start_values={"solver.elements_along": 6, "solver.elements_up": 4, "normal_load": 50.0})
assert state() == before
"""
    done = subprocess.run([sys.executable, "-c", script, str(fmu)], capture_output=True, text=True,
                          env={**os.environ, "PYTHONWARNINGS": "ignore"})
    assert done.returncode == 0, done.stderr
    assert done.stdout == "" and done.stderr == ""


def test_the_reference_result_in_the_fmu_is_what_the_fmu_gives(fmu, slave, outputs):
    archive = zipfile.ZipFile(fmu)

    def table(name):
        lines = archive.read(f"extra/org.tread-block.reference/{name}.csv").decode().splitlines()
        return lines[0].split(","), np.array([[float(x) for x in line.split(",")] for line in lines[1:]])

    names, samples = table("inputs")
    header, expected = table("outputs")
    assert header[1:] == outputs
    one = slave()
    for name, value in zip(names[1:], samples[0, 1:]):
        one.set(name, value)
    one.fmu.setupExperiment(startTime=0.0)
    one.fmu.enterInitializationMode()
    one.fmu.exitInitializationMode()
    rows = [one.outputs()]
    for k, sample in enumerate(samples[:-1], start=1):
        for name, value in zip(names[1:], sample[1:]):
            one.set(name, value)
        one.fmu.doStep(sample[0], 1e-5)
        if k % 10 == 0:
            rows.append(one.outputs())
    assert_same(rows, expected[:, 1:])

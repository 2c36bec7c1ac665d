"""What the tests of the FMU share: the file, a sliding motion, the library's own answer to it.

The FMU comes from `make fmu` (or TREAD_FMU), the library's answer from the example `follow_samples`
(or TREAD_FOLLOW), which applies the FMU's input rule to the same samples without any FMI.
"""

import os
import subprocess
from pathlib import Path

import fmpy
import numpy as np
import pytest
from fmpy.fmi2 import FMU2Slave

ROOT = Path(__file__).resolve().parents[2]
FMU = Path(os.environ.get("TREAD_FMU", ROOT / "out" / "TreadBlock.fmu"))
LOAD = 56.25  # N: 0.25 N/mm² on 15 mm x 15 mm
COARSE = {"solver.elements_along": 8, "solver.elements_up": 6}


def follower():
    candidates = [os.environ.get("TREAD_FOLLOW"), "target/debug/examples/follow_samples",
                  "target/release/examples/follow_samples"]
    for path in filter(None, candidates):
        if (ROOT / path).exists():
            return ROOT / path
    pytest.fail("build it first: cargo build --example follow_samples")


@pytest.fixture(scope="session")
def fmu():
    assert FMU.exists(), f"{FMU} is missing: run `make fmu`"
    return FMU


@pytest.fixture(scope="session")
def description(fmu):
    return fmpy.read_model_description(str(fmu))


@pytest.fixture(scope="session")
def vr(description):
    return {v.name: v.valueReference for v in description.modelVariables}


@pytest.fixture(scope="session")
def outputs(description):
    return [v.name for v in description.modelVariables if v.causality == "output"]


@pytest.fixture(scope="session")
def unpacked(fmu, tmp_path_factory):
    return fmpy.extract(str(fmu), str(tmp_path_factory.mktemp("fmu with blank")))


def belt_x(t):
    """Rest, a linear start over 0.5 ms, then 0.3 m/s to -x."""
    start = 0.5e-3
    return -0.3 * t * t / (2 * start) if t < start else -0.3 * (t - start / 2)


# A power of two: masters that add up their steps and masters that multiply arrive at the same bits.
DYADIC = 2.0 ** -17  # [s]


def grid(n, h):
    """Communication points as a master counts them that multiplies."""
    return [k * h for k in range(n + 1)]


def library(points, load=LOAD, **parameters):
    """Rows (outputs after each step) of the library on a sliding block; `load` may follow the points."""
    parameters = {**COARSE, **parameters}
    loads = load if isinstance(load, list) else [load] * len(points)
    lines = ["time,belt.x,belt.z,belt.angle,normal_load"]
    lines += [f"{t!r},{belt_x(t)!r},0.0,0.0,{newtons!r}" for t, newtons in zip(points, loads)]
    arguments = [f"{name}={value}" for name, value in parameters.items()]
    done = subprocess.run([follower(), *arguments], input="\n".join(lines), text=True,
                          capture_output=True, check=True)
    rows = [[float(cell) for cell in line.split(",")] for line in done.stdout.splitlines()]
    return np.array(rows)[:, 1:]


class Slave:
    """An fmpy slave with names instead of value references, that collects the FMU's messages."""

    def __init__(self, unpacked, description, instance="block"):
        self.vr = {v.name: v.valueReference for v in description.modelVariables}
        self.output_vrs = [v.valueReference for v in description.modelVariables
                           if v.causality == "output"]
        self.fmu = FMU2Slave(guid=description.guid, unzipDirectory=unpacked,
                             modelIdentifier=description.coSimulation.modelIdentifier,
                             instanceName=instance)
        self.fmu.instantiate()

    def initialize(self, load=LOAD, start=0.0, stop=None, **parameters):
        for name, value in {**COARSE, **parameters}.items():
            if isinstance(value, float):
                self.fmu.setReal([self.vr[name]], [value])
            else:
                self.fmu.setInteger([self.vr[name]], [value])
        self.set("normal_load", load)
        self.fmu.setupExperiment(startTime=start, stopTime=stop)
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()
        return self

    def set(self, name, value):
        self.fmu.setReal([self.vr[name]], [value])

    def get(self, name):
        return self.fmu.getReal([self.vr[name]])[0]

    def outputs(self):
        return self.fmu.getReal(self.output_vrs)

    def slide(self, points):
        rows = []
        for t, following in zip(points, points[1:]):
            self.set("belt.x", belt_x(t))
            self.fmu.doStep(t, following - t)
            rows.append(self.outputs())
        return np.array(rows)

    def close(self):
        self.fmu.freeInstance()


@pytest.fixture
def slave(unpacked, description):
    made = []

    def make(instance="block"):
        made.append(Slave(unpacked, description, instance))
        return made[-1]

    yield make
    for one in made:
        one.close()


def assert_same(result, expected, rtol=1e-12):
    """Equal to rtol of each column's own size."""
    scale = np.abs(expected).max(axis=0)
    scale[scale == 0] = 1
    error = (np.abs(np.asarray(result) - expected) / scale).max()
    assert error <= rtol, f"largest difference {error} of the column's size"

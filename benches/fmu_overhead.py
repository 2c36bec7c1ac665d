"""What a communication step of 20 µs costs in the library, in the FMU from C, and through fmpy."""

from __future__ import annotations

import ctypes
import statistics
import subprocess
import time
from collections.abc import Callable
from pathlib import Path

import fmpy
import numpy as np
from fmpy.fmi2 import FMU2Slave

import instructions

STEPS, STEP, RAMP = 1500, instructions.STEP, 0.5e-3


def belt(k: int) -> float:
    t = k * STEP
    return -0.3 * t * t / (2 * RAMP) if t < RAMP else -0.3 * (t - RAMP / 2)


def loop(slave: FMU2Slave, vr: dict[str, int]) -> float:
    """Seconds of the run with fmpy's own functions in a loop: set belt.x, step, read one output."""
    slave.reset()
    slave.setReal([vr["normal_load"]], [56.25])
    slave.setupExperiment(startTime=0.0)
    slave.enterInitializationMode()
    slave.exitInitializationMode()
    given, wanted = (ctypes.c_uint32 * 1)(vr["belt.x"]), (ctypes.c_uint32 * 1)(vr["run_in.displacement.x"])
    value, seen = (ctypes.c_double * 1)(), (ctypes.c_double * 1)()
    component, set_real, get_real, step = (slave.component, slave.fmi2SetReal, slave.fmi2GetReal,
                                           slave.fmi2DoStep)
    positions = [belt(k) for k in range(STEPS)]
    times = [k * STEP for k in range(STEPS + 1)]
    start = time.process_time()
    for k in range(STEPS):
        value[0] = positions[k]
        set_real(component, given, 1, value)
        step(component, times[k], times[k + 1] - times[k], 1)
        get_real(component, wanted, 1, seen)
    return time.process_time() - start


def measure(fmu: Path, folder: Path, library: Callable[[], float]) -> dict[str, float]:
    """Microseconds per communication step, medians of alternating rounds."""
    description = fmpy.read_model_description(str(fmu))
    # A folder of its own: unpacking again over a loaded library would crash this process.
    unzipped = fmpy.extract(str(fmu), str(folder / "fmu-python"))
    vr = {v.name: v.valueReference for v in description.modelVariables}
    slave = FMU2Slave(guid=description.guid, unzipDirectory=unzipped, modelIdentifier="TreadBlock",
                      instanceName="block")
    slave.instantiate()
    host = instructions.host_words(fmu, folder, STEPS, 5)
    names = ["time", "belt.x", "belt.z", "belt.angle", "normal_load"]
    samples = np.array([(k * STEP, belt(k), 0.0, 0.0, 56.25) for k in range(STEPS + 1)],
                       [(name, float) for name in names])

    def simulate() -> float:
        start = time.process_time()
        fmpy.simulate_fmu(unzipped, stop_time=STEPS * STEP, step_size=STEP, output_interval=STEP, input=samples,
                          start_values={"normal_load": 56.25}, output=["run_in.displacement.x"],
                          model_description=description)
        return time.process_time() - start

    loop(slave, vr)
    found: dict[str, list[float]] = {"library": [], "c": [], "loop": [], "simulate": []}
    for _ in range(5):
        found["library"].append(library() * STEPS)
        done = subprocess.run(host, capture_output=True, text=True, check=True)
        found["c"].append(statistics.median(float(line) for line in done.stdout.split()))
        found["loop"].append(statistics.median(loop(slave, vr) for _ in range(3)))
        found["simulate"].append(simulate())
    slave.freeInstance()
    return {name: 1e6 * statistics.median(values) / STEPS for name, values in found.items()}

"""The two runs: what the block is fed, by fmpy and by the command line."""

import json
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from fmpy import read_model_description, simulate_fmu

EXAMPLES = Path(__file__).resolve().parent.parent / "examples"
STEP = 1e-5  # [s] communication step


@dataclass(frozen=True)
class Case:
    """A run; `config` is the same run as a file for the command line."""

    name: str
    config: Path
    duration: float  # [s]
    speed: float  # [m/s] of the road (sliding) or of the belt (rolling)
    start_values: dict


SLIDING = Case("sliding", EXAMPLES / "slide.toml", 0.030, 0.3, {"drive.normal": "load"})
ROLLING = Case("rolling", EXAMPLES / "roll.toml", 0.022, 10.0, {"drive.normal": "trajectory"})
PRESSURE = 0.25e6  # [Pa] mean pressure of the sliding block
START_RAMP = 0.5e-3  # [s] linear start of the road
BLOCK = {"block.height": 0.010, "block.length": 0.015, "block.width": 0.015}  # [m]
CONTACT_LENGTH = 0.12  # [m] of the example's belt path
LEAD = 0.05  # [m] of belt before the flat part


def sliding_input(case):
    """Road dragged with a linear start: belt.x falls by the distance that the road would have moved."""
    t = time_grid(case)
    v = case.speed
    x = np.where(t < START_RAMP, 0.5 * v * t**2 / START_RAMP, v * (t - 0.5 * START_RAMP))
    load = np.full_like(t, PRESSURE * BLOCK["block.length"] * BLOCK["block.width"])
    return structured({"time": t, "belt.x": -x, "normal_load": load})


def rolling_input(case):
    """The example's belt path, as `tread belt` wrote it."""
    path = np.genfromtxt(EXAMPLES / "rolling-belt.csv", delimiter=",", names=True)
    return structured({
        "time": path["time_s"],
        "belt.x": path["belt_x_m"],
        "belt.z": path["belt_z_m"],
        "belt.angle": path["belt_angle_rad"],
    })


def time_grid(case):
    return np.arange(round(case.duration / STEP) + 1) * STEP


def structured(columns):
    """An input of fmpy: all four inputs of the FMU, those not used at zero."""
    names = ["time", "belt.x", "belt.z", "belt.angle", "normal_load"]
    array = np.zeros(len(columns["time"]), dtype=[(name, float) for name in names])
    for name, values in columns.items():
        array[name] = values
    return array


def run_in_fmpy(fmu, case, out):
    """Runs the FMU and leaves all its outputs as CSV."""
    description = read_model_description(str(fmu))
    outputs = [v.name for v in description.modelVariables if v.causality == "output"]
    inputs = sliding_input(case) if case is SLIDING else rolling_input(case)
    result = simulate_fmu(
        str(fmu),
        start_time=0.0,
        stop_time=case.duration,
        output_interval=STEP,
        start_values={**BLOCK, **enumerations(description, case.start_values)},
        input=inputs,
        output=outputs,
        step_finished=progress(case),
    )
    names = list(result.dtype.names)
    np.savetxt(out / f"{case.name}.csv", result, delimiter=",", header=",".join(names),
               comments="", fmt="%.12g")
    return result


def enumerations(description, values):
    """Numbers of enumeration items: what fmi2SetInteger takes."""
    number = {}
    for variable in description.modelVariables:
        if variable.name in values:
            items = variable.declaredType.items
            number[variable.name] = next(
                int(item.value) for item in items if item.name == values[variable.name])
    return number


def progress(case):
    """Tells fmpy's progress on the standard error, every tenth."""
    told = {"tenth": -1}

    def step_finished(time, _recorder):
        tenth = int(10 * time / case.duration + 1e-9)
        if tenth > told["tenth"]:
            told["tenth"] = tenth
            end = "\n" if tenth >= 10 else ""
            print(f"\r{case.name} in fmpy {10 * tenth:3d} %", end=end, file=sys.stderr, flush=True)
        return True

    return step_finished


class Tread:
    """The command line: what the FMU has no outputs for."""

    def __init__(self, binary, out):
        self.binary, self.out = binary, out

    def call(self, *arguments):
        run = subprocess.run([self.binary, *map(str, arguments)], capture_output=True, text=True)
        if run.returncode:
            sys.exit(f"demo: tread {arguments[0]} failed\n{run.stderr}")
        return run.stdout

    def field(self, case, name, *arguments):
        file = self.out / name
        self.call("simulate", case.config, "--quiet", "--set", 'run.inputs="sampled"',
                  "--out", self.out / f"{case.name}-library.csv", "--field", file, *arguments)
        return np.genfromtxt(file, delimiter=",", names=True)

    def edge_history(self, case):
        """Displacements of the nodes up the run-in edge at all times."""
        return self.field(case, f"{case.name}-edge.csv", "--field-nodes", "run-in")

    def shapes(self, case, times):
        """Displacements of all nodes at some times."""
        list_ = ",".join(f"{t:.9g}" for t in times)
        return self.field(case, f"{case.name}-shapes.csv", "--field-times", list_)

    def metrics(self, csv, speed):
        return json.loads(self.call("metrics", csv, "--speed", speed, "--json"))

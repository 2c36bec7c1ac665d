"""The same chain in three masters: fmpy's SSP, a container of fmucontainer, a plain loop in fmpy.

All three are Jacobi masters: at a communication point everyone gets the others' outputs of that point,
then all step. Each returns a structured array with the columns `COLUMNS`, one row per step.
"""

import json
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace
from unittest import mock

import fmpy
import fmpy.ssp.simulation as ssp
import numpy as np
from fmpy.fmi2 import FMU2Slave

HERE = Path(__file__).resolve().parent
POSE = ["belt.x", "belt.z", "belt.angle"]
HEARD = ["force.z", "run_in.velocity.x", "run_out.velocity.x"]
THIRD_OCTAVES = [f"third_octave.level[{i}]" for i in range(1, 22)]
LINES = [f"spectrum.pressure[{i}]" for i in range(1, 101)]
COLUMNS = ["time", "force.x", *HEARD, "pressure", "level", *THIRD_OCTAVES]


class Member:
    """One FMU of the plain loop, by names."""

    def __init__(self, fmu, name=None, unzipped=None, start=0.0, **values):
        self.folder = unzipped or fmpy.extract(str(fmu))
        description = fmpy.read_model_description(self.folder)
        self.reference = {v.name: v.valueReference for v in description.modelVariables}
        kinds = {v.name: v.type for v in description.modelVariables}
        self.slave = FMU2Slave(guid=description.guid, unzipDirectory=self.folder,
                               modelIdentifier=description.coSimulation.modelIdentifier,
                               instanceName=name or Path(fmu).stem)
        self.slave.instantiate()
        for key, value in values.items():
            put = self.slave.setReal if kinds[key] == "Real" else self.slave.setInteger
            put([self.reference[key]], [value])
        self.slave.setupExperiment(startTime=start)

    def initialize(self):
        self.slave.enterInitializationMode()
        self.slave.exitInitializationMode()

    def get(self, names):
        return self.slave.getReal([self.reference[name] for name in names])

    def set(self, names, values):
        self.slave.setReal([self.reference[name] for name in names], values)

    def rates(self, names, order):
        return self.slave.getRealOutputDerivatives([self.reference[name] for name in names],
                                                   [order] * len(names))

    def set_rates(self, names, order, values):
        self.slave.setRealInputDerivatives([self.reference[name] for name in names],
                                           [order] * len(names), values)

    def close(self):
        self.slave.terminate()
        self.slave.freeInstance()


def plain_loop(folder, step, duration, derivatives=True, at_end=None, **parameters):
    """Three instances and a loop; with `derivatives`, each input comes with its own.

    `parameters` are those of the block; `at_end` gets the acoustic stage before it is freed.
    """
    source = Member(folder / "BeltSource.fmu")
    block = Member(folder / "TreadBlock.fmu", **parameters)
    sound = Member(folder / "AcousticStage.fmu")
    source.initialize()
    block.set(POSE, source.get(POSE))
    block.initialize()
    sound.set(HEARD, block.get(HEARD))
    sound.initialize()
    rows = []
    for k in range(round(duration / step)):
        block.set(POSE, source.get(POSE))
        sound.set(HEARD, block.get(HEARD))
        if derivatives:
            for order in (1, 2):
                block.set_rates(POSE, order, source.rates(POSE, order))
            if k > 0:  # The block has no output derivatives before its first step.
                sound.set_rates(HEARD, 1, block.rates(HEARD, 1))
        for member in (source, block, sound):
            member.slave.doStep(k * step, step)
        rows.append(((k + 1) * step, *block.get(["force.x", *HEARD]),
                     *sound.get(["pressure", "level", *THIRD_OCTAVES])))
    if at_end:
        at_end(sound)
    for member in (source, block, sound):
        member.close()
    return np.array(rows, dtype=[(name, float) for name in COLUMNS])


def fmpy_ssp(folder, step, duration):
    """Chain.ssp in fmpy's SSP master.

    It exchanges nothing before the first step: inputs would be 0 there, a belt at the height of the
    road. So an FMU's connectors get their first values as soon as it is initialized.
    """
    instantiate, ready = ssp.instantiate_fmu, {}

    def with_first_values(component, *arguments):
        # In this chain connectors that belong together have the same name.
        inputs = [c for c in component.connectors if c.kind == "input" and c.name in ready]
        for connector in inputs:
            connector.value = ready[connector.name]
        first = SimpleNamespace(parameters=[
            SimpleNamespace(name=f"{component.name}.{c.name}", value=c.value) for c in inputs])
        instantiate(component, *arguments[:-1], first)
        ready.update((c.name, ssp.get_value(component, c.name))
                     for c in component.connectors if c.kind == "output")

    with mock.patch.object(ssp, "instantiate_fmu", with_first_values):
        # Half a step less: its loop compares sums of steps with the stop time.
        result = ssp.simulate_ssp(str(folder / "Chain.ssp"), stop_time=duration - 0.5 * step,
                                  step_size=step)
    prefix = {name: "sound" for name in COLUMNS[5:]} | {name: "block" for name in COLUMNS[1:5]}
    rows = np.empty(len(result), dtype=[(name, float) for name in COLUMNS])
    rows["time"] = result["time"] + step
    for name, component in prefix.items():
        rows[name] = result[f"{component}.{name}"]
    return rows


def container(folder, step, duration):
    """The three FMUs inside one, made by fmucontainer and driven by its own master in C."""
    plan = json.loads((HERE / "container.json").read_text())
    plan["step_size"] = step
    (folder / "container.json").write_text(json.dumps(plan))
    tool = Path(sys.executable).parent / "fmucontainer"
    done = subprocess.run([tool, "-container", "container.json", "-fmu-directory", "."], cwd=folder,
                          capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"chain: fmucontainer failed\n{done.stdout}{done.stderr}")
    result = fmpy.simulate_fmu(str(folder / "Container.fmu"), stop_time=duration, step_size=step,
                               output_interval=step, validate=False, output=COLUMNS[1:],
                               logger=tell)
    return result[1:]


def tell(_environment, instance, status, category, message):
    """Messages of the container, but for those by which it says how it is set up."""
    text = message.decode()
    if not text.startswith(("FMUContainer '", "Solver configure", "Container use ")):
        print(f"{instance.decode()} [{status}] {category.decode()}: {text}", file=sys.stderr)

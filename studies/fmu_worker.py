"""What one worker does: runs points of a plan on the FMU, instantiated once and reset per point.

What to set for a point, and what its outputs amount to, is asked of `tread sweep PLAN --serve`, which comes
along with the FMU: plan and measures have one implementation, so a worker gives the bits of `tread
sweep`. This file is sent to Dask's workers and must not import its neighbours.
"""

from __future__ import annotations

import ctypes
import hashlib
import json
import os
import subprocess
import tempfile
import threading
import tomllib
import weakref
from dataclasses import dataclass
from pathlib import Path

import fmpy
import numpy as np
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE


@dataclass(frozen=True)
class Kit:
    """Everything that a worker needs, as bytes: it may be on another machine."""

    fmu: bytes
    tread: bytes
    plan: bytes
    files: dict[str, bytes]
    """Files that the plan names, by their relative path."""

    @classmethod
    def gather(cls, plan: Path, fmu: Path, tread: Path) -> Kit:
        document = tomllib.loads(plan.read_text())
        belt = document.get("run", {}).get("roll", {}).get("belt_file")
        table = document.get("friction", {}).get("table_file")
        places = [(belt, plan.parent), (table, Path.cwd())]
        files = {name: (folder / name).read_bytes() for name, folder in places if name}
        return cls(fmu.read_bytes(), tread.read_bytes(), plan.read_bytes(), files)

    def digest(self) -> str:
        parts = [self.fmu, self.tread, self.plan, *self.files.values()]
        return hashlib.sha256(b"".join(hashlib.sha256(p).digest() for p in parts)).hexdigest()

    def unpack(self, folder: Path) -> None:
        for name, content in {"block.fmu": self.fmu, "tread": self.tread, "plan.toml": self.plan,
                              **{n: c for n, c in self.files.items() if not os.path.isabs(n)}}.items():
            target = folder / name
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(content)
        (folder / "tread").chmod(0o755)


class Cases:
    """`tread sweep PLAN --serve`: questions and answers line by line."""

    def __init__(self, tread: Path, plan: Path) -> None:
        self.process = subprocess.Popen([tread, "sweep", plan, "--serve"], text=True, cwd=plan.parent,
                                        stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self.greeting = self._read()

    def ask(self, **question) -> dict:
        self.process.stdin.write(json.dumps(question) + "\n")
        self.process.stdin.flush()
        return self._read()

    def close(self) -> None:
        self.process.stdin.close()
        self.process.wait()
        self.process.stdout.close()

    def _read(self) -> dict:
        line = self.process.stdout.readline()
        if not line:
            raise RuntimeError("tread sweep --serve has ended: what it says is above")
        return json.loads(line)


class Block:
    """One instance of the FMU."""

    def __init__(self, fmu: Path, folder: Path) -> None:
        description = fmpy.read_model_description(str(fmu))
        self.variables = {v.name: v for v in description.modelVariables}
        self.messages: list[str] = []
        # The FMU calls these as long as it lives: they are kept with it.
        self.callbacks = fmi2CallbackFunctions()
        self.callbacks.logger = fmi2CallbackLoggerTYPE(self._log)
        self.slave = FMU2Slave(guid=description.guid, modelIdentifier="TreadBlock", instanceName="point",
                               unzipDirectory=fmpy.extract(str(fmu), str(folder)))
        self.slave.instantiate(callbacks=self.callbacks)

    def run(self, time, parameters: dict, inputs: dict, outputs: list[str]) -> list[np.ndarray]:
        """Outputs at the communication points `time`; what stops the FMU is a RuntimeError."""
        self.messages.clear()
        try:
            return self._run(time, parameters, inputs, outputs)
        except FMICallException as error:
            raise RuntimeError("\n".join(self.messages) or str(error)) from error
        finally:
            self.slave.reset()

    def _run(self, time, parameters, inputs, outputs):
        slave, steps = self.slave, len(time)
        for name, value in parameters.items():
            self._set(name, value)
        given = self._references(inputs)
        wanted = self._references(outputs)
        # Rows that ctypes hands over without a copy: the loop below is all the overhead there is.
        samples = np.ascontiguousarray(np.array(list(inputs.values())).T)
        rows = np.zeros((steps, len(outputs)))
        sample = (ctypes.c_double * len(inputs) * steps).from_buffer(samples)
        row = (ctypes.c_double * len(outputs) * steps).from_buffer(rows)
        component, times = slave.component, time.tolist()
        set_real, get_real, step = slave.fmi2SetReal, slave.fmi2GetReal, slave.fmi2DoStep
        set_real(component, given, len(inputs), sample[0])
        slave.setupExperiment(startTime=times[0])
        slave.enterInitializationMode()
        slave.exitInitializationMode()
        get_real(component, wanted, len(outputs), row[0])
        for k in range(steps - 1):
            set_real(component, given, len(inputs), sample[k])
            step(component, times[k], times[k + 1] - times[k], 1)
            get_real(component, wanted, len(outputs), row[k + 1])
        return [np.ascontiguousarray(column) for column in rows.T]

    def _set(self, name: str, value) -> None:
        variable = self.variables[name]
        reference = [variable.valueReference]
        match variable.type:
            case "Real":
                self.slave.setReal(reference, [float(value)])
            case "Boolean":
                self.slave.setBoolean(reference, [bool(value)])
            case "String":
                self.slave.setString(reference, [value])
            case _:
                self.slave.setInteger(reference, [int(value)])

    def _references(self, names):
        references = [self.variables[name].valueReference for name in names]
        return (ctypes.c_uint32 * len(references))(*references)

    def _log(self, _environment, _instance, _status, _category, message) -> None:
        self.messages.append(message.decode(errors="replace"))


class Station:
    """A worker's FMU and its cases, kept from batch to batch."""

    def __init__(self, kit: Kit) -> None:
        self.folder = tempfile.TemporaryDirectory(prefix="tread-sweep-")
        here = Path(self.folder.name)
        kit.unpack(here)
        self.cases = Cases(here / "tread", here / "plan.toml")
        self.block = Block(here / "block.fmu", here / "fmu")
        weakref.finalize(self, self.cases.process.kill)

    def line(self, point: int) -> str:
        """The journal's line of a point."""
        case = self.cases.ask(case=point)
        if "line" in case:
            return case["line"]
        parameters = case["parameters"]
        table = Path(self.folder.name) / parameters.get("friction.table_file", "")
        if table.is_file():
            parameters["friction.table_file"] = str(table)
        inputs = {name: _numbers(text) for name, text in case["inputs"].items()}
        try:
            outputs = self.block.run(_numbers(case["time"]), parameters, inputs,
                                     self.cases.greeting["outputs"])
        except RuntimeError as error:
            return self.cases.ask(failed=point, reason=str(error))["line"]
        return self.cases.ask(measure=point, outputs=[o.tobytes().hex() for o in outputs])["line"]


def _numbers(text: str) -> np.ndarray:
    return np.frombuffer(bytearray.fromhex(text))


# One station per thread and kit. ctypes lets go of the interpreter in the FMU, yet workers of one thread
# are the fast ones: the loop around the FMU is Python's.
_stations = threading.local()


def run(kit: Kit, digest: str, points: list[int]) -> list[str]:
    """Lines of the journal for a batch of points."""
    if getattr(_stations, "digest", None) != digest:
        _stations.station, _stations.digest = Station(kit), digest
    return [_stations.station.line(point) for point in points]


class KitPlugin:
    """Keeps the kit on a Dask worker, also on those that join later: it arrives once, before the first
    batch. A base class of `distributed` is mixed in where there is one."""

    def __init__(self, kit: Kit) -> None:
        self.kit, self.digest = kit, kit.digest()


def run_delivered(plugin: str, points: list[int]) -> list[str]:
    """As `run`, with the kit that the plugin of this name brought."""
    from distributed import get_worker

    brought = get_worker().plugins[plugin]
    return run(brought.kit, brought.digest, points)

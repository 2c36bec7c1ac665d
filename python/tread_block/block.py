"""The block: parameters by their dotted names, runs as pandas frames with units."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import fmpy
import numpy as np
import pandas as pd

from . import motion

Value = float | int | bool | str


class TreadBlockError(ValueError):
    """What the FMU or this package refuses; the text names what, value, allowed range, way out."""


@dataclass(frozen=True)
class Variable:
    """A variable of the FMU."""

    name: str
    causality: str
    unit: str
    start: str | None
    description: str
    items: tuple[str, ...] = ()
    """Choices of an enumeration, the first with the value 1."""


class TreadBlock:
    """A tread block with given parameters; each run starts from rest.

    `parameters` maps dotted names to values in SI units, or to the name of an item for enumerations.
    `fmu` is TreadBlock.fmu; if not given, the environment variable TREAD_BLOCK_FMU names it, or it is
    looked for as out/TreadBlock.fmu in this folder and those above it.
    """

    def __init__(self, parameters: Mapping[str, Value] | None = None,
                 fmu: str | os.PathLike[str] | None = None) -> None:
        self.fmu = Path(fmu) if fmu is not None else _find_fmu()
        if not self.fmu.is_file():
            raise TreadBlockError(f"fmu = {self.fmu}: not a file; `make fmu` builds it")
        description = fmpy.read_model_description(str(self.fmu))
        self.variables: dict[str, Variable] = {
            v.name: _variable(v) for v in description.modelVariables}
        self.parameters: dict[str, Value] = dict(parameters or {})
        self._check(self.parameters)

    def slide(self, *, speed: float, pressure: float | None = None, load: float | None = None,
              duration: float = 0.03, step: float = 1e-5, start_ramp: float = 0.5e-3,
              dwell: float = 0.0) -> pd.DataFrame:
        """Drags the block over the road with `speed` [m/s] under `pressure` [Pa] or `load` [N].

        The road starts linearly within `start_ramp` [s] after `dwell` [s] of rest; positive speed
        drags the block from its run-in to its run-out edge. One row every `step` [s].
        """
        if pressure is not None and load is None:
            load = pressure * self._number("block.length") * self._number("block.width")
        elif pressure is not None or load is None:
            raise TreadBlockError("pressure, load: give exactly one of them")
        signals = motion.slide(speed, load, duration, step, start_ramp, dwell)
        return self._run(signals, step, {"drive.normal": "load"})

    def roll(self, path: pd.DataFrame | str | os.PathLike[str], *,
             step: float = 1e-5) -> pd.DataFrame:
        """Rolls the block along a belt path: the columns time_s, belt_x_m, belt_z_m, belt_angle_rad
        of a frame or CSV file, as `tread belt` writes them."""
        signals = motion.roll(path)
        return self._run(signals, step, {"drive.normal": "trajectory"})

    def units(self) -> dict[str, str]:
        """SI unit of every variable; `1` where there is none."""
        return {v.name: v.unit for v in self.variables.values()}

    def _run(self, signals: pd.DataFrame, step: float, fixed: Mapping[str, Value]) -> pd.DataFrame:
        outputs = [v.name for v in self.variables.values() if v.causality == "output"]
        messages: list[str] = []

        def log(_environment: Any, _instance: Any, _status: Any, _category: Any, message: Any) -> None:
            messages.append(message.decode() if isinstance(message, bytes) else str(message))

        start = {name: self._fmi(name, value) for name, value in {**self.parameters, **fixed}.items()}
        try:
            result = fmpy.simulate_fmu(
                str(self.fmu), start_time=float(signals["time"].iloc[0]),
                stop_time=float(signals["time"].iloc[-1]), output_interval=step,
                start_values=start, input=signals.to_records(index=False), output=outputs, logger=log)
        except Exception as error:
            raise TreadBlockError("\n".join(messages) or str(error)) from error
        frame = pd.DataFrame({name: result[name] for name in result.dtype.names}).set_index("time")
        frame.attrs["units"] = {"time": "s", **{name: self.variables[name].unit for name in outputs}}
        frame.attrs["parameters"] = {**self.parameters, **fixed}
        return frame

    def _check(self, parameters: Mapping[str, Value]) -> None:
        """All unknown names and items at once; ranges are the FMU's business."""
        problems = []
        for name, value in parameters.items():
            variable = self.variables.get(name)
            if variable is None or variable.causality != "parameter":
                problems.append(f"{name} = {value}: allowed is a parameter of the FMU; "
                                "TreadBlock().variables lists them")
            elif isinstance(value, str) and variable.items and value not in variable.items:
                problems.append(f"{name} = {value}: allowed is {', '.join(variable.items)}")
        if problems:
            raise TreadBlockError("\n".join(problems))

    def _number(self, name: str) -> float:
        return float(self.parameters.get(name, self.variables[name].start or 0.0))

    def _fmi(self, name: str, value: Value) -> Value:
        items = self.variables[name].items
        return items.index(value) + 1 if items and isinstance(value, str) else value


def _variable(v: fmpy.model_description.ScalarVariable) -> Variable:
    declared = v.declaredType
    items = tuple(item.name for item in declared.items) if declared and declared.items else ()
    unit = v.unit or (declared.unit if declared else None) or "1"
    return Variable(v.name, v.causality, unit, v.start, v.description or "", items)


def _find_fmu() -> Path:
    named = os.environ.get("TREAD_BLOCK_FMU")
    if named:
        return Path(named)
    here = Path.cwd()
    for folder in [here, *here.parents]:
        if (folder / "out/TreadBlock.fmu").is_file():
            return folder / "out/TreadBlock.fmu"
    raise TreadBlockError("fmu = None: no out/TreadBlock.fmu here or above; "
                          "name the file, or set TREAD_BLOCK_FMU")

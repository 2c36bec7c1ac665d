"""Measurement files of laboratories as CSV with units in the header, which `tread gap import` reads.

    python -m tread_block.measurements run-01.mf4 run-02.tdms run-03.uff --out raw

MDF4 is read by asammdf, TDMS by npTDMS, UFF58 by pyuff (`pip install tread-block[measurements]`). Nothing is
resampled, filtered or converted here: numbers, instants and units are those of the file. Signals that share
their instants share a time column; signals with others get one of their own. What is left out is told.
"""

from __future__ import annotations

import argparse
import csv
import sys
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from itertools import zip_longest
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

Numbers = NDArray[np.float64]


class MeasurementError(Exception):
    """A file that cannot be read, with what to do about it."""


@dataclass(frozen=True)
class Signal:
    """One recorded quantity; `time` [s] is None where the file has no time base for it."""

    name: str
    unit: str
    values: Numbers
    time: Numbers | None
    group: str = ""


@dataclass(frozen=True)
class Recording:
    """What a file holds, and what was left out of it and why."""

    signals: list[Signal]
    left_out: list[str]


def _numeric(values: object) -> Numbers | None:
    """Plain numbers of one dimension, or None."""
    array = np.asarray(values)
    if array.ndim != 1 or array.dtype.kind not in "iuf" or not array.size:
        return None
    return array.astype(float)


def read_mdf(path: Path) -> Recording:
    """MDF 3 and 4: every channel in its physical unit, by its group's master channel."""
    from asammdf import MDF

    signals, left_out = [], []
    with MDF(path) as mdf:
        # Its types say less than its manual does.
        groups: list[Any] = list(mdf.groups)
        for number, group in enumerate(groups):
            masters = {mdf.masters_db.get(number)}
            label = str(getattr(group.channel_group, "acq_name", "") or f"group {number + 1}")
            for index, channel in enumerate(group.channels):
                if index in masters:
                    continue
                signal = mdf.get(group=number, index=index)
                values = _numeric(signal.samples)
                if values is None:
                    left_out.append(f"{channel.name}: no plain numbers")
                    continue
                time = np.asarray(signal.timestamps, dtype=float)
                signals.append(Signal(channel.name, signal.unit or "", values, time, label))
    return Recording(signals, left_out)


def read_tdms(path: Path) -> Recording:
    """TDMS: scaled channels; the time base is the waveform's increment and offset."""
    from nptdms import TdmsFile

    signals, left_out, starts = [], [], []
    for group in TdmsFile.read(path).groups():
        for channel in group.channels():
            values = _numeric(channel[:])
            if values is None:
                left_out.append(f"{channel.name}: no plain numbers")
                continue
            time = None
            if channel.properties.get("wf_increment"):
                time = channel.time_track()
                starts.append(channel.properties.get("wf_start_time"))
            unit = str(channel.properties.get("unit_string", ""))
            signals.append(Signal(channel.name, unit, values, time, group.name))
    known = {np.datetime64(start, "ns") for start in starts if start is not None}
    if len(known) > 1:
        raise MeasurementError(f"{path}: the channels start at {len(known)} instants (wf_start_time); "
                               "export them with a common start")
    return Recording(signals, left_out)


def read_uff(path: Path) -> Recording:
    """UFF: data sets 58 that are responses over time; the ordinate's label is the unit."""
    import pyuff

    signals, left_out = [], []
    file = pyuff.UFF(str(path))
    for number, kind in enumerate(file.get_set_types()):
        if int(kind) != 58:
            left_out.append(f"data set {number + 1}: type {int(kind)}")
            continue
        data = file.read_sets(number)
        if data["func_type"] != 1:
            left_out.append(f"data set {number + 1}: function type {data['func_type']}, no time response")
            continue
        values = _numeric(data["data"])
        abscissa = data.get("abscissa_axis_units_lab", "").strip()
        if values is None or abscissa not in ("s", "sec", "S", "SEC", "NONE", ""):
            left_out.append(f"data set {number + 1}: no real numbers over seconds ({abscissa!r})")
            continue
        name = data.get("id1", "").strip()
        if name in ("", "NONE"):
            name = f"{data['rsp_node']}:{data['rsp_dir']}"
        unit = data.get("ordinate_axis_units_lab", "").strip()
        time = np.asarray(data["x"], dtype=float)
        signals.append(Signal(name, "" if unit == "NONE" else unit, values, time))
    return Recording(signals, left_out)


READERS: dict[str, Callable[[Path], Recording]] = {
    ".mf4": read_mdf, ".mdf": read_mdf, ".dat": read_mdf, ".tdms": read_tdms,
    ".uff": read_uff, ".unv": read_uff, ".bunv": read_uff,
}


def read(path: str | Path) -> Recording:
    """A measurement file by its ending."""
    path = Path(path)
    reader = READERS.get(path.suffix.lower())
    if reader is None:
        raise MeasurementError(f"{path}: the ending is none of {', '.join(READERS)}")
    if not path.exists():
        raise MeasurementError(f"{path}: no such file")
    try:
        recording = reader(path)
    except ImportError as error:
        raise MeasurementError(f"{path}: {error.name} is missing: pip install tread-block[measurements]") from error
    except MeasurementError:
        raise
    except Exception as error:  # the readers raise whatever their parsers do
        raise MeasurementError(f"{path}: {error}") from error
    if not recording.signals:
        raise MeasurementError(f"{path}: no numeric signals ({'; '.join(recording.left_out) or 'empty'})")
    return recording


def _columns(signals: Iterable[Signal]) -> Iterator[tuple[str, Numbers]]:
    """Columns with their headers: each time base before the signals that share it."""
    signals = list(signals)
    bases: list[Numbers] = []
    members: list[list[Signal]] = []
    for signal in signals:
        if signal.time is None:
            continue
        for base, member in zip(bases, members):
            if np.array_equal(base, signal.time):
                member.append(signal)
                break
        else:
            bases.append(signal.time)
            members.append([signal])
    names = [signal.name for signal in signals]

    def header(signal: Signal) -> str:
        twice = names.count(signal.name) > 1 and signal.group
        name = f"{signal.group}/{signal.name}" if twice else signal.name
        return f"{name} [{signal.unit}]" if signal.unit else name

    for number, (base, member) in enumerate(zip(bases, members), start=1):
        yield ("time [s]" if len(bases) == 1 else f"time {number} [s]"), base
        yield from ((header(signal), signal.values) for signal in member)
    yield from ((header(signal), signal.values) for signal in signals if signal.time is None)


def write_csv(recording: Recording, path: str | Path) -> list[str]:
    """Writes a recording; every number comes back to the last bit. Returns the header."""
    headers, columns = zip(*_columns(recording.signals))
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(headers)
        for row in zip_longest(*(column.tolist() for column in columns), fillvalue=""):
            writer.writerow([cell if cell == "" else repr(cell) for cell in row])
    return list(headers)


def main(arguments: list[str] | None = None) -> int:
    """The command line: 0 all files written, 2 some could not be read."""
    parser = argparse.ArgumentParser(prog="python -m tread_block.measurements", description=__doc__.split("\n")[0])
    parser.add_argument("files", nargs="+", type=Path, help="MDF4, TDMS or UFF58 files")
    parser.add_argument("--out", type=Path, required=True, help="folder for the CSV files")
    options = parser.parse_args(arguments)
    options.out.mkdir(parents=True, exist_ok=True)
    failed = False
    for path in options.files:
        try:
            recording = read(path)
            target = options.out / f"{path.stem}.csv"
            headers = write_csv(recording, target)
        except MeasurementError as error:
            print(error, file=sys.stderr)
            failed = True
            continue
        print(target)
        print(f"{path}: {', '.join(headers)}", file=sys.stderr)
        for signal in recording.signals:
            if signal.time is None:
                print(f"note: {signal.name} has no time base; the plan must name a column", file=sys.stderr)
            if not signal.unit:
                print(f"note: {signal.name} has no unit; the plan must give it", file=sys.stderr)
        for reason in recording.left_out:
            print(f"left out: {reason}", file=sys.stderr)
    return 2 if failed else 0


if __name__ == "__main__":
    sys.exit(main())

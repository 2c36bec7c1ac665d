"""Instructions per simulated millisecond, and the budget that they must keep.

    .venv/bin/python benches/instructions.py [--rebase "why"]

Counted by callgrind inside fmi2DoStep of the FMU that ships, on a sliding block of 15 mm: exact to the
instruction whatever else the machine does. valgrind knows no AVX-512, so it is the AVX2 path. --rebase
writes the count of now as the budget, with its reason.
"""

from __future__ import annotations

import csv
import datetime
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import fmpy

ROOT = Path(__file__).resolve().parents[1]
BUDGET = ROOT / "benches" / "instructions.csv"
STEPS, STEP = 300, 20e-6


def host_words(fmu: Path, folder: Path, steps: int, repeats: int) -> list[str]:
    """The C host on this FMU; built if it is not there."""
    host = folder / "fmu_host"
    source = ROOT / "benches/peers/fmu_host.c"
    if not host.exists() or host.stat().st_mtime < source.stat().st_mtime:
        folder.mkdir(parents=True, exist_ok=True)
        subprocess.run(["cc", "-O2", source, "-o", host, "-ldl"], check=True)
    description = fmpy.read_model_description(str(fmu))
    unzipped = fmpy.extract(str(fmu), str(folder / "fmu"))
    vr = {v.name: str(v.valueReference) for v in description.modelVariables}
    library = Path(unzipped) / "binaries/linux64/TreadBlock.so"
    return [str(host), str(library), description.guid, repr(STEP), str(steps), str(repeats), vr["belt.x"],
            vr["normal_load"], vr["run_in.displacement.x"]]


def count(fmu: Path, folder: Path) -> float:
    """Instructions per simulated millisecond."""
    out = folder / "callgrind.fmu"
    command = ["valgrind", "--tool=callgrind", "--collect-atstart=no", "--toggle-collect=fmi2DoStep",
               f"--callgrind-out-file={out}", *host_words(fmu, folder, STEPS, 1)]
    subprocess.run(command, check=True, capture_output=True)
    total = int(re.search(r"^(?:summary|totals): (\d+)", out.read_text(), re.M)[1])
    return total / (1e3 * STEPS * STEP)


def budget() -> float:
    """The last line's count."""
    with open(BUDGET, newline="") as file:
        return float(list(csv.DictReader(file))[-1]["instructions_per_ms"])


def rebase(instructions: float, why: str) -> None:
    revision = subprocess.run(["git", "describe", "--always", "--dirty"], capture_output=True, text=True,
                              cwd=ROOT).stdout.strip()
    rows = list(csv.reader(open(BUDGET))) if BUDGET.exists() else \
        [["date", "after_revision", "instructions_per_ms", "why"]]
    rows.append([datetime.date.today().isoformat(), revision, f"{instructions:.0f}", why])
    with open(BUDGET, "w", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows(rows)


def main() -> None:
    with tempfile.TemporaryDirectory() as folder:
        fmu = Path(os.environ.get("TREAD_FMU", ROOT / "out/TreadBlock.fmu"))
        found = count(fmu, Path(folder))
    print(f"{found:.0f} instructions per simulated millisecond")
    if sys.argv[1:2] == ["--rebase"]:
        rebase(found, " ".join(sys.argv[2:]) or "no reason given")
    elif BUDGET.exists():
        print(f"{100 * (found / budget() - 1):+.2f} % of the budget of {budget():.0f}")


if __name__ == "__main__":
    main()

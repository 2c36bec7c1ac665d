"""A sweep on the FMU: the same plan and the same bits as `tread sweep`, on one machine or a cluster.

    python studies/sweep.py plan.toml --out out/sweep --engine serial
    python studies/sweep.py plan.toml --out out/sweep --engine joblib --jobs 8
    python studies/sweep.py plan.toml --out out/sweep --engine dask --scheduler tcp://head:8786

The journal is that of `tread sweep`: either can go on with what the other began (--resume), and the
tables are written by it.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

from tqdm import tqdm

import engines
from fmu_worker import Cases, Kit

ROOT = Path(__file__).resolve().parents[1]


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("plan", type=Path, help="the plan: TOML with a [sweep] table")
    parser.add_argument("--out", type=Path, default=Path("out/sweep"), help="folder for the results")
    parser.add_argument("--engine", choices=["serial", "joblib", "dask"], default="serial")
    parser.add_argument("--scheduler", help="address of a running Dask scheduler; a local one if not given")
    parser.add_argument("--jobs", type=int, default=0, help="processes of joblib and a local Dask; 0: all cores")
    parser.add_argument("--batch", type=int, default=0, help="points per task; 0: chosen from their number")
    parser.add_argument("--resume", action="store_true", help="go on with the sweep that the folder holds")
    parser.add_argument("--fmu", type=Path, default=ROOT / "out/TreadBlock.fmu")
    parser.add_argument("--tread", type=Path, default=None, help="the command; $TREAD or the one on PATH")
    return parser.parse_args()


def find_tread(given: Path | None) -> Path:
    built = ROOT / "target/release/tread"
    found = given or os.environ.get("TREAD") or (built if built.is_file() else shutil.which("tread"))
    if not found or not Path(found).is_file():
        sys.exit("tread is not found: build it with `cargo build --release`, or give --tread")
    return Path(found).resolve()


def open_journal(path: Path, header: str, resume: bool) -> set[int]:
    """Makes the journal or cuts a torn last line off it; returns the points in it."""
    path.parent.mkdir(parents=True, exist_ok=True)
    text = path.read_text() if path.exists() else ""
    if not text:
        path.write_text(header)
        return set()
    if not resume:
        sys.exit(f"{path} holds a started sweep: --resume goes on with it; or name another --out")
    whole = text[:text.rfind("\n") + 1].splitlines(keepends=True)
    if whole[0] != header:
        sys.exit(f"{path} is the journal of another plan or version: name another --out")
    path.write_text("".join(whole))
    return {json.loads(line)["point"] for line in whole[1:]}


def batches(pending: list[int], size: int, workers: int) -> list[list[int]]:
    """So large that the scheduler has at most a few thousand tasks, so small that none waits long."""
    size = size or max(1, min(50, len(pending) // (8 * workers)), len(pending) // 20_000)
    return [pending[i:i + size] for i in range(0, len(pending), size)]


def main() -> int:
    args = arguments()
    tread = find_tread(args.tread)
    plan = args.plan.resolve()
    cases = Cases(tread, plan)
    journal = args.out / "journal.jsonl"
    done = open_journal(journal, cases.greeting["header"], args.resume)
    points = cases.greeting["points"]
    pending = [point for point in range(points) if point not in done]
    jobs = args.jobs or engines.cores()
    work = batches(pending, args.batch, jobs)
    kit = Kit.gather(plan, args.fmu.resolve(), tread)
    fail = lambda point, reason: cases.ask(failed=point, reason=reason)["line"]
    match args.engine:
        case "serial":
            results = engines.serial(kit, work, fail)
        case "joblib":
            results = engines.joblib(kit, work, fail, jobs)
        case _:
            results = engines.dask(kit, work, fail, jobs, args.scheduler)
    # Unbuffered: what is written is with the system, whatever becomes of this process.
    with open(journal, "ab", buffering=0) as out, \
            tqdm(total=points, initial=len(done), unit=" points", disable=None) as bar:
        for lines in results if work else ():
            out.write("".join(lines).encode())
            bar.update(len(lines))
    cases.close()
    return subprocess.run([tread, "sweep", plan, "--out", args.out.resolve(), "--resume"],
                          cwd=plan.parent).returncode


if __name__ == "__main__":
    sys.exit(main())

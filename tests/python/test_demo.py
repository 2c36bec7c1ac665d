"""The demo as a whole: its files, its table, and its sliding run against an independent solution."""

import csv
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
FMU = ROOT / "out/TreadBlock.fmu"
TREAD = ROOT / os.environ.get("TREAD", "target/release/tread")
pytestmark = pytest.mark.skipif(not (FMU.exists() and TREAD.exists()),
                                reason="the FMU or the command line is not built")

PICTURES = ["sliding-displacement", "sliding-limit-cycle", "sliding-forces", "sliding-face",
            "rolling-shapes", "rolling-run-in-edge"]


@pytest.fixture(scope="module")
def demo(tmp_path_factory):
    out = tmp_path_factory.mktemp("demo")
    command = [sys.executable, ROOT / "demo/demo.py", "--fmu", FMU, "--tread", TREAD, "--out", out]
    run = subprocess.run(command, capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    return out, run.stdout


def metrics(file):
    run = subprocess.run([TREAD, "metrics", file, "--speed", "0.3", "--json"], capture_output=True,
                         text=True, check=True)
    return {name: entry["value"] for name, entry in json.loads(run.stdout).items()}


def test_all_pictures_are_drawn_and_the_table_is_told(demo):
    out, table = demo
    for name in PICTURES:
        # An empty figure of this size has less than 15 kB.
        assert (out / f"{name}.png").stat().st_size > 15_000, name
        assert (out / f"{name}.svg").exists()
    for word in ["stick-slip frequency", "mean friction", "stick fraction", "peak to peak"]:
        assert word in table


def test_the_sliding_run_is_the_independent_solution(demo, tmp_path):
    """slide-1.csv is the demo's case, solved by another program to 24 ms."""
    names = {"t": "time", "edge_in_x": "run_in.displacement.x", "edge_in_vx": "run_in.velocity.x"}
    with open(ROOT / "tests/data/verification/slide-1.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    with open(tmp_path / "reference.csv", "w", encoding="utf-8") as file:
        print(*names.values(), "contact.friction_coefficient", "contact.stick_fraction", sep=",",
              file=file)
        for row in rows:
            friction = float(row["Fx"]) / float(row["Fz"])
            print(*(row[name] for name in names), friction, 0, sep=",", file=file)
    expected, found = metrics(tmp_path / "reference.csv"), metrics(demo[0] / "sliding.csv")
    # The tolerances that the project sets itself.
    for name, tolerance in [("stick-slip frequency", 0.01), ("mean friction", 0.01)]:
        assert found[name] == pytest.approx(expected[name], rel=tolerance), name

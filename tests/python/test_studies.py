"""Sweeps on the FMU: every engine gives the bits of `tread sweep`, also when workers are lost."""

import json
import os
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

import pyarrow.parquet
import pytest

from conftest import ROOT

DRIVER = ROOT / "studies" / "sweep.py"
PLAN = """
[run]
duration = 0.004
communication_step = 2e-5
[run.slide]
speed = 0.3
mean_pressure = 250e3
[solver]
elements_along = 6
elements_up = 4
[sweep]
method = "sobol"
points = 24
[sweep.vary]
"block.length" = [0.010, 0.015, 0.5]
"friction.mu_inf" = { from = 0.4, to = 0.6 }
"friction.form" = ["exponential", "rational"]
"run.slide.speed" = { from = 0.1, to = 1.0, scale = "log" }
"""


def tread():
    return ROOT / os.environ.get("TREAD", "target/debug/tread")


@pytest.fixture(scope="module")
def plan(tmp_path_factory):
    """A plan and the answer of `tread sweep` to it, some of whose points are out of range."""
    folder = tmp_path_factory.mktemp("plan")
    path = folder / "plan.toml"
    path.write_text(PLAN)
    done = subprocess.run([tread(), "sweep", path, "--out", folder / "library", "-q"])
    assert done.returncode == 1
    assert (folder / "library/sweep.csv").read_text().count("failed") > 5, "a third is out of range"
    return path


def drive(plan, fmu, out, *arguments):
    command = [sys.executable, DRIVER, plan, "--out", out, "--fmu", fmu, "--tread", tread(), *arguments]
    return subprocess.run(command, capture_output=True, text=True, timeout=300)


def assert_same_tables(plan, out):
    for name in ["sweep.csv", "sweep.parquet"]:
        assert (plan.parent / "library" / name).read_bytes() == (out / name).read_bytes(), name


@pytest.mark.parametrize("engine", [["serial"], ["joblib", "--jobs", "2"], ["dask", "--jobs", "2"]])
def test_every_engine_gives_the_bits_of_the_library(plan, fmu, tmp_path, engine):
    done = drive(plan, fmu, tmp_path, "--engine", *engine, "--batch", "3")
    assert done.returncode == 1 and "Traceback" not in done.stderr, done.stderr
    assert_same_tables(plan, tmp_path)


def test_a_driver_goes_on_where_the_command_line_stopped(plan, fmu, tmp_path):
    lines = (plan.parent / "library/journal.jsonl").read_text().splitlines(keepends=True)
    (tmp_path / "journal.jsonl").write_text("".join(lines[:10]) + lines[10][:9])
    assert "--resume" in drive(plan, fmu, tmp_path).stderr
    done = drive(plan, fmu, tmp_path, "--resume")
    assert done.returncode == 1, done.stderr
    assert_same_tables(plan, tmp_path)
    journal = (tmp_path / "journal.jsonl").read_text().splitlines(keepends=True)
    assert journal[:10] == lines[:10] and len(journal) == 25


def test_the_loss_of_a_worker_costs_nothing(plan, fmu, tmp_path):
    """Two workers of a scheduler on this machine; one is killed when a third of the points is done."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        address = f"tcp://127.0.0.1:{probe.getsockname()[1]}"
    dask = lambda *words: subprocess.Popen([sys.executable, "-m", "distributed.cli." + words[0], *words[1:]],
                                           stderr=subprocess.DEVNULL, cwd=tmp_path)
    quiet = ["--no-dashboard"]
    processes = [dask("dask_scheduler", "--host", address, *quiet)]
    worker = ["dask_worker", address, "--no-nanny", "--nthreads", "1", "--host", "127.0.0.1", *quiet]
    try:
        processes += [dask(*worker), dask(*worker)]
        command = [sys.executable, DRIVER, plan, "--out", tmp_path / "out", "--fmu", fmu, "--tread", tread(),
                   "--engine", "dask", "--scheduler", address, "--batch", "1"]
        with open(tmp_path / "talk", "w") as talk:
            driver = subprocess.Popen(command, stderr=talk)
            journal, end = tmp_path / "out/journal.jsonl", time.time() + 120
            while not journal.exists() or journal.read_text().count("\n") < 9:
                assert time.time() < end and driver.poll() is None, (tmp_path / "talk").read_text()
                time.sleep(0.01)
            processes[1].send_signal(signal.SIGKILL)
            assert journal.read_text().count("\n") < 25, "the sweep was over before a worker was lost"
            assert driver.wait(timeout=120) == 1, (tmp_path / "talk").read_text()
    finally:
        for process in processes:
            process.kill()
            process.wait()
    assert_same_tables(plan, tmp_path / "out")
    points = [json.loads(line)["point"] for line in journal.read_text().splitlines()[1:]]
    assert sorted(points) == list(range(24)), "no point is lost, none is there twice"


def test_other_programs_read_the_parquet_file(plan):
    table = pyarrow.parquet.read_table(plan.parent / "library/sweep.parquet")
    assert table.num_rows == 24
    frame = table.to_pandas()
    good = frame[frame.status == "ok"]
    assert good.reason.isna().all() and good.frequency_hz.notna().all()
    failed = frame[frame.status == "failed"]
    assert failed.mean_friction_1.isna().all() and failed.reason.str.contains("block.length").all()
    assert table.schema.metadata[b"unit:run.slide.speed"] == b"m/s"

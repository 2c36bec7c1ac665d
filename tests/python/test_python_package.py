"""The Python package against the FMU; skipped where the FMU is not built."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
FMU = ROOT / "out/TreadBlock.fmu"
pytest.importorskip("pandas")
if not FMU.exists():
    pytest.skip("out/TreadBlock.fmu is not built", allow_module_level=True)

sys.path.insert(0, str(ROOT / "python"))
from tread_block import TreadBlock, TreadBlockError  # noqa: E402


def test_a_slide_settles_on_the_load_and_names_its_units():
    run = TreadBlock(fmu=FMU).slide(speed=0.3, pressure=250e3, duration=0.004)
    # Statics: at rest the road carries pressure × length × width = 56.25 N.
    assert run["contact.force.z"].iloc[0] == pytest.approx(56.25, rel=1e-6)
    assert run.attrs["units"]["contact.pressure[1]"] == "Pa"
    assert run.index[-1] == pytest.approx(0.004)
    assert np.isfinite(run.to_numpy()).all()


def test_reversing_the_road_mirrors_the_block():
    # Symmetry: a road that runs the other way makes the run-out edge move as the run-in edge did.
    there = TreadBlock(fmu=FMU).slide(speed=0.2, load=50.0, duration=0.002)
    back = TreadBlock(fmu=FMU).slide(speed=-0.2, load=50.0, duration=0.002)
    difference = there["run_in.displacement.x"] + back["run_out.displacement.x"]
    assert np.abs(difference).max() < 1e-3 * np.abs(there["run_in.displacement.x"]).max()


def test_a_parameter_reaches_the_model():
    soft = TreadBlock({"rubber.young_modulus": 25e6}, fmu=FMU)
    run = soft.slide(speed=0.1, load=10.0, duration=0.001)
    stiff = TreadBlock(fmu=FMU).slide(speed=0.1, load=10.0, duration=0.001)
    assert run["contact.force.x"].iloc[-1] < stiff["contact.force.x"].iloc[-1]


def test_the_shipped_path_can_be_rolled_in_part():
    import pandas as pd

    path = pd.read_csv(ROOT / "examples/rolling-belt.csv").head(250)
    run = TreadBlock(fmu=FMU).roll(path)
    assert run.index[-1] == pytest.approx(path["time_s"].iloc[-1])


def test_wrong_names_and_values_are_told_at_once():
    with pytest.raises(TreadBlockError) as error:
        TreadBlock({"rubber.modulus": 1.0, "drive.normal": "magnet"}, fmu=FMU)
    assert "rubber.modulus" in str(error.value) and "magnet" in str(error.value)
    with pytest.raises(TreadBlockError, match="rubber.poisson_ratio"):
        TreadBlock({"rubber.poisson_ratio": 0.6}, fmu=FMU).slide(speed=0.1, load=10.0)
    with pytest.raises(TreadBlockError, match="exactly one"):
        TreadBlock(fmu=FMU).slide(speed=0.1)


def test_the_types_are_strict():
    # As in the folder python/, whose pyproject.toml says which libraries have no types of their own.
    run = subprocess.run([sys.executable, "-m", "mypy", "tread_block", "--cache-dir", os.devnull],
                         cwd=ROOT / "python", capture_output=True, text=True)
    assert run.returncode == 0, run.stdout + run.stderr


def test_pip_installs_the_package_with_its_types(tmp_path):
    command = [sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--target",
               str(tmp_path), str(ROOT / "python")]
    run = subprocess.run(command, capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    assert (tmp_path / "tread_block/py.typed").exists()

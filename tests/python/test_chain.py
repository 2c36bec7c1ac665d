"""The chain of examples/chain: three masters agree, the stages give closed forms, the patch adds up."""

import sys
from pathlib import Path

import fmpy
import fmpy.ssp
import lxml.etree as etree
import numpy as np
import pytest
from fmpy.validation import validate_fmu
from scipy.signal import butter, sosfilt

from conftest import ROOT

sys.path.append(str(ROOT / "examples/chain"))
import masters  # noqa: E402
import patch  # noqa: E402

FOLDER = ROOT / "out/chain"
# Until the second slip of the block.
DURATION, STEP = 8e-3, 1e-5
AIR, BELT = 1.2, 15.0  # defaults: kg/m³, kg/m²


@pytest.fixture(scope="module")
def plain():
    return masters.plain_loop(FOLDER, STEP, DURATION, derivatives=False)


def test_the_stages_are_flawless_fmus():
    for name in ("BeltSource", "AcousticStage", "TreadBlock"):
        assert validate_fmu(str(FOLDER / f"{name}.fmu")) == [], name


def test_the_system_structure_obeys_the_schema_of_ssp_1():
    schema = Path(fmpy.ssp.__file__).parent / "schema" / "SystemStructureDescription.xsd"
    ssd = etree.parse(str(ROOT / "examples/chain/SystemStructure.ssd"))
    etree.XMLSchema(etree.parse(str(schema))).assertValid(ssd)


def test_three_masters_agree(plain, tmp_path):
    for name in ("BeltSource.fmu", "TreadBlock.fmu", "AcousticStage.fmu"):
        (tmp_path / name).write_bytes((FOLDER / name).read_bytes())
    boxed = masters.container(tmp_path, STEP, DURATION)
    ssp = masters.fmpy_ssp(FOLDER, STEP, DURATION)
    assert len(plain) == len(boxed) == len(ssp) == 800
    for name in ("force.x", "force.z", "run_out.velocity.x", "pressure"):
        size = np.abs(plain[name]).max()
        assert size > 0
        assert np.abs(boxed[name] - plain[name]).max() <= 1e-12 * size, name
        # fmpy's SSP adds up its steps: they differ from ours in the last digits.
        assert np.abs(ssp[name] - plain[name]).max() <= 1e-5 * size, name


def test_input_derivatives_pay(plain):
    fine = {"solver.max_step": 2.5e-6}
    exact = masters.plain_loop(FOLDER, 5e-6, DURATION, **fine)["force.x"][3::4]
    with_, without = (masters.plain_loop(FOLDER, 2e-5, DURATION, derivatives=d, **fine)["force.x"]
                      for d in (True, False))
    errors = [np.linalg.norm(x - exact) / np.linalg.norm(exact) for x in (with_, without)]
    assert errors[0] < 0.1 * errors[1] and errors[1] < 1e-3, errors


def test_the_source_follows_the_path_of_the_command_line_and_knows_its_derivatives():
    path = np.genfromtxt(ROOT / "examples/rolling-belt.csv", delimiter=",", skip_header=1)
    source = masters.Member(FOLDER / "BeltSource.fmu")
    source.initialize()
    h, poses, rates = 1e-5, [source.get(masters.POSE)], [source.rates(masters.POSE, 1)]
    for k in range(1000):
        source.slave.doStep(k * h, h)
        poses.append(source.get(masters.POSE))
        rates.append(source.rates(masters.POSE, 1))
    source.close()
    # The file has been written with ten decimals or more.
    assert np.abs(np.array(poses) - path[:1001, 1:]).max() < 1e-9
    central = (np.array(poses)[2:] - np.array(poses)[:-2]) / (2 * h)
    assert np.abs(central - np.array(rates)[1:-1]).max() < 1e-3 * np.abs(rates).max()


def hear(signals, h=1e-5):
    """Samples of the acoustic stage for inputs at communication points; its final levels."""
    stage = masters.Member(FOLDER / "AcousticStage.fmu", **{"sampling.frequency": 1 / h})
    stage.set(masters.HEARD, signals[0])
    stage.initialize()
    pressure = []
    for k, row in enumerate(signals):
        stage.set(masters.HEARD, row)
        stage.slave.doStep(k * h, h)
        pressure += stage.get(["pressure"])
    levels = stage.get(masters.THIRD_OCTAVES)
    stage.close()
    return np.array(pressure), np.array(levels)


def test_a_force_radiates_as_a_point_excited_plate():
    """p = rho F / (2 pi r m'') well above the cut-on frequency: Cremer, Heckl, Petersson."""
    t = np.arange(40000) * 1e-5
    signals = np.zeros((len(t), 3))
    signals[:, 0] = np.sin(2 * np.pi * 2000 * t)
    pressure, levels = hear(signals)
    amplitude = np.sqrt(2) * pressure[20000:].std()
    # The foundation adds (f0/f)^2 = 0.25 %, the bilinear transform nothing at this frequency.
    assert amplitude == pytest.approx(AIR / (2 * np.pi * BELT), rel=4e-3)
    expected = 20 * np.log10(amplitude / np.sqrt(2) / 20e-6)
    assert levels[13] == pytest.approx(expected, abs=0.1), "the band around 1995 Hz holds the tone"


def test_faces_that_are_pushed_apart_radiate_as_a_source_in_a_baffle():
    """p = rho/(2 pi r) dQ/dt with Q = A/2 (v_out - v_in): Rayleigh."""
    t = np.arange(1000) * 1e-5
    signals = np.column_stack([0 * t, -50 * t, 150 * t])
    pressure, _ = hear(signals)
    assert pressure[500] == pytest.approx(AIR / (2 * np.pi) * 0.5 * 1.5e-4 * 200, rel=1e-9)


def test_third_octaves_are_those_of_an_independent_filter_design():
    h = 1e-5
    signals = np.zeros((20000, 3))
    signals[:, 2] = np.cumsum(np.random.default_rng(3).normal(size=20000)) * 1e-3
    pressure, levels = hear(signals, h)
    for i in (0, 7, 13, 20):
        middle = 1000 * 10 ** (0.1 * (i - 10))
        edges = np.array([10 ** -0.05, 10 ** 0.05]) * middle
        passed = sosfilt(butter(3, edges, "bandpass", fs=1 / h, output="sos"), pressure)
        expected = 10 * np.log10(np.mean(passed ** 2) / 20e-6 ** 2)
        assert levels[i] == pytest.approx(expected, abs=1e-6), middle


def test_blocks_of_a_patch_do_not_disturb_each_other():
    _, sums, each, *_ = patch.run(FOLDER, blocks=2, **{"solver.elements_along": 6,
                                                      "solver.elements_up": 4})
    _, alone, _, *_ = patch.run(FOLDER, blocks=1, **{"solver.elements_along": 6,
                                                    "solver.elements_up": 4})
    np.testing.assert_array_equal(each[: len(alone), 0], alone[:, 1])
    np.testing.assert_allclose(sums[:, 1], each.sum(axis=1), atol=1e-12)
    assert np.abs(each[:, 1]).max() > 50

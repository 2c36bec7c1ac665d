"""Importers that share no code with fmpy drive the same trajectory to the same numbers."""

import json
import os
import subprocess
import sys
from pathlib import Path

import fmpy
import numpy as np
import pytest

from conftest import COARSE, DYADIC, LOAD, ROOT, assert_same, belt_x, grid, library

N, H = 400, 1e-5


def test_fmuloader(fmu, vr, outputs, description):
    fmi2 = pytest.importorskip("fmuloader.fmi2")
    points = grid(N, H)
    slave = fmi2.Fmi2Slave(str(fmu), model_identifier="TreadBlock")
    slave.instantiate("block", fmi2.Fmi2Type.CO_SIMULATION, guid=description.guid)
    slave.set_integer([vr[name] for name in COARSE], list(COARSE.values()))
    slave.set_real([vr["normal_load"]], [LOAD])
    slave.setup_experiment(start_time=0.0, stop_time=points[-1])
    slave.enter_initialization_mode()
    slave.exit_initialization_mode()
    rows = []
    for t, following in zip(points, points[1:]):
        slave.set_real([vr["belt.x"]], [belt_x(t)])
        slave.do_step(t, following - t)
        rows.append(list(slave.get_real([vr[name] for name in outputs])))
    state = slave.get_fmu_state()
    assert len(slave.serialize_fmu_state(state)) > 1000
    slave.free_fmu_state(state)
    slave.terminate()
    slave.free_instance()
    assert_same(rows, library(points))


def test_libcosimpy(fmu, vr, outputs, slave, capfd):
    pytest.importorskip("libcosimpy")
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimManipulator import CosimManipulator
    from libcosimpy.CosimObserver import CosimObserver
    from libcosimpy.CosimSlave import CosimLocalSlave

    step = round(H * 1e9)
    execution = CosimExecution.from_step_size(step)
    block = execution.add_local_slave(CosimLocalSlave(fmu_path=str(fmu), instance_name="block"))
    for name, value in COARSE.items():
        execution.integer_initial_value(block, vr[name], value)
    execution.real_initial_value(block, vr["normal_load"], LOAD)
    manipulator, observer = CosimManipulator.create_override(), CosimObserver.create_last_value()
    execution.add_manipulator(manipulator)
    execution.add_observer(observer)
    references = [vr[name] for name in outputs]
    # libcosim counts nanoseconds: times are quotients, and steps are differences of times, unlike in their last bits.
    points, rows = [k * step / 1e9 for k in range(N + 1)], []
    for t in points[:-1]:
        manipulator.slave_real_values(block, [vr["belt.x"]], [belt_x(t)])
        execution.step()
        rows.append(observer.last_real_values(block, references))
    told = capfd.readouterr()
    complaints = [line for line in (told.out + told.err).splitlines()
                  if ("[error]" in line or "[warning]" in line)
                  # libcosim leaves enumerations out and says so: its limit, not our fault.
                  and "Enumeration variable type not supported" not in line]
    assert complaints == [], "the FMI Library's parser has nothing to say"
    # fmpy stands in for it here, with the same times and the same steps. That fmpy equals the library is tested
    # with steps of both kinds. With constant steps the last bits of the step decide here and there whether Newton's
    # method goes on, which shows at 3e-8.
    stand_in, expected = slave().initialize(), []
    for t, end in zip(points, points[1:]):
        stand_in.set("belt.x", belt_x(t))
        stand_in.fmu.doStep(t, end - t)
        expected.append(stand_in.outputs())
    assert_same(rows, np.array(expected))


def test_fmucontainer(fmu, tmp_path, outputs):
    """The block inside a container FMU, driven by the container's own C master."""
    (tmp_path / "TreadBlock.fmu").write_bytes(Path(fmu).read_bytes())
    (tmp_path / "chain.json").write_text(json.dumps({
        "name": "chain.fmu", "auto_link": True, "auto_input": True, "auto_output": True,
        "auto_parameter": True, "step_size": DYADIC, "fmu": ["TreadBlock.fmu"]}))
    tool = Path(sys.executable).parent / "fmucontainer"
    done = subprocess.run([tool, "-container", "chain.json", "-fmu-directory", "."], cwd=tmp_path,
                          capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stdout + done.stderr
    names = {v.name for v in fmpy.read_model_description(str(tmp_path / "chain.fmu"), validate=False)
             .modelVariables}
    start = {f"treadblock.{name}": value for name, value in COARSE.items()}
    start["normal_load"] = LOAD
    assert start.keys() <= names
    points = grid(N, DYADIC)
    samples = np.array([(t, belt_x(t)) for t in points], dtype=[("time", float), ("belt.x", float)])
    result = fmpy.simulate_fmu(str(tmp_path / "chain.fmu"), stop_time=points[-1], step_size=DYADIC,
                               output_interval=DYADIC, start_values=start, input=samples, validate=False,
                               output=["force.x", "run_in.displacement.x"])
    expected = library(points)
    columns = [outputs.index("force.x"), outputs.index("run_in.displacement.x")]
    rows = np.array([[row["force.x"], row["run_in.displacement.x"]] for row in result])[1:]
    assert len(rows) == N
    assert_same(rows, expected[:, columns])


def test_cofmupy(fmu, outputs):
    """Its master sets inputs, then resets, so the block starts without load: it is laid on smoothly."""
    python = ROOT / ".venv/cofmupy/bin/python"
    if not python.exists():
        pytest.skip("cofmupy could not be installed (packaging/setup.sh test)")
    points = grid(N, DYADIC)
    load = [LOAD * min(1.0, k / 64) for k in range(N + 1)]
    plan = "".join(f"{belt_x(t)!r} {newtons!r}\n" for t, newtons in zip(points[:-1], load))
    done = subprocess.run([python, ROOT / "tests/masters/cofmupy_run.py", fmu, repr(DYADIC), *outputs],
                          input=plan, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    # cofmupy cannot set fixed parameters: the mesh is the default one.
    expected = library(points, load, **{name: 0 for name in COARSE})
    assert_same(json.loads(done.stdout), expected)


@pytest.mark.parametrize("master", ["fmi", "fmu-runner"])
def test_masters_in_rust(master, fmu, vr, outputs):
    folder = ROOT / os.environ.get("TREAD_RUST_MASTERS", "target/masters/debug")
    program = folder / ("with_" + master.replace("-", "_"))
    if not program.exists():
        pytest.fail("build it first: packaging/test.sh python does")
    points = grid(N, H)
    plan = [f"output {name} {vr[name]}" for name in outputs]
    plan += [f"integer {name} {vr[name]} {value}" for name, value in COARSE.items()]
    plan += [f"real normal_load {vr['normal_load']} {LOAD}", f"belt belt.x {vr['belt.x']}"]
    plan += [f"at {t!r} {belt_x(t)!r}" for t in points]
    done = subprocess.run([program, fmu], input="\n".join(plan), capture_output=True,
                          text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    rows = [[float(cell) for cell in line.split(",")] for line in done.stdout.splitlines()]
    assert_same(rows, library(points))

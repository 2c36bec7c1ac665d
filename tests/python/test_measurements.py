"""Files that asammdf, npTDMS and pyuff write, through the helper and `tread gap import`, to a campaign
that the diagnosis takes without a complaint and whose numbers are those of the labelled campaign."""

import json
import os
import subprocess
import sys
import zipfile
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
TREAD = ROOT / os.environ.get("TREAD", "target/debug/tread")
CAMPAIGN = ROOT / "tests/data/campaigns/open/open-05.zip"
START = 0.0125  # s of the logger's clock
BEFORE = 100  # rows before the road starts
CHANNELS = {  # column, unit, worth in SI
    "friction_force_n": ("Fx", "kN", 1e3), "normal_force_n": ("Fz", "N", 1.0),
    "edge_velocity_m_s": ("vib", "mm/s", 1e-3), "edge_displacement_m": ("edge", "um", 1e-6),
    "carriage_z_m": ("lift", "mm", 1e-3)}

sys.path.insert(0, str(ROOT / "python"))
from tread_block import measurements  # noqa: E402


def unpack(text):
    """Columns of a packed run: name, decimals, v (values) or c (changes), whole numbers."""
    columns = {}
    for line in text.splitlines():
        name, decimals, kind, *numbers = line.split(" ")
        values = np.array(numbers, dtype=np.int64)
        columns[name] = (np.cumsum(values) if kind == "c" else values) / 10.0 ** int(decimals)
    return columns


@pytest.fixture(scope="module")
def runs():
    """Name of a run to its columns."""
    with zipfile.ZipFile(CAMPAIGN) as file:
        return {Path(name).stem: unpack(file.read(name).decode())
                for name in file.namelist() if name.endswith(".columns")}


def logged(columns):
    """Signals as a logger has them: rows before the start, its own clock and units."""
    count = len(columns["time_s"])
    time = START + (np.arange(count + BEFORE) - BEFORE) / 25e3
    signals = {}
    for channel, (name, unit, worth) in CHANNELS.items():
        values = columns.get(channel, np.zeros(count)) / worth
        signals[name] = (unit, np.concatenate([np.full(BEFORE, values[0]), values]))
    return time, signals


def write_mdf(path, time, signals):
    from asammdf import MDF, Signal
    mdf = MDF(version="4.10")
    mdf.append([Signal(v, time, name=n, unit=u) for n, (u, v) in signals.items()])
    # A second rate, and a text: neither may disturb.
    mdf.append([Signal(time[::50], time[::50], name="slow", unit="s")])
    mdf.append([Signal(np.array([b"on", b"off"]), time[:2], name="state", encoding="utf-8")])
    mdf.save(path, overwrite=True)
    mdf.close()


def write_tdms(path, time, signals):
    from nptdms import ChannelObject, TdmsWriter
    base = {"wf_increment": 1 / 25e3, "wf_start_offset": float(time[0])}
    with TdmsWriter(path) as writer:
        writer.write_segment([ChannelObject("rig", n, v, {**base, "unit_string": u})
                              for n, (u, v) in signals.items()])


def write_uff(path, time, signals):
    import pyuff
    file = pyuff.UFF(str(path))
    for node, (name, (unit, values)) in enumerate(signals.items(), start=1):
        # binary keeps doubles; text would keep five digits
        file.write_sets(pyuff.prepare_58(
            binary=1, func_type=1, rsp_node=node, rsp_dir=1, ref_dir=1, ref_node=1, data=values, x=time,
            id1=name, rsp_ent_name="NONE", ref_ent_name="NONE", abscissa_spacing=1, abscissa_inc=1 / 25e3,
            abscissa_min=time[0], ordinate_axis_units_lab=unit, abscissa_axis_units_lab="s",
            orddenom_spec_data_type=0, ord_data_type=4), "add")


def plan(runs, time_column, folder):
    """The labelled campaign's own file with where everything comes from."""
    with zipfile.ZipFile(CAMPAIGN) as file:
        text = file.read("campaign.toml").decode()
    text = text.replace("tread-block-campaign/1", "tread-block-import/1")
    text = text.replace("[channels]", f'[channels]\ntime = {{ column = "{time_column}" }}')
    for channel, (name, _, _) in CHANNELS.items():
        text = text.replace(f"{channel} = {{", f'{channel} = {{ column = "{name}",')
    for run in runs:
        text = text.replace(f'file = "runs/{run}.csv"',
                            f'file = "runs/{run}.csv"\nfrom = "raw/{run}.csv"\nstart = "{1e3 * START} ms"')
    (folder / "plan.toml").write_text(text)


@pytest.mark.parametrize("ending, write, time_column", [
    (".mf4", write_mdf, "time 1"), (".tdms", write_tdms, "time"), (".uff", write_uff, "time")])
def test_a_file_of_each_library_becomes_a_campaign(runs, tmp_path, ending, write, time_column):
    files = []
    for name, columns in runs.items():
        files.append(tmp_path / f"{name}{ending}")
        write(files[-1], *logged(columns))
    assert measurements.main([*map(str, files), "--out", str(tmp_path / "raw")]) == 0
    plan(runs, time_column, tmp_path)
    done = subprocess.run([TREAD, "gap", "import", tmp_path / "plan.toml", "--out", tmp_path / "campaign",
                           "--json"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    told = json.loads(done.stdout)["runs"]
    assert all(c["copied"] and abs(c["shift"] - START) < 1e-12 for r in told for c in r["channels"])
    for name, columns in runs.items():
        got = np.genfromtxt(tmp_path / f"campaign/runs/{name}.csv", delimiter=",", names=True)
        for channel in got.dtype.names[1:]:
            # 12 decimals are written; the rest is the rounding of the units
            np.testing.assert_allclose(got[channel], columns[channel], rtol=1e-14, atol=6e-13)
    check = subprocess.run([TREAD, "check", tmp_path / "campaign"], capture_output=True, text=True)
    assert check.returncode == 0 and "a good campaign" in check.stdout, check.stdout + check.stderr


def test_what_is_left_out_is_told(runs, tmp_path, capsys):
    write_mdf(tmp_path / "a.mf4", *logged(runs["03-v300"]))
    assert measurements.main([str(tmp_path / "a.mf4"), "--out", str(tmp_path)]) == 0
    assert "state: no plain numbers" in capsys.readouterr().err
    header = (tmp_path / "a.csv").read_text().splitlines()[0]
    assert header == "time 1 [s],Fx [kN],Fz [N],vib [mm/s],edge [um],lift [mm],time 2 [s],slow [s]"


def test_wrong_files_are_told_and_do_not_stop_the_others(runs, tmp_path, capsys):
    (tmp_path / "broken.tdms").write_bytes(b"TDSm nothing")
    (tmp_path / "notes.txt").write_text("x")
    write_tdms(tmp_path / "good.tdms", *logged(runs["03-v300"]))
    names = ["broken.tdms", "notes.txt", "missing.uff", "good.tdms"]
    assert measurements.main([*(str(tmp_path / n) for n in names), "--out", str(tmp_path / "raw")]) == 2
    told = capsys.readouterr().err
    assert all(name in told for name in names[:3]) and (tmp_path / "raw/good.csv").exists()

"""A host in C, plain and under valgrind: no leak, no invalid access, the same bits every time."""

import re
import shutil
import subprocess
from pathlib import Path

import pytest

SOURCE = Path(__file__).parents[1] / "c" / "host.c"
VARIABLES = ["belt.x", "normal_load", "solver.elements_along", "solver.elements_up", "force.x"]


@pytest.fixture(scope="session")
def host(tmp_path_factory):
    program = tmp_path_factory.mktemp("host") / "host"
    subprocess.run(["cc", "-O1", "-g", "-Wall", "-Wextra", "-Werror", "-o", program, SOURCE, "-ldl"],
                   check=True)
    return program


@pytest.fixture
def command(host, unpacked, description, vr):
    library = Path(unpacked) / "binaries" / "linux64" / "TreadBlock.so"
    return lambda cycles: [host, library, description.guid, str(cycles),
                           *(str(vr[name]) for name in VARIABLES)]


def test_a_thousand_cycles_give_the_same_bits_and_keep_the_memory(command):
    done = subprocess.run(command(1000), capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    forces = [float(line) for line in done.stdout.split()]
    assert len(forces) == 40 and forces[-1] != 0.0


@pytest.mark.skipif(not shutil.which("valgrind"), reason="valgrind is missing")
def test_valgrind_finds_no_leak_and_no_error(command):
    checked = ["valgrind", "--error-exitcode=99", "--leak-check=full", "--show-leak-kinds=definite,indirect",
               "--errors-for-leak-kinds=definite,indirect"]
    lost = {}
    for cycles in (1, 6):
        done = subprocess.run([*checked, *command(cycles)], capture_output=True, text=True, timeout=600)
        assert done.returncode == 0, done.stderr[-3000:]
        in_use = re.search(r"in use at exit: ([\d,]+) bytes", done.stderr)
        lost[cycles] = in_use.group(1)
    assert lost[1] == lost[6], f"memory in use at exit grows with the cycles: {lost}"

"""A host in C, plain and under valgrind: no leak, no invalid access, the same bits every time."""

import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

SOURCE = Path(__file__).parents[1] / "c" / "host.c"
THREADS = SOURCE.with_name("threads.c")
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
    # `make leak-check` asks for 1000.
    many = int(os.environ.get("TREAD_LEAK_CYCLES", 6))
    for cycles in (1, many):
        done = subprocess.run([*checked, *command(cycles)], capture_output=True, text=True, timeout=7200)
        assert done.returncode == 0, done.stderr[-3000:]
        in_use = re.search(r"in use at exit: ([\d,]+) bytes", done.stderr)
        lost[cycles] = in_use.group(1)
    assert lost[1] == lost[many], f"memory in use at exit grows with the cycles: {lost}"


def test_the_host_finds_itself_as_it_was_on_every_odd_path(command, tmp_path):
    """Small stacks, threads that hand an instance on, another rounding mode, unloading and loading again."""
    program = tmp_path / "manners"
    subprocess.run(["cc", "-O1", "-g", "-Wall", "-Wextra", "-Werror", "-o", program,
                    SOURCE.with_name("manners.c"), "-ldl", "-lpthread", "-lm"], check=True)
    _, library, guid, _, *references = command(0)
    done = subprocess.run([program, library, guid, *references], capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    assert done.stderr == "", "nothing but the host itself may print"


@pytest.fixture(scope="session")
def two_threads(tmp_path_factory):
    program = tmp_path_factory.mktemp("threads") / "threads"
    subprocess.run(["cc", "-O1", "-g", "-Wall", "-Wextra", "-Werror", "-o", program, THREADS, "-ldl",
                    "-lpthread"], check=True)
    return program


@pytest.fixture
def threads_command(two_threads, command):
    _, library, guid, _, *references = command(0)
    return [two_threads, library, guid, *references]


def test_two_threads_on_two_instances_get_the_same_bits(threads_command):
    done = subprocess.run(threads_command, capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr


@pytest.mark.skipif(not shutil.which("valgrind"), reason="valgrind is missing")
def test_helgrind_finds_no_memory_that_two_instances_share(threads_command):
    """Races on the heap or a stack would be two instances in each other's way.

    helgrind knows locks but not atomics, which Rust compiles in place: it reports the cells in which the
    library's static memory remembers, once for all, what the processor can do. They are no race, and
    there is no other static data: their number is kept small.
    """
    done = subprocess.run(["valgrind", "--tool=helgrind", *threads_command], capture_output=True,
                          text=True, timeout=600)
    assert done.returncode == 0, done.stderr[-3000:]
    assert "ERROR SUMMARY" in done.stderr
    conflicts = set(re.findall(r"Address (0x[0-9a-f]+) is (.*)", done.stderr, re.IGNORECASE))
    shared = [where for _, where in conflicts if "segment" not in where]
    assert shared == [], "memory of one instance is touched by the other's thread"
    assert len(conflicts) <= 8, conflicts

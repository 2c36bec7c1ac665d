"""Counts of floating-point operations and slopes: arithmetic of the benches.

Operations are counted, not estimated: callgrind tells how often each instruction ran, the disassembly how
many operations it does. Two runs of different length are subtracted, so that building the block cancels.
valgrind knows no AVX-512, so this counts the AVX2 path; its operations are those of the wider one.
"""

from __future__ import annotations

import math
import re
import subprocess
from collections import defaultdict
from pathlib import Path

# Doubles per vector register, and operations per double by the mnemonic's stem.
WIDTH = {"x": 2, "y": 4, "z": 8}
STEMS = [("fmadd", 2), ("fmsub", 2), ("fnmadd", 2), ("fnmsub", 2), ("add", 1), ("sub", 1), ("mul", 1),
         ("div", 1), ("sqrt", 1), ("max", 1), ("min", 1)]


def slope(xs, ys) -> float:
    """Least-squares slope of log y over log x."""
    lx, ly = [math.log(x) for x in xs], [math.log(y) for y in ys]
    mx, my = sum(lx) / len(lx), sum(ly) / len(ly)
    return sum((a - mx) * (b - my) for a, b in zip(lx, ly)) / sum((a - mx) ** 2 for a in lx)


def operations(mnemonic: str, operands: str) -> tuple[int, bool]:
    """Floating-point operations of an instruction on doubles, and whether it is a vector's."""
    match = re.fullmatch(r"v?(\w+?)(?:132|213|231)?(sd|pd)", mnemonic)
    if not match:
        return 0, False
    stem, kind = match.groups()
    count = next((n for name, n in STEMS if stem == name), 0)
    if kind == "sd" or not count:
        return count, False
    register = re.search(r"%([xyz])mm", operands)
    return count * WIDTH[register.group(1) if register else "x"], True


def accessed(operands: str, mnemonic: str) -> int:
    """Bytes that a vector or scalar floating-point instruction loads or stores."""
    if "(" not in operands or not re.fullmatch(r"v?\w+(sd|pd|s[ds]x)|v?movdq[au]", mnemonic):
        return 0
    if mnemonic.endswith("sd") or "broadcast" in mnemonic:
        return 8
    register = re.search(r"%([xyz])mm", operands)
    return 8 * WIDTH[register.group(1) if register else "x"]


def disassembly(program: Path) -> dict[int, tuple[str, str]]:
    listing = subprocess.run(["objdump", "-d", "--no-show-raw-insn", program], capture_output=True, text=True,
                             check=True).stdout
    lines = re.finditer(r"^ +([0-9a-f]+):\t([a-z0-9]+) *([^\n]*)$", listing, re.M)
    return {int(m[1], 16): (m[2], m[3]) for m in lines}


def executed(program: Path, duration: float, folder: Path) -> tuple[dict[int, int], int]:
    """How often each instruction of the program ran, by its address in the file; all of them together."""
    out = folder / "callgrind.out"
    subprocess.run(["valgrind", "--tool=callgrind", "--dump-instr=yes", "--compress-strings=no",
                    "--compress-pos=no", f"--callgrind-out-file={out}", program, "run", "15",
                    f"duration={duration}"], capture_output=True, check=True)
    counts: dict[int, int] = defaultdict(int)
    total, inside, skip = 0, False, False
    first_of_main = None
    in_main = False
    for line in out.read_text().splitlines():
        if line.startswith("ob="):
            inside = line[3:].strip() == str(program)
        elif line.startswith("fn="):
            in_main = inside and line[3:] == "main"
        elif line.startswith("calls="):
            skip = True
        elif line.startswith("0x"):
            if skip:
                skip = False
                continue
            address, _, cost = line.split()[:3]
            total += int(cost)
            if inside:
                counts[int(address, 16)] += int(cost)
                if in_main:
                    here = int(address, 16)
                    first_of_main = here if first_of_main is None else min(first_of_main, here)
    symbols = subprocess.run(["nm", program], capture_output=True, text=True, check=True).stdout
    main = int(re.search(r"^([0-9a-f]+) T main$", symbols, re.M)[1], 16)
    shift = first_of_main - main
    return {address - shift: n for address, n in counts.items()}, total


def flops(program: Path, folder: Path) -> dict:
    """Operations, instructions and bytes per simulated millisecond of the block of 15 mm."""
    code = disassembly(program)
    short, short_total = executed(program, 0.002, folder)
    long, long_total = executed(program, 0.006, folder)
    found = {"flops": 0.0, "vector": 0.0, "bytes": 0.0}
    for address, n in long.items():
        mnemonic, operands = code.get(address, ("", ""))
        times = (n - short.get(address, 0)) / 4.0
        count, vector = operations(mnemonic, operands)
        found["flops"] += times * count
        found["vector"] += times * count * vector
        found["bytes"] += times * accessed(operands, mnemonic)
    return {**found, "instructions": (long_total - short_total) / 4.0,
            "vector_share": found["vector"] / found["flops"]}

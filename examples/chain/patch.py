"""A contact patch of 20 blocks: 20 sources and 20 blocks, staggered along the belt, in one process.

Their forces and faces add up; one acoustic stage hears the sum. Lengths of the blocks vary by 10 % as
in a tyre's pitch sequence, or all blocks would do the same and the sum would be a comb of tones.
"""

import sys

import fmpy
import numpy as np

from masters import HEARD, LINES, POSE, THIRD_OCTAVES, Member

PITCHES = [0.018, 0.020, 0.022]  # [m] along the belt; three quarters of a pitch are rubber
# 20 pitches in an order without a period.
SEQUENCE = [1, 0, 2, 2, 1, 0, 1, 2, 0, 0, 2, 1, 1, 2, 0, 1, 0, 2, 1, 0]
SPEED = 10.0  # [m/s]
PASSAGE = 0.022  # [s] of one block
ADDED = ["force.x", *HEARD]


class Pair:
    """A block and the belt that carries it, from `start` [s] on."""

    def __init__(self, folder, unzipped, number, start, length, coarse):
        self.start, self.end, self.running = start, start + PASSAGE, False
        self.source = Member(folder / "BeltSource.fmu", f"source {number}", unzipped[0], start,
                             delay=start)
        self.block = Member(folder / "TreadBlock.fmu", f"block {number}", unzipped[1], start,
                            **{"block.length": length}, **coarse)

    def step(self, time, step):
        if not self.running:
            self.source.initialize()
            self.block.set(POSE, self.source.get(POSE))
            self.block.initialize()
            self.running = True
        self.block.set(POSE, self.source.get(POSE))
        for order in (1, 2):
            self.block.set_rates(POSE, order, self.source.rates(POSE, order))
        self.source.slave.doStep(time, step)
        self.block.slave.doStep(time, step)
        return self.block.get(ADDED)


def run(folder, step=1e-5, blocks=len(SEQUENCE), **coarse):
    """Times [s], sums of `ADDED` over time, each block's normal force, sound pressure [Pa], levels, lines."""
    pitches = [PITCHES[kind] for kind in SEQUENCE[:blocks]]
    starts = [round(sum(pitches[:i]) / SPEED / step) * step for i in range(blocks)]
    unzipped = [fmpy.extract(str(folder / f"{name}.fmu")) for name in ("BeltSource", "TreadBlock")]
    pairs = [Pair(folder, unzipped, i, start, 0.75 * pitch, coarse)
             for i, (start, pitch) in enumerate(zip(starts, pitches))]
    sound = Member(folder / "AcousticStage.fmu")
    sound.initialize()
    count = round((starts[-1] + PASSAGE) / step)
    sums, each = np.zeros((count, len(ADDED))), np.zeros((count, blocks))
    pressure = np.zeros(count)
    for k in range(count):
        time = k * step
        if k:
            sound.set(HEARD, sums[k - 1, 1:])
        for i, pair in enumerate(pairs):
            if pair.start - 0.5 * step < time < pair.end - 0.5 * step:
                values = pair.step(time, step)
                sums[k] += values
                each[k, i] = values[1]
        sound.slave.doStep(time, step)
        pressure[k] = sound.get(["pressure"])[0]
        progress(k, count)
    levels, lines = sound.get(THIRD_OCTAVES), sound.get(LINES)
    for member in [sound, *(m for pair in pairs for m in (pair.source, pair.block))]:
        member.close()
    return (np.arange(1, count + 1) * step, sums, each, pressure, np.array(levels), np.array(lines))


def progress(k, count):
    if sys.stderr.isatty() and k % 100 == 0 or k + 1 == count:
        print(f"\r{'patch of blocks':16s}{100 * (k + 1) // count:4d} %", end="", file=sys.stderr)
    if k + 1 == count:
        print(file=sys.stderr)

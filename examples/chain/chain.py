"""Belt path source, tread block, acoustic stage: three FMUs, three masters, pictures and sound.

    python examples/chain/chain.py --fmus out/chain --out out/chain       (`make chain` does all of it)

1. The same passage in fmpy's SSP, in a container of fmucontainer and in a plain loop: they agree.
2. The error against the communication step, with and without input derivatives.
3. Third-octave levels, spectrum and a WAV file of the passage.
4. A contact patch of 20 blocks: sum of forces, its spectrum, its sound.
"""

import argparse
import math
import shutil
import sys
from pathlib import Path

import numpy as np
from scipy.signal import periodogram

import masters
import patch
import plots
import sound
import system

DURATION = 0.022  # [s] of one passage
STEP = 1e-5  # [s]
STEPS = np.array([1e-5, 2e-5, 4e-5, 8e-5])
REFERENCE = 5e-6  # [s]
# The block halves a communication step until its parts are this short: all runs share the error of
# the same internal step, which is small here, and what differs is the coupling.
INTERNAL_STEP = 1.25e-6  # [s]
RING_OUT = 0.06  # [s] after the block has left, until the belt is silent
TURN = 2 * math.pi * 0.3 / 10.0  # [s] for one turn of the tyre at 10 m/s


def say(text):
    print(text, file=sys.stderr, flush=True)


def compare(runs):
    """Largest difference of each master's force to the plain loop's without derivatives."""
    expected = runs["plain loop"]
    size = np.abs(expected["force.x"]).max()
    return {name: np.abs(run["force.x"] - expected["force.x"]).max() / size
            for name, run in runs.items()}


def error(run, exact):
    """Rms error of the force over its rms, and largest error of a third-octave level [dB]."""
    stride = round(run["time"][0] / exact["time"][0])
    there = exact[stride - 1::stride][: len(run)]
    force = np.linalg.norm(run["force.x"] - there["force.x"]) / np.linalg.norm(there["force.x"])
    bands = [abs(run[name][-1] - exact[name][-1]) for name in masters.THIRD_OCTAVES]
    return force, max(bands)


def refine(folder):
    """Errors of each master for each communication step."""
    fine = folder / "fine"
    fine.mkdir(exist_ok=True)
    for name in ("BeltSource.fmu", "AcousticStage.fmu"):
        shutil.copy(folder / name, fine)
    system.assemble(folder / "TreadBlock.fmu", fine, **{"solver.max_step": INTERNAL_STEP})
    folder = fine
    exact = masters.plain_loop(folder, REFERENCE, DURATION)
    ways = {
        "plain loop with input derivatives": masters.plain_loop,
        "plain loop": lambda *a: masters.plain_loop(*a, derivatives=False),
        "fmpy SSP": masters.fmpy_ssp,
        "fmucontainer": masters.container,
    }
    curves = {}
    for name, way in ways.items():
        say(f"communication steps in: {name}")
        curves[name] = np.array([error(way(folder, step, DURATION), exact) for step in STEPS]).T
    return curves


def passage(folder, out):
    heard = {}

    def ring_out(stage):
        for k in range(round(RING_OUT / STEP)):
            stage.slave.doStep(DURATION + k * STEP, STEP)
        heard.update(lines=np.array(stage.get(masters.LINES)),
                     levels=np.array(stage.get(masters.THIRD_OCTAVES)),
                     level=stage.get(["level"])[0])

    runs = {"plain loop with input derivatives": masters.plain_loop(
        folder, STEP, DURATION, at_end=ring_out)}
    say("the same passage in each master")
    runs["plain loop"] = masters.plain_loop(folder, STEP, DURATION, derivatives=False)
    runs["fmpy SSP"] = masters.fmpy_ssp(folder, STEP, DURATION)
    runs["fmucontainer"] = masters.container(folder, STEP, DURATION)
    result = runs["plain loop with input derivatives"]
    np.savetxt(out / "chain.csv", result, delimiter=",", header=",".join(masters.COLUMNS),
               comments="", fmt="%.10g")
    sound.write(out / "chain.wav", sound.samples(result["time"], result["pressure"]), TURN)
    plots.passage(result, out)
    title = f"one block, mean over {1e3 * (DURATION + RING_OUT):.0f} ms, 1 m"
    plots.spectra(heard["levels"], heard["lines"], title, out, "chain-spectrum")
    return runs, heard


def twenty(folder, out):
    time, sums, each, pressure, levels, lines = patch.run(folder)
    np.savetxt(out / "patch.csv", np.column_stack([time, sums, pressure]), delimiter=",", comments="",
               header=",".join(["time", *patch.ADDED, "pressure"]), fmt="%.10g")
    period = sum(patch.PITCHES[kind] for kind in patch.SEQUENCE) / patch.SPEED
    sound.write(out / "patch.wav", sound.samples(time, pressure), period)
    plots.patch(time, sums, each, pressure, out)
    # From the first block's exit to the last one's entry as many blocks leave as come.
    full = (time > 0.018) & (time < time[-1] - 0.018)
    frequencies, density = periodogram(sums[full, :2], 1 / STEP, "hann", axis=0)
    plots.force_spectrum(frequencies, density.T, out)
    plots.spectra(levels, lines, "20 blocks, 1 m", out, "patch-sound")
    return sums[full, :2], frequencies, density


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--fmus", type=Path, default=Path("out/chain"))
    parser.add_argument("--out", type=Path, default=Path("out/chain"))
    arguments = parser.parse_args()
    folder, out = arguments.fmus.resolve(), arguments.out
    out.mkdir(parents=True, exist_ok=True)
    runs, heard = passage(folder, out)
    curves = refine(folder)
    plots.errors(STEPS, curves, out)
    sums, frequencies, density = twenty(folder, out)

    print("force against the plain loop without derivatives, largest difference over its size")
    for name, difference in compare(runs).items():
        print(f"  {name:36s}{difference:.1e}")
    print(f"\n{'rms error of the force':38s}" + "".join(f"{1e6 * s:8.0f} µs" for s in STEPS))
    for name, (force, _) in curves.items():
        print(f"  {name:36s}" + "".join(f"{e:11.1e}" for e in force))
    levels = heard["levels"]
    strongest = int(np.argmax(levels))
    print(f"\nlevel at 1 m {heard['level']:.1f} dB, most in the band of "
          f"{plots.MIDDLES[strongest]:.0f} Hz ({levels[strongest]:.1f} dB)")
    print(f"patch: normal force {sums[:, 1].mean():.0f} N on average, tangential "
          f"{sums[:, 0].mean():.0f} N; strongest tone above 300 Hz at "
          f"{frequencies[np.argmax(np.where(frequencies > 300, density[:, 0], 0))]:.0f} Hz")
    print("\nfiles in", out)
    for file in sorted([*out.glob("*.png"), *out.glob("*.wav"), *out.glob("*.csv")]):
        print("  ", file.name)


if __name__ == "__main__":
    main()

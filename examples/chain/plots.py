"""Pictures of the chain."""

import sys
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).resolve().parents[2] / "demo"))
from style import BLUE, GREEN, PURPLE, VERMILION, plt, save  # noqa: E402

MIDDLES = 1000 * 10 ** (0.1 * (np.arange(21) - 10))  # [Hz]
MS = 1e3


def passage(result, out):
    """What goes through the chain during one passage."""
    figure, axes = plt.subplots(3, 1, figsize=(7.5, 7), sharex=True, layout="constrained")
    t = result["time"] * MS
    axes[0].plot(t, result["force.z"], color=BLUE, label="normal, upward")
    axes[0].plot(t, result["force.x"], color=VERMILION, label="tangential, forward")
    axes[0].set(ylabel="force on the belt in N")
    axes[1].plot(t, result["run_in.velocity.x"], color=BLUE, label="run-in edge")
    axes[1].plot(t, result["run_out.velocity.x"], color=VERMILION, label="run-out edge")
    axes[1].set(ylabel="velocity against\nthe belt in m/s")
    axes[2].plot(t, result["pressure"], color=GREEN)
    axes[2].set(ylabel="sound pressure at 1 m in Pa", xlabel="time in ms")
    for axis in axes[:2]:
        axis.legend()
    return save(figure, out, "chain-passage")


def errors(steps, curves, out):
    """Error over the communication step, one panel for the force and one for the levels."""
    figure, axes = plt.subplots(1, 2, figsize=(8.5, 3.8), layout="constrained")
    looks = {"plain loop with input derivatives": (BLUE, "o", 8), "plain loop": (VERMILION, "s", 9),
             "fmpy SSP": (GREEN, "x", 7), "fmucontainer": (PURPLE, "+", 10)}
    for name, (force, level) in curves.items():
        color, marker, size = looks[name]
        style = dict(color=color, marker=marker, label=name, ms=size, mfc="none",
                     ls="-" if name.startswith("plain") else "none")
        axes[0].loglog(steps * 1e6, force, **style)
        axes[1].loglog(steps * 1e6, level, **style)
    axes[0].set(ylabel="rms error of the force over its rms")
    axes[1].set(ylabel="largest error of a third-octave level in dB")
    for axis in axes:
        axis.set(xlabel="communication step in µs")
        axis.set_xticks(steps * 1e6, [f"{1e6 * s:g}" for s in steps])
        axis.minorticks_off()
    axes[0].legend(fontsize=8)
    return save(figure, out, "chain-error")


def spectra(levels, lines, title, out, name):
    """Third-octave levels and the Fourier lines behind them."""
    figure, axes = plt.subplots(2, 1, figsize=(7.5, 6), layout="constrained")
    axes[0].bar(np.arange(21), np.maximum(levels, 0), color=BLUE, width=0.85)
    labels = ["100", "", "", "200", "", "", "400", "", "", "800", "", "", "1600", "", "", "3150", "",
              "", "6300", "", ""]
    axes[0].set_xticks(np.arange(21), labels)
    axes[0].set(xlabel="third-octave band in Hz", ylabel="level in dB re 20 µPa", title=title,
                ylim=(max(0, np.floor(levels.min() / 10) * 10), None))
    frequencies = 100.0 * np.arange(1, len(lines) + 1)
    axes[1].semilogx(frequencies, 20 * np.log10(np.maximum(lines, 1e-12) / 20e-6), color=VERMILION)
    axes[1].set(xlabel="frequency in Hz", ylabel="Fourier transform\nin dB re 20 µPa/Hz", xlim=(100, 1e4))
    return save(figure, out, name)


def patch(time, sums, each, pressure, out):
    """Forces of 20 blocks, one by one and added."""
    figure, axes = plt.subplots(3, 1, figsize=(7.5, 7.5), sharex=True, layout="constrained")
    t = time * MS
    for column in each.T:
        passing = column != 0
        axes[0].plot(t[passing], column[passing], lw=0.7)
    axes[0].set(ylabel="normal force\nof each block in N")
    axes[1].plot(t, sums[:, 1], color=BLUE, label="normal, upward")
    axes[1].plot(t, sums[:, 0], color=VERMILION, label="tangential, forward")
    axes[1].set(ylabel="sum of the forces in N")
    axes[1].legend()
    axes[2].plot(t, pressure, color=GREEN)
    axes[2].set(ylabel="sound pressure at 1 m in Pa", xlabel="time in ms")
    return save(figure, out, "patch-forces")


def force_spectrum(frequencies, density, out):
    """Spectrum of the patch's forces while it is full of blocks."""
    figure, axis = plt.subplots(figsize=(7.5, 3.6), layout="constrained")
    for values, color, label in zip(density, (VERMILION, BLUE), ("tangential", "normal")):
        axis.loglog(frequencies, values, color=color, label=label)
    axis.set(xlabel="frequency in Hz", ylabel="power spectral density\nof the force in N²/Hz",
             xlim=(100, 1e4))
    axis.legend()
    return save(figure, out, "patch-spectrum")

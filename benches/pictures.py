"""Pictures of the benches: work against precision, roofline."""

from __future__ import annotations

from pathlib import Path

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt

# Okabe and Ito's colours, which colour-blind readers can tell apart.
COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#7F7F7F"]
MARKS = "osD^vPX*"
plt.rcParams.update({"svg.hashsalt": "tread", "font.size": 10, "axes.grid": True, "grid.alpha": 0.3})


def work_precision(folder: Path, points: list[dict], limit: float) -> None:
    figure, axes = plt.subplots(figsize=(7.2, 4.6), layout="constrained")
    for at, solver in enumerate(dict.fromkeys(p["solver"] for p in points)):
        ours = solver.startswith("this model")
        line = "--" if solver == "this model, equal steps" else "-"
        own = [p for p in points if p["solver"] == solver]
        # An error of nothing is below what two runs can tell apart.
        errors = [max(p["error_percent"], 1e-4) for p in own]
        axes.loglog(errors, [p["seconds_per_ms"] for p in own], MARKS[at % len(MARKS)],
                    color="black" if ours else COLOURS[(at - 2) % len(COLOURS)], linestyle=line,
                    linewidth=2.5 if ours else 1.5, label=solver)
    axes.axvline(limit, color="grey", linestyle="--")
    axes.annotate(" 0.5 %", (limit, 1), xycoords=("data", "axes fraction"), va="top")
    axes.axhline(1e-3, color="grey", linestyle=":")
    axes.annotate("real time", (0.01, 1e-3), xycoords=("axes fraction", "data"), ha="left", va="bottom")
    axes.set_xlabel("error of stick-slip frequency or mean friction in %, the larger")
    axes.set_ylabel("seconds per simulated ms")
    axes.legend()
    save(figure, folder / "work-precision.svg")


def roofline(folder: Path, peak: float, found: dict, wall: float) -> None:
    """Where the step stands: attained over what the core can do at its vector share and intensity."""
    intensity, rate = found["flops"] / found["bytes"], found["flops"] / wall
    per_instruction = found["flops"] / found["instructions"]
    figure, axes = plt.subplots(figsize=(7.2, 4.6), layout="constrained")
    # Two fused multiply-adds and two loads of a whole vector per cycle: 4 bytes per flop of the peak.
    flops_per_cycle = 32 if "avx512f" in Path("/proc/cpuinfo").read_text() else 16
    bandwidth = 4 * peak
    xs = [2.0 ** (k / 4) for k in range(-28, 17)]
    axes.loglog(xs, [min(peak, bandwidth * x) / 1e9 for x in xs], color="black", label="core, first-level cache")
    issue = peak / flops_per_cycle * 4 * per_instruction
    axes.axhline(min(issue, peak) / 1e9, color=COLOURS[1], linestyle="--",
                 label=f"4 instructions a cycle at {per_instruction:.2f} flops each")
    axes.loglog([intensity], [rate / 1e9], "o", color=COLOURS[0], label=f"the step: {100 * rate / peak:.0f} % of the peak")
    axes.set_xlabel("flops per byte loaded or stored")
    axes.set_ylabel("Gflop/s")
    axes.legend()
    save(figure, folder / "roofline.svg")


def nodes(folder: Path, cost: list[tuple[int, float]], slope: float) -> None:
    """Work per unit of simulated time over contact nodes, with the fitted slope and the goal's beside it."""
    figure, axes = plt.subplots(figsize=(7.2, 4.6), layout="constrained")
    counts, works = [c[0] for c in cost], [1e3 * c[1] for c in cost]
    axes.loglog(counts, works, "o-", color=COLOURS[0], label=f"this model, slope {slope:.2f}")
    axes.loglog(counts, [works[0] * (n / counts[0]) ** 2 for n in counts], "--", color="grey", label="slope 2, the goal")
    axes.set_xlabel("contact nodes")
    axes.set_ylabel("milliseconds of processor time per simulated second")
    axes.legend()
    save(figure, folder / "nodes.svg")


def save(figure, path: Path) -> None:
    figure.savefig(path, metadata={"Date": None})
    plt.close(figure)

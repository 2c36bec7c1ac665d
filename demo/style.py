"""How all plots look: colours that colour-blind people tell apart (Okabe and Ito), units on every axis."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend has to be chosen first)

BLUE, VERMILION, GREEN, PURPLE, GREY = "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#777777"

plt.rcParams.update({
    "figure.dpi": 110,
    "savefig.dpi": 150,
    "font.size": 10,
    "axes.grid": True,
    "grid.color": "#dddddd",
    "grid.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.axisbelow": True,
    "lines.linewidth": 1.1,
    "legend.frameon": False,
    "svg.fonttype": "none",
})


def save(figure, out, name):
    """PNG for the eye, SVG for print; returns both."""
    files = [out / f"{name}.png", out / f"{name}.svg"]
    for file in files:
        figure.savefig(file)
    plt.close(figure)
    return files

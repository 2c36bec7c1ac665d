"""Draws packaging/model.png, the picture of the FMU: a clamped block that slides on the road."""

from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

figure, axes = plt.subplots(figsize=(4, 3), dpi=100)
height, length, lean = 10.0, 15.0, 3.0
z = np.linspace(0, height, 9)
x = np.linspace(-length / 2, length / 2, 13)
shear = lambda z: lean * ((height - z) / height) ** 1.4
for line in z:
    axes.plot(x + shear(line), np.full_like(x, line), color="#555", lw=0.6)
for line in x:
    axes.plot(line + shear(z), z, color="#555", lw=0.6)
axes.fill_between([-10, 12], height, height + 1.4, color="#222")
axes.fill_between([-10, 12], -1.4, 0, color="#bbb", hatch="///", edgecolor="#888", lw=0)
pressure = 3.2 * np.exp(-(x + length / 2) / 5) + 1.2
for px, p in zip(x + lean, pressure):
    axes.annotate("", (px, 0), (px, -p - 1.4), arrowprops={"arrowstyle": "->", "color": "#c33", "lw": 1})
axes.annotate("", (-10, height + 3), (10, height + 3), arrowprops={"arrowstyle": "->", "color": "#06c", "lw": 2})
axes.set_xlim(-12, 14)
axes.set_ylim(-7, height + 5)
axes.set_aspect("equal")
axes.axis("off")
figure.savefig(Path(__file__).parent / "model.png", metadata={"Software": None})

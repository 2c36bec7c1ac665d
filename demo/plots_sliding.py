"""Sliding: displacement of the edges, limit cycles up the run-in edge, forces, pressure over the face."""

import numpy as np
from style import BLUE, VERMILION, plt, save

import cases

LATE = 5e-3  # [s] end of the run that the close views show


def draw(run, edge, out):
    return (displacement(run, out) + limit_cycle(edge, out) + forces(run, out)
            + pressure(run, out))


def displacement(run, out):
    figure, (whole, late) = plt.subplots(2, 1, figsize=(8, 6), layout="constrained")
    for axes in (whole, late):
        for edge, color in (("run_in", BLUE), ("run_out", VERMILION)):
            axes.plot(1e3 * run["time"], 1e6 * run[f"{edge}.displacement.x"], color=color,
                      label=edge.replace("_", "-") + " edge")
        axes.set_ylabel("displacement [µm]")
    end = 1e3 * run["time"][-1]
    late.set_xlim(end - 1e3 * LATE, end)
    seen = run["time"] > run["time"][-1] - LATE
    values = 1e6 * run["run_in.displacement.x"][seen]
    margin = 0.1 * np.ptp(values) + 1.0
    late.set_ylim(values.min() - margin, values.max() + margin)
    late.set_xlabel("time [ms]")
    late.set_title(f"the last {1e3 * LATE:.0f} ms", fontsize=10)
    whole.set_title("Tangential displacement of the tread face's edges relative to the belt\n"
                    "10 × 15 × 15 mm, 0.25 N/mm², 300 mm/s")
    whole.legend(loc="lower right", ncols=2)
    return save(figure, out, "sliding-displacement")


def limit_cycle(edge, out):
    """Velocity over displacement of corner nodes up the run-in edge, settled part."""
    heights = np.unique(edge["z"])[:-1]  # the last one is clamped
    heights = heights[:: max(1, len(heights) // 5)]
    figure, axes = plt.subplots(figsize=(7.2, 5.6), layout="constrained")
    colors = plt.get_cmap("viridis")(np.linspace(0.0, 0.85, len(heights)))
    for z, color in zip(heights, colors):
        node = edge[edge["z"] == z]
        velocity = np.gradient(node["ux"], node["time"])
        late = node["time"] > node["time"][-1] - LATE
        axes.plot(1e6 * node["ux"][late], 1e3 * velocity[late], color=color, linewidth=0.9,
                  label=f"{1e3 * z:.1f} mm")
    axes.axhline(1e3 * cases.SLIDING.speed, color="black", linewidth=0.8, linestyle="--")
    axes.annotate("road speed: the node sticks", (0.99, 1e3 * cases.SLIDING.speed), fontsize=9,
                  xycoords=("axes fraction", "data"), xytext=(0, 3), textcoords="offset points",
                  ha="right")
    axes.set_xlabel("tangential displacement [µm]")
    axes.set_ylabel("tangential velocity [mm/s]")
    axes.set_title(f"Limit cycles of the nodes up the run-in edge, last {1e3 * LATE:.0f} ms")
    axes.legend(title="above the tread face", loc="lower left")
    return save(figure, out, "sliding-limit-cycle")


def forces(run, out):
    figure, (force, mu) = plt.subplots(2, 1, figsize=(8, 6), layout="constrained")
    t = 1e3 * run["time"]
    force.plot(t, run["contact.force.x"], color=BLUE, label="tangential")
    force.plot(t, run["contact.force.z"], color=VERMILION, label="normal")
    force.set_ylabel("force of the road [N]")
    force.set_ylim(bottom=min(0.0, 1.05 * run["contact.force.x"].min()))
    force.legend(loc="lower right", ncols=2)
    force.set_title("Forces of the road on the sliding block")
    mu.plot(t, run["contact.friction_coefficient"], color=BLUE, label="friction coefficient")
    mu.plot(t, run["contact.stick_fraction"], color=VERMILION, linewidth=0.8,
            label="share of the contact that sticks")
    force.set_xlabel("time [ms]")
    mu.set_xlabel("time [ms]")
    mu.set_xlim(t[-1] - 1e3 * LATE, t[-1])
    mu.set_title(f"the last {1e3 * LATE:.0f} ms", fontsize=10)
    mu.set_ylabel("friction, share [-]")
    mu.set_ylim(top=1.25 * max(1.0, run["contact.friction_coefficient"].max()))
    mu.legend(loc="upper right", ncols=2)
    return save(figure, out, "sliding-forces")


def pressure(run, out):
    stations = [name for name in run.dtype.names if name.startswith("contact.pressure")]
    late = run[run["time"] > run["time"][-1] - LATE]
    face = 1e-3 * np.array([late[name] for name in stations])
    speed = np.array([late[n.replace("pressure", "sliding_speed")] for n in stations])
    figure, axes = plt.subplots(2, 1, figsize=(8, 6), sharex=True, layout="constrained")
    length = 1e3 * cases.BLOCK["block.length"]
    x = np.linspace(0.0, length, len(stations))
    for panel, values, cmap, label in [
        (axes[0], face, "cividis", "contact pressure [kPa]"),
        (axes[1], 1e3 * np.abs(speed), "magma", "sliding speed [mm/s]"),
    ]:
        mesh = panel.pcolormesh(1e3 * late["time"], x, values, cmap=cmap, shading="nearest",
                                rasterized=True)
        figure.colorbar(mesh, ax=panel, label=label)
        panel.set_ylabel("from run-in edge [mm]")
        panel.grid(False)
    axes[1].set_xlabel("time [ms]")
    axes[0].set_title("Contact pressure and sliding speed over the tread face")
    return save(figure, out, "sliding-face")

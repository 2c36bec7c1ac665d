"""Rolling: the deformed block at run-in, sticking, sliding, snap-out; the run-in edge over the patch."""

import numpy as np
from style import BLUE, GREY, VERMILION, plt, save

import cases



def instants(run):
    """Times [s] of the four phases, by what the contact does."""
    t = run["time"]
    area, stick = run["contact.area_fraction"], run["contact.stick_fraction"]
    touching = np.flatnonzero(area > 0.0)
    if len(touching) < 10:
        raise SystemExit("demo: the block never touches the road: check the belt path")
    first, last = touching[0], touching[-1]
    speed = np.maximum(np.abs(run["run_in.velocity.x"]), np.abs(run["run_out.velocity.x"]))
    run_in = first + int(np.argmax(area[first:] > 0.3))
    full = np.flatnonzero(area > 0.9 * area.max())
    # The first slip of the whole face; without one, the middle of the patch.
    slips = full[(stick[full] < 0.1) & (full > full[0] + 5)]
    slip = slips[0] if len(slips) else full[len(full) // 2]
    holds = np.flatnonzero(stick[run_in:slip] > 0.9)
    sticking = run_in + (holds[-1] if len(holds) else 0)
    sliding = slip + int(np.argmax(speed[slip:slip + 40]))
    snap_out = full[-1] + int(np.argmax(speed[full[-1]:last + 50]))
    return {"run-in": t[run_in], "sticking": t[sticking], "sliding": t[sliding],
            "snap-out": t[snap_out]}


def contact_coordinate(run):
    """Where the block is along the patch [mm]: belt speed times the time from the patch's middle."""
    speed = cases.ROLLING.speed
    middle = (cases.LEAD + 0.5 * cases.CONTACT_LENGTH) / speed
    return 1e3 * speed * (run["time"] - middle)


def draw(run, times, shapes, out):
    return deformed(run, times, shapes, out) + run_in_edge(run, times, out)


def deformed(run, times, shapes, out):
    figure, panels = plt.subplots(1, 4, figsize=(13, 3.7), sharey=True, layout="constrained")
    stations = [n for n in run.dtype.names if n.startswith("contact.pressure")]
    rows = {phase: int(np.argmin(np.abs(run["time"] - t))) for phase, t in times.items()}
    largest = max(run[n][row] for n in stations for row in rows.values()) or 1.0
    pose = cases.rolling_input(cases.ROLLING)
    for panel, (phase, time) in zip(panels, times.items()):
        row = rows[phase]
        nodes = shapes[np.isclose(shapes["time"], run["time"][row], atol=1e-9)]
        angle = np.interp(time, pose["time"], pose["belt.angle"])
        height = np.interp(time, pose["time"], pose["belt.z"])
        grid(panel, nodes, angle, height)
        pressure_bars(panel, nodes, angle, height, [run[n][row] for n in stations], largest)
        panel.set_title(f"{phase}\nt = {1e3 * time:.2f} ms, stick {run['contact.stick_fraction'][row]:.0%}",
                        fontsize=10)
        panel.set_xlabel("along the road [mm]")
        panel.set_xlim(-10, 10)
        panel.set_ylim(-5, 12.5)
        panel.set_aspect("equal")
        panel.grid(False)
    panels[0].set_ylabel("above the road [mm]")
    figure.suptitle("One passage through the contact patch, displacements to scale; "
                    f"contact pressure in orange (deepest {1e-6 * largest:.2f} N/mm²)")
    return save(figure, out, "rolling-shapes")


def placed(nodes, angle, height, share=1.0):
    """Nodes in the road frame [mm], seen from above the middle of the clamped face."""
    x = nodes["x"] + share * nodes["ux"]
    # The block hangs below the clamped face.
    z = nodes["z"] - cases.BLOCK["block.height"] + share * nodes["uz"]
    cos, sin = np.cos(angle), np.sin(angle)
    return 1e3 * (cos * x - sin * z), 1e3 * (height + sin * x + cos * z)


def grid(panel, nodes, angle, height):
    """Lines of the mesh through corner nodes, deformed; the outline of the undeformed block."""
    x, z = placed(nodes, angle, height)
    for key in ("x", "z"):
        for value in np.unique(nodes[key]):
            line = np.flatnonzero(nodes[key] == value)
            order = line[np.argsort(nodes["z" if key == "x" else "x"][line])]
            edge = value in (nodes[key].min(), nodes[key].max())
            panel.plot(x[order], z[order], color=BLUE, linewidth=1.3 if edge else 0.35)
    x0, z0 = placed(nodes, angle, height, 0.0)
    corners = [np.argmin(sx * nodes["x"] + sz * nodes["z"])
               for sx, sz in [(1, 1), (-1, 1), (-1, -1), (1, -1), (1, 1)]]
    panel.plot(x0[corners], z0[corners], color=GREY, linewidth=0.8, linestyle=":")
    panel.axhline(0.0, color="black", linewidth=1.2)


def pressure_bars(panel, nodes, angle, height, pressure, largest):
    """Pressure downwards from the road, below where the face stands."""
    face = nodes[nodes["z"] == nodes["z"].min()]
    face = face[np.argsort(face["x"])]
    x, _ = placed(face, angle, height)
    at = np.interp(np.linspace(0, 1, len(pressure)), np.linspace(0, 1, len(x)), x)
    bars = -4.0 * np.array(pressure) / largest
    panel.fill_between(at, bars, 0.0, color=VERMILION, alpha=0.45, linewidth=0)
    panel.plot(at, bars, color=VERMILION, linewidth=1.0)


def run_in_edge(run, times, out):
    figure, panels = plt.subplots(3, 1, figsize=(8.5, 7.5), sharex=True, layout="constrained")
    s = contact_coordinate(run)
    panels[0].plot(s, 1e6 * run["run_in.displacement.x"], color=BLUE)
    panels[0].set_ylabel("displacement [µm]")
    panels[0].set_title("Run-in edge over the contact patch: tangential motion relative to the belt\n"
                        "belt 10 m/s, 3 % braking slip")
    panels[1].plot(s, 1e3 * run["run_in.velocity.x"], color=BLUE)
    panels[1].set_ylabel("velocity [mm/s]")
    low, high = panels[1].get_ylim()
    panels[1].set_ylim(low, high + 0.15 * (high - low))  # room for the labels
    panels[2].plot(s, run["contact.force.x"], color=BLUE, label="tangential")
    panels[2].plot(s, run["contact.force.z"], color=VERMILION, label="normal")
    panels[2].set_ylabel("force of the road [N]")
    panels[2].set_xlabel("contact coordinate: belt travel from the middle of the patch [mm]")
    panels[2].legend(loc="center")
    for phase, time in times.items():
        at = np.interp(time, run["time"], s)
        for panel in panels:
            panel.axvline(at, color=GREY, linewidth=0.8, linestyle="--")
        before = phase in ("run-in", "sticking")  # the next one follows at once
        panels[1].annotate(phase, (at, 0.97), xycoords=("data", "axes fraction"), fontsize=9,
                           xytext=(-3 if before else 3, 0), textcoords="offset points",
                           ha="right" if before else "left", va="top",
                           bbox={"facecolor": "white", "edgecolor": "none", "pad": 1})
    touching = s[run["contact.area_fraction"] > 0]
    if len(touching):
        panels[2].set_xlim(touching[0] - 8, touching[-1] + 12)
    return save(figure, out, "rolling-run-in-edge")

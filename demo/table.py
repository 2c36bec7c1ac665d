"""The table at the end of the demo."""

import numpy as np


def text(metrics, results, seconds):
    lines = [heading("Sliding: 10 × 15 × 15 mm, 0.25 N/mm², 300 mm/s, 30 ms")]
    for name, entry in metrics.items():
        lines.append(line(name, entry["value"], entry["unit"]))
    rolling = results["rolling"]
    lines.append(heading("Rolling: belt 10 m/s, 3 % braking slip"))
    for name, values, unit in [
        ("largest tangential force", np.abs(rolling["contact.force.x"]).max(), "N"),
        ("largest normal force", rolling["contact.force.z"].max(), "N"),
        ("largest displacement of run-in edge", 1e6 * np.abs(rolling["run_in.displacement.x"]).max(), "um"),
        ("largest velocity of run-in edge", 1e3 * np.abs(rolling["run_in.velocity.x"]).max(), "mm/s"),
        ("time in contact", 1e3 * contact_time(rolling), "ms"),
        ("mass worn off", 1e9 * rolling["wear.mass"][-1], "ug"),
    ]:
        lines.append(line(name, values, unit))
    lines.append(heading("Run time"))
    for name, used in seconds.items():
        lines.append(line(f"{name} in fmpy", used, "s"))
    return "\n".join(lines)


def contact_time(run):
    step = np.diff(run["time"], append=run["time"][-1])
    return float(np.sum(step[run["contact.area_fraction"] > 0]))


def heading(title):
    return f"\n{title}\n{'─' * 60}"


def line(name, value, unit):
    return f"  {name:<38}{value:>12.4g}  {'' if unit == '1' else unit}"

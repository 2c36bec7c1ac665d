"""Inputs of the FMU over time: a sliding road, a belt path."""

from __future__ import annotations

import os

import numpy as np
import pandas as pd

BELT_COLUMNS = {"time_s": "time", "belt_x_m": "belt.x", "belt_z_m": "belt.z",
                "belt_angle_rad": "belt.angle"}


def slide(speed: float, load: float, duration: float, step: float, start_ramp: float,
          dwell: float) -> pd.DataFrame:
    """belt.x falls by the distance that the road would have moved: x = −∫ v dt."""
    t = np.arange(round(duration / step) + 1) * step
    s = np.maximum(t - dwell, 0.0)
    ramp = max(start_ramp, 1e-12)
    moved = np.where(s < ramp, 0.5 * speed * s**2 / ramp, speed * (s - 0.5 * ramp))
    return pd.DataFrame({"time": t, "belt.x": -moved, "normal_load": np.full_like(t, load)})


def roll(path: pd.DataFrame | str | os.PathLike[str]) -> pd.DataFrame:
    """A belt path under the names of the FMU's inputs."""
    from .block import TreadBlockError

    frame = path if isinstance(path, pd.DataFrame) else pd.read_csv(path)
    missing = [name for name in BELT_COLUMNS if name not in frame.columns]
    if missing:
        raise TreadBlockError(
            f"column {', '.join(missing)} = missing: allowed are the columns "
            f"{', '.join(BELT_COLUMNS)}; `tread belt` writes them")
    return frame[list(BELT_COLUMNS)].rename(columns=BELT_COLUMNS).astype(float)

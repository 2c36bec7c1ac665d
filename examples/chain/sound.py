"""From the acoustic stage's pressure at communication points to something to listen to."""

import numpy as np
from scipy.io import wavfile
from scipy.signal import decimate

SAMPLING = 96_000  # [Hz] of the acoustic stage
FULL_SCALE = 5.0  # [Pa] that the file's largest number stands for


def samples(time, pressure):
    """The stage's samples: each is told at the end of the step after the one it falls into."""
    step = time[0]
    count = int((time[-1] - step) * SAMPLING)
    told = np.ceil(np.arange(count) / SAMPLING / step - 1e-6).astype(int)
    return pressure[told]


def write(file, pressure, every, seconds=2.0):
    """Repeats a sound [Pa] `every` so many seconds, overlaps added, as 48 kHz, 16 bit."""
    total = np.zeros(int(seconds * SAMPLING) + len(pressure))
    faded = pressure * np.minimum(1, np.arange(len(pressure), 0, -1) / 200)
    for start in np.arange(0, seconds, every):
        at = int(round(start * SAMPLING))
        total[at:at + len(faded)] += faded
    sound = decimate(total[: int(seconds * SAMPLING)], 2, ftype="fir")
    scaled = np.clip(sound / FULL_SCALE, -1, 1) * 32767
    wavfile.write(file, SAMPLING // 2, scaled.astype(np.int16))

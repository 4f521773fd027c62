"""Records made ready for models that know nothing above a certain frequency: filtered without lag, then thinned."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt
from scipy.signal import butter, sosfiltfilt

FloatArray = npt.NDArray[np.float64]

ORDER = 4
"""Of the Butterworth filter; it runs forwards and backwards, so the drop at the corner is 6 dB and the lag none."""


def low_pass(values: FloatArray, sample_time: float, corner: float) -> FloatArray:
    """Values without what lies above the corner [Hz]."""
    return np.asarray(sosfiltfilt(butter(ORDER, 2.0 * corner * sample_time, output="sos"), values))


def rates(angles: FloatArray, sample_time: float) -> tuple[FloatArray, FloatArray]:
    """Speed and acceleration of a smooth angle, central differences."""
    speeds = np.gradient(angles, sample_time)
    return speeds, np.gradient(speeds, sample_time)

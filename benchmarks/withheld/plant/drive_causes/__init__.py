"""What can be put into the drive bench: each cause draws its law and sizes, from barely detectable to strong.

A module here has ``CAUSES``: pairs of a Cause and a function (rng, place, specimen, strength) -> changed
specimen.  ``strength`` multiplies the main size, which is drawn from the range that such benches show; 1 keeps it.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from benchmarks.withheld.case import Cause
from benchmarks.withheld.plant.drive_train.specimen import Specimen

Put = Callable[[np.random.Generator, str, Specimen, float], Specimen]
Entry = tuple[Cause, Put]

"""How visible a cause is in the records of the drive bench once the nominal parameters are refitted."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from benchmarks.withheld.case import Array
from benchmarks.withheld.plant.drive_train.excitation import RECORDS
from benchmarks.withheld.plant.drive_train.motion import TOLERANCE
from benchmarks.withheld.plant.drive_train.nominal import UNCERTAINTY
from benchmarks.withheld.plant.drive_train.specimen import Specimen, specimen
from benchmarks.withheld.plant.drive_train.whitening import in_noise

STEP = 0.2  # standard deviations, of the differences
ROUGH = 10.0 * TOLERANCE  # errs by 0.02 noise units, enough for differences


def signals(made: Specimen, *, tolerance: float = TOLERANCE) -> Array:
    """All channels of all records in noise units, as one vector."""
    return np.concatenate([in_noise(made.channels(record, tolerance=tolerance)) for record in RECORDS])


class Yardstick:
    """A specimen without causes, and how its records change with each uncertain parameter.

    Detectability: min over d of |y - y_plain - J d|^2 + |d|^2 with d in standard deviations of the
    parameters: the gain in fit (in squares of noise) that the right cause brings over the best plain bench.
    Linear in the parameters: right for faint causes, an upper bound by up to orders of magnitude where
    parameters must move far to hide a strong one.
    """

    def __init__(self, values: Mapping[str, float]) -> None:
        self.values = dict(values)
        self.plain = signals(specimen(values))
        moved = ({**self.values, name: self.values[name] * np.exp(STEP * size)} for name, size in UNCERTAINTY.items())
        plain = signals(specimen(values), tolerance=ROUGH)
        self.jacobian = np.column_stack([(signals(specimen(other), tolerance=ROUGH) - plain) / STEP for other in moved])

    def linear(self, found: Array, *beside: Array) -> float:
        """Detectability of signals; ``beside`` are signatures of other causes, whose size may change by its own amount as well."""
        signature = found - self.plain
        columns = np.column_stack([self.jacobian, *beside]) if beside else self.jacobian
        along = columns.T @ signature
        return float(signature @ signature - along @ np.linalg.solve(columns.T @ columns + np.eye(columns.shape[1]), along))

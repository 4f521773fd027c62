"""How visible a cause is in the records of the drive bench once the nominal parameters are refitted."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from benchmarks.withheld.case import Array
from benchmarks.withheld.plant.drive_train.excitation import RECORDS
from benchmarks.withheld.plant.drive_train.nominal import UNCERTAINTY
from benchmarks.withheld.plant.drive_train.specimen import Specimen, specimen
from benchmarks.withheld.plant.drive_train.whitening import in_noise

STEP = 0.2  # standard deviations, of the differences


def signals(made: Specimen) -> Array:
    """All channels of all records in noise units, as one vector."""
    return joined({record: made.channels(record) for record in RECORDS})


def joined(channels: Mapping[str, Mapping[str, Array]]) -> Array:
    """The same from channels at hand."""
    return np.concatenate([in_noise(channels[record]) for record in RECORDS])


class Yardstick:
    """A specimen without causes, and how its records change with each uncertain parameter.

    Detectability: min over d of |y - y_plain(parameters moved by d standard deviations)|^2 + |d|^2, the
    gain in fit (in squares of noise) that the right cause brings over the best plain bench.
    """

    def __init__(self, values: Mapping[str, float]) -> None:
        self.values = dict(values)
        self.plain = signals(specimen(values))
        columns = [(signals(self._moved({name: STEP})) - self.plain) / STEP for name in UNCERTAINTY]
        self.jacobian = np.column_stack(columns)
        self._normal = self.jacobian.T @ self.jacobian

    def _moved(self, deviations: Mapping[str, float]) -> Specimen:
        return specimen({**self.values, **{name: self.values[name] * np.exp(d * UNCERTAINTY[name]) for name, d in deviations.items()}})

    def linear(self, found: Array, *beside: Array) -> float:
        """Detectability with the answer to parameters taken as linear: quick, too large for strong causes.

        ``beside`` are signatures of other causes, whose size may change by its own amount as well.
        """
        signature = found - self.plain
        columns = np.column_stack([self.jacobian, *beside]) if beside else self.jacobian
        along = columns.T @ signature
        return float(signature @ signature - along @ np.linalg.solve(columns.T @ columns + np.eye(columns.shape[1]), along))

    def refitted(self, found: Array, *, rounds: int = 12) -> float:
        """Detectability by a refit with damped Gauss-Newton steps and a fixed Jacobian; an upper bound that the refit reached."""
        moved = np.zeros(len(UNCERTAINTY))
        left = found - self.plain
        cost, damping = float(left @ left), 1e-3
        for _ in range(rounds):
            downhill = self.jacobian.T @ left - moved
            matrix = self._normal + np.eye(moved.size) + damping * np.diag(np.diag(self._normal))
            trial = np.clip(moved + np.linalg.solve(matrix, downhill), -12.0, 12.0)
            rest = found - signals(self._moved(dict(zip(UNCERTAINTY, trial, strict=True))))
            now = float(rest @ rest + trial @ trial)
            if now < cost:
                gain, cost, moved, left, damping = cost - now, now, trial, rest, 0.2 * damping
                if gain < 0.02 * cost:
                    break
            else:
                damping *= 10.0
        return cost

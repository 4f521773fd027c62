"""One example of the bench with what is planted in it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from benchmarks.withheld.plant.rotor_line.equations import Causes, FloatArray, Machine, no_causes
from benchmarks.withheld.plant.rotor_line.machine import machine
from benchmarks.withheld.plant.rotor_line.records import RECORDS, Run, run, static_deflection


@dataclass(kw_only=True)
class SensorFaults:
    """Faults of the probes."""

    runout: dict[int, FloatArray] = field(default_factory=dict)  # station: rows (order, amplitude, angle)
    scratch: dict[int, tuple[float, float, float]] = field(default_factory=dict)  # station: depth, angle, width
    gain: dict[str, tuple[float, float]] = field(default_factory=dict)  # channel: relative error, error per metre


@dataclass(kw_only=True)
class Planted:
    """The bench while causes are planted: its true values, and everything that the builder does not know."""

    values: dict[str, float]
    causes: Causes = field(default_factory=no_causes)
    sensors: SensorFaults = field(default_factory=SensorFaults)
    ring_stiffness: FloatArray = field(default_factory=lambda: np.ones(2))
    ring_damping: FloatArray = field(default_factory=lambda: np.ones(2))
    support_stiffness: FloatArray = field(default_factory=lambda: np.ones(2))
    effect: dict[str, Any] = field(default_factory=dict)  # put_in of truth.json
    sensor: dict[str, Any] = field(default_factory=dict)
    factors: dict[str, float] = field(default_factory=dict)

    def machine(self) -> Machine:
        """The numbers of the equations."""
        found = machine(self.values)
        return found._replace(
            ring_stiffness=found.ring_stiffness * self.ring_stiffness,
            ring_damping=found.ring_damping * self.ring_damping,
            support_stiffness=found.support_stiffness * self.support_stiffness[:, None],
        )

    def multiply(self, name: str, factor: float) -> None:
        """Change a true value."""
        self.values[name] *= factor
        self.factors[name] = self.factors.get(name, 1.0) * factor

    def rest(self) -> FloatArray:
        """Static deflection without any hidden cause."""
        return static_deflection(self.machine(), no_causes())

    def travel(self, station: int) -> float:
        """Largest distance of a station from its rest after the hammer's blows without any hidden cause [m]."""
        rest = self.rest()
        found = run(self.machine(), no_causes(), "bump", rest=rest)
        k = 4 * station
        return float(np.max(np.hypot(found.states[:, k] - rest[k], found.states[:, k + 1] - rest[k + 1])))

    def runs(self, records: Sequence[str] = RECORDS) -> dict[str, Run]:
        """Simulate."""
        made = self.machine()
        rest = static_deflection(made, self.causes)
        return {record: run(made, self.causes, record, rest=rest) for record in records}

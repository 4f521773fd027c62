"""A specimen of the bench: parameters, laws and sensor faults, and what was told about them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from benchmarks.withheld.case import Array
from benchmarks.withheld.plant.drive_train.motion import TOLERANCE, motion
from benchmarks.withheld.plant.drive_train.rates import Plant, Tables, nominal_plant
from benchmarks.withheld.plant.drive_train.sensors import Sensors, clean


@dataclass(frozen=True, kw_only=True)
class Specimen:
    """Immutable; each cause returns a changed copy."""

    values: Mapping[str, float]  # parameters by their symbols
    plant: Plant
    tables: Tables
    sensors: Sensors = Sensors()
    truth: tuple[Mapping[str, Any], ...] = ()
    put_in: Mapping[str, Mapping[str, Any]] = field(default_factory=lambda: {"effect": {}, "sensor": {}, "parameter_factors": {}})

    def channels(self, record: str, *, tolerance: float = TOLERANCE) -> dict[str, Array]:
        """The record without noise."""
        return clean(motion(self.plant, self.tables, record, tolerance=tolerance), self.sensors)

    def part(self, name: str, **changes: float) -> Specimen:
        """With changed numbers in one part of the plant."""
        return replace(self, plant=self.plant._replace(**{name: getattr(self.plant, name)._replace(**changes)}))

    def told(self, effect: str, at: str, kind: str = "effect", symbols: Mapping[str, Any] | None = None, **sizes: Any) -> Specimen:
        """With one more cause in the truth."""
        noted = {**self.put_in, kind: {**self.put_in[kind], **(symbols or {})}}
        return replace(self, truth=(*self.truth, {"effect": effect, "at": at, **sizes}), put_in=noted)


def specimen(values: Mapping[str, float]) -> Specimen:
    """The bench with these parameters and nothing else."""
    plant, tables = nominal_plant(dict(values))
    return Specimen(values=values, plant=plant, tables=tables)

"""Entries of causes that have no name in the answer format: the right answer is ``unknown``, with the place."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from benchmarks.withheld.case import Cause
from benchmarks.withheld.plant.drive_causes import Entry, Put
from benchmarks.withheld.plant.drive_train.specimen import Specimen

Sizes = Callable[[np.random.Generator, str, Specimen, float], dict[str, float]]


def in_plant(part: str | dict[str, str], sizes: Sizes) -> Put:
    """A cause that changes numbers of one part of the plant; a dictionary gives the part by place."""

    def put(rng: np.random.Generator, at: str, specimen: Specimen, strength: float) -> Specimen:
        name = part if isinstance(part, str) else part[at]
        changes = sizes(rng, at, specimen, strength)
        return specimen.part(name, **changes).told("unknown", at, symbols={f"{name}_{key}": value for key, value in changes.items()})

    return put


def in_sensor(sizes: Sizes) -> Put:
    def put(rng: np.random.Generator, at: str, specimen: Specimen, strength: float) -> Specimen:
        changes: dict[str, Any] = sizes(rng, at, specimen, strength)
        return replace(specimen, sensors=replace(specimen.sensors, **changes)).told("unknown", at, "sensor", changes)

    return put


def entry(name: str, places: tuple[str, ...], put: Put) -> Entry:
    return Cause(name=name, places=places, kind="unlisted"), put

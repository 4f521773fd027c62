"""A bench from a scene alone: columns named like channels, noise from the records, usual tolerances."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from hdrive_mbs.diagnosis.bench import Bench, Uncertain
from hdrive_mbs.diagnosis.measured import Measured
from hdrive_mbs.errors import RecordError
from hdrive_mbs.records.record import Record
from hdrive_mbs.scene import Scene

FloatArray = npt.NDArray[np.float64]

TOLERANCES: dict[str, float] = {"kg m^2": 0.05, "kg": 0.02, "N m/rad": 0.1, "N/m": 0.1, "N m s/rad": 0.3, "N s/m": 0.3, "Pa": 0.03}
"""Unit of a field -> assumed relative standard deviation: inertias and stiffnesses from data sheets, dampings by experience."""


def assumed_bench(scene: Scene, records: Sequence[Record]) -> Bench:
    """The bench that a bare scene stands for.  Raises RecordError where no column is named like a channel."""
    channels = {channel.name for channel in scene.network().channels}
    measured: dict[str, Measured] = {}
    for record in records:
        for name, item in record.channels.items():
            channel = item.quantity or name
            if channel in channels and name not in measured:
                noise, resolution = estimated_noise(np.asarray(item.values, float))
                measured[name] = Measured(channel=channel, noise=noise, resolution=resolution)
    if not measured:
        raise RecordError(
            f"No column is named like a channel of scene {scene.name!r}. Rename columns or map them when reading, e.g."
            f" read_record(path, channels={{'my column': {sorted(channels)[0]!r}}})."
        )
    knowledge = {
        path: Uncertain(paths=(path,), sigma=TOLERANCES[item.unit])
        for path, item in scene.parameters().items()
        if item.unit in TOLERANCES and item.value > 0.0
    }
    return Bench(scene=scene, knowledge=knowledge, measured=measured)


def estimated_noise(values: FloatArray) -> tuple[float, float]:
    """Standard deviation of white noise, from third differences (variance 20 times that of the noise), and the rounding step.

    The median over the record counts, so that a stretch of fast motion does not (Donoho's estimate of a scale).
    """
    finite = values[np.isfinite(values)]
    steps = np.diff(np.unique(finite))
    steps = steps[steps > 1e-12 * max(1.0, float(np.abs(finite).max(initial=0.0)))]
    resolution = float(steps.min()) if len(steps) and len(steps) < 0.5 * len(finite) else 0.0
    differences = np.diff(finite, 3)
    scale = float(np.median(np.abs(differences - np.median(differences)))) / 0.6745 / np.sqrt(20.0) if len(differences) else 0.0
    floor = 1e-6 * float(np.ptp(finite)) if len(finite) else 1.0
    return max(scale, floor, 1e-12), resolution

"""Identified parameters with intervals, or the plain word that the records do not determine them."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence

import numpy as np

from hdrive_mbs.diagnosis.acting_through import idle_without
from hdrive_mbs.diagnosis.fit import Fitted
from hdrive_mbs.diagnosis.result import Estimate
from hdrive_mbs.diagnosis.unknowns import Factor, Shape, Vector
from hdrive_mbs.scene import Scene

WIDTH = 1.959964
"""Standard deviations of a 95 % interval."""
LEARNED = 0.8
"""Of its prior standard deviation: a parameter that keeps more than this has not been identified."""


def nominal_estimates(fitted: Fitted, scene: Scene) -> tuple[Estimate, ...]:
    """Nominal parameters of the scene after the fit, one for each name."""
    errors = np.sqrt(np.diag(fitted.covariance))
    known = scene.parameters()
    found = []
    for k, factor in enumerate(unknown for unknown in fitted.hypothesis.unknowns if isinstance(unknown, Factor)):
        nominal = factor.nominal[factor.path]
        z, error = float(fitted.z[k]), float(errors[k])
        free = known[factor.path]
        found.append(
            Estimate(
                name=factor.name,
                unit=free.unit,
                doc=free.quantity.doc,
                value=nominal * factor.ratio(z),
                low=nominal * factor.ratio(z - WIDTH * error),
                high=nominal * factor.ratio(z + WIDTH * error),
                nominal=nominal,
                tolerance=factor.sigma,
                identifiable=error < LEARNED,
                at_end=factor.at_end([z]),
            )
        )
    return tuple(found)


def effect_estimates(fitted: Fitted, improved: Scene, name: str) -> tuple[Estimate, ...]:
    """Searched fields of an added effect.

    A phase whose amplitude may be zero is not identifiable, nor is a field that acts through sizes alone that may be.
    """
    covariance = fitted.covariance
    known = improved.parameters()
    found: list[Estimate] = []
    for unknown, part in zip(fitted.hypothesis.unknowns, fitted.hypothesis.slices, strict=True):
        if not unknown.path.startswith(f"{name}."):
            continue
        z, spread = fitted.z[part], covariance[part, part]
        slopes = _slopes(unknown, z.tolist())
        for path, value in unknown.values(z.tolist()).items():
            slope = slopes[path]
            error = math.sqrt(max(float(slope @ spread @ slope), 0.0))
            free = known[path]
            low, high = value - WIDTH * error, value + WIDTH * error
            sure = bool(np.sqrt(spread[0, 0]) < LEARNED)
            if isinstance(unknown, Shape):
                part_error = error / value
                low, high = value * math.exp(-WIDTH * part_error), value * math.exp(WIDTH * part_error)
            elif isinstance(unknown, Vector):
                sure = error < 0.5 * abs(value) if path == unknown.path else error < 1.0 and found[-1].identifiable
            elif unknown.precision == 0.0:
                sure = error < 0.5 * abs(value)
            found.append(
                Estimate(
                    name=path,
                    unit=free.unit,
                    doc=free.quantity.doc,
                    value=value,
                    low=max(low, free.low) if math.isfinite(free.low) else low,
                    high=min(high, free.high) if math.isfinite(free.high) else high,
                    identifiable=sure,
                    at_end=unknown.at_end(z.tolist()) and path == unknown.path,
                )
            )
    return _without_idle(found, improved, name)


def _without_idle(found: Sequence[Estimate], improved: Scene, name: str) -> tuple[Estimate, ...]:
    """Fields that are not felt without sizes which may be zero, as not identifiable."""
    sizes = {item.name: max(item.low, item.high, key=abs) for item in found if not item.identifiable and item.low <= 0.0 <= item.high}
    rest = [item.name for item in found if item.identifiable]
    idle = idle_without(improved, name, rest, sizes) if sizes and rest else frozenset()
    return tuple(dataclasses.replace(item, identifiable=item.identifiable and item.name not in idle) for item in found)


def _slopes(unknown: object, z: Sequence[float]) -> dict[str, np.ndarray[tuple[int], np.dtype[np.float64]]]:
    """d value/d coordinate of each field, by central differences."""
    step = 1e-6
    found: dict[str, list[float]] = {}
    for k in range(len(z)):
        ends = []
        for sign in (1.0, -1.0):
            moved = list(z)
            moved[k] += sign * step
            ends.append(unknown.values(moved))  # type: ignore[attr-defined]
        for path in ends[0]:
            change = ends[0][path] - ends[1][path]
            if isinstance(unknown, Vector) and path == unknown.phase_path:
                change = math.remainder(change, 2.0 * math.pi)
            found.setdefault(path, []).append(change / (2.0 * step))
    return {path: np.array(values) for path, values in found.items()}

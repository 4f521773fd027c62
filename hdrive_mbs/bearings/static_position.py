"""Where a bearing carries a static load."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from hdrive_mbs.bearings.gradients import FREE, NAMES, Derivatives, at_rest, numbers
from hdrive_mbs.bearings.law import BearingLaw, FloatArray, RelativeMotion
from hdrive_mbs.errors import AnalysisError, HdriveError, ParameterError


def static_position(law: BearingLaw, of: Derivatives, load: Sequence[float], speed: float, angle: float) -> FloatArray:
    """See BearingLaw.static_position; ``of`` are the derivatives of the law."""
    wanted = _checked(load, speed, angle)
    at, error = _solve(law, of, wanted, speed, angle, count=8)
    if error > _tolerance(wanted):
        at, error = _unloading(law, of, wanted, speed, angle, (at, error))
    if error > _tolerance(wanted):
        raise AnalysisError(
            f"No static position of {law.describe()} with the load ({wanted[0]:g}, {wanted[1]:g}) N at {speed:g} rad/s: "
            f"at best {error:.3g} N stay uncarried. A fluid film carries nothing at standstill and no more than at its largest "
            "eccentricity, a bearing without stiffness in a direction no load in it; give another speed or load, or the "
            "missing stiffness."
        )
    return np.append(at, 0.0)


def _checked(load: Sequence[float], speed: float, angle: float) -> FloatArray:
    wanted = np.zeros(FREE)
    try:
        wanted[:2] = np.asarray(load, float)
        known = np.shape(load) == (2,) and bool(np.isfinite([*wanted, float(speed), float(angle)]).all())
    except (TypeError, ValueError):
        known = False
    if not known:
        raise ParameterError(
            f"load = {load!r} N, speed = {speed!r} rad/s, angle = {angle!r} rad: must be two forces (Fx, Fy) and two numbers, all finite."
        )
    return wanted


def _tolerance(wanted: FloatArray) -> float:
    return 1e-9 * (float(np.hypot(wanted[0], wanted[1])) or 1.0)


def _solve(law: BearingLaw, of: Derivatives, wanted: FloatArray, speed: float, angle: float, count: int) -> tuple[FloatArray, float]:
    """Newton's method from the middle and from the best few starts; position and error [N, N m]."""
    best: tuple[FloatArray, float] = (np.zeros(FREE), np.inf)
    for start in _starts(law, wanted, speed, angle, count):
        found = _newton(of, start, wanted, speed, angle)
        best = min(best, found, key=lambda item: item[1])
        if best[1] <= _tolerance(wanted):
            break
    return best


def _unloading(
    law: BearingLaw, of: Derivatives, wanted: FloatArray, speed: float, angle: float, failed: tuple[FloatArray, float]
) -> tuple[FloatArray, float]:
    """From a load that is carried down to the one wanted: a contact found under more load is not lost on the way."""
    for factor in 10.0 ** np.arange(1, 8):
        at, error = _solve(law, of, factor * wanted, speed, angle, count=2)
        if error > _tolerance(factor * wanted):
            continue
        for part in np.geomspace(factor, 1.0, 1 + 40 * round(np.log10(factor))):
            at, error = _newton(of, at, part * wanted, speed, angle)
        return at, error
    return failed


def _starts(law: BearingLaw, wanted: FloatArray, speed: float, angle: float, count: int) -> Iterator[FloatArray]:
    """The middle, then places all round it at which the force along the load is right, the least wrong across first."""
    yield np.zeros(FREE)
    turns = np.arctan2(wanted[1], wanted[0]) + np.arange(48) * (2.0 * np.pi / 48)
    cosine, sine = np.cos(turns), np.sin(turns)
    size = np.hypot(wanted[0], wanted[1])
    along = wanted[:2] / size if size else np.array([1.0, 0.0])

    def forces(radius: FloatArray) -> FloatArray:
        return _radial(law, radius * cosine, radius * sine, speed, angle)

    high = np.full(len(turns), np.nan)
    low = np.zeros(len(turns))
    for radius in np.geomspace(1e-9, 1e-2, 57):
        reached = along @ forces(np.full(len(turns), radius)) >= size
        high = np.where(np.isnan(high) & reached, radius, high)
        low = np.where(np.isnan(high), radius, low)
    for _ in range(40):
        middle = 0.5 * (low + high)
        reached = along @ forces(middle) >= size
        low, high = np.where(reached, low, middle), np.where(reached, middle, high)
    error = np.linalg.norm(forces(high) - wanted[:2, None], axis=0)
    for k in np.argsort(error)[:count]:  # nan last
        if np.isfinite(error[k]):
            yield np.array([high[k] * cosine[k], high[k] * sine[k], 0.0, 0.0, 0.0])


def _radial(law: BearingLaw, x: FloatArray, y: FloatArray, speed: float, angle: float) -> FloatArray:
    """Forces in x and y at many places at rest, also of a law that takes single numbers only; (2, n)."""
    zero = np.zeros_like(x)
    motion = RelativeMotion(**{**dict.fromkeys(NAMES, zero), "x": x, "y": y, "angle": zero + angle, "speed": zero + speed})
    try:
        total = law.total_forces(motion)
        return np.array([total["x"] + zero, total["y"] + zero])
    except HdriveError:
        raise
    except Exception:
        points = [at_rest(np.array([a, b, 0.0, 0.0, 0.0]), speed, angle) for a, b in zip(x, y, strict=True)]
        return np.array([numbers(law, point)[:2] for point in points]).T


def _newton(of: Derivatives, position: FloatArray, wanted: FloatArray, speed: float, angle: float) -> tuple[FloatArray, float]:
    """Newton's method with least-squares steps and halving, until it no longer helps; position and error [N, N m]."""
    forces, stiffness, _ = of(at_rest(position, speed, angle))
    error = float(np.max(np.abs(forces - wanted)))
    for _ in range(100):
        if not (np.isfinite(error) and np.isfinite(stiffness).all()) or error == 0.0:
            break
        step = np.linalg.lstsq(stiffness, wanted - forces, rcond=1e-14)[0]
        for _halving in range(40):
            trial = position + step
            new_forces, new_stiffness, _ = of(at_rest(trial, speed, angle))
            new_error = float(np.max(np.abs(new_forces - wanted)))
            if new_error < error:
                break
            step = 0.5 * step
        else:
            break
        position, forces, stiffness, error = trial, new_forces, new_stiffness, new_error
    return position, error

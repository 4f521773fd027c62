"""The build-time guard: a lowered law must equal the plain function at random points.

Exudyn freezes what it cannot record without a word (a Python ``if``, ``float(x)``).  Recording by
our own expressions refuses those; this guard catches what is left: an operation whose symbolic
meaning differs, a law that is not a pure function.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any

import numpy as np

from hdrive_mbs.engine.records import CoupledRecord, ScalarRecord
from hdrive_mbs.errors import HdriveError, LawError
from hdrive_mbs.expression import Expression
from hdrive_mbs.network.moment import Moment

POINTS = 12
RELATIVE = 1e-9
_EXTRA = {"ObjectConnectorCoordinateSpringDamper": 3, "ObjectConnectorCoordinateSpringDamperExt": 9}


def _magnitudes(rng: np.random.Generator, low: float, high: float) -> np.ndarray:
    values = rng.choice((-1.0, 1.0), POINTS) * 10.0 ** rng.uniform(low, high, POINTS)
    values[0] = 0.0
    return values


def _differ(lowered: float, plain: float) -> bool:
    if np.isnan(lowered) and np.isnan(plain):
        return False
    if np.isinf(plain) or np.isinf(lowered):
        return lowered != plain
    return abs(lowered - plain) > RELATIVE * max(1.0, abs(plain), abs(lowered))


def _refuse(name: str, where: str, lowered: float, plain: float) -> LawError:
    return LawError(
        f"{name}: its lowered form gives {lowered:.9g} and the law itself {plain:.9g} at {where}. "
        "A law must be a pure function of its arguments: no counters, no random numbers, no look at their type, "
        "and no sums of comparisons (numpy adds True and True to True; write & and |)."
    )


@contextmanager
def _computing(name: str) -> Iterator[None]:
    try:
        yield
    except HdriveError:
        raise
    except Exception as error:
        raise LawError(
            f"{name}: the law can be recorded, but fails on numpy numbers ({type(error).__name__}: {error}). "
            "Comparisons are combined with &, | and ~, or turned into numbers by np.where."
        ) from error


def check_connector(mbs: Any, function: Any, kind: str, record: ScalarRecord) -> None:
    """Raise LawError where the symbolic connector function differs from the plain law."""
    extra = [0.0] * _EXTRA[kind]
    check_scalar(record, lambda t, x, v: float(function.Evaluate(mbs, t, 0, x, v, *extra)))


def check_scalar(record: ScalarRecord, lowered_law: Callable[[float, float, float], float]) -> None:
    """Raise LawError where what the engine computes differs from the plain law."""
    rng = np.random.default_rng(20141007)
    times, x, v = np.abs(_magnitudes(rng, -3, 2)), _magnitudes(rng, -5, 2), _magnitudes(rng, -5, 3)
    with np.errstate(all="ignore"):
        for t, xi, vi in zip(times, x, v, strict=True):
            with _computing(record.name):
                plain = float(record.plain(np.float64(t), np.float64(xi), np.float64(vi)))
            lowered = lowered_law(float(t), float(xi), float(vi))
            if _differ(lowered, plain):
                raise _refuse(record.name, f"t={t:.6g}, displacement={xi:.6g}, velocity={vi:.6g}", lowered, plain)


def check_coupling(
    mbs: Any, function: Any, record: CoupledRecord, names: Sequence[str], states: set[str], outputs: Mapping[str, Expression]
) -> None:
    """Raise LawError where the symbolic coupling differs from the plain law."""
    rng = np.random.default_rng(20141008)
    times = np.abs(_magnitudes(rng, -3, 2))
    q = {name: _magnitudes(rng, -5, 2) for name in names}
    q_t = {name: _magnitudes(rng, -5, 2) for name in names}
    with np.errstate(all="ignore"):
        for k, t in enumerate(times):
            speeds = {name: np.float64(q_t[name][k]) for name in names}
            moment = Moment(
                time=np.float64(t),
                angles={name: np.float64(q[name][k]) for name in names},
                speeds=speeds,
                states={name: speeds[name] for name in names if name in states},
            )
            with _computing(record.name):
                plain = {name: float(value) for name, value in record.plain(moment).items()}
            lowered = function.Evaluate(mbs, float(t), 0, [float(q[n][k]) for n in names], [float(q_t[n][k]) for n in names])
            for row, name in enumerate(names):
                expected = plain[name] if name in outputs else 0.0
                if _differ(float(lowered[row]), expected):
                    raise _refuse(f"{record.name} on {name}", f"t={t:.6g}", float(lowered[row]), expected)

"""The check of what laws promise: a law that calls itself dissipative must never deliver power."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import lru_cache

import numpy as np
import numpy.typing as npt

from hdrive_mbs.errors import LawError
from hdrive_mbs.expression import TraceError, Value, derivative, evaluate, record, variables
from hdrive_mbs.network.coupling import Coupling
from hdrive_mbs.network.elements import AppliedTorque, Claim, Connection
from hdrive_mbs.network.moment import Moment, recording_moment
from hdrive_mbs.network.network import Network, random_values

FloatArray = npt.NDArray[np.float64]

POINTS = 100
SEED = 20140101
ROUNDING = 1e-9
"""Share of the powers involved that rounding may hide."""


def check_claims(network: Network) -> None:
    """Raise LawError for a law that calls itself dissipative and delivers power.

    What is taken from the coordinates, less the growth of the energy that the law says it stores,
    must not be negative at random moments of all magnitudes.
    """
    elements = [element for element in network.elements if isinstance(element, (AppliedTorque, Connection, Coupling))]
    claims = [claim for element in elements for claim in element.claims()]
    if not claims:
        return
    moment = network.moment_of(_values(1 + 2 * len(network.bodies) + len(network.states)))
    rates = {equation.state: equation.rate for equation in network.state_equations()}
    with np.errstate(all="ignore"):
        for claim in claims:
            _check(claim, moment, rates)


@lru_cache(maxsize=16)
def _values(rows: int) -> tuple[FloatArray, ...]:
    """The same for all networks of one size; not to be changed."""
    found = tuple(random_values(np.random.default_rng(SEED), POINTS, rows))
    for values in found:
        values.setflags(write=False)
    return found


def _check(claim: Claim, moment: Moment, rates: Mapping[str, Callable[[Moment], Value]]) -> None:
    taken = _over(claim.power, moment)
    kept = _over(_growth(claim, rates), moment) if claim.stored is not None else np.zeros(POINTS)
    heat = taken - kept
    broken = ~(heat >= -ROUNDING * (np.abs(taken) + np.abs(kept)))
    if broken.any():
        worst = int(np.argmax(broken))
        stored = "" if claim.stored is None else f" (of {taken[worst]:.4g} W taken, {kept[worst]:.4g} W are stored)"
        raise LawError(
            f"{claim.name!r} claims to be dissipative but turns {heat[worst]:.4g} W into heat{stored} at {_where(moment, worst)}; "
            "it must be a number not below 0 W everywhere. A torque on a body counts along its forward sense, so friction opposes "
            "the speed; a torque at a connection resists. Turn its sign, or say dissipative = False."
        )


def _growth(claim: Claim, rates: Mapping[str, Callable[[Moment], Value]]) -> Callable[[Moment], Value]:
    """d(stored)/dt along the motion, by differentiation of the recorded energy."""
    assert claim.stored is not None
    try:
        energy = record(claim.stored(recording_moment()))
    except TraceError as error:
        raise LawError(f"{claim.name!r}: its stored energy must be written with numpy functions ({error}).") from None
    slopes = {name: derivative(energy, name) for name in sorted(variables(energy))}
    for name in slopes:
        if name.partition(":")[0] not in ("angle", "state"):
            raise LawError(f"{claim.name!r}: its stored energy depends on {name!r}; it may depend on angles and states only.")

    def growth(moment: Moment) -> Value:
        values = {f"angle:{name}": value for name, value in moment.angles.items()}
        values |= {f"state:{name}": value for name, value in moment.states.items()}
        total: Value = 0.0
        for path, slope in slopes.items():
            kind, _, name = path.partition(":")
            speed = moment.speed(name) if kind == "angle" else rates[name](moment)
            total = total + evaluate(slope, values) * speed
        return total

    return growth


def _over(function: Callable[[Moment], Value], moment: Moment) -> FloatArray:
    """A quantity at all moments; point by point where a law does not take arrays."""
    try:
        return np.broadcast_to(np.asarray(function(moment), float), (POINTS,))
    except (TypeError, ValueError):
        return np.array([float(function(_point(moment, k))) for k in range(POINTS)])


def _point(moment: Moment, k: int) -> Moment:
    def pick(values: Mapping[str, Value]) -> dict[str, Value]:
        return {name: np.broadcast_to(value, (POINTS,))[k] for name, value in values.items()}

    return Moment(
        time=moment.time[k],
        angles=pick(moment.angles),
        speeds=pick(moment.speeds),
        states=pick(moment.states),
    )


def _where(moment: Moment, k: int) -> str:
    point = _point(moment, k)
    values = [f"t = {point.time:.4g} s"]
    values += [f"angle of {name} {value:.4g} rad" for name, value in point.angles.items() if name != "ground"]
    values += [f"speed of {name} {value:.4g} rad/s" for name, value in point.speeds.items() if name != "ground"]
    values += [f"{name} = {value:.4g}" for name, value in point.states.items()]
    return ", ".join(values)

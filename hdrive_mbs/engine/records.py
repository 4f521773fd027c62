"""Elements of a network as records: expressions where the law can be recorded, else plain calls."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from hdrive_mbs.engine.symbolic import SYMBOLIC_VECTOR_LIMIT
from hdrive_mbs.errors import HdriveError, LawError
from hdrive_mbs.expression import Expression, TraceError, Value, derivative, evaluate, record, trace, variable, variables
from hdrive_mbs.network.coupling import Coupling
from hdrive_mbs.network.elements import AppliedTorque, Connection, Element, StateRate
from hdrive_mbs.network.moment import Moment, recording_moment
from hdrive_mbs.network.network import Network
from hdrive_mbs.network.stretch_rate import StretchRate

ScalarLaw = Callable[[Value, Value, Value], Value]


@dataclass(frozen=True)
class ScalarRecord:
    """A torque along one linear combination of coordinates: f(t, x, v) with x = sum(f_i q_i).

    expression : over ``t``, ``x``, ``v``; None where the law could not be recorded
    plain : the law itself, for the guard and as the fallback
    """

    name: str
    factors: Mapping[str, float]
    expression: Expression | None
    plain: ScalarLaw
    reason: str = ""

    def linear(self) -> tuple[float, float] | None:
        """(stiffness, damping) where the law is exactly k x + d v, else None."""
        if self.expression is None or "t" in variables(self.expression):
            return None
        k, d = (derivative(self.expression, name) for name in "xv")
        if variables(k, d):
            return None
        offset = evaluate(self.expression, {"x": 0.0, "v": 0.0})
        probe = evaluate(self.expression, {"x": 3.0, "v": -7.0})
        if offset != 0.0 or not np.isclose(probe, 3.0 * k.data - 7.0 * d.data, rtol=1e-12, atol=0.0):
            return None
        return float(k.data), float(d.data)


@dataclass(frozen=True)
class CoupledRecord:
    """Torques and state rates that depend on several coordinates.

    outputs : target -> expression over ``t``, ``angle:*``, ``speed:*``, ``state:*``; None if not recorded
    depends : coordinates and states that the law looks at
    stretches : coordinates of the engine's own that follow a sum of others: name -> factors
    """

    name: str
    targets: tuple[str, ...]
    outputs: Mapping[str, Expression] | None
    depends: tuple[str, ...]
    plain: Callable[[Moment], dict[str, Value]]
    reason: str = ""
    stretches: Mapping[str, Mapping[str, float]] = field(default_factory=dict)


def renamed(coupled: CoupledRecord, names: Mapping[str, str]) -> CoupledRecord:
    """The record with other names for coordinates that it reads or acts on."""
    assert coupled.outputs is not None
    given = {f"{kind}:{old}": variable(f"{kind}:{new}") for kind in ("angle", "speed") for old, new in names.items()}
    former = {new: old for old, new in names.items()}

    def substituted(expression: Expression) -> Expression:
        return record(evaluate(expression, {name: given.get(name, variable(name)) for name in variables(expression)}))

    def plain(moment: Moment) -> dict[str, Value]:
        angles, speeds = ({former.get(name, name): value for name, value in item.items()} for item in (moment.angles, moment.speeds))
        result = coupled.plain(Moment(time=moment.time, angles=angles, speeds=speeds, states=moment.states))
        return {names.get(name, name): value for name, value in result.items()}

    outputs = {names.get(name, name): substituted(item) for name, item in coupled.outputs.items()}
    targets, depends = (tuple(names.get(name, name) for name in item) for item in (coupled.targets, coupled.depends))
    return CoupledRecord(coupled.name, targets, outputs, depends, plain, coupled.reason, coupled.stretches)


class _Looked(Mapping[str, float]):
    """A mapping of small numbers that remembers which names a law looked at."""

    def __init__(self, seen: dict[str, None]) -> None:
        self._seen = seen

    def __getitem__(self, name: str) -> float:
        self._seen[name] = None
        return 1e-3

    def __iter__(self) -> Iterator[str]:
        return iter(self._seen)

    def __len__(self) -> int:
        return len(self._seen)


def _looked_at(name: str, function: Callable[[Moment], Iterable[Value]]) -> tuple[str, ...]:
    """Names that a law looks at when it computes with plain numbers.

    Raises LawError where it does not give numbers.
    """
    seen: dict[str, None] = {}
    looked = _Looked(seen)
    try:
        for value in function(Moment(time=1e-3, angles=looked, speeds=looked, states=looked)):
            if np.ndim(value) != 0:
                raise TypeError(f"it gives an array of shape {np.shape(value)}, not a number")
            float(value)
    except HdriveError:
        raise
    except Exception as error:
        raise LawError(f"{name}: the law fails on plain numbers ({type(error).__name__}: {error}). Correct the function.") from error
    return tuple(seen)


def make_records(element: Element, network: Network, *, follow: bool = True) -> list[ScalarRecord | CoupledRecord]:
    """The simplest records of an element: scalar if its law allows, else coupled.

    A coupling is taken apart: each force that depends on its own stretch alone becomes a scalar record.
    follow : whether stretches of a law over too many coordinates may become coordinates (see CoupledRecord.stretches)
    """
    if isinstance(element, Coupling):
        return [record for part in _taken_apart(element) for record in make_records(part, network, follow=follow)]
    scalar = _scalar(element, network)
    if scalar is not None:
        return [scalar]
    coupled = _coupled(element, network)
    return [_narrowed(element, coupled, network) if follow and isinstance(element, (_Rest, StretchRate)) else coupled]


def _is_wide(coupled: CoupledRecord) -> bool:
    """Whether it touches more coordinates than a symbolic law can."""
    return len({*coupled.targets, *coupled.depends}) > SYMBOLIC_VECTOR_LIMIT


def _narrowed(part: _Rest | StretchRate, wide: CoupledRecord, network: Network) -> CoupledRecord:
    """The record over the stretches themselves where the law is too wide over their coordinates."""
    if wide.outputs is None or not _is_wide(wide):
        return wide
    given = {motion.name for motion in network.motions}
    stretches = part.stretches
    own = {key: f"{part.of}.{key}~" for key, factors in stretches.items() if len(factors) > 1 and not given & set(factors)}
    over = {key: {own[key]: 1.0} if key in own else factors for key, factors in stretches.items()}
    narrow = _coupled(part.over(over), network, own.values())
    if narrow.outputs is None or _is_wide(narrow):
        return wide
    touched = {*narrow.targets, *narrow.depends}
    return replace(narrow, stretches={name: stretches[key] for key, name in own.items() if name in touched})


def _taken_apart(coupling: Coupling) -> list[Element]:
    """Connections for the forces along one stretch, and what is left as one element."""
    s = {key: variable(f"s:{key}") for key in coupling.stretches}
    v = {key: variable(f"v:{key}") for key in coupling.stretches}
    traced: dict[str, Value] = {}

    def total(moment: Moment) -> Value:
        traced.update(coupling.forces(moment, s, v))
        return 0.0

    try:
        trace(total, recording_moment())
        recorded = {key: record(value) for key, value in traced.items()}
    except TraceError:
        return [_Rest(coupling, None)]
    single = {key for key, item in recorded.items() if variables(item) <= {"t", f"s:{key}", f"v:{key}"}}
    parts: list[Element] = [_along(coupling, key, recorded[key]) for key in recorded if key in single]
    rest = {key: item for key, item in recorded.items() if key not in single}
    return [*parts, _Rest(coupling, rest)] if rest else parts


def _along(coupling: Coupling, key: str, force: Expression) -> Connection:
    def law(moment: Moment, x: Value, v: Value) -> Value:
        return evaluate(force, {"t": moment.time, f"s:{key}": x, f"v:{key}": v})

    return Connection(f"{coupling.name}_{key}", dict(coupling.stretches[key]), law)


@dataclass(frozen=True)
class _Rest:
    """What is left of a coupling: the named directions, or all of it where it could not be recorded."""

    coupling: Coupling
    directions: Mapping[str, Expression] | None

    @property
    def name(self) -> str:
        return self.coupling.name

    @property
    def of(self) -> str:
        """Whose stretches they are."""
        return self.coupling.name

    @property
    def stretches(self) -> Mapping[str, Mapping[str, float]]:
        return self.coupling.stretches

    def over(self, stretches: Mapping[str, Mapping[str, float]]) -> _Rest:
        """The same with stretches of other coordinates."""
        return _Rest(replace(self.coupling, stretches=stretches), self.directions)

    def contribution(self, moment: Moment) -> dict[str, Value]:
        if self.directions is None:
            return self.coupling.contribution(moment)
        result: dict[str, Value] = {}
        forces = self.coupling.values(moment)
        for key in self.directions:
            for name, factor in self.coupling.stretches[key].items():
                result[name] = result.get(name, 0.0) - factor * forces[key]
        return result


def oriented(coupled: CoupledRecord, signs: Mapping[str, int]) -> CoupledRecord:
    """The record with the engine's sense of each coordinate in place of the forward one."""
    turned = {name for name in (*coupled.targets, *coupled.depends) if signs.get(name, 1) < 0}
    if not turned:
        return coupled
    given = {f"{kind}:{name}": -variable(f"{kind}:{name}") for name in turned for kind in ("angle", "speed")}

    def sensed(values: Mapping[str, Value]) -> dict[str, Value]:
        return {name: -value if name in turned else value for name, value in values.items()}

    def plain(moment: Moment) -> dict[str, Value]:
        forward = Moment(time=moment.time, angles=sensed(moment.angles), speeds=sensed(moment.speeds), states=moment.states)
        return sensed(coupled.plain(forward))

    def substituted(expression: Expression) -> Expression:
        known = {name: given.get(name, variable(name)) for name in variables(expression)}
        return record(evaluate(expression, known))

    outputs = None
    if coupled.outputs is not None:
        outputs = {name: record(value) for name, value in sensed({k: substituted(e) for k, e in coupled.outputs.items()}).items()}
    return CoupledRecord(coupled.name, coupled.targets, outputs, coupled.depends, plain, coupled.reason, coupled.stretches)


def _scalar_form(element: Element) -> tuple[dict[str, float], Callable[[Moment, Value, Value], Value]] | None:
    """Factors and f(moment, x, v) that resists, where x is a linear combination of coordinates."""
    if isinstance(element, Connection):
        return None if element.terms else (dict(element.factors), element.torque)
    if isinstance(element, AppliedTorque):
        c = element.coordinate
        return {c: 1.0}, lambda m, x, v: -element.torque(_overlay(m, c, x, v))
    if isinstance(element, StateRate):
        s = element.state
        return {s: 1.0}, lambda m, x, v: -element.rate(Moment(time=m.time, angles=m.angles, speeds=m.speeds, states=_Over(m.states, s, v)))
    return None


class _Over(Mapping[str, Value]):
    def __init__(self, base: Mapping[str, Value], name: str, value: Value) -> None:
        self._base, self._name, self._value = base, name, value

    def __getitem__(self, name: str) -> Value:
        return self._value if name == self._name else self._base[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._base)

    def __len__(self) -> int:
        return len(self._base)


def _overlay(m: Moment, name: str, x: Value, v: Value) -> Moment:
    return Moment(time=m.time, angles=_Over(m.angles, name, x), speeds=_Over(m.speeds, name, v), states=m.states)


def _zeros(network: Network) -> dict[str, float]:
    return dict.fromkeys([item.name for item in (*network.bodies, *network.motions, *network.states)], 0.0)


def _scalar(element: Element, network: Network) -> ScalarRecord | None:
    form = _scalar_form(element)
    if form is None:
        return None
    factors, law = form
    prescribed = {motion.name: motion for motion in network.motions}
    moving = {name: f for name, f in factors.items() if name not in prescribed and f != 0.0}
    driven = [(f, prescribed[name]) for name, f in factors.items() if name in prescribed and name != "ground"]
    rest = _zeros(network)  # the law may name what it multiplies by zero
    if len(moving) > 2 or not moving:
        return None

    def plain(t: Value, x: Value, v: Value) -> Value:
        shift = sum(f * motion.angle(t) for f, motion in driven)
        drift = sum(f * motion.speed(t) for f, motion in driven)
        return law(Moment(time=t, angles=rest, speeds=rest, states=rest), x + shift, v + drift)

    reason = ""
    expression: Expression | None = None
    try:
        symbols = recording_moment()
        traced = trace(law, symbols, variable("x"), variable("v"))
        if not variables(traced) <= {"t", "x", "v"}:
            return None
        t = variable("t")
        x: Value = variable("x") + sum(f * motion.angle(t) for f, motion in driven)
        v: Value = variable("v") + sum(f * motion.speed(t) for f, motion in driven)
        expression = record(evaluate(traced, {"t": t, "x": x, "v": v}))
    except TraceError as error:
        reason = str(error)
        if _looked_at(element.name, lambda m: [law(m, 1e-3, 1e-3)]):
            return None
    return ScalarRecord(element.name, moving, expression, plain, reason)


def _traced(element: Element, symbols: Moment) -> dict[str, Value]:
    result: dict[str, Value] = {}

    def total(moment: Moment) -> Value:
        result.update(element.contribution(moment))
        return 0.0

    trace(total, symbols)
    return result


def _coupled(element: Element, network: Network, own: Iterable[str] = ()) -> CoupledRecord:
    prescribed = {motion.name: motion for motion in network.motions}
    kept = {body.name for body in network.bodies} | {state.name for state in network.states} | set(own)
    rest = _zeros(network)  # the law may name what it multiplies by zero

    def plain(moment: Moment) -> dict[str, Value]:
        full = network.moment(moment.time, {**rest, **moment.angles}, {**rest, **moment.speeds}, {**rest, **moment.states})
        return {name: value for name, value in element.contribution(full).items() if name in kept}

    try:
        symbols = recording_moment()
        raw = _traced(element, symbols)
        time = symbols.time
        given: dict[str, Value] = {}
        traced = {name: record(value) for name, value in raw.items() if name in kept}
        for name in variables(*traced.values()):
            kind, _, owner = name.partition(":")
            motion = prescribed.get(owner)
            if motion is not None and kind == "angle":
                given[name] = motion.angle(time)
            elif motion is not None and kind == "speed":
                given[name] = motion.speed(time)
            else:
                given[name] = time if name == "t" else variable(name)
        outputs = {name: record(evaluate(item, given)) for name, item in traced.items()}
        depends = tuple(dict.fromkeys(n.partition(":")[2] for n in sorted(variables(*outputs.values())) if n != "t"))
        return CoupledRecord(element.name, tuple(outputs), outputs, depends, plain)
    except TraceError as error:
        seen = tuple(name for name in _looked_at(element.name, lambda m: element.contribution(m).values()) if name in kept)
        probe = Moment(time=1e-3, angles=dict.fromkeys(kept, 1e-3), speeds=dict.fromkeys(kept, 1e-3), states=dict.fromkeys(kept, 1e-3))
        return CoupledRecord(element.name, tuple(plain(probe)), None, seen, plain, str(error))

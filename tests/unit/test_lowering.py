"""Laws in the engine: symbolic where possible, guarded, else a Python callback that says why."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import exudyn
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import hdrive_mbs as hm
from hdrive_mbs.components.component import Component
from hdrive_mbs.engine.assembly import assemble
from hdrive_mbs.engine.symbolic import SYMBOLIC_VECTOR_LIMIT, connector_function, generic_function
from hdrive_mbs.errors import LawError, ParameterError, SimulationError
from hdrive_mbs.expression import Expression, constant, evaluate, record, variable
from hdrive_mbs.expression.node import NUMERIC
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.quantities import option

PLAIN = "ObjectConnectorCoordinateSpringDamper"
GEARED = "ObjectConnectorCoordinateSpringDamperExt"
EXTRA = {PLAIN: [0.0] * 3, GEARED: [0.0] * 9}
x, v, t = variable("x"), variable("v"), variable("t")
POINTS = (-2.5, -1.0, -0.3, -0.0, 0.0, 1e-9, 0.3, 1.0, 2.0, 3.75)


@pytest.fixture(scope="module")
def mbs() -> Any:
    container = exudyn.SystemContainer()
    system = container.AddSystem()
    system.variables["kept"] = container
    return system


def evaluator(mbs: Any, law: Expression, kind: str = PLAIN) -> Callable[[float, float, float], float]:
    function = connector_function(mbs, kind, law)
    return lambda at_t, at_x, at_v: float(function.Evaluate(mbs, float(at_t), 0, float(at_x), float(at_v), *EXTRA[kind]))


def assert_same(got: float, want: float) -> None:
    if math.isnan(want) or math.isinf(want):
        assert got == want or (math.isnan(got) and math.isnan(want))
    else:
        assert got == pytest.approx(want, rel=1e-13, abs=1e-15)  # another libm, another last bit


@pytest.mark.parametrize("operation", NUMERIC)
def test_every_operation_means_the_same_in_the_engine(mbs: Any, operation: str) -> None:
    function = NUMERIC[operation]
    arguments = (x, v, constant(7.0))[: function.nin if isinstance(function, np.ufunc) else 3]
    if operation in ("and", "or"):
        arguments = (x < 0.5, v <= 0.0)
    if operation == "where":
        arguments = (x < v, x, v)
    law = Expression(operation, arguments)
    run = evaluator(mbs, law)
    with np.errstate(all="ignore"):
        for at_x in POINTS:
            for at_v in POINTS if len(arguments) > 1 else POINTS[:1]:
                values = {"x": np.float64(at_x), "v": np.float64(at_v)}
                assert_same(run(0.0, at_x, at_v), float(evaluate(law, values)))


@pytest.mark.parametrize("kind", [PLAIN, GEARED])
@pytest.mark.parametrize(
    "law",
    [
        lambda t, x, v: 5.0,
        lambda t, x, v: x,
        lambda t, x, v: -v,
        lambda t, x, v: t,
        lambda t, x, v: np.where((x > 0.0) & ~(v > 1.0) | (t == 0.5), x**3, np.abs(v) ** 1.5),
        lambda t, x, v: np.interp(x, [-1.0, 0.0, 0.0, 2.0], [2.0, 1.0, -1.0, 5.0]),
        lambda t, x, v: np.mod(x, 0.75) + np.fmod(v, 0.6) + np.clip(t, 0.1, 0.2),
        lambda t, x, v: np.hypot(x, v) * np.heaviside(x, 0.5) + np.copysign(2.0, v + 1e-300),
        lambda t, x, v: np.logical_and(x, v) * 2.0 + np.logical_or(x, v - v) * 4.0,
        lambda t, x, v: np.select([x > 1.0, v > 1.0], [v, x], default=t),
        lambda t, x, v: np.trunc(x) + np.expm1(v) + np.log1p(np.abs(x)) + np.cbrt(v),
    ],
)
def test_whole_laws_mean_the_same_in_the_engine(mbs: Any, law: Callable[..., Any], kind: str) -> None:
    recorded = record(law(t, x, v))
    run = evaluator(mbs, recorded, kind)
    for at_t in (0.0, 0.15, 0.5):
        for at_x in POINTS:
            for at_v in POINTS:
                values = {"t": np.float64(at_t), "x": np.float64(at_x), "v": np.float64(at_v)}
                assert_same(run(at_t, at_x, at_v), float(evaluate(recorded, values)))


@settings(max_examples=40, deadline=None, derandomize=True)
@given(
    st.lists(st.floats(-3.0, 3.0).map(lambda value: round(value, 2)), min_size=2, max_size=30, unique=True).map(sorted),
    st.integers(0, 2**31),
)
def test_tables_of_any_length_mean_the_same_in_the_engine(mbs: Any, xs: Sequence[float], seed: int) -> None:
    ys = np.random.default_rng(seed).normal(size=len(xs))
    run = evaluator(mbs, record(np.interp(x, xs, ys)))
    at = np.concatenate((xs, np.linspace(-4.0, 4.0, 23)))
    np.testing.assert_allclose([run(0.0, value, 0.0) for value in at], np.interp(at, xs, ys), rtol=1e-12, atol=1e-12)


def test_a_coupling_of_six_coordinates_means_the_same_in_the_engine(mbs: Any) -> None:
    names = [f"angle:{k}" for k in range(6)]
    q = [variable(name) for name in names]
    rates = [variable(f"speed:{k}") for k in range(6)]
    outputs = [record(np.sin(q[k]) * rates[(k + 1) % 6] + t) for k in range(5)] + [constant(0.0)]
    function = generic_function(mbs, outputs, names, [f"speed:{k}" for k in range(6)])
    rng = np.random.default_rng(3)
    at_q, at_v = rng.normal(size=6), rng.normal(size=6)
    got = function.Evaluate(mbs, 0.25, 0, list(at_q), list(at_v))
    want = [np.sin(at_q[k]) * at_v[(k + 1) % 6] + 0.25 for k in range(5)] + [0.0]
    np.testing.assert_allclose(got, want, rtol=1e-14)


def test_more_coordinates_than_exudyn_s_symbolic_vectors_hold_are_refused(mbs: Any) -> None:
    names = [f"angle:{k}" for k in range(SYMBOLIC_VECTOR_LIMIT + 1)]
    with pytest.raises(ValueError, match="limit of 6"):
        generic_function(mbs, [variable(name) for name in names], names, [""] * len(names))


# -- a user's laws --------------------------------------------------------------------------------


def motor(characteristic: Any, inertia: float = 0.1) -> hm.Scene:
    return hm.Scene(name="a rotor", parts={"motor": hm.Motor(inertia=inertia, characteristic=characteristic)}, connections=[])


def cosine(speed: float) -> float:
    return math.cos(speed) - 0.5


def branches(speed: float) -> float:
    return 1.0 - speed if speed < 0.5 else 0.5


def table(speed: float) -> float:
    return {0: 1.0, 1: 0.5}.get(int(speed * 2.0), 0.0)


def summed(speed: float) -> float:
    return np.sum([1.0, -2.0 * speed])


def largest(speed: float) -> float:
    return np.max([1.0 - speed, 0.25])


UNTRACEABLE: dict[str, tuple[Callable[[float], float], Callable[[Any], Any], str]] = {
    "math.cos": (cosine, lambda w: np.cos(w) - 0.5, "numpy function"),
    "if": (branches, lambda w: np.where(w < 0.5, 1.0 - w, 0.5), "np.where"),
    "int and a dictionary": (table, lambda w: np.select([w < 0.5, w < 1.0], [1.0, 0.5], 0.0), "np.floor"),
    "np.sum of a list": (summed, lambda w: 1.0 - 2.0 * w, "array"),
    "np.max of a list": (largest, lambda w: np.maximum(1.0 - w, 0.25), "array"),
}


@pytest.mark.parametrize("name", UNTRACEABLE)
def test_an_unrecordable_law_runs_as_a_callback_says_why_and_gives_what_its_recordable_twin_gives(name: str) -> None:
    law, twin, reason = UNTRACEABLE[name]
    solver = hm.RungeKutta4(step=1e-2)
    with pytest.warns(hm.LoweringWarning, match=rf"motor\.torque: .*Python callback.*{reason}"):
        slow = hm.simulate(motor(law), 1.0, solver=solver)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        fast = hm.simulate(motor(twin), 1.0, solver=solver)
    assert slow.lowering["motor.torque"] == "python"
    assert fast.lowering["motor.torque"] in ("symbolic", "native")
    # the same steps of the same method; what differs is the last bit of an operation, over 400 evaluations
    for channel in ("motor.speed", "motor.angle", "motor.torque", "motor.acceleration"):
        np.testing.assert_allclose(slow[channel].values, fast[channel].values, rtol=1e-12, atol=1e-12)


def test_the_fallback_may_depend_on_several_coordinates() -> None:
    @dataclass(frozen=True, kw_only=True)
    class Follower(Component):
        """A torque that pulls one body after another, in plain or in numpy mathematics."""

        sine: Any = option("sine function")

        def build(self, name: str, draft: Draft) -> None:
            def torque(moment: Moment) -> Any:
                return 3.0 * self.sine(moment.angle("leader") - moment.angle("follower")) - 0.1 * moment.speed("follower") + moment.time

            draft.add_torque(f"{name}.torque", "follower", torque)
            draft.add_channel(f"{name}.torque", "N m", "pull", torque)

    def scene(sine: Any) -> hm.Scene:
        parts = {
            "leader": hm.Inertia(inertia=1.0),
            "shaft": hm.Shaft(stiffness=50.0),
            "follower": hm.Inertia(inertia=2.0),
            "pull": Follower(sine=sine),
        }
        return hm.Scene(name="pull", parts=parts, connections=[("leader", "shaft", "follower")])

    start = {"leader.speed": 2.0}
    solver = hm.RungeKutta4(step=1e-3)
    with pytest.warns(hm.LoweringWarning, match=r"pull\.torque"):
        slow = hm.simulate(scene(math.sin), 0.5, initial=start, solver=solver)
    fast = hm.simulate(scene(np.sin), 0.5, initial=start, solver=solver)
    assert (slow.lowering["pull.torque"], fast.lowering["pull.torque"]) == ("python", "symbolic")
    for name in fast.channels:
        np.testing.assert_allclose(slow[name].values, fast[name].values, rtol=1e-10, atol=1e-12)


def test_lowering_python_gives_the_same_response_as_symbolic() -> None:
    scene = motor(lambda w: np.where(w > 0.3, 1.0 - w, np.exp(-w)))
    symbolic = hm.simulate(scene, 1.0, solver=hm.RungeKutta4(step=1e-2))
    python = hm.simulate(scene, 1.0, solver=hm.RungeKutta4(step=1e-2), lowering="python")
    assert (symbolic.lowering["motor.torque"], python.lowering["motor.torque"]) == ("symbolic", "python")
    np.testing.assert_allclose(symbolic["motor.speed"].values, python["motor.speed"].values, rtol=1e-13)


def test_an_unknown_lowering_is_refused() -> None:
    with pytest.raises(ParameterError, match="'symbolic' or 'python'"):
        hm.simulate(motor(lambda w: -w), 1.0, lowering="compiled")


def test_linear_laws_become_native_springs_and_dampers() -> None:
    parts = {"disc": hm.Inertia(inertia=1.0, viscous=2.0), "shaft": hm.Shaft(stiffness=9.0, damping=1.0)}
    scene = hm.Scene(name="x", parts=parts, connections=[("disc", "shaft", "ground")])
    assert {item.element: item.how for item in assemble(scene.network()).lowered} == {"shaft": "native", "disc.viscous": "native"}


def test_a_law_that_uses_its_own_result_many_times_stays_a_compiled_callback() -> None:
    def chaotic(speed: Any) -> Any:
        value = 0.1 * speed
        for _ in range(30):  # 2^30 operations when written out
            value = value * (1.0 - value) * 0.5 + 0.1
        return value

    with pytest.warns(hm.LoweringWarning, match="operations"):
        response = hm.simulate(motor(chaotic), 0.1)
    assert response.lowering["motor.torque"] == "python"
    assert response["motor.torque"].values[-1] == pytest.approx(float(chaotic(response["motor.speed"].values[-1])), rel=1e-12)


# -- couplings of many coordinates ------------------------------------------------------------------


@dataclass(frozen=True, kw_only=True)
class MeanPull(Component):
    """Springs from each of several bodies to their mean angle, nonlinear in all of them at once."""

    bodies: tuple[str, ...] = option("names of the bodies")

    def build(self, name: str, draft: Draft) -> None:
        count = len(self.bodies)

        def pull(body: str) -> Callable[[Moment], Any]:
            def torque(moment: Moment) -> Any:
                mean = sum(moment.angle(other) for other in self.bodies) / count
                return -4.0 * np.sin(moment.angle(body) - mean) - 0.1 * moment.speed(body)

            return torque

        for body in self.bodies:
            draft.add_torque(f"{name}.{body}", body, pull(body))


def swarm(count: int) -> hm.Scene:
    bodies = tuple(f"disc_{k}" for k in range(count))
    parts: dict[str, Component] = {name: hm.Inertia(inertia=1.0 + 0.1 * k) for k, name in enumerate(bodies)}
    for k in range(count - 1):
        parts[f"shaft_{k}"] = hm.Shaft(stiffness=3.0 + k)
    parts["pull"] = MeanPull(bodies=bodies)
    chain = [part for k in range(count - 1) for part in (f"disc_{k}", f"shaft_{k}")] + [bodies[-1]]
    return hm.Scene(name=f"{count} discs", parts=parts, connections=[chain])


def swarm_reference(count: int, duration: float, start: float) -> np.ndarray:
    """Angles of the swarm at the end, by scipy from equations written out by hand."""
    from scipy.integrate import solve_ivp

    inertia = 1.0 + 0.1 * np.arange(count)
    stiffness = 3.0 + np.arange(count - 1)

    def rates(_: float, state: np.ndarray) -> np.ndarray:
        q, w = state[:count], state[count:]
        torque = -4.0 * np.sin(q - q.mean()) - 0.1 * w
        shaft = stiffness * (q[:-1] - q[1:])
        torque[:-1] -= shaft
        torque[1:] += shaft
        return np.concatenate((w, torque / inertia))

    first = np.zeros(2 * count)
    first[count] = start
    return np.asarray(solve_ivp(rates, (0.0, duration), first, method="DOP853", rtol=1e-11, atol=1e-12).y[:count, -1])


@pytest.mark.parametrize(("count", "how"), [(6, "symbolic"), (7, "python"), (10, "python")])
def test_couplings_of_many_coordinates_are_solved_and_above_six_as_callbacks(count: int, how: str) -> None:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        response = hm.simulate(
            swarm(count), 1.0, initial={"disc_0.speed": 2.0}, solver=hm.DormandPrince(relative_tolerance=1e-10, absolute_tolerance=1e-11)
        )
    messages = [str(item.message) for item in caught if issubclass(item.category, hm.LoweringWarning)]
    assert response.lowering["pull.disc_0"] == how
    assert (f"couples {count} coordinates, more than 6" in " ".join(messages)) == (how == "python")
    final = [response[f"disc_{k}.angle"].values[-1] for k in range(count)]
    np.testing.assert_allclose(final, swarm_reference(count, 1.0, 2.0), rtol=1e-7, atol=1e-8)  # both solvers: 1e-10 a step, 1e3 steps


# -- the guard and bad laws -------------------------------------------------------------------------


def counter() -> Callable[[Any], Any]:
    calls = [0]

    def law(speed: Any) -> Any:
        calls[0] += 1
        return calls[0] * speed

    return law


def noise() -> Callable[[Any], Any]:
    rng = np.random.default_rng(1)
    return lambda speed: rng.normal() - speed


IMPURE: dict[str, Callable[[Any], Any]] = {
    "counts its calls": counter(),
    "random": noise(),
    "looks at the type": lambda w: 1.0 - w if isinstance(w, Expression) else 2.0 - w,
    "adds comparisons": lambda w: ((w > -1.0) + (w > -2.0)) * 1.0,
}


@pytest.mark.parametrize("way", IMPURE)
def test_the_guard_refuses_a_law_that_is_not_a_pure_function(way: str) -> None:
    with pytest.raises(LawError, match=r"motor\.torque: its lowered form gives .* and the law itself .* pure function"):
        hm.simulate(motor(IMPURE[way]), 0.1)


def test_the_guard_refuses_an_impure_law_of_several_coordinates() -> None:
    @dataclass(frozen=True, kw_only=True)
    class Drift(Component):
        def build(self, name: str, draft: Draft) -> None:
            calls = [0]

            def torque(moment: Moment) -> Any:
                calls[0] += 1
                return np.sin(moment.angle("a") - 2.0 * moment.angle("b")) + calls[0]

            draft.add_torque(f"{name}.torque", "a", torque)

    parts = {"a": hm.Inertia(inertia=1.0), "s": hm.Shaft(stiffness=1.0), "b": hm.Inertia(inertia=1.0), "drift": Drift()}
    with pytest.raises(LawError, match=r"drift\.torque on a: its lowered form"):
        hm.simulate(hm.Scene(name="x", parts=parts, connections=[("a", "s", "b")]), 0.1)


def test_a_law_that_can_be_recorded_but_not_computed_is_refused_with_the_way_out() -> None:
    # a common way to write a sign; numpy has no minus for its booleans
    with pytest.raises(LawError, match=r"motor\.torque: .*fails on numpy numbers .*np\.where"):
        hm.simulate(motor(lambda w: ((w > 0.0) * 1.0 + (-1.0) * (w < 0.0)) * ((w > 0.0) - (w < 0.0))), 0.1)


BROKEN: dict[str, tuple[Callable[..., Any], str]] = {
    "raises": (lambda w: 1 / 0, "ZeroDivisionError: division by zero"),
    "returns None": (lambda w: None, "NoneType"),
    "returns a text": (lambda w: "5", "str"),
    "returns an array": (lambda w: np.array([1.0, 2.0]), r"array of shape \(2,\)"),
    "returns an array of one": (lambda w: np.array([1.0]), r"array of shape \(1,\)"),
    "returns a complex number": (lambda w: 1j, "complex"),
    "calls a method that numbers do not have": (lambda w: w.ravel()[0], "'float' object has no attribute 'ravel'"),
}


@pytest.mark.parametrize("way", BROKEN)
def test_a_law_that_does_not_give_numbers_is_refused_by_name(way: str) -> None:
    law, reason = BROKEN[way]
    with pytest.raises(LawError, match=rf"motor\.torque: .*{reason}"):
        hm.simulate(motor(law), 0.1)


def test_a_law_that_fails_during_the_run_is_named_with_the_time_and_its_own_error(capfd: pytest.CaptureFixture[str]) -> None:
    def law(speed: float) -> float:
        return math.sqrt(0.5 - speed)

    # J dw/dt = sqrt(0.5 - w): w = 0.5 at t = 2 J sqrt(0.5) = 0.1414 s
    with (
        pytest.warns(hm.LoweringWarning),
        pytest.raises(SimulationError, match=r"motor\.torque fails at t = 0\.1\d* s \(ValueError: math domain"),
    ):
        hm.simulate(motor(law), 1.0)
    assert capfd.readouterr().out == ""  # exudyn's own banner would spoil what a command writes to its output

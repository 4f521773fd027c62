"""What a search for a cause relies on: sizes that can be zero, starts that are allowed, laws that fixed steps can follow."""

from __future__ import annotations

import dataclasses
import functools
import importlib
import inspect
import math
import pkgutil
from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest

import hdrive_mbs as hm
import hdrive_mbs.effects
from hdrive_mbs.compiled.line import CompiledLine
from hdrive_mbs.diagnosis.candidates import candidates, known_effects
from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.effects.fast_sliding import FASTEST_RATE, followed_share, mixed
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.network.network import Network
from hdrive_mbs.quantity import Quantity
from models import drive_bench, rotor_bench

STEP = 2.5e-4
"""Half a sample of the drive bench [s]: the step of a search."""


def effects_of_package() -> list[type[Effect]]:
    """Every concrete effect that the package defines."""
    for module in pkgutil.walk_packages(hdrive_mbs.effects.__path__, "hdrive_mbs.effects."):
        importlib.import_module(module.name)
    found, stack = set(), [Effect]
    while stack:
        kind = stack.pop()
        stack += kind.__subclasses__()
        if kind.__module__.startswith("hdrive_mbs.effects.") and not inspect.isabstract(kind):
            found.add(kind)
    return sorted(found, key=lambda kind: kind.__name__)


NOT_SEARCHED = {"ExternalShock", "SensorQuantisation"}
"""A knock whose time, and steps whose height, would have to be known before."""
EFFECTS = [kind for kind in effects_of_package() if kind.__name__ not in NOT_SEARCHED]
every_effect = pytest.mark.parametrize("kind", EFFECTS, ids=lambda kind: kind.__name__)


def quantities(kind: type[Effect]) -> dict[str, Quantity]:
    """Numbers of an effect."""
    return {f.name: f.metadata["quantity"] for f in kind.__dataclass_fields__.values() if "quantity" in f.metadata}


def strengths(kind: type[Effect]) -> list[str]:
    """Fields that a search varies, may be zero and are so unless told otherwise: the effect is gone where all are."""
    return [
        name
        for name, quantity in quantities(kind).items()
        if quantity.typical is not None
        and quantity.above is None
        and quantity.low is not None
        and quantity.low <= 0.0
        and kind.__dataclass_fields__[name].default in (0.0, dataclasses.MISSING)
    ]


def started(kind: type[Effect], **fields: Any) -> Effect:
    """The effect where a search may begin: starts, else the middle of the typical range, else the default."""
    values: dict[str, Any] = {name: options[-1] for name, options in kind.starts.items()}
    for name, quantity in quantities(kind).items():
        if name in values or quantity.typical is None:
            continue
        low, high = quantity.typical
        middle = math.sqrt(low * high) if low > 0.0 else 0.5 * (low + high)
        values[name] = (middle,) if quantity.sequence else middle
    for name, value in fields.items():
        values[name] = tuple(value for _ in values[name]) if isinstance(values.get(name), tuple) else value
    return kind(**values)


@functools.cache
def hosts() -> tuple[hm.Scene, ...]:
    """Scenes that offer a place to every effect."""
    rotors = rotor_bench.build()
    station = next(iter(rotors.network().rotors)).name
    probes = {f"probe_{axis}": hm.Sensor(quantity=f"{station}.{axis}") for axis in "xy"}
    return drive_bench.build(), dataclasses.replace(rotors, parts={**rotors.parts, **probes})


def host(kind: type[Effect]) -> tuple[hm.Scene, str]:
    for scene in hosts():
        places = kind.places(scene.network())
        if places:
            return scene, places[0]
    pytest.fail(f"no scene here has a place for {kind.__name__}")


# -- what classes say ----------------------------------------------------------------------------------


@every_effect
def test_vectors_are_an_amplitude_that_may_be_zero_and_an_angle(kind: type[Effect]) -> None:
    known = quantities(kind)
    for amplitude, phase in kind.vectors:
        assert known[amplitude].low == 0.0
        assert known[amplitude].typical is not None
        assert known[phase].unit == "rad"
        assert known[phase].typical == (-math.pi, math.pi)
    used = [name for pair in kind.vectors for name in pair]
    assert len(set(used)) == len(used)


@every_effect
def test_each_start_is_a_value_that_the_class_takes(kind: type[Effect]) -> None:
    fields = kind.__dataclass_fields__
    for name, options in kind.starts.items():
        assert name in fields
        assert len(set(options)) == len(options) > 0
        for option in options:
            assert getattr(started(kind).replacing(**{name: option}), name) == option


@every_effect
def test_what_is_needed_has_a_range_or_starts(kind: type[Effect]) -> None:
    needed = {p.name for p in inspect.signature(kind).parameters.values() if p.default is inspect.Parameter.empty}
    ranged = {name for name, quantity in quantities(kind).items() if quantity.typical is not None}
    assert needed <= ranged | set(kind.starts)


def test_all_others_are_searched() -> None:
    assert {kind.__name__ for kind in effects_of_package()} - {kind.__name__ for kind in known_effects()} == NOT_SEARCHED | {
        "MaxwellSlipHysteresis"
    }


DECISIVE = [kind for kind in known_effects() if kind.decisive and kind.acts_on in ("shaft", "rotor", "bearing")]


@pytest.mark.parametrize("kind", DECISIVE, ids=lambda kind: kind.__name__)
def test_a_first_look_takes_every_value_of_what_is_decisive(kind: type[Effect]) -> None:
    """A crack had two of its four sides, as every other one of so many starts was taken."""
    [first, *_] = candidates(rotor_bench.bench().scene, [kind])
    for name in kind.decisive:
        wanted = set(kind.starts.get(name, ()))
        assert wanted <= {getattr(item.effect, name) for item in first.first}
        assert wanted <= {getattr(item.effect, name) for item in first.starts}


@pytest.mark.parametrize("kind", [hm.PhasedCrack, hm.BreathingCrack, hm.MomentCrack, hm.LoadedMisalignment], ids=lambda kind: kind.__name__)
def test_where_starts_are_thinned_out_no_field_keeps_to_a_few_of_its_values(kind: type[Effect]) -> None:
    [first, *_] = candidates(rotor_bench.bench().scene, [kind])
    for name, values in kind.starts.items():
        tried = {getattr(item.effect, name) for item in first.starts}
        assert len(tried) >= min(len(values), 2), name
    phases = {getattr(item.effect, "phase", None) for item in first.starts}
    assert phases == set(kind.starts.get("phase", phases))


@every_effect
def test_a_search_has_a_strength_to_start_from_zero(kind: type[Effect]) -> None:
    assert strengths(kind), f"{kind.__name__} has no field with a typical range that may be zero"


OTHER_BEARINGS = {"BearingClearance", "HertzianClearance"}
"""Their contact is another one at no gap too: with less damping from the film, with Hertz's power in place of the bearing's law."""


@every_effect
def test_with_all_strengths_at_zero_the_equations_are_those_without_it(kind: type[Effect]) -> None:
    if kind.__name__ in OTHER_BEARINGS:
        with pytest.raises(AssertionError, match="bearing_1"):
            assert_same_equations(kind)
    else:
        assert_same_equations(kind)


def assert_same_equations(kind: type[Effect]) -> None:
    scene, place = host(kind)
    bare = scene.network()
    network = scene.with_effect(started(kind, **dict.fromkeys(strengths(kind), 0.0)), at=place, name="it").network()
    moment = ordinary_moment(network)
    with np.errstate(all="ignore"):
        found, wanted = network.accelerations(moment), bare.accelerations(restricted(moment, bare))
    for name, value in wanted.items():
        scale = float(np.max(np.abs(value)))
        np.testing.assert_allclose(np.broadcast_to(found[name], np.shape(value)), value, rtol=1e-9, atol=1e-9 * scale, err_msg=name)
    for name in set(found) - set(wanted):
        assert np.isfinite(found[name]).all(), name
    readings = {channel.name: channel for channel in network.channels}
    for channel in bare.channels:
        if channel.reads is not None:
            np.testing.assert_allclose(readings[channel.name].read(moment), channel.read(restricted(moment, bare)), rtol=1e-12, atol=0.0)


def ordinary_moment(network: Network) -> Any:
    """Moments of the size that a bench sees, with one at rest."""
    rng = np.random.default_rng(11)

    def draw(size: float) -> np.ndarray:
        values = rng.normal(0.0, size, 50)
        values[0] = 0.0
        return values

    angles = {body.name: draw(1e-4 if body.lateral else 1.0) for body in network.bodies}
    speeds = {body.name: draw(1e-2 if body.lateral else 50.0) for body in network.bodies}
    return network.moment(rng.uniform(0.0, 9.0, 50), angles, speeds, {state.name: draw(1e-3) for state in network.states})


def restricted(moment: Any, network: Network) -> Any:
    """The same moment for a network with fewer coordinates."""
    return network.moment(
        moment.time,
        {body.name: moment.angles[body.name] for body in network.bodies},
        {body.name: moment.speeds[body.name] for body in network.bodies},
        {state.name: moment.states[state.name] for state in network.states},
    )


# -- fast sliding ----------------------------------------------------------------------------------------

SLIDING: tuple[tuple[Any, str, float], ...] = (
    (hm.LuGreFriction(coulomb=0.2, drop=0.5, stribeck_speed=5.0, stiffness=40.0, damping=0.02), "bristle_torque", 200.0),
    (hm.DahlFriction(coulomb=0.2, presliding=4e-3, exponent=1.0), "z", 200.0),
    (hm.DahlFriction(coulomb=0.2, presliding=4e-3, exponent=2.0), "z", 200.0),
    (hm.PreslidingFriction(coulomb=0.2, drop=0.5, stribeck_speed=5.0, asymmetry=0.2, presliding=4e-3), "torque", 200.0),
    (hm.PreslidingFriction(coulomb=0.2, drop=0.5, stribeck_speed=5.0, presliding=4e-3, exponent=2.0), "torque", 200.0),
    (hm.SpreadSlipFriction(coulomb=0.2, drop=0.5, stribeck_speed=5.0, asymmetry=0.2, presliding=4e-3), "torque_2", 200.0),
    (hm.BoucWenHysteresis(torque_limit=5.0, yield_twist=2e-5, exponent=1.5, shape=0.7), "z", 1.0),
    (hm.DahlHysteresis(torque_limit=5.0, yield_twist=2e-5, exponent=1.7), "z", 1.0),
    (hm.MaxwellSlipHysteresis(stiffness=(1e5,), torque_limit=(2.0,)), "torque_1", 1.0),
    (hm.IwanHysteresis(torque_limit=5.0, slip_twist=3e-5), "torque_2", 1.0),
    (hm.SpreadSlipHysteresis(torque_limit=5.0, slip_twist=3e-5, spread=2.0), "torque_3", 1.0),
)
sliding = pytest.mark.parametrize(
    ("law", "name", "speed"), SLIDING, ids=lambda item: type(item).__name__ if isinstance(item, Effect) else str(item)
)


def limit_of(law: Any, name: str, speed: float) -> float:
    """The state in steady sliding."""
    if name == "z":
        return math.copysign(1.0, speed)
    if isinstance(law, hm.LuGreFriction | hm.PreslidingFriction):
        return math.copysign(float(law.sliding_torque(speed)), speed)
    if isinstance(law, hm.SpreadSlipFriction):
        return math.copysign(float(law.sliding_torque(speed)) / 4.0, speed)
    elements = law if isinstance(law, hm.MaxwellSlipHysteresis) else law.elements
    return math.copysign(elements.torque_limit[int(name[-1]) - 1], speed)


def rate_of(law: Any, name: str, speed: float, value: float) -> float:
    states = dict.fromkeys(law.states(), 0.0) | {name: value}
    return float(law.state_rate(name, 0.0, 0.0, speed, states))


def torque_of(law: Any, speed: float, states: Mapping[str, float]) -> float:
    return float(law.torque(0.0, 0.0, speed, states))


@sliding
def test_steady_sliding_is_the_same_however_fast(law: Any, name: str, speed: float) -> None:
    follows_all = law.replacing(fastest_rate=1e12)
    for at in (speed, -speed, 1e-3 * speed, 1e3 * speed):
        settled = {other: limit_of(law, other, at) for other in law.states()}
        for other, value in settled.items():
            assert rate_of(law, other, at, value) == pytest.approx(0.0, abs=1e-9 * FASTEST_RATE * abs(value))
        assert torque_of(law, at, settled) == pytest.approx(torque_of(follows_all, at, settled), rel=1e-9)


@sliding
def test_the_state_decays_no_faster_than_its_fastest_rate(law: Any, name: str, speed: float) -> None:
    follows_all = law.replacing(fastest_rate=1e12)
    for at in (0.3 * speed, speed, 100.0 * speed):
        limit = limit_of(law, name, at)

        def decay(some: Any, around: float, at: float = at, limit: float = limit) -> float:
            return -(rate_of(some, name, at, around + 1e-6 * limit) - rate_of(some, name, at, around - 1e-6 * limit)) / (2e-6 * limit)

        assert max(decay(law, share * limit) for share in np.linspace(0.0, 0.999, 40)) <= FASTEST_RATE * (1.0 + 1e-6)
        # without the limit it is far stiffer, so the test says something
        assert max(decay(follows_all, share * limit) for share in np.linspace(0.0, 0.999, 40)) > 2.0 * FASTEST_RATE


@sliding
def test_slow_sliding_is_the_law_itself(law: Any, name: str, speed: float) -> None:
    follows_all = law.replacing(fastest_rate=1e12)
    for at in (1e-4 * speed, -1e-3 * speed):
        for share in (-0.9, 0.0, 0.5, 0.99):
            states = {other: share * abs(limit_of(law, other, at)) for other in law.states()}
            assert torque_of(law, at, states) == torque_of(follows_all, at, states)
            assert rate_of(law, name, at, states[name]) == rate_of(follows_all, name, at, states[name])


def test_the_share_that_is_followed_falls_with_the_rate_and_mixes_the_torque() -> None:
    assert followed_share(0.0, 5e3) == followed_share(5e3, 5e3) == 1.0
    assert followed_share(2e4, 5e3) == 0.25
    assert mixed(0.25, 3.0, 7.0, -2.0) == 0.25 * 3.0 - 0.75 * 7.0


def reversing_bench(*effects: tuple[Effect, str]) -> Network:
    """The drive bench at 200 rad/s, turned round, under a swinging load: 1.2 s."""
    times = np.linspace(0.0, 1.2, 2401)
    speed = 200.0 * np.clip(times / 0.2, 0.0, 1.0) - 400.0 * np.clip((times - 0.4) / 0.4, 0.0, 1.0)
    scene = drive_bench.build(speed_reference=(times, speed), load_torque=(times, 40.0 * np.sin(2.0 * np.pi * 6.0 * times)))
    for k, (effect, place) in enumerate(effects):
        scene = scene.with_effect(effect, at=place, name=f"it{k}")
    return scene.network()


COLUMNS = {column: drive_bench.CHANNELS[column] for column in drive_bench.NOISE}


def in_noise(network: Network, step: float) -> dict[str, np.ndarray]:
    run = CompiledLine(network, tuple(COLUMNS.values())).run(2400, drive_bench.SAMPLE_TIME, step=step)
    return {column: run.values[channel] / drive_bench.noise()[column] for column, channel in COLUMNS.items()}


@pytest.mark.parametrize(
    ("effect", "place"),
    [
        (hm.LuGreFriction(coulomb=0.12, drop=0.76, stribeck_speed=4.7, stiffness=12.0), "wave_generator"),
        (hm.LuGreFriction(coulomb=0.12, drop=0.76, stribeck_speed=4.7, stiffness=30.0, damping=0.02), "motor"),
        (hm.PreslidingFriction(coulomb=0.12, drop=0.76, stribeck_speed=4.7, presliding=4e-3, exponent=1.7), "wave_generator"),
        (hm.DahlFriction(coulomb=5.0, presliding=4e-4, exponent=1.5), "load"),
        (hm.SpreadSlipFriction(coulomb=5.0, drop=0.4, stribeck_speed=0.1, presliding=6e-4, spread=2.0), "load"),
        (hm.BoucWenHysteresis(torque_limit=5.4, yield_twist=3e-4), "gear"),
        (hm.SpreadSlipHysteresis(torque_limit=5.4, slip_twist=3e-4), "gear"),
        (hm.MeshPreslidingFriction(loss_factor=0.25, rounding_torque=1.0, drop=0.1), "gear"),
    ],
    ids=lambda item: type(item).__name__ if isinstance(item, Effect) else item,
)
def test_half_a_sample_is_short_enough_for_friction_and_hysteresis(effect: Any, place: str) -> None:
    coarse = in_noise(reversing_bench((effect, place)), STEP)
    fine = in_noise(reversing_bench((effect.replacing(fastest_rate=25.0 / STEP), place)), STEP / 25.0)
    plain = in_noise(reversing_bench(), STEP)
    errors = {column: float(np.sqrt(np.mean((coarse[column] - fine[column]) ** 2))) for column in fine}
    assert max(errors.values()) < 0.1, errors  # a tenth of the noise: 1 % of what its variance says
    assert max(np.max(np.abs(plain[column] - fine[column])) for column in fine) > 10.0


# -- short lags ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("time", [1e-6, 5e-5, 1e-4, 2e-4, 1e-3, 5e-3])
def test_a_steady_ramp_comes_late_by_the_lag_of_a_sensor_however_short(time: float) -> None:
    # x = c t with c = 3 and x = 0 now:  y' = c,  so that x - y = c/(rate of the lag), and the reading is -c t
    lag, delay = hm.SensorLag(time_constant=time), hm.SensorDelay(delay=time)
    behind = 3.0 / float(lag.state_rate("lagged", 0.0, 1.0, {"lagged": 0.0}))
    assert lag.reading(0.0, 0.0, {"lagged": -behind}) == pytest.approx(-3.0 * time, rel=1e-12)
    slope = 3.0 / float(delay.state_rate("late", 0.0, 0.0, {"late": 0.0, "slope": 1.0}))  # late' = c
    late = -slope / 2.0  # slope' = 0
    assert delay.state_rate("slope", 0.0, 0.0, {"late": late, "slope": slope}) == pytest.approx(0.0, abs=1e-6)
    assert delay.reading(0.0, 0.0, {"late": late, "slope": slope}) == pytest.approx(-3.0 * time, rel=1e-12)


@pytest.mark.parametrize("effect", [hm.ActuatorLag(time_constant=5e-5), hm.SecondOrderLag(delay=5e-5), hm.SecondOrderLag(delay=2e-3)])
def test_a_motor_follows_a_ramp_late_by_its_lag_with_steps_of_half_a_sample(effect: Any) -> None:
    late = getattr(effect, "time_constant", None) or effect.delay
    motor = hm.Motor(inertia=0.1, characteristic=lambda time, speed: 5.0 * time + 0.0 * speed)
    scene = hm.Scene(name="ramp", parts={"motor": motor}, connections=[]).with_effect(effect, at="motor", name="it")
    response = hm.simulate(scene, 0.1, solver=hm.RungeKutta4(step=STEP))
    assert response["it.torque"].values[-1] == pytest.approx(5.0 * (0.1 - late), abs=1e-9)


# a search meets the ends of the ranges: what may be stiff stays stable there
@pytest.mark.parametrize(
    ("effect", "place"),
    [
        *((hm.ActuatorLag(time_constant=t), "motor") for t in (5e-5, 0.05)),
        *((hm.SecondOrderLag(delay=t, damping_ratio=z), "motor") for t in (5e-5, 0.02) for z in (0.3, 1.5)),
        *((hm.SensorLag(time_constant=t), "load_encoder") for t in (5e-5, 0.05)),
        *((hm.SensorDelay(delay=t), "load_encoder") for t in (5e-5, 0.02)),
        *((hm.SeriesCompliance(compliance=c), at) for c in (1e-7, 1e-2) for at in ("input_shaft", "gear", "output_shaft")),
        *((hm.Creep(compliance=c, relaxation_time=4e-3), at) for c in (1e-7, 1e-2) for at in ("input_shaft", "gear", "output_shaft")),
        *((hm.JointSlip(slip_torque=t, slip_rate=1.0), at) for t in (0.3, 300.0) for at in ("input_shaft", "output_shaft")),
        *((hm.FlexibleInertia(share=s, natural_frequency=f), "load") for s in (0.02, 0.7) for f in (20.0, 3e3)),
        *((hm.PreslidingFriction(coulomb=0.3, presliding=x), "wave_generator") for x in (1e-4, 0.1)),
        *((hm.CoulombStribeckFriction(coulomb=0.3, smoothing_speed=0.3), at) for at in ("motor", "wave_generator", "load")),
    ],
    ids=str,
)
def test_at_the_ends_of_its_range_it_is_stable_with_steps_of_half_a_sample(effect: Effect, place: str) -> None:
    found = in_noise(reversing_bench((effect, place)), STEP)
    wanted = in_noise(reversing_bench((effect, place)), STEP / 5.0)
    # stable: what the steps change is small beside the motion itself
    for column, values in wanted.items():
        assert np.max(np.abs(found[column] - values)) < 1e-2 * np.max(np.abs(values)), column


# -- laws against each other ------------------------------------------------------------------------------------

SPEEDS = np.array([-300.0, -2.0, -1e-3, 0.0, 0.4, 50.0])


def test_a_drop_is_the_breakaway_torque_as_a_share() -> None:
    for make in (hm.CoulombStribeckFriction, functools.partial(hm.LuGreFriction, stiffness=40.0)):
        by_share, by_torque = make(coulomb=4.0, drop=0.5), make(coulomb=4.0, breakaway=6.0)
        state = {"bristle_torque": 1.0}
        args: tuple[Any, ...] = (0.0, 0.0, SPEEDS) if isinstance(by_share, hm.CoulombStribeckFriction) else (0.0, 0.0, SPEEDS, state)
        np.testing.assert_allclose(by_share.torque(*args), by_torque.torque(*args), rtol=1e-14)
        with pytest.raises(ParameterError, match="say the same"):
            make(coulomb=4.0, breakaway=6.0, drop=0.5)


def test_presliding_friction_without_drop_and_asymmetry_is_dahls() -> None:
    for exponent in (1.0, 1.7):
        law = hm.PreslidingFriction(coulomb=5.0, presliding=2e-3, exponent=exponent)
        dahl = hm.DahlFriction(coulomb=5.0, presliding=2e-3, exponent=exponent)
        for z in (-0.8, 0.1, 0.95):
            np.testing.assert_allclose(
                law.torque(0.0, 0.0, SPEEDS, {"torque": 5.0 * z}), dahl.torque(0.0, 0.0, SPEEDS, {"z": z}), rtol=1e-12
            )
            np.testing.assert_allclose(
                law.state_rate("torque", 0.0, 0.0, SPEEDS, {"torque": 5.0 * z}),
                5.0 * dahl.state_rate("z", 0.0, 0.0, SPEEDS, {"z": z}),
                rtol=1e-12,
            )


def test_presliding_friction_slides_at_unequal_torques_that_drop_with_speed() -> None:
    law = hm.PreslidingFriction(coulomb=5.0, drop=0.6, stribeck_speed=2.0, stribeck_exponent=2.0, asymmetry=0.1, presliding=1e-3)
    # T_C (1 +- a)(1 + d/(1 + 1)) at the speed of the drop
    assert law.sliding_torque(2.0) == pytest.approx(5.0 * 1.1 * 1.3)
    assert law.sliding_torque(-2.0) == pytest.approx(5.0 * 0.9 * 1.3)
    assert law.sliding_torque(1e6) == pytest.approx(5.5)


def test_friction_of_both_senses_may_come_apart_with_the_speed() -> None:
    law = hm.PreslidingFriction(coulomb=5.0, asymmetry=0.2, asymmetry_speed=3.0, presliding=1e-3)
    # tanh(1) = 0.76159, tanh(1/10) = 0.099668
    assert law.sliding_torque(np.array([3.0, -3.0, 0.3, 300.0])) == pytest.approx([5.76159, 4.23841, 5.099668, 6.0], rel=1e-6)


def moved(law: hm.SpreadSlipFriction, states: dict[str, float], angle: float, speed: float) -> dict[str, float]:
    """The states after a slow motion over an angle, in small steps."""
    steps = 4000
    for _ in range(steps):
        rates = {name: float(law.state_rate(name, 0.0, 0.0, speed, states)) for name in states}
        states = {name: value + rates[name] * abs(angle / speed) / steps for name, value in states.items()}
    return states


def test_friction_of_sliders_turns_over_in_pieces_and_closes_its_inner_loops() -> None:
    # q = 16: slip angles x_p (1/8, 1/2, 2, 8), limits of 2 N m and so stiffnesses of 16, 4, 1, 1/4 kN m/rad
    law = hm.SpreadSlipFriction(coulomb=8.0, presliding=1e-3, spread=16.0, rounding=0.01, fastest_rate=1e9)
    virgin = moved(law, dict.fromkeys(law.states(), 0.0), 1e-3, 0.01)
    # two slip at 2 N m each, 1 kN m/rad 1e-3 rad and a quarter of it
    assert float(law.torque(0.0, 0.0, 0.01, virgin)) == pytest.approx(-(2.0 + 2.0 + 1.0 + 0.25), rel=2e-3)
    assert law.stored(virgin) == pytest.approx(0.5 * (4.0 / 16e3 + 4.0 / 4e3 + 1.0 / 1e3 + 0.0625 / 250.0), rel=5e-3)
    # Masing: back by 0.2e-3 the torque falls by twice the virgin course at 0.1e-3, (16 + 4 + 1 + 1/4) 0.2
    back = moved(law, virgin, 0.2e-3, -0.01)
    assert float(law.torque(0.0, 0.0, -0.01, back)) == pytest.approx(-(5.25 - 4.25), rel=1e-2)
    # and forth again it meets where it left, which Dahl's law misses
    forth = moved(law, back, 0.2e-3, 0.01)
    assert float(law.torque(0.0, 0.0, 0.01, forth)) == pytest.approx(-5.25, abs=0.02)  # the corner of one is rounded by 1 % of 2 N m


def test_friction_of_sliders_follows_the_sliding_torque_and_gives_way_where_it_falls() -> None:
    law = hm.SpreadSlipFriction(coulomb=8.0, drop=0.5, stribeck_speed=2.0, stribeck_exponent=2.0, asymmetry=0.1, presliding=1e-3)
    # T_C (1 +- a)(1 + d/(1 + 1)) at the speed of the drop
    for speed, size in ((2.0, 8.0 * 1.1 * 1.25), (-2.0, 8.0 * 0.9 * 1.25)):
        full = dict.fromkeys(law.states(), math.copysign(8.0 * 1.5 / 4.0, speed))  # as large as it ever gets
        assert float(law.torque(0.0, 0.0, speed, full)) == pytest.approx(-math.copysign(size, speed), rel=1e-12)
        assert all(float(law.state_rate(name, 0.0, 0.0, speed, full)) * speed < 0.0 for name in full)
        # what is put in and what the springs give becomes heat, |v| (L + |T| (s - 1)) of each, s = (|T| - (1 - r) L)/(r L): slider.py
        followed = law.replacing(fastest_rate=1e9)
        given = -sum(full[name] * float(followed.state_rate(name, 0.0, 0.0, speed, full)) / k for name, k in stiffnesses(law).items())
        torque, limit, r = 3.0, size / 4.0, law.rounding
        slip = (torque - (1.0 - r) * limit) / (r * limit)
        assert size * abs(speed) + given == pytest.approx(4.0 * abs(speed) * (limit + torque * (slip - 1.0)), rel=1e-9)
    assert law.states() == dict.fromkeys(("torque_1", "torque_2", "torque_3", "torque_4"), "N m")
    assert law.replacing(coulomb=0.0).states() == {}


def stiffnesses(law: hm.SpreadSlipFriction) -> dict[str, float]:
    """Of its elements [N m/rad]: k = T_C/(4 x_i), x_i = x_p q^((2 i - 5)/4)."""
    angles = [law.presliding * law.spread ** (k / 4.0) for k in (-3, -1, 1, 3)]
    return {f"torque_{k}": law.coulomb / 4.0 / angle for k, angle in enumerate(angles, start=1)}


def test_lubricated_friction_slides_at_a_torque_that_drops_and_rises_from_zero_with_the_speed() -> None:
    law = hm.LubricatedFriction(coulomb=5.0, drop=0.6, stribeck_speed=2.0, stribeck_exponent=2.0, asymmetry=0.1, smoothing_speed=0.01)
    # T_C (1 +- a)(1 + d/(1 + (w/w_S)^2)) against the motion, where tanh is 1: (w/w_S)^2 = 1, 9, 1/4
    for speed, size in ((2.0, 5.0 * 1.1 * 1.3), (-2.0, 5.0 * 0.9 * 1.3), (6.0, 5.0 * 1.1 * 1.06), (-1.0, 5.0 * 0.9 * 1.48)):
        assert law.torque(0.0, 0.0, speed) == pytest.approx(-math.copysign(size, speed), rel=1e-12)
    # T_C (1 + a w/w_a)(1 + d) w/w_0 close to zero, w_a = 1e-3: tanh leaves (w/w_0)^2/3, the drop (w/w_S)^2
    assert law.torque(0.0, 0.0, 1e-5) == pytest.approx(-5.0 * 1.001 * 1.6 * 1e-3, rel=4e-7)
    assert law.torque(0.0, 0.0, 0.0) == 0.0


def test_dahl_hysteresis_of_exponent_one_is_bouc_and_wens_with_a_sign_term_alone() -> None:
    dahl = hm.DahlHysteresis(torque_limit=8.0, yield_twist=2e-4, exponent=1.0)
    wen = hm.BoucWenHysteresis(torque_limit=8.0, yield_twist=2e-4, exponent=1.0, shape=1.0)
    rates = np.array([-2.0, -1e-3, 1e-2, 0.5])
    for z in (-0.7, 0.3):
        for law in ("state_rate", "torque"):
            args: tuple[Any, ...] = ("z", 0.0, 0.0, rates, {"z": z}) if law == "state_rate" else (0.0, 0.0, rates, {"z": z})
            np.testing.assert_allclose(getattr(dahl, law)(*args), getattr(wen, law)(*args), rtol=1e-12)


def test_spread_sliders_reach_from_a_part_to_a_multiple_of_the_middle_twist() -> None:
    elements = hm.SpreadSlipHysteresis(torque_limit=8.0, slip_twist=1e-3, spread=16.0).elements
    # x_i = x_s q^(-3/4, -1/4, 1/4, 3/4) = x_s (1/8, 1/2, 2, 8)
    twists = np.array(elements.torque_limit) / np.array(elements.stiffness)
    np.testing.assert_allclose(twists, 1e-3 * np.array([0.125, 0.5, 2.0, 8.0]), rtol=1e-12)
    assert sum(elements.torque_limit) == pytest.approx(8.0)
    assert len(set(hm.SpreadSlipHysteresis(torque_limit=8.0, slip_twist=1e-3, spread=1.0).elements.stiffness)) == 1


def test_power_drag_holds_the_viscous_and_the_quadratic_drag() -> None:
    for exponent, other in ((1.0, hm.ViscousDrag(coefficient=0.3)), (2.0, hm.QuadraticDrag(coefficient=0.3))):
        law = hm.PowerDrag(drag=0.3 * 20.0**exponent, exponent=exponent, reference_speed=20.0)
        np.testing.assert_allclose(law.torque(0.0, 0.0, SPEEDS), other.torque(0.0, 0.0, SPEEDS), rtol=1e-12)


def test_one_sided_stiffness_leaves_the_other_side_alone() -> None:
    def law(twist: Any, rate: Any) -> Any:
        return 1e4 * twist + 3.0 * rate

    twists = np.array([-1e-3, -5e-4, 0.0, 5e-4, 1e-3])
    for side, sense in (("forward", 1.0), ("reverse", -1.0)):
        effect = hm.OneSidedStiffness(change=0.2, onset_twist=5e-4, side=side)
        beyond = np.maximum(sense * twists, 0.0)
        share = beyond / (beyond + 5e-4)  # half of it at the onset
        np.testing.assert_allclose(effect.changed(law)(twists, 2.0), law(twists, 2.0) + 0.2 * share * 1e4 * twists, rtol=1e-12)
        # beyond a gap of 6e-4 rad of the law itself: 2e-4 and 7e-4 rad are left of these twists
        changed = effect.changed_beyond(law, 6e-4)(twists, 2.0)
        left = np.maximum(sense * twists - 3e-4, 0.0)
        np.testing.assert_allclose(changed, law(twists, 2.0) + 0.2 * left / (left + 5e-4) * 1e4 * twists, rtol=1e-12)
    with pytest.raises(ParameterError, match="must be 'forward' or 'reverse'"):
        hm.OneSidedStiffness(change=0.2, side="left")


def test_mesh_friction_with_bristles_slides_as_without_them() -> None:
    scene = drive_bench.build()
    rng = np.random.default_rng(3)
    torques = {}
    for name, effect in (
        ("plain", hm.MeshFriction(loss_factor=0.3, no_load=0.05)),
        ("bristles", hm.MeshPreslidingFriction(loss_factor=0.3, no_load=0.05, stiffness=1e9)),
    ):
        network = scene.with_effect(effect, at="gear", name="it").network()
        rng = np.random.default_rng(3)
        wave, flange = rng.normal(0.0, 3.0, 40), rng.normal(0.0, 1e-3, 40)
        angles = {body.name: wave if body.ratio == 1.0 else wave / 100.0 + flange for body in network.bodies}
        speeds = {body.name: 100.0 * np.sign(wave) * body.ratio for body in network.bodies}
        moment = network.moment(0.0 * wave, angles, speeds, {state.name: 0.0 * wave for state in network.states})
        channel = next(c for c in network.channels if c.name == "it.torque")
        torques[name] = np.asarray(channel.read(moment))
    # stiff bristles at 100 rad/s: s = f L/(k v) < 1e-6, the sliding torque to within it
    assert np.ptp(torques["plain"]) > 0.5
    np.testing.assert_allclose(torques["bristles"], torques["plain"], rtol=1e-4)


def test_a_kinematic_error_with_its_offset_starts_unwound() -> None:
    for make in (hm.KinematicError, hm.HarmonicKinematicError, hm.BeatingKinematicError):
        effect = make(amplitude=1e-4, phase=0.7, offset=-1e-4 * math.sin(0.7))
        assert effect.error(0.0) == pytest.approx(0.0, abs=1e-18)
        assert effect.error(np.array([math.pi / 4.0])) == pytest.approx(1e-4 * (math.cos(0.7) - math.sin(0.7)))


def channel_torque(effect: Effect, angles: np.ndarray) -> np.ndarray:
    """Torque of an effect on the load of the bench at these angles, speeds and all else zero."""
    network = drive_bench.build().with_effect(effect, at="load", name="it").network()
    zero = 0.0 * angles
    names = [body.name for body in network.bodies]
    moment = network.moment(zero, dict.fromkeys(names, angles), dict.fromkeys(names, zero), {state.name: zero for state in network.states})
    return np.asarray(next(c for c in network.channels if c.name == "it.torque").read(moment))


def test_the_second_harmonics_of_weight_and_ripple_add_to_the_first() -> None:
    angles = np.linspace(0.0, 7.0, 50)
    weight = hm.EccentricLoad(mass=2.0, radius=0.1, start_angle=0.3, second_torque=0.4, second_phase=0.9)
    alone = weight.replacing(second_torque=0.0)
    np.testing.assert_allclose(
        channel_torque(weight, angles) - channel_torque(alone, angles), -0.4 * np.sin(2.0 * angles + 0.9), atol=1e-12
    )
    np.testing.assert_allclose(channel_torque(alone, angles), -2.0 * 9.80665 * 0.1 * np.sin(angles + 0.3), atol=1e-12)
    ripple = hm.TorqueRipple(amplitude=0.2, order=6.0, phase=0.1, second_amplitude=0.05, second_phase=0.5)
    expected = 0.2 * np.sin(6.0 * angles + 0.1) + 0.05 * np.sin(12.0 * angles + 0.5)
    np.testing.assert_allclose(channel_torque(ripple, angles), expected, atol=1e-12)


def test_a_hardening_spring_of_a_hidden_mode_stores_what_it_takes() -> None:
    law = hm.HiddenMode(inertia=0.2, natural_frequency=100.0, damping_ratio=0.0, hardening=30.0)

    def state(x: float) -> dict[str, float]:
        return {"deflection": x, "inertia_speed": 0.0}

    for x in (0.05, 0.3):
        # J f^2 (x + b x^3), the slope of the energy
        assert law.torque(0.0, 0.0, 0.0, state(x)) == pytest.approx(0.2 * 1e4 * (x + 30.0 * x**3))
        slope = (law.stored(state(x + 1e-6)) - law.stored(state(x - 1e-6))) / 2e-6
        assert slope == pytest.approx(law.torque(0.0, 0.0, 0.0, state(x)), rel=1e-6)
    damped = law.replacing(square_damping=4.0)
    taken = damped.torque(0.0, 0.0, 0.0, {"deflection": 0.0, "inertia_speed": -3.0})
    assert taken == pytest.approx(-0.2 * 4.0 * 9.0)


def test_a_weight_is_not_searched_where_its_mass_would_shake_the_line() -> None:
    """On a rotor line it would be an unbalance: 0.04 kg m, say, where the bench has 2e-4; what only turns may carry an arm."""
    assert hm.EccentricLoad.places(rotor_bench.build().network()) == ()
    assert "load" in hm.EccentricLoad.places(drive_bench.build().network())


# -- the bench ----------------------------------------------------------------------------------------------------


def test_effects_of_its_sensors_reach_the_columns_of_the_drive_bench() -> None:
    gain = hm.SensorGain(error=0.1)
    eccentric = hm.EncoderEccentricity(amplitude=1e-3, phase=0.4)
    plain = in_noise(reversing_bench(), STEP)
    for column, effect, sensor in (
        ("output_torque", gain, "torque_sensor"),
        ("motor_angle", eccentric, "motor_encoder"),
        ("load_angle", eccentric, "load_encoder"),
    ):
        found = in_noise(reversing_bench((effect, sensor)), STEP)
        sigma = drive_bench.noise()[column]
        true = plain[column] * sigma
        wanted = 1.1 * true if effect is gain else true + 1e-3 * np.sin(true + 0.4)
        np.testing.assert_allclose(found[column] * sigma, wanted, rtol=0.0, atol=1e-9 * np.max(np.abs(true)))
        for other in set(plain) - {column}:
            np.testing.assert_array_equal(found[other], plain[other])

"""One battery of tests over every effect of the package, and over effects of a user's own.

Every concrete subclass of Effect in hdrive_mbs.effects is found by walking the package; there is no
list of exclusions.  A new effect needs one line in EXAMPLES.
"""

from __future__ import annotations

import dataclasses
import functools
import importlib
import inspect
import math
import pkgutil
import re
import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import hdrive_mbs.effects
from hdrive_mbs.compiled.line import CompiledLine
from hdrive_mbs.components.harmonic_drive import HarmonicDrive
from hdrive_mbs.components.load import Load
from hdrive_mbs.components.motor import Motor
from hdrive_mbs.components.sensor import Sensor
from hdrive_mbs.components.shaft import Shaft
from hdrive_mbs.conversions import arcmin, rpm
from hdrive_mbs.diagnosis.candidates import known_effects
from hdrive_mbs.effects.actuator_lag import ActuatorLag
from hdrive_mbs.effects.beating_kinematic_error import BeatingKinematicError
from hdrive_mbs.effects.bouc_wen_hysteresis import BoucWenHysteresis
from hdrive_mbs.effects.cogging import Cogging
from hdrive_mbs.effects.coulomb_stribeck_friction import CoulombStribeckFriction
from hdrive_mbs.effects.coupling_backlash import CouplingBacklash
from hdrive_mbs.effects.creep import Creep
from hdrive_mbs.effects.dahl_friction import DahlFriction
from hdrive_mbs.effects.dahl_hysteresis import DahlHysteresis
from hdrive_mbs.effects.eccentric_load import EccentricLoad
from hdrive_mbs.effects.effect import KINDS, Effect, MemoryTwistEffect, TorqueEffect, TwistEffect
from hdrive_mbs.effects.encoder_eccentricity import EncoderEccentricity
from hdrive_mbs.effects.external_torque import ExternalTorque
from hdrive_mbs.effects.film_backlash import FilmBacklash
from hdrive_mbs.effects.flexible_inertia import FlexibleInertia
from hdrive_mbs.effects.friction_by_angle import FrictionByAngle
from hdrive_mbs.effects.harmonic_kinematic_error import HarmonicKinematicError
from hdrive_mbs.effects.hidden_mode import HiddenMode
from hdrive_mbs.effects.inertia_variation import InertiaVariation
from hdrive_mbs.effects.iwan_hysteresis import IwanHysteresis
from hdrive_mbs.effects.joint_slip import JointSlip
from hdrive_mbs.effects.kinematic_error import KinematicError
from hdrive_mbs.effects.load_lag import LoadLag
from hdrive_mbs.effects.lost_motion import LostMotion
from hdrive_mbs.effects.lubricated_friction import LubricatedFriction
from hdrive_mbs.effects.lugre_friction import LuGreFriction
from hdrive_mbs.effects.maxwell_slip_hysteresis import MaxwellSlipHysteresis
from hdrive_mbs.effects.mesh_friction import MeshFriction
from hdrive_mbs.effects.mesh_presliding_friction import MeshPreslidingFriction
from hdrive_mbs.effects.motor_saturation import MotorSaturation
from hdrive_mbs.effects.motor_scale import MotorScale
from hdrive_mbs.effects.one_sided_stiffness import OneSidedStiffness
from hdrive_mbs.effects.parallel_stiffness_variation import ParallelStiffnessVariation
from hdrive_mbs.effects.places import PLACES, gear_flanges
from hdrive_mbs.effects.power_drag import PowerDrag
from hdrive_mbs.effects.presliding_friction import PreslidingFriction
from hdrive_mbs.effects.quadratic_drag import QuadraticDrag
from hdrive_mbs.effects.ripple_spectrum import RippleSpectrum
from hdrive_mbs.effects.rub_at_angle import RubAtAngle
from hdrive_mbs.effects.second_order_lag import SecondOrderLag
from hdrive_mbs.effects.sensor_delay import SensorDelay
from hdrive_mbs.effects.sensor_drift import SensorDrift
from hdrive_mbs.effects.sensor_gain import SensorGain
from hdrive_mbs.effects.sensor_lag import SensorLag
from hdrive_mbs.effects.sensor_offset import SensorOffset
from hdrive_mbs.effects.sensor_quantisation import SensorQuantisation
from hdrive_mbs.effects.series_compliance import SeriesCompliance
from hdrive_mbs.effects.soft_windup import SoftWindup
from hdrive_mbs.effects.spread_slip_friction import SpreadSlipFriction
from hdrive_mbs.effects.spread_slip_hysteresis import SpreadSlipHysteresis
from hdrive_mbs.effects.stiffness_asymmetry import StiffnessAsymmetry
from hdrive_mbs.effects.stiffness_variation import StiffnessVariation
from hdrive_mbs.effects.supply_sag import SupplySag
from hdrive_mbs.effects.thermal_drift import ThermalDrift
from hdrive_mbs.effects.torque_ripple import TorqueRipple
from hdrive_mbs.effects.unequal_drag import UnequalDrag
from hdrive_mbs.effects.viscous_drag import ViscousDrag
from hdrive_mbs.engine.assembly import LoweringWarning, assemble
from hdrive_mbs.engine.simulation import RawRun, run
from hdrive_mbs.engine.solvers import DormandPrince, RungeKutta4, Solver
from hdrive_mbs.errors import LawError, ParameterError, PlaceError
from hdrive_mbs.expression import Value
from hdrive_mbs.flexsplines.piecewise_linear import PiecewiseLinearStiffness
from hdrive_mbs.loads.sine import SineTorque
from hdrive_mbs.motors.asynchronous import AsynchronousMotor
from hdrive_mbs.motors.ideal_speed import IdealSpeedMotor
from hdrive_mbs.motors.profiles.ramp import SpeedRamp
from hdrive_mbs.network.claims import check_claims
from hdrive_mbs.network.elements import Connection
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.network import Network
from hdrive_mbs.quantities import parameter
from hdrive_mbs.scene import Scene
from hdrive_mbs.scene_file import scene_from_dict, scene_to_dict

# -- effects of a user's own: one class each, no registration ---------------------------------------


@dataclass(frozen=True, kw_only=True)
class SealDrag(TorqueEffect):
    """Lip-seal drag.

    tau = -a sign(w) |w|^n

    Source: made up for this test.  Leaves out everything about real seals.
    """

    scale: float = parameter("N m", "drag at 1 rad/s", low=0.0, high=50.0)
    exponent: float = parameter("1", "speed exponent", default=1.3, low=1.0, high=2.0)

    dissipative: ClassVar[bool] = True
    signature: ClassVar[str] = "drag that grows a little faster than speed"

    def torque(self, time: Value, angle: Value, speed: Value) -> Value:
        return -self.scale * np.sign(speed) * np.abs(speed) ** self.exponent


@dataclass(frozen=True, kw_only=True)
class RelaxingSpring(MemoryTwistEffect):
    """A spring in series with a damper, beside a connection.

    tau = y,  dy/dt = k v - y/r

    Source: Maxwell's viscoelastic element.  Leaves out everything else.
    """

    stiffness: float = parameter("N m/rad", "stiffness k", low=0.0)
    relaxation_time: float = parameter("s", "time r in which it relaxes", above=0.0)

    dissipative: ClassVar[bool] = True
    signature: ClassVar[str] = "stiffer when fast"

    def states(self) -> Mapping[str, str]:
        return {"torque": "N m"} if self.stiffness > 0.0 else {}

    def state_rate(self, name: str, time: Value, twist: Value, rate: Value, state: Mapping[str, Value]) -> Value:
        return self.stiffness * rate - state["torque"] / self.relaxation_time

    def torque(self, time: Value, twist: Value, rate: Value, state: Mapping[str, Value]) -> Value:
        return sum(state[name] for name in self.states())

    def stored(self, state: Mapping[str, Value]) -> Value:
        return sum(state[name] ** 2 / (2.0 * self.stiffness) for name in self.states())


# -- the examples -------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Example:
    """An effect with values that can be seen in the test train, its place, and the fields that are its size."""

    effect: Effect
    at: str
    size: tuple[str, ...]


EXAMPLES = {
    type(example.effect): example
    for example in (
        Example(CoulombStribeckFriction(coulomb=5.0, breakaway=8.0, stribeck_speed=0.1), "load", ("coulomb", "breakaway")),
        Example(
            LuGreFriction(coulomb=5.0, breakaway=8.0, stribeck_speed=0.1, stiffness=2e3, damping=5.0, viscous=2.0),
            "load",
            ("coulomb", "breakaway", "viscous"),
        ),
        Example(ViscousDrag(coefficient=10.0), "load", ("coefficient",)),
        Example(QuadraticDrag(coefficient=10.0), "load", ("coefficient",)),
        Example(MeshFriction(loss_factor=0.3, no_load=0.1), "gear", ("loss_factor", "no_load")),
        Example(KinematicError(amplitude=arcmin(1.0), order=2.0, phase=0.4), "gear", ("amplitude",)),
        Example(BoucWenHysteresis(torque_limit=8.0, yield_twist=2e-4, exponent=1.5, shape=0.7), "gear", ("torque_limit",)),
        Example(
            MaxwellSlipHysteresis(stiffness=(3e4, 2e4, 1e4, 5e3), torque_limit=(2.0, 3.0, 4.0, 4.0)), "gear", ("stiffness", "torque_limit")
        ),
        Example(CouplingBacklash(backlash=0.01), "coupling", ("backlash",)),
        Example(TorqueRipple(amplitude=0.3, relative=0.1, order=6.0), "motor", ("amplitude", "relative")),
        Example(EccentricLoad(mass=4.0, radius=0.3, start_angle=0.5), "load", ("mass",)),
        Example(DahlFriction(coulomb=5.0, presliding=2e-3, exponent=1.5), "load", ("coulomb",)),
        Example(
            LubricatedFriction(coulomb=5.0, drop=0.5, stribeck_speed=0.1, asymmetry=0.2, asymmetry_speed=0.3, smoothing_speed=0.02),
            "load",
            ("coulomb",),
        ),
        Example(
            PreslidingFriction(
                coulomb=5.0, drop=0.5, stribeck_speed=0.1, asymmetry=0.2, asymmetry_speed=0.3, presliding=2e-3, exponent=1.5
            ),
            "load",
            ("coulomb",),
        ),
        Example(
            SpreadSlipFriction(
                coulomb=5.0, drop=0.5, stribeck_speed=0.1, asymmetry=0.2, asymmetry_speed=0.3, presliding=2e-3, spread=4.0, rounding=0.5
            ),
            "load",
            ("coulomb",),
        ),
        Example(
            MeshPreslidingFriction(loss_factor=0.3, no_load=0.1, rounding_torque=2.0, drop=0.3, stiffness=50.0),
            "gear",
            ("loss_factor", "no_load"),
        ),
        Example(PowerDrag(drag=10.0, exponent=1.75, reference_speed=2.0), "load", ("drag",)),
        Example(DahlHysteresis(torque_limit=8.0, yield_twist=2e-4, exponent=1.5), "gear", ("torque_limit",)),
        Example(SpreadSlipHysteresis(torque_limit=8.0, slip_twist=5e-4, spread=3.0), "gear", ("torque_limit",)),
        Example(OneSidedStiffness(change=0.3, onset_twist=1e-4), "gear", ("change",)),
        Example(
            RippleSpectrum(order=6.0, first_amplitude=0.3, second_amplitude=0.1, sixth_amplitude=0.05, sixth_phase=1.0, growth=0.1),
            "motor",
            ("first_amplitude", "second_amplitude", "sixth_amplitude"),
        ),
        Example(SecondOrderLag(delay=5e-3, damping_ratio=0.8), "motor", ("delay",)),
        Example(IwanHysteresis(torque_limit=8.0, slip_twist=1e-3, rounding=0.5), "gear", ("torque_limit",)),
        Example(StiffnessAsymmetry(asymmetry=0.3), "gear", ("asymmetry",)),
        Example(LostMotion(width=2e-4, film=2e-5), "gear", ("width",)),
        Example(SoftWindup(width=2e-4, soft_twist=5e-5), "gear", ("width",)),
        Example(FilmBacklash(backlash=0.01, film=1e-3, film_damping=0.02), "coupling", ("backlash",)),
        Example(StiffnessVariation(variation=0.3, phase=0.4), "gear", ("variation",)),
        Example(ParallelStiffnessVariation(variation=0.3, phase=0.4), "gear", ("variation",)),
        Example(InertiaVariation(variation=0.3, phase=0.4), "load", ("variation",)),
        Example(
            Cogging(amplitude=0.3, order=6.0, phase=0.4, second_amplitude=0.1, third_amplitude=0.05, third_phase=1.0),
            "motor",
            ("amplitude", "second_amplitude", "third_amplitude"),
        ),
        Example(
            HarmonicKinematicError(amplitude=arcmin(1.0), second_amplitude=arcmin(0.5), third_amplitude=arcmin(0.2), third_phase=1.0),
            "gear",
            ("amplitude", "second_amplitude", "third_amplitude"),
        ),
        Example(
            BeatingKinematicError(amplitude=arcmin(1.0), second_amplitude=arcmin(0.5), modulation=0.4, modulation_phase=0.5),
            "gear",
            ("amplitude", "second_amplitude"),
        ),
        Example(ActuatorLag(time_constant=5e-3), "motor", ("time_constant",)),
        Example(SupplySag(sag=0.3, torque_limit=15.0), "motor", ("sag",)),
        Example(MotorScale(error=0.2), "motor", ("error",)),
        Example(MotorSaturation(saturation=0.01), "motor", ("saturation",)),
        Example(HiddenMode(inertia=0.2, natural_frequency=150.0, damping_ratio=0.3), "load", ("inertia",)),
        Example(FlexibleInertia(share=0.3, natural_frequency=150.0, damping_ratio=0.3), "load", ("share",)),
        Example(SeriesCompliance(compliance=2e-5), "gear", ("compliance",)),
        Example(Creep(compliance=2e-5, relaxation_time=5e-3), "gear", ("compliance",)),
        Example(JointSlip(slip_torque=0.02, slip_rate=0.5), "coupling", ("slip_rate",)),
        Example(ThermalDrift(viscous_change=5.0, friction_change=-3.0, time_constant=0.05), "load", ("viscous_change", "friction_change")),
        Example(LoadLag(time_constant=5e-3), "load", ("time_constant",)),
        Example(ExternalTorque(amplitude=20.0, frequency=300.0, phase=0.4), "load", ("amplitude",)),
        Example(UnequalDrag(viscous=10.0, friction=-3.0), "load", ("viscous", "friction")),
        Example(
            FrictionByAngle(mean=5.0, once=2.0, once_phase=0.3, twice=1.0, thrice=0.5, thrice_phase=1.0),
            "load",
            ("mean", "once", "twice", "thrice"),
        ),
        Example(RubAtAngle(friction=5.0, angle=0.3, sharpness=2.0), "load", ("friction",)),
        Example(SensorGain(error=0.1), "torque_sensor", ("error",)),
        Example(SensorOffset(offset=0.5), "torque_sensor", ("offset",)),
        Example(SensorLag(time_constant=2e-3), "load_encoder", ("time_constant",)),
        Example(SensorDelay(delay=2e-3), "load_encoder", ("delay",)),
        Example(EncoderEccentricity(amplitude=1e-3, phase=0.4), "load_encoder", ("amplitude",)),
        Example(SensorQuantisation(resolution=1e-3), "load_encoder", ("resolution",)),
        Example(SensorDrift(offset=0.5, time_constant=0.05), "torque_sensor", ("offset",)),
        Example(SealDrag(scale=10.0), "load", ("scale",)),
        Example(RelaxingSpring(stiffness=2e4, relaxation_time=5e-3), "gear", ("stiffness",)),
    )
}


TRAIN_KINDS = ("body", "connection", "gear", "coupling", "motor", "sensor", "load")
"""Kinds of places that a drive train has; effects at others are held to the contract in test_rotor_effects.py."""


def effects_of_package() -> list[type[Effect]]:
    """Every concrete effect that the package defines for drive trains."""
    return [kind for kind in all_effects() if kind.acts_on in TRAIN_KINDS]


def all_effects() -> list[type[Effect]]:
    """Every concrete effect that the package defines."""
    for module in pkgutil.walk_packages(hdrive_mbs.effects.__path__, "hdrive_mbs.effects."):
        importlib.import_module(module.name)
    found, stack = [], [Effect]
    while stack:
        kind = stack.pop()
        stack += kind.__subclasses__()
        if kind.__module__.startswith("hdrive_mbs.effects.") and not inspect.isabstract(kind):
            found.append(kind)
    return sorted(found, key=lambda kind: kind.__name__)


EFFECTS = [*effects_of_package(), SealDrag, RelaxingSpring]


@pytest.fixture(params=EFFECTS, ids=lambda kind: kind.__name__)
def example(request: pytest.FixtureRequest) -> Example:
    if request.param not in EXAMPLES:
        pytest.fail(f"{request.param.__name__} has no example: add a line to EXAMPLES in {__file__}.")
    return EXAMPLES[request.param]


# -- the train they act on ----------------------------------------------------------------------------

DURATION = 0.1
START_SPEED = -20.0
"""Motor speed at t = 0 [rad/s]: backwards, so that every speed passes through zero."""
TIGHT = DormandPrince(relative_tolerance=1e-10, absolute_tolerance=1e-12)


def train() -> Scene:
    """Motor, coupling, gear, load; the sine load turns the torque in the mesh round several times."""
    return Scene(
        name="train",
        parts={
            "motor": Motor(
                inertia=1.5e-3,
                characteristic=AsynchronousMotor(rated_power=550.0, rated_speed=rpm(1410), pole_pairs=2, breakdown_ratio=2.4),
            ),
            "coupling": Shaft(stiffness=200.0, damping=0.05),
            "gear": HarmonicDrive(
                ratio=100.0,
                stiffness=PiecewiseLinearStiffness(
                    lost_motion=0.0, stiffness_1=3.2e4, stiffness_2=6.4e4, stiffness_3=11e4, torque_1=23.5, torque_2=98.0
                ),
                damping=20.0,
                wave_generator_inertia=1.69e-4,
                flexspline_inertia=4e-4,
            ),
            "load": Load(inertia=0.5, torque=SineTorque(mean=10.0, amplitude=40.0, frequency=25.0)),
            "load_encoder": Sensor(quantity="load.angle"),
            "torque_sensor": Sensor(quantity="gear.torque"),
            "copy": Sensor(quantity="load_encoder", gain=2.0),
        },
        connections=[("motor", "coupling", "gear", "load")],
    )


def placed(example: Example, effect: Effect | None = None) -> Scene:
    return train().with_effect(effect or example.effect, at=example.at, name="it")


def without_size(example: Example) -> Effect:
    """The effect with its size fields at zero."""
    zero = {name: (0.0,) * len(value) if isinstance(value := getattr(example.effect, name), tuple) else 0.0 for name in example.size}
    return example.effect.replacing(**zero)


def start_speeds(network: Network) -> dict[str, float]:
    return {body.name: body.sense * body.ratio * START_SPEED for body in network.bodies}


@functools.cache
def engine_run(scene: Scene, solver: Solver) -> RawRun:
    network = scene.network()
    with warnings.catch_warnings():
        warnings.simplefilter("error", LoweringWarning)
        assembly = assemble(network)
    assert all(item.how in ("native", "symbolic") for item in assembly.lowered)
    return run(assembly, duration=DURATION, solver=solver, angles={}, speeds=start_speeds(network), states={})


def reference_run(network: Network, times: np.ndarray) -> dict[str, np.ndarray]:
    """The network's equations in scipy with plain floats: nothing recorded, nothing of the engine."""
    bodies, states = [body.name for body in network.bodies], [state.name for state in network.states]
    n = len(bodies)

    def rates(t: float, y: np.ndarray) -> list[float]:
        values = y.tolist()
        moment = network.moment(
            t,
            dict(zip(bodies, values[:n], strict=True)),
            dict(zip(bodies, values[n : 2 * n], strict=True)),
            dict(zip(states, values[2 * n :], strict=True)),
        )
        slopes = network.accelerations(moment)
        return [*values[n : 2 * n], *(float(slopes[name]) for name in [*bodies, *states])]

    speeds = start_speeds(network)
    start = [0.0] * n + [speeds[name] for name in bodies] + [state.initial for state in network.states]
    solution = solve_ivp(rates, (0.0, DURATION), start, method="DOP853", rtol=1e-10, atol=1e-12, t_eval=times)
    assert solution.success, solution.message
    named = {f"angle of {name}": solution.y[k] for k, name in enumerate(bodies)}
    named |= {f"speed of {name}": solution.y[n + k] for k, name in enumerate(bodies)}
    return named | {name: solution.y[2 * n + k] for k, name in enumerate(states)}


def channels(raw: RawRun) -> dict[str, np.ndarray]:
    named = {f"angle of {name}": values for name, values in raw.angles.items()}
    named |= {f"speed of {name}": values for name, values in raw.speeds.items()}
    return named | dict(raw.states)


def observed(scene: Scene, solver: Solver) -> dict[str, np.ndarray]:
    """Angles, speeds, states and readings of sensors of a run on the engine."""
    raw, network = engine_run(scene, solver), scene.network()
    moment = network.moment(raw.times, raw.angles, raw.speeds, raw.states)
    return channels(raw) | {f"reading of {c.name}": np.asarray(c.read(moment)) for c in network.channels if c.reads}


def distance(a: Mapping[str, np.ndarray], b: Mapping[str, np.ndarray]) -> dict[str, float]:
    """Largest difference of each channel of b over its largest value."""
    return {name: float(np.max(np.abs(a[name] - b[name])) / np.max(np.abs(b[name]))) for name in b}


def moments(network: Network, count: int = 200) -> Moment:
    """Moments of the size that a train sees: a few turns, twists of minutes of arc, both senses."""
    rng = np.random.default_rng(7)
    turns, speed = rng.uniform(-20.0, 20.0, count), rng.uniform(-200.0, 200.0, count)
    ratio = {body.name: abs(body.ratio) for body in network.bodies}
    return network.moment(
        rng.uniform(0.0, 1.0, count),
        {name: r * turns + rng.normal(0.0, 1e-3, count) for name, r in ratio.items()},
        {name: r * speed + rng.normal(0.0, 0.3, count) for name, r in ratio.items()},
        {state.name: rng.normal(0.0, 2.0, count) for state in network.states},
    )


def power_taken(example: Example, moment: Moment) -> tuple[np.ndarray, np.ndarray]:
    """Power that the effect takes from the bodies [W], by the difference of the trains with and without it, and its rounding."""
    with_it, bare = placed(example).network(), train().network()
    torque, bare_torque = with_it.torques(moment), bare.torques(moment)
    taken, size = np.zeros(np.shape(moment.time)), np.zeros(np.shape(moment.time))
    for body in with_it.bodies:
        speed = moment.speed(body.name)
        taken -= (torque[body.name] - bare_torque[body.name]) * speed
        size += np.abs(bare_torque[body.name] * speed) + np.abs(torque[body.name] * speed)
    return taken, 1e-12 * size


# -- what every effect must keep ------------------------------------------------------------------------


def test_every_effect_of_the_package_has_an_example() -> None:
    missing = [kind.__name__ for kind in effects_of_package() if kind not in EXAMPLES]
    assert not missing, f"no line in EXAMPLES for {', '.join(missing)}"


def test_the_walk_finds_the_effects_and_not_their_shapes() -> None:
    names = {kind.__name__ for kind in effects_of_package()}
    assert {"CoulombStribeckFriction", "KinematicError", "MaxwellSlipHysteresis"} <= names
    shapes = {"Effect", "TorqueEffect", "TwistEffect", "LawEffect", "MemoryTwistEffect", "MotorEffect", "SensorEffect"}
    assert not names & (shapes | {"SealDrag"})


def test_it_runs_without_a_python_callback(example: Example) -> None:
    network = placed(example).network()
    with warnings.catch_warnings():
        warnings.simplefilter("error", LoweringWarning)
        lowered = assemble(network).lowered
    assert {item.element for item in lowered} == {element.name for element in network.elements}
    assert {item.how for item in lowered} <= {"native", "symbolic"}


def test_of_size_zero_it_changes_nothing(example: Example) -> None:
    # a fixed step gives both runs the same times; equal equations then differ by rounding alone,
    # about 1e-16 per step over 1000 steps
    solver = RungeKutta4(step=1e-4)
    difference = distance(observed(placed(example, without_size(example)), solver), observed(train(), solver))
    assert max(difference.values()) < 1e-12, difference


def test_of_example_size_it_can_be_seen(example: Example) -> None:
    # a thousand times the error that the engine is allowed (1e-6)
    difference = distance(observed(placed(example), RungeKutta4(step=1e-4)), observed(train(), RungeKutta4(step=1e-4)))
    assert max(difference.values()) > 1e-3, difference


def test_the_engine_agrees_with_scipy(example: Example) -> None:
    scene = placed(example)
    raw = engine_run(scene, TIGHT)
    difference = distance(channels(raw), reference_run(scene.network(), raw.times))
    assert max(difference.values()) < 1e-6, difference


def test_it_never_delivers_power_if_it_says_so(example: Example) -> None:
    check_claims(placed(example).network())
    if not example.effect.dissipative:
        return
    network = placed(example).network()
    moment = moments(network)
    taken, rounding = power_taken(example, moment)
    heat = taken - growth_of_stored_energy(network, moment)
    assert (heat >= -rounding).all(), float(heat.min())
    assert heat.max() > 0.0


def growth_of_stored_energy(network: Network, moment: Moment) -> np.ndarray:
    """dU/dt of what the effect says it stores, by central differences along the states' rates; exact for quadratic energies."""
    claims = [claim for element in network.elements if hasattr(element, "claims") for claim in element.claims()]
    stored = [claim.stored for claim in claims if claim.name == "it" and claim.stored is not None]
    if not network.states or not stored:
        return np.zeros(np.shape(moment.time))
    step = 1e-3
    slopes = network.accelerations(moment)
    scale = max(np.max(np.abs(slopes[state.name])) for state in network.states)

    def energy(sign: float) -> np.ndarray:
        moved = {state.name: moment.state(state.name) + sign * step * slopes[state.name] / scale for state in network.states}
        return sum(function(dataclasses.replace(moment, states=moved)) for function in stored)

    return (energy(1.0) - energy(-1.0)) / (2.0 * step) * scale


def test_it_takes_energy_over_a_run_if_it_says_so(example: Example) -> None:
    if not example.effect.dissipative:
        assert example.effect.dissipative is False
        return
    network = placed(example).network()
    raw = engine_run(placed(example), TIGHT)
    taken, _ = power_taken(example, network.moment(raw.times, raw.angles, raw.speeds, raw.states))
    energy = np.concatenate(([0.0], np.cumsum(0.5 * (taken[1:] + taken[:-1]) * np.diff(raw.times))))
    # what it takes from the start, where its states are at rest, is heat and what it stores: never below zero;
    # the trapezoidal sum over the solver's own steps is good to 1e-3 of the energy that passed
    passed = np.sum(0.5 * np.abs(taken[1:] + taken[:-1]) * np.diff(raw.times))
    assert energy.min() >= -1e-3 * passed
    assert energy[-1] > 0.1 * passed


def test_connections_turn_power_over_without_loss_or_gain(example: Example) -> None:
    network = placed(example).network()
    moment = moments(network)
    for element in network.elements:
        if not isinstance(element, Connection):
            continue
        put_in = sum(torque * moment.speed(name) for name, torque in element.contribution(moment).items())
        through = element.value(moment) * element.rate(moment)
        size = sum(np.abs(torque * moment.speed(name)) for name, torque in element.contribution(moment).items())
        assert np.all(np.abs(put_in + through) <= 1e-12 * size), element.name


def test_its_text_states_equation_source_and_what_it_leaves_out(example: Example) -> None:
    kind = type(example.effect)
    text = inspect.getdoc(kind) or ""
    assert re.search(r"^\w+ = \S", text, re.MULTILINE), "no line with an equation"
    assert "Source:" in text
    assert re.search(r"[Ll]eaves\s+out", text)
    assert len(kind.signature.split()) >= 3
    for name, _, metadata in example.effect.fields():
        quantity = metadata.get("quantity")
        assert (quantity.doc and quantity.unit) if quantity else metadata.get("doc"), f"{kind.__name__}.{name} has no doc or unit"


def test_it_says_its_kind_its_family_and_where_a_search_begins(example: Example) -> None:
    kind = type(example.effect)
    assert kind.kind in KINDS
    assert kind.acts_on in PLACES
    assert kind.family.isidentifier()
    assert kind.family == kind.family.lower()
    known = {name: metadata.get("quantity") for name, _, metadata in example.effect.fields()}
    varied = {name: quantity for name, quantity in known.items() if quantity is not None and quantity.typical is not None}
    if kind in effects_of_package() and kind in known_effects():
        needed = {field.name for field in dataclasses.fields(kind) if field.default is dataclasses.MISSING}
        assert needed <= set(varied) | set(kind.starts)
        assert set(example.size) & set(varied)
    for name, quantity in varied.items():
        for value in quantity.typical:
            quantity.check(name, value)
        assert quantity.typical[0] < quantity.typical[1]
        assert f"typically {quantity.typical[0]:g} to {quantity.typical[1]:g}" in (inspect.getdoc(kind) or "")


def test_its_places_are_those_where_it_can_be_put(example: Example) -> None:
    kind = type(example.effect)
    network = train().network()
    places = kind.places(network)
    assert len(set(places)) == len(places)
    assert network.places.get(example.at, example.at) in places
    held = train().replacing({"motor.characteristic": IdealSpeedMotor(motion=SpeedRamp(start=0.0, end=10.0, duration=1.0))})
    for scene in (train(), held):
        listed = kind.places(scene.network())
        for place in listed:
            changed = scene.with_effect(example.effect, at=place, name="it").network()
            assert len(changed.elements) + len(changed.states) > 0
        every = {place for find in PLACES.values() for place in find(scene.network())}
        refused = set()
        for place in sorted(every - set(listed)):
            try:
                scene.with_effect(example.effect, at=place, name="it")
            except PlaceError:
                refused.add(place)
        # what is left takes the effect but makes no sense for it: a ripple on what is no motor, a clamp inside a gear, an inertia of a
        # round rotor that varies
        left = every - set(listed) - refused
        round_ones = {*PLACES["motor"](scene.network()), *gear_flanges(scene.network(), "wave_generator")}
        assert (
            not left
            or kind.acts_on == "motor"
            or (kind.acts_on == "coupling" and left == set(PLACES["gear"](scene.network())))
            or (kind is InertiaVariation and left <= round_ones)
        ), left


def test_a_compiled_run_equals_that_of_the_engine(example: Example) -> None:
    # the same method with the same steps: only rounding differs, which 1000 steps and the corners of laws enlarge
    solver = RungeKutta4(step=1e-4)
    scene = placed(example)
    network = scene.network()
    senses = {body.name: body.sense for body in network.bodies}
    names = [f"{name}.{what}" for name in senses for what in ("angle", "speed")] + [state.name for state in network.states]
    readings = [channel.name for channel in network.channels if channel.reads]
    line = CompiledLine(network, [*names, *readings])
    run = line.run(11, 0.1 * DURATION, step=solver.step, speeds=start_speeds(network))
    engine = observed(scene, solver)
    at = np.searchsorted(engine_run(scene, solver).times, run.times - 0.5 * solver.step)
    for name in names:
        body, _, what = name.rpartition(".")
        wanted = senses[body] * engine[f"{what} of {body}"] if body in senses else engine[name]
        np.testing.assert_allclose(run.values[name], wanted[at], rtol=0.0, atol=1e-6 * np.max(np.abs(wanted)), err_msg=name)
    for name in readings:
        wanted = engine[f"reading of {name}"]
        np.testing.assert_allclose(run.values[name], wanted[at], rtol=0.0, atol=1e-6 * np.max(np.abs(wanted)), err_msg=name)


def test_its_size_can_be_zero_but_only_negative_where_that_means_something(example: Example) -> None:
    for name in example.size:
        value = getattr(example.effect, name)
        quantity = next(item.metadata["quantity"] for item in dataclasses.fields(example.effect) if item.name == name)
        if quantity.low != 0.0:
            assert quantity.low < 0.0 < quantity.high
            example.effect.replacing(**{name: -value})
            with pytest.raises(ParameterError, match=re.escape(f"at least {quantity.low}")):
                example.effect.replacing(**{name: 2.0 * quantity.low})
            continue
        bad = (*value[:-1], -value[-1]) if isinstance(value, tuple) else -value
        with pytest.raises(ParameterError) as caught:
            example.effect.replacing(**{name: bad})
        message = str(caught.value)
        shown = f"{bad[-1]:g}" if isinstance(bad, tuple) else f"{bad:g}"
        assert f"{type(example.effect).__name__}.{name}" in message
        assert shown in message
        assert quantity.unit == "1" or quantity.unit in message
        assert "at least 0" in message


def test_it_refuses_numbers_that_are_not_finite(example: Example) -> None:
    for name, value, metadata in example.effect.fields():
        if "quantity" not in metadata:
            continue
        for bad in (math.nan, math.inf):
            entry = (bad,) * len(value) if isinstance(value, tuple) else bad
            with pytest.raises(ParameterError, match=rf"{type(example.effect).__name__}\.{name}.*finite"):
                example.effect.replacing(**{name: entry})


def test_it_refuses_unknown_fields(example: Example) -> None:
    with pytest.raises(TypeError, match="strenght"):
        type(example.effect)(strenght=1.0)
    with pytest.raises(PlaceError, match="strenght"):
        example.effect.replacing(strenght=1.0)


def test_it_is_compared_by_value_and_set_by_path(example: Example) -> None:
    twin = dataclasses.replace(example.effect)
    assert twin is not example.effect
    assert twin == example.effect
    scene = placed(example)
    assert scene == placed(example)
    for name in example.size:
        value = getattr(example.effect, name)
        half = tuple(0.5 * item for item in value) if isinstance(value, tuple) else 0.5 * value
        if name == "coulomb" and hasattr(example.effect, "breakaway"):  # stays below the breakaway torque
            assert half < example.effect.breakaway
        elif name == "breakaway":
            half = 2.0 * value
        changed = scene.replacing({f"it.{name}": half})
        assert getattr(changed.effect("it").effect, name) == half
        assert changed != scene
        if not isinstance(value, tuple):
            assert scene.parameters()[f"it.{name}"].value == value
            assert changed.parameters()[f"it.{name}"].value == half
    with pytest.raises(PlaceError, match="strenght"):
        scene.replacing({"it.strenght": 1.0})


def test_its_ranges_hold_the_example_and_zero(example: Example) -> None:
    ranges = {item.path: item for item in placed(example).parameters().values() if item.path.startswith("it.")}
    for item in ranges.values():
        assert item.low <= item.value <= item.high, item
    for name in example.size:
        if f"it.{name}" in ranges:
            assert ranges[f"it.{name}"].low <= 0.0


def test_at_a_place_of_the_wrong_kind_it_lists_the_right_ones(example: Example) -> None:
    wrong = "coupling" if example.effect.acts_on in ("body", "motor") else "motor"
    right = {"motor", "load"} if example.effect.acts_on in ("body", "motor") else {example.at}
    with pytest.raises(PlaceError) as caught:
        train().with_effect(example.effect, at=wrong)
    message = str(caught.value)
    assert type(example.effect).__name__ in message
    assert wrong in message
    assert right <= set(re.findall(r"[\w.]+\b", message))


def test_at_an_unknown_place_it_lists_the_right_ones(example: Example) -> None:
    with pytest.raises(PlaceError, match=r"No (body|connection|sensor) 'gaer'") as caught:
        train().with_effect(example.effect, at="gaer")
    assert example.at in str(caught.value)


def test_it_survives_a_scene_file(example: Example) -> None:
    scene = placed(example)
    assert scene_from_dict(scene_to_dict(scene), types=[type(example.effect)]) == scene


# -- claims that are broken ------------------------------------------------------------------------------


@dataclass(frozen=True, kw_only=True)
class PushingDrag(TorqueEffect):
    """A drag with its sign turned."""

    coefficient: float = parameter("N m s/rad", "drag coefficient", low=0.0)
    dissipative: ClassVar[bool] = True

    def torque(self, time: Value, angle: Value, speed: Value) -> Value:
        return self.coefficient * speed


@dataclass(frozen=True, kw_only=True)
class PushingDamper(TwistEffect):
    """A damper with its sign turned."""

    dissipative: ClassVar[bool] = True

    def torque(self, time: Value, twist: Value, rate: Value) -> Value:
        return -3.0 * rate


@dataclass(frozen=True, kw_only=True)
class SpringThatClaims(TwistEffect):
    """A spring: it gives back what it took, so it is not dissipative without saying what it stores."""

    dissipative: ClassVar[bool] = True

    def torque(self, time: Value, twist: Value, rate: Value) -> Value:
        return 100.0 * twist


@dataclass(frozen=True, kw_only=True)
class ForgetfulSpring(RelaxingSpring):
    """A relaxing spring that understates its energy by half."""

    def stored(self, state: Mapping[str, Value]) -> Value:
        return 0.5 * super().stored(state)


@dataclass(frozen=True, kw_only=True)
class DragThatDecides(TorqueEffect):
    """A drag with a Python 'if' and its sign turned: only plain numbers can be put in."""

    dissipative: ClassVar[bool] = True

    def torque(self, time: Value, angle: Value, speed: Value) -> Value:
        return 1.0 if speed > 0.0 else -1.0


@pytest.mark.parametrize(
    ("effect", "at"),
    [
        (PushingDrag(coefficient=2.0), "load"),
        (PushingDamper(), "gear"),
        (SpringThatClaims(), "coupling"),
        (ForgetfulSpring(stiffness=1e3, relaxation_time=0.1), "gear"),
        (DragThatDecides(), "motor"),
    ],
    ids=lambda item: type(item).__name__ if isinstance(item, Effect) else item,
)
def test_a_broken_claim_is_refused_with_the_moment_and_the_way_out(effect: Effect, at: str) -> None:
    with pytest.raises(LawError) as caught:
        check_claims(train().with_effect(effect, at=at, name="culprit").network())
    message = str(caught.value)
    assert "'culprit' claims to be dissipative" in message
    assert re.search(r"-[\d.e+]+ W", message)
    assert "speed of load" in message
    assert "dissipative = False" in message


def test_a_law_that_gives_no_number_somewhere_breaks_its_claim() -> None:
    @dataclass(frozen=True, kw_only=True)
    class RootDrag(TorqueEffect):
        dissipative: ClassVar[bool] = True

        def torque(self, time: Value, angle: Value, speed: Value) -> Value:
            return -np.sqrt(speed)  # not a number for negative speed

    with pytest.raises(LawError, match="nan W"):
        check_claims(train().with_effect(RootDrag(), at="load").network())


def test_a_train_without_claims_passes() -> None:
    check_claims(train().network())

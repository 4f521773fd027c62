"""A rotor bench as its builder knows it: two unbalanced rotors on a shaft in two bearings on elastic supports.

The numbers are those of the bench's data sheet (withheld cases, round 1, rotor_bench.toml).  At 4 kHz it records the held
torque, an encoder at the drive end, probes at both rotors and accelerometers on both housings, in three experiments:
``run_up``, ``steps`` of speed, and ``bump``, a hammer on rotor 1 at standstill.

    from models import rotor_bench
    scene = rotor_bench.build("run_up")
    response = hm.simulate(scene, 4.2, solver=rotor_bench.SOLVER, **rotor_bench.start("run_up"))

``bench()`` is what a diagnosis needs to know of it.

With ``spin=(times, angles)`` the drive end follows its measured angle in place of its controller: what is wrong in drag
and inertia then does not add up in the phase of the unbalance.  The data sheet has no axial motion; here bearing 1
locates the shaft, and nothing excites it.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.interpolate import make_lsq_spline
from scipy.linalg import expm

import hdrive_mbs as hm
from hdrive_mbs.analysis.whirl.line_matrices import LineMatrices
from hdrive_mbs.analysis.whirl.rotor_point import rotor_point
from hdrive_mbs.diagnosis.bench import Bench, Uncertain, even_step, held_out
from hdrive_mbs.diagnosis.experiment.plan import Course, Plan
from hdrive_mbs.diagnosis.experiment.rotor_menu import rotor_menu
from hdrive_mbs.diagnosis.measured import Measured
from hdrive_mbs.diagnosis.trial import Trial
from hdrive_mbs.errors import ParameterError, RecordError
from hdrive_mbs.expression import Value
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.node import Node
from hdrive_mbs.records.record import Record
from hdrive_mbs.tables import EDGE

FloatArray = npt.NDArray[np.float64]

# -- the data sheet ------------------------------------------------------------------------------------

POSITIONS = {"bearing_1": 0.0, "rotor_1": 0.42, "bearing_2": 0.78, "rotor_2": 0.95}
"""Of the stations along the shaft [m]; the drive end is at bearing 1."""

AXIAL_STIFFNESS, AXIAL_DAMPING = 1e7, 1e3
"""Of bearing 1 [N/m, N s/m]: ours, the data sheet has none."""

BEARINGS, SECTIONS = ("bearing_1", "bearing_2"), ("section_1", "section_2", "section_3")

NOMINAL: dict[str, float] = {
    "youngs_modulus": 2.06e11,
    "shear_modulus": 7.9e10,
    "shaft_diameter": 0.045,
    "shaft_damping": 3.0e-5,  # s, over stiffness, not rotating, bending and torsion
    "drag": 0.002,  # N m s/rad at each station
    "rotor_1_mass": 24.0,
    "rotor_1_polar_inertia": 0.36,
    "rotor_1_transverse_inertia": 0.21,
    "rotor_1_eccentricity": 8e-6,
    "rotor_1_angle": 0.6,
    "rotor_1_tilt": 2e-4,
    "rotor_1_tilt_angle": -1.1,
    "rotor_2_mass": 7.0,
    "rotor_2_polar_inertia": 0.055,
    "rotor_2_transverse_inertia": 0.032,
    "rotor_2_eccentricity": 5e-6,
    "rotor_2_angle": 2.2,
    "ring_mass": 1.1,
    "ring_polar_inertia": 3e-3,
    "ring_transverse_inertia": 2.5e-3,
    "bearing_stiffness": 6.5e7,  # ring to housing
    "bearing_damping": 2500.0,
    "tilt_stiffness": 2.0e4,  # ring to ground
    "tilt_damping": 4.0,
    "housing_mass": 9.0,
    "support_stiffness_x": 3.2e7,
    "support_stiffness_y": 4.1e7,
    "support_damping": 6000.0,
}
"""Parameters of the bench, SI.  Rings, bearings, housings and supports are alike at both bearings."""

KNOWLEDGE: dict[str, float] = {
    "youngs_modulus": 0.006,
    **{f"rotor_{k}_{what}": 0.006 for k in (1, 2) for what in ("mass", "polar_inertia", "transverse_inertia")},
    **dict.fromkeys(("bearing_stiffness", "support_stiffness_x", "support_stiffness_y"), 0.02),
    **dict.fromkeys(("bearing_damping", "support_damping", "shaft_damping"), 0.08),
    "rotor_1_eccentricity": 0.05,
    "rotor_2_eccentricity": 0.05,
}
"""Standard deviation of the logarithm of each parameter that is not exact, independent of each other."""

GROUPS: dict[str, tuple[str, ...]] = {
    "bearing_stiffness": ("bearing_stiffness",),
    "bearing_damping": ("bearing_damping",),
    "support_stiffness": ("support_stiffness_x", "support_stiffness_y"),
    "support_damping": ("support_damping",),
    "shaft_stiffness": ("youngs_modulus",),
    "shaft_damping": ("shaft_damping",),
    **{f"rotor_{k}_mass": tuple(f"rotor_{k}_{what}" for what in ("mass", "polar_inertia", "transverse_inertia")) for k in (1, 2)},
    **{f"rotor_{k}_eccentricity": (f"rotor_{k}_eccentricity",) for k in (1, 2)},
}
"""Parameters that are wrong together, if they are wrong: of both bearings or supports, of a rotor.  What is wrong at one bearing
or support alone is an effect there (BearingStiffnessChange, SupportStiffnessChange, ...)."""

PATHS: dict[str, tuple[str, ...]] = {
    "youngs_modulus": tuple(f"{name}.youngs_modulus" for name in SECTIONS),
    "shear_modulus": tuple(f"{name}.shear_modulus" for name in SECTIONS),
    "shaft_diameter": tuple(f"{name}.diameter" for name in SECTIONS),
    "shaft_damping": tuple(f"{name}.damping" for name in SECTIONS),
    "drag": tuple(f"drag_{name}.coefficient" for name in POSITIONS),
    **{name: (f"{name[:7]}.{name[8:]}",) for name in NOMINAL if name.startswith("rotor_")},
    **{f"ring_{what}": tuple(f"{name}.{what}" for name in BEARINGS) for what in ("mass", "polar_inertia", "transverse_inertia")},
    **{f"bearing_{what}": tuple(f"{name}.law.{what}_{d}" for name in BEARINGS for d in ("xx", "yy")) for what in ("stiffness", "damping")},
    **{f"tilt_{what}": tuple(f"{name}.law.{what}_{d}" for name in BEARINGS for d in ("psi", "theta")) for what in ("stiffness", "damping")},
    "housing_mass": tuple(f"{name}.housing.mass" for name in BEARINGS),
    **{f"support_stiffness_{d}": tuple(f"{name}.housing.stiffness_{d}" for name in BEARINGS) for d in "xy"},
    "support_damping": tuple(f"{name}.housing.damping_{d}" for name in BEARINGS for d in "xy"),
}
"""Where each parameter sits in the scene, for ``scene.replacing``.  What of the controller depends on parameters (see
HeldSpeedControl) stays as it was built; a deviation from there is fed back all the same."""

GAIN, TORQUE_LIMIT, SAMPLE_TIME = 4.0, 170.0, 1.0 / 4000.0
"""Speed control at the drive end [N m s/rad, N m, s]: it reads speed and reference and holds its torque for a sample."""

REFERENCES: dict[str, tuple[tuple[float, ...], tuple[float, ...]]] = {
    "run_up": ((0.0, 0.1, 3.6, 4.2), (0.0, 20.0, 1000.0, 1000.0)),
    "steps": (
        (0.0, 0.6, 0.8, 1.4, 1.6, 2.2, 2.4, 3.0, 3.2, 3.8, 4.0, 4.8),
        (180.0, 180.0, 320.0, 320.0, 480.0, 480.0, 640.0, 640.0, 800.0, 800.0, 940.0, 940.0),
    ),
    "bump": ((0.0, 1.2), (0.0, 0.0)),
}
"""Record -> times [s] and speed references [rad/s], straight lines between.  A record lasts until the last time."""

HAMMER: dict[str, float] = {"x": 0.050, "y": 0.650}
"""Start of the blow on rotor 1 in each direction, record bump [s]."""
BLOW, BLOW_TIME = 2500.0, 3e-3
"""Peak [N] and length [s] of a blow, a half sine, sampled and held."""

CHANNELS: dict[str, str] = {
    "motor_torque": "drive.torque",
    "spin_angle": "bearing_1.angle",
    **{f"r{k}_{d}": f"rotor_{k}.{d}" for k in (1, 2) for d in "xy"},
    **{f"h{k}_a{d}": f"bearing_{k}.housing.{d}_acceleration" for k in (1, 2) for d in "xy"},
    **{f"hammer_{d}": f"hammer.force_{d}" for d in "xy"},
}
"""Column of a record -> channel of the scene.  With a measured spin there is no torque to compare."""

SPEED = "speed_reference"
"""Input of a planned record."""
MENU_TIME = 3.0
"""Of the records that are proposed [s]."""
INPUTS = ("hammer_x", "hammer_y")
HELD = ("motor_torque", *INPUTS)
"""Columns of what is held from a sample on: compare them with the scene half a sample later."""
OFFSET_FREE = ("r1_x", "r1_y", "r2_x", "r2_y")
"""Columns whose offset is unknown and another one in each record."""

NOISE: dict[str, float] = {
    "motor_torque": 0.05,
    "spin_angle": 0.0,
    **dict.fromkeys(("r1_x", "r1_y", "r2_x", "r2_y"), 2.5e-7),
    **dict.fromkeys(("h1_ax", "h1_ay", "h2_ax", "h2_ay"), 0.05),
    **dict.fromkeys(INPUTS, 1.0),
}
"""Standard deviation of the white noise of each column, SI."""

RESOLUTION: dict[str, float] = {
    "motor_torque": 0.02,
    "spin_angle": 2.0 * math.pi / 8192.0,
    **dict.fromkeys(("r1_x", "r1_y", "r2_x", "r2_y"), 1e-7),
    **dict.fromkeys(("h1_ax", "h1_ay", "h2_ax", "h2_ay"), 0.02),
}
"""Steps of the columns that are rounded, after the noise is added, SI."""

KNOT_TIME = 0.02
"""Distance of the knots of the spline that smooths what is left of a measured angle [s]: 80 samples."""


def noise() -> dict[str, float]:
    """Standard deviation of each column: white noise and rounding (a uniform error of one step)."""
    return {name: math.hypot(sigma, RESOLUTION.get(name, 0.0) / math.sqrt(12.0)) for name, sigma in NOISE.items()}


NO_TORQUE = hm.TorqueHistory(times=(0.0, 1.0), torques=(0.0, 0.0))


# -- the scene -----------------------------------------------------------------------------------------


@dataclass(frozen=True, kw_only=True)
class HeldSpeedControl(hm.MotorCharacteristic):
    """A sampled speed controller as a law of continuous time:  M = clip(k (e(t) - z), -M_max, M_max),  z' = (w - v(t) - z)/T.

    The controller holds M_k = clip(k (ref_k - w_k)) for a sample.  The speed v(t) of the nominal line under exactly this
    control is worked out before, and e(t) = ref_k - v_k in sample k.  A deviation w - v is fed back with the lag
    T of half a sample, which is what sampling and holding delay it by on average; v is a line in each sample that has
    the right mean.  So where the line turns like v the law is right.  Leaves out the saw teeth of a held deviation.
    """

    gain: float = hm.parameter("N m s/rad", "k, torque per speed error", above=0.0)
    torque_limit: float = hm.parameter("N m", "largest torque M_max", above=0.0)
    lag: float = hm.parameter("s", "T, half a sample", above=0.0)
    times: tuple[float, ...] = hm.table("s", "times of the worked-out errors and speeds, rising")
    errors: tuple[float, ...] = hm.table("rad/s", "worked-out speed error e at these times")
    speeds: tuple[float, ...] = hm.table("rad/s", "worked-out speed v at these times")
    asked_times: tuple[float, ...] = hm.table("s", "times of the reference, rising")
    asked_speeds: tuple[float, ...] = hm.table("rad/s", "reference at these times")

    def torque(self, time: Value, speed: Value) -> Value:
        """Without the lag."""
        return self._limited(np.interp(time, self.times, self.errors) + np.interp(time, self.times, self.speeds) - speed)

    def _limited(self, error: Value) -> Value:
        return np.clip(self.gain * error, -self.torque_limit, self.torque_limit)

    def drive(self, name: str, node: Node, draft: Draft) -> None:
        def rate(moment: Moment) -> Value:
            return (moment.speed(node.name) - np.interp(moment.time, self.times, self.speeds) - moment.state(state)) / self.lag

        def torque(moment: Moment) -> Value:
            return self._limited(np.interp(moment.time, self.times, self.errors) - moment.state(state))

        def command(moment: Moment) -> Value:
            return self._limited(np.interp(moment.time, self.asked_times, self.asked_speeds) - moment.speed(node.name))

        state = draft.add_state(f"{name}.deviation", unit="rad/s", initial=0.0, rate=rate)
        draft.add_torque(f"{name}.torque", node.name, torque, is_motor=True)
        draft.add_channel(f"{name}.torque", "N m", f"torque of {name}", torque)
        draft.add_channel(f"{name}.command", "N m", f"at a sample: the torque that {name} takes up there and holds", command)


def build(
    record: str = "run_up",
    *,
    spin: tuple[Sequence[float], Sequence[float]] | None = None,
    hammer: Mapping[str, Sequence[float]] | None = None,
    **parameters: float,
) -> hm.Scene:
    """The bench as it is driven in a record.

    record : "run_up", "steps" or "bump"
    spin : (times, measured angles of the drive end) [s, rad]: follow this angle, smoothed, instead of the reference
    hammer : direction -> force [N] at each sample from t = 0, instead of the two blows of the data sheet
    parameters : other values for those of NOMINAL

    Raises ParameterError for an unknown record or parameter.
    """
    free = undriven(record, hammer=hammer, **parameters)
    return free.replacing({"drive.characteristic": _controller(record, free) if spin is None else _measured_spin(record, free, *spin)})


def undriven(record: str, *, hammer: Mapping[str, Sequence[float]] | None = None, **parameters: float) -> hm.Scene:
    """The bench with a drive that does nothing."""
    if record not in REFERENCES:
        raise hm.ParameterError(f"record = {record!r}: must be one of {', '.join(REFERENCES)}.")
    for name in parameters:
        if name not in NOMINAL:
            raise hm.ParameterError(f"No parameter {name!r}. The rotor bench has: {', '.join(NOMINAL)}.")
    p, blows = NOMINAL | parameters, _blows(record) if hammer is None else hammer
    housing = hm.Housing(
        mass=p["housing_mass"],
        stiffness_x=p["support_stiffness_x"],
        stiffness_y=p["support_stiffness_y"],
        damping_x=p["support_damping"],
        damping_y=p["support_damping"],
    )

    def bearing(*, locating: bool) -> hm.Bearing:
        law = hm.LinearBearing.isotropic(
            radial=p["bearing_stiffness"],
            damping=p["bearing_damping"],
            axial=AXIAL_STIFFNESS if locating else 0.0,
            axial_damping=AXIAL_DAMPING if locating else 0.0,
            tilt=p["tilt_stiffness"],
            tilt_damping=p["tilt_damping"],
        )
        ring = {what: p[f"ring_{what}"] for what in ("mass", "polar_inertia", "transverse_inertia")}
        return hm.Bearing(law=law, housing=housing, **ring)

    parts: dict[str, hm.Component] = {
        "bearing_1": bearing(locating=True),
        "rotor_1": hm.Rotor(**_of(p, "rotor_1")),
        "bearing_2": bearing(locating=False),
        "rotor_2": hm.Rotor(**_of(p, "rotor_2")),
    }
    chain = ["drive", "bearing_1"]
    for section, (left, right) in zip(SECTIONS, itertools.pairwise(POSITIONS), strict=True):
        parts[section] = hm.ShaftSection(
            length=POSITIONS[right] - POSITIONS[left],
            diameter=p["shaft_diameter"],
            youngs_modulus=p["youngs_modulus"],
            shear_modulus=p["shear_modulus"],
            damping=p["shaft_damping"],
        )
        chain += [section, right]
    parts |= {"drive": hm.DriveTorque(characteristic=NO_TORQUE), "gravity": hm.Gravity()}
    parts |= {f"probe_r{k}_{d}": hm.Sensor(quantity=f"rotor_{k}.{d}") for k in (1, 2) for d in "xy"}
    connections = [tuple(chain)]
    if blows:
        times = SAMPLE_TIME * np.arange(max(map(len, blows.values())))
        forces = {f"forces_{direction}": tuple(values) for direction, values in blows.items()}
        parts["hammer"] = hm.LateralForce(times=tuple(times), held=True, **forces)
        connections.append(("hammer", "rotor_1"))
    scene = hm.Scene(name="rotor bench", parts=parts, connections=connections)
    for station in POSITIONS:
        scene = scene.with_effect(hm.ViscousDrag(coefficient=p["drag"]), at=station, name=f"drag_{station}")
    return scene


def _of(p: Mapping[str, float], part: str) -> dict[str, float]:
    """Parameters of one part, by the names of its fields."""
    return {name.removeprefix(f"{part}_"): value for name, value in p.items() if name.startswith(f"{part}_")}


def _blows(record: str) -> dict[str, FloatArray]:
    """Force in each direction at the samples of a record [N]."""
    if record != "bump":
        return {}
    times = sample_times(record)
    return {
        d: np.where((times >= t) & (times <= t + BLOW_TIME), BLOW * np.sin(np.pi * (times - t) / BLOW_TIME), 0.0) for d, t in HAMMER.items()
    }


def sample_times(record: str) -> FloatArray:
    """Times of the samples of a record [s]."""
    return SAMPLE_TIME * np.arange(round(REFERENCES[record][0][-1] / SAMPLE_TIME))


def start(record: str, scene: hm.Scene | None = None) -> dict[str, Any]:
    """What ``hm.simulate`` needs to begin like a record: at rest or all at 180 rad/s, untwisted, in the static deflection.

    scene : the bench, if it is not the nominal one
    """
    still = undriven(record) if scene is None else scene.replacing({"drive.characteristic": NO_TORQUE})
    at_rest = rotor_point(still, 0.0).angles
    lateral = {body.name for body in still.network().bodies if body.lateral}
    return {"initial_speed": REFERENCES[record][1][0], "initial": {name: at_rest[name] for name in at_rest if name in lateral}}


# -- the drive -----------------------------------------------------------------------------------------


def held_control(record: str, free: hm.Scene) -> tuple[FloatArray, FloatArray, FloatArray]:
    """The line turning under its sampled controller: angles and speeds of the drive end, one more than samples, and torques.

    Torsion alone, linear, from sample to sample by the matrix exponential: exact but for what whirl takes from the
    spin (1e-4 to 4e-4 rad over a record).

    free : the bench without its drive, see ``undriven``
    """
    return _under_control(free, np.interp(sample_times(record), *REFERENCES[record]))


def _under_control(free: hm.Scene, references: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """``held_control`` for references at samples [rad/s]; all turns at the first of them at the start."""
    network = free.without("gravity").network()  # the weight of an eccentric rotor is no constant stiffness
    spins = [k for k, body in enumerate(network.bodies) if not body.lateral]
    zero = dict.fromkeys((body.name for body in network.bodies), 0.0)
    system = LineMatrices(network).at(zero, zero)
    mass, damping, stiffness = (matrix[np.ix_(spins, spins)] for matrix in (system.mass, system.damping, system.stiffness))
    n, drive = len(spins), [system.names[k] for k in spins].index("bearing_1")
    rates = np.zeros((2 * n + 1, 2 * n + 1))
    rates[:n, n : 2 * n] = np.eye(n)
    rates[n : 2 * n, : 2 * n] = -np.linalg.solve(mass, np.hstack([stiffness, damping]))
    rates[n : 2 * n, 2 * n] = np.linalg.solve(mass, np.eye(n)[drive])
    moved = expm(rates * SAMPLE_TIME)
    state = np.zeros(2 * n + 1)
    state[n : 2 * n] = references[0]
    torques, states = np.zeros(len(references)), np.zeros((len(references) + 1, 2))
    for k, reference in enumerate(references.tolist()):
        states[k] = state[drive], state[n + drive]
        torques[k] = state[2 * n] = min(max(GAIN * (reference - state[n + drive]), -TORQUE_LIMIT), TORQUE_LIMIT)
        state = moved @ state
    states[-1] = state[drive], state[n + drive]
    return states[:, 0], states[:, 1], torques


def _controller(record: str, free: hm.Scene) -> HeldSpeedControl:
    return _controller_of(REFERENCES[record], *held_control(record, free)[:2])


def _controller_of(reference: Course, angles: FloatArray, speeds: FloatArray) -> HeldSpeedControl:
    """The controller with what the line does under it; a change is a steep line centred on its sample."""
    times = SAMPLE_TIME * np.arange(len(angles) - 1)
    mean, error = np.diff(angles) / SAMPLE_TIME, np.interp(times, *reference) - speeds[:-1]
    half, rise = 0.5 * EDGE * SAMPLE_TIME, 0.5 * np.diff(speeds)

    def twice(first: FloatArray, second: FloatArray) -> tuple[float, ...]:
        return tuple(np.column_stack((first, second)).ravel().tolist())

    return HeldSpeedControl(
        gain=GAIN,
        torque_limit=TORQUE_LIMIT,
        lag=0.5 * SAMPLE_TIME,
        times=twice(times + half, times + SAMPLE_TIME - half),
        errors=twice(error, error),
        speeds=twice(mean - rise, mean + rise),
        asked_times=tuple(map(float, reference[0])),
        asked_speeds=tuple(map(float, reference[1])),
    )


def _measured_spin(record: str, free: hm.Scene, times: Sequence[float], angles: Sequence[float]) -> hm.IdealSpeedMotor:
    """The measured angle without the steps of its encoder: that of the controlled line, and a spline through the rest.

    The rest is smooth, because the twist and the fast part of the speed are in the controlled line: knots 0.02 s apart
    leave 1/sqrt(12) of a step times about sqrt(1/80).
    """
    at, measured = np.asarray(times, float), np.asarray(angles, float)
    turned, _, _ = held_control(record, free)
    own = SAMPLE_TIME * np.arange(len(turned))
    rest = measured - np.interp(at, own, turned)
    weights = np.where(at == 0.0, 1e3, 1.0)  # the angle is zero at t = 0
    knots = np.linspace(at[0], at[-1], max(2, round((at[-1] - at[0]) / KNOT_TIME) + 1))
    smooth = make_lsq_spline(at, rest, np.concatenate(([knots[0]] * 3, knots, [knots[-1]] * 3)), k=3, w=weights)
    found = turned + smooth(np.clip(own, at[0], at[-1]))
    return hm.IdealSpeedMotor(motion=hm.AngleTable(times=tuple(own), angles=tuple(found - found[0])))


SOLVER = hm.RungeKutta4(step=SAMPLE_TIME / 6.0)
"""Meets every sample; stable to SAMPLE_TIME/4.8, for the axial vibration of the ring between its short sections."""


# -- what a diagnosis knows ----------------------------------------------------------------------------

PROBES, ACCELEROMETERS = OFFSET_FREE, ("h1_ax", "h1_ay", "h2_ax", "h2_ay")
LATERAL, TORSION = (*PROBES, *ACCELEROMETERS), ("motor_torque", "spin_angle")
"""Columns that are compared while the drive end follows its measured angle, and under its controller."""

STEP = 1.0 / 12000.0
"""Longest step of the compiled integration [s] for the bench without effects: stable to 1/10600 s."""

NAMES: dict[tuple[str, str], tuple[str, str]] = {
    **{("probe_runout", f"rotor_{k}"): ("probe_runout", f"probe_rotor_{k}") for k in (1, 2)},
    **{("support_stiffness", f"bearing_{k}"): ("parameter_support_stiffness", f"support_{k}") for k in (1, 2)},
    **{
        (f"bearing_{what}", f"bearing_{k}"): (f"parameter_bearing_{what}", f"bearing_{k}")
        for k in (1, 2)
        for what in ("stiffness", "damping")
    },
    **{(family, f"bearing_{k}"): (family, f"support_{k}") for k in (1, 2) for family in ("hidden_mode_support", "looseness")},
    **{("crack", section): ("crack", "shaft") for section in SECTIONS},
    ("misalignment", "bearing_1"): ("misalignment", "drive_end"),
    ("torque_ripple", "drive"): ("torque_ripple", "drive_end"),
    ("parameter", "bearing_stiffness"): ("parameter_bearing_stiffness", "bearings"),
    ("parameter", "bearing_damping"): ("parameter_bearing_damping", "bearings"),
    ("parameter", "shaft_stiffness"): ("parameter_shaft_stiffness", "shaft"),
    **{("parameter", f"rotor_{k}_mass"): ("parameter_rotor_mass", f"rotor_{k}") for k in (1, 2)},
    **{("parameter", f"rotor_{k}_eccentricity"): ("unbalance", f"rotor_{k}") for k in (1, 2)},
}
"""(family, place of the scene) -> (effect, place) as the bench's people call them, where they differ."""


STILL = hm.AngleTable(times=(0.0, 1.0), angles=(0.0, 0.0))


def _hammer(blows: Mapping[str, FloatArray]) -> hm.LateralForce:
    """The hammer of a record; in most it does next to nothing, so that all records share their equations."""
    blows = blows or {"x": np.zeros(2), "y": np.full(2, 1e-30)}  # two tables, like those of two blows
    times = SAMPLE_TIME * np.arange(len(blows["x"]))
    return hm.LateralForce(times=tuple(times), held=True, forces_x=tuple(blows["x"]), forces_y=tuple(blows["y"]))


@dataclass(frozen=True, kw_only=True, eq=False)
class RotorBench(Bench):
    """The bench with two views of each record that share all parameters.

    lateral : the drive end follows its measured angle; probes and accelerometers are compared
    torsion : under the controller; held torque and encoder are compared (not at standstill)
    """

    def trials(self, record: Record) -> tuple[Trial, ...]:
        """Raises RecordError for a record that is none of the bench's, or lacks its columns."""
        if record.name not in REFERENCES:
            raise RecordError(f"Record {record.name!r} is none of the rotor bench: {', '.join(REFERENCES)}.")
        columns = self.columns_of(record)
        moving = record.name != "bump"
        if moving and "spin_angle" not in columns:
            raise RecordError(f"Record {record.name!r} has no column 'spin_angle', which drives the scene.")
        free = undriven(record.name)
        spin: hm.SpeedProfile = STILL
        if moving:
            follower = _measured_spin(record.name, free, record.times - record.times[0], columns["spin_angle"])
            assert isinstance(follower.motion, hm.SpeedProfile)
            spin = follower.motion
        scene = self.scene.replacing({"drive.characteristic": _controller(record.name, free), "hammer": _hammer(_blows(record.name))})
        begin = REFERENCES[record.name][1][0]
        return self._views(record.name, scene, spin, begin, columns, held_out(len(record), record.name), even_step(record))

    def planned(self, plan: Plan) -> tuple[Trial, ...]:
        """Inputs of a plan: speed_reference [rad/s], and the hammer on rotor 1, hammer_x and hammer_y [N]; sampled like the records.

        Raises ParameterError for another input or sample time.
        """
        if unknown := set(plan.inputs) - {SPEED, *INPUTS}:
            raise ParameterError(f"Plan {plan.name!r}: no input {min(unknown)!r}; the rotor bench has {SPEED}, {', '.join(INPUTS)}.")
        if not math.isclose(plan.every, SAMPLE_TIME):
            raise ParameterError(f"Plan {plan.name!r}: every = {plan.every:g} s; the rotor bench samples every {SAMPLE_TIME:g} s.")
        references = plan.sampled(SPEED)
        angles, speeds, _ = _under_control(undriven("run_up"), references)
        blows = {d: plan.sampled(f"hammer_{d}") for d in "xy"} if set(plan.inputs) & set(INPUTS) else {}
        controller = _controller_of((plan.times, references), angles, speeds)
        scene = self.scene.replacing({"drive.characteristic": controller, "hammer": _hammer(blows)})
        spin = hm.AngleTable(times=tuple((SAMPLE_TIME * np.arange(len(angles))).tolist()), angles=tuple(angles.tolist()))
        moving = bool(np.any(references != 0.0))
        columns = {name: np.zeros(plan.samples) for name in (*LATERAL, *(TORSION if moving else ()))}
        seen = np.zeros(plan.samples, bool)
        return self._views(plan.name, scene, spin if moving else STILL, float(references[0]), columns, seen, SAMPLE_TIME)

    def menu(self) -> tuple[Plan, ...]:
        """Records of 3 s at other speeds than those of the bench's own, and blows on rotor 1 while it turns."""
        top = max(REFERENCES["run_up"][1])
        critical = hm.campbell(undriven("run_up"), np.linspace(0.0, top, 11)).critical_speeds
        turning = rotor_menu(SPEED, top=top, seconds=MENU_TIME, every=SAMPLE_TIME, critical=critical[:1].tolist())
        times = SAMPLE_TIME * np.arange(round(MENU_TIME / SAMPLE_TIME))
        blows: dict[str, Course] = {}
        for d, first in HAMMER.items():
            since = (times - first) % (MENU_TIME / 3.0)
            blows[f"hammer_{d}"] = times, np.where(since < BLOW_TIME, BLOW * np.sin(np.pi * since / BLOW_TIME), 0.0)
        slow = {SPEED: ((0.0, 0.02), (0.0, 0.25 * top)), **blows}
        return (*turning, Plan(name="blows at a quarter of the top speed", inputs=slow, duration=MENU_TIME, every=SAMPLE_TIME))

    def _views(
        self,
        name: str,
        scene: hm.Scene,
        spin: hm.SpeedProfile,
        begin: float,
        columns: Mapping[str, FloatArray],
        held: npt.NDArray[np.bool_],
        every: float,
    ) -> tuple[Trial, ...]:
        """Both views of a record, as far as it has their columns; begin : speed at the start [rad/s]."""
        found = []
        for view, wanted in (("lateral", LATERAL), ("torsion", TORSION if spin is not STILL else ())):
            here = [column for column in wanted if column in columns]
            if here:
                found.append(
                    Trial(
                        name=f"{name}, {view}",
                        scene=scene,
                        every=every,
                        columns={column: columns[column] for column in here},
                        measured={column: self.measured[column] for column in here},
                        held_out=held,
                        speeds=dict.fromkeys(POSITIONS, begin),
                        settled=True,
                        motions={"bearing_1": spin.angle} if view == "lateral" else {},
                    )
                )
        return tuple(found)


def bench() -> RotorBench:
    """The bench as its builder knows it, for a diagnosis."""
    channels = {**CHANNELS, "motor_torque": "drive.command", **{name: f"probe_{name}" for name in PROBES}}
    return RotorBench(
        scene=build("run_up", hammer=dict.fromkeys("xy", (0.0, 0.0))),
        knowledge={name: Uncertain(paths=PATHS[name], sigma=sigma) for name, sigma in KNOWLEDGE.items()},
        measured={
            name: Measured(
                channel=channels[name],
                noise=NOISE[name],
                resolution=RESOLUTION[name],
                offset=math.inf if name in OFFSET_FREE else 0.0,
            )
            for name in (*LATERAL, *TORSION)
        },
        together=GROUPS,
        searched=("bump", "run_up"),
    )

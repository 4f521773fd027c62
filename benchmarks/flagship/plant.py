"""The torsion of the robot joint, written again: eight bodies, a gear with lost motion, an inverter-fed motor, an arm.

Nothing of the package under test is imported.  Angles are true, all about the motor's axis; the output turns backwards.
Lagrange:  J a'' = -dV/da - D a' + outer torques, with the wind-up of the gear

    d = a_cs - (a_wg - a_cs)/u - a_fs        (zero for the ideal gear)
    D = d + s e(a_wg - a_cs)                 (s e: the error, in the sense of the output)

as its potential's variable.  Integrator: classical Runge-Kutta at 10 us, the stiffest body makes 0.3 rad in a step;
dry sliders keep their places from step to step.  Laws that are not those of the package: corners of the stiffness and
edges of the gap are rounded hyperbolas, friction is a Hess-Soom hyperbola over w/sqrt(w^2 + w_0^2), hysteresis a bank of
Jenkins elements, errors have side bands, the ripple of the torque is a sharpened wave.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from benchmarks.withheld.plant.compiled import compiled

Array = npt.NDArray[np.float64]

STEP = 1e-5
"""Of the integrator [s]."""
GRAVITY = 9.80665
MOTOR, HUB, DISC, GENERATOR, FLANGE, ENCODER, ARM, HOUSING = range(8)
BODIES = {"motor": MOTOR, "hub": HUB, "brake_disc": DISC, "wave_generator": GENERATOR, "output_flange": FLANGE}
BODIES |= {"encoder_disc": ENCODER, "arm": ARM, "gear_housing": HOUSING}
ELEMENTS = 12
"""Jenkins elements of the hysteresis."""

DATA_SHEET: dict[str, float] = {
    "motor_inertia": 3e-4,
    "motor_viscous": 2e-4,
    "motor_power": 400.0,
    "motor_rated_speed": 5700.0 * math.pi / 30.0,
    "motor_breakdown_ratio": 2.5,
    "motor_synchronous_speed": 200.0 * math.pi,
    "coupling_stiffness": 120.0,
    "coupling_damping": 0.012,
    "hub_inertia": 3.8e-5,
    "brake_disc_inertia": 3.008e-3,
    "wave_generator_inertia": 1.1e-4,
    "input_shaft_diameter": 0.012,
    "input_shaft_length": 0.18,
    "generator_shaft_length": 0.21,
    "output_shaft_diameter": 0.032,
    "output_shaft_length": 0.07,
    "arm_shaft_length": 0.08,
    "shear_modulus": 8.1e10,
    "shaft_damping": 1e-5,
    "ratio": 100.0,
    "lost_motion": 6.728465804318479e-4,
    "gear_stiffness_1": 3.1e4,
    "gear_stiffness_2": 5.0e4,
    "gear_stiffness_3": 5.7e4,
    "gear_torque_1": 14.0,
    "gear_torque_2": 48.0,
    "gear_damping": 12.0,
    "gear_housing_inertia": 0.05,
    "foot_stiffness": 2e6,
    "foot_damping": 50.0,
    "ovality_error": 9.623550979025072e-5,
    "flange_inertia": 6.08e-4,
    "encoder_disc_inertia": 2.08e-4,
    "arm_inertia": 0.4,
    "arm_mass": 4.0,
    "arm_radius": 0.3,
    "arm_drag": 0.3,
}
"""Numbers of the joint, SI, as a builder would hand them over."""

UNCERTAINTY: dict[str, float] = {
    "motor_inertia": 0.03,
    "motor_viscous": 0.1,
    "motor_power": 0.03,
    "coupling_stiffness": 0.05,
    "coupling_damping": 0.1,
    "brake_disc_inertia": 0.03,
    "gear_stiffness_1": 0.04,
    "gear_stiffness_2": 0.04,
    "lost_motion": 0.05,
    "gear_damping": 0.1,
    "ovality_error": 0.1,
    "arm_inertia": 0.03,
    "arm_mass": 0.02,
    "arm_drag": 0.1,
}
"""Standard deviation of the logarithm of what is not known exactly."""


class Friction(NamedTuple):
    """C (1 + s/(1 + (|w|/w_s)^n)) w/sqrt(w^2 + w_0^2) on one body."""

    body: int = 0
    coulomb: float = 0.0  # N m, C
    drop: float = 0.0  # 1, s
    drop_speed: float = 1.0  # rad/s, w_s
    exponent: float = 1.0  # 1, n
    smooth_speed: float = 1.0  # rad/s, w_0


class Ripple(NamedTuple):
    """Motor torque A s/sqrt(1 - h s^2) times sqrt(1 - h), s = sin(n a + p): a wave with flattened or sharpened tops."""

    amplitude: float = 0.0  # N m
    order: float = 1.0
    phase: float = 0.0
    sharpness: float = 0.0  # 1, h, below 1


class Sliders(NamedTuple):
    """Jenkins elements across the gear: stiffness and limit of each."""

    stiffness: Array  # N m/rad
    limit: Array  # N m


class Error(NamedTuple):
    """Orders of the kinematic error of the wave generator: sum of A (sin(n a + p) - sin p)."""

    amplitude: Array  # rad at the output
    order: Array
    phase: Array


@dataclass(frozen=True)
class Joint:
    """A specimen: its numbers and what is put into it.

    encoder_error : of the reading of the output encoder: A (sin(a + p) - sin p) and second harmonic, [rad, rad]
    """

    values: Mapping[str, float]
    friction: Friction = field(default_factory=Friction)
    ripple: Ripple = field(default_factory=Ripple)
    sliders: Sliders | None = None
    error: tuple[tuple[float, float, float], ...] = ()
    encoder_error: tuple[tuple[float, float, float], ...] = ()

    def with_(self, **changes: Any) -> Joint:
        """The same with other fields."""
        return replace(self, **changes)

    def run(self, feed_times: Array, feed_speeds: Array, samples: int, every: float) -> dict[str, Array]:
        """Exact columns of a record from rest; the feed is straight between its points."""
        v = self.values
        orders = np.array([(v["ovality_error"], 2.0, 0.0), *self.error], float).T.copy()
        sliders = self.sliders or Sliders(np.zeros(1), np.zeros(1))
        substeps = round(every / STEP)
        angles, torque = _integrate(
            _numbers(v),
            _inertias(v),
            self.friction,
            self.ripple,
            Error(orders[0], orders[1], orders[2]),
            sliders,
            np.asarray(feed_times, float),
            np.asarray(feed_speeds, float),
            samples,
            substeps,
            every / substeps,
        )
        true = angles[:, ENCODER]
        read = true + sum((a * (np.sin(n * true + p) - np.sin(p)) for a, n, p in self.encoder_error), np.zeros(samples))
        return {"motor_torque": torque, "motor_angle": angles[:, MOTOR], "output_angle": read}


def drawn(rng: np.random.Generator) -> dict[str, float]:
    """Numbers of one specimen: the data sheet's, off by their tolerance."""
    return {
        name: value * math.exp(UNCERTAINTY.get(name, 0.0) * float(np.clip(rng.standard_normal(), -2.5, 2.5)))
        for name, value in DATA_SHEET.items()
    }


class _Numbers(NamedTuple):
    springs: tuple[float, ...]  # coupling, input, generator, output, arm, foot: N m/rad
    dampers: tuple[float, ...]  # the same: N m s/rad
    ratio: float
    half_gap: float
    gear: tuple[float, ...]  # K1, K2 - K1, K3 - K2
    corners: tuple[float, ...]  # rad
    gear_damping: float
    motor_viscous: float
    arm_drag: float
    arm_weight: float  # N m
    breakdown_torque: float
    breakdown_slip_speed: float


def _shaft(v: Mapping[str, float], name: str, shaft: str) -> float:
    return v["shear_modulus"] * math.pi * v[f"{shaft}_diameter"] ** 4 / 32.0 / v[f"{name}_length"]


def _numbers(v: Mapping[str, float]) -> _Numbers:
    springs = (
        v["coupling_stiffness"],
        _shaft(v, "input_shaft", "input_shaft"),
        _shaft(v, "generator_shaft", "input_shaft"),
        _shaft(v, "output_shaft", "output_shaft"),
        _shaft(v, "arm_shaft", "output_shaft"),
        v["foot_stiffness"],
    )
    dampers = (v["coupling_damping"], *(v["shaft_damping"] * k for k in springs[1:5]), v["foot_damping"])
    k1, k2, k3 = (v[f"gear_stiffness_{k}"] for k in (1, 2, 3))
    first = 0.5 * v["lost_motion"] + v["gear_torque_1"] / k1
    second = first + (v["gear_torque_2"] - v["gear_torque_1"]) / k2
    ratio = v["motor_breakdown_ratio"]
    rated_slip_speed = v["motor_synchronous_speed"] - v["motor_rated_speed"]
    return _Numbers(
        springs=springs,
        dampers=dampers,
        ratio=v["ratio"],
        half_gap=0.5 * v["lost_motion"],
        gear=(k1, k2 - k1, k3 - k2),
        corners=(first, second),
        gear_damping=v["gear_damping"],
        motor_viscous=v["motor_viscous"],
        arm_drag=v["arm_drag"],
        arm_weight=v["arm_mass"] * GRAVITY * v["arm_radius"],
        breakdown_torque=ratio * v["motor_power"] / v["motor_rated_speed"],
        breakdown_slip_speed=rated_slip_speed * (ratio + math.sqrt(ratio * ratio - 1.0)),
    )


def _inertias(v: Mapping[str, float]) -> tuple[float, ...]:
    names = ("motor", "hub", "brake_disc", "wave_generator", "flange", "encoder_disc", "arm", "gear_housing")
    return tuple(v[f"{name}_inertia"] for name in names)


ROUND = 3e-6
"""Half width [rad] over which edges of the gap and corners of the stiffness are rounded."""


@compiled
def _ramp(x):
    """max(x, 0), rounded."""
    return 0.5 * (x + math.sqrt(x * x + ROUND * ROUND))


@compiled
def _elastic(wind, n):
    """Torque of the gear without damping."""
    size = abs(wind)
    zero = n.gear[0] * _ramp(-n.half_gap) + n.gear[1] * _ramp(-n.corners[0]) + n.gear[2] * _ramp(-n.corners[1])
    value = n.gear[0] * _ramp(size - n.half_gap) + n.gear[1] * _ramp(size - n.corners[0]) + n.gear[2] * _ramp(size - n.corners[1])
    return (value - zero) * (1.0 if wind > 0.0 else -1.0)


@compiled
def _sliding(wind, place, force, sliders):
    """Torque of the Jenkins elements, which stood at ``place`` with ``force``."""
    total = 0.0
    for k in range(sliders.limit.size):
        most = sliders.limit[k]
        total += min(max(force[k] + sliders.stiffness[k] * (wind - place), -most), most)
    return total


@compiled
def _airgap(feed, speed, n):
    """Kloss's curve over the slip speed."""
    slip = feed - speed
    return 2.0 * n.breakdown_torque * slip * n.breakdown_slip_speed / (slip * slip + n.breakdown_slip_speed * n.breakdown_slip_speed)


@compiled
def _error(angle, e):
    value, slope = 0.0, 0.0
    for k in range(e.amplitude.size):
        inside = e.order[k] * angle + e.phase[k]
        value += e.amplitude[k] * (math.sin(inside) - math.sin(e.phase[k]))
        slope += e.amplitude[k] * e.order[k] * math.cos(inside)
    return value, slope


@compiled
def _wind_up(a, n, e):
    """Wind-up with the error, and the slope of the error."""
    value, slope = _error(a[3] - a[7], e)
    # the output is ahead of its ideal angle by e in its own sense, which is the motor's reversed
    return a[7] - (a[3] - a[7]) / n.ratio - a[4] - value, slope


@compiled
def _motor_torque(a, w, feed, n, r):
    s = math.sin(r.order * a + r.phase)
    return _airgap(feed, w, n) + r.amplitude * s * math.sqrt((1.0 - r.sharpness) / (1.0 - r.sharpness * s * s))


@compiled
def _rates(a, w, feed, n, inertia, f, r, e, sliders, place, force, out):
    """Angular accelerations into ``out``."""
    k, c = n.springs, n.dampers
    wind, slope = _wind_up(a, n, e)
    # d wind/dt = b . w with
    b_wg, b_fs, b_cs = -1.0 / n.ratio - slope, -1.0, 1.0 + 1.0 / n.ratio + slope
    rate = b_wg * w[3] + b_fs * w[4] + b_cs * w[7]
    gear = _elastic(wind, n) + n.gear_damping * rate + _sliding(wind, place, force, sliders)
    coupling = k[0] * (a[0] - a[1]) + c[0] * (w[0] - w[1])
    first = k[1] * (a[1] - a[2]) + c[1] * (w[1] - w[2])
    second = k[2] * (a[2] - a[3]) + c[2] * (w[2] - w[3])
    third = k[3] * (a[4] - a[5]) + c[3] * (w[4] - w[5])
    fourth = k[4] * (a[5] - a[6]) + c[4] * (w[5] - w[6])
    out[0] = _motor_torque(a[0], w[0], feed, n, r) - n.motor_viscous * w[0] - coupling
    out[1] = coupling - first
    out[2] = first - second
    out[3] = second - b_wg * gear
    out[4] = -b_fs * gear - third
    out[5] = third - fourth
    out[6] = fourth - n.arm_weight * math.sin(a[6]) - n.arm_drag * w[6]
    out[7] = -b_cs * gear - k[5] * a[7] - c[5] * w[7]
    if f.coulomb != 0.0:
        speed = w[f.body]
        level = f.coulomb * (1.0 + f.drop / (1.0 + (abs(speed) / f.drop_speed) ** f.exponent))
        out[f.body] -= level * speed / math.sqrt(speed * speed + f.smooth_speed * f.smooth_speed)
    for j in range(8):
        out[j] /= inertia[j]


@compiled
def _integrate(n, inertia, f, r, e, sliders, feed_times, feed_speeds, samples, substeps, h):
    """Angles of the bodies and torque of the motor at the samples."""
    a, w = np.zeros(8), np.zeros(8)
    angles, torque = np.zeros((samples, 8)), np.zeros(samples)
    k1, k2, k3, k4 = np.zeros(8), np.zeros(8), np.zeros(8), np.zeros(8)
    place, force = 0.0, np.zeros(sliders.limit.size)
    place = _wind_up(a, n, e)[0]
    for i in range(samples):
        for j in range(8):
            angles[i, j] = a[j]
        time = i * substeps * h
        torque[i] = _motor_torque(a[0], w[0], np.interp(time, feed_times, feed_speeds), n, r)
        for s in range(substeps):
            t = time + s * h
            begin = np.interp(t, feed_times, feed_speeds)
            middle = np.interp(t + 0.5 * h, feed_times, feed_speeds)
            end = np.interp(t + h, feed_times, feed_speeds)
            _rates(a, w, begin, n, inertia, f, r, e, sliders, place, force, k1)
            _rates(a + 0.5 * h * w, w + 0.5 * h * k1, middle, n, inertia, f, r, e, sliders, place, force, k2)
            _rates(a + 0.5 * h * w + 0.25 * h * h * k1, w + 0.5 * h * k2, middle, n, inertia, f, r, e, sliders, place, force, k3)
            _rates(a + h * w + 0.5 * h * h * k2, w + h * k3, end, n, inertia, f, r, e, sliders, place, force, k4)
            a += h * w + h * h / 6.0 * (k1 + k2 + k3)
            w += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
            wind = _wind_up(a, n, e)[0]
            for k in range(sliders.limit.size):
                most = sliders.limit[k]
                force[k] = min(max(force[k] + sliders.stiffness[k] * (wind - place), -most), most)
            place = wind
    return angles, torque


def sliders(total: float, yield_wind: float, spread: float) -> Sliders:
    """Elements of equal limits that add up to ``total`` [N m], yields spread evenly in the logarithm about yield_wind [rad]."""
    places = yield_wind * np.geomspace(1.0 / spread, spread, ELEMENTS)
    limit = np.full(ELEMENTS, total / ELEMENTS)
    return Sliders(limit / places, limit)

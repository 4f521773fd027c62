"""Values outside their tolerance, and faulty probes: how each is drawn and planted."""

from __future__ import annotations

import math

import numpy as np

from benchmarks.withheld.draws import phase
from benchmarks.withheld.plant.rotor_line.bearing_causes import BEARING
from benchmarks.withheld.plant.rotor_line.planted import Planted
from benchmarks.withheld.plant.rotor_line.shaft_causes import STATION
from benchmarks.withheld.plant.rotor_line.sizes import grown, sign
from benchmarks.withheld.plant.rotor_line.support_causes import SUPPORT


def _factor(strength: float, rng: np.random.Generator, low: float, high: float) -> float:
    return math.exp(sign(rng) * grown(strength, low, high))


def bearing_stiffness(bench: Planted, place: str, strength: float, rng: np.random.Generator) -> None:
    """One bearing, or both, stiffer or softer by 10 to 42 %."""
    factor = _factor(strength, rng, 0.1, 0.35)
    if place == "bearings":
        bench.multiply("k_b", factor)
        return
    bench.ring_stiffness[BEARING[place]] *= factor
    bench.effect.update(k_b_factor=factor, loc=BEARING[place])


def bearing_damping(bench: Planted, place: str, strength: float, rng: np.random.Generator) -> None:
    """One bearing, or both, with 2 to 8 times the damping; less of it would hardly be seen."""
    factor = grown(strength, 2.0, 8.0)
    if place == "bearings":
        bench.multiply("d_b", factor)
        return
    bench.ring_damping[BEARING[place]] *= factor
    bench.effect.update(d_b_factor=factor, loc=BEARING[place])


def support_stiffness(bench: Planted, place: str, strength: float, rng: np.random.Generator) -> None:
    """One support stiffer or softer by 9 to 42 %, both ways alike."""
    factor = _factor(strength, rng, 0.09, 0.35)
    bench.support_stiffness[SUPPORT[place]] *= factor
    bench.effect.update(k_h_factor=factor, loc=SUPPORT[place])


def shaft_stiffness(bench: Planted, place: str, strength: float, rng: np.random.Generator) -> None:
    """Young's modulus off by 3 to 12 %."""
    bench.multiply("E", _factor(strength, rng, 0.03, 0.11))


def rotor_mass(bench: Planted, place: str, strength: float, rng: np.random.Generator) -> None:
    """The mass of a rotor off by 3 to 12 %, its inertias as they were."""
    bench.multiply(place.replace("rotor_", "m_r"), _factor(strength, rng, 0.03, 0.11))


def probe_runout(bench: Planted, place: str, strength: float, rng: np.random.Generator) -> None:
    """A surface that is not round: orders 1 to 4 under both probes of a rotor, at times with a scratch."""
    station = STATION[place.removeprefix("probe_")]
    size = grown(strength, 4e-8, 6e-6)
    shares = (1.0, rng.uniform(0.1, 0.6), rng.uniform(0.0, 0.4), rng.uniform(0.0, 0.2))
    bench.sensors.runout[station] = np.array([(n + 1, size * share, phase(rng)) for n, share in enumerate(shares)])
    if rng.random() < 0.3:
        bench.sensors.scratch[station] = size, phase(rng), rng.uniform(0.15, 0.4)
    bench.sensor.update(runout=size, runout_harmonics=[float(size * share) for share in shares], scratch=station in bench.sensors.scratch)


def probe_gain(bench: Planted, place: str, strength: float, rng: np.random.Generator) -> None:
    """A probe that shows too much or too little, at times bent: error + curve * displacement."""
    error = sign(rng) * grown(strength, 0.0015, 0.12)
    curve = rng.uniform(-0.1, 0.1) * error / 1e-4 if rng.random() < 0.5 else 0.0
    bench.sensors.gain[place.removeprefix("probe_")] = error, curve
    bench.sensor.update(gain=error, gain_curve=curve)

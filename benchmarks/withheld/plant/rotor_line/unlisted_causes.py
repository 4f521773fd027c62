"""Causes that have no name in the answers: how each is drawn and planted."""

from __future__ import annotations

import math

import numpy as np

from benchmarks.withheld.draws import phase
from benchmarks.withheld.plant.rotor_line.planted import Planted
from benchmarks.withheld.plant.rotor_line.shaft_causes import STATION
from benchmarks.withheld.plant.rotor_line.sizes import grown, one_of, sign
from benchmarks.withheld.plant.rotor_line.support_causes import SUPPORT


def support_dry_friction(bench: Planted, place: str, strength: float, rng: np.random.Generator) -> None:
    """A friction joint beside the support (Dahl) whose force depends on where the housing stands."""
    force = grown(strength, 0.15, 120.0)
    bench.causes.friction[SUPPORT[place]] = rng.uniform(3e6, 2e7), force, rng.uniform(2e-6, 1e-5)
    bench.effect.update(friction=force, loc=SUPPORT[place])


def support_stiffness_drift(bench: Planted, place: str, strength: float, rng: np.random.Generator) -> None:
    """A support that softens or stiffens steadily between two moments of each record."""
    share = sign(rng) * grown(strength, 0.01, 0.3)
    begins, length = rng.uniform(0.2, 2.0), rng.uniform(0.3, 3.0)
    bench.causes.drift[SUPPORT[place]] = share, begins, length
    bench.effect.update(drift=share, drift_begins=begins, drift_length=length, loc=SUPPORT[place])


def support_quadratic_damping(bench: Planted, place: str, strength: float, rng: np.random.Generator) -> None:
    """A damper with a turbulent film: c |v| v."""
    size = grown(strength, 1.5e4, 1.2e6)
    bench.causes.quadratic[SUPPORT[place]] = size
    bench.effect.update(quadratic=size, loc=SUPPORT[place])


def magnetic_pull(bench: Planted, place: str, strength: float, rng: np.random.Generator) -> None:
    """A magnet around a rotor: a negative stiffness about a centre of its own that throbs with twice the mains."""
    station, rest = STATION[place], bench.rest()
    size = grown(strength, 6e3, 3e5)
    shift, way = rng.uniform(5e-6, 6e-5), phase(rng)
    centre = rest[4 * station] + shift * math.cos(way), rest[4 * station + 1] + shift * math.sin(way)
    bench.causes.pull[:] = 1, station, size, rng.uniform(0.2, 0.6), 200.0 * math.pi, *centre
    bench.effect.update(pull=size, pull_throb=bench.causes.pull[3])


def floor_vibration(bench: Planted, place: str, strength: float, rng: np.random.Generator) -> None:
    """A neighbour's machine shakes a support at two fixed frequencies."""
    size, first = grown(strength, 0.8, 150.0), rng.uniform(120.0, 800.0)
    second = first * rng.uniform(1.3, 2.2)
    bench.causes.floor[:] = 1, SUPPORT[place], size, first, rng.uniform(0.2, 0.7) * size, second, phase(rng), phase(rng)
    bench.effect.update(floor=size, floor_1=first, floor_2=second, loc=SUPPORT[place])


def floor_shocks(bench: Planted, place: str, strength: float, rng: np.random.Generator) -> None:
    """Blows from outside that ring down, at regular times that have nothing to do with the rotation."""
    size, every = grown(strength, 1.0, 300.0), rng.uniform(0.23, 0.7)
    ringing, decay = rng.uniform(600.0, 2500.0), rng.uniform(40.0, 150.0)
    bench.causes.floor[:] = 2, SUPPORT[place], size, ringing, decay, every, phase(rng), rng.uniform(0.05, 0.2)
    bench.effect.update(shock=size, shock_every=every, loc=SUPPORT[place])


def loose_ball(bench: Planted, place: str, strength: float, rng: np.random.Generator) -> None:
    """A ball left in a ring groove of a rotor: dragged along, it finds its own place, so that the unbalance wanders."""
    station, radius = STATION[place], rng.uniform(0.06, 0.12)
    moment = grown(strength, 4e-7, 1e-4)
    bench.causes.ball[:] = 1, station, moment / radius, radius, rng.uniform(2.0, 12.0), 1.0
    bench.effect.update(ball_moment=moment, ball_radius=radius, ball_drag=bench.causes.ball[4])


def windage(bench: Planted, place: str, strength: float, rng: np.random.Generator) -> None:
    """A fan on the drive end: torque with the square of the speed."""
    size = grown(strength, 1e-9, 1e-6)
    bench.causes.windage[0] = size
    bench.effect.update(windage=size)


def seal_drag(bench: Planted, place: str, strength: float, rng: np.random.Generator) -> None:
    """A lip seal at the drive end: dry friction on the spin."""
    size = grown(strength, 5e-4, 0.5)
    bench.causes.seal[0] = size
    bench.effect.update(seal_drag=size)


def unsymmetric_shaft(bench: Planted, place: str, strength: float, rng: np.random.Generator) -> None:
    """A keyway beside rotor 1: one direction of the section bends more easily, open at all times."""
    section = one_of(rng, 0, 1)
    where = rng.uniform(0.6, 0.95) if section == 0 else rng.uniform(0.05, 0.4)
    compliance = grown(strength, 2e-9, 5e-7)
    bench.causes.crack[:7] = 0, section, where, compliance, 0.0, phase(rng), 1.0
    bench.effect.update(keyway=compliance, section=section, key_place=where)

"""Causes at one bearing: how each is drawn and planted."""

from __future__ import annotations

import math

import numpy as np

from benchmarks.withheld.draws import phase
from benchmarks.withheld.plant.rotor_line.planted import Planted
from benchmarks.withheld.plant.rotor_line.sizes import grown, one_of

BEARING = {"bearing_1": 0, "bearing_2": 1}


def bearing_clearance(bench: Planted, place: str, strength: float, rng: np.random.Generator) -> None:
    """Radial play: 1 linear contact, 2 line contact p^(10/9), its stiffness at 800 N equal to the bearing's; a thin film in the gap."""
    law, b = one_of(rng, 1, 2), BEARING[place]
    made, gap = bench.machine(), grown(strength, 5e-8 if law == 1 else 2e-7, 2e-5)
    k, d = made.ring_stiffness[b], made.ring_damping[b]
    row = bench.causes.bearing[b]
    row[:4] = law, gap, rng.uniform(0.0, 0.03), rng.uniform(0.1, 1.0)
    if law == 2:
        at, force = (10.0 / 9.0) * 800.0 / k, 800.0
        row[4:6] = force / at ** (10.0 / 9.0), (1.0 - row[3]) * d / force
    bench.effect.update(clear=gap, film_stiffness=row[2], film_damping=row[3], loc=b, bearing_law=law)


def bearing_cubic_stiffness(bench: Planted, place: str, strength: float, rng: np.random.Generator) -> None:
    """Hardening: 3 along the displacement, 4 by axis, 5 as sinh; the length is that at which the stiffness has grown by its own size."""
    law, b = one_of(rng, 3, 4, 5), BEARING[place]
    length = grown(strength, 1e-4, 6e-6)
    bench.causes.bearing[b, :2] = law, length / (math.sqrt(6.0) if law == 5 else 1.0)
    bench.effect.update(hardening_length=length, loc=b, bearing_law=law)


def bearing_cross_coupling(bench: Planted, place: str, strength: float, rng: np.random.Generator) -> None:
    """A skew stiffness that drives forward whirl; the laws are in laws.cross_force."""
    law, b = one_of(rng, 1, 2, 3), BEARING[place]
    size = grown(strength, 7e5, 1.4e7)
    bench.causes.cross[b] = law, size, rng.uniform(-0.3, 0.3), rng.uniform(5e-5, 3e-4)
    bench.effect.update(cross=size, cross_law=law, loc=b)


def oil_whirl(bench: Planted, place: str, strength: float, rng: np.random.Generator) -> None:
    """Whirl at 0.42 to 0.49 of the speed: 4 a force that sets in at a speed and wavers, 3 a limit cycle that the ring can pull along.

    1 and 2, with the forms that the package has come to hold since, were drawn in sets before the sixth.
    """
    law, b = one_of(rng, 4, 3), BEARING[place]
    force, part = grown(strength, 1.5, 400.0), rng.uniform(0.42, 0.49)
    onset = rng.uniform(300.0, 600.0)
    row = bench.causes.whirl
    row[:8] = law, b, force, part, rng.uniform(-0.02, 0.02), onset, rng.uniform(0.0, 0.0015), phase(rng)
    row[8:10] = (rng.uniform(8.0, 25.0), rng.uniform(0.0, 20.0)) if law == 3 else (0.0, rng.uniform(1.0, 2.5))
    bench.effect.update(whirl=force, whirl_part=part, whirl_onset=onset, loc=b, whirl_law=law)


def ball_pass(bench: Planted, place: str, strength: float, rng: np.random.Generator) -> None:
    """Pulses as balls pass a flaw, with slip: 1 outer race, 2 inner race, 3 a smooth wave; the laws are in laws.pass_force."""
    law, b = one_of(rng, 1, 2, 3), BEARING[place]
    balls, ratio = int(rng.choice([7, 8, 9])), rng.uniform(0.2, 0.3)
    orders = 0.5 * balls * (1.0 + ratio if law == 2 else 1.0 - ratio)
    size = grown(strength, 0.3, 60.0)
    row = bench.causes.passing
    row[:5] = law, orders, rng.uniform(0.0005, 0.004), size, rng.uniform(0.0, 1.5)
    row[5:10] = rng.uniform(0.1, 0.4) if law == 3 else rng.uniform(1.0, 5.0), -0.5 * math.pi + rng.uniform(-0.6, 0.6), 0.1, b, phase(rng)
    bench.effect.update(ball_pass=size, orders=orders, slip=row[2], sharpness=row[5], loc=b, pass_law=law)

"""Causes at one support: how each is drawn and planted."""

from __future__ import annotations

import math

import numpy as np

from benchmarks.withheld.plant.rotor_line.planted import Planted
from benchmarks.withheld.plant.rotor_line.records import HOUSING
from benchmarks.withheld.plant.rotor_line.sizes import grown, one_of

SUPPORT = {"support_1": 0, "support_2": 1}


def looseness(bench: Planted, place: str, strength: float, rng: np.random.Generator) -> None:
    """A loose foot: 1 softer when it lifts, 2 softer within a sideways gap, 3 softer between the foot and the bolt's head."""
    law, b = one_of(rng, 1, 2, 3), SUPPORT[place]
    rest = float(bench.rest()[HOUSING + 2 * b + 1])
    part = 1.0 - grown(strength, 0.006, 0.7)
    row = bench.causes.support[b]
    if law == 2:
        row[:] = 2, 0.0, rng.uniform(5e-7, 3e-6), part
    else:
        low = rest + rng.uniform(1e-7, 1.5e-6)
        row[:] = law, low, low + rng.uniform(2e-6, 8e-6), part
    bench.effect.update(loose_part=part, loose_low=row[1], loose_high=row[2], loc=b, loose_law=law)


def hidden_mode_support(bench: Planted, place: str, strength: float, rng: np.random.Generator) -> None:
    """Something that swings on the housing (a pipe, a guard): one mass on two springs along turned axes."""
    b = SUPPORT[place]
    mass, first = grown(strength, 0.04, 6.0), rng.uniform(160.0, 900.0)
    second = first * rng.uniform(0.7, 1.6)
    damping = 2 * rng.uniform(0.005, 0.04) * mass * first
    angle = rng.uniform(0.0, 0.5 * math.pi)
    bench.causes.hidden[:] = 1, b, mass, mass * first**2, mass * second**2, damping, angle
    bench.effect.update(hidden_mass=mass, hidden_1=first, hidden_2=second, hidden_damping=damping, hidden_angle=angle, loc=b)

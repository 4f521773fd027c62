"""Banks of springs behind dry sliders (Jenkins elements), integrated exactly.

Torque of an element: clip(F + k (x - x_0), -c L, c L), where F and x_0 are torque and place at the last
turning point or accepted step.  No rate equation: reversals are events that end a step.  With a limit
factor c that changes in time the slider gives way, which only loses energy.
Sources: Iwan, J. Applied Mechanics 33 (1966) 893; generalised Maxwell slip of Lampaert, Swevers,
Al-Bender (2003) for friction, with c(speed) as its Stribeck curve.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from benchmarks.withheld.case import Array
from benchmarks.withheld.plant.compiled import compiled

MOTOR_BANK, WAVE_BANK, LOAD_BANK, MESH_BANK, FLEX_BANK = range(5)
BANKS, ELEMENTS = 5, 10


class Banks(NamedTuple):
    """Stiffness and limit of each element; a bank without limits is switched off."""

    stiffness: Array  # N m/rad, (BANKS, ELEMENTS)
    limit: Array  # N m
    active: Array  # 1.0 or 0.0


class Memory(NamedTuple):
    """Torques and places at the last accepted step."""

    force: Array  # (BANKS, ELEMENTS)
    place: Array  # (BANKS,)


def no_banks() -> Banks:
    """All switched off."""
    return Banks(np.zeros((BANKS, ELEMENTS)), np.zeros((BANKS, ELEMENTS)), np.zeros(BANKS))


def with_bank(banks: Banks, bank: int, total: float, yield_place: float, spread: float) -> Banks:
    """Switch a bank on: equal limits that add up to ``total``, yields spread over yield_place/spread .. yield_place*spread."""
    stiffness, limit, active = (array.copy() for array in banks)
    places = yield_place * np.geomspace(1.0 / spread, spread, ELEMENTS)
    limit[bank] = total / ELEMENTS
    stiffness[bank] = limit[bank] / places
    active[bank] = 1.0
    return Banks(stiffness, limit, active)


def no_memory() -> Memory:
    """At rest and unloaded."""
    return Memory(np.zeros((BANKS, ELEMENTS)), np.zeros(BANKS))


@compiled
def bank_torque(bank, place, factor, banks, memory):
    """Torque of a bank against its motion."""
    if banks.active[bank] == 0.0:
        return 0.0
    moved = place - memory.place[bank]
    total = 0.0
    for k in range(banks.limit.shape[1]):
        most = factor * banks.limit[bank, k]
        total += min(max(memory.force[bank, k] + banks.stiffness[bank, k] * moved, -most), most)
    return total


@compiled
def remember(bank, place, factor, banks, memory):
    """Take place and torques into the memory."""
    moved = place - memory.place[bank]
    for k in range(banks.limit.shape[1]):
        most = factor * banks.limit[bank, k]
        memory.force[bank, k] = min(max(memory.force[bank, k] + banks.stiffness[bank, k] * moved, -most), most)
    memory.place[bank] = place

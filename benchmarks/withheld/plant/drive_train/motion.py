"""Integrates a record: Dormand and Prince 5(4), step size by error, from sample to sample.

Inputs are linear between samples, so no step crosses a sample.  Reversals of a bank of sliders end a
step.  Source of the tableau: Dormand, Prince, J. Comp. Appl. Math. 6 (1980) 19.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from benchmarks.withheld.case import Array
from benchmarks.withheld.plant.compiled import compiled
from benchmarks.withheld.plant.drive_train import excitation
from benchmarks.withheld.plant.drive_train.banks import BANKS, MESH_BANK, no_memory, remember
from benchmarks.withheld.plant.drive_train.line import (
    BANK_PLACE,
    BANK_RATE,
    BRISTLE,
    COMMAND,
    DELIVERED,
    FLEX,
    FLEX_SPEED,
    HIDDEN,
    HYSTERESIS,
    INTEGRAL,
    LOAD,
    LOAD_SPEED,
    MOTOR,
    MOTOR_SPEED,
    OUTPUT_TORQUE,
    REPORTS,
    STATES,
    WAVE,
    WAVE_SPEED,
)
from benchmarks.withheld.plant.drive_train.rates import Plant, Tables, bank_factor, rates

NODES = np.array([0.0, 1 / 5, 3 / 10, 4 / 5, 8 / 9, 1.0, 1.0])
WEIGHTS = np.array(
    [
        [0, 0, 0, 0, 0, 0],
        [1 / 5, 0, 0, 0, 0, 0],
        [3 / 40, 9 / 40, 0, 0, 0, 0],
        [44 / 45, -56 / 15, 32 / 9, 0, 0, 0],
        [19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729, 0, 0],
        [9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656, 0],
        [35 / 384, 0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84],
    ]
)
# fifth order minus fourth
DIFFERENCE = np.array([71 / 57600, 0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40])

# what a state may err in a step at tolerance 1: about a noise unit of the channels it moves
SCALE = np.ones(STATES)
SCALE[[MOTOR, WAVE]] = 1e-4  # rad
SCALE[[MOTOR_SPEED, WAVE_SPEED]] = 5e-2  # rad/s
SCALE[[FLEX, LOAD, HIDDEN]] = 1.5e-6
SCALE[[FLEX_SPEED, LOAD_SPEED, HIDDEN + 1]] = 1e-3
SCALE[INTEGRAL] = 5e-3  # rad
SCALE[DELIVERED] = 2e-2  # N m
SCALE[DELIVERED + 1] = 20.0  # N m/s
SCALE[BRISTLE : BRISTLE + 3] = (2e-2, 2e-2, 0.3)  # N m
SCALE[HYSTERESIS : HYSTERESIS + 2] = 0.3
SCALE[HYSTERESIS + 2] = 5e-6  # rad, slipped twist
SCALE[HYSTERESIS + 3] = 0.1  # N m, brake

# rate of a bank's place below which a reversal needs no step of its own (moves less than noise in a sample)
STILL = np.array([2e-3, 2e-3, 2e-6, 2e-3, 2e-6])
SHORTEST = 1e-9  # s
TOLERANCE = 1e-4
SMALL_CHANGE = 0.02  # of the limit of a speed-dependent slider in a step


class Motion(NamedTuple):
    """States, torque command and output torque at every sample; the number of steps."""

    states: Array  # (samples, STATES)
    command: Array
    output_torque: Array
    steps: int


def motion(plant: Plant, tables: Tables, record: str, *, tolerance: float = TOLERANCE, samples: int = excitation.COUNT) -> Motion:
    """The record from rest, all states zero."""
    reference, brake = excitation.inputs(record)
    return follow(plant, tables, reference[:samples], brake[:samples], 1.0 / excitation.RATE, tolerance=tolerance)


def follow(plant: Plant, tables: Tables, reference: Array, brake: Array, sample: float, *, tolerance: float = TOLERANCE) -> Motion:
    """The answer to inputs that are linear between samples."""
    states, reports, steps = _integrate(
        np.ascontiguousarray(reference), np.ascontiguousarray(brake), sample, plant, tables, no_memory(), tolerance
    )
    if steps < 0:
        raise ArithmeticError(
            f"The plant needs steps below {SHORTEST:g} s after {-steps / excitation.RATE:.4f} s; a size that was put in is absurd."
        )
    return Motion(states, reports[:, COMMAND].copy(), reports[:, OUTPUT_TORQUE].copy(), steps)


@compiled
def _integrate(reference, brake, sample, p, tables, memory, tolerance):
    count = reference.size
    states = np.zeros((count, STATES))
    reports = np.zeros((count, REPORTS))
    slopes = np.zeros((7, STATES))
    y = np.zeros(STATES)
    trial = np.zeros(STATES)
    report = np.zeros(REPORTS)
    after = np.zeros(REPORTS)
    scale = SCALE * tolerance
    rates(0.0, y, reference[0], brake[0], p, tables, memory, slopes[0], report)
    reports[0] = report
    step = 1e-5
    taken = 0
    for k in range(1, count):
        start = (k - 1) * sample
        done = 0.0
        reference_slope = (reference[k] - reference[k - 1]) / sample
        brake_slope = (brake[k] - brake[k - 1]) / sample
        while done < sample:
            last = done + step >= sample * (1.0 - 1e-9)
            h = sample - done if last else step
            for stage in range(1, 7):
                for i in range(STATES):
                    total = 0.0
                    for j in range(stage):
                        total += WEIGHTS[stage, j] * slopes[j, i]
                    trial[i] = y[i] + h * total
                at = done + NODES[stage] * h
                rates(
                    start + at,
                    trial,
                    reference[k - 1] + reference_slope * at,
                    brake[k - 1] + brake_slope * at,
                    p,
                    tables,
                    memory,
                    slopes[stage],
                    after,
                )
            worst = 0.0
            for i in range(STATES):
                total = 0.0
                for j in range(7):
                    total += DIFFERENCE[j] * slopes[j, i]
                worst = max(worst, abs(h * total) / scale[i])
            if worst > 1.0 or worst != worst:
                step = h * (max(0.2, 0.9 * worst**-0.2) if worst == worst else 0.1)
                if step < SHORTEST:
                    return states, reports, -k
                continue
            share = min(_reversal(report, after, tables.banks), _change_of_limits(y, trial, p, tables))
            if share < 0.98 and h > 1e-7:
                step = max(h * share, 1e-8)
                continue
            y[:] = trial
            slopes[0] = slopes[6]
            report[:] = after
            for bank in range(BANKS):
                if tables.banks.active[bank] != 0.0:
                    remember(bank, report[BANK_PLACE + bank], bank_factor(bank, y, p, tables), tables.banks, memory)
            taken += 1
            done = sample if last else done + h
            growth = min(5.0, 0.9 * max(worst, 1e-10) ** -0.2)
            step = min(h * growth, sample) if not last or h * growth < step else min(step * max(growth, 1.0), sample)
        states[k] = y
        reports[k] = report
    return states, reports, taken


@compiled
def _reversal(before, after, banks):
    """Share of the step up to the first reversal of an active bank; 1 if none turns."""
    share = 1.0
    for bank in range(BANKS):
        if banks.active[bank] != 0.0:
            first, second = before[BANK_RATE + bank], after[BANK_RATE + bank]
            if first * second < 0.0 and abs(first) > STILL[bank] and abs(second) > STILL[bank]:
                share = min(share, first / (first - second))
    return share


@compiled
def _change_of_limits(before, after, p, tables):
    """Share of the step over which the limits of a speed-dependent slider change little: a rising limit is followed from step to step."""
    share = 1.0
    for bank in range(MESH_BANK):
        if tables.banks.active[bank] != 0.0:
            first, second = bank_factor(bank, before, p, tables), bank_factor(bank, after, p, tables)
            share = min(share, SMALL_CHANGE * first / max(abs(second - first), 1e-9))
    return max(share, 0.1)

"""Inertias, linear shafts and viscous losses of the bench, and where the states stand."""

from __future__ import annotations

from typing import NamedTuple

# states: angles and speeds of the four inertias, controller, then what effects add
MOTOR, MOTOR_SPEED, WAVE, WAVE_SPEED, FLEX, FLEX_SPEED, LOAD, LOAD_SPEED, INTEGRAL = range(9)
DELIVERED, DELIVERED_RATE = 9, 10  # motor torque behind its lag
HIDDEN, HIDDEN_SPEED = 11, 12  # inertia behind the load
BRISTLE = 13  # 13, 14, 15: bristle torque at motor, wave generator, load
HYSTERESIS = 16  # hysteresis torque of the flexspline
RELAXING, SLIPPED, BRAKE = 17, 18, 19  # output shaft: torque that relaxes, twist that slipped; brake torque behind its lag
STATES = 20

# what the rates function reports beside the rates
COMMAND, OUTPUT_TORQUE, BANK_PLACE, BANK_RATE = 0, 1, 2, 7
REPORTS = 12

SITES = ("motor", "wave_generator", "load")  # bodies that drags act on, in the order of arrays


class Line(NamedTuple):
    """The linear part."""

    motor_inertia: float
    wave_inertia: float
    flex_inertia: float
    load_inertia: float
    input_stiffness: float
    input_damping: float
    output_stiffness: float
    output_damping: float
    flex_damping: float
    motor_viscous: float
    wave_viscous: float
    load_viscous: float
    ratio: float
    proportional: float
    integral: float
    limit: float


def line(values: dict[str, float]) -> Line:
    """From the symbols of the data sheet."""
    v = values
    return Line(
        *(v[name] for name in ("J_m", "J_wg", "J_fs", "J_l", "k_in", "d_in", "k_out", "d_out", "d_fs", "b_m", "b_wg", "b_l")),
        *(v[name] for name in ("u", "kp", "ki", "tau_max")),
    )

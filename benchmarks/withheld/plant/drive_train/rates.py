"""Equations of motion of the drive bench with everything that a case may hold."""

from __future__ import annotations

import math
from typing import NamedTuple

from benchmarks.withheld.plant.compiled import compiled
from benchmarks.withheld.plant.drive_train.banks import (
    FLEX_BANK,
    LOAD_BANK,
    MESH_BANK,
    MOTOR_BANK,
    WAVE_BANK,
    Banks,
    bank_torque,
    no_banks,
)
from benchmarks.withheld.plant.drive_train.contact import Play, shaft_torque
from benchmarks.withheld.plant.drive_train.drags import Drag, drag_torque
from benchmarks.withheld.plant.drive_train.friction import (
    BANK,
    DAHL,
    SMOOTH,
    Friction,
    MeshFriction,
    dahl_rate,
    level,
    mesh_level,
    smooth_friction,
)
from benchmarks.withheld.plant.drive_train.gear_error import Orders, error, orders
from benchmarks.withheld.plant.drive_train.line import (
    BANK_PLACE,
    BANK_RATE,
    BRAKE,
    BRISTLE,
    COMMAND,
    DELIVERED,
    DELIVERED_RATE,
    FLEX,
    FLEX_SPEED,
    HIDDEN,
    HIDDEN_SPEED,
    HYSTERESIS,
    INTEGRAL,
    LOAD,
    LOAD_SPEED,
    MOTOR,
    MOTOR_SPEED,
    OUTPUT_TORQUE,
    RELAXING,
    SLIPPED,
    WAVE,
    WAVE_SPEED,
    Line,
    line,
)
from benchmarks.withheld.plant.drive_train.load import OddLoad, cable, hidden_torque, shaking, still_there, uneven, weight
from benchmarks.withheld.plant.drive_train.motor import Motor, controller, lag_rate, shaft_side
from benchmarks.withheld.plant.drive_train.shaft import OddShaft, slip_rate
from benchmarks.withheld.plant.drive_train.springs import GearSpring, gear_spring, modulated, spring_torque


class Hysteresis(NamedTuple):
    """Hysteresis of the flexspline after Dahl with an exponent above 1 (the Iwan form is a bank)."""

    torque: float = 0.0  # N m; 0: none
    stiffness: float = 0.0  # N m/rad at a reversal
    sharpness: float = 1.0


class Plant(NamedTuple):
    """One specimen with all that was put in: numbers."""

    line: Line
    spring: GearSpring
    hysteresis: Hysteresis = Hysteresis()
    motor_friction: Friction = Friction()
    wave_friction: Friction = Friction()
    load_friction: Friction = Friction()
    mesh: MeshFriction = MeshFriction()
    motor_drag: Drag = Drag()
    wave_drag: Drag = Drag()
    load_drag: Drag = Drag()
    motor: Motor = Motor()
    input_play: Play = Play()
    output_play: Play = Play()
    shaft: OddShaft = OddShaft()
    load: OddLoad = OddLoad()


class Tables(NamedTuple):
    """The rest of it: arrays, apart because they cost time at every call."""

    wave_error: Orders  # counts the wave generator's angle
    output_error: Orders  # counts the flexspline's angle
    banks: Banks


def nominal_plant(values: dict[str, float]) -> tuple[Plant, Tables]:
    """The bench of the data sheet with these parameters and nothing else."""
    return Plant(line(values), gear_spring(values)), Tables(orders(), orders(), no_banks())


@compiled
def gear_twist(y, ratio, tables):
    """(twist, its rate, de/da at the wave generator, de/da at the output)"""
    value, slope = error(y[WAVE], tables.wave_error)
    more, bend = error(y[FLEX], tables.output_error)
    twist = y[WAVE] / ratio - y[FLEX] + value + more
    rate = y[WAVE_SPEED] * (1.0 / ratio + slope) - y[FLEX_SPEED] * (1.0 - bend)
    return twist, rate, slope, bend


@compiled
def bank_factor(bank, y, p, tables):
    """Limit factor of a bank: Stribeck level, mesh level or 1."""
    if bank == MOTOR_BANK:
        return level(y[MOTOR_SPEED], p.motor_friction)
    if bank == WAVE_BANK:
        return level(y[WAVE_SPEED], p.wave_friction)
    if bank == LOAD_BANK:
        return level(y[LOAD_SPEED], p.load_friction)
    if bank == MESH_BANK:
        twist, rate, _, _ = gear_twist(y, p.line.ratio, tables)
        torque = spring_torque(twist, p.spring) + modulated(twist, y[WAVE], p.spring)[0] + p.line.flex_damping * rate
        return mesh_level(torque, y[WAVE_SPEED], p.line.ratio, p.mesh)
    return 1.0


@compiled
def dry_friction(bank, angle, speed, bristle, f, banks, memory):
    """(friction torque of a body by whichever law it has, rate of its bristle)"""
    if f.kind == SMOOTH:
        return smooth_friction(speed, f), 0.0
    if f.kind == DAHL:
        return bristle, dahl_rate(bristle, speed, f.coulomb * level(speed, f), f.stiffness, f.sharpness)
    if f.kind == BANK:
        return bank_torque(bank, angle, level(speed, f), banks, memory), 0.0
    return 0.0, 0.0


@compiled
def rates(time, y, reference, brake, p, tables, memory, dy, report):
    """Rates of all states into dy; command, output torque, places and rates of the banks into report."""
    b = p.line
    dy[:] = 0.0

    command, dy[INTEGRAL] = controller(reference - y[MOTOR_SPEED], y[INTEGRAL], b)
    delivered = command
    if p.motor.lag_frequency > 0.0:
        delivered = y[DELIVERED]
        dy[DELIVERED] = y[DELIVERED_RATE]
        dy[DELIVERED_RATE] = lag_rate(command, delivered, y[DELIVERED_RATE], p.motor)
    motor = shaft_side(time, delivered, y[MOTOR], p.motor)

    into = shaft_torque(y[MOTOR] - y[WAVE], y[MOTOR_SPEED] - y[WAVE_SPEED], b.input_stiffness, b.input_damping, p.input_play)

    twist, rate, slope, bend = gear_twist(y, b.ratio, tables)
    extra, on_wave = modulated(twist, y[WAVE], p.spring)
    through = spring_torque(twist, p.spring) + extra + b.flex_damping * rate
    gear = through
    if p.hysteresis.torque > 0.0:
        gear += y[HYSTERESIS]
        dy[HYSTERESIS] = dahl_rate(y[HYSTERESIS], rate, p.hysteresis.torque, p.hysteresis.stiffness, p.hysteresis.sharpness)
    gear += bank_torque(FLEX_BANK, twist, 1.0, tables.banks, memory)

    mesh = 0.0
    if p.mesh.loss > 0.0:
        most = mesh_level(through, y[WAVE_SPEED], b.ratio, p.mesh)
        if p.mesh.kind == BANK:
            mesh = bank_torque(MESH_BANK, y[WAVE], most, tables.banks, memory)
        else:
            mesh = most * y[WAVE_SPEED] / math.sqrt(y[WAVE_SPEED] ** 2 + p.mesh.smooth_speed**2)

    outer = y[FLEX] - y[LOAD]
    outer_rate = y[FLEX_SPEED] - y[LOAD_SPEED]
    out = shaft_torque(outer - y[SLIPPED], outer_rate, b.output_stiffness, b.output_damping, p.output_play)
    dy[SLIPPED] = slip_rate(b.output_stiffness * (outer - y[SLIPPED]), p.shaft)
    if p.shaft.branch_stiffness > 0.0:
        out += y[RELAXING]
        dy[RELAXING] = p.shaft.branch_stiffness * outer_rate - y[RELAXING] / p.shaft.branch_time

    if p.load.brake_time > 0.0:
        dy[BRAKE] = (brake - y[BRAKE]) / p.load.brake_time
        brake = y[BRAKE]
    brake *= uneven(y[LOAD], p.load)
    onto = out - b.load_viscous * y[LOAD_SPEED] - brake - weight(y[LOAD], p.load) - cable(y[LOAD], p.load) + shaking(time, p.load)
    onto -= drag_torque(time, y[LOAD], y[LOAD_SPEED], p.load_drag)
    dry, dy[BRISTLE + 2] = dry_friction(LOAD_BANK, y[LOAD], y[LOAD_SPEED], y[BRISTLE + 2], p.load_friction, tables.banks, memory)
    onto -= dry
    inertia = b.load_inertia * still_there(time, p.load)
    if p.load.hidden_share > 0.0:
        behind = hidden_torque(y[LOAD] - y[HIDDEN], y[LOAD_SPEED] - y[HIDDEN_SPEED], p.load)
        onto -= behind
        dy[HIDDEN] = y[HIDDEN_SPEED]
        dy[HIDDEN_SPEED] = behind / (p.load.hidden_share * inertia)
        inertia *= 1.0 - p.load.hidden_share
    if p.load.inertia_depth != 0.0:
        inside = 2.0 * y[LOAD] + p.load.inertia_phase
        onto += inertia * p.load.inertia_depth * math.sin(inside) * y[LOAD_SPEED] ** 2  # -(dJ/da) w^2/2
        inertia *= 1.0 + p.load.inertia_depth * math.cos(inside)

    onto_motor = motor - into - b.motor_viscous * y[MOTOR_SPEED] - drag_torque(time, y[MOTOR], y[MOTOR_SPEED], p.motor_drag)
    dry, dy[BRISTLE] = dry_friction(MOTOR_BANK, y[MOTOR], y[MOTOR_SPEED], y[BRISTLE], p.motor_friction, tables.banks, memory)
    onto_motor -= dry

    onto_wave = into - gear * (1.0 / b.ratio + slope) - on_wave - mesh - b.wave_viscous * y[WAVE_SPEED]
    onto_wave -= drag_torque(time, y[WAVE], y[WAVE_SPEED], p.wave_drag)
    dry, dy[BRISTLE + 1] = dry_friction(WAVE_BANK, y[WAVE], y[WAVE_SPEED], y[BRISTLE + 1], p.wave_friction, tables.banks, memory)
    onto_wave -= dry

    dy[MOTOR], dy[MOTOR_SPEED] = y[MOTOR_SPEED], onto_motor / b.motor_inertia
    dy[WAVE], dy[WAVE_SPEED] = y[WAVE_SPEED], onto_wave / b.wave_inertia
    dy[FLEX], dy[FLEX_SPEED] = y[FLEX_SPEED], (gear * (1.0 - bend) - out) / b.flex_inertia
    dy[LOAD], dy[LOAD_SPEED] = y[LOAD_SPEED], onto / inertia

    report[COMMAND] = command
    report[OUTPUT_TORQUE] = out
    for bank, place, speed in (
        (MOTOR_BANK, y[MOTOR], y[MOTOR_SPEED]),
        (WAVE_BANK, y[WAVE], y[WAVE_SPEED]),
        (LOAD_BANK, y[LOAD], y[LOAD_SPEED]),
        (MESH_BANK, y[WAVE], y[WAVE_SPEED]),
        (FLEX_BANK, twist, rate),
    ):
        report[BANK_PLACE + bank] = place
        report[BANK_RATE + bank] = speed

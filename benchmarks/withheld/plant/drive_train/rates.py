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
from benchmarks.withheld.plant.drive_train.drags import Drags, drag, no_drags
from benchmarks.withheld.plant.drive_train.friction import (
    BANK,
    DAHL,
    SMOOTH,
    Friction,
    MeshFriction,
    dahl_rate,
    level,
    mesh_level,
    no_friction,
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
from benchmarks.withheld.plant.drive_train.load import OddLoad, hidden_torque, shaking, weight
from benchmarks.withheld.plant.drive_train.motor import Motor, controller, lag_rate, shaft_side
from benchmarks.withheld.plant.drive_train.shaft import OddShaft, slip_rate
from benchmarks.withheld.plant.drive_train.springs import GearSpring, gear_spring, modulated, spring_torque


class Hysteresis(NamedTuple):
    """Hysteresis of the flexspline after Dahl with an exponent above 1 (the Iwan form is a bank)."""

    torque: float = 0.0  # N m; 0: none
    stiffness: float = 0.0  # N m/rad at a reversal
    sharpness: float = 1.0


class Plant(NamedTuple):
    """One specimen with all that was put in."""

    line: Line
    spring: GearSpring
    wave_error: Orders  # counts the wave generator's angle
    output_error: Orders  # counts the flexspline's angle
    hysteresis: Hysteresis
    friction: Friction
    mesh: MeshFriction
    banks: Banks
    drags: Drags
    motor: Motor
    input_play: Play
    output_play: Play
    shaft: OddShaft
    load: OddLoad


def nominal_plant(values: dict[str, float]) -> Plant:
    """The bench of the data sheet with these parameters and nothing else."""
    return Plant(
        line(values), gear_spring(values), orders(), orders(), Hysteresis(), no_friction(), MeshFriction(), no_banks(), no_drags(),
        Motor(), Play(), Play(), OddShaft(), OddLoad(),
    )  # fmt: skip


@compiled
def bank_factor(bank, y, report, p):
    """Limit factor of a bank in a state whose reports are at hand: Stribeck level, mesh level or 1."""
    if bank == MOTOR_BANK:
        return level(0, y[MOTOR_SPEED], p.friction)
    if bank == WAVE_BANK:
        return level(1, y[WAVE_SPEED], p.friction)
    if bank == LOAD_BANK:
        return level(2, y[LOAD_SPEED], p.friction)
    if bank == MESH_BANK:
        torque, _ = gear_torque(y, p)
        return mesh_level(torque, y[WAVE_SPEED], p.line.ratio, p.mesh)
    return 1.0


@compiled
def gear_twist(y, p):
    """(twist, its rate, de/da at the wave generator, de/da at the output)"""
    value, slope = error(y[WAVE], p.wave_error)
    more, bend = error(y[FLEX], p.output_error)
    ratio = p.line.ratio
    twist = y[WAVE] / ratio - y[FLEX] + value + more
    rate = y[WAVE_SPEED] * (1.0 / ratio + slope) - y[FLEX_SPEED] * (1.0 - bend)
    return twist, rate, slope, bend


@compiled
def gear_torque(y, p):
    """(spring and damper torque without hysteresis, dV/d angle of the wave generator)"""
    twist, rate, _, _ = gear_twist(y, p)
    extra, on_wave = modulated(twist, y[WAVE], p.spring)
    return spring_torque(twist, p.spring) + extra + p.line.flex_damping * rate, on_wave


@compiled
def body_friction(site, bank, angle, speed, y, p, memory, dy):
    """Dry friction of a body by whichever law it has; sets the rate of its bristle."""
    kind = p.friction.kind[site]
    if kind == SMOOTH:
        return smooth_friction(site, speed, p.friction)
    if kind == DAHL:
        limit = p.friction.coulomb[site] * level(site, speed, p.friction)
        force = y[BRISTLE + site]
        dy[BRISTLE + site] = dahl_rate(force, speed, limit, p.friction.stiffness[site], p.friction.sharpness[site])
        return force
    if kind == BANK:
        return bank_torque(bank, angle, level(site, speed, p.friction), p.banks, memory)
    return 0.0


@compiled
def rates(time, y, reference, brake, p, memory, dy, report):
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

    twist, rate, slope, bend = gear_twist(y, p)
    gear, on_wave = gear_torque(y, p)
    friction_torque = gear  # the mesh is loaded by what goes through spring and damper
    if p.hysteresis.torque > 0.0:
        gear += y[HYSTERESIS]
        dy[HYSTERESIS] = dahl_rate(y[HYSTERESIS], rate, p.hysteresis.torque, p.hysteresis.stiffness, p.hysteresis.sharpness)
    gear += bank_torque(FLEX_BANK, twist, 1.0, p.banks, memory)

    mesh = 0.0
    if p.mesh.loss > 0.0:
        most = mesh_level(friction_torque, y[WAVE_SPEED], b.ratio, p.mesh)
        if p.mesh.kind == BANK:
            mesh = bank_torque(MESH_BANK, y[WAVE], most, p.banks, memory)
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
    onto = out - b.load_viscous * y[LOAD_SPEED] - brake - weight(y[LOAD], p.load) + shaking(time, p.load)
    onto -= drag(2, time, y[LOAD], y[LOAD_SPEED], p.drags)
    onto -= body_friction(2, LOAD_BANK, y[LOAD], y[LOAD_SPEED], y, p, memory, dy)
    inertia = b.load_inertia
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

    onto_motor = motor - into - b.motor_viscous * y[MOTOR_SPEED] - drag(0, time, y[MOTOR], y[MOTOR_SPEED], p.drags)
    onto_motor -= body_friction(0, MOTOR_BANK, y[MOTOR], y[MOTOR_SPEED], y, p, memory, dy)
    onto_wave = into - gear * (1.0 / b.ratio + slope) - on_wave - mesh - b.wave_viscous * y[WAVE_SPEED]
    onto_wave -= drag(1, time, y[WAVE], y[WAVE_SPEED], p.drags)
    onto_wave -= body_friction(1, WAVE_BANK, y[WAVE], y[WAVE_SPEED], y, p, memory, dy)

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

"""Causes on the shaft, the rotors and the drive end: how each is drawn and planted."""

from __future__ import annotations

import cmath
import math

import numpy as np

from benchmarks.withheld.draws import phase
from benchmarks.withheld.plant.rotor_line.planted import Planted
from benchmarks.withheld.plant.rotor_line.sizes import grown, one_of, sign

STATION = {"rotor_1": 1, "rotor_2": 3}


def unbalance(bench: Planted, place: str, strength: float, rng: np.random.Generator) -> None:
    """A mass added to a rotor, in its plane (law 1) or beside it (law 2), on top of the known unbalance."""
    r = place.replace("rotor_", "r")
    law = one_of(rng, 1, 1, 2)
    added = grown(strength, 6e-8, 1e-5) if r == "r1" else grown(strength, 1.2e-7, 2e-5)
    angle = phase(rng)
    before = cmath.rect(bench.values[f"e_{r}"], bench.values[f"a_{r}"])
    after = before + cmath.rect(added, angle)
    old = bench.values[f"a_{r}"]
    turned = old + (cmath.phase(after) - old + math.pi) % (2 * math.pi) - math.pi
    bench.multiply(f"e_{r}", abs(after) / bench.values[f"e_{r}"])
    bench.multiply(f"a_{r}", turned / old)
    bench.effect.update(added_eccentricity=added, added_angle=angle)
    if law == 2:
        lever = sign(rng) * rng.uniform(0.03, 0.06)
        thin = bench.values[f"Jt_{r}"] - bench.values[f"Jp_{r}"]
        moment = thin * cmath.rect(bench.values[f"tau_{r}"], bench.values[f"b_{r}"])
        moment += lever * bench.values[f"m_{r}"] * cmath.rect(added, angle)
        bench.values[f"tau_{r}"], bench.values[f"b_{r}"] = abs(moment) / abs(thin), cmath.phase(moment / thin)
        bench.effect.update(added_lever=lever)


def bow(bench: Planted, place: str, strength: float, rng: np.random.Generator) -> None:
    """A bent shaft: 1 a half sine between the bearings with its tangent beyond, 2 a kink at rotor 1, 3 a kink at bearing 2."""
    law, size, angle = one_of(rng, 1, 1, 2, 3), grown(strength, 5e-8, 1e-5), phase(rng)
    p = bench.values
    z = np.array([p["z_b1"], p["z_r1"], p["z_b2"], p["z_r2"]])
    span = z[2] - z[0]
    if law == 1:
        shape, lean = np.sin(np.pi * z / span), np.pi / span * np.cos(np.pi * z / span)
        shape[3], lean[3] = -np.pi / span * (z[3] - z[2]), -np.pi / span
    elif law == 2:
        left, right = 1 / (z[1] - z[0]), -1 / (z[2] - z[1])
        shape, lean = np.array([0.0, 1.0, 0.0, right * (z[3] - z[2])]), np.array([left, 0.5 * (left + right), right, right])
    else:
        shape, lean = np.array([0.0, 0.0, 0.0, 1.0]), np.array([0.0, 0.0, 0.5, 1.0]) / (z[3] - z[2])
    c, s = math.cos(angle), math.sin(angle)
    bench.causes.bow[:] = size * np.stack([c * shape, s * shape, c * lean, -s * lean], axis=1)
    bench.effect.update(bow=size, bow_angle=angle, bow_law=law)


def misalignment(bench: Planted, place: str, strength: float, rng: np.random.Generator) -> None:
    """A misaligned coupling at the drive end; the laws are in laws.misalignment_force."""
    law = one_of(rng, 1, 1, 2, 3)
    row = bench.causes.misalignment
    if law == 2:
        k, part, offset, direction = 4e4, rng.uniform(0.15, 0.4), grown(strength, 5e-6, 4e-3), phase(rng)
        row[:4] = 2, k, part, phase(rng)
        row[4:8] = offset * math.cos(direction), offset * math.sin(direction), rng.uniform(0.1, 0.5) * offset, phase(rng)
        bench.effect.update(mis_offset=offset, mis_stiffness=k, mis_part=part)
    else:
        twice = grown(strength, 0.1, 60.0)
        row[:5] = law, rng.uniform(0.1, 0.7) * twice, phase(rng), twice, phase(rng)
        row[5:8] = rng.uniform(0.0, 0.25) * twice, phase(rng), rng.uniform(0.5, 1.0)
        row[8:10] = (0.6, rng.uniform(0.0, 0.05)) if law == 3 else (0.0, 0.0)
        bench.effect.update(mis1=row[1], mis2=row[3], mis3=row[5])
    bench.effect.update(mis_law=law)


def crack(bench: Planted, place: str, strength: float, rng: np.random.Generator) -> None:
    """A transverse crack beside rotor 1 that breathes; the laws are in laws.openness (5 since set 25, 4 since set 6, 2 before)."""
    law, section = one_of(rng, 1, 5, 3), one_of(rng, 0, 1)
    where = rng.uniform(0.6, 0.95) if section == 0 else rng.uniform(0.05, 0.4)
    compliance = grown(strength, 2.5e-9, 1e-6)
    scale = {1: rng.uniform(10.0, 40.0), 5: rng.uniform(0.2, 0.8), 3: rng.uniform(5.0, 25.0)}[law]
    gape = rng.uniform(-0.15, 0.15)
    bench.causes.crack[:] = law, section, where, compliance, rng.uniform(0.1, 0.4) * compliance, phase(rng), scale, gape
    bench.effect.update(crack=compliance, crack_law=law, section=section, crack_place=where, crack_scale=scale, crack_gape=gape)


def rub(bench: Planted, place: str, strength: float, rng: np.random.Generator) -> None:
    """A stator around a rotor with little room; the laws are in laws.rub_force."""
    law, station = one_of(rng, 1, 2, 3), STATION[place]
    travel, rest = bench.travel(station), bench.rest()
    gap = travel * (1.0 - grown(strength, 0.03, 0.65))
    shift, way = rng.uniform(0.0, 0.08) * (travel - gap), phase(rng)
    k = grown(strength, 4e5, 1e7)
    row = bench.causes.rub
    row[:4] = law, gap, rest[4 * station] + shift * math.cos(way), rest[4 * station + 1] + shift * math.sin(way)
    row[4:10] = k, rng.uniform(50.0, 500.0), rng.uniform(0.05, 0.2), 0.05, rng.uniform(0.04, 0.09), 0.0
    if law == 2:
        row[4], row[5], row[9] = k / (1.5 * math.sqrt(2e-5)), rng.uniform(0.2, 1.5), rng.uniform(0.4, 0.8)
    elif law == 3:
        row[9] = rng.uniform(2e-5, 1e-4)
    row[10] = station
    bench.effect.update(rub_gap=gap, rub_stiffness=row[4], rub_friction=row[6], rub_radius=row[8], rub_law=law)


def internal_damping(bench: Planted, place: str, strength: float, rng: np.random.Generator) -> None:
    """Material damping that turns with the shaft: 1 viscous, 2 a relaxing stiffness (standard linear solid)."""
    law = one_of(rng, 1, 1, 2)
    viscous = grown(strength, 2e-7, 1.6e-5)
    if law == 1:
        bench.causes.internal[:] = 1, viscous, 0.0
        bench.effect.update(internal_damping=viscous)
    else:
        tau = grown(rng.random(), 2e-4, 2e-3)
        bench.causes.internal[:] = 2, viscous / tau, tau
        bench.effect.update(internal_share=viscous / tau, internal_time=tau)
    bench.effect.update(internal_law=law)


def torque_ripple(bench: Planted, place: str, strength: float, rng: np.random.Generator) -> None:
    """Motor torque beside the command, in orders of the drive end's angle: 1 of constant size, 2 that grows with the torque."""
    law = one_of(rng, 1, 1, 2)
    orders = [(1, 2, 4), (2, 4, 8), (3, 6, 12), (6, 12, 1)][int(rng.integers(4))]
    size = grown(strength, 0.004, 1.5) * (orders[0] ** 0.7)
    row = bench.causes.ripple
    row[0], row[1] = law, 0.4
    for n, order in enumerate(orders):
        row[2 + 3 * n : 5 + 3 * n] = size * (1.0, rng.uniform(0.1, 0.4), rng.uniform(0.0, 0.2))[n], order, phase(rng)
    bench.effect.update(ripple=size, ripple_order=orders[0], ripple_law=law)

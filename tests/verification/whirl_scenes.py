"""Rotor lines with published or closed-form frequencies, for several tests."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import pytest

import hdrive_mbs as hm

E, G, RHO, D = 211e9, 81.2e9, 7810.0, 0.05
FULL_SPEED = 4000.0 * math.pi / 30.0


def disc(diameter: float) -> hm.Rotor:
    """70 mm thick, bored to the shaft."""
    return hm.Rotor.disc(diameter=diameter, thickness=0.07, density=RHO, bore=D)


def bearing(kx: float, ky: float | None = None, damping: float = 0.0) -> hm.Bearing:
    law = hm.LinearBearing(stiffness_xx=kx, stiffness_yy=kx if ky is None else ky, damping_xx=damping, damping_yy=damping)
    return hm.Bearing(law=law)


def friswell(stations: Sequence[tuple[float, hm.Component]], elements: int = 6) -> hm.Scene:
    """A shaft of 1.5 m with these parts along it, in equal elements."""
    parts: dict[str, hm.Component] = {}
    chain: list[str] = []
    for k, (position, part) in enumerate(stations):
        if k:
            length = position - stations[k - 1][0]
            count = round(length / 1.5 * elements)
            assert count * 1.5 / elements == pytest.approx(length)
            parts[f"section_{k}"] = hm.ShaftSection(
                length=length, diameter=D, youngs_modulus=E, shear_modulus=G, density=RHO, elements=count, shear=True
            )
            chain.append(f"section_{k}")
        parts[f"station_{k}"] = part
        chain.append(f"station_{k}")
    return hm.Scene(name="Friswell", parts=parts, connections=[tuple(chain)])


def two_discs(elements: int = 6, **support: float) -> hm.Scene:
    end = bearing(**support)  # type: ignore[arg-type]
    return friswell([(0.0, end), (0.5, disc(0.28)), (1.0, disc(0.35)), (1.5, end)], elements)


def overhung_machine(elements: int = 6) -> hm.Scene:
    return friswell([(0.0, bearing(1e7)), (1.0, bearing(1e7)), (1.5, disc(0.35))], elements)


PINNED = {"length": 0.9, "diameter": 0.05, "youngs_modulus": 2e11, "shear_modulus": 7.7e10, "density": 7800.0}


def pinned(stiffness: float, elements: int = 96) -> hm.Scene:
    end = bearing(stiffness)
    shaft = hm.ShaftSection(**PINNED, elements=elements, rotary_inertia=False)
    return hm.Scene(name="pinned shaft", parts={"a": end, "shaft": shaft, "b": end}, connections=[("a", "shaft", "b")])


OVERHUNG = {"length": 0.4, "diameter": 0.02, "youngs_modulus": 2.1e11, "shear_modulus": 8.1e10}


def overhung_disc() -> hm.Scene:
    """Massless cantilever with a disc at its end (m = 5, Id = .02, Ip = .04)."""
    parts = {"shaft": hm.ShaftSection(**OVERHUNG), "disc": hm.Rotor(mass=5.0, polar_inertia=0.04, transverse_inertia=0.02)}
    return hm.Scene(name="overhung disc", parts=parts, connections=[("ground", "shaft", "disc")])


def overhung_closed_form(speed: float) -> np.ndarray:
    """Roots w of (k11 - m w^2)(k22 - Id w^2 + Ip W w) = k12^2 over x + i y and theta - i psi; negative: backward."""
    bending, length = 2.1e11 * math.pi / 64.0 * 0.02**4, 0.4
    k11, k12, k22 = 12.0 * bending / length**3, -6.0 * bending / length**2, 4.0 * bending / length
    product = np.polymul([-5.0, 0.0, k11], [-0.02, 0.04 * speed, k22])
    return np.sort(np.roots(np.polyadd(product, [-(k12**2)])).real)


MASS, K, C = 4.0, 9e4, 30.0


def jeffcott(cross: float, damping: float = C) -> hm.Scene:
    """A rotor on one bearing with k_xy = -k_yx = cross; tilts are held by springs of their own."""
    law = hm.LinearBearing(
        stiffness_xx=K,
        stiffness_yy=K,
        stiffness_xy=cross,
        stiffness_yx=-cross,
        stiffness_psi=1e4,
        stiffness_theta=1e4,
        damping_xx=damping,
        damping_yy=damping,
    )
    rotor = hm.Rotor(mass=MASS, polar_inertia=0.02, transverse_inertia=0.015)
    return hm.Scene(name="Jeffcott", parts={"rotor": rotor, "bearing": hm.Bearing(law=law)}, connections=[("rotor", "bearing")])


def torsional(inertias: Sequence[float], stiffnesses: Sequence[float], dampings: Sequence[float] | None = None) -> hm.Scene:
    parts: dict[str, hm.Component] = {}
    chain: list[str] = []
    for k, inertia in enumerate(inertias):
        parts[f"disc_{k}"] = hm.Inertia(inertia=inertia)
        chain.append(f"disc_{k}")
        if k < len(stiffnesses):
            parts[f"shaft_{k}"] = hm.Shaft(stiffness=stiffnesses[k], damping=dampings[k] if dampings else 0.0)
            chain.append(f"shaft_{k}")
    return hm.Scene(name="torsional chain", parts=parts, connections=[tuple(chain)])

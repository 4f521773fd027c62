"""Static deflection against beam formulae, bearing loads against the weight."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.analysis.unbalance.deflection_line import StaticDeflection
from hdrive_mbs.errors import AnalysisError, ParameterError, PlaceError
from models.two_rotor_line import build

G = 9.80665
BALANCED = 1e-9
"""The deflection is found to 1e-10 of the weight."""


def with_gravity(scene: hm.Scene, **gravity: float) -> hm.Scene:
    return hm.Scene(name=scene.name, parts={**scene.parts, "gravity": hm.Gravity(**gravity)}, connections=scene.connections)


def line(**section: Any) -> hm.Scene:
    law = hm.LinearBearing.isotropic(radial=2e7, damping=100.0, axial=1e7)
    ring = {"mass": 0.4, "polar_inertia": 1e-4, "transverse_inertia": 1e-4}
    shaft = {"diameter": 0.03, "youngs_modulus": 2.1e11, "shear_modulus": 8.1e10, **section}
    parts: dict[str, Any] = {
        "left": hm.Bearing(law=law, **ring),
        "one": hm.ShaftSection(length=0.5, **shaft),
        "disc": hm.Rotor(mass=10.0, polar_inertia=0.05, transverse_inertia=0.03, eccentricity=1e-3),
        "two": hm.ShaftSection(length=0.5, **shaft),
        "right": hm.Bearing(law=law, **ring),
    }
    return with_gravity(hm.Scene(name="beam", parts=parts, connections=[("left", "one", "disc", "two", "right")]))


def test_a_disc_in_the_middle_of_a_shaft_sags_as_the_beam_formula_says() -> None:
    result = hm.static_deflection(line())
    bending = 2.1e11 * math.pi * 0.03**4 / 64.0
    support = (0.5 * 10.0 + 0.4) * G / 2e7
    # F L^3/(48 E I) between the bearings, slope F L^2/(16 E I) at them
    assert result["left"]["y"] == pytest.approx(-support, rel=BALANCED)
    assert result["disc"]["y"] == pytest.approx(-support - 10.0 * G / (48.0 * bending), rel=BALANCED)
    # y' = -psi: the line falls from the left bearing on
    assert result["left"]["psi"] == pytest.approx(10.0 * G / (16.0 * bending), rel=BALANCED)
    assert result["disc"]["psi"] == pytest.approx(0.0, abs=1e-12)
    assert result["right"]["z"] == pytest.approx(1.0)
    assert result.bearing_load("left") == pytest.approx((0.0, -5.4 * G), rel=BALANCED, abs=1e-9)
    assert result.status == "complete"


def test_bearings_carry_the_whole_weight_of_shaft_rings_and_rotors() -> None:
    result = hm.static_deflection(line(density=7800.0, elements=4))
    weight = (10.0 + 0.8 + 7800.0 * math.pi / 4.0 * 0.03**2) * G
    assert result.weight_y == pytest.approx(-weight, rel=1e-12)
    assert result.load_y.sum() == pytest.approx(-weight, rel=BALANCED)
    # a simply supported beam under its own weight q: 5 q L^4/(384 E I) on top, and the mass of the discs
    bending, q = 2.1e11 * math.pi * 0.03**4 / 64.0, 7800.0 * math.pi / 4.0 * 0.03**2 * G
    sag = 10.0 * G / (48.0 * bending) + 5.0 * q / (384.0 * bending) + (0.5 * weight) / 2e7
    # a consistent load of straight displacement shares q per element: off by about (1/elements)^2/10 of the share of q
    assert result["disc"]["y"] == pytest.approx(-sag, rel=5e-3)


@pytest.mark.parametrize("cubic", [0.0, 1e12])
def test_housings_carry_themselves_and_bearings_the_rest(cubic: float) -> None:
    result = hm.static_deflection(with_gravity(build(cubic=cubic)), speed=200.0)
    turning = 0.8 + 8.0 + 3.0 + 2.0 * 0.35
    assert result.load_y.sum() == pytest.approx(-turning * G, rel=BALANCED)
    for bearing in ("bearing_a", "bearing_b"):
        # the foundation of 6e6 N/m carries the load of the bearing and the housing of 2.5 kg
        _, load = result.bearing_load(bearing)
        assert result[f"{bearing}.housing"]["y"] == pytest.approx((load - 2.5 * G) / 6e6, rel=1e-8)
    assert result.status == "complete"


def test_weight_along_x_bends_the_line_in_x() -> None:
    down, aside = hm.static_deflection(line()), hm.static_deflection(with_gravity(line().without("gravity"), x=-G, y=0.0))
    np.testing.assert_allclose(aside.x, down.y, rtol=1e-8, atol=1e-15)
    np.testing.assert_allclose(aside.theta, -down.psi, rtol=1e-8, atol=1e-12)


def test_a_cross_coupled_bearing_lets_the_disc_down_aside() -> None:
    # [k, q; -q, k] (x, y) = (0, -W): x = q W/(k^2 + q^2), y = -k W/(k^2 + q^2)
    k, q, mass = 2e6, 1.5e6, 3.0
    law = hm.LinearBearing.from_matrices(
        stiffness=np.array([[k, q, 0, 0, 0, 0], [-q, k, 0, 0, 0, 0], [0, 0, 1e6, 0, 0, 0], *np.diag([0, 0, 0, 1e4, 1e4, 0.0])[3:]]),
        damping=np.diag([1e4, 1e4, 0.0, 0.0, 0.0, 0.0]),
    )
    parts: dict[str, Any] = {"rotor": hm.Rotor(mass=mass, polar_inertia=0.02, transverse_inertia=0.02), "bearing": hm.Bearing(law=law)}
    result = hm.static_deflection(with_gravity(hm.Scene(name="film", parts=parts, connections=[("rotor", "bearing")])))
    assert result["rotor"]["x"] == pytest.approx(q * mass * G / (k**2 + q**2), rel=BALANCED)
    assert result["rotor"]["y"] == pytest.approx(-k * mass * G / (k**2 + q**2), rel=BALANCED)
    assert result.bearing_load("bearing") == pytest.approx((0.0, -mass * G), rel=BALANCED, abs=1e-8)


def test_a_shaft_held_by_the_ground_shares_the_weight_and_the_status_says_so() -> None:
    scene = line()
    parts = {name: part for name, part in scene.parts.items() if name != "right"}
    held = hm.Scene(name="held", parts=parts, connections=[("left", "one", "disc", "two", "ground")])
    result = hm.static_deflection(held)
    assert "something else carries the rest" in result.status
    assert -10.4 * G < result.load_y[0] < 0.0


def test_a_line_that_nothing_holds_or_that_only_turns_is_refused() -> None:
    parts: dict[str, Any] = {
        "a": hm.Rotor(mass=1.0, polar_inertia=0.01, transverse_inertia=0.01),
        "shaft": hm.ShaftSection(length=0.5, diameter=0.03, youngs_modulus=2.1e11, shear_modulus=8.1e10),
        "b": hm.Rotor(mass=1.0, polar_inertia=0.01, transverse_inertia=0.01),
    }
    with pytest.raises(AnalysisError, match="No static deflection of 'free'"):
        hm.static_deflection(with_gravity(hm.Scene(name="free", parts=parts, connections=[("a", "shaft", "b")])))
    turning = hm.Scene(
        name="train",
        parts={"motor": hm.Inertia(inertia=1.0), "shaft": hm.Shaft(stiffness=1.0), "load": hm.Inertia(inertia=1.0)},
        connections=[("motor", "shaft", "load")],
    )
    with pytest.raises(AnalysisError, match="only turns"):
        hm.static_deflection(turning)
    with pytest.raises(ParameterError, match="must be a finite number"):
        hm.static_deflection(line(), math.inf)
    with pytest.raises(PlaceError, match="No bearing 'disc'"):
        hm.static_deflection(line()).bearing_load("disc")


def test_a_deflection_is_saved_and_written_as_a_table(tmp_path: Any) -> None:
    result = hm.static_deflection(line())
    result.save(tmp_path / "static.npz")
    np.testing.assert_array_equal(StaticDeflection.load(tmp_path / "static.npz").y, result.y)
    lines = result.to_csv(tmp_path / "static.csv").read_text().splitlines()
    assert lines[0] == "place,z [m],x [m],y [m],psi [rad],theta [rad]"
    assert lines[1].startswith("left,0,")

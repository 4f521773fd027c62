"""What a run shows of a housing: momentum of the housing, and the displacement that a probe on it sees."""

from __future__ import annotations

import numpy as np
import pytest

import hdrive_mbs as hm

HOUSING = hm.Housing(
    mass=6.0, stiffness_x=3e7, stiffness_y=5e7, damping_x=900.0, damping_y=400.0, power_stiffness_x=4e16, power_stiffness_y=1e16, power=3.0
)
LINEAR = hm.LinearBearing.isotropic(radial=4e7, damping=300.0, axial=1e7, axial_damping=100.0, tilt=1e4, tilt_damping=1.0)
POWER = hm.PowerBearing.isotropic(power_radial=1e15, radial=4e7, damping=300.0, axial=1e7, axial_damping=100.0, tilt=1e4, tilt_damping=1.0)
ROUND, NEWTON = 1e-12, 1e-10
"""Of the largest value: of sums of the same coordinates, and the engine's Newton tolerance, to which forces and accelerations balance."""


def line(law: hm.BearingLaw) -> hm.Scene:
    ring = hm.Bearing(law=law, mass=0.5, polar_inertia=2e-4, transverse_inertia=2e-4, housing=HOUSING)
    return hm.rotor_line(
        "two bearings",
        stations={
            "a": (0.0, ring),
            "disc": (0.25, hm.Rotor.disc(diameter=0.2, thickness=0.03, density=7850.0, eccentricity=1e-3)),
            "b": (0.6, ring),
        },
        shaft=[(-0.05, 0.65, 0.03)],
        material=hm.ShaftMaterial(youngs_modulus=2.1e11, shear_modulus=8e10, density=7850.0),
        largest_element=0.2,
        parts={"drive": hm.DriveTorque(characteristic=hm.TorqueSpeedTable(speeds=(0.0, 1.0), torques=(20.0, 20.0)))},
        connections=[("drive", "disc")],
    )


@pytest.mark.parametrize("model", ["full", "improved"])
@pytest.mark.parametrize("law", [LINEAR, POWER], ids=["matrices alone", "with forces"])
def test_the_bearing_moves_the_housing_against_its_foundation(law: hm.BearingLaw, model: str) -> None:
    """F_foundation = k x + b x' + k_n x^3 and, where the housing is a body by itself, F_B - F_foundation = m_h x'', in every sample."""
    scene = line(law) if model == "full" else hm.with_bearings(line(law), "improved", highest_speed=400.0)
    run = hm.simulate(scene, 0.05, initial_speed=300.0, solver=hm.Trapezoidal(step=1e-4, newton_tolerance=NEWTON))
    for key in "xy":
        force, ground = run[f"a.force_{key}"].values, run[f"a.foundation_force_{key}"].values
        motion, rate = run[f"a.housing.{key}"].values, run[f"a.housing.{key}_rate"].values
        inertia = HOUSING.mass * run[f"a.housing.{key}_acceleration"].values
        largest = np.abs(force).max()
        assert largest > 100.0
        if model == "full":
            np.testing.assert_allclose(force - ground, inertia, atol=NEWTON * largest)
        stiffness, damping, power = (getattr(HOUSING, f"{name}_{key}") for name in ("stiffness", "damping", "power_stiffness"))
        np.testing.assert_allclose(ground, stiffness * motion + damping * rate + power * motion**3, atol=ROUND * largest)
        assert np.abs(power * motion**3).max() > 1e-3 * largest
        across = run[f"a.{key}"].values - motion
        np.testing.assert_allclose(run[f"a.across_{key}"].values, across, atol=ROUND * np.abs(across).max())


def test_a_bearing_in_the_ground_has_no_housing_to_show() -> None:
    scene = line(LINEAR).replacing({"a.housing": None})
    names = [channel.name for channel in scene.network().channels]
    assert "b.across_x" in names
    assert "a.across_x" not in names
    assert "a.foundation_force_x" not in names

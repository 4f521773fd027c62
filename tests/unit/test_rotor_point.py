"""Static deflection of lines that lie in their clearances, and initial values of housings behind nonlinear bearings."""

from __future__ import annotations

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.analysis.whirl.rotor_point import rotor_point

BALLS = hm.BallBearing(
    balls=8,
    ball_diameter=0.008,
    pitch_diameter=0.04,
    contact_stiffness=8e9,
    radial_clearance=1e-5,
    damping=100.0,
    axial_stiffness=1e7,
    tilt_stiffness=1e3,
    tilt_damping=0.1,
)


def line(*, housing: hm.Housing | None) -> hm.Scene:
    """A rotor between two loose ball bearings, under its weight."""
    ring = {"mass": 0.2, "polar_inertia": 3e-5, "transverse_inertia": 2e-5}
    section = hm.ShaftSection(length=0.2, diameter=0.03, youngs_modulus=2.1e11, shear_modulus=8.1e10)
    return hm.Scene(
        name="loose",
        parts={
            "left": hm.Bearing(law=BALLS, housing=housing, **ring),
            "shaft_1": section,
            "rotor": hm.Rotor(mass=6.0, polar_inertia=0.03, transverse_inertia=0.016),
            "shaft_2": section,
            "right": hm.Bearing(law=BALLS, housing=housing, **ring),
            "gravity": hm.Gravity(),
        },
        connections=[("left", "shaft_1", "rotor", "shaft_2", "right")],
    )


@pytest.mark.parametrize("housing", [None, hm.Housing.isotropic(mass=3.0, stiffness=5e6, damping=500.0)])
def test_a_shaft_in_its_clearance_is_found_lying_on_the_balls(housing: hm.Housing | None) -> None:
    scene = line(housing=housing)
    point = rotor_point(scene, 50.0)
    network = scene.network()
    moment = network.moment(np.float64(0.0), point.angles, point.speeds, point.states)
    force = {c.name: float(c.read(moment)) for c in network.channels if c.name.endswith("force_y")}
    # by symmetry each bearing carries half of rotor and both rings, and pushes its housing down
    half = -9.80665 * (6.0 + 2 * 0.2) / 2.0
    assert force["left.force_y"] == pytest.approx(half, rel=1e-8)
    assert force["right.force_y"] == pytest.approx(half, rel=1e-8)
    # one ball stands straight below; its neighbours at 45 degrees do not touch: sunk by the clearance and (F/k)^(2/3) of Hertz
    down = (-half / 8e9) ** (2.0 / 3.0) + 1e-5
    sunk = -(float(point.angles["left.y"]) if housing is None else float(point.angles["left.across_y"]))
    angle = float(point.angles["left.x"]) if housing is None else float(point.angles["left.across_x"])
    assert down * np.cos(np.pi / 4.0) < 1e-5
    assert abs(angle) < 1e-9
    assert sunk == pytest.approx(down, rel=1e-6)


def test_initial_values_of_a_housing_behind_a_nonlinear_bearing_are_those_of_the_housing() -> None:
    scene = line(housing=hm.Housing.isotropic(mass=3.0, stiffness=5e6, damping=500.0))
    start = {"left.x": 2e-5, "left.housing.x": 5e-6, "right.y": -1e-5, "left.housing.y_rate": 1e-3}
    response = hm.simulate(scene, 2e-5, solver=hm.Trapezoidal(step=1e-5), initial=start)
    first = {
        name: response.values[name][0] for name in ("left.x", "left.housing.x", "left.across_x", "right.across_y", "left.housing.y_rate")
    }
    assert first == pytest.approx(
        # x - x_h; a housing that is not named stays at rest
        {"left.x": 2e-5, "left.housing.x": 5e-6, "left.across_x": 1.5e-5, "right.across_y": -1e-5, "left.housing.y_rate": 1e-3},
        rel=1e-12,
    )


def test_a_shaft_that_nothing_holds_has_no_static_deflection() -> None:
    scene = hm.Scene(
        name="falling",
        parts={"rotor": hm.Rotor(mass=1.0, polar_inertia=0.02, transverse_inertia=0.012), "gravity": hm.Gravity()},
        connections=[],
    )
    with pytest.raises(hm.AnalysisError, match=r"No static deflection of 'falling'.*'rotor\.y'"):
        rotor_point(scene, 10.0)

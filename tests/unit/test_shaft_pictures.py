"""Pictures along the shafts of a line: shafts that a coupling joins, curves between places, the order of a drive."""

from __future__ import annotations

import functools

import numpy as np
import pytest
from matplotlib.axes import Axes

import hdrive_mbs as hm
from hdrive_mbs.plots.shafts import drive_order, shaft_numbers
from tests.unit.picture_checks import assert_nothing_is_cut_off, figure_of

LAW = hm.LinearBearing.isotropic(radial=4e7, damping=500.0, axial=1e8, tilt=1e3)
RING = hm.Bearing(law=LAW, mass=0.3, polar_inertia=2e-4, transverse_inertia=2e-4)


@functools.cache
def coupled() -> hm.Scene:
    """A shaft with a heavy disc, and the armature of a motor behind a coupling at its end."""
    return hm.rotor_line(
        "coupled",
        stations={
            "hub": (0.0, hm.Rotor(mass=1.0, polar_inertia=1e-3, transverse_inertia=6e-4)),
            "a": (0.1, RING),
            "disc": (0.3, hm.Rotor.disc(diameter=0.4, thickness=0.04, density=7800, eccentricity=2e-5)),
            "b": (0.6, RING),
        },
        shaft=0.035,
        material=hm.ShaftMaterial(youngs_modulus=2.1e11, shear_modulus=8e10, density=7800, damping=1e-5),
        parts={
            "armature": hm.Rotor(mass=5.0, polar_inertia=0.02, transverse_inertia=0.03),
            "held": hm.Bearing(law=LAW),
            "coupling": hm.FlexibleCoupling(torsional_stiffness=2e3, radial_stiffness=1e5, tilt_stiffness=10.0),
            "weight": hm.Gravity(),
        },
        connections=[("armature", "held"), ("armature", "coupling", "hub")],
    )


@functools.cache
def geared() -> hm.Scene:
    """The same disc behind a motor and a gear."""
    gear = hm.HarmonicDrive(ratio=50.0, stiffness=hm.CubicStiffness(linear=2e4, cubic=1e8), damping=20.0, wave_generator_inertia=1e-4)
    return hm.rotor_line(
        "geared",
        stations={"a": (0.05, RING), "wheel": (0.3, coupled().parts["disc"]), "b": (0.6, RING)},
        shaft=[(0.0, 0.65, 0.035)],
        material=hm.ShaftMaterial(youngs_modulus=2.1e11, shear_modulus=8e10, density=7800, damping=1e-5),
        parts={
            "motor": hm.Motor(inertia=2e-3, characteristic=hm.TorqueSpeedTable(speeds=(0.0, 300.0), torques=(9.0, 0.0), extrapolate=True)),
            "gear": gear,
            "output": hm.Shaft(stiffness=2e4, inertia=1e-3),
        },
        connections=[("motor", "gear", "output", "section_1")],
    )


def curves(ax: Axes) -> list[np.ndarray]:
    """(x, y) of the lines with a label of their own, broken where there are gaps."""
    return [np.asarray(line.get_xydata(), float) for line in ax.lines if not line.get_label().startswith("_")]


def test_a_coupling_does_not_join_two_shafts_and_sections_do() -> None:
    places = ("armature", "hub", "a", "section_2.b", "disc", "b")
    assert shaft_numbers(coupled(), places) == [0, 1, 1, 1, 1, 1]
    assert shaft_numbers(None, places) == [0] * len(places)


def test_no_curve_runs_from_one_shaft_to_the_other() -> None:
    modes = hm.whirl_modes(coupled(), 100.0, count=6)
    figure = figure_of(hm.plot(modes))
    for panel in figure.axes:
        for curve in curves(panel):
            along = curve[:, 0]
            # both begin at z = 0: a joined curve would have a piece of no length there
            steps = np.diff(along)
            assert np.all(steps[np.isfinite(steps)] > 0.0)
    deflection = hm.static_deflection(coupled())
    ax = hm.plot(deflection)
    largest = 1e6 * max(float(np.abs(deflection.y).max()), float(np.abs(deflection.x).max()))
    assert all(np.nanmax(np.abs(curve[:, 1])) < 1.1 * largest for curve in curves(ax))


def test_the_axis_reaches_as_far_as_the_shaft_bends_between_its_places() -> None:
    modes = hm.whirl_modes(geared(), 300.0, count=6)
    figure = figure_of(hm.plot(modes))
    tops = []
    for panel in figure.axes:
        low, high = panel.get_ylim()
        for curve in curves(panel):
            assert np.nanmax(curve[:, 1], initial=0.0) <= high
            assert np.nanmin(curve[:, 1], initial=0.0) >= low
            tops.append(np.nanmax(np.abs(curve[:, 1]), initial=0.0))
    assert max(tops) > 1.2, "a tilting disc bends the shaft further beside it"
    assert_nothing_is_cut_off(figure.axes[0])


def test_torsion_is_drawn_from_the_motor_on() -> None:
    modes = hm.whirl_modes(geared(), 300.0)
    order = [modes.places[k] for k in drive_order(modes.scene, modes.places)]
    turning = [place for place in order if not place.endswith(".housing")]
    assert turning == ["motor", "gear.flexspline", "section_1.a", "a", "wheel", "b", "section_4.b"]
    assert drive_order(None, ("b", "a")) == [0, 1]


def test_bearing_loads_stand_below_the_deflection_line() -> None:
    ax = hm.plot(hm.static_deflection(coupled()))
    assert_nothing_is_cut_off(ax)
    named = {text.get_text().partition("\n")[0]: text for text in ax.texts}
    assert set(named) == {"a", "b", "held"}
    figure = figure_of(ax)
    figure.draw_without_rendering()
    lowest = min(float(np.nanmin(curve[:, 1])) for curve in curves(ax))
    foot = ax.transData.transform((0.0, lowest))[1]
    assert all(text.get_window_extent().y1 < foot for text in ax.texts)


def test_a_motor_that_does_not_hold_its_speed_is_shaded_apart_from_vibration() -> None:
    rising = hm.TorqueSpeedTable(speeds=(0.0, 150.0, 300.0), torques=(1.0, 4.0, 0.0), extrapolate=True)
    result = hm.campbell(geared().replacing({"motor.characteristic": rising, "gear.damping": 200.0}), np.linspace(0.0, 300.0, 7))
    assert "grows without oscillating" in result.status
    assert not result.stable[0]
    assert result.stable[-1]
    ax = hm.plot(result)
    words = {text.get_text() for text in figure_of(ax).legends[0].get_texts()}
    assert "drifts off" in words
    assert "unstable" not in words
    assert figure_of(ax).axes[1].get_xlabel() == "speed of motor [rad/s]"


def test_the_automatic_choice_of_places_is_of_rotors_and_bearings() -> None:
    ax = hm.plot(hm.unbalance_response(coupled(), np.linspace(20.0, 200.0, 10)))
    words = [text.get_text() for text in figure_of(ax).legends[0].get_texts()]
    assert set(words) <= {"hub", "a", "disc", "b", "armature"}
    assert "disc" in words


def test_lengths_down_to_nanometres_need_no_power_of_ten() -> None:
    response = hm.unbalance_response(coupled(), np.linspace(1.0, 2.0, 3))
    assert hm.plot(response).get_ylabel() == "major semi-axis, 0-peak [nm]"


def test_a_response_of_a_rotor_line_shows_its_rotors_and_bearing_forces() -> None:
    run = hm.simulate(coupled(), 0.002)
    labels = [ax.get_ylabel() for ax in figure_of(hm.plot(run)).axes]
    assert any(label.startswith("distance [") for label in labels)
    assert any(label.startswith("force") and label.endswith("[N]") for label in labels)


def test_a_run_above_a_speed_begins_its_axis_there() -> None:
    drive = {"drive": hm.DriveTorque(characteristic=lambda w: 0.5 + 0.0 * w)}
    scene = coupled()
    driven = hm.Scene(name="d", parts={**scene.parts, **drive}, connections=[*scene.connections, ("drive", "disc")])
    ax = figure_of(hm.plot(hm.run_up(driven, 0.05, initial_speed=100.0))).axes[1]
    assert ax.get_xlim()[0] == pytest.approx(100.0, abs=2.0)

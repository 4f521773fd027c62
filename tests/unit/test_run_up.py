"""Run-ups and coast-downs: peaks against independent integration and closed forms, step choice, capture, bad input."""

from __future__ import annotations

import functools
import json
import math
import threading
from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure
from scipy.special import fresnel

import hdrive_mbs as hm
from hdrive_mbs.analysis.run_up.rest_positions import FreeLine, RestPositions, rest_position
from hdrive_mbs.analysis.run_up.run_up_step import choose_step
from hdrive_mbs.analysis.run_up.speed_peaks import Whirl, speed_peaks
from hdrive_mbs.analysis.turning_alone import TurningAlone
from hdrive_mbs.analysis.unbalance.synchronous_whirl import CriticalSpeed, critical_speeds
from hdrive_mbs.analysis.whirl.line_matrices import LineMatrices
from models.two_rotor_line import build
from tests.unit.picture_checks import assert_nothing_is_cut_off, figure_of
from tests.unit.rotor_scenes import CRITICAL, DAMPING, ECCENTRICITY, MASS, POLAR, STIFFNESS, constant, holding, jeffcott, steady, support
from tests.verification.reference_sommerfeld import SpinUp, UnbalancedDisc, spin_up

ACCURACY = 1e-3
"""The default of run_up, aimed at for peaks."""


@functools.cache
def jeffcott_run() -> hm.RunUp:
    return hm.run_up(jeffcott(), 1.2)


@functools.cache
def independent() -> SpinUp:
    """The same disc by scipy, samples every 1e-4 s."""
    disc = UnbalancedDisc(mass=MASS, inertia=POLAR, stiffness=STIFFNESS, damping=DAMPING, eccentricity=ECCENTRICITY)
    return spin_up(disc, 5.0, end=1.2, step=1e-4, tolerance=1e-11, stop=False)


@functools.cache
def reference_line() -> hm.RunUp:
    return hm.run_up(build(), 2.5)


# -- peaks ------------------------------------------------------------------------------------------


def test_peak_and_speed_agree_with_an_independent_integration() -> None:
    run, other = jeffcott_run(), independent()
    # between samples of 1e-4 s the distance falls by (a t)^2/2 of itself at most, a t = 500 rad/s^2 * 1e-4 s * ...: below 1e-6
    top = int(np.argmax(other.distance))
    assert run.peak_amplitude["disc"] == pytest.approx(other.distance[top], rel=ACCURACY)
    assert run.peak_speed["disc"] == pytest.approx(other.speed[top], rel=ACCURACY)
    mass_centre = np.abs(other.states[:, 0] + 1j * other.states[:, 1] + ECCENTRICITY * np.exp(1j * other.states[:, 2]))
    assert run.mass_centre_amplitude["disc"] == pytest.approx(mass_centre.max(), rel=ACCURACY)
    assert run.final_speed == pytest.approx(other.speed[-1], rel=ACCURACY)


def test_the_error_estimate_is_about_the_error() -> None:
    run, other = hm.run_up(jeffcott(), 1.2, accuracy=1e-2, estimate_error=True), independent()
    error = abs(run.peak_amplitude["disc"] / other.distance.max() - 1.0)
    # the run returned has half the step, and so a quarter of the error aimed at; Richardson leaves the order h^4
    assert error < 0.25e-2
    assert run.peak_error["disc"] == pytest.approx(error, rel=0.2)
    assert jeffcott_run().peak_error == {}


def test_a_tenth_of_the_accuracy_gives_a_tenth_of_the_error() -> None:
    errors = [abs(hm.run_up(jeffcott(), 1.2, accuracy=a).peak_amplitude["disc"] / independent().distance.max() - 1.0) for a in (1e-2, 1e-3)]
    # order 2 and step ~ sqrt(accuracy)
    assert errors[0] / errors[1] == pytest.approx(10.0, rel=0.15)


def test_a_peak_lies_between_samples_too() -> None:
    # r = |1 - (t - 0.5217)^2| on a circle, sampled every 0.05 s; a cubic Hermite curve errs by h^4/384 max|z''''| < 1e-6 here
    t = np.linspace(0.0, 1.0, 21)
    z = (1.0 - (t - 0.5217) ** 2) * np.exp(1j * t)
    rate = (-2.0 * (t - 0.5217) + 1j * (1.0 - (t - 0.5217) ** 2)) * np.exp(1j * t)
    time, amplitude = Whirl(t, z, rate).maximum()
    assert amplitude == pytest.approx(1.0, abs=1e-6)
    assert time == pytest.approx(0.5217, abs=1e-3)


def test_the_reference_line_has_its_published_peaks_and_a_second_one_at_rotor_2() -> None:
    # tests/verification/reference_rotor_values.json, "m_ref full": an independent model and integrator (uncertainty 1e-6)
    path = Path(__file__).parents[1] / "verification" / "reference_rotor_values.json"
    reference = json.loads(path.read_text())["m_ref full"]
    run = reference_line()
    for rotor in ("rotor_1", "rotor_2"):
        assert run.peak_amplitude[rotor] == pytest.approx(reference["peaks"][rotor]["amplitude"], rel=ACCURACY)
        assert run.peak_speed[rotor] == pytest.approx(reference["peaks"][rotor]["speed"], rel=ACCURACY)
    assert run.final_speed == pytest.approx(reference["final_speed"], rel=1e-5)
    forward = [item["undamped"] for item in reference["critical_speeds"] if item["whirl"] == "forward"]
    assert run.critical_speeds == pytest.approx(forward[:2], rel=1e-9)
    first, second = run.peaks("rotor_2")
    assert (first.critical, second.critical) == pytest.approx(tuple(forward[:2]), rel=1e-9)
    assert first.amplitude == run.peak_amplitude["rotor_2"]
    # rotor 1 passes the second critical speed without a maximum of its own; its beats are none
    assert [peak.critical for peak in run.peaks("rotor_1")] == pytest.approx(forward[:1], rel=1e-9)


def test_two_resonances_make_two_peaks_and_beats_make_none() -> None:
    # z' = p_k z + i f exp(i a t^2/2) of two modes 100 and 300 rad/s, passed at 50 rad/s^2, exactly: the response of a pole to a
    # chirp by stepping z(t + h) = exp(p h) z + midpoint force, h w = 0.01
    h, a = 2e-5, 50.0
    t = np.arange(0.0, 8.0, h)
    z = np.zeros(len(t), complex)
    for w, f in ((100.0, 1.0), (300.0, 2.0)):
        pole = complex(-0.02 * w, w)
        force = f * np.exp(0.5j * a * (t + 0.5 * h) ** 2) * h * np.exp(0.5 * pole * h)
        from scipy.signal import lfilter

        z += lfilter([1.0], [1.0, -np.exp(pole * h)], np.concatenate([[0.0], force[:-1]]))
    speed = a * t
    peaks = speed_peaks(Whirl(t, z, np.gradient(z, h)), 0.5 * a * t**2, speed, np.array([100.0, 300.0]), lambda at: a * at)
    assert [peak.critical for peak in peaks] == [100.0, 300.0]
    assert 100.0 < peaks[0].speed < 120.0
    assert 300.0 < peaks[1].speed < 330.0


# -- what amplitudes count from ---------------------------------------------------------------------


def test_under_weight_the_whirl_counts_from_the_static_deflection_and_the_distance_from_the_axis() -> None:
    run = hm.run_up(jeffcott(parts={"gravity": hm.Gravity()}), 1.2)
    sag = MASS * 9.80665 / STIFFNESS
    assert run.static_deflection["disc"][1:, 0] == pytest.approx([0.0, -sag], abs=1e-12)
    # linear support: superposition, but for the torque m g e cos(phi) on the spin, 2e-3 of 5 N m once a revolution
    assert run.peak_amplitude["disc"] == pytest.approx(jeffcott_run().peak_amplitude["disc"], rel=1e-5)
    # the orbit is largest when it points down, within half a revolution of the peak, where the whirl is hardly less
    assert run.peak_amplitude["disc"] + 0.9 * sag < run.peak_distance["disc"] < run.peak_amplitude["disc"] + sag
    assert run.values["disc.whirl"][0] == pytest.approx(0.0, abs=1e-12)
    assert run.values["disc.radial"][0] == pytest.approx(sag, rel=1e-9)


def test_started_undeflected_the_rotor_falls_into_its_deflection() -> None:
    run = hm.run_up(jeffcott(constant(0.01), parts={"gravity": hm.Gravity()}), 0.1, from_static=False)
    # the step response: it starts one static deflection away from rest and swings through
    assert run.values["disc.whirl"][0] == pytest.approx(MASS * 9.80665 / STIFFNESS, rel=1e-9)
    assert run.peak_time["disc"] == 0.0


def test_started_at_a_speed_the_rotor_is_on_its_steady_orbit() -> None:
    speed = 500.0
    run = hm.coast_down(jeffcott(), 0.05, initial_speed=speed, accuracy=1e-6)
    # nothing brakes but whirl, which takes c w |Z|^2 = 2e-4 N m of 0.01 kg m^2: 1e-3 rad/s in the run, so |Z| stays
    assert run.values["disc.whirl"] == pytest.approx(abs(steady(speed)), rel=1e-4)
    assert "nothing brakes the line" in run.status
    # P leads to the other side: |Z + e|
    assert run.values["disc.mass_centre_whirl"] == pytest.approx(abs(steady(speed) + ECCENTRICITY), rel=2e-3)


def test_a_journal_bearing_carries_nothing_at_rest_and_the_run_starts_just_above_and_says_so() -> None:
    # 0.02 N s/m^2: a disc of 2 kg floats at 0.1 rad/s already; exactly at rest there is no static deflection
    scene = film(wall_stiffness=0.0)
    with pytest.raises(hm.AnalysisError, match="at 0 rad/s"):
        FreeLine(scene).point(0.0)
    run = hm.run_up(scene, 0.05)
    assert "started at 0.1 rad/s, as at rest the film of bearing carries nothing" in run.status
    asked = hm.run_up(scene, 0.05, initial_speed=0.1)
    assert "started" not in asked.status
    np.testing.assert_array_equal(run.values["disc.y"], asked.values["disc.y"])
    # from there it is a steady state: the journal follows the rising speed without ringing, never below where it began
    assert run.values["disc.y"].min() > run.values["disc.y"][0] - 1e-8
    # one that is driven backwards starts backwards, the mirror image but for the side of the unbalance
    back = hm.run_up(film(constant(-5.0), wall_stiffness=0.0), 0.05)
    assert "started at -0.1 rad/s" in back.status
    np.testing.assert_allclose(back.values["disc.y"], run.values["disc.y"], rtol=1e-4)
    run = hm.run_up(scene, 0.05, initial_speed=150.0)
    speeds, x, y = run.static_deflection["disc"]
    assert len(speeds) > 3
    assert np.all(np.diff(y) > 0.0), "the faster, the higher the journal floats"
    # it starts at rest in its film: the whirl is that of the unbalance, far below the sag
    assert run.peak_amplitude["disc"] < 0.2 * np.hypot(x, y).min()


def test_a_load_that_no_film_holds_at_a_creep_is_refused_with_the_way_out() -> None:
    # 2 t on the same bearing
    heavy = film(mass=2000.0, wall_stiffness=0.0)
    with pytest.raises(hm.AnalysisError, match=r"at 0 rad/s.*film of bearing.*wall_stiffness.*another initial_speed, or with from_static"):
        hm.run_up(heavy, 0.05)


def test_a_prescribed_run_up_from_rest_starts_where_its_film_begins_to_carry() -> None:
    motor = hm.Motor(inertia=1e-3, characteristic=hm.IdealSpeedMotor(motion=hm.SpeedRamp(start=0.0, end=300.0, duration=0.05)))
    scene = film(wall_stiffness=0.0)
    parts = {name: part for name, part in scene.parts.items() if name != "drive"} | {"motor": motor}
    run = hm.run_up(hm.Scene(name="prescribed", parts=parts, connections=[("motor", "disc", "bearing")]), 0.06)
    assert "started in the position of 0.1 rad/s" in run.status
    assert run.values["disc.speed"][0] == 0.0
    assert np.hypot(run.values["disc.x"][0], run.values["disc.y"][0]) > 0.9 * 60e-6


def film(drive: hm.TorqueSpeedTable | None = None, *, mass: float = MASS, **changes: float) -> hm.Scene:
    """A disc on a plain bearing whose wall carries it at rest."""
    fields = {
        "diameter": 0.03,
        "length": 0.012,
        "radial_clearance": 60e-6,
        "viscosity": 0.03,
        "axial_stiffness": 1e5,
        "tilt_stiffness": 1e4,
        "tilt_damping": 1.0,
        "wall_stiffness": 1e9,
        **changes,
    }
    return jeffcott(drive, law=hm.JournalBearing(**fields), parts={"gravity": hm.Gravity()}, eccentricity=5e-6, mass=mass)


def test_with_an_oil_film_no_undamped_critical_speed_is_told() -> None:
    run = hm.run_up(film(), 0.3, initial_speed=50.0)
    assert len(run.critical_speeds) == 0
    assert run.settings["critical_speeds"] == "left out, as the film of bearing makes them another matter: see campbell"
    assert all(math.isnan(peak.critical) for peak in run.peaks("disc"))
    assert "critical_speeds" not in jeffcott_run().settings


def test_the_peak_is_counted_from_the_second_revolution_on() -> None:
    # the journal lifts off its wall by 20 um while it turns by a few degrees; the unbalance moves it by 1 um
    run = hm.run_up(film(), 0.3)
    lift = run.values["disc.whirl"][np.abs(run.values["disc.angle"]) < 2.0 * math.pi].max()
    assert lift > 5.0 * run.peak_amplitude["disc"]
    first = run.times[np.abs(run.values["disc.angle"]) >= 2.0 * math.pi][0]
    assert run.peak_time["disc"] >= first - (run.times[1] - run.times[0])
    later = run.values["disc.whirl"][np.abs(run.values["disc.angle"]) >= 2.0 * math.pi].max()
    assert run.peak_amplitude["disc"] == pytest.approx(later, rel=1e-2)
    # a run that turns less has no other part to look at
    short = hm.run_up(film(), 0.05)
    assert short.peak_amplitude["disc"] == pytest.approx(short.values["disc.whirl"].max(), rel=1e-3)


def test_where_a_journal_leaves_the_wall_its_rest_position_is_followed_closely() -> None:
    line = FreeLine(film())
    table = RestPositions.over(line, ("disc",), 600.0).table["disc"]
    way = np.sum(np.abs(np.diff(table[1] + 1j * table[2])))
    # the film begins to carry within a fraction of a rad/s; evenly spaced speeds would be 25 rad/s apart
    for speed in (0.5, 2.0, 7.0):
        error = abs(rest_position(table, np.array([speed]))[0] - line.positions(line.point(speed), ("disc",))[0])
        # between points that are 5 % of the way apart a curve errs by a part of that
        assert error < 0.01 * way


def test_a_journal_that_cannot_lift_off_its_wall_in_one_step_starts_just_above_rest() -> None:
    rough = hm.Trapezoidal(step=2e-3, newton_tolerance=1e-6)
    run = hm.run_up(film(largest_eccentricity=0.999), 0.05, solver=rough)
    assert "started at 0.1 rad/s" in run.status
    # an explicit method is too coarse for the film at every speed
    with pytest.raises(hm.SimulationError, match=r"film of bearing.*initial_speed=10\.0.*shorter step"):
        hm.run_up(film(), 0.05, solver=hm.RungeKutta4(step=2e-3))
    # a spring has no film, and the hint would mislead
    stiff = jeffcott(law=support(1e15, 1e15))
    with pytest.raises(hm.SimulationError) as caught:
        hm.run_up(stiff, 0.05, solver=hm.RungeKutta4(step=1e-4))
    assert "film" not in str(caught.value)


def test_a_line_that_nothing_turns_says_so() -> None:
    run = hm.run_up(jeffcott(constant(0.0)), 0.01)
    assert "nothing turns the line: give it a DriveTorque or a Motor, or an initial_speed" in run.status
    assert "nothing turns" not in jeffcott_run().status


# -- coast-down -------------------------------------------------------------------------------------


def braked(torque: float = 5.0) -> hm.Scene:
    return jeffcott(constant(torque)).with_effect(hm.ViscousDrag(coefficient=0.02), at="disc")


def test_a_coast_down_passes_the_critical_speed_late_too_which_is_below_it() -> None:
    run = hm.coast_down(braked(), 1.0, initial_speed=600.0)
    # J w' = -d w: w = 600 exp(-2 t).  Whirl takes integral of c |z'|^2 dt, 0.5 J here, of the 33 J left: 0.8 % of w
    assert run.final_speed == pytest.approx(600.0 * math.exp(-2.0), rel=1e-2)
    assert run.peak_speed["disc"] < CRITICAL
    (peak,) = run.peaks("disc")
    assert peak.critical == pytest.approx(CRITICAL, rel=1e-9)
    assert jeffcott_run().peak_speed["disc"] > CRITICAL


def test_a_coast_down_switches_the_drive_off_unless_told_to_keep_it() -> None:
    free, driven = (hm.coast_down(braked(-5.0), 0.2, initial_speed=600.0, driven=keep) for keep in (False, True))
    # far above the critical speed whirl takes c w |Z|^2 = 3e-4 N m and less, against 8 N m of drag
    assert free.final_speed == pytest.approx(600.0 * math.exp(-0.4), rel=1e-4)
    # J w' = -5 - d w:  (w + 250) decays with d/J = 2 1/s; 320 rad/s is near the resonance, where whirl takes more
    assert driven.final_speed == pytest.approx(850.0 * math.exp(-0.4) - 250.0, rel=5e-3)


# -- where the torque goes --------------------------------------------------------------------------


def test_whirl_takes_the_torque_that_its_damping_dissipates() -> None:
    run = hm.run_up(jeffcott(holding(350.0, 1.0)), 1.0, initial_speed=340.0)
    w = run.final_speed
    # c w |Z|^2 of the steady whirl; the run settles to it with 6.25 1/s, and within the last tenth it has to e^-5.6
    assert run.whirl_torque == pytest.approx(DAMPING * w * abs(steady(w)) ** 2, rel=2e-2)
    assert run.applied_torque == pytest.approx(350.0 - w, rel=2e-2)
    assert run.driven_speed == pytest.approx(350.0, rel=1e-3)
    assert not run.captured, "0.1 % of slip is no capture"


def test_a_line_that_its_own_drag_holds_is_not_captured() -> None:
    scene = jeffcott(constant(2.0)).with_effect(hm.ViscousDrag(coefficient=0.02), at="disc")
    # d/J = 2 1/s: after 4 s within e^-8 of 2/0.02 = 100 rad/s, a third of the critical speed
    run = hm.run_up(scene, 4.0)
    assert run.final_speed == pytest.approx(100.0, rel=1e-3)
    assert not run.captured
    assert run.status == "complete"


def test_a_prescribed_motion_has_no_torque_balance() -> None:
    motion = hm.SpeedRamp(start=0.0, end=600.0, duration=1.2)
    parts = {"drive": hm.Motor(inertia=0.01, characteristic=hm.IdealSpeedMotor(motion=motion))}
    run = hm.run_up(jeffcott(parts=parts), 1.2)
    assert not run.captured
    assert math.isnan(run.whirl_torque)
    # at the same 500 rad/s^2 the torque-driven disc passes its resonance a little slower and so reaches higher
    assert jeffcott_run().peak_amplitude["disc"] > run.peak_amplitude["disc"]
    assert run.peak_amplitude["disc"] == pytest.approx(jeffcott_run().peak_amplitude["disc"], rel=5e-3)


def test_the_torque_of_a_prescribed_unbalanced_rotor_says_what_it_lacks() -> None:
    motor = hm.Motor(inertia=1e-3, characteristic=hm.IdealSpeedMotor(motion=hm.ConstantSpeed(value=200.0)))
    docs = []
    for eccentricity in (0.0, ECCENTRICITY):
        parts = {"motor": motor, "disc": jeffcott(eccentricity=eccentricity).parts["disc"], "bearing": hm.Bearing(law=support())}
        scene = hm.Scene(name="prescribed", parts=parts, connections=[("motor", "disc", "bearing")])
        docs += [channel.doc for channel in scene.network().channels if channel.name == "motor.torque"]
    assert docs == ["torque that motor needs to keep its motion" + end for end in ("", ", without what the whirl of its unbalance takes")]


def test_a_prescribed_constant_speed_starts_on_the_steady_orbit() -> None:
    parts = {"drive": hm.Motor(inertia=0.01, characteristic=hm.IdealSpeedMotor(motion=hm.ConstantSpeed(value=500.0)))}
    run = hm.run_up(jeffcott(parts=parts), 0.05, accuracy=1e-6)
    assert run.values["disc.whirl"] == pytest.approx(abs(steady(500.0)), rel=1e-5)


def test_a_rotor_behind_a_gear_has_its_own_speed_and_sense() -> None:
    law = hm.LinearBearing.isotropic(radial=1800.0, damping=6.0, axial=1e4, axial_damping=10.0, tilt=5e3, tilt_damping=1.0)
    gear = hm.HarmonicDrive(
        ratio=50.0, stiffness=lambda twist: 3e4 * twist, damping=20.0, wave_generator_inertia=1.69e-4, flexspline_inertia=4e-4
    )
    parts = {
        "motor": hm.Motor(inertia=1.5e-3, characteristic=constant(2.0)),
        "gear": gear,
        "disc": hm.Rotor(mass=2.0, polar_inertia=0.05, transverse_inertia=0.03, eccentricity=1e-3),
        "bearing": hm.Bearing(law=law),
    }
    run = hm.run_up(hm.Scene(name="geared rotor", parts=parts, connections=[("motor", "gear", "disc", "bearing")]), 2.0)
    # the flexspline turns backwards at 1/50: critical sqrt(1800/2) = 30 rad/s at 1500 rad/s of the motor
    assert run.reference == "motor"
    assert run.critical_speeds == pytest.approx([1500.0], rel=1e-9)
    assert -45.0 < run.peak_speed["disc"] < -30.0
    # rigid line: (J_m + J_wg + J_out/50^2) w' = 2 N m, less what the damping of whirl takes (1 %)
    assert run.final_speed == pytest.approx(4.0 / (1.669e-3 + 0.0504 / 2500.0), rel=1e-2)
    assert run.final_speeds["disc"] == pytest.approx(-run.final_speed / 50.0, rel=1e-3)


def test_a_run_the_other_way_round_has_the_same_amplitudes() -> None:
    back = hm.run_up(jeffcott(constant(-5.0)), 1.2)
    assert back.peak_amplitude["disc"] == pytest.approx(jeffcott_run().peak_amplitude["disc"], rel=1e-9)
    assert back.peak_speed["disc"] == pytest.approx(-jeffcott_run().peak_speed["disc"], rel=1e-9)


# -- critical speeds and the step -------------------------------------------------------------------


def critical(scene: hm.Scene) -> list[float]:
    line = FreeLine(scene)
    return [item.speed for item in critical_speeds(line.lines, line.point(100.0), line.point(300.0))]


def test_the_critical_speed_of_tilting_is_that_of_forward_whirl_with_the_gyroscope() -> None:
    # k = W^2 (Jt - Jp) in step with the spin; none for a disc with Jp > Jt, whose frequency outruns the spin
    assert critical(jeffcott(polar_inertia=0.002, eccentricity=0.0, tilt=1e-3)) == pytest.approx([math.sqrt(5e3 / 0.004)], rel=1e-6)
    assert critical(jeffcott(polar_inertia=0.01, eccentricity=0.0, tilt=1e-3)) == []


def test_an_unsymmetric_support_has_two_critical_speeds_that_unbalance_excites() -> None:
    assert critical(jeffcott(law=support(1e5, 2e5))) == pytest.approx([math.sqrt(5e4), math.sqrt(1e5)], rel=1e-9)


def test_a_balanced_line_has_no_excited_critical_speed() -> None:
    assert critical(jeffcott(eccentricity=0.0)) == []


def test_the_fastest_speed_is_that_of_the_line_without_whirl() -> None:
    # w = T t/J; Newton's method stops at 1e-6
    assert TurningAlone(jeffcott().network(), 1.2, 0.0).fastest()["disc"] == pytest.approx(600.0, rel=1e-5)
    assert TurningAlone(jeffcott(holding(350.0, 1.0)).network(), 1.0, 0.0).fastest()["disc"] == pytest.approx(350.0, rel=1e-5)


def late(critical: float, acceleration: float) -> float:
    """Frequency at the peak of an undamped resonance passed with an acceleration: see run_up_step.LATE."""
    u = np.linspace(0.0, 3.0, 30001)
    sine, cosine = fresnel(u)
    top = u[np.argmax(np.abs(cosine + 0.5 + 1j * (sine + 0.5)))]
    return critical + float(top) * math.sqrt(math.pi * acceleration)


def test_the_step_follows_the_highest_critical_speed_met_and_the_highest_speed() -> None:
    met = [CriticalSpeed(100.0, 100.0, 0.02, ())]
    # (w h)^2/1.75 = 1e-3 where 100 rad/s is met, swept with 200 rad/s in 100 s, and (w h)^2/24 = 1e-3 at the top
    step = choose_step({"disc": 200.0}, {"disc": 1.0}, met, 100.0, 1e-3).step
    assert step == pytest.approx(math.sqrt(1.75e-3) / late(100.0, 2.0), rel=1e-3)
    assert choose_step({"disc": 900.0}, {"disc": 1.0}, met, 100.0, 1e-3).step == pytest.approx(math.sqrt(24e-3) / 900.0, rel=1e-2)
    # nothing is met later than at the highest speed
    assert choose_step({"disc": 101.0}, {"disc": 1.0}, met, 100.0, 1e-3).step == pytest.approx(math.sqrt(1.75e-3) / 101.0, rel=1e-3)
    # a critical speed far above is not met; then the highest speed itself counts
    assert choose_step({"disc": 50.0}, {"disc": 1.0}, met, 100.0, 1e-3).step == pytest.approx(math.sqrt(1.75e-3) / 50.0, rel=1e-2)


def test_a_motor_before_a_reduction_gear_is_resolved_too() -> None:
    slow = choose_step({"disc": 6.0}, {"disc": 0.02}, [], 100.0, 1e-3, 6.0)
    # (w h)^2/1.75 = 1e-3 at the disc alone, (w h)^2/24 = 1e-3 at the motor
    assert slow.step == pytest.approx(math.sqrt(1.75e-3) / 6.0, rel=1e-2)
    geared = choose_step({"disc": 6.0}, {"disc": 0.02}, [], 100.0, 1e-3, 300.0)
    assert geared.step == pytest.approx(math.sqrt(24e-3) / 300.0, rel=1e-2)
    assert geared.reason == "(w h)^2/24 <= 0.001 at the highest speed before a gear, w = 300 rad/s"


def test_a_lesser_resonance_may_be_four_times_as_rough() -> None:
    # reach 1 and 0.1 m at one place with equal damping: amplitudes 10 : 1, the limit is 4
    met = [CriticalSpeed(100.0, 100.0, 0.02, (1.0,)), CriticalSpeed(300.0, 300.0, 0.02, (0.1,))]
    assert choose_step({"disc": 310.0}, {"disc": 1.0}, met, 1e4, 1e-3).step == pytest.approx(math.sqrt(7e-3) / 300.0, rel=1e-2)
    alike = [CriticalSpeed(100.0, 100.0, 0.02, (1.0, 0.0)), CriticalSpeed(300.0, 300.0, 0.02, (0.0, 0.1))]
    assert choose_step({"disc": 310.0}, {"disc": 1.0}, alike, 1e4, 1e-3).step == pytest.approx(math.sqrt(1.75e-3) / 300.0, rel=1e-2)


def test_on_a_line_with_cubic_springs_the_chosen_step_keeps_its_promise() -> None:
    # where (w h)^2/2 at the critical speed itself was 0.116 % off, as resonance bends to higher speeds with the amplitude
    laws = {f"bearing_{b}.law.stiffness_{key}{key}": 1.2e7 for b in "ab" for key in "xy"}
    scene = hm.with_bearings(build(cubic=1e18).replacing(laws), "improved")
    run, fine = (hm.run_up(scene, 2.5, accuracy=accuracy, sample_step=2e-4) for accuracy in (ACCURACY, 1e-4))
    for rotor in ("rotor_1", "rotor_2"):
        # the rule is of order 2: the fine run is off by a tenth of the difference and a little
        assert abs(run.peak_amplitude[rotor] / fine.peak_amplitude[rotor] - 1.0) < 0.9 * ACCURACY


def test_the_settings_say_step_and_reason() -> None:
    settings = jeffcott_run().settings
    # swept with 500 rad/s^2: sqrt(1.75e-3)/364.5, a whole number of steps in 1.2 s
    assert late(CRITICAL, 500.0) == pytest.approx(364.5, abs=0.05)
    assert "Trapezoidal(step=0.0001147" in settings["solver"]
    assert settings["step"] == "(w h)^2/1.75 <= 0.001 at w = 364.5 rad/s, where a run meets the critical speed of 316.2 rad/s"


# -- the result -------------------------------------------------------------------------------------


def test_a_run_is_saved_and_loaded_whole(tmp_path: Path) -> None:
    run = jeffcott_run()
    again = hm.RunUp.load(run.save(tmp_path / "run.npz"))
    assert len(run.peaks("disc")) == 1
    assert again.peaks("disc") == run.peaks("disc")
    assert again.peak_amplitude == run.peak_amplitude
    assert again.status == run.status
    np.testing.assert_array_equal(again["disc.whirl"].values, run["disc.whirl"].values)
    assert "disc.mass_centre_whirl [m]" in again.columns()


def test_places_other_than_rotors_can_be_asked_for() -> None:
    run = hm.run_up(build(), 0.2, places=("bearing_a", "rotor_1"))
    assert run.rotors == ("bearing_a", "rotor_1")
    assert run.peak_amplitude["bearing_a"] == pytest.approx(float(run.values["bearing_a.radial"].max()), rel=1e-3)


def test_the_status_says_what_the_run_did_not_reach() -> None:
    run = hm.run_up(jeffcott(), 0.6)
    # 300 rad/s, just below the critical speed; T/J = 500 rad/s^2, of which whirl takes 2e-3 N m of 5
    assert "the speed still changes, by 499 rad/s^2 at the end" in run.status
    assert "the amplitude of disc is largest at the very end: give a longer duration" in run.status


def test_the_status_says_that_a_stiffening_bearing_has_not_let_the_line_through() -> None:
    # k + 3/4 k_3 r^2 = m w^2 on the backbone: at 400 rad/s r = 0.89 mm and the damping allows 3.2 mm
    stiffening = hm.PowerBearing.isotropic(
        radial=STIFFNESS, damping=DAMPING, axial=1e5, axial_damping=10.0, tilt=5e3, tilt_damping=0.5, power_radial=2e11
    )
    drive = holding(400.0, 0.02)
    held, through = (hm.run_up(jeffcott(drive, law), 4.0).status for law in (stiffening, support()))
    assert "though the speed is above the critical speed of 316.23 rad/s" in held
    assert through == "complete"


def test_a_cancelled_run_returns_what_it_has() -> None:
    cancel = threading.Event()
    cancel.set()
    run = hm.run_up(jeffcott(), 1.2, cancel=cancel)
    assert run.status.startswith("cancelled at t = ")
    assert len(run.times) < 100


def test_fewer_samples_keep_the_peak_by_interpolation() -> None:
    run = hm.run_up(jeffcott(), 1.2, sample_step=1e-3)
    # w h = 0.36 between samples: cubic Hermite (w h)^4/384 = 4e-5
    assert len(run.times) < 1300
    assert run.peak_amplitude["disc"] == pytest.approx(jeffcott_run().peak_amplitude["disc"], rel=1e-4)


# -- the picture ------------------------------------------------------------------------------------


def test_the_picture_shows_both_centres_over_speed_with_peaks_and_critical_speeds(tmp_path: Path) -> None:
    run = reference_line()
    first = hm.plot(run)
    assert_nothing_is_cut_off(first)
    axes = figure_of(first).axes
    assert [ax.get_title(loc="left") for ax in axes] == ["", "drive disc", "rotor 1", "rotor 2"]
    assert first.get_xlabel() == "time [s]"
    assert axes[-1].get_xlabel() == "speed of the rotor [rad/s]"
    assert all("0-peak [µm]" in ax.get_ylabel() for ax in axes[1:])
    # rotor 1 alone is unbalanced: a line for C and one for P; 428.5 um and its speed are written beside its peak
    curves = [line for line in axes[2].get_lines() if len(line.get_xdata()) > 100]
    assert len(curves) == 2
    assert float(np.max(curves[0].get_ydata())) == pytest.approx(1e6 * run.peak_amplitude["rotor_1"], rel=1e-3)
    beside = (f"{1e6 * run.peak_amplitude['rotor_1']:.1f}", f"{run.peak_speed['rotor_1']:.1f}")
    assert beside[0] == "428.5"
    assert any(all(number in text.get_text() for number in beside) for text in axes[2].texts)
    upright = [line.get_xdata()[0] for line in axes[2].get_lines() if len(line.get_xdata()) == 2]
    assert sorted(map(float, upright)) == pytest.approx(run.critical_speeds.tolist(), rel=1e-9)
    png, svg = hm.save_figure(first, tmp_path / "run")
    assert png.stat().st_size > 10_000
    assert svg.stat().st_size < 1_000_000


def test_the_picture_of_one_rotor_goes_on_axes_of_the_caller() -> None:
    own = Figure().add_subplot()
    assert hm.plot(jeffcott_run(), ax=own, about="axis", logarithmic=True) is own
    assert own.get_ylabel() == "distance from axis,\n0-peak [mm]"
    assert own.get_yscale() == "log"
    assert len(figure_of(own).axes) == 1
    with pytest.raises(hm.ParameterError, match="about = 'zero': must be one of static, axis"):
        hm.plot(jeffcott_run(), about="zero")
    with pytest.raises(hm.PlaceError, match="No rotor 'rotor'"):
        hm.plot(jeffcott_run(), rotors=["rotor"])


# -- bad input --------------------------------------------------------------------------------------


def test_bad_questions_are_refused_with_the_way_out() -> None:
    with pytest.raises(hm.ParameterError, match=r"duration = 0.*greater than 0 s"):
        hm.run_up(jeffcott(), 0.0)
    with pytest.raises(hm.ParameterError, match=r"accuracy = 1: must be between 1e-8 and 0\.1"):
        hm.run_up(jeffcott(), 1.0, accuracy=1.0)
    with pytest.raises(hm.PlaceError, match=r"No place with lateral motion 'dics'.*disc"):
        hm.run_up(jeffcott(), 1.0, places=("dics",))
    with pytest.raises(hm.ParameterError, match="needs a speed to fall from"):
        hm.coast_down(jeffcott(), 1.0, initial_speed=0.0)
    with pytest.raises(hm.PlaceError, match=r"No rotor 'rotor'. This run has: disc"):
        jeffcott_run().peaks("rotor")
    turning = hm.Scene(
        name="train",
        parts={"motor": hm.Motor(inertia=1.0, characteristic=constant(1.0)), "wheel": hm.Inertia(inertia=1.0)},
        connections=[("motor", "wheel")],
    )
    with pytest.raises(hm.AnalysisError, match=r"everything in 'train' only turns; use start_up"):
        hm.run_up(turning, 1.0)


def test_a_line_without_rotor_needs_places() -> None:
    parts = {
        "drive": hm.DriveTorque(characteristic=constant(1.0)),
        "bearing": hm.Bearing(law=support(), mass=1.0, polar_inertia=0.01, transverse_inertia=0.01),
    }
    scene = hm.Scene(name="ring", parts=parts, connections=[("drive", "bearing")])
    with pytest.raises(hm.AnalysisError, match=r"has no rotor; name the places"):
        hm.run_up(scene, 0.1)
    assert LineMatrices(scene.network()).names
    assert hm.run_up(scene, 0.1, places=("bearing",)).peak_amplitude["bearing"] == 0.0

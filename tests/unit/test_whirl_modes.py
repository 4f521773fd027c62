"""Damped modes of rotor lines: closed forms, whirl, shapes, free motions, operating points."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.errors import AnalysisError, HdriveError, ParameterError
from tests.verification.scenes import chain
from tests.verification.whirl_scenes import OVERHUNG, bearing, disc, friswell, jeffcott, overhung_disc, two_discs

M, K, C, JT, JP, KT = 4.0, 9e4, 60.0, 0.015, 0.02, 1e4


def on_a_bearing(law: hm.BearingLaw, **more: Any) -> hm.Scene:
    """A rigid rotor on one bearing that holds its tilts too."""
    rotor = hm.Rotor(mass=M, polar_inertia=JP, transverse_inertia=JT, **more.pop("unbalance", {}))
    parts = {"rotor": rotor, "bearing": hm.Bearing(law=law), **more}
    return hm.Scene(name="rotor on a bearing", parts=parts, connections=[("rotor", "bearing")])


def isotropic(radial: float = K, damping: float = C) -> hm.LinearBearing:
    return hm.LinearBearing.isotropic(radial=radial, damping=damping, tilt=KT)


def pick(modes: hm.WhirlModes, word: str, near: float) -> int:
    """The mode of that kind whose frequency is nearest."""
    own = [k for k, w in enumerate(modes.whirl) if w == word]
    return min(own, key=lambda k: abs(modes.frequencies[k] - near))


# -- numbers ----------------------------------------------------------------------------------------------


def test_eigenvalue_frequency_damping_and_decrement_of_a_damped_rotor_follow_the_closed_form() -> None:
    # m x'' + c x' + k x = 0
    modes = hm.whirl_modes(on_a_bearing(isotropic()), 120.0)
    w, zeta = math.sqrt(K / M), C / (2.0 * math.sqrt(K * M))
    for word in ("backward", "forward"):
        k = pick(modes, word, w)
        assert modes.eigenvalues[k] == pytest.approx(complex(-zeta * w, w * math.sqrt(1.0 - zeta**2)), rel=1e-12)
        assert modes.frequencies[k] == pytest.approx(w * math.sqrt(1.0 - zeta**2), rel=1e-12)
        assert modes.natural[k] == pytest.approx(w, rel=1e-12)
        assert modes.damping_ratios[k] == pytest.approx(zeta, rel=1e-12)
        assert modes.log_decrements[k] == pytest.approx(2.0 * math.pi * zeta / math.sqrt(1.0 - zeta**2), rel=1e-12)
    assert modes.stable
    assert modes.status == "complete"


def test_tilts_split_by_gyroscopic_moments_as_the_closed_form_says() -> None:
    # Jt b'' - i Jp W b' + kt b = 0 for b = theta - i psi: w^2 - (Jp/Jt) W w - kt/Jt = 0, negative roots: backward
    speed = 500.0
    roots = np.roots([JT, -JP * speed, -KT])
    modes = hm.whirl_modes(on_a_bearing(isotropic(damping=0.0)), speed)
    for root in roots:
        word = "forward" if root > 0.0 else "backward"
        k = pick(modes, word, abs(root))
        assert modes.frequencies[k] == pytest.approx(abs(root), rel=1e-12)
        assert modes.circularity[k] == pytest.approx(1.0 if root > 0.0 else -1.0, abs=1e-9)


def test_an_overdamped_motion_is_reported_apart_with_its_two_rates() -> None:
    # m x'' + c x' + k x = 0 with zeta = 2.5: -lambda = w (zeta -+ sqrt(zeta^2 - 1)), in x and in y
    w, zeta = math.sqrt(K / M), 2.5
    modes = hm.whirl_modes(on_a_bearing(isotropic(damping=2.0 * zeta * math.sqrt(K * M))), 0.0)
    root = math.sqrt(zeta**2 - 1.0)
    assert modes.decay_rates == pytest.approx([w * (zeta - root)] * 2 + [w * (zeta + root)] * 2, rel=1e-9)
    assert modes.frequencies == pytest.approx([math.sqrt(KT / JT)] * 2, rel=1e-9)
    assert modes.stable


def test_a_free_rotor_has_only_its_precession() -> None:
    # nothing holds it: Jt b'' - i Jp W b' = 0 leaves w = (Jp/Jt) W, forward; six motions without stiffness
    rotor = hm.Scene(name="free", parts={"rotor": hm.Rotor(mass=M, polar_inertia=JP, transverse_inertia=JT)}, connections=[])
    spinning, resting = hm.whirl_modes(rotor, 100.0), hm.whirl_modes(rotor, 0.0)
    assert spinning.frequencies == pytest.approx([JP / JT * 100.0], rel=1e-12)
    assert spinning.whirl == ("forward",)
    assert (spinning.free_motions, resting.free_motions) == (6, 6)
    assert (len(resting.frequencies), len(resting.decay_rates), len(spinning.decay_rates)) == (0, 0, 0)


def test_turning_and_sliding_as_a_whole_are_taken_out_without_slow_modes() -> None:
    modes = hm.whirl_modes(two_discs(kx=1e6), 100.0, count=None)
    assert modes.free_motions == 2
    assert modes.frequencies.min() > 80.0
    assert len(modes.decay_rates) == 0


def test_growth_without_oscillation_is_said() -> None:
    # a spring that pushes away: x grows with sqrt(k/m)
    modes = hm.whirl_modes(on_a_bearing(hm.LinearBearing.isotropic(radial=-K, damping=0.0, tilt=KT)))
    assert not modes.stable
    assert modes.decay_rates == pytest.approx([-math.sqrt(K / M)] * 2 + [math.sqrt(K / M)] * 2, rel=1e-9)
    assert modes.status == "complete; unstable: a motion grows without oscillating"


def test_the_number_of_growing_modes_is_in_the_status() -> None:
    modes = hm.whirl_modes(jeffcott(2e4), 200.0)
    assert modes.status == "complete; unstable: 1 of these modes grows"
    assert not modes.stable


# -- whirl ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("scene", [overhung_disc(), two_discs(kx=1e6), on_a_bearing(isotropic())], ids=["overhung", "two discs", "bearing"])
def test_at_rest_pairs_are_circles_backward_before_forward_as_they_part_at_small_speed(scene: hm.Scene) -> None:
    rest, slow = hm.whirl_modes(scene, 0.0, count=11), hm.whirl_modes(scene, 0.05, count=11)
    whirling = [k for k, word in enumerate(rest.whirl) if word in ("forward", "backward")]
    assert [rest.whirl[k] for k in whirling] == ["backward", "forward"] * (len(whirling) // 2)
    assert np.abs(rest.circularity[whirling]) == pytest.approx(1.0, abs=1e-9)
    assert rest.whirl == slow.whirl
    # shapes change by the order of speed over frequency
    np.testing.assert_allclose(rest.shapes, slow.shapes, rtol=1e-3, atol=1e-3)


def test_without_gyroscopic_moments_a_pair_stays_together_and_still_has_both_senses() -> None:
    modes = hm.whirl_modes(on_a_bearing(isotropic(damping=0.0)), 500.0)
    pair = [k for k in range(len(modes.frequencies)) if modes.frequencies[k] == pytest.approx(math.sqrt(K / M), rel=1e-9)]
    assert [modes.whirl[k] for k in pair] == ["backward", "forward"]
    assert modes.circularity[pair] == pytest.approx([-1.0, 1.0], abs=1e-9)


def test_orbits_in_a_straight_line_are_called_mixed() -> None:
    # unlike bearings, at rest: each mode moves in one plane
    modes = hm.whirl_modes(two_discs(kx=1e6, ky=0.8e6))
    lateral = [k for k, word in enumerate(modes.whirl) if word != "torsional"]
    assert {modes.whirl[k] for k in lateral} == {"mixed"}
    assert modes.circularity[lateral] == pytest.approx(0.0, abs=1e-9)


def test_a_mode_whose_discs_whirl_in_opposite_senses_is_called_mixed() -> None:
    modes = hm.whirl_modes(two_discs(kx=1e6, ky=0.2e6), 1500.0, count=8)
    named = [modes.places.index(place) for place in ("station_1", "station_2")]
    for k, word in enumerate(modes.whirl):
        x, y = modes.shapes[k, :, 0], modes.shapes[k, :, 1]
        area = -np.imag(np.conj(x) * y)  # of each orbit: forward > 0
        if word == "mixed":
            assert area.min() < -1e-3 * area.max() or area.max() < 1e-3 * -area.min() or np.prod(np.sign(area)) <= 0.0
            assert np.any(area > 0.0)
            assert np.any(area < 0.0)
        if word in ("forward", "backward"):
            assert np.all(np.sign(area[named]) == (1.0 if word == "forward" else -1.0))
    assert {"mixed", "forward", "backward"} <= set(modes.whirl)


def test_turning_the_other_way_mirrors_the_whirl_but_not_the_frequencies() -> None:
    there, back = hm.whirl_modes(two_discs(kx=1e6), 300.0), hm.whirl_modes(two_discs(kx=1e6), -300.0)
    assert back.frequencies == pytest.approx(there.frequencies, rel=1e-9)
    assert back.whirl == there.whirl
    assert back.circularity == pytest.approx(there.circularity, abs=1e-9)


def geared(motor_speed: float) -> hm.Scene:
    """An overhung disc behind a gear that turns it backwards at a tenth of the motor's speed."""
    parts = {
        "motor": hm.Motor(inertia=1e-3, characteristic=hm.IdealSpeedMotor(motion=hm.ConstantSpeed(value=motor_speed))),
        "gear": hm.HarmonicDrive(ratio=10.0, stiffness=lambda twist: 1e5 * twist, damping=1.0),
        "disc": hm.Rotor(mass=5.0, polar_inertia=0.04, transverse_inertia=0.02),
        "bearing": hm.Bearing(law=hm.LinearBearing.isotropic(radial=1e6, damping=0.0, axial=1e6, tilt=1e3)),
    }
    return hm.Scene(name="geared", parts=parts, connections=[("motor", "gear", "disc", "bearing")])


def test_forward_means_the_sense_of_the_shaft_that_whirls_also_behind_a_gear() -> None:
    # Jt w^2 -+ Jp W w - kt = 0 at W = 100 rad/s of the disc; forward is the faster one, whatever the sign of W
    modes = hm.whirl_modes(geared(0.0), 1000.0)
    fast, slow = sorted(np.abs(np.roots([0.02, -0.04 * 100.0, -1e3])), reverse=True)
    assert modes.frequencies[pick(modes, "forward", fast)] == pytest.approx(fast, rel=1e-9)
    assert modes.frequencies[pick(modes, "backward", slow)] == pytest.approx(slow, rel=1e-9)
    # about +z the forward orbit turns negatively: psi leads theta ... area of (theta, -psi) < 0
    k = pick(modes, "forward", fast)
    psi, theta = modes.shapes[k, modes.places.index("disc"), 3:5]
    assert -np.imag(np.conj(theta) * -psi) < 0.0


# -- shapes -----------------------------------------------------------------------------------------------


def test_shapes_are_those_of_the_places_with_the_largest_amplitude_one() -> None:
    # massless cantilever: from (k12 , k22 - Id w^2 + Ip W w) the tilt per displacement of a whirl with frequency w
    speed = 300.0
    modes = hm.whirl_modes(overhung_disc(), speed)
    bending, length = 2.1e11 * math.pi / 64.0 * 0.02**4, OVERHUNG["length"]
    k12, k22 = -6.0 * bending / length**2, 4.0 * bending / length
    assert modes.places == ("disc",)
    assert modes.positions == pytest.approx([0.4])
    for k, word in enumerate(modes.whirl):
        if word not in ("forward", "backward"):
            continue
        w = modes.frequencies[k] * (1.0 if word == "forward" else -1.0)
        x, y, z, psi, theta, phi = modes.shapes[k, 0]
        assert x == pytest.approx(1.0, rel=1e-9)
        assert y == pytest.approx(-1j if word == "forward" else 1j, rel=1e-9)  # x = cos, y = +- sin
        assert theta == pytest.approx(-k12 / (k22 - 0.02 * w**2 + 0.04 * speed * w), rel=1e-8)
        assert -psi == pytest.approx(theta * y, rel=1e-8)
        assert (abs(z), abs(phi)) == pytest.approx((0.0, 0.0), abs=1e-12)


def test_a_torsional_mode_is_scaled_by_its_spin_though_an_oil_film_couples_it_with_displacement() -> None:
    law = hm.JournalBearing(
        diameter=0.03, length=0.012, radial_clearance=60e-6, viscosity=0.03, axial_stiffness=1e5, tilt_stiffness=1e4, tilt_damping=1.0
    )
    parts = {
        "rotor": hm.Rotor(mass=M, polar_inertia=JP, transverse_inertia=JT),
        "bearing": hm.Bearing(law=law),
        "spring": hm.Shaft(stiffness=500.0),
        "wheel": hm.Inertia(inertia=0.03),
        "weight": hm.Gravity(),
    }
    scene = hm.Scene(name="coupled", parts=parts, connections=[("rotor", "bearing"), ("rotor", "spring", "wheel")])
    modes = hm.whirl_modes(scene, 300.0)
    k = modes.whirl.index("torsional")
    assert modes.frequencies[k] == pytest.approx(math.sqrt(500.0 * (1.0 / JP + 1.0 / 0.03)), rel=1e-3)
    spins = dict(zip(modes.places, modes.shapes[k, :, 5], strict=True))
    # momentum: Jp phi_rotor + J phi_wheel = 0
    assert spins["rotor"] == pytest.approx(1.0, rel=1e-3)
    assert spins["wheel"] == pytest.approx(-JP / 0.03, rel=1e-3)


def test_places_of_one_rigid_body_move_as_one_body() -> None:
    parts = {
        "rotor": hm.Rotor(mass=M, polar_inertia=JP, transverse_inertia=JT),
        "arm": hm.RigidSection(length=0.1),
        "bearing": hm.Bearing(law=isotropic()),
    }
    scene = hm.Scene(name="merged", parts=parts, connections=[("rotor", "arm", "bearing")])
    modes = hm.whirl_modes(scene, 100.0)
    assert modes.places == ("rotor", "bearing")
    rotor, held = modes.shapes[:, 0], modes.shapes[:, 1]
    np.testing.assert_allclose(held[:, 0], rotor[:, 0] + 0.1 * rotor[:, 4], atol=1e-12)
    np.testing.assert_allclose(held[:, 1], rotor[:, 1] - 0.1 * rotor[:, 3], atol=1e-12)


def test_housings_are_places_of_their_own() -> None:
    housing = hm.Housing.isotropic(mass=2.0, stiffness=5e5, damping=0.0)
    parts = {
        "rotor": hm.Rotor(mass=M, polar_inertia=JP, transverse_inertia=JT),
        "bearing": hm.Bearing(law=isotropic(damping=0.0), housing=housing),
    }
    modes = hm.whirl_modes(hm.Scene(name="housed", parts=parts, connections=[("rotor", "bearing")]))
    assert modes.places == ("rotor", "bearing.housing")
    # (k_b - m w^2) x = k_b x_h
    k = 0
    x, x_h = modes.shapes[k, :, 0]
    assert x_h / x == pytest.approx(1.0 - M * modes.frequencies[k] ** 2 / K, rel=1e-9)


# -- which scenes -----------------------------------------------------------------------------------------


def test_a_train_that_only_turns_has_torsional_modes_as_hm_modes_finds_them() -> None:
    scene = chain([0.5, 1.5, 0.25], [200.0, 900.0])
    modes, reference = hm.whirl_modes(scene), hm.modes(scene)
    assert modes.frequencies == pytest.approx(reference.damped, rel=1e-8)
    assert modes.whirl == ("torsional", "torsional")
    assert np.isnan(modes.positions).all()
    np.testing.assert_allclose(np.abs(modes.shapes[:, :, 5]).T, np.abs(reference.shapes), atol=1e-8)


def test_hm_modes_of_a_rotor_line_are_its_torsional_modes() -> None:
    scene = two_discs(kx=1e6)
    torsional = [w for w, word in zip(*(lambda m: (m.frequencies, m.whirl))(hm.whirl_modes(scene, count=None))) if word == "torsional"]
    modes = hm.modes(scene, motor_speed=0.0)
    assert modes.undamped == pytest.approx(torsional, rel=1e-6)
    assert modes.rigid_modes == 1
    assert not [name for name in modes.bodies if name.endswith((".x", ".psi"))]


def test_unbalance_and_its_weight_do_not_change_the_modes() -> None:
    eccentric = {"eccentricity": 1e-4, "angle": 1.0, "tilt": 1e-3}
    plain = hm.whirl_modes(on_a_bearing(isotropic()), 200.0)
    heavy = hm.whirl_modes(on_a_bearing(isotropic(), unbalance=eccentric, gravity=hm.Gravity()), 200.0)
    np.testing.assert_allclose(heavy.eigenvalues, plain.eigenvalues, rtol=1e-12)
    assert heavy.free_motions == plain.free_motions


def test_a_bearing_with_a_cubic_spring_is_taken_about_the_position_under_the_weight() -> None:
    # k y + k3 y^3 = m g; slope k + 3 k3 y^2 in y, k in x
    k3 = 5e13
    law = hm.PowerBearing.isotropic(power_radial=k3, radial=K, damping=0.0, tilt=KT)
    modes = hm.whirl_modes(on_a_bearing(law, gravity=hm.Gravity()), 0.0)
    y = float(np.real(next(root for root in np.roots([k3, 0.0, K, -M * 9.80665]) if abs(root.imag) < 1e-9 * abs(root))))
    expected = sorted([math.sqrt(K / M), math.sqrt((K + 3.0 * k3 * y**2) / M)])
    planar = modes.frequencies[[k for k in range(len(modes.whirl)) if np.abs(modes.shapes[k, 0, :2]).max() > 0.5]]
    assert expected[1] > 1.05 * expected[0], "the cubic part must matter"
    assert np.sort(planar) == pytest.approx(expected, rel=1e-9)


def test_coefficients_that_depend_on_the_speed_are_those_of_the_speed() -> None:
    law = hm.TableBearing(
        speeds=(0.0, 100.0), stiffness_xx=(K, 4.0 * K), stiffness_yy=(K, 4.0 * K), damping_xx=(0.0, 0.0), damping_yy=(0.0, 0.0)
    )
    scene = hm.Scene(
        name="table",
        parts={"rotor": hm.Rotor(mass=M, polar_inertia=JP, transverse_inertia=JT), "bearing": hm.Bearing(law=law)},
        connections=[("rotor", "bearing")],
    )
    for speed in (0.0, 50.0, 100.0):
        modes = hm.whirl_modes(scene, speed)
        expected = math.sqrt(K * (1.0 + 0.03 * speed) / M)
        assert modes.frequencies[pick(modes, "forward", expected)] == pytest.approx(expected, rel=1e-9)


def test_a_prescribed_motor_turns_the_line_at_the_speed_asked_for() -> None:
    one, other = hm.whirl_modes(geared(1.0), 800.0), hm.whirl_modes(geared(-300.0), 800.0)
    np.testing.assert_allclose(one.eigenvalues, other.eigenvalues, rtol=1e-9)


# -- result -----------------------------------------------------------------------------------------------


def test_the_lowest_modes_are_those_of_the_whole_list() -> None:
    few, every = hm.whirl_modes(two_discs(kx=1e6), 100.0, count=5), hm.whirl_modes(two_discs(kx=1e6), 100.0, count=None)
    assert len(few.frequencies) == 5
    np.testing.assert_allclose(few.eigenvalues, every.eigenvalues[:5], rtol=1e-12)
    assert np.all(np.diff(every.natural) >= -1e-9 * every.natural[1:])
    assert every.eigenvalues.shape == every.frequencies.shape == (len(every.whirl),)


def test_a_result_is_the_same_after_saving_and_has_a_table(tmp_path: Path) -> None:
    modes = hm.whirl_modes(two_discs(kx=1e6, damping=100.0), 50.0)
    again = hm.load(modes.save(tmp_path / "modes.npz"))
    assert isinstance(again, hm.WhirlModes)
    np.testing.assert_array_equal(again.eigenvalues, modes.eigenvalues)
    np.testing.assert_array_equal(again.shapes, modes.shapes)
    assert again.whirl == modes.whirl
    lines = modes.to_csv(tmp_path / "modes.csv").read_text().splitlines()
    assert lines[0].startswith("mode,whirl,damped frequency [rad/s],|eigenvalue| [rad/s],damping ratio [1],log decrement [1]")
    assert len(lines) == 13
    assert lines[1].startswith("1,backward,86.")


@pytest.mark.parametrize(
    ("arguments", "kind", "message"),
    [
        ({"speed": math.nan}, ParameterError, "speed = nan rad/s: must be a finite number"),
        ({"speed": math.inf}, ParameterError, "speed = inf rad/s"),
        ({"count": 0}, ParameterError, "count = 0: must be a whole number of at least 1"),
        ({"count": 2.5}, ParameterError, "count = 2.5"),
    ],
)
def test_a_bad_argument_is_refused(arguments: dict[str, Any], kind: type[HdriveError], message: str) -> None:
    with pytest.raises(kind, match=message):
        hm.whirl_modes(two_discs(kx=1e6), **arguments)


def test_where_no_steady_rotation_exists_the_error_says_why() -> None:
    # an oil film carries nothing at rest
    film = hm.JournalBearing(diameter=0.05, length=0.02, radial_clearance=5e-5, viscosity=0.02, tilt_stiffness=KT, tilt_damping=0.0)
    scene = on_a_bearing(film, gravity=hm.Gravity())
    with pytest.raises(AnalysisError, match="No static deflection of 'rotor on a bearing' at 0 rad/s"):
        hm.whirl_modes(scene, 0.0)
    assert len(hm.whirl_modes(scene, 200.0).frequencies) > 0


def test_a_shaft_without_mass_at_one_end_is_not_singular_but_refused_by_the_scene() -> None:
    # a station without inertia would make the eigenproblem singular; the scene names it
    with pytest.raises(HdriveError, match="no inertia"):
        hm.whirl_modes(hm.Scene(name="bare", parts={"a": bearing(1e6), "b": bearing(1e6)}, connections=[("a", "b")]))
    assert hm.whirl_modes(friswell([(0.0, bearing(1e6)), (1.5, disc(0.28))])).stable

"""Campbell diagrams of rotor lines: branches, crossings, critical speeds, stability, reduced models."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

import hdrive_mbs as hm
from hdrive_mbs.analysis.whirl.crossings import zeros
from hdrive_mbs.analysis.whirl.line_block import BlockModel, line_blocks
from hdrive_mbs.analysis.whirl.mode_tracking import ModeTracker, follow
from hdrive_mbs.analysis.whirl.reduced_basis import reduced_model
from hdrive_mbs.analysis.whirl.spinning_line import SpinningLine
from hdrive_mbs.analysis.whirl.whirl_kind import WhirlKinds
from hdrive_mbs.errors import AnalysisError, HdriveError, LawError, ParameterError, PlaceError
from models.two_rotor_line import build
from tests.verification.scenes import chain
from tests.verification.whirl_scenes import FULL_SPEED, OVERHUNG, C, K, jeffcott, overhung_closed_form, overhung_disc, two_discs

SPEEDS = np.linspace(0.0, 600.0, 31)


def column(result: hm.WhirlCampbell, word: str, near: float) -> int:
    """The branch of that kind whose frequency at the first speed is nearest."""
    own = [k for k, w in enumerate(result.whirl) if w == word]
    return min(own, key=lambda k: abs(result.frequencies[0, k] - near))


def signed(speed: float, rank: int) -> float:
    """Frequency of the overhung disc by the closed form: 0, 1 backward (fast, slow), 2, 3 forward (slow, fast)."""
    return float(overhung_closed_form(speed)[rank])


# -- branches ---------------------------------------------------------------------------------------------


def test_branches_follow_the_closed_form_at_every_speed() -> None:
    result = hm.campbell(overhung_disc(), SPEEDS, count=6)
    rest = np.abs(overhung_closed_form(0.0))
    for word, rank in (("backward", 0), ("backward", 1), ("forward", 2), ("forward", 3)):
        k = column(result, word, rest[rank])
        exact = [abs(signed(speed, rank)) for speed in SPEEDS]
        np.testing.assert_allclose(result.frequencies[:, k], exact, rtol=1e-9)
        assert set(result.whirl_at[:, k]) == {word}
        np.testing.assert_allclose(np.abs(result.circularity[:, k]), 1.0, atol=1e-6)
    assert result.stable.all()
    assert result.status == "complete"


def test_at_each_speed_the_branches_are_the_modes_there() -> None:
    scene = two_discs(kx=1e6, ky=0.7e6, damping=500.0)
    result = hm.campbell(scene, SPEEDS, count=8)
    for row in (0, 13, 30):
        modes = hm.whirl_modes(scene, float(SPEEDS[row]), count=12)
        for k in range(8):
            j = int(np.argmin(np.abs(modes.eigenvalues.imag - result.frequencies[row, k])))
            assert modes.frequencies[j] == pytest.approx(result.frequencies[row, k], rel=1e-9)
            assert modes.damping_ratios[j] == pytest.approx(result.damping_ratios[row, k], rel=1e-6, abs=1e-12)
            assert modes.log_decrements[j] == pytest.approx(result.log_decrements[row, k], rel=1e-6, abs=1e-11)
            assert modes.whirl[j] == result.whirl_at[row, k]


def test_a_coarse_grid_gives_the_same_branches_as_a_fine_one() -> None:
    # forward and backward, lateral and torsional branches cross, two backward ones turn away from each other
    fine, coarse = (hm.campbell(build(), np.linspace(0.0, 1200.0, n), count=11) for n in (121, 7))
    np.testing.assert_allclose(coarse.frequencies, fine.frequencies[::20], rtol=1e-9)
    np.testing.assert_allclose(coarse.damping_ratios, fine.damping_ratios[::20], rtol=1e-6)
    assert coarse.whirl == fine.whirl


def test_branches_that_cross_keep_their_shapes_and_those_that_veer_keep_their_frequencies() -> None:
    # unlike planes: at rest 87 rad/s in x and 137 rad/s in y; the disc on a tilting spring adds a pair that crosses
    result = hm.campbell(overhung_disc(), np.linspace(0.0, 3000.0, 4), count=6)
    forward = [k for k, word in enumerate(result.whirl) if word == "forward"]
    # slow forward whirl tends to sqrt(k11/m) from below, the fast one to (Ip/Id) W: they never meet
    gap = result.frequencies[:, forward[1]] - result.frequencies[:, forward[0]]
    assert np.all(gap > 0.0)
    exact = np.array([[abs(signed(speed, rank)) for rank in (2, 3)] for speed in result.speeds])
    np.testing.assert_allclose(result.frequencies[:, forward], exact, rtol=1e-9)


def weakly_coupled(diameter: float) -> hm.Scene:
    """Tilting of a rotor whose forward frequency rises from 270 rad/s, and bouncing of another at 330 rad/s, on a thin shaft."""
    tilting = hm.LinearBearing.isotropic(radial=1e8, damping=0.0, tilt=0.015 * 270.0**2)
    still = hm.LinearBearing.isotropic(radial=4.0 * 330.0**2, damping=0.0, tilt=1e6)
    parts: dict[str, hm.Component] = {
        "a": hm.Rotor(mass=40.0, polar_inertia=0.02, transverse_inertia=0.015),
        "at_a": hm.Bearing(law=tilting),
        "b": hm.Rotor(mass=4.0, polar_inertia=1e-5, transverse_inertia=1e-2),
        "at_b": hm.Bearing(law=still),
        "link": hm.ShaftSection(length=0.2, diameter=diameter, youngs_modulus=2.1e11, shear_modulus=8e10),
    }
    return hm.Scene(name="weakly coupled", parts=parts, connections=[("at_a", "a", "link", "b", "at_b")])


def test_a_narrow_veering_is_resolved_between_two_speeds_of_the_grid() -> None:
    # a rising and a level forward branch, coupled by a thin shaft: they come within a few rad/s and turn away
    scene = weakly_coupled(3e-3)
    coarse, fine = hm.campbell(scene, np.linspace(0.0, 200.0, 5), count=8), hm.campbell(scene, np.linspace(0.0, 200.0, 801), count=8)
    pair = [k for k, word in enumerate(fine.whirl) if word == "forward" and 260.0 < fine.frequencies[0, k] < 340.0]
    assert len(pair) == 2
    gap = fine.frequencies[:, pair[1]] - fine.frequencies[:, pair[0]]
    closest = int(np.argmin(gap))
    assert 0.0 < gap[closest] < 0.05 * gap[0], "they must come close"
    assert 0 < closest < 800
    assert np.all(gap > 0.0), "coupled branches of one kind do not cross"
    np.testing.assert_allclose(coarse.frequencies, fine.frequencies[::200], rtol=1e-9)


def test_a_branch_that_becomes_overdamped_ends_there() -> None:
    # damping ratio grows with the speed and reaches 0.999 at 99.9 rad/s
    m, k = 4.0, 9e4
    top = 2.0 * math.sqrt(k * m)
    law = hm.TableBearing(
        speeds=(0.0, 200.0), stiffness_xx=(k, k), stiffness_yy=(k, k), damping_xx=(0.0, 2.0 * top), damping_yy=(0.0, 2.0 * top)
    )
    rotor = hm.Rotor(mass=m, polar_inertia=0.02, transverse_inertia=0.015)
    scene = hm.Scene(name="table", parts={"rotor": rotor, "bearing": hm.Bearing(law=law)}, connections=[("rotor", "bearing")])
    speeds = np.linspace(0.0, 200.0, 41)
    result = hm.campbell(scene, speeds, count=3)
    k_lateral = [j for j in range(3) if result.frequencies[0, j] == pytest.approx(150.0, rel=1e-9)]
    assert len(k_lateral) == 2
    for j in k_lateral:
        ratio = speeds / 100.0
        there = ratio < 0.999
        np.testing.assert_allclose(result.frequencies[there, j], 150.0 * np.sqrt(1.0 - ratio[there] ** 2), rtol=1e-6)
        np.testing.assert_allclose(result.damping_ratios[there, j], ratio[there], rtol=1e-9, atol=1e-12)
        assert np.isnan(result.frequencies[~there, j]).all()
        assert set(result.whirl_at[~there, j]) == {""}
    assert result.stable.all()


def test_torsional_and_axial_branches_are_level_and_in_the_diagram() -> None:
    result = hm.campbell(build(), np.linspace(0.0, 900.0, 10), orders=(1, 3), count=14)
    assert {"torsional", "axial", "forward", "backward"} <= set(result.whirl)
    for word in ("torsional", "axial"):
        k = result.whirl.index(word)
        assert np.ptp(result.frequencies[:, k]) < 1e-9 * result.frequencies[0, k]


def test_a_train_that_only_turns_has_a_diagram_too() -> None:
    scene = chain([0.5, 1.5, 0.25], [200.0, 900.0])
    result = hm.campbell(scene, [0.0, 50.0, 100.0])
    assert result.whirl == ("torsional", "torsional")
    assert result.frequencies[0] == pytest.approx(hm.modes(scene).damped, rel=1e-8)
    levels = result.frequencies[0]
    assert result.critical_speeds == pytest.approx([w for w in levels if w <= 100.0], rel=1e-9)


def test_without_a_number_all_branches_near_the_order_lines_are_followed() -> None:
    result = hm.campbell(two_discs(kx=1e6), np.linspace(0.0, 2000.0, 21), orders=(1,))
    assert len(result.whirl) > 6
    every = hm.campbell(two_discs(kx=1e6), np.linspace(0.0, 2000.0, 21), orders=(1,), count=16)
    np.testing.assert_allclose(result.critical_speeds, every.critical_speeds, rtol=1e-9)


def test_running_backwards_gives_the_mirrored_diagram() -> None:
    there = hm.campbell(two_discs(kx=1e6), SPEEDS, count=6)
    back = hm.campbell(two_discs(kx=1e6), -SPEEDS[::-1], count=6)
    order = [back.frequencies[-1].tolist().index(w) for w in back.frequencies[-1]]
    for k in order:
        word = back.whirl[k]
        j = min((i for i, w in enumerate(there.whirl) if w == word), key=lambda i: abs(there.frequencies[-1, i] - back.frequencies[0, k]))
        np.testing.assert_allclose(back.frequencies[::-1, k], there.frequencies[:, j], rtol=1e-9)
    np.testing.assert_allclose(np.sort(-back.critical_speeds), there.critical_speeds, rtol=1e-9)


# -- critical speeds --------------------------------------------------------------------------------------


def exact_critical(ratio: float) -> float:
    """Positive w with (k11 - m w^2)(k22 - Id w^2 + Ip w^2 / ratio) = k12^2, W = w/|ratio|; ratio < 0: backward."""
    bending, length = 2.1e11 * math.pi / 64.0 * 0.02**4, OVERHUNG["length"]
    k11, k12, k22 = 12.0 * bending / length**3, -6.0 * bending / length**2, 4.0 * bending / length
    product = np.polymul([-5.0, k11], [-0.02 + 0.04 / ratio, k22])
    squares = np.roots(np.polyadd(product, [-(k12**2)]))
    return math.sqrt(min(float(square.real) for square in squares if square.real > 0.0)) / abs(ratio)


def test_critical_speeds_are_those_of_the_closed_form_and_not_of_a_line_between_two_speeds() -> None:
    result = hm.campbell(overhung_disc(), np.linspace(0.0, 400.0, 5), orders=(1, 2), count=6)
    found: dict[tuple[float, str], float] = {}
    for speed, order, word in zip(result.critical_speeds, result.critical_orders, result.critical_whirl, strict=True):
        found.setdefault((result.order_numbers[order], word), speed)
    for order in (1.0, 2.0):
        assert found[order, "forward"] == pytest.approx(exact_critical(order), rel=1e-10)
        assert found[order, "backward"] == pytest.approx(exact_critical(-order), rel=1e-10)
    assert list(result.critical_speeds) == sorted(result.critical_speeds)
    notes = dict(zip(result.critical_whirl, result.critical_notes, strict=True))
    assert (notes["forward"], notes["backward"]) == ("", "backward")


def test_a_heavily_damped_crossing_is_marked_with_its_damping_and_amplification() -> None:
    # Friswell 5.9.5: third pair, damping ratio 0.66
    result = hm.campbell(two_discs(kx=1e6, damping=3e3), np.linspace(0.0, 1000.0, 21), count=8)
    table = result.critical_columns()
    light, heavy = table["damping ratio [1]"] < 0.2, table["damping ratio [1]"] > 0.2
    assert light.any()
    assert heavy.any()
    for k in range(len(result.critical_speeds)):
        assert ("heavily damped" in result.critical_notes[k]) == bool(heavy[k])
        row = int(np.argmin(np.abs(result.speeds - result.critical_speeds[k])))
        near = result.damping_ratios[row, result.critical_branches[k]]
        assert table["damping ratio [1]"][k] == pytest.approx(near, abs=0.05)
        undamped = result.critical_whirl[k] == "torsional"
        amplification = math.inf if undamped else 0.5 / table["damping ratio [1]"][k]
        assert table["amplification 1/(2 zeta) [1]"][k] == pytest.approx(amplification)
        assert table["frequency [rad/s]"][k] == pytest.approx(result.critical_speeds[k])


def test_critical_speeds_of_the_example_are_those_of_an_independent_model() -> None:
    # damped synchronous critical speeds of M-REF, from equations written separately (tests/verification/reference_whirl.py)
    result = hm.campbell(build(), np.linspace(0.0, 1000.0, 51))
    expected = [("backward", 360.87000492), ("forward", 370.61954093), ("backward", 719.79029855), ("forward", 796.94146050)]
    lateral = [
        (word, speed) for word, speed in zip(result.critical_whirl, result.critical_speeds, strict=True) if word in ("forward", "backward")
    ]
    for (word, speed), (wanted_word, wanted) in zip(lateral, expected, strict=False):
        assert word == wanted_word
        assert speed == pytest.approx(wanted, rel=1e-8)


def test_orders_of_another_shaft_have_its_ratio() -> None:
    parts = {
        "motor": hm.Motor(inertia=1e-3, characteristic=hm.IdealSpeedMotor(motion=hm.ConstantSpeed(value=1.0))),
        "gear": hm.HarmonicDrive(ratio=10.0, stiffness=lambda twist: 1e5 * twist, damping=1.0),
        "disc": hm.Rotor(mass=5.0, polar_inertia=0.04, transverse_inertia=0.02),
        "bearing": hm.Bearing(law=hm.LinearBearing.isotropic(radial=1e4, damping=0.0, axial=1e6, tilt=1e6)),
    }
    scene = hm.Scene(name="geared", parts=parts, connections=[("motor", "gear", "disc", "bearing")])
    result = hm.campbell(scene, np.linspace(0.0, 1000.0, 11), orders={"disc": (1.0,), "motor": (0.5,)}, count=2)
    assert result.order_slopes == pytest.approx((0.1, 0.5))
    # sqrt(k/m) = 44.72 rad/s, of the disc: at 447.2 rad/s of the motor by order 1 of the disc, at 89.4 by order 0.5 of the motor
    w = math.sqrt(1e4 / 5.0)
    assert sorted(set(np.round(result.critical_speeds, 6))) == pytest.approx([w / 0.5, w / 0.1], abs=1e-5)


def test_a_crossing_at_a_speed_of_the_grid_is_found_once() -> None:
    w = math.sqrt(K / 4.0)
    result = hm.campbell(jeffcott(0.0, 0.0), [0.5 * w, w, 2.0 * w], count=2)
    assert result.critical_speeds == pytest.approx([w, w], rel=1e-9)
    assert sorted(result.critical_whirl) == ["backward", "forward"]


def test_two_crossings_within_one_step_are_found_from_the_slopes() -> None:
    # f = (s - 1.2)(s - 1.4) is positive at 1 and at 2
    speeds = np.array([0.0, 1.0, 2.0, 3.0])

    def f(s: float) -> float:
        return (s - 1.2) * (s - 1.4)

    values, slopes = np.array([f(s) for s in speeds]), 2.0 * speeds - 2.6
    assert list(zeros(speeds, values, f, slopes)) == pytest.approx([1.2, 1.4], rel=1e-12)
    assert list(zeros(speeds, values, f)) == []
    away = values + 1.0
    assert list(zeros(speeds, away, lambda s: f(s) + 1.0, slopes)) == []


# -- stability --------------------------------------------------------------------------------------------

M, BETA, OUTSIDE = 3.0, 2e-4, 40.0


def internally_damped() -> hm.Scene:
    """A disc in the middle of a shaft that is clamped at both ends and damped inside; dampers outside."""
    half = hm.ShaftSection(length=0.3, diameter=0.02, youngs_modulus=2.1e11, shear_modulus=8.1e10, rotating_damping=BETA)
    damper = hm.LinearBearing.isotropic(radial=0.0, damping=OUTSIDE)
    parts = {
        "left": half,
        "disc": hm.Rotor(mass=M, polar_inertia=2e-3, transverse_inertia=1.5e-3),
        "damper": hm.Bearing(law=damper),
        "right": half,
    }
    return hm.Scene(name="internal damping", parts=parts, connections=[("ground", "left", "disc", "right", "ground"), ("disc", "damper")])


@dataclass(frozen=True, kw_only=True)
class RadialStop(hm.BearingLaw):
    """A soft ring that meets a stop after a gap all around."""

    soft: float = hm.parameter("N/m", "stiffness inside the gap", above=0.0)
    gap: float = hm.parameter("m", "radial gap", above=0.0)

    def forces(self, motion: hm.RelativeMotion) -> dict[str, Any]:
        radius = np.hypot(motion.x, motion.y)
        stiffness = self.soft + 1e9 * np.maximum(0.0, radius - self.gap) / (radius + 1e-12)
        return {"x": stiffness * motion.x, "y": stiffness * motion.y}


@dataclass(frozen=True, kw_only=True)
class TurnedSpring(RadialStop):
    """One that depends on the direction of the displacement, which there is none of at the centre."""

    def forces(self, motion: hm.RelativeMotion) -> dict[str, Any]:
        return {"x": self.soft * motion.x * (1.0 + 0.1 * np.arctan2(motion.y, motion.x)), "y": self.soft * motion.y}


@dataclass(frozen=True, kw_only=True)
class SteepSpring(RadialStop):
    """One that cannot be recorded, and is no number on one side of the centre."""

    def forces(self, motion: hm.RelativeMotion) -> dict[str, Any]:
        return {"x": self.soft * float(motion.x) + (float(motion.x) ** 0.5 if motion.x >= 0.0 else math.nan), "y": self.soft * motion.y}


def test_a_stop_around_a_soft_ring_leaves_the_frequencies_of_the_ring() -> None:
    def frequencies(law: hm.BearingLaw) -> Any:
        bearing = hm.Bearing(law=law)
        return hm.campbell(two_discs(kx=1e6).replacing({"station_3": bearing}), [0.0, 100.0]).frequencies

    ring = hm.LinearBearing(stiffness_xx=4e6, stiffness_yy=4e6)
    np.testing.assert_allclose(frequencies(RadialStop(soft=4e6, gap=5e-5)), frequencies(ring), rtol=1e-12)


def test_a_law_without_a_derivative_is_named_with_its_place() -> None:
    line = two_discs(kx=1e6).replacing({"station_3": hm.Bearing(law=TurnedSpring(soft=4e6, gap=5e-5))})
    with pytest.raises(LawError, match=r"station_3.*no finite derivative with respect to station_3.*[xy] where that is 0, .*np\.where"):
        hm.campbell(line, [0.0, 100.0])
    by_numbers = two_discs(kx=1e6).replacing({"station_3": hm.Bearing(law=SteepSpring(soft=4e6, gap=5e-5))})
    with pytest.raises(LawError, match=r"station_3.*no finite derivative"):
        hm.campbell(by_numbers, [0.0, 100.0])


def test_internal_damping_makes_forward_whirl_grow_above_the_speed_of_the_closed_form() -> None:
    # m r'' + (c_e + c_i) r' + (k - i c_i W) r = 0, c_i = beta k, k = 2 x 12 E I/L^3: grows for W > w (1 + c_e/c_i)
    k = 24.0 * 2.1e11 * math.pi / 64.0 * 0.02**4 / 0.3**3
    w = math.sqrt(k / M)
    threshold = w * (1.0 + OUTSIDE / (BETA * k))
    result = hm.campbell(internally_damped(), np.linspace(0.0, 2.0 * threshold, 24), count=2)
    j = result.whirl.index("forward")
    assert result.threshold_speeds == pytest.approx([threshold], rel=1e-8)
    assert result.threshold_branches == (j,)
    assert result.threshold_frequencies == pytest.approx([w], rel=1e-6)
    assert result.threshold_notes == ("unstable above",)
    np.testing.assert_array_equal(result.stable, result.speeds < threshold)
    assert f"unstable above {threshold:.6g} rad/s (mode {j + 1})" in result.status
    assert np.all((result.damping_ratios[:, j] < 0.0) == (result.speeds > threshold))


def test_thresholds_are_printed_with_mode_and_frequency() -> None:
    result = hm.campbell(internally_damped(), np.linspace(0.0, 900.0, 12), count=2)
    (table,) = [table for table in result.tables() if table.title == "thresholds of stability"]
    expected = zip(result.threshold_speeds, result.threshold_branches, result.threshold_frequencies, result.threshold_notes, strict=True)
    assert table.rows == tuple((speed, branch + 1, frequency, note) for speed, branch, frequency, note in expected)
    assert len(table.rows) > 0


def test_an_undamped_line_has_no_thresholds_although_rounding_makes_tiny_ratios_of_both_signs() -> None:
    result = hm.campbell(two_discs(kx=1e6), SPEEDS, count=8)
    assert len(result.threshold_speeds) == 0
    assert result.stable.all()
    assert result.status == "complete"


def test_a_line_that_is_unstable_at_all_speeds_says_so() -> None:
    result = hm.campbell(jeffcott(2.0 * C * 150.0), [0.0, 100.0, 200.0], count=3)
    assert not result.stable.any()
    assert result.status == "complete; unstable at all speeds"
    assert "unstable" in result.critical_notes[[w == "forward" for w in result.critical_whirl].index(True)]


# -- large lines ------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "support",
    [{"kx": 1e6}, {"kx": 1e6, "ky": 0.6e6, "damping": 3e3}, {"kx": 1e7, "damping": 1e5}],
    ids=["undamped", "unlike and damped", "nearly locked by dampers"],
)
def test_a_reduced_model_has_the_roots_of_the_whole_line(support: dict[str, float]) -> None:
    line = SpinningLine(two_discs(24, **support))
    block = max(line_blocks(line), key=lambda item: item.size)
    form = WhirlKinds(line).form()[np.ix_(block.index, block.index)]
    speeds = np.linspace(0.0, FULL_SPEED, 41).tolist()
    reduced, whole = reduced_model(block, form, speeds, 11), BlockModel(block, form)
    assert reduced.basis.shape[1] < 0.7 * block.size
    assert not reduced.is_whole
    for speed in speeds[::8]:
        few, all_ = reduced.solve(speed).lowest(11), whole.solve(speed).lowest(11)
        np.testing.assert_allclose(few.values, all_.values, rtol=1e-9)


def test_the_diagram_of_a_finely_divided_line_is_that_of_the_whole_eigenvalue_problem() -> None:
    scene = two_discs(24, kx=1e6, ky=0.8e6, damping=200.0)
    result = hm.campbell(scene, np.linspace(0.0, 1000.0, 11), count=9)
    for row in (0, 5, 10):
        exact = hm.whirl_modes(scene, float(result.speeds[row]), count=9)
        np.testing.assert_allclose(np.sort(result.natural[row]), np.sort(exact.natural), rtol=1e-9)


def test_a_line_of_many_elements_with_a_film_is_followed_too() -> None:
    # not linear in the speed: a table of coefficients with whirl terms
    table = {
        "speeds": (0.0, 500.0),
        "stiffness_xx": (1e6, 3e6),
        "stiffness_yy": (2e6, 3e6),
        "damping_xx": (1e3, 2e3),
        "damping_yy": (1e3, 2e3),
    }
    law = hm.TableBearing(**table, stiffness_xy=(0.0, 1e5), stiffness_yx=(0.0, -1e5))
    scene = two_discs(24, kx=1e6).replacing({"station_0.law": law, "station_3.law": law})
    result = hm.campbell(scene, np.linspace(0.0, 500.0, 6), count=6)
    for row in range(6):
        exact = hm.whirl_modes(scene, float(result.speeds[row]), count=6)
        np.testing.assert_allclose(np.sort(result.natural[row]), exact.natural, rtol=1e-9)


def test_the_tracker_never_loses_a_root_that_exists_at_both_ends() -> None:
    line = SpinningLine(two_discs(kx=1e6, ky=0.5e6, damping=100.0))
    block = max(line_blocks(line), key=lambda item: item.size)
    model = BlockModel(block, WhirlKinds(line).form()[np.ix_(block.index, block.index)])
    table = follow(ModeTracker(model.solve, 14, 10), [0.0, 500.0, 1000.0, 3000.0])
    for row in table:
        assert sorted(index for index in row if index >= 0) == list(range(14))
    # every branch among the ten lowest at rest is there at the end
    assert np.all(table[:, :8] >= 0)


# -- arguments and result ---------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("arguments", "kind", "message"),
    [
        ({"speeds": [0.0, 200.0, 100.0]}, ParameterError, "must increase, but 100 rad/s follows 200 rad/s"),
        ({"speeds": [1000.0, 0.0]}, ParameterError, "must increase, but 0 rad/s follows 1000 rad/s"),
        ({"speeds": [1.0, 1.0]}, ParameterError, "must increase"),
        ({"speeds": [1.0]}, ParameterError, "at least two"),
        ({"speeds": 5.0}, ParameterError, "at least two"),
        ({"speeds": [0.0, math.nan]}, ParameterError, "at least two"),
        ({"speeds": ["slow", "fast"]}, ParameterError, "at least two"),
        ({"orders": (0,)}, ParameterError, "each must be a number greater than 0"),
        ({"orders": (1, math.inf)}, ParameterError, "each must be a number greater than 0"),
        ({"orders": {"disk": (1,)}}, PlaceError, "No place 'disk'"),
        ({"orders": {"disc": ("one",)}}, ParameterError, "orders of 'disc'"),
        ({"count": 0}, ParameterError, "count = 0"),
    ],
)
def test_a_bad_argument_is_refused(arguments: dict[str, Any], kind: type[HdriveError], message: str) -> None:
    with pytest.raises(kind, match=message):
        hm.campbell(overhung_disc(), **({"speeds": [0.0, 100.0]} | arguments))


def test_a_speed_without_steady_rotation_is_named() -> None:
    film = hm.JournalBearing(diameter=0.05, length=0.02, radial_clearance=5e-5, viscosity=0.02, tilt_stiffness=1e4, tilt_damping=0.0)
    parts = {"rotor": hm.Rotor(mass=4.0, polar_inertia=0.02, transverse_inertia=0.015), "bearing": hm.Bearing(law=film), "g": hm.Gravity()}
    scene = hm.Scene(name="film", parts=parts, connections=[("rotor", "bearing")])
    with pytest.raises(AnalysisError, match="at 0 rad/s"):
        hm.campbell(scene, [0.0, 100.0])
    assert hm.campbell(scene, [100.0, 150.0, 200.0], count=2).frequencies.shape == (3, 2)


def test_without_order_lines_the_lowest_branches_are_drawn() -> None:
    result = hm.campbell(two_discs(kx=1e6), [0.0, 100.0], orders=())
    assert (len(result.order_slopes), len(result.critical_speeds)) == (0, 0)
    assert len(result.whirl) == 6


def test_a_result_is_the_same_after_saving_and_has_tables(tmp_path: Path) -> None:
    result = hm.campbell(overhung_disc(), SPEEDS, count=4)
    again = hm.load(result.save(tmp_path / "campbell.npz"))
    assert isinstance(again, hm.WhirlCampbell)
    np.testing.assert_array_equal(again.frequencies, result.frequencies)
    np.testing.assert_array_equal(again.whirl_at, result.whirl_at)
    assert again.critical_notes == result.critical_notes
    lines = result.to_csv(tmp_path / "campbell.csv").read_text().splitlines()
    assert lines[0].split(",")[:3] == ["speed [rad/s]", "mode 1 backward damped frequency [rad/s]", "mode 1 damping ratio [1]"]
    assert len(lines) == 1 + len(SPEEDS)


def test_the_second_root_of_a_crossing_is_not_taken_for_the_first() -> None:
    # independent: the forward critical by bisection of the closed form on its own branch
    root = brentq(lambda speed: signed(speed, 2) - speed, 50.0, 400.0, xtol=1e-12)
    result = hm.campbell(overhung_disc(), [0.0, 400.0], count=4)
    forward = [speed for speed, word in zip(result.critical_speeds, result.critical_whirl, strict=True) if word == "forward"]
    assert forward == pytest.approx([root], rel=1e-10)


def test_a_motor_whose_torque_rises_with_the_speed_is_named_as_what_grows() -> None:
    # J w' = a w runs away at the rate a/J; the train behind it swings as ever
    scene = hm.Scene(
        name="runaway",
        parts={
            "motor": hm.Motor(inertia=0.5, characteristic=lambda w: 0.3 * w),
            "shaft": hm.Shaft(stiffness=200.0, damping=0.5),
            "disc": hm.Inertia(inertia=1.5),
        },
        connections=[("motor", "shaft", "disc")],
    )
    result = hm.campbell(scene, [10.0, 20.0])
    assert not result.stable.any()
    assert "a motion grows without oscillating" in result.status
    assert hm.whirl_modes(scene, 10.0).decay_rates.min() == pytest.approx(-0.3 / 2.0, rel=1e-3)


def test_a_flat_backward_orbit_is_not_called_unexcited() -> None:
    # supports of unlike stiffness: a trial mass makes a peak at each backward critical speed too
    scene = two_discs(kx=1e6, ky=0.7e6, damping=100.0)
    result = hm.campbell(scene, np.linspace(0.0, 400.0, 21), count=6)
    backward = [k for k, word in enumerate(result.critical_whirl) if word == "backward"]
    assert len(backward) == 2
    assert [result.critical_notes[k] for k in backward] == ["", ""]
    disc_place = next(name for name, part in scene.parts.items() if isinstance(part, hm.Rotor))
    response = hm.unbalance_response(scene, np.linspace(20.0, 350.0, 34), rotors=False, extra={disc_place: (1e-3, 0.0)})
    peaks = np.array([peak.speed for peak in response.peaks if peak.place == disc_place])
    for k in backward:
        # a peak lies off the damped critical speed by about its damping ratio, at most 0.013 here
        assert np.min(np.abs(peaks / result.critical_speeds[k] - 1.0)) < 0.013
    alike = hm.campbell(two_discs(kx=1e6, damping=100.0), np.linspace(0.0, 400.0, 21), count=6)
    assert {note for word, note in zip(alike.critical_whirl, alike.critical_notes, strict=True) if word == "backward"} == {"backward"}


def test_an_axial_crossing_of_the_first_order_is_marked() -> None:
    # sqrt(4e4/4) = 100 rad/s along the axis, which unbalance does not drive; a second order may be anything
    law = hm.LinearBearing.isotropic(radial=9e4, damping=20.0, axial=4e4, tilt=1e4)
    rotor = hm.Rotor(mass=4.0, polar_inertia=0.02, transverse_inertia=0.015)
    scene = hm.Scene(name="axial", parts={"rotor": rotor, "bearing": hm.Bearing(law=law)}, connections=[("rotor", "bearing")])
    result = hm.campbell(scene, np.linspace(20.0, 300.0, 8), orders=(1, 2))
    found = {
        round(speed): note
        for speed, word, note in zip(result.critical_speeds, result.critical_whirl, result.critical_notes, strict=True)
        if word == "axial"
    }
    assert found == {50: "", 100: "axial"}


@pytest.mark.parametrize("first_ball", [0.0, 0.3, 0.6])
def test_balls_in_one_position_neither_hold_the_spin_nor_drive_it(first_ball: float) -> None:
    # their force changes with the spin angle: as a stiffness a torsional mode of 0.02 rad/s, and growth where two balls share the load
    law = hm.BallBearing(
        balls=7.0,
        contact_stiffness=5e9,
        ball_diameter=0.01,
        pitch_diameter=0.05,
        radial_clearance=2e-6,
        damping=200.0,
        axial_stiffness=1e6,
        axial_damping=10.0,
        tilt_stiffness=2e3,
        tilt_damping=1.0,
        first_ball=first_ball,
    )
    parts = {
        "motor": hm.Motor(inertia=0.02, characteristic=np.zeros_like),
        "shaft": hm.Shaft(stiffness=900.0, damping=0.01),
        "disc": hm.Rotor(mass=8.0, polar_inertia=0.04, transverse_inertia=0.0206),
        "bearing": hm.Bearing(law=law),
        "weight": hm.Gravity(),
    }
    scene = hm.Scene(name="balls", parts=parts, connections=[("motor", "shaft", "disc", "bearing")])
    diagram = hm.campbell(scene, np.linspace(200.0, 400.0, 3))
    assert diagram.stable.all()
    assert not len(diagram.threshold_speeds)
    modes = hm.whirl_modes(scene, 300.0)
    assert modes.status == "complete"
    assert modes.free_motions == 1, "the line turns freely"
    torsion = [f for f, word in zip(modes.natural, modes.whirl, strict=True) if word == "torsional"]
    assert torsion == pytest.approx([math.sqrt(900.0 * (1.0 / 0.02 + 1.0 / 0.04))], rel=1e-8)
    # across the axis the disc, loaded by its weight, sees the bearing with its balls in that position
    support = law.linearised(load=(0.0, -8.0 * 9.80665), speed=300.0)
    stiffness, damping = support.stiffness_matrix()[:2, :2], support.damping_matrix()[:2, :2]
    system = np.block([[np.zeros((2, 2)), np.eye(2)], [-stiffness / 8.0, -damping / 8.0]])
    exact = np.sort(np.abs(np.linalg.eigvals(system)))[::2]
    for frequency in exact:
        assert np.min(np.abs(modes.natural / frequency - 1.0)) < 1e-7

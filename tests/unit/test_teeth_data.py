"""Wheels, stages and gears: what is refused, and how it is said."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.errors import ParameterError
from models.double_harmonic_transmission import gear

GOOD: dict[str, Any] = {
    "flexible_teeth": 202,
    "rigid_teeth": 204,
    "module": hm.mm(0.3),
    "profile_angle": hm.degrees(30.0),
    "addendum": hm.mm(0.24),
    "clearance": hm.mm(0.06),
    "backlash": hm.mm(0.01),
    "fibre_radius": hm.mm(29.3),
    "deformation": hm.CosineDeformation(amplitude=hm.mm(0.30)),
}


def stage(**changes: Any) -> hm.Stage:
    return hm.Stage.standard(**{**GOOD, **changes})


def test_set_a_has_the_radii_of_the_notes() -> None:
    first, second = gear("A").stages()
    radii = [1e3 * r for w in (first.flexible, first.rigid, second.flexible, second.rigid) for r in (w.tip_radius, w.root_radius)]
    # r_a2 r_f2 r_a3 r_f3 r'_a2 r'_f2 r_a4 r_f4
    np.testing.assert_allclose(radii, [30.54, 30.00, 30.36, 30.90, 28.056, 28.56, 28.224, 27.72], rtol=0.0, atol=1e-9)


def test_the_outline_has_its_corners_on_the_circles_and_its_thickness_on_the_reference_circle() -> None:
    for wheel in (stage().flexible, stage().rigid):
        assert isinstance(wheel, hm.StraightToothWheel)
        flank = wheel.right_flank()
        np.testing.assert_allclose(np.hypot(*flank.T), [wheel.root_radius, wheel.tip_radius], rtol=1e-14)
        direction = flank[1] - flank[0]
        assert abs(direction[0] / direction[1]) == pytest.approx(np.tan(wheel.profile_angle), rel=1e-12)
        # the flank passes the reference circle at half the thickness
        on = np.array([np.sin(wheel.thickness / (2 * wheel.reference_radius)), np.cos(wheel.thickness / (2 * wheel.reference_radius))])
        off = wheel.reference_radius * on - flank[0]
        assert abs(direction[0] * off[1] - direction[1] * off[0]) / np.hypot(*direction) < 1e-15


def test_flanks_are_parallel_at_full_depth() -> None:
    for one in gear("A").stages():
        assert isinstance(one.flexible, hm.StraightToothWheel)
        assert isinstance(one.rigid, hm.StraightToothWheel)
        assert one.rigid.profile_angle - one.direction * np.pi / one.rigid.teeth == pytest.approx(one.flexible.profile_angle, rel=1e-12)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"clearance": hm.mm(-0.01)}, "clearance = -0.01 mm is negative"),
        ({"backlash": hm.mm(-0.01)}, "backlash = -0.01 mm is negative"),
        ({"addendum": 0.0}, "must be greater than 0 mm"),
        ({"rigid_teeth": 203}, "do not assemble"),
        (
            {"deformation": hm.CosineDeformation(amplitude=hm.mm(0.37))},
            r"w0 is too large for the tooth height: .* 0.37 mm .* limit is 0.36 mm",
        ),
        ({"deformation": hm.CosineDeformation(amplitude=hm.mm(0.1)), "addendum": hm.mm(0.09)}, "do not reach each other"),
        ({"profile_angle": hm.degrees(46.0)}, "crosses itself. It is .* mm thick at the tip"),
        ({"profile_angle": hm.degrees(38.0), "addendum": hm.mm(0.2), "clearance": hm.mm(0.2)}, "neighbouring teeth cross"),
        ({"fibre_radius": hm.mm(30.1)}, "lies in the teeth"),
        ({"addendum": 0.24}, "root_radius = .* m: must be greater than 0.0 m"),
        ({"flexible_teeth": 202.5}, "whole number"),
        ({"rigid_teeth": 202}, "both wheels have 202 teeth.* usually 204, or fewer inside it, usually 200"),
        ({"deformation": hm.mm(0.3)}, "deformation = 0.0003 is no deformation law; give one"),
    ],
    ids=lambda value: value if isinstance(value, str) else "-".join(value),
)
def test_a_stage_that_cannot_be_is_refused(changes: dict[str, Any], words: str) -> None:
    with pytest.raises(ParameterError, match=words):
        stage(**changes)


def test_an_outline_that_crosses_itself_is_refused() -> None:
    with pytest.raises(ParameterError, match="crosses itself"):
        hm.StraightToothWheel(
            teeth=202,
            tip_radius=hm.mm(30.54),
            root_radius=hm.mm(30.0),
            reference_radius=hm.mm(30.3),
            thickness=hm.mm(0.2),
            profile_angle=hm.degrees(30.0),
        )


def test_radii_that_leave_no_clearance_at_all_are_refused() -> None:
    flexible, rigid = stage().flexible, stage().rigid
    with pytest.raises(ParameterError, match="negative clearance"):
        stage().replacing(rigid=rigid.replacing(root_radius=hm.mm(30.5)), flexible=flexible)


def test_two_wheels_with_outward_teeth_are_refused() -> None:
    with pytest.raises(ParameterError, match="one must point outwards and one inwards"):
        stage().replacing(rigid=stage().flexible)


def test_a_tooth_of_own_points_is_refused_where_its_heights_do_not_fit() -> None:
    def wheel(heights: tuple[float, ...], widths: tuple[float, ...]) -> hm.OutlinedWheel:
        return hm.OutlinedWheel(teeth=202, tip_radius=hm.mm(30.54), root_radius=hm.mm(30.0), heights=heights, half_widths=widths)

    wheel((0.0, 0.3e-3, 0.54e-3), (0.4e-3, 0.2e-3, 0.1e-3))
    with pytest.raises(ParameterError, match="does not rise"):
        wheel((0.0, 0.54e-3, 0.3e-3), (0.4e-3, 0.1e-3, 0.2e-3))
    with pytest.raises(ParameterError, match=r"they must run from 0 to the height of the tooth, 0.54 mm"):
        wheel((0.0, 0.5e-3), (0.4e-3, 0.1e-3))
    with pytest.raises(ParameterError, match="greater than 0"):
        wheel((0.0, 0.54e-3), (0.4e-3, -0.1e-3))


def test_a_straight_tooth_given_by_points_has_the_same_clearances() -> None:
    straight = stage()
    flank = straight.flexible.right_flank()
    heights = np.hypot(*flank.T) - straight.flexible.root_radius
    heights[0] = 0.0
    own = hm.OutlinedWheel(
        teeth=202,
        tip_radius=straight.flexible.tip_radius,
        root_radius=straight.flexible.root_radius,
        heights=tuple(heights),
        half_widths=tuple(flank[:, 0]),
    )
    assert hm.clearances(straight.replacing(flexible=own)).minimum == pytest.approx(hm.clearances(straight).minimum, abs=1e-12)


def test_a_double_gear_that_cannot_be_is_refused() -> None:
    good = gear("C")
    with pytest.raises(ParameterError, match="outer teeth of the flexspline must point outwards"):
        good.replacing(flexspline_outer=good.flexspline_inner)
    with pytest.raises(ParameterError, match="lies in the teeth"):
        good.replacing(fibre_radius=hm.mm(28.7))
    with pytest.raises(ParameterError, match="output_wheel = 188 is no toothed wheel"):
        good.replacing(output_wheel=188)


def test_millimetres_given_as_metres_are_noticed() -> None:
    with pytest.raises(ParameterError, match="lengths are in m"):
        hm.StraightToothWheel(teeth=202, tip_radius=2.0, root_radius=1.0, reference_radius=1.5, thickness=0.01, profile_angle=0.5)


def test_an_ordinary_gear_is_a_stage_with_a_ratio() -> None:
    one = hm.HarmonicGear.standard(
        **{{"flexible_teeth": "flexspline_teeth", "rigid_teeth": "circular_spline_teeth"}.get(k, k): v for k, v in GOOD.items()}
    )
    assert one.ratio == pytest.approx(-101.0, rel=1e-12)
    assert one.ratio_of("wave_generator", "circular_spline", "flexspline") == pytest.approx(102.0, rel=1e-12)
    assert one.members == ("wave_generator", "flexspline", "circular_spline")
    assert not one.interferes
    assert one.lost_motion == pytest.approx(hm.clearances(stage()).lost_motion, rel=1e-12)

"""Ratios and senses from the numbers of teeth."""

from __future__ import annotations

import itertools
from fractions import Fraction

import pytest

from hdrive_mbs.errors import ParameterError, PlaceError
from hdrive_mbs.teeth.kinematics import check_assembly, ratio, speeds

ORDINARY = (("flexspline", 200, "circular_spline", 202),)
DOUBLE = (("flexspline", 202, "circular_spline", 204), ("flexspline", 202, "output_wheel", 200))


def test_the_ordinary_drive_has_the_textbook_ratios_whatever_is_held() -> None:
    z2, z3 = 200, 202

    def i(driver: str, driven: str, fixed: str) -> float:
        return ratio(speeds(ORDINARY, driver=driver, fixed=fixed), driven)

    assert i("wave_generator", "flexspline", "circular_spline") == pytest.approx(-z2 / (z3 - z2), rel=1e-12)  # -100, backwards
    assert i("wave_generator", "circular_spline", "flexspline") == pytest.approx(z3 / (z3 - z2), rel=1e-12)  # +101
    assert i("flexspline", "circular_spline", "wave_generator") == pytest.approx(z3 / z2, rel=1e-12)
    assert i("flexspline", "wave_generator", "circular_spline") == pytest.approx(-(z3 - z2) / z2, rel=1e-12)  # step up


@pytest.mark.parametrize(
    ("z2", "z3", "z2i", "z4"), [(202, 204, 202, 200), (200, 202, 190, 188), (180, 182, 170, 166), (160, 164, 150, 148)]
)
def test_the_double_drive_has_the_ratio_of_the_paper(z2: int, z3: int, z2i: int, z4: int) -> None:
    found = speeds(
        (("flexspline", z2, "circular_spline", z3), ("flexspline", z2i, "output_wheel", z4)),
        driver="wave_generator",
        fixed="circular_spline",
    )
    exact = Fraction(z2 * z4, z2 * z4 - z3 * z2i)
    assert ratio(found, "output_wheel") == pytest.approx(float(exact), rel=1e-10)


def test_the_sets_of_the_model_have_ratio_minus_50_and_minus_48_205() -> None:
    assert Fraction(202 * 200, 202 * 200 - 204 * 202) == -50
    assert float(Fraction(200 * 188, 200 * 188 - 202 * 190)) == pytest.approx(-48.205, abs=5e-4)


def test_in_every_arrangement_teeth_pass_each_mesh_in_equal_numbers() -> None:
    members = ("wave_generator", "flexspline", "circular_spline", "output_wheel")
    for driver, fixed in itertools.permutations(members, 2):
        found = speeds(DOUBLE, driver=driver, fixed=fixed)
        assert found[driver] == 1.0
        assert found[fixed] == 0.0
        for flexible, z_f, rigid, z_r in DOUBLE:
            passed = [z * (found[name] - found["wave_generator"]) for name, z in ((flexible, z_f), (rigid, z_r))]
            assert passed[0] == pytest.approx(passed[1], rel=1e-9, abs=1e-6)


@pytest.mark.parametrize(
    ("flexible", "rigid", "waves", "direction", "words"),
    [
        (202, 203, 2, 1, "differ by 1, which must be a multiple of the number of waves, 2. Take 204"),
        (202, 201, 2, -1, "differ by 1.*Take 200"),
        (200, 202, 3, 1, "multiple of the number of waves, 3. Take 203"),
        (202, 200, 2, 1, "it needs more, usually 204"),
        (200, 200, 2, 1, "it needs more"),
        (200, 202, 2, -1, "it needs fewer, usually 198"),
    ],
)
def test_numbers_of_teeth_that_do_not_assemble_are_refused(flexible: int, rigid: int, waves: int, direction: int, words: str) -> None:
    with pytest.raises(ParameterError, match=words):
        check_assembly("stage", flexible, rigid, waves, direction)


def test_unknown_and_impossible_members_are_refused() -> None:
    with pytest.raises(PlaceError, match=r"No driver 'generator'. This gear has: wave_generator"):
        speeds(ORDINARY, driver="generator", fixed="flexspline")
    with pytest.raises(ParameterError, match="cannot both drive and be held"):
        speeds(ORDINARY, driver="flexspline", fixed="flexspline")
    with pytest.raises(ParameterError, match="stands still"):
        ratio(speeds(ORDINARY, driver="wave_generator", fixed="flexspline"), "flexspline")
    with pytest.raises(PlaceError, match="driven member"):
        ratio(speeds(ORDINARY, driver="wave_generator", fixed="flexspline"), "output")

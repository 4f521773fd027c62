"""The design window: best point, bounds with reasons, words."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.errors import ParameterError, PlaceError
from hdrive_mbs.teeth.amplitude_window import amplitude_window
from hdrive_mbs.teeth.design import common_amplitude
from hdrive_mbs.teeth.design_points import REASONS, VARIABLES
from models.double_harmonic_transmission import gear

TASK = hm.DesignTask(
    flexible_teeth=202,
    rigid_teeth=204,
    module=hm.mm(0.3),
    fibre_radius=hm.mm(29.3),
    deformation=hm.CosineDeformation(amplitude=hm.mm(0.3)),
    backlash=hm.mm(0.01),
)
GOOD = {"profile_angle": hm.degrees(30.0), "height": hm.mm(0.54), "clearance": hm.mm(0.06), "amplitude": hm.mm(0.30)}


@pytest.fixture(scope="module")
def window() -> hm.DesignWindow:
    return TASK.window(per_variable=6)


def test_the_best_point_is_admissible_by_the_full_outlines_too(window: hm.DesignWindow) -> None:
    stage = TASK.stage(**window.best)
    assert not hm.clearances(stage).interferes
    # 1.5 degrees between the angles of the sweep, joined by straight lines: (1.5 deg)^2/8 of curvature 4 w0 over the slope
    assert hm.clearances(stage).teeth_in_engagement == pytest.approx(float(TASK.evaluate(**window.best).teeth_in_engagement[0]), abs=0.2)
    assert window.status == "complete"


def test_at_each_bound_the_design_works_and_just_beyond_it_does_not(window: hm.DesignWindow) -> None:
    for bound in window.bounds:
        low, high = window.box[bound.variable]
        step = 1e-3 * (high - low)
        for end, reason, beyond in ((bound.low, bound.reason_low, -step), (bound.high, bound.reason_high, step)):
            assert TASK.evaluate(**{**window.best, bound.variable: end}).admissible[0]
            if reason == "edge of the search":
                assert end in (low, high)
            else:
                outside = TASK.evaluate(**{**window.best, bound.variable: end + beyond})
                assert REASONS[outside.verdict[0]] == reason


def test_the_window_says_its_bounds_and_reasons_in_words(window: hm.DesignWindow) -> None:
    words = window.explain()
    assert words.startswith(f"{np.sum(window.points.admissible)} of {6**4} designs are admissible.")
    for bound in window.bounds:
        assert bound.variable in words
        assert bound.reason_low in words


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({}, "Admissible"),
        ({"profile_angle": hm.degrees(15.0)}, "tip interference on the way in and out"),
        ({"profile_angle": hm.degrees(42.0)}, "pointed"),
        ({"profile_angle": hm.degrees(38.0), "height": hm.mm(0.5), "clearance": hm.mm(0.2)}, "run into each other at the root"),
        ({"clearance": hm.mm(0.6)}, "addendum is not positive"),
        ({"amplitude": hm.mm(0.37)}, "w0 is too large for the tooth height"),
        ({"amplitude": hm.mm(0.12), "height": hm.mm(0.2)}, "do not reach each other"),
        ({"amplitude": hm.mm(0.22), "height": hm.mm(0.6)}, "tip interference on the starting axis"),
        ({"amplitude": hm.mm(0.33)}, "flank interference near full depth"),
        ({"height": hm.mm(2.0), "profile_angle": 0.0}, "neutral fibre"),
    ],
)
def test_a_refused_design_is_explained(changes: dict[str, float], words: str) -> None:
    assert words in TASK.explain(**{**GOOD, **changes})


def test_every_reason_is_met_by_some_design() -> None:
    rng = np.random.default_rng(3)
    limits = np.array([[0.0, 46.0], [0.1, 2.4], [0.01, 0.9], [0.3, 1.3]]).T
    points = TASK.evaluate(*(rng.uniform(*limits, (4000, 4)) * [np.pi / 180.0, 0.3e-3, 0.3e-3, 0.3e-3]).T)
    # the rim of this gear is deep enough for all heights of the box, so the fibre is never in the teeth
    assert set(np.unique(points.verdict)) == set(range(len(REASONS))) - {2}


def test_one_design_at_a_time_gives_what_many_at_once_give() -> None:
    rng = np.random.default_rng(5)
    values = rng.uniform([0.3, 0.4e-3, 0.03e-3, 0.26e-3], [0.7, 0.6e-3, 0.1e-3, 0.32e-3], (450, 4))  # more than one chunk
    many = TASK.evaluate(*values.T)
    for k in (0, 399, 400, 449):
        one = TASK.evaluate(*values[k])
        assert one.verdict[0] == many.verdict[k]
        assert one.flank_gap[0] == pytest.approx(many.flank_gap[k], abs=1e-15)


def test_a_law_without_symmetry_is_followed_over_the_whole_turn() -> None:
    skew = hm.FunctionDeformation(function=lambda s: 0.3e-3 * (np.cos(2.0 * s) + 0.02 * np.sin(3.0 * s)))
    points = TASK.replacing(deformation=skew).evaluate(**GOOD)
    stage = TASK.replacing(deformation=skew).stage(**GOOD)
    # half a step of the sweep, as in test_teeth_interference
    assert points.flank_gap[0] == pytest.approx(hm.clearances(stage).flank_clearance, abs=0.8e-6)


def test_a_task_is_read_from_a_stage_and_gives_it_back() -> None:
    for stage in gear("A").stages():
        task = hm.DesignTask.of(stage)
        assert isinstance(stage.flexible, hm.StraightToothWheel)
        again = task.stage(
            profile_angle=stage.flexible.profile_angle, height=stage.flexible.height, clearance=0.2 * task.module, amplitude=hm.mm(0.3)
        )
        for name in ("flexible", "rigid"):
            for field, value, metadata in getattr(again, name).fields():
                if "quantity" in metadata:
                    assert value == pytest.approx(getattr(getattr(stage, name), field), rel=1e-9), field


def test_a_search_without_an_answer_says_what_stops_it() -> None:
    window = TASK.replacing(backlash=0.0).window({"profile_angle": (0.1, 0.2)}, per_variable=4)
    assert not window.best
    assert window.status.startswith("No design of the grid is admissible")
    assert "tip interference on the way in and out of mesh" in window.explain()


@pytest.mark.parametrize(
    ("call", "kind", "words"),
    [
        (lambda: TASK.window({"angle": (0.1, 0.2)}), PlaceError, "No variable 'angle'. A design has: profile_angle"),
        (lambda: TASK.window({"height": (2e-3, 1e-3)}), ParameterError, "it must rise"),
        (lambda: TASK.evaluate(**{**GOOD, "clearance": -1e-5}), ParameterError, "clearance must be finite and not negative"),
        (
            lambda: TASK.evaluate(**{**GOOD, "profile_angle": 30.0}),
            ParameterError,
            r"profile_angle = 30 rad: must be at most 1.047 rad \(60 deg\)",
        ),
        (lambda: TASK.window(per_variable=1), ParameterError, "a grid needs at least 2"),
        (lambda: TASK.replacing(rigid_teeth=203), ParameterError, "do not assemble"),
        (lambda: TASK.replacing(backlash=-1e-6), ParameterError, "backlash"),
    ],
)
def test_bad_questions_are_refused(call: Any, kind: type[Exception], words: str) -> None:
    with pytest.raises(kind, match=words):
        call()


def test_the_amplitude_window_ends_where_interference_begins() -> None:
    stage = gear("A").stages()[0]
    found = amplitude_window(stage)
    assert found.low < hm.mm(0.3) < found.high
    for end, beyond in ((found.low, -3e-7), (found.high, 3e-7)):
        assert not hm.clearances(stage.replacing(deformation=stage.deformation.scaled(end)), 360).interferes
        outside = stage.replacing(deformation=stage.deformation.scaled(end + beyond))
        assert hm.clearances(outside, 360).interferes
    assert "tip interference" in found.reason_low
    assert "flank interference near full depth" in found.reason_high
    with pytest.raises(ParameterError, match=r"There is no window around w0 = 0.32 mm"):
        amplitude_window(stage.replacing(deformation=stage.deformation.scaled(hm.mm(0.32))))


def test_the_gear_s_window_is_the_narrower_one_of_its_stages() -> None:
    both = gear("A").amplitude_window()
    each = [amplitude_window(stage) for stage in gear("A").stages()]
    assert both.low == max(one.low for one in each)
    assert both.high == min(one.high for one in each)


def test_windows_have_a_common_w0_only_where_all_have_one(window: hm.DesignWindow) -> None:
    bound = next(one for one in window.bounds if one.variable == "amplitude")
    assert common_amplitude([window, window]) == (bound.low, bound.high)
    apart = dataclasses.replace(window, bounds=(dataclasses.replace(bound, low=bound.high + 1e-6, high=bound.high + 2e-6),))
    assert common_amplitude([window, apart]) is None
    assert common_amplitude([window, dataclasses.replace(window, bounds=())]) is None


def test_variables_have_units() -> None:
    assert [bound.variable for bound in TASK.window(per_variable=4).bounds] == list(VARIABLES)

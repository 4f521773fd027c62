"""Lines of a diagnosis at values with which a compiled run cannot follow them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.diagnosis.hypothesis import Added, Hypothesis
from hdrive_mbs.diagnosis.lines import Lines
from hdrive_mbs.diagnosis.measured import Measured
from hdrive_mbs.diagnosis.trial import Trial
from models import jeffcott

WEIGHT = 1e-5
"""kg m, of an unbalance at the disc."""


def lines(scene: hm.Scene) -> Lines:
    measured, still = {"probe": Measured(channel="disc.x", noise=1e-6)}, np.zeros(8)
    return Lines([Trial(name="run", scene=scene, every=1e-3, columns={"probe": still}, measured=measured, held_out=still > 0.0)])


def unbalanced() -> Hypothesis:
    return Hypothesis(factors=(), added=(Added(hm.RotorUnbalance(unbalance=WEIGHT, phase=0.0, lever=0.0), "disc", "it"),))


def test_a_point_that_makes_a_disc_uneven_is_left_out_and_the_others_are_not() -> None:
    # the moments of inertia about two diameters then differ by U^2/m; a compiled run takes 1e-4 of their sum
    disc = jeffcott.DISC
    largest = float(np.sqrt(1e-4 * 2.0 * disc.transverse_inertia * disc.mass))
    hypothesis = unbalanced()
    points = [factor * hypothesis.start() for factor in (1.0, 0.8 * largest / WEIGHT, 1.2 * largest / WEIGHT)]
    [starts] = lines(jeffcott.build(eccentricity=0.0)).at(hypothesis, points)
    assert [start is not None for start in starts] == [True, True, False]


def test_a_trial_that_is_skipped_has_no_line_even_where_the_others_start_as_it_rests() -> None:
    """Else it would be run: a simulator runs whatever has a line."""
    measured, still = {"probe": Measured(channel="disc.x", noise=1e-6)}, np.zeros(8)
    scene = jeffcott.build(eccentricity=0.0)
    run = Trial(name="run", scene=scene, every=1e-3, columns={"probe": still}, measured=measured, held_out=still > 0.0, settled=True)
    points = [unbalanced().start()]
    [[one], [other]] = Lines([run, replace(run, name="again")]).at(unbalanced(), points)
    assert one is not None
    [[skipped], [alone]] = Lines([run, replace(run, name="again")]).at(unbalanced(), points, frozenset({0}))
    assert skipped is None
    assert other is not None
    assert alone is not None
    assert alone.angles == other.angles == one.angles


def test_a_scene_that_no_compiled_run_can_follow_is_refused_and_not_left_out() -> None:
    scene = jeffcott.build().replacing({"disc.tilt": 0.05})
    with pytest.raises(hm.ParameterError, match="Rotor 'disc' is not round"):
        lines(scene).at(unbalanced(), [unbalanced().start()])

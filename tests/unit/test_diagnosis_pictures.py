"""The pictures that a real diagnosis is drawn with: loops, order maps and located forces show what was planted."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from hdrive_mbs.diagnosis.diagnose import diagnose
from hdrive_mbs.diagnosis.locate.latent_force import LatentForce
from hdrive_mbs.diagnosis.pictured import pictured
from hdrive_mbs.diagnosis.result import Diagnosis
from hdrive_mbs.effects.dahl_hysteresis import DahlHysteresis
from hdrive_mbs.effects.kinematic_error import KinematicError
from hdrive_mbs.plots import plot
from hdrive_mbs.plots.report_html import report_html
from tests.browser import DESKTOP, PHONE, layout, needs_browser
from tests.unit.diagnosis_cases import INPUTS, bench, quiet, records

ORDER = 2.0


def energy(loop: np.ndarray) -> float:
    """That a loop takes up, shape (2, n)."""
    return float(np.sum(0.5 * (loop[1, 1:] + loop[1, :-1]) * np.diff(loop[0])))


@cache
def hysteresis() -> Diagnosis:
    return diagnose(bench(), records((DahlHysteresis(torque_limit=4.0, yield_twist=3e-4), "gear")), candidates=DahlHysteresis)


@cache
def error() -> Diagnosis:
    return diagnose(bench(), records((KinematicError(amplitude=1e-4, order=ORDER, phase=0.8), "gear")), candidates=KinematicError)


@cache
def pages() -> tuple[str, str]:
    """Of a loop where a connection is to blame, of orders where the shaft runs through speeds."""
    return report_html(hysteresis()), report_html(error())


def test_the_loop_of_the_gear_is_shown_for_every_record() -> None:
    found = hysteresis()
    assert {loop.record for loop in found.loops} == set(INPUTS)
    for loop in found.loops:
        assert loop.at == "gear"
        assert loop.refit.shape == loop.effect.shape == loop.measured.shape
        # the unknown torque, over the twist of the refitted model, closes more than half of what that model misses
        assert abs(energy(loop.measured) - energy(loop.effect)) < 0.5 * abs(energy(loop.refit) - energy(loop.effect))


def test_an_order_stands_in_the_map_before_and_not_after() -> None:
    found = error()
    assert {item.record for item in found.order_maps} <= set(INPUTS)
    first = found.order_maps[0]
    assert first.reference == "motor"
    near = np.abs(first.orders - ORDER) < 0.2
    peak = first.before[:, near].max()
    assert peak == first.before[:, first.orders > 1.0].max()
    assert first.after[:, near].max() < 0.1 * peak


@pytest.mark.slow
def test_the_page_holds_these_pictures_with_words_for_those_who_do_not_see_them() -> None:
    alts = [re.findall(r'<img[^>]* alt="([^"]*)"', page) for page in pages()]
    assert sum(text.startswith("Loop of torque against twist of gear during record") for text in alts[0]) == len(INPUTS)
    maps = [text for text in alts[1] if text.startswith("Map of amplitudes of the residual")]
    assert len(maps) == len(error().order_maps) > 0
    for found in (hysteresis(), error()):
        assert plot(found) is not None


@needs_browser
@pytest.mark.parametrize("width", [PHONE, DESKTOP])
def test_the_page_fits_a_phone_and_a_desktop(width: int, tmp_path: Path) -> None:
    for name, page in zip(("loop", "map"), pages(), strict=True):
        (tmp_path / name).mkdir()
        layout(page, width, tmp_path / name).check()


def test_without_a_claim_there_is_no_loop_after() -> None:
    found = diagnose(bench(), quiet(), candidates=DahlHysteresis)
    assert found.verdict == "none"
    assert all(loop.effect.size == 0 for loop in found.loops)
    assert all(np.isnan(item.after).all() for item in found.order_maps)


@pytest.mark.parametrize("way", ["x", "y"])
def test_a_located_force_keeps_its_way(way: str) -> None:
    times = np.arange(5.0)
    force = LatentForce(
        at="rotor", way=way, record="r", unit="N", times=times, force=times, angle=times, speed=times, torque=times * np.nan
    )
    assert pictured(force).way == way

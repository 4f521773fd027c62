"""Orders of the spin in the force that is missing at a place, and the laws that are tried there."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.diagnosis.at_the_place import those_at
from hdrive_mbs.diagnosis.candidates import Candidate, candidates
from hdrive_mbs.diagnosis.force_orders import ForceOrders
from hdrive_mbs.diagnosis.locate.latent_force import TurnedForce
from models import rotor_bench

ORDER = 4.8586
TURNS = 2000.0
WIDTH = 2.0 * np.pi / TURNS


class Residuals:
    """Stands for what a model leaves: one period whatever is asked."""

    def standing_out(self, over: str, low: float, high: float) -> tuple[float, ...]:
        return (0.5 * (low + high),)

    def width(self, over: str) -> float:
        return WIDTH


def force_of(effect: hm.BallPass, *, noise: float = 0.0, samples: int = 40000) -> TurnedForce:
    """Of a run-up at a constant acceleration to 1000 rad/s, with what a wrong unbalance leaves."""
    angle = TURNS * np.linspace(0.0, 1.0, samples) ** 2
    speed = 1000.0 * np.sqrt(angle / TURNS)
    x, y = effect.force(0.0, angle, speed, 0.0, 0.0, 0.0, 0.0)
    white = np.random.default_rng(4).standard_normal((2, samples))
    return TurnedForce(angle, x + 1j * y + 3.0 * np.exp(1j * angle) + noise * (white[0] + 1j * white[1]))


@pytest.mark.parametrize(
    "effect",
    [
        hm.BallPass(amplitude=1.0, order=ORDER, sharpness=0.4),
        hm.InnerRacePass(amplitude=1.0, order=ORDER, sharpness=0.4, direction=0.7),
        hm.InnerRacePulses(amplitude=1.0, mean=1.25, order=ORDER, sharpness=0.4, direction=2.0, growth=1.0),
    ],
    ids=lambda effect: type(effect).__name__,
)
def test_the_order_of_a_flaw_is_among_the_first_three(effect: hm.BallPass) -> None:
    """Within a quarter of what the record can tell apart; lines one order apart make neighbours as likely."""
    found = ForceOrders([force_of(effect, noise=0.5)], Residuals()).standing_out("turn", 2.0, 7.0)
    assert min(abs(order - ORDER) for order in found[:3]) < 0.25 * WIDTH
    assert all(2.0 <= order <= 7.0 for order in found)


def test_whole_orders_are_no_flaw() -> None:
    angle = TURNS * np.linspace(0.0, 1.0, 40000) ** 2
    force = sum((np.exp(1j * n * angle) / abs(n) for n in (1, 2, -2, 3)), 0.2 * np.exp(-1j * ORDER * angle))
    found = ForceOrders([TurnedForce(angle, force)], Residuals()).standing_out("turn", 2.0, 7.0)
    beside = found[0] - ORDER  # one order more or less has as many of its lines
    assert abs(beside - round(beside)) < WIDTH
    assert all(abs(order - round(order)) > WIDTH for order in found[:3])


def test_where_nothing_turns_and_for_frequencies_the_residuals_are_asked() -> None:
    still = TurnedForce(np.linspace(0.0, 1.0, 1000), np.ones(1000, complex))
    orders = ForceOrders([still], Residuals())
    assert orders.standing_out("turn", 2.0, 7.0) == (4.5,)
    assert ForceOrders([force_of(hm.BallPass(amplitude=1.0, order=ORDER))], Residuals()).standing_out("time", 10.0, 20.0) == (15.0,)
    assert orders.width("turn") == WIDTH


@cache
def all_of_the_rotor_bench() -> list[Candidate]:
    return candidates(rotor_bench.bench().scene)


@pytest.mark.parametrize(
    ("place", "there", "elsewhere"),
    [
        ("bearing_2.law", {("InnerRacePass", "bearing_2"), ("BearingClearance", "bearing_2")}, {("Looseness", "bearing_2")}),
        ("bearing_1.housing", {("Looseness", "bearing_1")}, {("BallPass", "bearing_1"), ("Looseness", "bearing_2")}),
        ("section_1", {("MomentCrack", "section_1"), ("ShaftKink", "section_1")}, {("MomentCrack", "section_2")}),
        ("rotor_2", {("Rub", "rotor_2"), ("RotorUnbalance", "rotor_2")}, {("Rub", "rotor_1")}),
        ("drive", {("Cogging", "drive")}, {("BallPass", "bearing_1")}),
    ],
)
def test_laws_of_a_place_are_those_that_act_there(place: str, there: set[tuple[str, str]], elsewhere: set[tuple[str, str]]) -> None:
    found = {(item.kind.__name__, item.at) for item in those_at(place, all_of_the_rotor_bench())}
    assert there <= found
    assert not elsewhere & found

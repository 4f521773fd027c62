"""The jump law: exact up to its first contacts, then by what does not depend on the integrator.

Where the load lies between 0 and M_A no torque of the law balances it: both sides push the twist
back to the edge of the gap.  With damping the bounces die out without end (a sliding mode), and how
often a solver crosses the edge says something of its tolerance, nothing of the train.  So the
histories are compared over the first contacts, the frequency and the force of contacts with a
closed form without damping, and the sliding mode by its mean torque and by the motion of the load.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

import hdrive_mbs as hm
from tests.verification import reference_laws as laws
from tests.verification.reference_train import BODIES, ReferenceTrain, integrate
from tests.verification.scenes import LOST_MOTION, SENSE, train
from tests.verification.test_time_histories import HALF_GAP, LIMIT, NAME_PLATE, differences, fitted

READINGS: dict[str, tuple[type, tuple[int, int]]] = {
    "torque b phi + d phi^3": (hm.JumpTorqueStiffness, (1, 3)),
    "stiffness (b phi + d phi^3) phi": (hm.JumpSecantStiffness, (2, 4)),
}
LOAD = 4.0
"""Constant load below M_A [N m]."""
CONTACTS = 12
"""Passages over the edge, in and out, that are compared one by one."""
SPEED, TWIST = 156.0, 1.25e-3
"""Start near the no-load speed with the twist just inside the gap, so that the first contact comes soon."""


def polynomial(powers: tuple[int, int]) -> Callable[[float], float]:
    """Torque outside the gap: least squares of the catalogue curve from the edge to 137 N m."""
    first, second = fitted(powers, HALF_GAP)
    return lambda x: float(first * x ** powers[0] + second * x ** powers[1])


def reference(law: laws.Pieces) -> tuple[ReferenceTrain, list[float]]:
    model = ReferenceTrain(flexspline=law, motor=laws.kloss(**NAME_PLATE), load=laws.in_time(lambda t: LOAD), gap=LOST_MOTION)
    start = model.start(SPEED)
    start[2] -= TWIST
    start[3] -= TWIST
    return model, start


def simulated(kind: type, powers: tuple[int, int], duration: float, solver: hm.Solver) -> hm.Response:
    linear, cubic = fitted(powers, HALF_GAP)
    scene = train(stiffness=kind(lost_motion=LOST_MOTION, linear=linear, cubic=cubic), load=hm.ConstantTorque(value=LOAD))
    # forward -TWIST is true +TWIST: the output turns backwards
    start = {"gear.flexspline.angle": TWIST, "load.angle": TWIST}
    return hm.simulate(scene, duration, solver=solver, initial_speed=SPEED, initial=start)


def contacts(response: hm.Response) -> np.ndarray:
    """Times at which the twist passes an edge of the gap, by linear interpolation between samples."""
    outside = np.abs(response.values["gear.twist"]) - HALF_GAP
    k = np.nonzero((outside[1:] > 0.0) != (outside[:-1] > 0.0))[0]
    t = response.times
    return t[k] - outside[k] * (t[k + 1] - t[k]) / (outside[k + 1] - outside[k])


@pytest.mark.parametrize("reading", READINGS)
def test_first_contacts_follow_the_reference(reading: str) -> None:
    kind, powers = READINGS[reading]
    law = laws.odd((HALF_GAP,), (laws.polynomial(0.0), polynomial(powers)))
    assert law(HALF_GAP * (1.0 + 1e-12)) > LOAD  # below M_A: the jump law has no torque that balances the load
    model, start = reference(law)
    passages = [t for t, *_ in integrate(model, np.linspace(0.0, 0.02, 3), start=start, most_passages=CONTACTS).passages]
    assert len(passages) == CONTACTS
    # a passage at the wrong time hands its error to the next one: ten times tighter than for the smooth laws
    solver = hm.DormandPrince(relative_tolerance=1e-12, absolute_tolerance=1e-14)
    response = simulated(kind, powers, passages[-1] + 1e-6, solver)
    # the edge is passed with more than 0.005 rad/s, so 1e-12 rad of error in the twist are 2e-10 s
    np.testing.assert_allclose(contacts(response)[:CONTACTS], passages, rtol=0.0, atol=2e-10)
    followed = integrate(model, response.times, start=start, most_passages=CONTACTS)
    assert np.min(np.abs(np.interp(passages, response.times, response.values["gear.twist_rate"]))) > 0.005
    worst = differences(response, followed, jumps=True)
    assert max(worst.values()) < LIMIT, worst


def test_undamped_bounces_have_the_period_depth_and_force_of_the_closed_form() -> None:
    # one inertia J against a wave generator that stands still; the torque is 0 inside and M_A outside, the load T0 < M_A
    inertia, load, torque, speed = 0.02, 4.0, 6.655, 0.05
    scene = hm.Scene(
        name="bounce",
        parts={
            "motor": hm.Motor(inertia=1e-3, characteristic=hm.IdealSpeedMotor(motion=hm.ConstantSpeed(value=0.0))),
            "gear": hm.HarmonicDrive(
                ratio=100.0, stiffness=hm.JumpTorqueStiffness(lost_motion=LOST_MOTION, constant=torque, linear=0.0, cubic=0.0)
            ),
            "load": hm.Load(inertia=inertia, torque=hm.ConstantTorque(value=load)),
        },
        connections=[("motor", "gear", "load")],
    )
    # parabolas: out and back in 2 v J/(M_A - T0), in and back in 2 v J/T0; each returns with the speed v it left with
    outside, inside = 2.0 * speed * inertia / (torque - load), 2.0 * speed * inertia / load
    period, cycles = outside + inside, 20
    duration = cycles * period
    # the twist starts at the edge and grows: the output lags behind
    start = {"load.angle": HALF_GAP, "load.speed": speed}
    solver = hm.DormandPrince(relative_tolerance=1e-10, absolute_tolerance=1e-12)
    response = hm.simulate(scene, duration, solver=solver, initial=start)
    found = contacts(response)
    expected = np.concatenate([[n * period + outside, (n + 1) * period] for n in range(cycles)])[:-1]
    found = found[found > 1e-6]  # the start is on the edge
    # an error dx of the step that passes the edge changes the energy by M_A dx and so v by M_A dx/(J v); over n
    # passages the errors of the period, in proportion to v, add up
    dx = 1e-12 + 1e-10 * HALF_GAP
    slack = 2.0 * cycles * (torque * dx / (inertia * speed**2)) * period * cycles
    assert slack < 1e-3 * period
    np.testing.assert_allclose(found[: len(expected)], expected, rtol=0.0, atol=slack)
    twist = response.values["gear.twist"]
    assert np.max(twist) == pytest.approx(HALF_GAP + 0.5 * speed**2 * inertia / (torque - load), rel=1e-5)
    assert np.min(twist) == pytest.approx(HALF_GAP - 0.5 * speed**2 * inertia / load, rel=1e-5)
    values = response.values["gear.torque"]
    assert set(np.unique(np.round(values, 12))) == {0.0, torque}  # pulses between 0 and M_A
    # the mean torque over whole cycles is the load, so the share of contact is T0/M_A
    hit = np.diff(np.concatenate([[0.0], expected, [duration]]))[::2].sum() / duration
    assert hit == pytest.approx(load / torque, rel=1e-12)
    assert response["gear.torque"].summary()["mean"] == pytest.approx(load, rel=1e-4)


def test_sliding_at_the_edge_has_the_mean_torque_and_motion_of_a_narrow_ramp() -> None:
    powers, duration, settled, width = (1, 3), 0.03, 0.018, 2e-7
    outer = polynomial(powers)
    top = outer(HALF_GAP + 0.5 * width)
    ramp = laws.line(HALF_GAP - 0.5 * width, 0.0, top / width)
    law = laws.odd((HALF_GAP - 0.5 * width, HALF_GAP + 0.5 * width), (laws.polynomial(0.0), ramp, outer))
    model, start = reference(law)
    times = np.linspace(0.0, duration, 6001)
    expected = integrate(model, times, start=start)
    response = simulated(hm.JumpTorqueStiffness, powers, duration, hm.DormandPrince(relative_tolerance=1e-5, absolute_tolerance=1e-7))
    late = times >= settled
    mean = np.trapezoid(expected.torque[late], times[late]) / (duration - settled)
    # a run at this tolerance chatters about 1e-7 rad around the edge, where the damping is 20 N m per rad/s: 1 % of M_A
    assert response["gear.torque"].between(settled, duration).summary()["mean"] == pytest.approx(mean, abs=0.01 * top)
    for name in BODIES:
        # twists differ by the width of the ramp, so angles by as much; the load keeps its momentum
        final = SENSE[name] * response.values[f"{name}.angle"][-1]
        ratio = 100.0 if name in ("motor", "gear.wave_generator") else 1.0
        assert final == pytest.approx(expected.angles[name][-1], abs=3.0 * width * ratio)
    assert -response.values["load.speed"][-1] == pytest.approx(expected.speeds["load"][-1], rel=1e-4)


def test_number_of_contacts_while_sliding_is_set_by_the_tolerance() -> None:
    counts = []
    for tolerance in (1e-4, 1e-5):
        solver = hm.DormandPrince(relative_tolerance=tolerance, absolute_tolerance=1e-2 * tolerance)
        counts.append(len(contacts(simulated(hm.JumpTorqueStiffness, (1, 3), 0.03, solver))))
    # the layer in which a solver of tolerance eps bounces is as thin as eps, so it is crossed 1/eps times
    assert 0.6 < math.log10(counts[1] / counts[0]) < 1.4, counts

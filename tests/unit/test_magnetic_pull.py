"""The pull of magnets on a rotor, against closed forms, Hill's equation and the stress around the air gap."""

from __future__ import annotations

import cmath
import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import hdrive_mbs as hm
from hdrive_mbs.analysis.whirl.line_matrices import LineMatrices
from hdrive_mbs.analysis.whirl.rotor_point import rotor_point
from tests.unit.rotor_scenes import MASS, STIFFNESS, damped_disc, z_of

STEP = hm.RungeKutta4(step=1e-4)


def test_a_magnet_pulls_the_disc_over_and_lowers_its_frequency() -> None:
    pull, centre = 0.2 * STIFFNESS, complex(3e-5, -2e-5)
    scene = damped_disc(25.0).with_effect(hm.MagneticPull(stiffness=pull, centre_x=centre.real, centre_y=centre.imag), at="disc")
    left = STIFFNESS - pull
    response = hm.simulate(scene, 2.0, solver=STEP)
    # K z = k (z - c); what the start shook has faded by exp(-12.5/2 2.0) = 4e-6
    assert abs(z_of(response, "disc")[-1] + pull * centre / left) < 1e-5 * abs(pull * centre / left)
    swing = z_of(response, "disc")[:2000] + pull * centre / left
    rate = 25.0 / (2.0 * MASS)
    ringing = math.sqrt(left / MASS - rate**2)
    times = response.times[:2000]
    # from rest at zero: z - z_s = -z_s exp(-r t) (cos w t + r/w sin w t)
    wanted = pull * centre / left * np.exp(-rate * times) * (np.cos(ringing * times) + rate / ringing * np.sin(ringing * times))
    np.testing.assert_allclose(swing, wanted, rtol=0.0, atol=1e-6 * abs(pull * centre / left))


TWO_POLES = hm.MagneticPull(stiffness=6e4, centre_x=4e-5, centre_y=1e-5, throb=3e4, frequency=200.0 * math.pi, phase=0.7)
ONE_PHASE = hm.PulsatingPull(stiffness=6e4, centre_x=4e-5, centre_y=1e-5, pulsation=5e4, frequency=200.0 * math.pi, phase=0.7)


@pytest.mark.parametrize("law", [TWO_POLES, ONE_PHASE], ids=["turns", "pulsates"])
def test_a_magnet_that_throbs_follows_its_equation_of_hill(law: hm.PullEffect) -> None:
    response = hm.simulate(damped_disc(25.0).with_effect(law, at="disc", name="it"), 0.3, solver=hm.RungeKutta4(step=5e-5))

    def motion(t: float, q: np.ndarray) -> np.ndarray:
        z, rate = q[0] + 1j * q[1], q[2] + 1j * q[3]
        off = z - complex(4e-5, 1e-5)
        turn = 200.0 * math.pi * t + 0.7
        part = 3e4 * cmath.exp(1j * turn) * off.conjugate() if law is TWO_POLES else 5e4 * math.cos(turn) * off
        push = 6e4 * off + part
        gained = (push - STIFFNESS * z - 25.0 * rate) / MASS
        return np.array([rate.real, rate.imag, gained.real, gained.imag])

    wanted = solve_ivp(motion, (0.0, 0.3), np.zeros(4), t_eval=response.times, rtol=1e-10, atol=1e-14).y
    size = np.max(np.abs(wanted[:2]))
    np.testing.assert_allclose(response["disc.x"].values, wanted[0], rtol=0.0, atol=1e-6 * size)
    np.testing.assert_allclose(response["disc.y"].values, wanted[1], rtol=0.0, atol=1e-6 * size)


def test_the_pull_of_a_field_of_two_poles_is_that_of_the_stress_around_the_gap() -> None:
    # pressure B^2/(2 mu_0) of the field in a gap that is a thousandth narrower on one side, summed around; R l = 1 m^2
    field, gap, permeability, time = 0.7, 1e-3, 4e-7 * math.pi, 3.1e-3
    off = 1e-3 * gap * cmath.exp(0.6j)
    around = np.linspace(0.0, 2.0 * math.pi, 3600, endpoint=False)
    stiffness = math.pi * field**2 / (2.0 * permeability * gap)
    for pairs, throb in ((1, 0.5 * stiffness), (2, 0.0), (3, 0.0)):
        local = field * np.cos(pairs * around - 100.0 * math.pi * time) / (1.0 - np.real(off * np.exp(-1j * around)) / gap)
        wanted = complex(np.mean(local**2 / (2.0 * permeability) * np.exp(1j * around))) * 2.0 * math.pi
        law = hm.MagneticPull(stiffness=stiffness, throb=throb)
        mean = law.force(time, 0.0, 0.0, off.real, off.imag, 0.0, 0.0)
        turning = law.throbbing(time, off.real, off.imag)
        found = complex(mean[0] + turning[0], mean[1] + turning[1])
        assert abs(found - wanted) < 1e-5 * abs(wanted)  # next is the third power of a thousandth, some millionths of the first


def test_the_pull_of_a_field_that_turns_backwards_too_is_that_of_the_stress_around_the_gap() -> None:
    # as above, with a field of 0.7 T forwards and one of 0.4 T backwards; with two poles more turns than the law holds
    fields, gap, permeability, time, lead = (0.7, 0.4), 1e-3, 4e-7 * math.pi, 3.1e-3, 0.8
    off = 1e-3 * gap * cmath.exp(0.6j)
    around = np.linspace(0.0, 2.0 * math.pi, 3600, endpoint=False)
    scale = math.pi / (2.0 * permeability * gap)
    law = hm.PulsatingPull(
        stiffness=scale * (fields[0] ** 2 + fields[1] ** 2),
        pulsation=2.0 * scale * fields[0] * fields[1],
        frequency=200.0 * math.pi,
        phase=lead,
    )
    mean = law.force(time, 0.0, 0.0, off.real, off.imag, 0.0, 0.0)
    part = law.throbbing(time, off.real, off.imag)
    found = complex(mean[0] + part[0], mean[1] + part[1])
    for pairs, near in ((1, False), (2, True), (3, True)):
        turn = 100.0 * math.pi * time
        field = fields[0] * np.cos(pairs * around - turn) + fields[1] * np.cos(pairs * around + turn + lead)
        local = field / (1.0 - np.real(off * np.exp(-1j * around)) / gap)
        wanted = complex(np.mean(local**2 / (2.0 * permeability) * np.exp(1j * around))) * 2.0 * math.pi
        assert (abs(found - wanted) < 1e-5 * abs(wanted)) is near


@pytest.mark.parametrize("law", [TWO_POLES, ONE_PHASE], ids=["turns", "pulsates"])
def test_whirl_knows_the_steady_pull_alone(law: hm.PullEffect) -> None:
    scene, names = damped_disc(25.0), ("disc.x", "disc.y")
    stiffness = []
    for item in (scene, scene.with_effect(law, at="disc"), scene.with_effect(law.replacing(phase=2.0), at="disc")):
        point = rotor_point(item, 400.0)
        system = LineMatrices(item.network()).at(point.angles, point.speeds)
        at = [system.names.index(name) for name in names]
        stiffness.append(system.stiffness[np.ix_(at, at)])
    np.testing.assert_allclose(stiffness[1], stiffness[0] - 6e4 * np.eye(2), rtol=0.0, atol=1e-12 * STIFFNESS)
    np.testing.assert_array_equal(stiffness[1], stiffness[2])

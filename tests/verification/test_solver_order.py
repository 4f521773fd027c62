"""Observed order of each solver and honesty of its error estimate, on a smooth problem.

A train with a cubic flexspline and a Kloss motor whose fastest motion (about 3e3 rad/s) is well
inside the asymptotic range of the steps used.
"""

from __future__ import annotations

import math
from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

import hdrive_mbs as hm
from tests.verification import reference_laws as laws
from tests.verification.reference_train import BODIES, Reference, ReferenceTrain, integrate
from tests.verification.scenes import SENSE, kloss_motor

LINEAR, CUBIC = 1.2e4, 2.5e9
DURATION = 0.04
SPEED = 120.0
RATES = {"input_shaft": (900.0, 0.02), "output_shaft": (2.1e4, 3.0)}
"""Stiffness [N m/rad] and damping [N m s/rad]."""


def scene() -> hm.Scene:
    (k_in, b_in), (k_out, b_out) = RATES["input_shaft"], RATES["output_shaft"]
    return hm.Scene(
        name="smooth train",
        parts={
            "motor": hm.Motor(inertia=1.5e-3, characteristic=kloss_motor()),
            "input_shaft": hm.Shaft(stiffness=k_in, damping=b_in, inertia=1e-5),
            "gear": hm.HarmonicDrive(
                ratio=100.0, stiffness=hm.CubicStiffness(linear=LINEAR, cubic=CUBIC), damping=2.0,
                wave_generator_inertia=1.69e-4, flexspline_inertia=4e-3,
            ),
            "output_shaft": hm.Shaft(stiffness=k_out, damping=b_out, inertia=2.465e-5),
            "load": hm.Load(inertia=0.5, torque=hm.SineTorque(mean=20.0, amplitude=30.0, frequency=20.0)),
        },
        connections=[("motor", "input_shaft", "gear", "output_shaft", "load")],
    )  # fmt: skip


def reference_model() -> ReferenceTrain:
    (k_in, b_in), (k_out, b_out) = RATES["input_shaft"], RATES["output_shaft"]
    return ReferenceTrain(
        flexspline=laws.cubic_stiffness(LINEAR, CUBIC),
        motor=laws.kloss(power=550.0, speed=1410.0 * math.pi / 30.0, pole_pairs=2, frequency=50.0, breakdown=2.4),
        load=laws.sine(20.0, 30.0, 20.0),
        J_FS=4e-3, K_wwe=k_in, B_wwe=b_in, K_wwy=k_out, B_wwy=b_out, B_FS=2.0,
    )  # fmt: skip


@cache
def reference() -> tuple[np.ndarray, Reference]:
    """At 501 even times: multiples of every fixed step used here."""
    times = np.linspace(0.0, DURATION, 501)
    model = reference_model()
    return times, integrate(model, times, start=model.start(SPEED), relative=1e-13)


@cache
def simulated(solver: hm.Solver) -> hm.Response:
    return hm.simulate(scene(), DURATION, solver=solver, initial_speed=SPEED)


def sampled(response: hm.Response) -> dict[str, np.ndarray]:
    """Angles and speeds of all bodies, forward, at the times of the reference."""
    times, _ = reference()
    k = np.clip(np.searchsorted(response.times, times - 1e-9), 0, len(response.times) - 1)
    np.testing.assert_allclose(response.times[k], times, rtol=0.0, atol=1e-9)
    return {
        f"{name}.{quantity}": SENSE[name] * response.values[f"{name}.{quantity}"][k] for name in BODIES for quantity in ("angle", "speed")
    }


def scaled(differences: dict[str, np.ndarray]) -> dict[str, float]:
    """Largest absolute value of each channel in units of the channel's largest value."""
    _, exact = reference()
    size = {f"{name}.angle": np.max(np.abs(exact.angles[name])) for name in BODIES}
    size |= {f"{name}.speed": np.max(np.abs(exact.speeds[name])) for name in BODIES}
    return {name: float(np.max(np.abs(values)) / size[name]) for name, values in differences.items()}


def true_errors(response: hm.Response) -> dict[str, float]:
    """Error of each channel against the reference."""
    _, exact = reference()
    theirs = {f"{n}.angle": exact.angles[n] for n in BODIES} | {f"{n}.speed": exact.speeds[n] for n in BODIES}
    return scaled({name: values - theirs[name] for name, values in sampled(response).items()})


def richardson(solver: hm.Solver, field: str, step: float) -> float:
    """log2 of |y_h - y_h/2| over |y_h/2 - y_h/4|, largest over channels and times."""
    coarse, middle, fine = (sampled(simulated(solver.replacing(**{field: step / 2**k}))) for k in range(3))
    first = max(scaled({name: coarse[name] - middle[name] for name in coarse}).values())
    second = max(scaled({name: middle[name] - fine[name] for name in coarse}).values())
    return math.log2(first / second)


FIXED: dict[str, tuple[Any, float, int]] = {
    "RungeKutta4": (hm.RungeKutta4(step=1.0), 4e-5, 4),
    "Trapezoidal": (hm.Trapezoidal(step=1.0), 2e-5, 2),
    "GeneralizedAlpha": (hm.GeneralizedAlpha(step=1.0), 2e-5, 2),
    "GeneralizedAlpha, strong damping": (hm.GeneralizedAlpha(step=1.0, spectral_radius=0.5), 2e-5, 2),
}  # fmt: skip


@pytest.mark.parametrize("name", FIXED)
def test_fixed_step_solver_has_its_order(name: str) -> None:
    solver, step, order = FIXED[name]
    assert solver.order == order
    # Richardson: from three of its own runs
    assert richardson(solver, "step", step) == pytest.approx(order, abs=0.2)
    # and from its error against the reference
    errors = [max(true_errors(simulated(solver.replacing(step=step / 2**k))).values()) for k in range(2)]
    assert math.log2(errors[0] / errors[1]) == pytest.approx(order, abs=0.2)


@pytest.mark.parametrize("name", FIXED)
def test_error_estimate_of_a_fixed_step_solver_is_within_a_factor_of_three_of_the_truth(name: str) -> None:
    solver, step, _ = FIXED[name]
    response = hm.simulate(scene(), DURATION, solver=solver.replacing(step=step), initial_speed=SPEED, estimate_error=True)
    truth = true_errors(response)
    for channel, error in truth.items():
        assert error / 3.0 < response.error[channel] < 3.0 * error, (channel, response.error[channel], error)


def test_dormand_prince_without_step_control_has_order_five() -> None:
    # Exudyn keeps adapting even with automaticStepSize off, so the tolerance is made too wide to matter
    solver = hm.DormandPrince(relative_tolerance=1e9, absolute_tolerance=1e9, first_step=1.0)
    responses = [simulated(solver.replacing(max_step=8e-5 / 2**k)) for k in range(3)]
    for k, response in enumerate(responses):
        np.testing.assert_allclose(np.diff(response.times)[2:], 8e-5 / 2**k, rtol=1e-6)
    assert richardson(solver, "max_step", 8e-5) == pytest.approx(solver.order, abs=0.2)


def test_error_of_dormand_prince_falls_with_its_tolerance() -> None:
    _, exact = reference()
    errors = []
    for tolerance in (1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10):
        response = simulated(hm.DormandPrince(relative_tolerance=tolerance, absolute_tolerance=1e-2 * tolerance))
        ends = [abs(SENSE[n] * response.values[f"{n}.speed"][-1] - exact.speeds[n][-1]) / np.max(np.abs(exact.speeds[n])) for n in BODIES]
        errors.append(max(ends))
    assert all(fine < coarse for coarse, fine in pairwise(errors))
    # over six decades of the tolerance the error falls by about as much
    assert 4.5 < math.log10(errors[0] / errors[-1]) < 7.5
    assert errors[-1] < 1e-8


def test_error_estimate_of_dormand_prince_is_above_the_error_of_the_run_it_returns() -> None:
    solver = hm.DormandPrince(relative_tolerance=1e-6, absolute_tolerance=1e-8)
    response = hm.simulate(scene(), DURATION, solver=solver, initial_speed=SPEED, estimate_error=True)
    model = reference_model()
    exact = integrate(model, response.times, start=model.start(SPEED), relative=1e-13)
    for name in BODIES:
        ours, theirs = SENSE[name] * response.values[f"{name}.speed"], exact.speeds[name]
        truth = float(np.max(np.abs(ours - theirs)) / np.max(np.abs(theirs)))
        assert truth < response.error[f"{name}.speed"] < 1e-4

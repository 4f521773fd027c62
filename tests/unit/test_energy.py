"""Energy and angular momentum of runs against closed forms and against the error of the solver."""

from __future__ import annotations

import dataclasses
import math
from pathlib import Path

import numpy as np
import pytest

import hdrive_mbs as hm
from models.harmonic_drive_train import build

TWISTED = {"gear.flexspline.angle": 5e-3, "load.angle": 5e-3}
"""Start with 5 mrad in the gear and none in the shafts (true sense: the output turns backwards)."""

TIGHT = hm.DormandPrince(relative_tolerance=1e-10, absolute_tolerance=1e-12)


def free_train(damping: bool) -> hm.Scene:
    """The train without motor torque and load; undamped unless asked for."""
    scene = build().replacing({"motor.characteristic": lambda speed: 0.0 * speed, "load.torque": lambda time: 0.0 * time})
    if damping:
        return scene
    return scene.replacing({"input_shaft.damping": 0.0, "gear.damping": 0.0, "output_shaft.damping": 0.0})


def step_errors(response: hm.Response, relative: float, absolute: float) -> tuple[float, float]:
    """What the tolerances of an adaptive solver allow in energy [J] and momentum [N m s].

    Each step may err by absolute + relative |y| in every angle and speed; with the largest speeds and elastic torques
    of the run,  dE <= sum(|J w| dw + |T| dq)  and  dL <= sum(J dw),  and the steps add up at worst.
    """
    assert response.scene is not None
    energy = momentum = 0.0
    network = response.scene.network()
    for body in network.bodies:
        torque = sum(
            abs(network.connection(name).factors.get(body.name, 0.0)) * np.max(np.abs(response.values[f"{name}.torque"]))
            for name in ("input_shaft", "gear", "output_shaft")
        )
        w = float(np.max(np.abs(response.values[f"{body.name}.speed"])))
        q = float(np.max(np.abs(response.values[f"{body.name}.angle"])))
        dw, dq = absolute + relative * w, absolute + relative * q
        energy += body.inertia * w * dw + torque * dq
        momentum += body.inertia * dw
    return response.steps * energy, response.steps * momentum


# -- nothing gets lost --------------------------------------------------------------------------------


def test_a_free_undamped_train_keeps_its_energy_and_its_momentum() -> None:
    response = hm.simulate(free_train(damping=False), 0.05, solver=TIGHT, initial=TWISTED | {"motor.speed": 1.0})
    balance = hm.energy_balance(response)
    energy, momentum = step_errors(response, 1e-10, 1e-12)
    assert np.max(np.abs(balance.energy_residual)) < energy
    # the sum of kinetic and elastic energy uses the area under the laws, not the work: an independent check
    assert np.ptp(balance.total) < energy
    assert energy < 1e-4 * balance.total[0], "the bound must be small against what is checked"
    assert np.max(np.abs(balance.momentum_residual)) < momentum
    for heat in balance.dissipated.values():
        assert np.max(np.abs(heat)) < energy


def test_the_residual_shows_the_error_of_a_coarse_solver() -> None:
    # RK4 damps an oscillation by 1 - (wh)^6/144 a step, so its energy by (wh)^5 over a time: half the step, 1/32 of it
    scene = free_train(damping=False).replacing({"gear.stiffness": hm.CubicStiffness(linear=6e4, cubic=0.0)})

    def error(solver: hm.Solver) -> float:
        return hm.energy_balance(hm.simulate(scene, 0.1, solver=solver, initial=TWISTED)).energy_error

    coarse, fine = error(hm.RungeKutta4(step=2e-5)), error(hm.RungeKutta4(step=1e-5))
    assert 16.0 < coarse / fine < 64.0
    assert error(TIGHT) < 0.1 * fine


def test_a_wrong_history_does_not_balance() -> None:
    response = hm.simulate(free_train(damping=False), 0.05, solver=TIGHT, initial=TWISTED)
    wrong = dataclasses.replace(response, values={**response.values, "load.speed": 1.001 * response.values["load.speed"]})
    # a speed wrong by 1e-3 is a kinetic energy wrong by 2e-3
    right = hm.energy_balance(response)
    assert hm.energy_balance(wrong).energy_error > 1e-3
    assert right.energy_error * right.energy_scale < step_errors(response, 1e-10, 1e-12)[0] < 1e-4 * right.energy_scale


# -- where it goes ------------------------------------------------------------------------------------


def test_a_damped_oscillator_turns_its_energy_into_heat_as_the_closed_form_says() -> None:
    # two discs on a damped shaft, let go at twist x0:  J = J1 J2/(J1 + J2), x = x0 e^(-d t) (cos wt + d/w sin wt)
    first, second, k, c, x0 = 0.02, 0.05, 800.0, 0.05, 0.1
    J = first * second / (first + second)
    d = c / (2.0 * J)
    w = math.sqrt(k / J - d * d)
    parts = {"a": hm.Inertia(inertia=first), "shaft": hm.Shaft(stiffness=k, damping=c), "b": hm.Inertia(inertia=second)}
    scene = hm.Scene(name="oscillator", parts=parts, connections=[("a", "shaft", "b")])
    response = hm.simulate(scene, 0.2, solver=TIGHT, initial={"a.angle": x0})
    balance = hm.energy_balance(response)
    t = balance.times
    decay = np.exp(-d * t)
    twist = x0 * decay * (np.cos(w * t) + d / w * np.sin(w * t))
    rate = -x0 * decay * (w + d * d / w) * np.sin(w * t)
    start = 0.5 * k * x0**2
    # errors of a step, 1e-10 of each value, over all steps, times the 2 of a square
    bound = 2.0 * response.steps * 1e-10 * start
    np.testing.assert_allclose(balance.stored["shaft"], 0.5 * k * twist**2, atol=bound)
    np.testing.assert_allclose(balance.kinetic, 0.5 * J * rate**2, atol=bound)
    np.testing.assert_allclose(balance.dissipated["shaft"], start - 0.5 * k * twist**2 - 0.5 * J * rate**2, atol=2.0 * bound)
    assert bound < 1e-5 * start


def test_the_driven_train_balances_within_the_error_of_the_solver() -> None:
    response = hm.simulate(build(), 0.5, solver=TIGHT)
    balance = hm.energy_balance(response)
    energy, momentum = step_errors(response, 1e-10, 1e-12)
    assert np.max(np.abs(balance.energy_residual)) < energy < 1e-3 * balance.energy_scale
    assert np.max(np.abs(balance.momentum_residual)) < momentum < 1e-3 * balance.momentum_scale
    assert balance.work["motor.torque"][-1] < 0.0 < balance.work["load.torque"][-1]
    for heat in balance.dissipated.values():
        assert np.all(np.diff(heat) > -energy), "dampers do not give energy back"
    delivered = -balance.work["motor.torque"][-1] - balance.work["load.torque"][-1]
    kept = balance.kinetic[-1] + sum(values[-1] for values in balance.stored.values())
    assert delivered == pytest.approx(kept + sum(values[-1] for values in balance.dissipated.values()), abs=2.0 * energy)


def test_the_reaction_of_the_housing_closes_the_balance_of_momentum() -> None:
    response = hm.simulate(build(), 0.3, solver=TIGHT)
    balance = hm.energy_balance(response)
    # the housing pushes back with the torque that the channel says it takes; trapezoids are of order 2, so those over
    # every other sample differ from those over all by three times the error of the latter
    torque, times = response["gear.housing_torque"].values, response.times
    impulse = -np.concatenate([[0.0], np.cumsum(0.5 * np.diff(times) * (torque[1:] + torque[:-1]))])
    every_other = -np.concatenate([[0.0], np.cumsum(0.5 * np.diff(times[::2]) * (torque[2::2] + torque[:-2:2]))])
    error = np.max(np.abs(impulse[::2][: len(every_other)] - every_other))
    assert np.max(np.abs(balance.impulse["held at ground"] - impulse)) < error < 1e-4 * np.max(np.abs(impulse))
    without = balance.momentum - balance.momentum[0] - balance.impulse["motor.torque"] - balance.impulse["load.torque"]
    assert np.max(np.abs(without)) > 0.5 * np.max(np.abs(impulse)), "without the housing it does not close"


def test_a_prescribed_motor_is_seen_to_do_the_work() -> None:
    scene = build().replacing({"motor.characteristic": hm.IdealSpeedMotor(motion=lambda t: 40.0 * t - 40.0 * np.sin(20.0 * t) / 20.0)})
    response = hm.simulate(scene, 0.4, solver=TIGHT)
    balance = hm.energy_balance(response)
    assert balance.driven["motor"][-1] > 0.0
    energy, momentum = step_errors(response, 1e-10, 1e-12)
    assert np.max(np.abs(balance.energy_residual)) < energy < 1e-2 * balance.energy_scale
    assert np.max(np.abs(balance.momentum_residual)) < momentum
    assert "held at motor" in balance.impulse


@pytest.mark.parametrize(
    ("effect", "at"),
    [
        (hm.BoucWenHysteresis(torque_limit=5.0, yield_twist=2e-4), "gear"),
        (hm.KinematicError(amplitude=1e-4, order=2.0), "gear.mesh"),
        (hm.MeshFriction(loss_factor=0.2, no_load=0.02), "gear"),
        (hm.CoulombStribeckFriction(coulomb=3.0, smoothing_speed=0.1), "load"),
        (hm.CouplingBacklash(backlash=1e-3), "output_shaft"),
    ],
    ids=lambda item: type(item).__name__ if isinstance(item, hm.Effect) else item,
)
def test_effects_take_part_in_both_balances(effect: hm.Effect, at: str) -> None:
    response = hm.simulate(build().with_effect(effect, at=at), 0.2, solver=TIGHT)
    balance = hm.energy_balance(response)
    energy, momentum = step_errors(response, 1e-10, 1e-12)
    assert np.max(np.abs(balance.energy_residual)) < energy
    assert np.max(np.abs(balance.momentum_residual)) < momentum
    for heat in balance.dissipated.values():
        assert np.all(np.diff(heat) > -energy)


# -- bad input ----------------------------------------------------------------------------------------


def test_a_thinned_record_is_refused() -> None:
    response = hm.simulate(build(), 0.05, sample_step=1e-3)
    with pytest.raises(hm.AnalysisError, match="sample_step=0"):
        hm.energy_balance(response)


def test_a_response_without_its_scene_is_refused(tmp_path: Path) -> None:
    response = hm.simulate(free_train(damping=True), 0.01)
    loaded = hm.load(response.save(tmp_path / "run.npz"))
    assert isinstance(loaded, hm.Response)
    with pytest.raises(hm.AnalysisError, match="simulate it again"):
        hm.energy_balance(loaded)


def test_a_balance_is_saved_and_loaded_whole(tmp_path: Path) -> None:
    balance = hm.energy_balance(hm.simulate(build(), 0.02))
    copy = hm.load(balance.save(tmp_path / "energy.npz"))
    assert copy.energy_error == balance.energy_error  # type: ignore[attr-defined]
    assert {len(column) for column in balance.columns().values()} == {len(balance.times)}

"""Steps that are too long: refused where they are unstable, told where they do not follow the motion."""

from __future__ import annotations

import math
import re
import warnings

import numpy as np
import pytest
from typer.testing import CliRunner

import hdrive_mbs as hm
from hdrive_mbs.cli.main import app
from hdrive_mbs.errors import SimulationError
from models.harmonic_drive_train import build as train
from models.jeffcott import build as jeffcott


def oscillator(damping: float = 0.0) -> hm.Scene:
    """J = 1 kg m^2 on k = 100 N m/rad: 10 rad/s."""
    parts = {"disc": hm.Inertia(inertia=1.0), "shaft": hm.Shaft(stiffness=100.0, damping=damping)}
    return hm.Scene(name="oscillator", parts=parts, connections=[("disc", "shaft", "ground")])


def remark(scene: hm.Scene, duration: float, **options: object) -> str:
    """What the status says of the step, which is warned of too."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", hm.CoarseStepWarning)
        status = hm.simulate(scene, duration, **options).status  # type: ignore[arg-type]
    said = status.removeprefix("complete").removeprefix("; ")
    assert [str(item.message) for item in caught] == ([f"{scene.name}: {said}."] if said else [])
    assert all(item.filename == __file__ for item in caught)
    return said


# -- explicit ---------------------------------------------------------------------------------------------


def test_the_limit_of_stability_of_a_vibration_is_that_of_theory() -> None:
    # |1 + z + z^2/2 + z^3/6 + z^4/24| = 1 on the imaginary axis at sqrt(8)
    limit = math.sqrt(8.0) / 10.0
    assert hm.simulate(oscillator(), 40.0, solver=hm.RungeKutta4(step=0.99 * limit), initial={"disc.speed": 1.0}).status == "complete"
    message = (
        rf"RungeKutta4\.step = 0\.28\d* s is beyond .* {limit:.3g} s for the vibration of disc at 10 rad/s at the start.*DormandPrince"
    )
    with pytest.raises(SimulationError, match=message):
        hm.simulate(oscillator(), 40.0, solver=hm.RungeKutta4(step=1.01 * limit), initial={"disc.speed": 1.0})


def test_a_train_with_a_step_of_a_hundred_times_its_limit_gives_no_numbers() -> None:
    with pytest.raises(SimulationError, match=r"RungeKutta4\.step = 0\.05 s is beyond its limit of stability"):
        hm.simulate(train(), 1.0, solver=hm.RungeKutta4(step=0.05))


def test_a_decay_that_is_unstable_all_the_way_gives_no_numbers() -> None:
    # lambda^2 + 1000 lambda + 100 = 0: -999.9 1/s, where Runge-Kutta is stable up to h = 2.785/999.9
    scene, start = oscillator(1000.0), {"disc.speed": 1.0}
    assert hm.simulate(scene, 0.05, solver=hm.RungeKutta4(step=2.7e-3), initial=start).status == "complete"
    with pytest.raises(SimulationError, match=r"0\.00279 s for the decay of disc with 999\.9 1/s"):
        hm.simulate(scene, 0.05, solver=hm.RungeKutta4(step=2.9e-3), initial=start)


def test_friction_that_is_stiff_at_rest_alone_does_not_stop_a_run() -> None:
    # at rest dT/dw = 1 N m/1e-4 rad/s, a decay with 1e4 1/s; at h = 1e-3 s it is stable as soon as the motor turns
    friction = hm.CoulombStribeckFriction(coulomb=1.0, smoothing_speed=1e-4)
    motor = hm.Motor(inertia=1.0, characteristic=lambda w: 10.0 - w)
    scene = hm.Scene(name="from rest", parts={"motor": motor}, connections=[]).with_effect(friction, at="motor")
    response = hm.simulate(scene, 1.0, solver=hm.RungeKutta4(step=1e-3))
    assert response["motor.speed"].values[-1] == pytest.approx(9.0 * (1.0 - math.exp(-1.0)), rel=1e-2)


# -- implicit ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("steps", "said"), [(12.0, False), (8.0, True)])
def test_a_vibration_needs_ten_steps_a_period(steps: float, said: bool) -> None:
    period = 2.0 * math.pi / 10.0
    text = remark(oscillator(), 10.0 * period, solver=hm.Trapezoidal(step=period / steps), initial={"disc.speed": 1.0})
    assert bool(text) is said
    if said:  # the rule vibrates with (2/h) atan(w h/2)
        found = float(re.search(r": ([\d.]+) steps in a period", text).group(1))  # type: ignore[union-attr]
        assert found == pytest.approx(math.pi / math.atan(math.pi / steps), rel=0.02)


def test_a_start_in_five_steps_says_so() -> None:
    assert "the step of 0.2 s is too long for what comes out" in remark(train(), 1.0, solver=hm.Trapezoidal(step=0.2))
    with pytest.warns(hm.CoarseStepWarning):
        assert "; the step of 0.2 s is too long" in hm.start_up(train(), 1.0, solver=hm.Trapezoidal(step=0.2)).status


def test_stepping_over_a_stiff_mode_that_hardly_moves_is_what_the_rule_is_for() -> None:
    # a pinion of a ten thousandth of the inertia on a stiff shaft: 3.2e4 rad/s, of which h = 1e-3 s sees nothing
    parts = {
        "disc": hm.Inertia(inertia=1.0),
        "shaft": hm.Shaft(stiffness=100.0),
        "stub": hm.Shaft(stiffness=1e5),
        "pinion": hm.Inertia(inertia=1e-4),
    }
    scene = hm.Scene(name="stiff stub", parts=parts, connections=[("pinion", "stub", "disc"), ("disc", "shaft", "ground")])
    assert float(np.max(hm.modes(scene).undamped)) > 3e4
    assert remark(scene, 1.0, solver=hm.Trapezoidal(step=1e-3), initial={"disc.speed": 1.0, "pinion.speed": 1.0}) == ""


def test_an_unbalanced_rotor_needs_ten_steps_a_turn_also_when_few_samples_are_kept() -> None:
    # 250 rad/s and 5e-3 s: 5.03 steps a turn at first; nothing brakes the free spin
    text = remark(jeffcott(), 0.2, initial_speed=250.0, solver=hm.Trapezoidal(step=5e-3, newton_tolerance=1e-5), sample_step=0.02)
    assert re.search(r"steps in a turn of \w+ at \d+", text)
    assert remark(jeffcott(), 0.2, initial_speed=250.0, solver=hm.Trapezoidal(step=1e-4, newton_tolerance=1e-5)) == ""


def test_a_run_up_says_it_of_a_step_that_was_given_and_not_of_its_own() -> None:
    with pytest.warns(hm.CoarseStepWarning, match="too long for what comes out"):
        coarse = hm.run_up(jeffcott(), 0.5, initial_speed=250.0, solver=hm.Trapezoidal(step=5e-3, newton_tolerance=1e-5))
    assert coarse.status.startswith("complete; the step of 0.005 s is too long for what comes out")
    with warnings.catch_warnings():
        warnings.simplefilter("error", hm.CoarseStepWarning)
        assert "too long" not in hm.run_up(jeffcott(), 0.5, initial_speed=250.0, accuracy=0.1).status


def test_the_command_prints_it_and_ends_well(tmp_path: object) -> None:
    options = ["run", "models/harmonic_drive_train.py", "--solver", "trapezoidal", "--step", "0.2", "--out", str(tmp_path)]
    with pytest.warns(hm.CoarseStepWarning):
        done = CliRunner().invoke(app, options)
    assert done.exit_code == 0, done.output
    assert "is too long for what comes out" in " ".join(done.output.split())

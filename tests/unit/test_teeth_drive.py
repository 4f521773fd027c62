"""From teeth to the drive: ratio, sense, lost motion, loaded teeth, kinematic error, refusal."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.errors import ParameterError, PlaceError
from models.double_harmonic_transmission import build, gear

STIFFNESS = hm.PiecewiseLinearStiffness(lost_motion=0.0, stiffness_1=4e3, stiffness_2=6e3, stiffness_3=8e3, torque_1=4.0, torque_2=15.0)


def jammed() -> hm.DoubleHarmonicGear:
    """Set A with w0 = 0.32 mm: flanks jam at full depth."""
    return gear("A", hm.CosineDeformation(amplitude=hm.mm(0.32)))


@pytest.mark.parametrize(("name", "ratio"), [("A", 50.0), ("C", 200 * 188 / (202 * 190 - 200 * 188))])
def test_a_drive_takes_ratio_and_sense_from_its_teeth(name: str, ratio: float) -> None:
    drive = hm.HarmonicDrive.from_gear(gear(name), stiffness=STIFFNESS)
    assert drive.ratio == pytest.approx(ratio, rel=1e-12)
    assert drive.output_sense == "opposite"


@pytest.mark.parametrize("name", ["A", "C"])
def test_in_motion_the_load_turns_at_the_ratio_of_the_teeth_and_backwards(name: str) -> None:
    response = hm.simulate(build(name), 0.4)
    wound = response["load.angle"].values[-1] * gear(name).ratio / response["motor.angle"].values[-1]
    # the elastic and lost twist is some milliradian of about 1 rad at the load
    assert wound == pytest.approx(1.0, abs=0.01)


def test_a_scene_refuses_a_gear_that_interferes_and_says_why() -> None:
    with pytest.raises(ParameterError, match=r"The teeth of this gear interfere.*flank interference near full depth"):
        hm.HarmonicDrive.from_gear(jammed(), stiffness=STIFFNESS)
    with pytest.raises(ParameterError, match="interfere"):
        build("A").replacing({"gear.teeth.deformation.amplitude": hm.mm(0.32)})


def test_a_ratio_that_is_not_that_of_the_teeth_is_refused() -> None:
    with pytest.raises(ParameterError, match=r"ratio = 51 .* does not belong to the teeth, which give -50"):
        hm.HarmonicDrive(ratio=51.0, stiffness=STIFFNESS, teeth=gear("A"))
    with pytest.raises(ParameterError, match="does not belong to the teeth"):
        hm.HarmonicDrive(ratio=50.0, output_sense="same", stiffness=STIFFNESS, teeth=gear("A"))


@pytest.mark.parametrize("suffix", [".toml", ".json"])
def test_a_scene_with_teeth_is_saved_and_loaded(tmp_path: Path, suffix: str) -> None:
    scene = build("C")
    assert hm.load_scene(hm.save_scene(scene, tmp_path / f"scene{suffix}")) == scene


def test_the_lost_motion_of_both_stages_adds_up_at_the_output() -> None:
    one = gear("A")
    first, second = one.clearances()
    # held generator: w4 = w2 z2'/z4
    assert one.lost_motion == pytest.approx(first.lost_motion * 202 / 200 + second.lost_motion, rel=1e-12)
    assert one.gains()[0] == pytest.approx(one.speeds(driver="flexspline", fixed="wave_generator")["output_wheel"], rel=1e-12)
    law = build("A").parts["gear"].law  # type: ignore[attr-defined]
    assert law.half_gap == pytest.approx(one.lost_motion / 2.0, rel=1e-12)


def test_more_wind_up_loads_more_teeth_until_all_in_mesh_carry() -> None:
    result = gear("A").clearances()[0]
    windups = np.geomspace(1e-5, 1.0, 30)
    counts = np.array([result.loaded_teeth(w) for w in windups])
    factors = np.array([result.stiffness_factor(w) for w in windups])
    assert (np.diff(counts) >= 0.0).all()
    assert (np.diff(factors) > 0.0).all()
    assert counts[-1] == pytest.approx(result.teeth_in_engagement, rel=0.02)
    assert factors[-1] == pytest.approx(1.0, abs=0.03)
    assert factors[0] < 0.1
    # the load of springs that begin one after the other, counted tooth by tooth
    play = np.interp(np.arange(0.0, 2.0 * np.pi, 1e-4), result.angles, np.where(np.isinf(result.play()), 1e3, result.play()))
    by_count = np.mean(np.maximum(0.0, 2e-3 - play)) / (2e-3 * result.zone)
    assert result.stiffness_factor(2e-3) == pytest.approx(by_count, rel=1e-3)


def test_stages_in_series_are_softer_than_the_better_of_them() -> None:
    one = gear("A")
    first, second = one.stiffness_factors(1e-3)
    assert min(first, second) <= one.mesh_stiffness_factor(1e-3) <= max(first, second)
    assert one.loaded_teeth(1e-3) == tuple(result.loaded_teeth(1e-3) for result in one.clearances())
    with pytest.raises(ParameterError, match="windup = 0 rad"):
        one.stiffness_factors(0.0)


def simulated_error(
    one: hm.DoubleHarmonicGear, errors: list[hm.WheelError], turns: int, samples: int, weights: tuple[float, float]
) -> np.ndarray:
    """Error [rad] at the output over turns of the generator, by averaging the deviation of the wheels over all teeth of both zones."""
    G = 2.0 * np.pi * turns * np.arange(samples) / samples
    speeds = one.speeds()
    total = np.zeros(samples)
    for error in errors:
        k = 0 if error.wheel in ("flexspline", "circular_spline") else 1
        stage, result = one.stages()[k], one.clearances()[k]
        member = {"flexspline_inner": "flexspline"}.get(error.wheel, error.wheel)
        wheel = stage.flexible if member == "flexspline" else stage.rigid
        half = np.pi * result.zone / 2.0
        seen = G * (1.0 - speeds[member])
        across = np.linspace(-half, half, 201)
        for side, weight in zip((0.0, np.pi), weights):
            at = seen[:, None] + side + across
            total += (
                weight
                * np.trapezoid(error.amplitude * np.sin(error.harmonic * at + error.phase), across, axis=1)
                / (2.0 * half)
                / wheel.tip_radius
                * one.gains()[k]
            )
    return total


@pytest.mark.parametrize("imbalance", [0.0, 0.3])
def test_error_orders_are_those_of_the_deviations_averaged_tooth_by_tooth(imbalance: float) -> None:
    one = gear("A")
    errors = [
        hm.eccentricity("circular_spline", 10e-6),
        hm.WheelError(wheel="circular_spline", harmonic=2, amplitude=8e-6),
        hm.WheelError(wheel="flexspline", harmonic=2, amplitude=5e-6),
        hm.WheelError(wheel="output_wheel", harmonic=4, amplitude=5e-6),
        hm.WheelError(wheel="flexspline_inner", harmonic=3, amplitude=5e-6),
    ]
    for error in errors:
        (order,) = hm.error_orders(one, [error], imbalance)
        turns = 5050  # all orders have whole numbers of periods: n (1 + k/5050)
        signal = simulated_error(one, [error], turns, 12000, ((1.0 + imbalance) / 2.0, (1.0 - imbalance) / 2.0))
        G = 2.0 * np.pi * turns * np.arange(12000) / 12000
        found = 2.0 * abs(np.mean(signal * np.exp(-1j * order.order * G)))
        assert found == pytest.approx(order.amplitude, rel=1e-3, abs=1e-12)
        if imbalance == 0.0 and error.harmonic % 2:
            assert order.amplitude < 1e-12  # two zones opposite each other cancel it


def test_the_beat_of_ring_and_flexspline_is_twice_per_turn_of_the_output_of_an_ordinary_drive() -> None:
    one = hm.HarmonicGear.standard(
        flexspline_teeth=200, circular_spline_teeth=202, module=hm.mm(0.3), profile_angle=0.52, addendum=hm.mm(0.24), clearance=hm.mm(0.06),
        backlash=hm.mm(0.01), fibre_radius=hm.mm(29.3), deformation=hm.CosineDeformation(amplitude=hm.mm(0.3)),
    )  # fmt: skip
    ring, flexible = hm.error_orders(one, [hm.WheelError(wheel=w, harmonic=2, amplitude=5e-6) for w in ("circular_spline", "flexspline")])
    assert ring.order == 2.0
    assert (flexible.order - ring.order) * abs(one.ratio) == pytest.approx(2.0, rel=1e-12)


def test_error_orders_become_effects_of_the_drive() -> None:
    one = gear("A")
    errors = [hm.eccentricity("circular_spline", 10e-6), hm.WheelError(wheel="circular_spline", harmonic=2, amplitude=8e-6)]
    effects = hm.tooth_errors(one, errors)
    assert [effect.order for effect in effects] == [2.0]  # the eccentricity cancels
    scene = build("A").with_effect(effects[0], at="gear.mesh")
    response = hm.simulate(scene, 0.3)
    assert np.max(np.abs(response["kinematic_error.error"].values)) == pytest.approx(effects[0].amplitude, rel=0.01)
    with pytest.raises(PlaceError, match=r"No wheel 'ring'. This gear has: flexspline, circular_spline, flexspline_inner, output_wheel"):
        hm.error_orders(one, [hm.eccentricity("ring", 1e-6)])


def test_explain_names_what_is_wrong_and_the_way_out() -> None:
    assert "no interference" in gear("A").explain()
    assert "Bring w0 closer" in jammed().explain()
    steep = hm.Stage.standard(
        flexible_teeth=202, rigid_teeth=204, module=hm.mm(0.3), profile_angle=hm.degrees(20.0), addendum=hm.mm(0.24), clearance=hm.mm(0.06),
        backlash=hm.mm(0.01), fibre_radius=hm.mm(29.3), deformation=hm.CosineDeformation(amplitude=hm.mm(0.3)),
    )  # fmt: skip
    shallow = steep.replacing(deformation=hm.CosineDeformation(amplitude=hm.mm(0.17)))
    from hdrive_mbs.teeth.explain import explain_clearances

    assert "tip interference on the way in and out" in explain_clearances(hm.clearances(steep))
    assert "on the starting axis" in explain_clearances(hm.clearances(shallow))

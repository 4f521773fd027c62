"""What is put into records is found in them, nothing where nothing is, and the rest is admitted.

The records come from the multibody engine with another step, parameters off by their tolerance, and noise
(diagnosis_cases.py); the search runs compiled lines.  Limits: 4 standard deviations everywhere, so that a right method
fails by chance once in 16 000 asserts.
"""

from __future__ import annotations

import itertools
import math
from functools import cache

import pytest

import hdrive_mbs as hm
from hdrive_mbs.diagnosis.diagnose import diagnose
from hdrive_mbs.diagnosis.result import Cause, Diagnosis, Estimate
from hdrive_mbs.diagnosis.unknowns import TOLERANCE
from hdrive_mbs.effects.coulomb_stribeck_friction import CoulombStribeckFriction
from hdrive_mbs.effects.dahl_hysteresis import DahlHysteresis
from hdrive_mbs.effects.eccentric_load import EccentricLoad
from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.effects.external_torque import ExternalTorque
from hdrive_mbs.effects.kinematic_error import KinematicError
from hdrive_mbs.effects.load_lag import LoadLag
from hdrive_mbs.effects.rub_at_angle import RubAtAngle
from hdrive_mbs.effects.sensor_gain import SensorGain
from hdrive_mbs.effects.torque_ripple import TorqueRipple
from hdrive_mbs.effects.unequal_drag import UnequalDrag
from tests.unit.diagnosis_cases import CHANNELS, DISTURBED, DURATION, INPUTS, KNOWLEDGE, STEP, bench, quiet, records, scene

TRIED: tuple[type[Effect], ...] = (CoulombStribeckFriction, KinematicError, DahlHysteresis, SensorGain, EccentricLoad)
HELD_OUT = 0.25 * len(CHANNELS) * len(INPUTS) * DURATION / STEP
"""Samples that no fit sees: a quarter."""
NEAR_ONE = 4.0 / math.sqrt(2.0 * HELD_OUT)
"""Of the root mean square of so many samples of unit variance: its standard deviation is 1/sqrt(2 n)."""


def holds(estimate: Estimate, truth: float) -> bool:
    """Whether a value lies within four standard deviations, twice the half width of the 95 % interval (1.96)."""
    below, above = estimate.value - estimate.low, estimate.high - estimate.value
    return estimate.value - 2.05 * below <= truth <= estimate.value + 2.05 * above


def estimates(cause: Cause) -> dict[str, Estimate]:
    return {item.name.rpartition(".")[2]: item for item in cause.parameters}


def check_gap(found: Diagnosis, refit_helps: bool = True) -> None:
    """Nothing but noise is left by the claim, and refitted parameters alone go only part of the way, if any."""
    assert abs(found.gap.effect.value - 1.0) < NEAR_ONE
    assert found.gap.effect.value < min(found.gap.refit.value, found.gap.nominal.value)
    assert (found.gap.refit.value < found.gap.nominal.value) == (found.closed_by_refit > 0.0) == refit_helps
    assert found.closed_by_refit < found.closed
    assert found.gap.effect.low < found.gap.effect.value < found.gap.effect.high


PLANTED: dict[str, tuple[Effect, str, str, tuple[str, ...]]] = {
    "friction of the motor": (
        CoulombStribeckFriction(coulomb=0.05, smoothing_speed=0.3),
        "motor",
        "effect",
        ("coulomb",),
    ),
    "friction of the load": (
        CoulombStribeckFriction(coulomb=3.0, smoothing_speed=0.01),
        "load",
        "effect",
        ("coulomb",),
    ),
    "kinematic error": (KinematicError(amplitude=1e-4, order=2.0, phase=0.8), "gear", "effect", ("amplitude", "phase")),
    "hysteresis": (DahlHysteresis(torque_limit=4.0, yield_twist=3e-4), "gear", "effect", ("torque_limit", "yield_twist")),
    "sensor gain": (SensorGain(error=0.01), "load_encoder", "sensor", ("error",)),
}
"""Effect, place, verdict, and fields that the records determine."""


WITHOUT_A_NAME: dict[str, tuple[Effect, str, str, tuple[str, ...]]] = {
    "drag in one sense": (UnequalDrag(friction=0.02), "motor", "effect", ("friction",)),
    "rub at an angle": (RubAtAngle(friction=0.03, angle=0.7, sharpness=5.0), "motor", "effect", ("friction", "angle", "sharpness")),
    "brake that lags": (LoadLag(time_constant=0.02), "load", "effect", ("time_constant",)),
    "neighbour that shakes": (ExternalTorque(amplitude=1.0, frequency=47.0, phase=0.4), "load", "effect", ("amplitude", "frequency")),
}
"""Causes that most libraries have no word for; each has to be told from the others, too."""
WITHOUT_A_NAME_TRIED: tuple[type[Effect], ...] = (UnequalDrag, RubAtAngle, LoadLag, ExternalTorque, CoulombStribeckFriction)


@pytest.mark.parametrize("name", [*PLANTED, *WITHOUT_A_NAME])
def test_a_planted_cause_is_found_at_its_place_with_its_size(name: str) -> None:
    effect, place, verdict, fields = {**PLANTED, **WITHOUT_A_NAME}[name]
    tried = TRIED if name in PLANTED else WITHOUT_A_NAME_TRIED
    found = diagnose(bench(), records((effect, place)), candidates=tried, pictures=False)
    assert found.verdict == verdict
    [cause] = found.causes
    assert (cause.effect, cause.at, cause.law) == (type(effect).family, place, type(effect).__name__)
    assert set(found.indistinguishable) <= {(cause.effect, cause.at)}
    assert cause.probability > 0.5
    assert cause.probability == max(item.probability for item in found.ranking)
    for field in fields:
        assert holds(estimates(cause)[field], getattr(effect, field)), field
        assert estimates(cause)[field].identifiable
    # a load that lags cannot be made up for by parameters: what they gain where they are fitted they lose elsewhere
    check_gap(found, refit_helps=name != "brake that lags")
    [added] = found.improved.effects
    assert (type(added.effect), added.at) == (type(effect), place)


def true_value(name: str, errors: dict[str, float]) -> float:
    path, sigma = KNOWLEDGE[name]
    return scene().parameters()[path].value * math.exp(sigma * errors.get(name, 0.0))


def test_records_of_a_scene_with_wrong_parameters_within_tolerance_are_blamed_on_nothing() -> None:
    found = diagnose(bench(), quiet(), candidates=TRIED, pictures=False)
    assert found.verdict == "none"
    assert found.causes == found.indistinguishable == ()
    assert found.improved.effects == ()
    assert found.ranking[0].effect == "none"
    assert found.gap.nominal.value > 10.0  # the tolerance alone looks like a large gap
    assert abs(found.gap.refit.value - 1.0) < NEAR_ONE
    assert found.gap.effect.value == found.gap.refit.value
    for item in found.parameters:
        if item.identifiable:
            assert holds(item, true_value(item.name, DISTURBED)), item.name
    assert any("agree" in note for note in found.notes)


@pytest.mark.parametrize("sigmas", [3.9, 9.0])  # of the logarithm
def test_a_parameter_outside_its_tolerance_is_named_with_its_value(sigmas: float) -> None:
    """Up to 5 sigma the odds are those of the priors alone: the nominal one costs z^2/2, one ten times wider z^2/200 and log 10.

    Beyond, the nominal model may not follow, and the odds are larger.
    """
    errors = {**DISTURBED, "load_inertia": sigmas}
    found = diagnose(bench(), records(errors=errors), candidates=TRIED, pictures=False)
    assert found.verdict == "parameter"
    [cause] = found.causes
    assert (cause.effect, cause.at) == ("parameter", "load_inertia")
    [estimate] = cause.parameters
    truth, (path, sigma) = true_value("load_inertia", errors), KNOWLEDGE["load_inertia"]
    assert holds(estimate, truth)
    z = (truth / scene().parameters()[path].value - 1.0) / sigma
    from_priors = 0.5 * z**2 * (1.0 - 0.1**2) - math.log(10.0)
    assert abs(cause.log_odds - from_priors) < 1.0 if z < TOLERANCE else cause.log_odds > from_priors + 1.0
    assert abs(found.gap.effect.value - 1.0) < NEAR_ONE


def test_a_cause_outside_the_list_is_unknown_and_not_blamed_on_another() -> None:
    ripple = TorqueRipple(amplitude=0.05, order=6.0)
    found = diagnose(bench(), records((ripple, "motor")), candidates=TRIED, pictures=False)
    assert found.verdict == "unknown"
    assert found.causes == ()
    assert found.ranking[0].effect == "unknown"
    assert found.gap.effect.value > 2.0
    assert found.improved.effects == ()


@cache
def pair() -> Diagnosis:
    causes = (CoulombStribeckFriction(coulomb=0.05, smoothing_speed=0.3), "motor"), (KinematicError(amplitude=1e-4, phase=0.8), "gear")
    kinds = (CoulombStribeckFriction, KinematicError, SensorGain)
    return diagnose(bench(), records(*causes), candidates=kinds, pictures=False)


def test_two_causes_at_once_are_both_found() -> None:
    found = pair()
    assert found.verdict == "effect"
    assert {(cause.effect, cause.at) for cause in found.causes} == {("friction", "motor"), ("kinematic_error", "gear")}
    by_name = {cause.effect: estimates(cause) for cause in found.causes}
    assert holds(by_name["friction"]["coulomb"], 0.05)
    assert holds(by_name["kinematic_error"]["amplitude"], 1e-4)
    check_gap(found)


def test_places_that_the_records_cannot_tell_apart_are_both_named() -> None:
    """Friction at either end of a shaft that no sensor looks into.

    0.004 N m turn the shaft of 400 N m/rad by 1e-5 rad, at the load by 2e-7 rad: 0.07 standard deviations of its encoder.
    """
    columns = tuple(CHANNELS)
    cause = CoulombStribeckFriction(coulomb=0.004, smoothing_speed=0.3), "motor"
    found = diagnose(
        bench(columns, shaft=True), records(cause, shaft=True), candidates=(CoulombStribeckFriction,), pictures=False, step=5e-4
    )
    assert found.verdict == "effect"
    claimed = {(found.causes[0].effect, found.causes[0].at)}
    assert claimed | set(found.indistinguishable) == {("friction", "motor"), ("friction", "wave_generator")}
    assert claimed.isdisjoint(found.indistinguishable)
    assert found.causes[0].at in ("motor", "wave_generator")
    assert found.causes[0].probability < 0.9
    assert {item.at for item in found.ranking[:2]} == {"motor", "wave_generator"}
    assert set(found.fits) >= claimed | set(found.indistinguishable)
    assert found.next_records, found.notes
    assert all({item.first, item.second} == claimed | set(found.indistinguishable) for item in found.next_records)
    assert all(a.detectability >= b.detectability for a, b in itertools.pairwise(found.next_records))
    assert abs(found.gap.effect.value - 1.0) < NEAR_ONE


def test_records_of_different_sampling_are_diagnosed_together() -> None:
    cause = KinematicError(amplitude=1e-4, order=2.0, phase=0.8), "gear"
    fine, coarse = records(cause, names=("staircase",), step=5e-4), records(cause, names=("load_cycle",), step=1e-3)
    found = diagnose(bench(), (*fine, *coarse), candidates=(KinematicError,), pictures=False)
    assert [(item.effect, item.at) for item in found.causes] == [("kinematic_error", "gear")]
    assert holds(estimates(found.causes[0])["amplitude"], 1e-4)
    assert abs(found.gap.effect.value - 1.0) < NEAR_ONE
    assert {gap.record for gap in found.gaps[1:]} == {"staircase", "load_cycle"}


@cache
def with_a_whole_record_held_out() -> Diagnosis:
    cause = KinematicError(amplitude=1e-4, order=2.0, phase=0.8), "gear"
    return diagnose(bench(), records(cause), candidates=(KinematicError, SensorGain), held_out=("load_cycle",))


def test_a_whole_record_is_held_out_and_the_gap_measured_on_it_alone() -> None:
    found = with_a_whole_record_held_out()
    assert [(item.effect, item.at) for item in found.causes] == [("kinematic_error", "gear")]
    assert holds(estimates(found.causes[0])["amplitude"], 1e-4)
    assert {gap.record for gap in found.gaps[1:]} == {"load_cycle"}
    assert abs(found.gap.effect.value - 1.0) < 4.0 / math.sqrt(2.0 * len(CHANNELS) * DURATION / STEP)
    for trace in found.traces:
        assert trace.held_out.all() == (trace.record == "load_cycle")
        assert trace.held_out.any() == (trace.record == "load_cycle")
    assert found.settings["held_out"] == ["load_cycle"]
    assert found.settings["searched"] == ["staircase"]


def test_what_is_held_out_must_be_there_and_leave_something() -> None:
    with pytest.raises(hm.PlaceError, match="sweep"):
        diagnose(bench(), quiet(), candidates=(SensorGain,), held_out=("sweep",))
    with pytest.raises(hm.PlaceError, match="sweep"):
        diagnose(bench(), quiet(), candidates=(SensorGain,), held_out="sweep")
    with pytest.raises(hm.ParameterError, match="All records are held out"):
        diagnose(bench(), quiet(), candidates=(SensorGain,), held_out=tuple(INPUTS))


def test_the_improved_scene_can_be_run_and_closes_the_gap_on_the_engine() -> None:
    """Independent of the search: its answer, simulated by the engine through a record's inputs, meets the load encoder."""
    improved = pair().improved
    times, speeds, load_times, torques = INPUTS["load_cycle"]
    driven = improved.replacing(
        {
            "motor.characteristic.reference": hm.SpeedTable(times=times, speeds=speeds),
            "load.torque": hm.TableTorque(times=load_times, torques=torques),
        }
    )
    causes = (CoulombStribeckFriction(coulomb=0.05, smoothing_speed=0.3), "motor"), (KinematicError(amplitude=1e-4, phase=0.8), "gear")
    [record] = records(*causes, names=("load_cycle",), seed=77)
    response = hm.simulate(driven, DURATION, sample_step=STEP, progress=False)
    left = (record["load_angle"].values - response.at("load_encoder", record.times)) / 3e-6
    assert abs(math.sqrt(float(left @ left) / len(left)) - 1.0) < 4.0 / math.sqrt(2.0 * len(left)) + 0.02

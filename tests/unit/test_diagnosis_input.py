"""What cannot be diagnosed is refused early, with object, value, limit and way out."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.diagnosis.bench import Bench, Input, Uncertain
from hdrive_mbs.diagnosis.candidates import candidates
from hdrive_mbs.diagnosis.column_names import as_the_bench_names_them
from hdrive_mbs.diagnosis.diagnose import diagnose
from hdrive_mbs.diagnosis.drive_scale_checks import drives_scaled
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.input_checks import check_trials, not_compared, not_driven
from hdrive_mbs.diagnosis.measured import Measured
from hdrive_mbs.diagnosis.prepared import factors_of
from hdrive_mbs.diagnosis.report_text import report_text
from hdrive_mbs.diagnosis.result import Diagnosis
from hdrive_mbs.diagnosis.scale_checks import OTHERS, check_scale, looks_scaled
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.step import suitable_step
from hdrive_mbs.effects.bearing_cubic_stiffness import BearingCubicStiffness
from hdrive_mbs.effects.effect import Effect, MemoryTorqueEffect, TorqueEffect, add_body_torque
from hdrive_mbs.effects.kinematic_error import KinematicError
from hdrive_mbs.effects.torque_ripple import TorqueRipple
from hdrive_mbs.expression import Value
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.network import Network
from hdrive_mbs.plots.report_html import report_html
from hdrive_mbs.quantities import parameter
from hdrive_mbs.records.measurement import Measurement
from hdrive_mbs.records.record import Record
from hdrive_mbs.records.repair import repaired
from hdrive_mbs.units import factor
from tests.unit.diagnosis_cases import DURATION, KNOWLEDGE, STEP, bench, quiet, records

CONSTANT = hm.SpeedTable(times=(0.0, 0.1, 10.0), speeds=(0.0, 50.0, 50.0))


def run(found: Bench | None = None, given: tuple[Record, ...] | None = None, kinds: tuple[type[Effect], ...] = ()) -> Diagnosis:
    return diagnose(found or bench(), quiet() if given is None else given, candidates=kinds, pictures=False, step=1e-3)


def changed(name: str, change: Callable[[np.ndarray], np.ndarray], record: Record | None = None) -> tuple[Record, ...]:
    """The quiet records, one column of the first of them (or of another record) changed."""
    first = record or quiet()[0]
    values = change(first[name].values.copy())
    new = first.with_channels(item.replacing(values=values) if item.name == name else item for item in first)
    return (new, *quiet()[1:])


def refused(kind: type[Exception], *words: str, **given: object) -> None:
    with pytest.raises(kind) as caught:
        run(**given)  # type: ignore[arg-type]
    text = str(caught.value)
    for word in words:
        assert word in text, text


# -- units and columns ------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("size", "words"),
    [
        (math.pi / 180.0, "'motor_angle' is 0.0174"),
        (180.0 / math.pi, "'motor_angle' is 57."),
        (1.0 / (2.0 * math.pi), "'motor_angle' is 0.159"),
    ],
)
def test_a_column_a_unit_away_from_the_model_is_refused(size: float, words: str) -> None:
    refused(hm.RecordError, words, "times what motor_encoder of the nominal scene does", "units={'motor_angle': ...}",
            given=changed("motor_angle", lambda values: size * values))  # fmt: skip


def test_a_factor_that_no_unit_has_is_a_gap_and_not_a_unit() -> None:
    simulator = Simulator(bench().trials(changed("motor_angle", lambda values: 1.3 * values)[0]), 1e-3)
    hypothesis = Hypothesis(factors_of(bench()))
    [own] = simulator.columns(hypothesis, np.zeros(hypothesis.size))
    check_scale(simulator.trials[0], "motor_angle", own["motor_angle"], "rad")
    check_scale(simulator.trials[0], "motor_torque", own["motor_torque"], "N m")


def test_degrees_read_as_radians_are_seen_though_the_model_does_something_else() -> None:
    """A model whose load has five times the drag turns half as far: beside the motor's angle the load's shows the unit all the same."""
    for size, off in ((180.0 / math.pi, True), (1.0, False), (1.3, False)):
        [trial] = bench().trials(changed("load_angle", lambda values, size=size: size * values)[0])
        columns = {name: 0.45 * trial.columns[name] for name in ("motor_angle", "load_angle")}
        items = {name: trial.measured[name] for name in columns}
        simulator = Simulator([dataclasses.replace(trial, columns=columns, measured=items)], 1e-3)
        said = looks_scaled(simulator, factors_of(bench()))
        assert [text.startswith("Record 'staircase': column 'load_angle' looks as if its numbers were in deg") for text in said] == [
            True
        ] * off
        if off:
            assert "beside 'motor_angle' it moves 57" in said[0]


def test_an_angle_is_held_against_a_speed_of_another_place_too() -> None:
    first = quiet()[0]
    [trial] = bench().trials(first)
    speed = np.gradient(trial.columns["motor_angle"], trial.every)
    items = {"load_angle": trial.measured["load_angle"], "motor_speed": Measured(channel="motor.speed", noise=0.5)}
    columns = {"load_angle": 0.4 * 180.0 / math.pi * trial.columns["load_angle"], "motor_speed": 0.4 * speed}
    simulator = Simulator([dataclasses.replace(trial, columns=columns, measured=items)], 1e-3)
    [said] = looks_scaled(simulator, factors_of(bench()))
    assert "column 'load_angle' looks as if its numbers were in deg" in said
    assert "beside 'motor_speed'" in said


def test_a_column_that_runs_the_other_way_is_seen_and_how_it_is_turned_round() -> None:
    coarse = Simulator(bench().trials(changed("load_angle", lambda values: -0.8 * values)[0]), 1e-3, 4)
    [said] = looks_scaled(coarse, factors_of(bench()))
    assert "column 'load_angle' runs against what load_encoder of the nominal model does" in said
    assert "--unit load_angle='-1 rad'" in said
    for right in quiet():
        assert looks_scaled(Simulator(bench().trials(right), 1e-3, 4), factors_of(bench())) == ()


def test_a_driving_column_in_another_unit_is_seen_by_what_the_model_then_does() -> None:
    turns = changed("speed_reference", lambda values: values * 60.0 / (2.0 * math.pi))
    for given, wrong in ((turns, True), (quiet(), False)):
        coarse = Simulator([trial for record in given for trial in bench().trials(record)], 1e-3, 4)
        said = drives_scaled(bench(), given, coarse, factors_of(bench()))
        assert len(said) == wrong
        if wrong:
            assert said[0].startswith("Column 'speed_reference', which drives the scene, looks as if its numbers were in rpm")
            assert "--unit speed_reference=..." in said[0]


def test_a_model_that_runs_away_for_want_of_friction_is_no_matter_of_units() -> None:
    """It would be nearer if it hardly moved, as with a torque a thousand times smaller; but nothing is as near as that at rest."""
    times = np.arange(2000) * 1e-3
    torque = 0.5 * np.sign(np.sin(4.0 * times))
    standing = hm.TorqueHistory(times=(0.0, 1.0), torques=(0.0, 0.0))
    scene = hm.Scene(name="free", parts={"rotor": hm.Motor(inertia=1e-3, characteristic=standing)}, connections=[])
    alone = Bench(
        scene=scene,
        knowledge={"inertia": Uncertain(paths=("rotor.inertia",), sigma=0.05)},
        measured={"w": Measured(channel="rotor.speed", noise=0.05)},
        inputs={"torque": Input(path="rotor.characteristic", law=lambda t, v: hm.TorqueHistory(times=t, torques=v))},
    )
    real = hm.simulate(
        scene.replacing({"rotor.characteristic": hm.TorqueHistory(times=tuple(times), torques=tuple(torque))}).with_effect(
            hm.CoulombStribeckFriction(coulomb=0.45, smoothing_speed=0.5), at="rotor"
        ),
        float(times[-1]),
    )
    noise = 0.05 * np.random.default_rng(3).standard_normal(len(times))
    channels = [
        Measurement(name="torque", unit="N m", values=torque),
        Measurement(name="w", unit="rad/s", values=real.at("rotor.speed", times) + noise),
    ]
    given = Record(name="run", times=times, channels={item.name: item for item in channels})
    coarse = Simulator(alone.trials(given), 1e-3, 4)
    assert drives_scaled(alone, [given], coarse, factors_of(alone)) == ()
    free = 800.0 * np.cumsum(torque) * 1e-3  # of a rotor without friction, its inertia wrong by a quarter
    kilo = given.with_channels([channels[0].replacing(values=1e3 * torque), channels[1].replacing(values=free)])
    assert drives_scaled(alone, [kilo], Simulator(alone.trials(kilo), 1e-3, 4), factors_of(alone)) != ()


def test_what_is_no_record_is_refused_and_one_class_is_a_list_of_one() -> None:
    with pytest.raises(hm.ParameterError, match=r"Read it first: hm\.diagnose\(bench, hm\.read_records\('run_a\.csv'\)\)"):
        diagnose(bench(), "run_a.csv")  # type: ignore[arg-type]
    assert candidates(bench().scene, hm.ViscousDrag) != []


def test_a_measured_column_that_no_record_has_is_warned_of_at_the_top() -> None:
    given = tuple(record.without("load_angle") for record in quiet())
    found = run(given=given, kinds=(hm.ViscousDrag,))
    [said] = found.warnings
    assert said == "'load_angle', which the bench measures, was not compared in 'staircase', 'load_cycle': no such column there."
    assert report_text(found).splitlines()[3].startswith("WARNING: 'load_angle', which the bench measures, was not compared")
    assert report_html(found).index("Warning: &#x27;load_angle&#x27;") < report_html(found).index("No gap beyond noise")


def called_otherwise(record: Record, names: Mapping[str, tuple[str, str]]) -> Record:
    """Columns under other names, mapped to something."""
    new = {old: item.replacing(name=name, quantity=quantity) for old, (name, quantity) in names.items() for item in [record[old]]}
    return record.with_channels(new.get(item.name, item) for item in record)


def test_columns_of_other_names_serve_the_bench_where_they_are_mapped() -> None:
    """To the channel that the bench measures, or to the bench's own name: that of a column that drives the scene, say."""
    first = quiet()[0]
    mapped = called_otherwise(first, {"motor_angle": ("phi", "motor_encoder"), "speed_reference": ("wanted", "speed_reference")})
    assert "motor_angle" not in mapped.channels
    [plain], [named] = bench().trials(first), bench().trials(as_the_bench_names_them(bench(), mapped))
    assert named.scene == plain.scene
    assert list(named.columns) == list(plain.columns)
    np.testing.assert_array_equal(named.columns["motor_angle"], plain.columns["motor_angle"])
    assert run(given=(mapped, quiet()[1]), kinds=(hm.ViscousDrag,)).warnings == ()


def test_two_columns_for_one_of_the_bench_are_refused() -> None:
    first = called_otherwise(quiet()[0], {"motor_angle": ("phi", "motor_encoder")})
    twice = first.with_channels([*first, first["phi"].replacing(name="phi_2", quantity="motor_angle")])
    with pytest.raises(hm.RecordError, match=r"'phi' and 'phi_2' would both be what the bench calls 'motor_angle'; map one of them"):
        as_the_bench_names_them(bench(), twice)
    both = quiet()[0].with_channels([*quiet()[0], first["phi"].replacing(quantity="motor_angle")])
    with pytest.raises(hm.RecordError, match=r"'phi' and 'motor_angle' would both be"):
        as_the_bench_names_them(bench(), both)


def test_a_column_that_drives_and_is_missing_says_how_another_one_is_mapped() -> None:
    given = (quiet()[0].without("speed_reference"), quiet()[1])
    refused(hm.RecordError, "no column 'speed_reference', which drives the scene", "--channel 'its name'=speed_reference", given=given)


def test_a_column_that_is_spelt_otherwise_than_in_the_bench_is_asked_about() -> None:
    first = quiet()[0]
    given = first.with_channels(item.replacing(name="loadangle") if item.name == "load_angle" else item for item in first)
    [said] = not_compared(bench(), (given,))
    assert said.endswith("Columns there that the bench does not know: loadangle. Did you mean 'loadangle'? Then name both alike.")


def test_a_scene_that_no_column_drives_is_warned_of() -> None:
    """A scene alone takes columns named like its channels; its motor stands still, and the torque column is not used."""
    first = quiet()[0].selecting("motor_torque", "load_angle")
    record = first.with_channels(item.replacing(name="load.angle") if item.name == "load_angle" else item for item in first)
    found = diagnose(bench().scene, record, candidates=(hm.ViscousDrag,), pictures=False, step=1e-3)
    [said] = found.warnings
    assert said.startswith("No column drives the scene, and the model stands still while the records move")
    assert "inputs={'motor_torque': Input(path=" in said
    simulator = Simulator(bench().trials(quiet()[0]), 1e-3)
    assert not_driven(bench(), quiet(), simulator, factors_of(bench())) == ()


def test_a_scene_that_runs_by_a_law_of_its_own_far_from_the_record_is_warned_of() -> None:
    """Its servo follows a reference that the record knows nothing of; where the model is near the record, nothing is said."""
    alone = dataclasses.replace(bench(), inputs={}, scene=bench().scene.replacing({"motor.characteristic.reference": CONSTANT}))
    [said] = not_driven(alone, quiet(), Simulator(alone.trials(quiet()[0]), 1e-3), factors_of(alone), bare=True)
    assert not_driven(alone, quiet(), Simulator(alone.trials(quiet()[0]), 1e-3), factors_of(alone)) == ()  # a bench that says so
    assert said.startswith("No column drives the scene, and the model runs by laws of its own, far from what was measured")
    assert "Columns that are not used: load_torque, speed_reference." in said
    [near] = Simulator(alone.trials(quiet()[0]), 1e-3).columns_at(Hypothesis(factors_of(alone)), [np.zeros(len(factors_of(alone)))])[0]
    [trial] = alone.trials(quiet()[0])
    itself = Simulator([dataclasses.replace(trial, columns=near)], 1e-3)
    assert not_driven(alone, quiet(), itself, factors_of(alone), bare=True) == ()


def test_effects_with_states_of_their_own_can_be_run_on_a_record_of_a_kilohertz() -> None:
    trials = bench().trials(quiet()[0])
    assert trials[0].every == 1e-3
    step = suitable_step(trials, factors_of(bench()))
    assert step == 5e-4
    kinds = [hm.SensorDelay, hm.ActuatorLag, hm.SeriesCompliance, hm.SensorLag]
    simulator = Simulator(trials, step)
    for one in candidates(bench().scene, kinds):
        hypothesis = Hypothesis(factors_of(bench()), one.first[:1])
        assert simulator.residuals(hypothesis, [hypothesis.start()])[0] is not None, one.label


# -- records against the bench ----------------------------------------------------------------------------


def test_a_record_without_an_input_names_it_and_what_there_is() -> None:
    given = (quiet()[0].without("load_torque"),)
    refused(
        hm.RecordError, "'staircase' has no column 'load_torque', which drives the scene", "It was read with: motor_torque", given=given
    )


def test_a_record_without_any_measured_column_is_refused() -> None:
    given = (quiet()[0].without("motor_torque", "motor_angle", "load_angle"),)
    refused(hm.RecordError, "has no column 'motor_torque', which the bench measures", given=given)


def test_a_record_without_one_of_several_measured_columns_is_used() -> None:
    found = run(given=(quiet()[0].without("load_angle"), quiet()[1]))
    assert found.verdict == "none"
    assert ("staircase", "load_angle") not in [(gap.record, gap.column) for gap in found.gaps]


def test_a_column_in_an_impossible_unit_is_refused() -> None:
    wrong = quiet()[0].with_channels(item.replacing(unit="N m" if item.name == "motor_angle" else item.unit) for item in quiet()[0])
    refused(hm.RecordError, "'motor_angle' is in N m, but 'motor_encoder'", "is in rad", "units={'motor_angle':", given=(wrong,))


def test_a_unit_that_does_not_fit_is_quoted_as_it_was_written() -> None:
    first = quiet()[0]
    wrong = first.with_channels(item.replacing(unit="N m", given="kp*cm") if item.name == "motor_angle" else item for item in first)
    refused(hm.RecordError, "'motor_angle' is in 'kp*cm', which is read as N m, but 'motor_encoder', which it measures", given=(wrong,))


def test_an_input_in_an_impossible_unit_is_refused() -> None:
    wrong = quiet()[0].with_channels(item.replacing(unit="1" if item.name == "load_torque" else item.unit) for item in quiet()[0])
    refused(hm.UnitError, "'load_torque' is in no unit (1), but load.torque, which it drives, is in N m", given=(wrong,))


def test_a_record_that_is_too_short_is_refused() -> None:
    refused(hm.RecordError, "has 51 samples; a diagnosis needs at least 64", given=(quiet()[0].between(0.0, 0.05),))


def test_no_records_are_refused() -> None:
    refused(hm.ParameterError, "at least one record", given=())


def test_two_records_of_one_name_are_refused() -> None:
    refused(hm.ParameterError, "Two records are named 'staircase'", "record.replacing(name=", given=(quiet()[0], quiet()[0]))


def test_a_saturated_sensor_is_refused() -> None:
    given = changed("motor_torque", lambda values: np.clip(values, -0.2, 0.2))
    refused(hm.RecordError, "motor_torque", "cut off at its largest value 0.2 N m", "saturated='drop'", given=given)


def test_a_sensor_that_got_stuck_is_refused() -> None:
    def stuck(values: np.ndarray) -> np.ndarray:
        values[700:] = values[700]
        return values

    refused(hm.RecordError, "load_angle", "stands at", "for 901 samples", "stuck='drop'", given=changed("load_angle", stuck))


def test_a_sensor_that_is_dead_all_along_is_refused() -> None:
    given = changed("load_angle", lambda values: np.full_like(values, 0.25))
    refused(hm.RecordError, "'load_angle' shows 0.25 rad all along", "moves by", "record.without('load_angle')", given=given)


def test_records_in_which_nothing_moves_are_refused() -> None:
    rng = np.random.default_rng(4)
    still = quiet()[0]
    for name in ("speed_reference", "load_torque"):
        still = changed(name, np.zeros_like, still)[0]
    for name, sigma in (("motor_torque", 2e-3), ("motor_angle", 2e-4), ("load_angle", 3e-6)):
        still = changed(name, lambda values, size=sigma: size * rng.standard_normal(len(values)), still)[0]
    refused(hm.RecordError, "Nothing moves in 'staircase'", "10 times its noise", "Record a motion", given=(still,))


def test_a_constant_input_is_used_where_others_move() -> None:
    load = quiet()[0]["load_torque"].values
    assert np.ptp(load) == 0.0
    assert run(given=quiet()[:1]).verdict == "none"


def test_missing_values_are_refused_until_somebody_decides() -> None:
    def holes(values: np.ndarray) -> np.ndarray:
        values[300:420] = math.nan
        return values

    given = changed("load_angle", holes)
    refused(hm.RecordError, "load_angle", "120 of 1601 values are missing", "not_finite='interpolate'", given=given)
    kept = (repaired(given[0], not_finite="keep"), *given[1:])
    found = run(given=kept)
    assert found.verdict == "none"
    assert abs(found.gap.refit.value - 1.0) < 0.06


def test_missing_values_of_an_input_cannot_be_kept() -> None:
    def holes(values: np.ndarray) -> np.ndarray:
        values[300:420] = math.nan
        return values

    given = (repaired(changed("load_torque", holes)[0], not_finite="keep"),)
    refused(hm.RecordError, "'load_torque' drives the scene", "120 of its 1601 values", "first at t = 0.3 s", given=given)


def test_a_column_with_hardly_a_value_is_refused() -> None:
    def holes(values: np.ndarray) -> np.ndarray:
        values[12:] = math.nan
        return values

    given = (repaired(changed("load_angle", holes)[0], not_finite="keep"),)
    refused(hm.RecordError, "'load_angle' has 12 values that a fit may see; needed are 16", given=given)


def test_uneven_times_are_refused() -> None:
    first = quiet()[0]
    times = first.times.copy()
    times[800:] += 0.4e-3
    refused(hm.RecordError, "is not sampled evenly", "resample", given=(first.replacing(times=times),))


def test_a_record_that_starts_at_another_speed_is_refused() -> None:
    part = quiet()[0].between(0.6, 1.6)
    refused(hm.RecordError, "'staircase' does not start like the scene", "'motor_angle' begins at", "rad/s", "Bench(speeds=", given=(part,))


def test_a_record_that_starts_at_speed_is_taken_with_its_start_and_one_from_rest_as_it_is() -> None:
    """At 0.55 s the reference of the load cycle has stood at 40 rad/s for a while."""
    [part] = (quiet()[1].between(0.55, DURATION).selecting("motor_angle", "speed_reference", "load_torque"),)
    for speeds, fits in (({}, False), ({"motor": 40.0, "load": 0.8}, True)):
        known = dataclasses.replace(bench(("motor_angle",)), speeds=speeds)
        simulator, factors = Simulator(known.trials(part), 1e-3), factors_of(known)
        if fits:
            check_trials(simulator, factors)
        else:
            with pytest.raises(hm.RecordError, match=r"'motor_angle' begins at (39|40)\."):
                check_trials(simulator, factors)
    check_trials(Simulator(bench().trials(quiet()[1].between(0.02, DURATION)), 1e-3), factors_of(bench()))


# -- the bench itself ------------------------------------------------------------------------------------


def test_knowledge_of_a_path_that_does_not_exist_is_refused() -> None:
    with pytest.raises(hm.PlaceError, match=r"No path of 'J' 'motor\.inertja'.*motor\.inertia"):
        bench(knowledge={"J": ("motor.inertja", 0.03)})


def test_an_input_of_a_path_that_does_not_exist_is_refused() -> None:
    wrong = Input(path="motor.reference", law=lambda t, v: hm.SpeedTable(times=t, speeds=v))
    refused(hm.PlaceError, "motor.reference", found=dataclasses.replace(bench(), inputs={"speed_reference": wrong}))


def test_a_measured_channel_that_does_not_exist_is_refused() -> None:
    with pytest.raises(hm.PlaceError, match=r"channel of column 'motor_angle' 'motor\.angel'"):
        dataclasses.replace(bench(), measured={"motor_angle": Measured(channel="motor.angel", noise=1e-4)})


def test_a_relative_uncertainty_of_zero_is_refused() -> None:
    known = dataclasses.replace(bench(), knowledge={"cubic": Uncertain(paths=("gear.stiffness.cubic",), sigma=0.1)})
    refused(hm.ParameterError, "gear.stiffness.cubic = 0", "no factor changes 0", found=known)


def test_a_parameter_that_is_uncertain_twice_is_refused() -> None:
    twice = {"one": Uncertain(paths=("motor.inertia",), sigma=0.1), "two": Uncertain(paths=("motor.inertia",), sigma=0.2)}
    refused(hm.ParameterError, "motor.inertia is uncertain twice", found=dataclasses.replace(bench(), knowledge=twice))


def test_a_group_of_a_parameter_that_is_not_known_is_refused() -> None:
    known = dataclasses.replace(bench(), together={"masses": ("motor_inertia", "nothing")})
    refused(hm.PlaceError, "parameter of the group 'masses'", "'nothing'", found=known)


def test_a_scene_whose_channels_no_column_bears_is_refused() -> None:
    with pytest.raises(hm.RecordError, match="No column is named like a channel of scene 'small drive'"):
        diagnose(bench().scene, quiet(), pictures=False)


def test_without_uncertain_parameters_and_candidates_the_verdict_is_about_the_scene_as_it_is() -> None:
    exact = dataclasses.replace(bench(), knowledge={})
    assert run(exact, records(errors={})).verdict == "none"
    found = run(exact, quiet())
    assert found.verdict == "unknown"
    assert found.gap.effect.value > 10.0
    assert found.parameters == found.causes == ()


def test_without_candidates_parameters_alone_are_refitted() -> None:
    found = run()
    assert found.verdict == "none"
    assert {item.effect for item in found.ranking} <= {"none", "parameter"}
    assert {item.name for item in found.parameters} == set(KNOWLEDGE)


# -- candidates ------------------------------------------------------------------------------------------


def test_a_candidate_without_a_place_in_the_scene_is_left_out() -> None:
    found = run(kinds=(BearingCubicStiffness, KinematicError), given=quiet())
    assert found.verdict == "none"
    assert "bearing_cubic_stiffness" not in {item.effect for item in found.ranking}


def test_what_is_no_effect_class_is_refused() -> None:
    refused(hm.ParameterError, "is no effect class", kinds=(hm.Motor,))
    refused(hm.ParameterError, "is no effect class", kinds=(KinematicError(amplitude=1e-4),))


@dataclass(frozen=True, kw_only=True)
class _Own(TorqueEffect):
    """An effect of a user's own, tried only where it is named: other tests search the library."""

    tried: ClassVar[bool] = False
    size: float = parameter("N m", "size", low=0.0, typical=(1e-3, 1.0))

    def torque(self, time: Value, angle: Value, speed: Value) -> Value:
        return -self.size * np.tanh(speed)


class PlacesRaise(_Own):
    @classmethod
    def places(cls, network: Network) -> tuple[str, ...]:  # noqa: ARG003
        raise ZeroDivisionError("no bodies")


class ApplyRaises(_Own):
    def apply(self, draft: Draft, place: str, name: str) -> None:
        raise AttributeError("'Draft' object has no attribute 'force'")


class LawRaises(_Own):
    def torque(self, time: Value, angle: Value, speed: Value) -> Value:
        return -self.size if speed > 0.0 else self.size  # type: ignore[operator]


class LawIsNotFinite(_Own):
    def torque(self, time: Value, angle: Value, speed: Value) -> Value:
        return -self.size * np.sqrt(speed - 1e6)


@dataclass(frozen=True, kw_only=True)
class StateIsNotFinite(MemoryTorqueEffect):
    """A state that runs away."""

    size: float = parameter("N m", "size", low=0.0, typical=(1e-3, 1.0))
    family: ClassVar[str] = "runaway"
    tried: ClassVar[bool] = False

    def states(self) -> Mapping[str, str]:
        return {"level": "1"}

    def state_rate(self, name: str, time: Value, angle: Value, speed: Value, state: Mapping[str, Value]) -> Value:
        return 1.0 + 1e3 * state["level"] ** 2

    def torque(self, time: Value, angle: Value, speed: Value, state: Mapping[str, Value]) -> Value:
        return -self.size * state["level"]


class NothingToSearch(TorqueEffect):
    tried: ClassVar[bool] = False

    def torque(self, time: Value, angle: Value, speed: Value) -> Value:
        return 0.0


@pytest.mark.parametrize(
    ("kind", "words"),
    [
        (PlacesRaise, ("PlacesRaise.places raised ZeroDivisionError: no bodies", "leave the class out")),
        (ApplyRaises, ("ApplyRaises at ", "raised AttributeError", "no attribute 'force'")),
        (LawRaises, ("LawRaises at ", "its law raised", "no if, min", "leave the class out")),
        (LawIsNotFinite, ("LawIsNotFinite at ", "not finite", "size=0.001")),
        (StateIsNotFinite, ("StateIsNotFinite at ", "not finite")),
        (NothingToSearch, ("NothingToSearch has nothing to search", "typical=(low, high)")),
    ],
)
def test_an_effect_of_a_users_own_that_cannot_work_is_refused_by_name(kind: type[Effect], words: tuple[str, ...]) -> None:
    refused(hm.ParameterError, *words, kinds=(kind, KinematicError))


def test_an_effect_of_a_users_own_that_works_takes_part_without_registration() -> None:
    found = run(kinds=(_Own,), given=records((_Own(size=0.05), "motor")))
    assert [(cause.effect, cause.at) for cause in found.causes] == [("_own", "motor")]
    assert found.causes[0].parameters[0].value == pytest.approx(0.05, rel=0.01)


class RaisesWhereItIsLarge(_Own):
    """A friction whose law has a fault that the values with which a search begins do not show."""

    def torque(self, time: Value, angle: Value, speed: Value) -> Value:
        if self.size > 0.03:
            raise ZeroDivisionError("no room for so much")
        return super().torque(time, angle, speed)


def test_a_law_that_raises_in_the_search_is_named_and_the_search_goes_on() -> None:
    found = run(kinds=(RaisesWhereItIsLarge, KinematicError), given=records((_Own(size=0.05), "motor")))
    assert found.causes[0].at == "motor"
    assert found.causes[0].parameters[0].value == pytest.approx(0.03, rel=1e-3)  # as far as it can be run
    [said] = [text for text in found.warnings if "A law raised" in text]
    assert "RaisesWhereItIsLarge at motor (TraceError: the law cannot be recorded (ZeroDivisionError: no room for so much))" in said
    assert "passed over" in said
    assert "A law raised at values" in report_text(found)


def test_where_all_candidates_fail_the_answer_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    """A law of the library that overflows with its start values: the search goes on without it."""

    def overflowing(self: TorqueRipple, draft: Draft, place: str, name: str) -> None:
        body = draft.body(place, "TorqueRipple").name
        add_body_torque(self, draft, body, name, lambda moment: np.exp(1e6 * (1.0 + moment.time)) * moment.speed(body))

    monkeypatch.setattr(TorqueRipple, "apply", overflowing)
    found = run(kinds=(TorqueRipple,))
    assert found.verdict == "none"
    assert any("None of the 1 candidates could be run" in note and "torque_ripple at motor" in note for note in found.notes)


def test_a_nominal_scene_that_cannot_be_simulated_is_refused() -> None:
    stiff = bench().scene.replacing({"gear.stiffness.linear": 1.2e13})
    with pytest.raises(hm.AnalysisError, match="nominal scene cannot be simulated through the records"):
        diagnose(dataclasses.replace(bench(), scene=stiff), quiet(), candidates=(), pictures=False, step=STEP)


def test_units_that_a_log_may_be_in_have_the_size_that_pint_gives() -> None:
    for unit, others in OTHERS.items():
        for other, size in others.items():
            assert size == pytest.approx(factor(other, unit, "here"), rel=1e-14)

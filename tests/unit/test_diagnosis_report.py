"""The report of a diagnosis in text and JSON: it says what was found, and what cannot be said."""

from __future__ import annotations

import dataclasses
import json
import math
from pathlib import Path
from typing import Any

import pytest

from hdrive_mbs.diagnosis import readable, sentences
from hdrive_mbs.diagnosis.report_json import VERSION, read_report_json, report_document, write_report_json
from hdrive_mbs.diagnosis.report_text import report_text, write_report
from hdrive_mbs.diagnosis.result import NOWHERE, Diagnosis, DomainBin, Estimate, Place
from hdrive_mbs.diagnosis.unknowns import Factor, Shape, Signed, Strength, Unknown, Vector
from hdrive_mbs.errors import FileFormatError
from hdrive_mbs.scene_file import scene_from_dict
from tests.unit import diagnosis_samples
from tests.unit.diagnosis_samples import NAN, SAMPLES


def test_a_claim_that_leaves_more_than_noise_says_so() -> None:
    found = diagnosis_samples.effect()
    for rest, said in ((1.2, ""), (27.04, "What is claimed leaves 27.0 times the noise: the law is not exact")):
        again = dataclasses.replace(found, gaps=diagnosis_samples.gaps(34.2, 28.1, rest))
        assert sentences.inexact(again).startswith(said)
        assert bool(sentences.inexact(again)) == bool(said)
        assert ("not exact" in report_text(again)) == bool(said)


@pytest.mark.parametrize(
    ("chances", "contradicts"), [((0.99, 0.004), True), ((0.95, 0.05), False), ((0.6, 0.004), False), ((0.004, 0.99), False)]
)
def test_a_claim_that_is_not_exact_says_where_its_place_is_excluded(chances: tuple[float, float], contradicts: bool) -> None:
    """Mesh friction that takes three quarters of a gap at the motor, say, because nothing else was tried."""
    found = SAMPLES["effect"]()
    [cause] = found.causes
    places = sorted(zip(("motor", f"{cause.at}.law"), chances, strict=True), key=lambda item: -item[1])
    where = tuple(Place(at=at, probability=chance, gain=9.0, share=0.5) for at, chance in places)
    again = dataclasses.replace(found, gaps=diagnosis_samples.gaps(34.2, 28.1, 27.04), where=where)
    assert cause.at != "motor"
    assert (f"the gap lies at motor, not at {cause.at}" in sentences.inexact(again)) == contradicts
    assert "the gap lies at" not in sentences.inexact(dataclasses.replace(again, gaps=diagnosis_samples.gaps(34.2, 28.1, 1.01)))


def test_a_place_says_what_explains_the_gap_there() -> None:
    said = [
        sentences.where(Place(at=at, probability=0.5, gain=9.0, share=share, parameter=parameter))
        for at, share, parameter in (("load", 0.48, ""), ("gear", 0.0, "gear stiffness"), (NOWHERE, 0.0, ""))
    ]
    assert said == [
        "load: probability 0.50; an unknown signal there explains 48 % of the gap",
        "gear: probability 0.50; in place of an unknown signal there gear stiffness off beyond its tolerance would do, and with less;"
        " this compares the two alone and is not the verdict",
        "nowhere: probability 0.50; no signal at any place",
    ]


def test_where_nothing_but_noise_is_left_no_place_and_no_range_is_named() -> None:
    found = SAMPLES["effect"]()
    quiet = dataclasses.replace(SAMPLES["none"](), where=found.where, domain=found.domain)
    text = " ".join(report_text(quiet).split())
    assert "What is left is noise by the verdict" in text
    assert "Over speed" not in text
    assert "unknown signal there" not in text
    assert "What is left is noise" not in report_text(SAMPLES["none"]())  # neither was looked for
    assert "Over speed" in report_text(found)


def test_of_places_that_explain_the_same_the_report_says_why_one_wins() -> None:
    places = (Place(at="arm", probability=0.999, gain=99.0, share=0.99995), Place(at="motor", probability=0.001, gain=30.0, share=0.99995))
    found = dataclasses.replace(SAMPLES["effect"](), where=places)
    said = "the likelier is the one that needs less signal for it."
    assert sum(text.endswith(said) for text in sentences.where_sentences(found)) == 1
    assert not any(text.endswith(said) for text in sentences.where_sentences(dataclasses.replace(found, where=places[:1])))


@pytest.mark.parametrize(
    ("chances", "left", "verdict", "first", "said"),
    [
        ((0.905, 0.01), 1.01, "effect", {}, True),
        ((0.905, 0.01), 27.0, "effect", {}, False),
        ((0.6, 0.3), 1.01, "effect", {}, False),
        ((0.01, 0.9), 1.01, "effect", {}, False),
        ((0.905, 0.01), 1.01, "parameter", {}, False),
        ((0.905, 0.01), 1.01, "effect", {"share": 0.2}, False),
        ((0.905, 0.01), 1.01, "effect", {"parameter": "gear stiffness"}, False),
        ((0.905, 0.01), 1.01, "effect", {"tied": ("load.law",)}, False),
    ],
)
def test_a_cause_that_leaves_noise_alone_is_not_refuted_by_the_list_of_places(
    chances: tuple[float, float], left: float, verdict: str, first: dict[str, Any], said: bool
) -> None:
    """Backlash of an output shaft beside the gear's own lost motion: one signal at the gear stands for nearly all of it."""
    found = SAMPLES["effect"]()
    [cause] = found.causes
    assert cause.at == "load"
    places = sorted(zip(("gear", "load.law"), chances, strict=True), key=lambda item: -item[1])
    likeliest, other = (Place(at=at, probability=chance, gain=9.0, share=0.9) for at, chance in places)
    where = (dataclasses.replace(likeliest, **first), other)
    again = dataclasses.replace(found, gaps=diagnosis_samples.gaps(34.2, 28.1, left), where=where, verdict=verdict)
    lines = [text for text in sentences.where_sentences(again) if "leaves noise alone" in text]
    assert [text.startswith(f"What is claimed at {cause.at} leaves") and text.endswith("and at gear it does.") for text in lines] == [
        True
    ] * said


@pytest.mark.parametrize(
    ("sample", "first"),
    [
        ("none", "No gap beyond noise and parameter tolerance. Probability 0.97."),
        ("effect", "An effect is missing from the model: friction at load. Probability 0.93."),
        ("parameter", "A parameter is off by more than its tolerance: parameter load inertia. Probability 0.88."),
        ("sensor", "A sensor is off: sensor gain at torque_sensor. Probability 0.99."),
        ("unknown", "A gap that nothing in the library explains. Probability 0.90."),
        ("two", "Two causes: friction at load and kinematic error at gear. Probability 0.93 and 0.81."),
    ],
)
def test_report_begins_with_the_verdict_in_words(sample: str, first: str) -> None:
    lines = report_text(SAMPLES[sample]()).splitlines()
    assert lines[0] == "Diagnosis of 'drive bench' by 3 records: staircase, load_cycle and sweep"
    assert lines[3] == first


@pytest.mark.parametrize(("sample", "said"), [("effect", "the cause closes"), ("two", "the causes close")])
def test_the_gap_is_told_with_one_cause_or_with_several(sample: str, said: str) -> None:
    text = " ".join(sentences.gap_sentences(SAMPLES[sample]()))
    assert f" {said} " in text
    assert f"with {said.rpartition(' ')[0]} by" in text


def test_two_causes_with_one_probability_are_not_read_as_a_sum() -> None:
    answer = SAMPLES["two"]()
    shared = dataclasses.replace(answer, causes=tuple(dataclasses.replace(cause, probability=0.79) for cause in answer.causes))
    assert "Probability 0.79 of both together." in report_text(shared)


@pytest.mark.parametrize("sample", SAMPLES)
def test_report_has_no_raw_nan_or_infinity_and_no_blank_at_line_ends(sample: str) -> None:
    text = report_text(SAMPLES[sample]())
    assert text.endswith("\n")
    assert not any(line.endswith(" ") for line in text.splitlines())
    words = text.replace("(", " ").replace(")", " ").replace(",", " ").split()
    assert not {"nan", "inf", "-inf", "None"} & set(words)


def test_print_of_a_diagnosis_is_its_report() -> None:
    answer = SAMPLES["effect"]()
    assert str(answer) == report_text(answer)


def test_identified_parameters_have_an_interval_or_are_called_not_identifiable() -> None:
    lines = report_text(SAMPLES["effect"]()).splitlines()
    assert any("friction.coulomb" in line and "6.03 (5.91 to 6.15) N m" in line for line in lines)
    assert any("friction.stiction" in line and "not identifiable from these records" in line for line in lines)


def test_gap_is_told_in_noise_and_in_the_unit_of_its_column() -> None:
    # motor_angle: noise 1.1e-4 rad, so a misfit of 34.2 noise deviations is 3.76 mrad; bounds 0.93 and 1.09 of that
    lines = [line for line in report_text(SAMPLES["effect"]()).splitlines() if line.startswith("  staircase, motor_angle")]
    assert "34.2 (31.8 to 37.3)" in lines[0]
    assert "3.76 (3.50 to 4.10) mrad" in lines[1]


def test_closed_share_is_that_of_the_energy_above_the_noise() -> None:
    answer = SAMPLES["effect"]()
    # 1 - (5.1^2 - 1)/(34.2^2 - 1) and 1 - (1.02^2 - 1)/(34.2^2 - 1)
    assert answer.closed_by_refit == pytest.approx(1.0 - 25.01 / 1168.64, rel=1e-12)
    assert answer.closed == pytest.approx(1.0 - 0.0404 / 1168.64, rel=1e-12)
    assert "refitting alone closes 97 % and the cause closes over 99.99 %" in report_text(answer)


def test_a_nominal_model_at_the_noise_has_nothing_to_close() -> None:
    answer = dataclasses.replace(SAMPLES["none"](), gaps=diagnosis_samples.gaps(0.99, 0.98, 0.98))
    assert math.isnan(answer.closed)
    assert "there is no gap to close" in report_text(answer)


def test_what_cannot_be_told_apart_is_named_once_and_never_the_claim_itself() -> None:
    tied = SAMPLES["tied"]()
    wanted = "These records cannot tell friction at load from hysteresis at gear or friction at output_shaft."
    assert wanted in report_text(tied)
    with_itself = dataclasses.replace(tied, indistinguishable=(("friction", "load"), *tied.indistinguishable))
    assert wanted in report_text(with_itself)
    assert sentences.ambiguity(dataclasses.replace(tied, indistinguishable=(("friction", "load"),))) == ""


def test_next_record_says_whether_it_would_be_enough() -> None:
    text = " ".join(report_text(SAMPLES["tied"]()).split())
    assert "Record 'slow reversals' would tell friction at load from hysteresis at gear (detectability 410; 25 is enough)." in text
    assert "Record 'sweep' would not tell friction at load from hysteresis at gear (detectability 11.0; 25 is needed)." in text


def test_parameters_are_told_in_sigmas_of_their_tolerance_the_furthest_first() -> None:
    estimate = Estimate(name="inertia", unit="kg m^2", doc="", value=2.12, low=2.0, high=2.2, nominal=2.0, tolerance=0.03)
    assert sentences.moved(estimate) == pytest.approx(2.0)  # (value/nominal - 1)/tolerance
    assert math.isnan(sentences.moved(dataclasses.replace(estimate, value=-2.0)))
    moved = sentences.moved_parameters(SAMPLES["effect"]())
    assert [round(abs(z), 6) for _, z in moved] == sorted((round(abs(z), 6) for _, z in moved), reverse=True)
    assert all(abs(z) > 1.0 for _, z in moved)
    assert len(moved) == 8  # of 14, every first and second of four moves by 2.4 and -1.3 sigma


@pytest.mark.parametrize("z", [-12.0, -6.01, -5.99, -1.0, 0.0, 4.0])
def test_sigmas_that_are_told_are_those_that_the_fits_count(z: float) -> None:
    """Also far below the value, where the prior goes over to its logarithm: at 10 % from 6 of them on."""
    factor = Factor(path="motor.inertia", name="inertia", nominal={"motor.inertia": 2.0}, sigma=0.1)
    assert Factor.deviations(factor.values([z])["motor.inertia"] / 2.0, 0.1) == pytest.approx(z, abs=1e-12)


@pytest.mark.parametrize(
    ("unknown", "ends", "within"),
    [
        (Shape("ratio", 0.5, 2.0), [[-3.0], [3.0]], [[-2.9], [0.0], [2.9]]),
        (Factor(path="m", name="m", nominal={"m": 1.0}, sigma=0.05), [[-5.0], [5.0]], [[-4.9], [0.0]]),
        (Strength("size", 0.1, 10.0, 1.0), [[40.0]], [[0.0], [39.0]]),  # a size may well be zero
        (Signed("side", 1.0, -0.9, 0.9), [[-1.764], [1.764]], [[-1.7], [0.0], [1.7]]),
        (Vector("size", "phase", 0.1, 10.0, 1.0), [[40.0, 0.0], [-24.0, 32.0]], [[0.0, 0.0], [24.0, 31.0]]),
    ],
    ids=lambda value: type(value).__name__,
)
def test_a_fit_that_stops_at_an_end_is_known(unknown: Unknown, ends: list[list[float]], within: list[list[float]]) -> None:
    assert all(unknown.at_end(z) for z in ends)
    assert not any(unknown.at_end(z) for z in within)


def test_a_value_at_an_end_is_told_as_one() -> None:
    """A ratio of 0.3536 was an interval like any other, where a fit had ended in a hollow (our own tenth rotor set, c02)."""
    answer = SAMPLES["effect"]()
    [cause] = answer.causes
    first, *rest = cause.parameters
    told = dataclasses.replace(answer, causes=(dataclasses.replace(cause, parameters=(dataclasses.replace(first, at_end=True), *rest)),))
    assert "the end of what a fit may take" not in report_text(answer)
    assert "the end of what a fit may take" in " ".join(report_text(told).split())
    assert report_document(told)["causes"][0]["parameters"][0]["at_end"] is True


def test_every_nominal_parameter_has_its_value_before_and_after() -> None:
    """A dozen fit into the text; of more only those that moved are listed, and the rest are counted."""
    answer = SAMPLES["effect"]()
    lines = report_text(answer).splitlines()
    start = lines.index("Nominal parameters")
    table = "\n".join(lines[start : lines.index("", start + 3)])
    assert all(f"  {item.name} " in table for item in answer.parameters)
    assert "refitted (95 % interval)" in table
    assert "a value known to 10 % that halves has moved by (0.5 - 1)/0.1 = -5 sigma" in " ".join(table.split())
    many = dataclasses.replace(
        answer, parameters=tuple(dataclasses.replace(p, name=f"{p.name}_{k}") for k in "ab" for p in answer.parameters)
    )
    text = report_text(many)
    moved = [item for item, _ in sentences.moved_parameters(many)]
    assert f"  {28 - len(moved)} more moved by less than 1 sigma; diagnosis.json has them all under 'parameters'" in text


def test_a_parameter_far_off_that_is_not_claimed_stands_beside_the_verdict() -> None:
    answer = SAMPLES["none"]()
    far = dataclasses.replace(answer.parameters[0], name="motor_inertia", nominal=2.0, value=2.0 * (1.0 - 0.17), tolerance=0.05)
    off = dataclasses.replace(answer, parameters=(far, *answer.parameters[1:]))
    said = "The fit moved motor inertia by -3.4 sigma of its tolerance, which the verdict does not claim"
    assert report_text(off).splitlines()[4].startswith(said)
    assert sentences.strained(answer) == ""
    claimed = dataclasses.replace(off, causes=(dataclasses.replace(SAMPLES["parameter"]().causes[0], parameters=(far,)),))
    assert sentences.strained(claimed) == ""


def test_domain_names_the_part_that_holds_more_than_its_share() -> None:
    said = sentences.domain_sentences(SAMPLES["effect"]().domain)
    # of eight equal bins with 12, 5, 2, 1, 0.5, 0.3, 0.1 the first holds 12/20.9 = 57 %
    assert said[0].startswith("Over speed: largest 0 to 20 rad/s, where 12 % of the samples hold 57 % of the misfit")
    assert said[2].startswith("Over order: largest order 2,")


def test_domain_without_a_preference_is_called_even() -> None:
    bins = [DomainBin(over="time", unit="s", low=float(k), high=k + 1.0, excess=3.0 + 0.1 * k, after=NAN, samples=100) for k in range(4)]
    assert sentences.domain_sentences(bins)[0].startswith("Over time: spread evenly")
    none = [dataclasses.replace(item, excess=-0.01) for item in bins]
    assert sentences.domain_sentences(none) == ("Over time: nothing above the noise.",)


@pytest.mark.parametrize(
    ("value", "low", "high", "unit", "text"),
    [
        (2.0312, 1.98, 2.08, "N m", "2.03 (1.98 to 2.08) N m"),
        (3.1e-4, 3.0e-4, 3.3e-4, "rad", "0.310 (0.300 to 0.330) mrad"),
        (4.2e-5, 4.1e-5, 4.4e-5, "m", "42.0 (41.0 to 44.0) um"),
        (30776.0, 30500.0, 31054.0, "N m/rad", "30780 (30500 to 31050) N m/rad"),
        (2.0e-5, 1.9e-5, 2.1e-5, "kg m", "2.00e-05 (1.90e-05 to 2.10e-05) kg m"),
        (5.0, NAN, NAN, "1", "5.000 (no interval)"),
        (NAN, NAN, NAN, "N m", "-"),
        (0.0, 0.0, 0.0, "N m", "0 (0 to 0) N m"),
    ],
)
def test_intervals_have_as_many_digits_as_they_allow(value: float, low: float, high: float, unit: str, text: str) -> None:
    assert readable.interval(value, low, high, unit) == text


def test_neither_shares_nor_probabilities_are_rounded_to_certainty() -> None:
    assert readable.percent(0.99999) == "over 99.99 %"
    assert readable.percent(0.9996) == "99.96 %"
    assert readable.percent(1.0) == "100 %"
    assert readable.percent(0.004) == "under 1 %"
    assert readable.percent(0.0) == "0 %"
    assert readable.probability(0.9999) == "> 0.99"
    assert readable.probability(1.0) == "> 0.99"
    assert readable.probability(1e-6) == "< 0.01"


def test_text_file_holds_the_report(tmp_path: Path) -> None:
    answer = SAMPLES["two"]()
    assert write_report(answer, tmp_path / "a" / "d.txt").read_text("utf-8") == report_text(answer)


@pytest.mark.parametrize(("sample", "series"), [*((name, False) for name in SAMPLES), ("two", True)])
def test_json_is_strict_and_comes_back_as_written(sample: str, series: bool, tmp_path: Path) -> None:
    answer = SAMPLES[sample]()
    path = write_report_json(answer, tmp_path / "d.json", series=series)

    def refused(text: str) -> Any:
        raise AssertionError(f"{text} is no JSON")

    json.loads(path.read_text("utf-8"), parse_constant=refused)
    found = read_report_json(path)
    assert found == report_document(answer, series=series)
    assert series == ("traces" in found)
    assert found["verdict"] == answer.verdict
    assert found["schema_version"] == VERSION
    assert len(found["ranking"]) == len(answer.ranking)


def test_json_keeps_every_digit_and_the_scene(tmp_path: Path) -> None:
    answer = SAMPLES["effect"]()
    found = read_report_json(write_report_json(answer, tmp_path / "d.json"))
    assert found["causes"][0]["parameters"][2]["value"] == 0.021
    assert found["gaps"][1]["in_unit"]["nominal"]["value"] == 1.1e-4 * 34.2
    assert found["parameters"][0]["moved_sigmas"] == pytest.approx(2.4)
    assert scene_from_dict(found["improved_scene"]) == answer.improved
    assert scene_from_dict(found["nominal_scene"]) == answer.scene


def test_json_writes_null_for_what_is_not_a_number() -> None:
    found = report_document(SAMPLES["without_numbers"]())
    assert found["causes"][0]["probability"] is None
    assert found["causes"][0]["parameters"][0]["high"] is None
    assert found["gaps"][0]["refit"] == {"value": None, "low": None, "high": None}


def test_a_report_that_was_changed_is_refused_and_can_be_read_on_request(tmp_path: Path) -> None:
    path = write_report_json(SAMPLES["effect"](), tmp_path / "d.json")
    path.write_text(path.read_text("utf-8").replace('"verdict": "effect"', '"verdict": "none"'), "utf-8")
    with pytest.raises(FileFormatError, match=r"checksum does not fit.*verify=False"):
        read_report_json(path)
    assert read_report_json(path, verify=False)["verdict"] == "none"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("{", "cannot be parsed"),
        ("[]", "is no report of a diagnosis"),
        ('{"schema": "other"}', "is no report of a diagnosis"),
        ('{"schema": "hdrive-mbs diagnosis", "schema_version": 99}', "reads up to 1. Install a later"),
        ('{"schema": "hdrive-mbs diagnosis"}', "schema_version None"),
    ],
)
def test_a_file_that_is_no_report_is_refused(text: str, words: str, tmp_path: Path) -> None:
    (tmp_path / "d.json").write_text(text)
    with pytest.raises(FileFormatError, match=words):
        read_report_json(tmp_path / "d.json")


def test_a_missing_report_is_named(tmp_path: Path) -> None:
    with pytest.raises(FileFormatError, match=r"none\.json: cannot be read"):
        read_report_json(tmp_path / "none.json")


def test_a_failed_write_leaves_the_older_report(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = write_report_json(SAMPLES["effect"](), tmp_path / "d.json")
    before = path.read_bytes()

    def broken(*given: object) -> None:
        raise OSError("disc full")

    monkeypatch.setattr("os.replace", broken)
    with pytest.raises(FileFormatError, match=r"d\.json"):
        write_report_json(SAMPLES["none"](), path)
    assert path.read_bytes() == before
    assert [item.name for item in tmp_path.iterdir()] == ["d.json"]


def test_reports_do_not_depend_on_the_order_in_which_samples_are_made() -> None:
    answer: Diagnosis = SAMPLES["effect"]()
    assert report_text(answer) == report_text(SAMPLES["effect"]())

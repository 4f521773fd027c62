"""How often the diagnosis is right, as the documentation says it: the committed results of the sealed sets."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest

from benchmarks.withheld.calibration import expected_error
from benchmarks.withheld.case_score import interval
from hdrive_mbs.diagnosis import nearly, second_cause, unevenness, verdict

ROOT = Path(__file__).parents[2]
OWN = ROOT / "benchmarks" / "withheld" / "own"
ENDINGS = {1: "st", 2: "nd", 3: "rd"}
ORDINALS = {f"{number}{'th' if 10 <= number % 100 <= 20 else ENDINGS.get(number % 10, 'th')}": number for number in range(2, 100)}
Row = tuple[str, str, str]


def rows(file: Path) -> list[Row]:
    """Bench, number and the rest of each row of a table of sets."""
    return re.findall(r"^\| (drive|rotor) bench, (\S+) \| (.*) \|$", file.read_text("utf-8"), re.MULTILINE)


ROWS = rows(OWN / "README.md")


def share(found: dict[str, Any]) -> str:
    return f"{found['right']} of {found['of']}"


@pytest.mark.parametrize(("bench", "which", "row"), ROWS)
def test_a_row_of_the_documentation_holds_what_the_set_gave(bench: str, which: str, row: str) -> None:
    results = json.loads((OWN / f"{bench}_{ORDINALS[which]}" / "results.json").read_text("utf-8"))
    found = results["methods"]["diagnosis"]
    cases, right, place, nulls, unknown = row.split(" | ")
    effect = found["effect right"]
    low, high = interval(effect["right"], effect["of"])
    assert int(cases) == effect["of"] == len(results["cases"])
    assert right == f"{effect['right']} ({low:.2f} to {high:.2f})"
    assert [place, nulls, unknown] == [share(found[name]) for name in ("place right", "nulls kept", "unknown caught")]


@pytest.mark.parametrize("bench", ["drive", "rotor"])
def test_the_last_four_sets_together_are_the_sums_of_theirs(bench: str) -> None:
    text = (ROOT / "docs" / "diagnosis.md").read_text("utf-8")
    [told] = re.findall(rf"^The last four sets of the {bench} bench together: (.+)\.$", text, re.MULTILINE)
    numbers = sorted(int(path.parent.name.partition("_")[2]) for path in OWN.glob(f"{bench}_[0-9]*/results.json"))[-4:]
    methods = [json.loads((OWN / f"{bench}_{number}" / "results.json").read_text("utf-8"))["methods"]["diagnosis"] for number in numbers]

    def together(name: str) -> tuple[int, int]:
        return sum(found[name]["right"] for found in methods), sum(found[name]["of"] for found in methods)

    def with_interval(name: str) -> str:
        low, high = interval(*together(name))
        return "{} of {} ({:.2f} to {:.2f})".format(*together(name), low, high)

    pairs = "{} of {}".format(*together("both of two"))
    assert told == f"cause right in {with_interval('effect right')}, place right in {with_interval('place right')}, both of two in {pairs}"


def test_the_sets_since_a_method_are_told_as_they_came_out() -> None:
    text = (ROOT / "docs" / "diagnosis.md").read_text("utf-8")
    [(sets, told)] = re.findall(r"^Both benches, .+ answered by 04cb5ea or later, .+ \((.+)\): (cause .+)\.$", text, re.MULTILINE)
    named = {bench: list(range(int(first), int(last) + 1)) for bench, first, last in re.findall(r"(drive|rotor) (\d+) to (\d+)", sets)}
    there = {bench: sorted(int(path.parent.name.partition("_")[2]) for path in OWN.glob(f"{bench}_[0-9]*/results.json")) for bench in named}
    assert named == {bench: [number for number in there[bench] if number >= first] for bench, first in (("drive", 29), ("rotor", 31))}
    names = [f"{bench}_{number}" for bench, numbers in named.items() for number in numbers]
    results = [json.loads((OWN / name / "results.json").read_text("utf-8")) for name in names]
    methods, cases = [item["methods"]["diagnosis"] for item in results], [case for item in results for case in item["cases"]]

    def counted(name: str, *, bounds: bool = False) -> str:
        right, of = sum(found[name]["right"] for found in methods), sum(found[name]["of"] for found in methods)
        low, high = interval(right, of)
        return f"{right} of {of} ({low:.2f} to {high:.2f})" if bounds else f"{right} of {of}"

    first = f"cause right in {counted('effect right', bounds=True)}, place right in {counted('place right', bounds=True)}"
    more = f"both of two in {counted('both of two')}, nulls kept in {counted('nulls kept')}"
    error = expected_error([case["confidence"] for case in cases], [case["effect"] for case in cases])
    unknown = f'no known cause answered "unknown" in {counted("unknown caught")}'
    assert told == f"{first}, {more}, {unknown}; calibration error of all {len(cases)} together {error:.3f}"


def test_the_nulls_of_their_own_are_told_as_they_came_out() -> None:
    text = (ROOT / "docs" / "diagnosis.md").read_text("utf-8")
    [told] = re.findall(r"^Nulls of their own, .+: (.+)\.$", text, re.MULTILINE)
    kept = [
        json.loads((OWN / f"{bench}_nulls" / "results.json").read_text("utf-8"))["methods"]["diagnosis"]["nulls kept"]
        for bench in ("drive", "rotor")
    ]
    kept.append({name: kept[0][name] + kept[1][name] for name in ("right", "of")})
    drive, rotor, both = ("{} ({:.2f} to {:.2f})".format(share(found), *interval(found["right"], found["of"])) for found in kept)
    drive, rotor = (words.replace(" (", f"{{}} on the {bench} bench (") for words, bench in ((drive, "drive"), (rotor, "rotor")))
    assert told == f"{drive.format(' kept')} and {rotor.format('')}, together {both}"


def test_the_pairs_of_their_own_are_told_as_they_came_out() -> None:
    text = (ROOT / "docs" / "diagnosis.md").read_text("utf-8")
    [told] = re.findall(r"^Pairs of their own on the drive bench, .+: both causes right in (.+)\.$", text, re.MULTILINE)
    both = json.loads((OWN / "drive_pairs" / "results.json").read_text("utf-8"))["methods"]["diagnosis"]["both of two"]
    assert told == "{} ({:.2f} to {:.2f})".format(share(both), *interval(both["right"], both["of"]))


def test_the_causes_without_a_name_of_their_own_are_told_as_they_came_out() -> None:
    text = (ROOT / "docs" / "diagnosis.md").read_text("utf-8")
    [told] = re.findall(r"^Causes without a name of their own on the drive bench, .+: (.+)\.$", text, re.MULTILINE)
    found = json.loads((OWN / "drive_unlisted" / "results.json").read_text("utf-8"))["methods"]["diagnosis"]
    caught, place = (
        "{} ({:.2f} to {:.2f})".format(share(found[name]), *interval(found[name]["right"], found[name]["of"]))
        for name in ("unknown caught", "place right")
    )
    assert told == f'answered "unknown" in {caught}, at the right place in {place}'


def test_the_share_of_an_oracle_is_told_as_it_came_out() -> None:
    """Of drive sets without a gap, and of none that came later and is not told."""
    text = (ROOT / "docs" / "diagnosis.md").read_text("utf-8")
    [(first, last, told)] = re.findall(r"^Beside an oracle .+ drive sets (\d+) to (\d+): within 10 % in (.+)\.$", text, re.MULTILINE)
    later = [path for path in OWN.glob("drive_[0-9]*/results.json") if int(path.parent.name.partition("_")[2]) > int(last)]
    assert not any(json.loads(path.read_text("utf-8"))["oracle"] for path in later)
    oracles = [
        json.loads((OWN / f"drive_{number}" / "results.json").read_text("utf-8"))["oracle"] for number in range(int(first), int(last) + 1)
    ]
    within, cases = sum(found["within"] for found in oracles), sum(found["cases"] for found in oracles)
    assert told == "{} of {} ({:.2f} to {:.2f})".format(within, cases, *interval(within, cases))


def test_the_share_of_an_oracle_on_the_rotor_bench_is_told_of_every_set_it_was_run_on() -> None:
    text = (ROOT / "docs" / "diagnosis.md").read_text("utf-8")
    [(sets, told)] = re.findall(r"^In the rotor sets it was run on \((.+)\): within 10 % in (.+)\.$", text, re.MULTILINE)
    oracles = {
        int(path.parent.name.partition("_")[2]): found
        for path in OWN.glob("rotor_[0-9]*/results.json")
        if (found := json.loads(path.read_text("utf-8"))["oracle"])
    }
    assert [int(number) for number in sets.split(", ")] == sorted(oracles)
    within, cases = (sum(found[name] for found in oracles.values()) for name in ("within", "cases"))
    assert told == "{} of {} ({:.2f} to {:.2f})".format(within, cases, *interval(within, cases))


def test_the_user_is_told_of_the_last_four_sets_of_each_bench() -> None:
    told = rows(ROOT / "docs" / "diagnosis.md")
    for bench in ("drive", "rotor"):
        last = sorted((ORDINALS[row[1]], row) for row in ROWS if row[0] == bench)[:-5:-1]
        assert [row for row in told if row[0] == bench] == [row for _, row in last]


def test_the_table_leaves_out_no_set_since_the_first_it_names() -> None:
    """Of each bench the last ones without a gap: none that went badly is passed over."""
    for bench in ("drive", "rotor"):
        told = sorted(ORDINALS[which] for name, which, _ in ROWS if name == bench)
        there = [int(path.parent.name.partition("_")[2]) for path in OWN.glob(f"{bench}_[0-9]*/results.json")]
        assert told == list(range(min(told), max(there) + 1))


def test_the_figures_of_the_verdict_are_those_of_the_program() -> None:
    """The table of docs/diagnosis.md, row by row."""
    table = (ROOT / "docs" / "diagnosis.md").read_text("utf-8")
    rows = dict(re.findall(r"^\| (.+?) \| (.+) \|$", table, re.MULTILINE))
    rest = f"of the logarithm of the rest or {verdict.COMPARABLE:.0%} of the first one's log odds".replace("%", " %")
    told = {
        "the refitted model counts as noise up to": f"{verdict.CLEAN}",
        "... if of it there stands in stretches above the rest at most": f"{unevenness.EVEN}",
        "log odds that an effect needs, a parameter": f"{verdict.ODDS:g}, {verdict.PARAMETER_ODDS:g}",
        "what an effect has to take away at least": f"{verdict.TRACE}",
        "a claim has to take of the gap's logarithm, or a single cause of the gap itself": f"{verdict.EXPLAINED:.0%}, {verdict.LARGE:.0%}",
        "a second cause is looked for where the best leaves more than": (
            f"{second_cause.SLIGHT}, of fewer than {2.0 * (second_cause.SCATTER / (second_cause.SLIGHT - 1.0)) ** 2:,.0f} samples more,"
            f" up to {second_cause.LEFT:.2f}"
        ),
        "... and is claimed with log odds over the first of": f"{verdict.SECOND:g}, and {100 * verdict.MORE:g} % {rest}",
        "two causes cannot be told apart within log odds of, or single ones within mean squares of": f"{verdict.TIED:g}, {verdict.ALIKE}",
    }
    for name, value in told.items():
        assert rows[name].replace(" %", "%") == value.replace(" %", "%"), name
    little = (
        f"... of a rest of at most {verdict.LITTLE:.2f} (more beside a gap of more than {verdict.LITTLE ** (1.0 / nearly.SMALL):.0f}:"
        f" its power {nearly.SMALL}, {nearly.nearly_right(1000.0):.2f} at 1000)"
    )
    most = f"{verdict.MOST:.0%} of the logarithm of the rest, and of one family with the first {verdict.COMPARABLE:.0%} of its log odds"
    assert rows[little] == f"{verdict.SECOND:g}, and {most}".replace("%", " %")

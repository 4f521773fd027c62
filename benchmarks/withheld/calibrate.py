"""Choosing the constants of the verdict on an open set: ``python -m benchmarks.withheld.calibrate RAW TRUTHS [RAW TRUTHS ...]``.

RAW is a folder answers.raw as the runner writes it, TRUTHS a folder with CASE/truth.json or a file of open_labels.  The
verdict of hdrive_mbs/diagnosis/verdict.py is drawn again from the stored figures, with one constant changed at a time:
how many are right, nulls kept, unknown caught, both of two.  Then the temperature is fitted so that probabilities mean
what they say, with its error on cases left out.  --set NAME=VALUE starts from other constants; --try A,B looks at two
constants side by side.  Never for a set that is to count.
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.withheld.answer import answer_of
from benchmarks.withheld.calibration import chance_error, expected_error, log_loss
from benchmarks.withheld.case_score import Row, score, shares
from benchmarks.withheld.names import names_of
from benchmarks.withheld.raw import constants, finding_again
from benchmarks.withheld.truths import read_truths
from benchmarks.writing import table
from hdrive_mbs.diagnosis import verdict

FACTORS = (0.25, 0.4, 0.6, 0.8, 1.0, 1.25, 1.6, 2.5, 4.0)
"""Times a constant (its excess over 1 where it is a mean square, its distance to 1 where it is a share) that is tried."""
TEMPERATURES = tuple(float(value) for value in np.geomspace(0.5, 400.0, 60))
SHOWN = ("effect right", "verdict right", "place right", "nulls kept", "unknown caught", "wrongly unknown", "both of two")


@dataclass(frozen=True, kw_only=True)
class Stored:
    """Raw figures of a case and its opened truth."""

    raw: Mapping[str, Any]
    labels: Mapping[str, Any]


def main(arguments: Sequence[str] | None = None) -> int:
    """Report; returns 0."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.withheld.calibrate", description="Constants of the verdict.")
    parser.add_argument("sets", type=Path, nargs="+", metavar="RAW TRUTHS")
    parser.add_argument("--set", action="append", default=[], metavar="NAME=VALUE", help="start from another value (several times)")
    parser.add_argument("--try", dest="tried", default="", metavar="A,B", help="two constants side by side")
    options = parser.parse_args(arguments)
    if len(options.sets) % 2:
        parser.error("give pairs: a folder of raw figures, then its truths")
    cases = [case for raw, truths in zip(options.sets[::2], options.sets[1::2], strict=True) for case in stored(raw, truths)]
    if not cases:
        parser.error("no case has both raw figures and a truth")
    given = {name: float(value) for name, value in (item.split("=", 1) for item in options.set)}
    with constants(**given):
        print(report(cases))
        if options.tried:
            first, second = options.tried.split(",")
            print(side_by_side(cases, first, second))
    return 0


def stored(raw: Path, truths: Path) -> list[Stored]:
    """Cases with figures and truth; those that failed are left out."""
    labels = read_truths(truths)
    found = []
    for path in sorted(raw.glob("*.json")):
        figures = json.loads(path.read_text(encoding="utf-8"))
        if "singles" in figures and figures["case"] in labels:
            found.append(Stored(raw=figures, labels=labels[figures["case"]]))
    return found


def rows_with(cases: Iterable[Stored], **values: float) -> list[Row]:
    """Scores of the answers that the verdict gives with other constants."""
    with constants(**values):
        return [
            score(case.raw["case"], case.labels, answer_of(case.raw["case"], finding_again(case.raw), names_of(case.raw["bench"])))
            for case in cases
        ]


def known_constants() -> dict[str, float]:
    """Constants of the verdict by name."""
    return {name: value for name, value in vars(verdict).items() if name.isupper() and isinstance(value, float)}


SMALL = 0.01
"""Constants below it are no shares of something whole."""


def grid(value: float) -> list[float]:
    """Values to try about a constant: of a share below 1 its distance to 1 is scaled, of a mean square its excess over 1.

    A logarithm of odds, which may have any sign but is 0 or less here, is moved; a small part of a mean square is scaled itself.
    """
    if value <= 0.0:
        return [value + move for move in (-2.0, -1.0, 0.0, 1.0, 2.0)]
    if value < SMALL:
        return [float(f"{value * factor:.4g}") for factor in FACTORS]
    if value < 1.0:
        return sorted({round(1.0 - (1.0 - value) * factor, 4) for factor in FACTORS if (1.0 - value) * factor < 1.0})
    if value < 2.0:
        return [round(1.0 + (value - 1.0) * factor, 4) for factor in FACTORS]
    return [round(value * factor, 4) for factor in FACTORS]


def report(cases: Sequence[Stored]) -> str:
    """Text: the constants at hand, each varied, and the temperature."""
    parts = [f"# {len(cases)} cases with the constants at hand", _lines([("at hand", rows_with(cases))])]
    for name, value in known_constants().items():
        tried = [(f"{other:g}" + (" (at hand)" if other == value else ""), rows_with(cases, **{name: other})) for other in grid(value)]
        parts += [f"## {name}", _lines(tried)]
    parts += ["## Temperature", temperature_report(cases), "## Wrong with the constants at hand", _wrong(cases)]
    return "\n\n".join(parts)


def _lines(tried: Sequence[tuple[str, Sequence[Row]]]) -> str:
    lines = []
    for words, rows in tried:
        found = shares(rows)
        counts = (f"{found[name].right}/{found[name].of}" for name in SHOWN)
        lines.append((words, *counts, f"{expected_error(*_sure(rows)):.3f}", f"{log_loss(*_sure(rows)):.3f}"))
    return table(("", *SHOWN, "calibration error", "log loss"), lines)


def _sure(rows: Sequence[Row]) -> tuple[list[float], list[bool]]:
    return [row.confidence for row in rows], [row.effect for row in rows]


def temperature_report(cases: Sequence[Stored]) -> str:
    """The temperature with the least log loss of the answers' own probabilities, and what it gives on cases left out."""
    by = {value: _sure(rows_with(cases, TEMPERATURE=value)) for value in TEMPERATURES}
    best = _least(by, range(len(cases)))
    left_out = []
    for k in range(len(cases)):
        chosen = _least(by, [other for other in range(len(cases)) if other != k])
        left_out.append((by[chosen][0][k], by[chosen][1][k]))
    sure, right = [item[0] for item in left_out], [item[1] for item in left_out]
    now = _sure(rows_with(cases))
    lines = [
        (f"{verdict.TEMPERATURE:g} (at hand)", f"{log_loss(*now):.3f}", f"{expected_error(*now):.3f}", f"{chance_error(now[0]):.3f}"),
        (f"{best:.3g} (fitted)", f"{log_loss(*by[best]):.3f}", f"{expected_error(*by[best]):.3f}", f"{chance_error(by[best][0]):.3f}"),
        (
            "fitted without the case itself",
            f"{log_loss(sure, right):.3f}",
            f"{expected_error(sure, right):.3f}",
            f"{chance_error(sure):.3f}",
        ),
    ]
    mean, share = float(np.mean(by[best][0])), float(np.mean(by[best][1]))
    text = table(("TEMPERATURE", "log loss", "calibration error", "that of perfect probabilities"), lines)
    return f"{text}\n\nMean probability said {mean:.3f} at {best:.3g}, share right {share:.3f}."


def _least(by: Mapping[float, tuple[list[float], list[bool]]], cases: Iterable[int]) -> float:
    own = list(cases)
    return min(by, key=lambda value: log_loss([by[value][0][k] for k in own], [by[value][1][k] for k in own]))


def side_by_side(cases: Sequence[Stored], first: str, second: str) -> str:
    """Cases right over two constants."""
    values = known_constants()
    others = grid(values[second])
    lines = []
    for one in grid(values[first]):
        right = [sum(row.effect for row in rows_with(cases, **{first: one, second: other})) for other in others]
        lines.append((f"{one:g}", *map(str, right)))
    return f"## Right over {first} (down) and {second} (across), of {len(cases)}\n\n" + table((first, *(f"{o:g}" for o in others)), lines)


def _wrong(cases: Sequence[Stored]) -> str:
    lines = []
    for case, row in zip(cases, rows_with(cases), strict=True):
        if row.effect:
            continue
        raw = case.raw
        best = ", ".join(f"{' at '.join(i['label'])} {i['log_odds']:.0f} ({i['fit']:.3f}/{i['held']:.3f})" for i in raw["singles"][:3])
        pair = ", ".join(f"+ {' at '.join(item['label'])} {item['log_odds']:.0f} ({item['held']:.3f})" for item in raw["pairs"])
        truth = " + ".join(f"{name} at {at}" for name, at in row.truth) or "none"
        said = " + ".join(f"{name} at {at}" for name, at in row.claim) or row.said
        lines.append((row.case, truth, said, f"{raw['null']['fit']:.3f}/{raw['null']['held']:.3f}", best, pair))
    return table(("case", "truth", "answer", "null fit/held", "singles: log odds (fit/held)", "pair"), lines)


if __name__ == "__main__":
    sys.exit(main())

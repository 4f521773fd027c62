"""Scores answers on opened truths: ``python -m benchmarks.withheld.scoring ANSWERS TRUTHS --out FOLDER``.

TRUTHS is a file of open_labels, or a folder with CASE/truth.json.  Writes results.md, results.json and two pictures.
Further answers of the same set: --oracle FILE (method "oracle"), --baseline NAME=FILE (several times).
"""

from __future__ import annotations

import argparse
import contextlib
import importlib.util
import io
import json
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from statistics import median
from typing import Any

from benchmarks.withheld.case_score import Row, medians, score, shares
from benchmarks.withheld.run import read_answers
from benchmarks.withheld.score_pictures import calibration_figure, detectability_figure
from benchmarks.withheld.score_report import report
from benchmarks.withheld.truths import read_truths
from benchmarks.writing import write_results

SHARED = Path(__file__).parents[3] / "shared" / "withheld" / "score.py"
"""The scoring of round 1, beside the project; the comparison is left out where it is missing."""
CLOSE = 1.10
"""Held-out gap over that of an oracle up to which it counts as reached."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Score; returns 0, or 1 for files that cannot be read."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.withheld.scoring", description="Scores answers on opened truths.")
    parser.add_argument("answers", type=Path)
    parser.add_argument("truths", type=Path)
    parser.add_argument("--out", type=Path, required=True, help="folder for results.md, results.json and pictures")
    parser.add_argument("--oracle", type=Path, help="answers of the method oracle")
    parser.add_argument("--baseline", action="append", default=[], metavar="NAME=FILE", help="answers of another method")
    options = parser.parse_args(arguments)
    if nameless := [item for item in options.baseline if not all(item.partition("="))]:
        parser.error(f"--baseline {nameless[0]}: give it as NAME=FILE")
    baselines = dict(item.split("=", 1) for item in options.baseline)
    try:
        truths = read_truths(options.truths)
        answers = {"diagnosis": answers_to(truths, options.answers)}
        answers |= {name: answers_to(truths, Path(path)) for name, path in baselines.items()}
        oracle = answers_to(truths, options.oracle) if options.oracle else {}
    except (OSError, ValueError) as error:
        print(error, file=sys.stderr)
        return 1
    rows = {name: rows_of(truths, given) for name, given in answers.items()}
    against = against_oracle(rows["diagnosis"], oracle)
    shared = shared_lines(options.answers, options.truths)
    text = report(rows, against, shared)
    numbers = {
        "methods": {name: summary(found) for name, found in rows.items()},
        "oracle": against,
        "score.py": shared,
        "cases": [vars(row) for row in rows["diagnosis"]],
    }
    figures = {"calibration": calibration_figure(rows["diagnosis"]), "detectability": detectability_figure(rows["diagnosis"])}
    write_results(options.out, numbers, text, figures)
    print(text.split("\n## ")[0])
    return 0


def answers_to(truths: Mapping[str, Mapping[str, Any]], path: Path) -> dict[str, dict[str, Any]]:
    """Answers of a file, by case.  A case without an answer counts as wrong, but a file without any is another one than was meant.

    Raises FileNotFoundError where there is no file, ValueError where it answers none of the cases.
    """
    if not path.is_file():
        raise FileNotFoundError(f"{path}: no such file; answers are made with python -m benchmarks.withheld.run --out {path}.")
    answers = read_answers(path)
    if not truths.keys() & answers.keys():
        raise ValueError(f"{path} answers none of the {len(truths)} cases, {', '.join(sorted(truths)[:3])} and so on: another set's?")
    return answers


def rows_of(truths: Mapping[str, Mapping[str, Any]], answers: Mapping[str, Mapping[str, Any]]) -> list[Row]:
    """Scores of every case that has a truth."""
    return [score(case, labels, answers.get(case)) for case, labels in sorted(truths.items())]


def summary(rows: Sequence[Row]) -> dict[str, Any]:
    """Counts and means as plain data."""
    return {name: {"right": item.right, "of": item.of} for name, item in shares(rows).items()} | medians(rows)


def against_oracle(rows: Sequence[Row], oracle: Mapping[str, Mapping[str, Any]]) -> dict[str, Any]:
    """Held-out gap over that of a fit which knows the cause, where both are there and the oracle knows one."""
    ratios = {}
    for row in rows:
        known = oracle.get(row.case, {}).get("gap", {}).get("effect")
        if row.gap is not None and known and row.kind in ("effect", "parameter", "sensor"):
            ratios[row.case] = row.gap["effect"] / max(known, row.gap["floor"])
    if not ratios:
        return {}
    return {"cases": len(ratios), "median": median(ratios.values()), "within": sum(v <= CLOSE for v in ratios.values()), "ratios": ratios}


def shared_lines(answers: Path, truths: Path) -> list[str]:
    """What the scoring of round 1 prints on these files; empty where it is not there."""
    if not SHARED.exists():
        return []
    return shared_score(answers, truths)[1].strip().splitlines()


def shared_score(answers: Path, truths: Path) -> tuple[dict[str, Any], str]:
    """Its summary and what it prints.  It is loaded by its path."""
    spec = importlib.util.spec_from_file_location("withheld_round_1_score", SHARED)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    said = io.StringIO()
    with contextlib.redirect_stdout(said):
        found = module.main([str(answers), str(truths)])
    return dict(json.loads(json.dumps(found))), said.getvalue()


if __name__ == "__main__":
    sys.exit(main())

"""The report in plain text, for a terminal, a file or a mail."""

from __future__ import annotations

import os
import textwrap
from collections.abc import Iterator, Sequence
from pathlib import Path

from hdrive_mbs.diagnosis import report_rows, sentences
from hdrive_mbs.diagnosis.improved_words import improved_words
from hdrive_mbs.diagnosis.readable import probability
from hdrive_mbs.diagnosis.report_rows import Table
from hdrive_mbs.diagnosis.result import Cause, Diagnosis
from hdrive_mbs.writing import write_text

WIDTH = 110
"""Columns of the report; only a table with long names is wider."""
ROWS = 15
"""Nominal parameters up to which all are listed."""


def report_text(diagnosis: Diagnosis) -> str:
    """The whole report, lines ended by newlines.  SI units, angles in rad, speeds in rad/s."""
    return "\n".join(line.rstrip() for line in _lines(diagnosis)) + "\n"


def write_report(diagnosis: Diagnosis, path: str | os.PathLike[str]) -> Path:
    """Write it to a file (UTF-8), whole or not at all."""
    return write_text(path, report_text(diagnosis))


def _lines(diagnosis: Diagnosis) -> Iterator[str]:
    yield from _heading(sentences.title(diagnosis), "=")
    yield ""
    for text in diagnosis.warnings:
        yield from _wrapped(f"WARNING: {text}", indent="")
    yield from _wrapped(f"{sentences.verdict(diagnosis)} {sentences.confidence(diagnosis)}", indent="")
    for text in filter(
        None, (sentences.ambiguity(diagnosis), sentences.inexact(diagnosis), sentences.strained(diagnosis), sentences.rest(diagnosis))
    ):
        yield from _wrapped(text, indent="")
    for cause in diagnosis.causes:
        yield from _cause(cause)
    yield from _section("Where (an unknown signal at one place, no law assumed)", sentences.where_sentences(diagnosis, 5))
    yield from _gap(diagnosis)
    if diagnosis.ranking:
        table = report_rows.ranking_table(diagnosis)
        yield from _section(f"Ranking (first {len(table.rows)} of {len(diagnosis.ranking)})", [""])
        yield from _drawn(table)
        yield "  log odds: against the refitted nominal model; fit, held out: mean square of the residual, 1 for noise alone"
    yield from _parameters(diagnosis)
    if not sentences.only_noise(diagnosis):
        yield from _section("Where in the operating range (refitted nominal model)", sentences.domain_sentences(diagnosis.domain))
    yield from _section("Measure next", sentences.next_sentences(diagnosis.next_records))
    yield from _section("Notes", (*diagnosis.notes, *improved_words(diagnosis)))
    yield ""
    yield from _wrapped(sentences.made(diagnosis), indent="")


def _cause(cause: Cause) -> Iterator[str]:
    known = f"probability {probability(cause.probability)}; {sentences.law_line(cause)}"
    yield from _section(f"Cause: {sentences.label(cause.effect, cause.at)}", [known])
    if cause.parameters:
        yield from _drawn(report_rows.cause_table(cause))


def _gap(diagnosis: Diagnosis) -> Iterator[str]:
    yield from _section("Gap (held out)", sentences.gap_sentences(diagnosis))
    if not diagnosis.gaps:
        return
    yield ""
    yield "  rms in standard deviations of the noise (95 % interval):"
    yield from _drawn(report_rows.gap_table(diagnosis))
    physical = report_rows.unit_table(diagnosis)
    if physical.rows:
        yield ""
        yield "  the same in the columns' units:"
        yield from _drawn(physical)


def _parameters(diagnosis: Diagnosis) -> Iterator[str]:
    if not diagnosis.parameters:
        return
    yield from _section("Nominal parameters", [""])
    short = len(diagnosis.parameters) > ROWS
    table = report_rows.parameter_table(diagnosis, beyond=sentences.MOVED if short else 0.0)
    if table.rows:
        yield from _drawn(table)
    if short:
        number = len(diagnosis.parameters) - len(table.rows)
        yield f"  {number} more moved by less than {sentences.MOVED:g} sigma; diagnosis.json has them all under 'parameters'"
    yield from _wrapped(sentences.SIGMA)


def _section(title: str, lines: Sequence[str]) -> Iterator[str]:
    if lines:
        yield ""
        yield from _heading(title, "-")
        for line in lines:
            yield from _wrapped(line)


def _heading(text: str, under: str) -> Iterator[str]:
    lines = _wrapped(text, indent="")
    yield from lines
    yield under * max(len(line) for line in lines)


def _wrapped(text: str, indent: str = "  ") -> list[str]:
    return textwrap.wrap(text.strip(), WIDTH, initial_indent=indent, subsequent_indent=indent + "  ", break_on_hyphens=False)


def _drawn(table: Table) -> Iterator[str]:
    """Columns in line; running text at the end wrapped within the width, below the row where there is no room."""
    fixed = len(table.heads) - table.free
    widths = [max(len(table.heads[k]), *(len(row[k]) for row in table.rows)) for k in range(fixed)]

    def line(row: Sequence[str]) -> str:
        cells = (row[k].rjust(widths[k]) if k >= table.words else row[k].ljust(widths[k]) for k in range(fixed))
        return "  " + "  ".join(cells)

    yield line(table.heads)
    left = 2 + sum(widths) + 2 * fixed
    for row in table.rows:
        if not table.free or not row[-1]:
            yield line(row)
        elif WIDTH - left < 24:
            yield line(row)
            yield from textwrap.wrap(row[-1], WIDTH, initial_indent=" " * 6, subsequent_indent=" " * 6)
        else:
            said = textwrap.wrap(row[-1], WIDTH - left)
            yield f"{line(row)}  {said[0]}"
            yield from (" " * left + more for more in said[1:])

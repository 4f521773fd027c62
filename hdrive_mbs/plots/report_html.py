"""A diagnosis as one page for a browser: text, tables and pictures in a single file that needs nothing else."""

from __future__ import annotations

import os
from collections.abc import Iterator
from html import escape
from pathlib import Path

from hdrive_mbs.diagnosis import report_rows, sentences
from hdrive_mbs.diagnosis.improved_words import improved_words
from hdrive_mbs.diagnosis.readable import digits, named, probability
from hdrive_mbs.diagnosis.result import Diagnosis, Trace
from hdrive_mbs.plots.diagnosis import worst_first
from hdrive_mbs.plots.diagnosis_domain import plot_domain, plot_orders
from hdrive_mbs.plots.diagnosis_force import plot_force
from hdrive_mbs.plots.diagnosis_gap import plot_gap
from hdrive_mbs.plots.diagnosis_look import steps_of, varies
from hdrive_mbs.plots.diagnosis_loop import plot_loop
from hdrive_mbs.plots.diagnosis_ranking import plot_places, plot_ranking
from hdrive_mbs.plots.diagnosis_traces import OVER, plot_residual, plot_traces
from hdrive_mbs.plots.look import house_look
from hdrive_mbs.plots.page import bullets, figure, page, paragraphs, table_of
from hdrive_mbs.writing import write_text


def report_html(diagnosis: Diagnosis) -> str:
    """The page.  Nothing on it is fetched from anywhere; every picture says in its alternative text what it shows."""
    with house_look():
        body = "\n".join(report_body(diagnosis))
    return page(sentences.title(diagnosis), body)


def write_report_html(diagnosis: Diagnosis, path: str | os.PathLike[str]) -> Path:
    """Write it, whole or not at all."""
    return write_text(path, report_html(diagnosis))


def report_body(diagnosis: Diagnosis) -> Iterator[str]:
    """Everything below the title: verdict, causes, gap, curves, place, ranking, parameters; headings of the second level."""
    said = (sentences.verdict, sentences.confidence, sentences.ambiguity, sentences.inexact, sentences.strained, sentences.rest)
    if diagnosis.warnings:
        yield f'<div class="verdict unknown">{"".join(paragraphs(f"Warning: {text}" for text in diagnosis.warnings))}</div>'
    kind = escape(diagnosis.verdict, quote=True)
    yield f'<div class="verdict {kind}">{"".join(paragraphs(text for say in said if (text := say(diagnosis))))}</div>'
    yield from _causes(diagnosis)
    yield from _gap(diagnosis)
    yield from _curves(diagnosis)
    if not sentences.only_noise(diagnosis):
        yield from _where(diagnosis)
        yield from _domain(diagnosis)
    yield from _ranking(diagnosis)
    yield from _parameters(diagnosis)
    yield from bullets("Measure next", sentences.next_sentences(diagnosis.next_records))
    yield from bullets("Notes", (*diagnosis.notes, *improved_words(diagnosis)))
    yield f"<footer>{escape(sentences.made(diagnosis))}</footer>"


def _causes(diagnosis: Diagnosis) -> Iterator[str]:
    for cause in diagnosis.causes:
        yield f"<h2>Cause: {escape(sentences.label(cause.effect, cause.at))}</h2>"
        yield from paragraphs([f"Probability {probability(cause.probability)}; {sentences.law_line(cause)}."])
        yield from table_of(report_rows.cause_table(cause), "Identified parameters")


def _gap(diagnosis: Diagnosis) -> Iterator[str]:
    yield "<h2>Gap: how far the model is off, and how far that shrinks</h2>"
    yield from paragraphs(sentences.gap_sentences(diagnosis))
    if not diagnosis.gaps:
        return
    gap = diagnosis.gap
    sizes = ", ".join(f"{words} {digits(getattr(gap, name).value, 3)}" for name, words in steps_of(bool(diagnosis.causes)).items())
    text = f"Bars on a logarithmic axis. All records and columns together: {sizes} standard deviations of the noise."
    yield figure(plot_gap(diagnosis), text, "Root mean square on held-out stretches, with 95 % intervals; dashed: noise alone.")
    yield "<details><summary>Numbers, in noise and in the columns' units</summary>"
    yield from table_of(report_rows.gap_table(diagnosis), "Standard deviations of the noise (95 % interval)")
    yield from table_of(report_rows.unit_table(diagnosis), "In the columns' units (95 % interval)")
    yield "</details>"


def _curves(diagnosis: Diagnosis) -> Iterator[str]:
    if not diagnosis.traces:
        return
    yield "<h2>Measured against simulated</h2>"
    ordered = worst_first(diagnosis)
    yield _trace(diagnosis, ordered[0])
    if any(varies(getattr(ordered[0], name), len(ordered[0].times)) for name in OVER):
        yield _residual(diagnosis, ordered[0])
    if len(ordered) > 1:
        yield f"<details><summary>{len(ordered) - 1} more columns, the worst first</summary>"
        yield from (_trace(diagnosis, trace) for trace in ordered[1:])
        yield "</details>"


def _trace(diagnosis: Diagnosis, trace: Trace) -> str:
    axes = plot_traces(diagnosis, record=trace.record, column=trace.column)
    text = (
        f"Column {named(trace.column)} of record {trace.record} over {digits(float(trace.times[-1]), 3)} s, and below it what models leave."
    )
    said = (
        f"{trace.record}, {named(trace.column)}. Grey ground: held out, no fit saw it."
        " Grey band below, under what is at the noise: plus and minus two noise sigmas."
    )
    return figure(axes, text, said, points=True)


def _residual(diagnosis: Diagnosis, trace: Trace) -> str:
    axes = plot_residual(diagnosis, record=trace.record, column=trace.column)
    over = [name for name in OVER if varies(getattr(trace, name), len(trace.times))]
    text = f"Measured minus simulated {named(trace.column)} of record {trace.record}."
    return figure(axes, text, f"What is left of {named(trace.column)}, record {trace.record}, against {', '.join(over)}.", points=True)


def _where(diagnosis: Diagnosis) -> Iterator[str]:
    if not (diagnosis.where or diagnosis.forces or diagnosis.loops):
        return
    yield "<h2>Where it lies</h2>"
    if diagnosis.where:
        first = diagnosis.where[0]
        text = f"Bars: {sentences.where(first)}."
        yield figure(plot_places(diagnosis), text, "An unknown signal at one place, no law assumed.")
        yield from paragraphs(sentences.where_sentences(diagnosis, 5))
    for force in diagnosis.forces:
        axes = plot_force(diagnosis, at=force.at, way=force.way, record=force.record)
        text = f"Estimated unknown signal at {' '.join(filter(None, (force.at, force.way)))} during record {force.record}."
        yield figure(axes, text, f"What must have acted at {force.at} for the refitted model to follow the record.", points=True)
    for loop in diagnosis.loops:
        axes = plot_loop(diagnosis, record=loop.record)
        text = f"Loop of torque against twist of {loop.at} during record {loop.record}."
        yield figure(axes, text, f"Hysteresis loop of {loop.at}, record {loop.record}, without its straight line.")


def _domain(diagnosis: Diagnosis) -> Iterator[str]:
    if diagnosis.domain:
        said = sentences.domain_sentences(diagnosis.domain)
        yield from bullets("When it shows", said)
        text = f"Bars of the mean square above the noise in parts of the operating range. {said[0]}"
        yield figure(plot_domain(diagnosis), text, "Mean square of the residual above the noise; dashed: as much as the noise.")
    for item in diagnosis.order_maps:
        axes = plot_orders(diagnosis, record=item.record)
        text = f"Map of amplitudes of the residual of {named(item.column)} over order and speed of {item.reference}, record {item.record}."
        yield figure(axes, text, f"Orders of {item.reference} in the residual of {named(item.column)}, amplitudes 0-peak.", points=True)


def _ranking(diagnosis: Diagnosis) -> Iterator[str]:
    if not diagnosis.ranking:
        return
    first = diagnosis.ranking[0]
    yield "<h2>Ranking</h2>"
    text = f"Bars of probability; first is {sentences.label(first.effect, first.at)} with {probability(first.probability)}."
    said = "Calibrated probabilities; log odds are those against the refitted nominal model."
    yield figure(plot_ranking(diagnosis), text, said)
    yield from table_of(
        report_rows.ranking_table(diagnosis),
        f"First of {len(diagnosis.ranking)}; fit, held out: mean square of the residual, 1 for noise alone",
    )


def _parameters(diagnosis: Diagnosis) -> Iterator[str]:
    if not diagnosis.parameters:
        return
    yield "<h2>Nominal parameters</h2>"
    yield from table_of(report_rows.parameter_table(diagnosis), f"Before and after the fit; {sentences.SIGMA}")

"""A diagnosis as one page for a browser: text, tables and pictures in a single file that needs nothing else."""

from __future__ import annotations

import base64
import io
import os
from collections.abc import Callable, Iterable, Iterator
from html import escape
from pathlib import Path
from typing import Any

from matplotlib.axes import Axes

from hdrive_mbs.diagnosis import report_rows, sentences
from hdrive_mbs.diagnosis.readable import digits, named, percent, probability
from hdrive_mbs.diagnosis.report_rows import Table
from hdrive_mbs.diagnosis.result import Diagnosis, Trace
from hdrive_mbs.plots.diagnosis import worst_first
from hdrive_mbs.plots.diagnosis_domain import plot_domain, plot_orders
from hdrive_mbs.plots.diagnosis_force import plot_force
from hdrive_mbs.plots.diagnosis_gap import plot_gap
from hdrive_mbs.plots.diagnosis_look import varies
from hdrive_mbs.plots.diagnosis_loop import plot_loop
from hdrive_mbs.plots.diagnosis_ranking import plot_places, plot_ranking
from hdrive_mbs.plots.diagnosis_traces import OVER, plot_residual, plot_traces
from hdrive_mbs.plots.look import house_look
from hdrive_mbs.writing import write_text

STYLE = """
body { font: 16px/1.45 system-ui, sans-serif; color: #1a1a1a; background: #fff; overflow-wrap: anywhere; }
body { max-width: 46rem; margin: 0 auto; padding: 1rem; }
h1 { font-size: 1.35rem; line-height: 1.25; } h2 { font-size: 1.1rem; margin: 2rem 0 .5rem; }
h3 { font-size: 1rem; margin: 1.2rem 0 .3rem; }
.verdict { border-left: .4rem solid #0072B2; background: #f1f6fa; padding: .7rem 1rem; margin: 1rem 0; }
.verdict p { margin: .2rem 0; } .verdict p:first-child { font-size: 1.15rem; font-weight: 600; }
.none { border-color: #009E73; background: #eef8f4; } .unknown { border-color: #D55E00; background: #fdf3ec; }
.table { overflow-x: auto; margin: .6rem 0; } table { border-collapse: collapse; font-size: .85rem; }
table { overflow-wrap: normal; }
caption { text-align: left; padding: .2rem 0; color: #444; }
th, td { padding: .2rem .6rem .2rem 0; text-align: left; vertical-align: top; border-bottom: 1px solid #ddd; }
.number { text-align: right; white-space: nowrap; }
figure { margin: 1rem 0; } img { display: block; max-width: 100%; height: auto; } figcaption { font-size: .85rem; color: #444; }
summary { cursor: pointer; padding: .4rem 0; } footer { margin-top: 2rem; font-size: .85rem; color: #444; }
"""
DOTS = 200
"""Of a picture of many points, per inch."""


def report_html(diagnosis: Diagnosis) -> str:
    """The page.  Nothing on it is fetched from anywhere; every picture says in its alternative text what it shows."""
    title = sentences.title(diagnosis)
    head = (
        '<meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">'
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; style-src 'unsafe-inline'\">"
        f"<title>{escape(title)}</title><style>{STYLE}</style>"
    )
    with house_look():
        body = "\n".join(_body(diagnosis))
    return f'<!DOCTYPE html>\n<html lang="en">\n<head>{head}</head>\n<body>\n<h1>{escape(title)}</h1>\n{body}\n</body>\n</html>\n'


def write_report_html(diagnosis: Diagnosis, path: str | os.PathLike[str]) -> Path:
    """Write it, whole or not at all."""
    return write_text(path, report_html(diagnosis))


def _body(diagnosis: Diagnosis) -> Iterator[str]:
    said = (sentences.verdict(diagnosis), sentences.confidence(diagnosis), sentences.ambiguity(diagnosis))
    kind = escape(diagnosis.verdict, quote=True)
    yield f'<div class="verdict {kind}">{"".join(_paragraphs(text for text in said if text))}</div>'
    yield from _causes(diagnosis)
    yield from _gap(diagnosis)
    yield from _curves(diagnosis)
    yield from _where(diagnosis)
    yield from _domain(diagnosis)
    yield from _ranking(diagnosis)
    yield from _parameters(diagnosis)
    yield from _list("Measure next", sentences.next_sentences(diagnosis.next_records))
    yield from _list("Notes", diagnosis.notes)
    yield f"<footer>{escape(sentences.made(diagnosis))}</footer>"


def _causes(diagnosis: Diagnosis) -> Iterator[str]:
    for cause in diagnosis.causes:
        yield f"<h2>Cause: {escape(sentences.label(cause.effect, cause.at))}</h2>"
        yield from _paragraphs([f"Probability {probability(cause.probability)}; {sentences.law_line(cause)}."])
        yield from _table(report_rows.cause_table(cause), "Identified parameters")


def _gap(diagnosis: Diagnosis) -> Iterator[str]:
    yield "<h2>Gap: how far the model is off, and how far that shrinks</h2>"
    yield from _paragraphs(sentences.gap_sentences(diagnosis))
    if not diagnosis.gaps:
        return
    gap = diagnosis.gap
    text = (
        f"Bars on a logarithmic axis. All records and columns together: nominal {digits(gap.nominal.value, 3)}, "
        f"refitted {digits(gap.refit.value, 3)}, with the cause {digits(gap.effect.value, 3)} standard deviations of the noise."
    )
    yield _figure(plot_gap(diagnosis), text, "Root mean square on held-out stretches, with 95 % intervals; dashed: noise alone.")
    yield "<details><summary>Numbers, in noise and in the columns' units</summary>"
    yield from _table(report_rows.gap_table(diagnosis), "Standard deviations of the noise (95 % interval)")
    yield from _table(report_rows.unit_table(diagnosis), "In the columns' units (95 % interval)")
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
        f"Column {named(trace.column)} of record {trace.record} over {digits(float(trace.times[-1]), 3)} s: measured, and simulated before"
    )
    text += f"{' and after' if diagnosis.causes else ''}; below, what is left between them in standard deviations of the noise."
    said = f"{trace.record}, {named(trace.column)}. Grey ground: held out, no fit saw it. Grey band below: plus and minus two noise sigmas."
    return _figure(axes, text, said, points=True)


def _residual(diagnosis: Diagnosis, trace: Trace) -> str:
    axes = plot_residual(diagnosis, record=trace.record, column=trace.column)
    over = [name for name in OVER if varies(getattr(trace, name), len(trace.times))]
    text = f"Measured minus simulated {named(trace.column)} of record {trace.record} against {' and '.join(over)}, before"
    text += " and after." if diagnosis.causes else "."
    return _figure(axes, text, f"What is left of {named(trace.column)}, record {trace.record}, against {', '.join(over)}.", points=True)


def _where(diagnosis: Diagnosis) -> Iterator[str]:
    if not (diagnosis.where or diagnosis.forces or diagnosis.loops):
        return
    yield "<h2>Where it lies</h2>"
    if diagnosis.where:
        first = diagnosis.where[0]
        text = f"Bars: {first.at} has probability {probability(first.probability)} and explains {percent(first.share)} of the gap."
        yield _figure(plot_places(diagnosis), text, "An unknown signal at one place, no law assumed.")
    for force in diagnosis.forces:
        axes = plot_force(diagnosis, at=force.at, way=force.way, record=force.record)
        text = f"Estimated unknown signal at {force.at} {force.way} during record {force.record}, over time and against what varies there."
        yield _figure(axes, text, f"What must have acted at {force.at} for the refitted model to follow the record.", points=True)
    for loop in diagnosis.loops:
        axes = plot_loop(diagnosis, record=loop.record)
        text = f"Loop of torque against twist of {loop.at} during record {loop.record}: measured, before and after."
        yield _figure(axes, text, f"Hysteresis loop of {loop.at}, record {loop.record}, without its straight line.")


def _domain(diagnosis: Diagnosis) -> Iterator[str]:
    if diagnosis.domain:
        said = sentences.domain_sentences(diagnosis.domain)
        yield from _list("When it shows", said)
        text = f"Bars of the mean square above the noise in parts of the operating range. {said[0]}"
        yield _figure(plot_domain(diagnosis), text, "Mean square of the residual above the noise; dashed: as much as the noise.")
    for item in diagnosis.order_maps:
        axes = plot_orders(diagnosis, record=item.record)
        text = f"Map of amplitudes of the residual of {named(item.column)} over order and speed of {item.reference}, record {item.record}."
        yield _figure(axes, text, f"Orders of {item.reference} in the residual of {named(item.column)}, amplitudes 0-peak.", points=True)


def _ranking(diagnosis: Diagnosis) -> Iterator[str]:
    if not diagnosis.ranking:
        return
    first = diagnosis.ranking[0]
    yield "<h2>Ranking</h2>"
    text = f"Bars of probability; first is {sentences.label(first.effect, first.at)} with {probability(first.probability)}."
    said = "Calibrated probabilities; log odds are those against the refitted nominal model."
    yield _figure(plot_ranking(diagnosis), text, said)
    yield from _table(
        report_rows.ranking_table(diagnosis),
        f"First of {len(diagnosis.ranking)}; fit, held out: mean square of the residual, 1 for noise alone",
    )


def _parameters(diagnosis: Diagnosis) -> Iterator[str]:
    if not diagnosis.parameters:
        return
    yield "<h2>Nominal parameters</h2>"
    yield from _table(report_rows.moved_table(diagnosis), "Moved by the fit; sigma is the tolerance they had before")
    yield from _paragraphs(text for text in [sentences.unmoved(diagnosis)] if text)


def _list(title: str, lines: Iterable[str]) -> Iterator[str]:
    items = [f"<li>{escape(line)}</li>" for line in lines]
    if items:
        yield f"<h2>{escape(title)}</h2><ul>{''.join(items)}</ul>"


def _paragraphs(texts: Iterable[str]) -> list[str]:
    return [f"<p>{escape(text)}</p>" for text in texts]


def _table(table: Table, caption: str) -> Iterator[str]:
    if not table.rows:
        return

    def cells(tag: str, row: tuple[str, ...]) -> str:
        numbers = [' class="number"' if k >= table.words else "" for k in range(len(row))]
        scope = ' scope="col"' if tag == "th" else ""
        return "".join(f"<{tag}{scope}{number}>{escape(text)}</{tag}>" for number, text in zip(numbers, row, strict=True))

    rows = "".join(f"<tr>{cells('td', row)}</tr>" for row in table.rows)
    head = f"<thead><tr>{cells('th', table.heads)}</tr></thead>"
    yield f'<div class="table"><table><caption>{escape(caption)}</caption>{head}<tbody>{rows}</tbody></table></div>'


def _figure(axes: Axes, alternative: str, caption: str, *, points: bool = False) -> str:
    """points : whether it has so many points that a picture of dots is smaller than one of lines."""
    figure: Any = axes.figure.figure
    kind, mime = ("png", "image/png") if points else ("svg", "image/svg+xml")
    buffer = io.BytesIO()
    save: Callable[..., None] = figure.savefig
    save(buffer, format=kind, dpi=DOTS, metadata={"Software": None} if points else {"Date": None})
    width, height = (round(96.0 * size) for size in figure.get_size_inches())
    data = base64.b64encode(buffer.getvalue()).decode("ascii")
    picture = f'<img alt="{escape(alternative, quote=True)}" width="{width}" height="{height}" src="data:{mime};base64,{data}">'
    return f"<figure>{picture}<figcaption>{escape(caption)}</figcaption></figure>"

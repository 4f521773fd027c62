"""The page of ``hdrive-mbs demo``: run-up, Campbell diagram, bearing models and a diagnosis of one line."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from html import escape

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from hdrive_mbs.analysis.run_up.run_up import RunUp
from hdrive_mbs.analysis.whirl.whirl_campbell import WhirlCampbell
from hdrive_mbs.diagnosis import sentences
from hdrive_mbs.diagnosis.readable import digits
from hdrive_mbs.diagnosis.report_rows import Table
from hdrive_mbs.diagnosis.result import Diagnosis
from hdrive_mbs.plots.dispatch import plot
from hdrive_mbs.plots.joint_figures import WIDTH, plot_bearing_models, plot_gear_run
from hdrive_mbs.plots.look import house_look
from hdrive_mbs.plots.page import figure, page, paragraphs, table_of
from hdrive_mbs.plots.report_html import report_body

TITLE = "A robot joint as one line: run-up, Campbell diagram, bearings, diagnosis"
LEAD = (
    "An inverter-fed motor turns an arm through a strain-wave gear. Motor, coupling, an input shaft on two housed bearings with an"
    " unbalanced brake disc, wave generator, flexspline, output shaft on two bearings and arm are one model: torque, lateral whirl and"
    " lost motion act on each other. Ratio, lost motion and kinematic error of the gear come from its teeth."
)


@dataclass(frozen=True, kw_only=True, eq=False)
class DemoResults:
    """What the demo has found.

    runs : bearing model -> run-up, the full one first;  seconds : section -> its run time [s]
    coordinates : bearing model -> number of coordinates;  rotor, gear : whose curves are shown;  lost_motion : of the gear [rad]
    campbell : torsion and bending;  diagnosis : of the bundled records, or why there is none
    about_records : what they are
    """

    runs: Mapping[str, RunUp]
    coordinates: Mapping[str, int]
    rotor: str
    gear: str
    lost_motion: float
    campbell: WhirlCampbell
    diagnosis: Diagnosis | str
    about_records: str
    seconds: Mapping[str, float]
    made: str


def demo_page(results: DemoResults) -> str:
    """The page, in one file that fetches nothing."""
    with house_look():
        parts = [*paragraphs([LEAD]), *_found(results), *_run_up(results), *_campbell(results), *_bearings(results), *_diagnosis(results)]
    times = "; ".join(f"{name} {_short(seconds)} s" for name, seconds in results.seconds.items())
    footer = f"<footer>{escape(results.made)} Run times here: {escape(times)}.</footer>"
    return page(TITLE, "\n".join([*parts, footer]))


def _found(results: DemoResults) -> Iterator[str]:
    lines = [_peak(results, "full"), _first_criticals(results.campbell), _difference(results)]
    lines.append(results.diagnosis if isinstance(results.diagnosis, str) else f"Diagnosis of the record: {_verdict(results.diagnosis)}")
    yield f"<ul>{''.join(f'<li>{escape(line)}</li>' for line in lines)}</ul>"


def _peak(results: DemoResults, model: str) -> str:
    run, rotor = results.runs[model], results.rotor
    return (
        f"{_named(rotor)} passes its lateral critical speeds with a whirl of {_short(1e6 * run.peak_amplitude[rotor])} µm (0-peak) at"
        f" {_short(run.peak_speed[rotor])} rad/s."
    )


def _first_criticals(campbell: WhirlCampbell) -> str:
    unbalance = _excited(campbell, 1.0, "lateral")
    error = _excited(campbell, 2.0, "torsional")
    said = f"Unbalance meets the bending of its shaft at {_listed(unbalance[:3])} rad/s"
    return said + (f"; the kinematic error, twice per turn, meets torsion at {_listed(error[:2])} rad/s." if error else ".")


def _excited(campbell: WhirlCampbell, order: float, kind: str) -> list[float]:
    """Critical speeds of an order that nothing keeps from being excited, in bending or in torsion, above rest."""
    rows = zip(campbell.critical_speeds, campbell.critical_orders, campbell.critical_whirl, campbell.critical_notes, strict=True)
    return [
        float(speed)
        for speed, line, word, note in rows
        if speed > 0.0 and campbell.order_numbers[line] == order and not note and (word == "torsional") == (kind == "torsional")
    ]


def _difference(results: DemoResults) -> str:
    full, simple = (results.runs[name].peak_amplitude[results.rotor] for name in ("full", "simplified"))
    criticals = [results.runs[name].critical_speeds for name in ("full", "simplified")]
    said = f"Simplified bearings change the largest whirl by {100.0 * (simple / full - 1.0):+.1f} %"
    if len(criticals[0]) == len(criticals[1]) > 0:
        worst = max(100.0 * (criticals[1] / criticals[0] - 1.0), key=abs)
        said += f" and critical speeds by up to {worst:+.1f} %"
    return f"{said}."


def _verdict(diagnosis: Diagnosis) -> str:
    said = sentences.verdict(diagnosis)
    if not diagnosis.gaps:
        return said
    gap = diagnosis.gap
    then = f", with the cause {_short(gap.effect.value)}" if diagnosis.causes else ""
    return (
        f"{said} Gap on stretches that no fit saw, in standard deviations of the noise: nominal"
        f" {_short(gap.nominal.value)}, refitted {_short(gap.refit.value)}{then}; noise alone is 1."
    )


def _run_up(results: DemoResults) -> Iterator[str]:
    run, gear = results.runs["full"], results.gear
    yield "<h2>Run-up</h2>"
    twist, half = run.values[f"{gear}.twist"], 0.5 * results.lost_motion
    taken = float(run.times[int(np.argmax(np.abs(twist) > half))])
    crossings = int(np.count_nonzero(np.diff(np.sign(twist[np.abs(twist) > half])) != 0))
    torque = run.values[f"{gear}.torque"]
    largest = int(np.argmax(np.abs(torque)))
    most, then = _short(abs(float(torque[largest]))), _short(abs(float(run.values[f"{run.reference}.speed"][largest])))
    yield from paragraphs(
        [
            f"The inverter raises its frequency in proportion to time. The gear takes up its lost motion of"
            f" {_short(1e3 * results.lost_motion)} mrad at {_short(taken)} s and crosses it {crossings} more times, as the arm passes the"
            f" top and the bottom and its weight changes sides or as the kinematic error shakes the mesh open. The largest torque,"
            f" {most} N m, comes at {then} rad/s of the motor.",
            _peak(results, "full") + " Dashed: undamped critical speeds.",
        ]
    )
    rows = f"{_short(run.times[-1])} s"
    text = f"Two curves over {rows}: torque of the gear, up to {most} N m, and its twist in and outside the gap."
    yield figure(
        plot_gear_run(run, gear, lost_motion=results.lost_motion), text, "Torque and twist of the gear in the run-up.", points=True
    )
    text = (
        f"Speed of the motor over {rows}, rising to {_short(run.final_speed)} rad/s, and the whirl of the {_plain(results.rotor)} over its"
        f" speed with a peak of {_short(1e6 * run.peak_amplitude[results.rotor])} µm at {_short(run.peak_speed[results.rotor])} rad/s."
    )
    yield figure(_narrowed(plot(run)), text, f"Speed, and whirl of the {_plain(results.rotor)}, 0-peak.", points=True)


def _campbell(results: DemoResults) -> Iterator[str]:
    found = results.campbell
    yield "<h2>Campbell diagram: torsion and bending in one picture</h2>"
    said = "The arm is level here, so that its weight loads the mesh; hanging, it would leave the mesh in its gap."
    yield from paragraphs([f"{said} {_first_criticals(found)}"])
    words = sorted(set(found.whirl))
    text = f"Damped frequencies of {len(found.whirl)} branches ({', '.join(words)}) over the speed of the motor up to"
    text += f" {_short(float(found.speeds[-1]))} rad/s, with the lines of orders 1 and 2. {_first_criticals(found)}"
    yield figure(_narrowed(plot(found)), text, "Rings: critical speeds; small grey ones are hardly excited.")
    rows = [
        (f"{speed:.1f}", f"{found.order_numbers[order]:g}", word, f"{100.0 * ratio:.2g} %", note or "excited")
        for speed, order, word, ratio, note in zip(
            found.critical_speeds,
            found.critical_orders,
            found.critical_whirl,
            found.critical_damping_ratios,
            found.critical_notes,
            strict=True,
        )
        if speed > 0.0
    ]
    heads = ("speed [rad/s]", "order", "whirl", "damping", "remark")
    yield f"<details><summary>{len(rows)} crossings as numbers</summary>"
    yield from table_of(Table(heads=heads, rows=tuple(rows), words=5), "Critical speeds")
    yield "</details>"


def _bearings(results: DemoResults) -> Iterator[str]:
    full = results.runs["full"].peak_amplitude[results.rotor]
    yield "<h2>Full against simplified bearings</h2>"
    yield from paragraphs(
        [
            "Full bearings have rings and housings with coordinates of their own. Simplified ones (Matyja 2015, section 5) are springs"
            f" and dampers at the shaft; improved ones keep what the whirl needs. {_difference(results)}"
        ]
    )
    rows = tuple(
        (
            name,
            str(results.coordinates[name]),
            f"{_short(1e6 * run.peak_amplitude[results.rotor])}",
            f"{100.0 * (run.peak_amplitude[results.rotor] / full - 1.0):+.2f} %" if name != "full" else "",
            f"{_short(run.peak_speed[results.rotor])}",
            ", ".join(f"{speed:.1f}" for speed in run.critical_speeds),
            f"{results.seconds[f'run-up, {name} bearings']:.1f}",
        )
        for name, run in results.runs.items()
    )
    heads = ("bearings", "coordinates", "peak [µm]", "against full", "at [rad/s]", "undamped critical speeds [rad/s]", "run [s]")
    yield from table_of(Table(heads=heads, rows=rows), f"Whirl of the {_plain(results.rotor)} in the run-up, 0-peak")
    peaks = ", ".join(f"{name} {row[2]} µm at {row[4]} rad/s" for name, row in zip(results.runs, rows, strict=True))
    text = f"Whirl of the {_plain(results.rotor)} over its speed near the critical speeds, one curve a model: {peaks}."
    yield figure(plot_bearing_models(results.runs, results.rotor), text, "The same run with three models of the bearings.", points=True)


def _diagnosis(results: DemoResults) -> Iterator[str]:
    yield "<h2>Diagnosis of a record</h2>"
    yield from paragraphs([results.about_records])
    if isinstance(results.diagnosis, str):
        yield f'<div class="verdict unknown">{"".join(paragraphs([results.diagnosis]))}</div>'
        return
    for part in report_body(results.diagnosis):
        yield part.replace("<h3", "<h4").replace("</h3>", "</h4>").replace("<h2", "<h3").replace("</h2>", "</h3>")


def _short(value: float) -> str:
    return digits(value, 3)


def _narrowed(axes: Axes) -> Axes:
    """The same picture as wide as the others."""
    drawn = axes.figure.figure
    assert isinstance(drawn, Figure)
    drawn.set_size_inches(WIDTH, float(drawn.get_size_inches()[1]))
    return axes


def _listed(speeds: list[float]) -> str:
    return " and ".join(f"{speed:.1f}" for speed in speeds) or "no speed"


def _plain(place: str) -> str:
    return place.replace("_", " ")


def _named(place: str) -> str:
    words = _plain(place)
    return f"The {words}"

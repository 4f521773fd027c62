"""The content of Figs 4-11 of the paper, and of what the benchmark adds to it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import hdrive_mbs as hm
from benchmarks.stiffness_laws.laws import CATALOGUE, CONTINUOUS, CUBIC, JUMP, LARGEST_TORQUE, LITERAL, laws
from benchmarks.stiffness_laws.measure import Measured
from benchmarks.stiffness_laws.pulses import EXPLICIT, FIXED, IN_GAP, SMOOTHED, Pulses
from benchmarks.stiffness_laws.table_1 import printed_9, printed_10
from hdrive_mbs.plots.look import COLOURS, GREY, house_look, legend_above, new_figure, style
from models.harmonic_drive_train import catalogue, load_above_gap, load_in_gap, motor

RPM = 30.0 / np.pi
TWIST = "twist of the flexspline [mrad]"
TORQUE = "elastic torque [N\u2009m]"


def figures(pulses: Pulses, shaft: Measured, numbers: Mapping[str, Any]) -> dict[str, Figure]:
    """All pictures by file name."""
    with house_look():
        return {
            "figure_4_motor": _figure_4(),
            "figures_5_6_catalogue_and_cubic": _figures_5_6(),
            "figures_7_8_jump_and_continuous": _figures_7_8(),
            "figures_9_10_load_in_the_gap_torque": _figures_9_10(pulses),
            "figure_11_output_shaft": _figure_11(shaft),
            "contacts_of_the_jump_law": _contacts(pulses.contacts),
            "steps_and_time": _costs(pulses),
            "reduction_to_two_equations": _reduction(numbers["reduction"]),
        }


def _figure_4() -> Figure:
    figure = new_figure()
    ax = figure.add_subplot()
    curve = motor()
    speed = np.linspace(0.0, 1.1 * curve.synchronous_speed, 500)
    ax.plot(RPM * speed, curve.torque(0.0, speed), **style(0))
    breakdown = curve.synchronous_speed * (1.0 - curve.breakdown_slip)
    points = {"start": 0.0, "breakdown": breakdown, "rated": curve.rated_speed, "synchronous": curve.synchronous_speed}
    for name, at in points.items():
        torque = float(curve.torque(0.0, at))
        ax.plot([RPM * at], [torque], "o", color=GREY, markersize=4.5)
        text = f"{name}\n{RPM * at:.0f} rpm, {torque:.2f} N\u2009m"
        ax.annotate(text, (RPM * at, torque), xytext=(8, -26 if name == "start" else 3), textcoords="offset points")
    ax.set_ylim(top=1.2 * curve.breakdown_torque)
    ax.set_xlim(0.0, 1.3 * RPM * curve.synchronous_speed)
    ax.set_xlabel("speed of the motor [rpm]")
    ax.set_ylabel("torque of the motor [N\u2009m]")
    ax.set_title("Fig. 4: torque-speed characteristic of the asynchronous motor (Kloss)")
    return figure


def _figures_5_6() -> Figure:
    figure = new_figure(10.5, 4.6)
    left, right = figure.subplots(1, 2)
    law = catalogue()
    torque = np.linspace(1e-9, LARGEST_TORQUE, 600)
    left.plot(torque, 1e3 * law.twist(torque), label="(7)-(10), corrected", **style(0))
    middle = torque[(torque >= law.torque_1) & (torque <= law.torque_2)]
    high = torque[torque >= law.torque_2]
    left.plot(middle, [1e3 * printed_9(law, t) for t in middle], label="(9) as printed", **style(1))
    left.plot(high, [1e3 * printed_10(law, t) for t in high], label="(10) as printed", **style(2))
    rows = {0.0: 1.31, 23.5: 2.04, 98.0: 3.21, 137.0: 3.56}
    left.plot(list(rows), list(rows.values()), "o", color=GREY, markersize=5, label="Table 1", zorder=5)
    left.set_xlabel("torque [N\u2009m]")
    left.set_ylabel("torsion angle [mrad]")
    legend_above(left, columns=2)
    twist = np.linspace(0.0, float(law.twist(LARGEST_TORQUE)), 800)
    _curve(right, twist, law, CATALOGUE, 0)
    _curve(right, twist, laws()[CUBIC], "cubic (Fig. 6)", 1)
    right.axvspan(0.0, 1e3 * law.half_gap, color="#EEEEEE", zorder=0)
    right.set_xlabel(TWIST)
    right.set_ylabel(TORQUE)
    legend_above(right)
    figure.suptitle("Figs 5 and 6: HDUC 32-100, catalogue pieces and a cubic through them (grey: half the lost motion)", x=0.01, ha="left")
    return figure


def _curve(ax: Axes, twist: Any, law: hm.StiffnessLaw, name: str, index: int) -> None:
    ax.plot(1e3 * twist, law.torque(twist), label=name, **style(index))


def _figures_7_8() -> Figure:
    figure = new_figure(10.5, 4.8)
    left, right = figure.subplots(1, 2)
    found = laws()
    edge = found[CATALOGUE].half_gap
    twist = np.sort(
        np.concatenate([np.linspace(-2.2e-3, 2.2e-3, 1201), [s * edge * (1.0 + d) for s in (-1.0, 1.0) for d in (-1e-9, 1e-9)]])
    )
    for index, name in ((1, JUMP), (2, LITERAL), (0, CATALOGUE)):
        _curve(left, twist, found[name], name, index)
    height = float(found[JUMP].edge_torque)  # type: ignore[attr-defined]
    for letter, sign in (("A", 1.0), ("D", -1.0)):
        left.plot([1e3 * sign * edge], [sign * height], "o", color="black", markersize=5, zorder=5)
        shift = (8, -4) if sign > 0 else (-16, -4)
        left.annotate(letter, (1e3 * sign * edge, sign * height), xytext=shift, textcoords="offset points", fontsize=11, fontweight="bold")
    left.set_title(f"Fig. 7: A and D at \u00b1{1e3 * edge:.3f} mrad, \u00b1{height:.2f} N\u2009m", pad=24)
    for index, name in ((1, CONTINUOUS), (0, CATALOGUE)):
        _curve(right, twist, found[name], name, index)
    right.set_title("Fig. 8", pad=24)
    for ax in (left, right):
        ax.set_xlabel(TWIST)
        ax.set_ylabel(TORQUE)
        ax.set_ylim(-35.0, 35.0)
        legend_above(ax)
    return figure


def _figures_9_10(pulses: Pulses) -> Figure:
    figure = new_figure(10.5, 8.4)
    grid = figure.subplots(3, 2)
    load = load_in_gap()
    fixed = {name: pulses.runs[IN_GAP, name, FIXED] for name in (JUMP, SMOOTHED, CONTINUOUS)}
    whole, short = grid[:, 0], grid[:, 1]
    times = fixed[JUMP].times
    end = times[-1]
    whole[0].plot(times, load.torque(times, 0.0, 0.0), **style(4))
    height = float(laws()[JUMP].edge_torque)  # type: ignore[attr-defined]
    whole[0].axhline(height, color=GREY, linestyle=":", linewidth=1.2)
    whole[0].annotate(f"M_A = {height:.2f} N\u2009m", (end, height), xytext=(-4, -12), textcoords="offset points", ha="right", color=GREY)
    whole[0].set_title("Fig. 9: load torque against M_A at the edge of the gap")
    whole[0].set_ylabel("load torque [N\u2009m]")
    for row, name in ((1, JUMP), (2, CONTINUOUS)):
        width = 0.5 if name == JUMP else 1.3
        whole[row].plot(fixed[name].times, fixed[name].elastic, color=COLOURS[row % 2], linewidth=width, linestyle="-")
        whole[row].set_ylabel(TORQUE)
    whole[1].set_title("Fig. 10: jump law (11)-(14), RungeKutta4 with h = 20 \u00b5s")
    whole[2].set_title("the same with the continuous law (15)-(17)")
    whole[2].set_xlabel("time [s]")
    for ax in whole:
        ax.set_xlim(0.0, end)
    windows = ((FIXED, min(2e-3, 0.1 * end)), ("explicit, coarse", None), (EXPLICIT, None))
    titles = ("part of it", "DormandPrince, tolerance 1e-4", "DormandPrince, tolerance 1e-6")
    for ax, (kind, width), title in zip(short, windows, titles, strict=True):
        run = pulses.runs[IN_GAP, JUMP, kind]
        start = 0.5 * run.times[-1]
        # about ten pulses of an adaptive run
        span = width if width is not None else 10.0 * run.times[-1] / max(run.pulses, 1)
        part = (run.times >= start) & (run.times <= start + span)
        unit, name = (1e3, "ms") if span > 2e-4 else (1e6, "\u00b5s")
        ax.plot(
            unit * (run.times[part] - start), run.elastic[part], color=COLOURS[1], linestyle="-", linewidth=0.9, marker=".", markersize=3
        )
        ax.set_title(f"jump law, {title}: {run.pulses / run.duration:.2g} pulses/s")
        ax.set_xlabel(f"time after {start:.4g} s [{name}]")
        ax.set_ylabel(TORQUE)
    return figure


def _figure_11(shaft: Measured) -> Figure:
    figure = new_figure(7.2, 5.4)
    top, bottom = figure.subplots(2, 1, sharex=True)
    top.plot(shaft.times, load_above_gap().torque(shaft.times, 0.0, 0.0), **style(4))
    top.set_ylabel("load torque [N\u2009m]")
    top.set_title("Fig. 11: load torque and twist of the output shaft, 70 mm x 26 mm, with (15)-(17)")
    bottom.plot(shaft.times, -1e3 * shaft.output_twist, **style(0))
    bottom.set_ylabel("phi_MR - phi_FS [mrad]")
    bottom.set_xlabel("time [s]")
    bottom.set_xlim(0.0, shaft.times[-1])
    return figure


def _contacts(contacts: Mapping[str, Any]) -> Figure:
    figure = new_figure()
    ax = figure.add_subplot()
    times, speed = 1e6 * contacts["times"], contacts["speed"]
    ax.semilogy(times, speed, ".", color=COLOURS[1], markersize=3, label=f"{len(times)} contacts, simulated at a tolerance of 1e-10")
    theory = speed[0] * np.exp(-contacts["growth_rate_theory"] * (contacts["times"] - contacts["times"][0]))
    rate = contacts["growth_rate_theory"]
    ax.semilogy(times, theory, label=f"exp(-t (B_FS + B_wwy)/3J) = exp(-t {rate:.3g}/s)", **style(4))
    ax.set_xlabel("time after a push of 0.02 rad/s [\u00b5s]")
    ax.set_ylabel("speed of contact at the edge [rad/s]")
    ax.set_title("Jump law: contacts get slower and, as the time between them is 2v/a, denser without end", pad=40)
    legend_above(ax, columns=1)
    return figure


def _costs(pulses: Pulses) -> Figure:
    figure = new_figure(10.5, 7.2)
    left, right = figure.subplots(1, 2, sharey=True)
    labels, steps, seconds, colours = [], [], [], []
    order = (CATALOGUE, CUBIC, CONTINUOUS, SMOOTHED, JUMP, LITERAL)
    for (scenario, name, kind), run in sorted(pulses.runs.items(), key=lambda item: (item[0][0], item[0][2])):
        labels.append(f"{scenario} | {kind} | {name}" + ("  FAILED" if run.failure else ""))
        steps.append(np.nan if run.failure else run.steps / run.duration)
        seconds.append(np.nan if run.failure else run.seconds / run.duration)
        colours.append(COLOURS[(0, 5, 3, 2, 1, 6)[order.index(name)]])
    rows = np.arange(len(labels))
    left.barh(rows, steps, color=colours)
    right.barh(rows, seconds, color=colours)
    left.set_yticks(rows, labels, fontsize=7.5)
    left.invert_yaxis()
    left.margins(y=0.01)
    for ax, text in ((left, "steps per simulated second [1/s]"), (right, "CPU time per simulated second [s/s]")):
        ax.set_xscale("log")
        ax.set_xlabel(text)
        ax.grid(axis="y", visible=False)
    return figure


def _reduction(numbers: Mapping[str, Any]) -> Figure:
    figure = new_figure()
    ax = figure.add_subplot()
    errors = {float(factor): 100.0 * error for factor, error in numbers["first_mode_error"].items()}
    ax.loglog(list(errors), list(errors.values()), marker="o", markersize=4, **style(0))
    ax.axhline(1.0, color=GREY, linestyle=":", linewidth=1.2)
    ax.annotate("1 %", (min(errors), 1.0), xytext=(2, 3), textcoords="offset points", color=GREY)
    ax.set_xlabel("stiffness of both shafts over that of the train [1]")
    ax.set_ylabel("error of the first mode with rigid shafts [%]")
    ax.set_title("Two equations instead of four, 20 N\u2009m, continuous law")
    return figure

"""The results of the speed benchmark as text and as a picture."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from matplotlib.figure import Figure

from benchmarks.speed.study import STABILITY
from benchmarks.writing import facts, table
from hdrive_mbs.plots.look import COLOURS, GREY, house_look, new_figure

SYMBOLIC = "engine, symbolic: DormandPrince"
PYTHON = "engine, Python functions: DormandPrince"
LSODA = "scipy LSODA (solve_ivp), Python right side"
ODEINT = "scipy LSODA (odeint), Python right side"
NUMPY = "scipy LSODA (solve_ivp), numpy right side"
LOOPS = ("compiled loop: RungeKutta4", "compiled loop: DormandPrince")


def report(results: Mapping[str, Any]) -> str:
    """Markdown: time at the target error, verdicts, costs around a run, all runs."""
    target = results["target_error"]
    parts = [
        "# Speed of the train",
        f"Start-up from rest under 20 + 5 sin(2 pi t) N m, {results['duration']:g} s simulated. Error: the largest over the angles "
        f"and speeds of the four bodies of max|difference| / max|channel|, at the solver's own times. CPU seconds of the "
        f"integration alone, median of {results['repeats']} interleaved repeats in one process.",
        facts(results["machine"]),
    ]
    for case in results["cases"].values():
        parts += [f"## {case['what'][0].upper()}{case['what'][1:]}", _times(case, target), _verdicts(case)]
    parts += ["## Before and after the integration", _around(results)]
    for case in results["cases"].values():
        parts += [f"## All runs: {case['what']}", _runs(case)]
    return "\n\n".join(parts)


def _times(case: Mapping[str, Any], target: float) -> str:
    fastest = case["methods"][SYMBOLIC]["seconds_at_target"]
    rows = []
    for name, method in case["methods"].items():
        seconds = method["seconds_at_target"]
        if seconds is not None and math.isfinite(seconds):
            rows.append((name, f"{seconds:.4f}", f"{seconds / fastest:.2f}"))
        else:
            best = min((e, s) for e, s in zip(method["error"], method["median_seconds"], strict=True))
            rows.append((name, f"not reached: {best[0]:.1e} in {best[1]:.2f}", "-"))
    agreement = f"Two references (DOP853 at 1e-12, Radau at 1e-11) agree to {case['reference_agreement']:.1e}."
    limit = (
        f"Fastest motion of the linearised train at 20 N m: {case['fastest_rate']:.3g} 1/s; DormandPrince stays stable with steps "
        f"up to about {STABILITY:g} over that, which makes at least {case['fewest_steps']:.0f} steps."
    )
    return f"{agreement} {limit}\n\n" + table((f"method, at an error of {target:g}", "CPU [s]", "over engine, symbolic"), rows)


def ratios(case: Mapping[str, Any]) -> dict[str, float]:
    """How many times longer others take than the engine with symbolic functions, at the target error."""
    at = {name: method["seconds_at_target"] for name, method in case["methods"].items()}
    at = {name: math.nan if seconds is None else seconds for name, seconds in at.items()}  # as JSON has it
    return {name: at.get(name, math.nan) / at[SYMBOLIC] for name in (NUMPY, LSODA, ODEINT, PYTHON, *LOOPS)}


def _verdicts(case: Mapping[str, Any]) -> str:
    ratio = ratios(case)
    rows = [
        ("3x faster than scipy LSODA (solve_ivp), right side with numpy", f"{ratio[NUMPY]:.2f}x", _verdict(ratio[NUMPY] >= 3.0)),
        ("3x faster than the same, right side in tuned scalar Python", f"{ratio[LSODA]:.2f}x", _verdict(ratio[LSODA] >= 3.0)),
        ("the same against its older interface odeint", f"{ratio[ODEINT]:.2f}x", _verdict(ratio[ODEINT] >= 3.0)),
        ("symbolic 2x faster than Python functions", f"{ratio[PYTHON]:.2f}x", _verdict(ratio[PYTHON] >= 2.0)),
    ]
    rows += [(f"distance to the {name}", f"{1.0 / ratio[name]:.1f}x", "stated") for name in LOOPS if math.isfinite(ratio[name])]
    return table(("target", "measured", "verdict"), rows)


def _verdict(reached: bool) -> str:
    return "reached" if reached else "missed"


def _around(results: Mapping[str, Any]) -> str:
    fresh, around = results["fresh_processes"], results["around_a_run"]
    added = fresh["import hdrive_mbs on top [s]"] + fresh["and the names a script uses [s]"]
    first = fresh["first scene: build [s]"] + fresh["first scene: equations, assemble, guard [s]"]
    build = around["build the scene [s]"]
    warm = build + around["equations [s]"] + around["assemble and guard [s]"]
    verdicts = table(
        ("target", "measured", "verdict"),
        [
            ("importing hdrive_mbs takes at most 0.15 s on top of exudyn", f"{added:.3f} s with all names used", _verdict(added <= 0.15)),
            ("building a train scene under 10 ms", f"{1e3 * build:.2f} ms", _verdict(build < 0.01)),
            ("building and assembling it under 10 ms, warm", f"{1e3 * warm:.2f} ms", _verdict(warm < 0.01)),
            ("the same, first call of a process", f"{1e3 * first:.2f} ms", _verdict(first < 0.01)),
        ],
    )
    columns = [(name.replace(" [s]", ""), f"{1e3 * value:.2f}") for name, value in (*fresh.items(), *around.items())]
    note = (
        "CPU time; the first five in fresh processes, the rest warm. "
        f"The run: {results['duration']:g} s simulated at the default tolerances."
    )
    return f"{verdicts}\n\n{note}\n\n" + table(("part", "median [ms]"), columns)


def _runs(case: Mapping[str, Any]) -> str:
    rows = []
    for name, method in case["methods"].items():
        for k, setting in enumerate(method["settings"]):
            times = f"{method['median_seconds'][k]:.4f}", f"{method['best_seconds'][k]:.4f}"
            rows.append((name, f"{setting:g}", f"{method['error'][k]:.1e}", *times, method["samples"][k]))
    return table(("method", "tolerance or step [s]", "error", "median CPU [s]", "best [s]", "samples"), rows)


def figure(results: Mapping[str, Any]) -> Figure:
    """Error against CPU time, one panel per case."""
    with house_look():
        return _figure(results)


def _figure(results: Mapping[str, Any]) -> Figure:
    cases = list(results["cases"].values())
    made = new_figure(5.8 * len(cases), 6.6)
    axes = made.subplots(1, len(cases), sharey=True, sharex=True, squeeze=False)[0]
    colours = {"engine": COLOURS[0], "scipy LSODA": COLOURS[1], "scipy Radau": COLOURS[2], "compiled": COLOURS[4]}
    markers = {"RungeKutta4": "s", "Trapezoidal": "^", "odeint": "v"}
    for ax, case in zip(axes, cases, strict=True):
        for name, method in case["methods"].items():
            colour = next(value for start, value in colours.items() if name.startswith(start))
            line = "--" if "compiled right" in name or "Python functions" in name else ":" if "numpy" in name else "-"
            marker = next((value for word, value in markers.items() if word in name), "o")
            points = [(s, e) for s, e in zip(method["median_seconds"], method["error"], strict=True) if 0.0 < e < math.inf and s > 0.0]
            if points:
                ax.loglog(*zip(*points, strict=True), color=colour, linestyle=line, marker=marker, markersize=5, label=name)
        ax.axhline(results["target_error"], color=GREY, linestyle=":", linewidth=1.2)
        ax.set_xlabel(f"CPU time for {results['duration']:g} s simulated [s]")
        ax.set_title(case["what"])
    axes[0].set_ylabel("error, relative to the largest value of each channel [1]")
    handles, labels = axes[0].get_legend_handles_labels()
    made.legend(handles, labels, loc="outside lower center", ncols=3, fontsize=8)
    return made

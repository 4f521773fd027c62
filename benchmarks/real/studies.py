"""The three studies: numbers for results.json, and pictures."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib.figure import Figure

import hdrive_mbs as hm
from benchmarks.machine import machine
from benchmarks.real import kuka, rk4, staubli
from benchmarks.real.held_out import Unseen, unseen
from benchmarks.real.pictures import histories, planes
from benchmarks.real.rounds import Round, rounds
from hdrive_mbs.diagnosis.bench import Bench
from hdrive_mbs.records.record import Record

FloatArray = npt.NDArray[np.float64]
Study = tuple[dict[str, Any], dict[str, Figure]]

MOST = 4
"""Rounds of a study."""


def kuka_study() -> Study:
    """Axis 1: rounds on runs A and B, every scene tried on run C."""
    started = time.monotonic()
    bench, (out,) = kuka.bench(), kuka.records([kuka.HELD_OUT])
    found = rounds(bench, kuka.records(), kuka.LAWS, step=kuka.STEP, most=MOST)
    tried = _tried(bench, found, out, kuka.STEP)
    numbers = {
        "floor": {name: item.total for name, item in bench.measured.items()},
        "rounds": [_round(item) for item in found],
        "unseen": {name: dict(item.rms) for name, item in tried.items()},
        "late": kuka.lateness(),
        "compliance": kuka.compliance(found[-1]),
        "seconds": time.monotonic() - started,
        "machine": machine(),
    }
    every = kuka.THIN * kuka.SAMPLE_TIME
    figure = histories(tried, every, {"motor_torque": ("motor torque [N m]", 1.0), "link_angle": ("link angle [urad]", 1e6)}, "run C")
    return numbers, {"kuka": figure}


def staubli_study() -> Study:
    """Axes 1 to 4 alone, 5 and 6 together."""
    started = time.monotonic()
    numbers: dict[str, Any] = {"axes": {}}
    figures: dict[str, Figure] = {}
    for axes in ((1,), (2,), (3,), (4,), (5, 6)):
        bench, out = staubli.bench(*axes), staubli.record(staubli.HELD_OUT, *axes)
        laws = staubli.WRIST_LAWS if len(axes) == 2 else staubli.LAWS
        found = rounds(bench, [staubli.record(staubli.SEEN, *axes)], laws, step=staubli.STEP, most=MOST)
        tried = _tried(bench, found, out, staubli.STEP, staubli.start_speeds(staubli.HELD_OUT, *axes))
        numbers["axes"]["+".join(map(str, axes))] = {
            "floor": {name: item.total for name, item in bench.measured.items()},
            "rounds": [_round(item) for item in found],
            "unseen": {name: dict(item.rms) for name, item in tried.items()},
        }
        if len(axes) == 2:
            every = staubli.THIN * staubli.SAMPLE_TIME
            rows = {f"torque_{axis}": (f"torque of axis {axis} [N m]", 1.0) for axis in axes}
            figures["staubli_wrist"] = histories(tried, every, rows, staubli.HELD_OUT)
    numbers |= {
        "published": {str(axis): value for axis, value in staubli.PUBLISHED.items()},
        "coupled": staubli.COUPLED,
        "seconds": time.monotonic() - started,
        "machine": machine(),
    }
    return numbers, figures


CONDITIONS = ("A019", "A020", "A008")
"""12 g mm at each disc at two speeds, 24 g mm at each at one, 60 g mm at disc 1 at one; smaller ones drown in what mountings differ by."""


def rk4_study() -> Study:
    """The run-up with one probe, and known unbalances with four."""
    started = time.monotonic()
    numbers: dict[str, Any] = {}
    for name in ("run_up", *CONDITIONS):
        bench, records = rk4.run_up_case() if name == "run_up" else rk4.dwell_case(name)
        until = rk4.run_up_seen()
        seen = [record.between(0.0, until) for record in records] if name == "run_up" else records
        found = rounds(bench, seen, rk4.LAWS, step=rk4.STEP, most=2)
        own = {"floor": {key: item.total for key, item in bench.measured.items()}, "rounds": [_round(item) for item in found]}
        if name == "run_up":
            own["unseen"] = {key: dict(item.rms) for key, item in _tried(bench, found, records[0], rk4.STEP, since=until).items()}
        else:
            first, second, *_ = next(item for (condition, _), item in rk4.dwells().items() if condition == name)
            own["put_in"] = {"disc_1": abs(first), "disc_2": abs(second)}
        numbers[name] = own
    numbers["planes"] = rk4.planes()
    numbers |= {"seconds": time.monotonic() - started, "machine": machine()}
    return numbers, {"rk4_planes": planes(numbers["planes"])}


STUDIES: dict[str, Callable[[], Study]] = {"kuka": kuka_study, "staubli": staubli_study, "rk4": rk4_study}


def _tried(
    bench: Bench, found: Sequence[Round], out: Record, step: float, speeds: Mapping[str, float] | None = None, since: float = 0.0
) -> dict[str, Unseen]:
    """Every scene of the rounds on a record, or what comes after a time [s], that none has seen; the refitted one is of the first round."""
    at = bench if speeds is None else replace(bench, speeds=speeds)
    scenes: dict[str, hm.Scene] = {"nominal": bench.scene, "refitted": found[0].refit}
    scenes |= {f"round {k}": item.answer.improved for k, item in enumerate(found, start=1) if item.accepted}
    return {name: unseen(at, scene, out, step, since) for name, scene in scenes.items()}


def _round(item: Round) -> dict[str, Any]:
    """What a round said."""
    answer = item.answer
    return {
        "verdict": answer.verdict,
        "accepted": item.accepted,
        "causes": [
            {
                "effect": cause.effect,
                "at": cause.at,
                "law": cause.law,
                "probability": cause.probability,
                "log_odds": cause.log_odds,
                "parameters": {
                    p.name.rpartition(".")[2]: {"value": p.value, "low": p.low, "high": p.high, "unit": p.unit}
                    for p in cause.parameters
                    if p.identifiable
                },
            }
            for cause in answer.causes
        ],
        "tied": [list(label) for label in answer.indistinguishable],
        "ranking": [[c.effect, c.at, c.law, c.log_odds, c.fit, c.held_out] for c in answer.ranking],
        "gap": {kind: [m.value, m.low, m.high] for kind in ("nominal", "refit", "effect") if (m := getattr(answer.gap, kind))},
        "parameters": {p.name: [p.value, p.low, p.high] for p in answer.parameters if math.isfinite(p.value)},
    }

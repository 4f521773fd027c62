"""The three studies: numbers for results.json, and pictures."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib.figure import Figure

import hdrive_mbs as hm
from benchmarks.campaign import Where
from benchmarks.machine import machine
from benchmarks.real import kuka, rk4, staubli
from benchmarks.real.held_out import Unseen, unseen
from benchmarks.real.pictures import histories, planes
from benchmarks.real.rounds import Round, rounds
from hdrive_mbs.diagnosis.bench import Bench
from hdrive_mbs.records.record import Record

FloatArray = npt.NDArray[np.float64]
Study = tuple[dict[str, Any], dict[str, Figure]]
Part = dict[str, Any]
"""Numbers of a part of a study, and ``shown``: what is drawn of it, by model (see ``Unseen``)."""

MOST = 4
"""Rounds of a study."""
CONDITIONS = ("A019", "A020", "A008")
"""12 g mm at each disc at two speeds, 24 g mm at each at one, 60 g mm at disc 1 at one; smaller ones drown in what mountings differ by."""


def kuka_part(name: str) -> Part:
    """Axis 1: rounds on runs A and B, every scene tried on run C."""
    bench, (out,) = kuka.bench(), kuka.records([kuka.HELD_OUT])
    found = rounds(bench, kuka.records(), kuka.LAWS, step=kuka.STEP, most=MOST)
    tried = _tried(bench, found, out, kuka.STEP)
    return {
        "numbers": {
            "floor": {key: item.total for key, item in bench.measured.items()},
            "rounds": [_round(item) for item in found],
            "unseen": {key: dict(item.rms) for key, item in tried.items()},
            "late": kuka.lateness(),
            "compliance": kuka.compliance(found[-1]),
        },
        "shown": _shown(tried),
    }


def staubli_part(name: str) -> Part:
    """An axis alone, or two of them together ("5+6")."""
    axes = tuple(int(axis) for axis in name.split("+"))
    bench, out = staubli.bench(*axes), staubli.record(staubli.HELD_OUT, *axes)
    laws = staubli.WRIST_LAWS if len(axes) == 2 else staubli.LAWS
    found = rounds(bench, [staubli.record(staubli.SEEN, *axes)], laws, step=staubli.STEP, most=MOST)
    tried = _tried(bench, found, out, staubli.STEP, staubli.start_speeds(staubli.HELD_OUT, *axes))
    return {
        "numbers": {
            "floor": {key: item.total for key, item in bench.measured.items()},
            "rounds": [_round(item) for item in found],
            "unseen": {key: dict(item.rms) for key, item in tried.items()},
        },
        "shown": _shown(tried) if len(axes) == 2 else {},
    }


def rk4_part(name: str) -> Part:
    """The run-up with one probe, or a known unbalance with four."""
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
    return {"numbers": own, "shown": {}}


def kuka_study(parts: Mapping[str, Part]) -> Study:
    """Numbers and the picture of the run that no fit saw."""
    [part] = parts.values()
    every = kuka.THIN * kuka.SAMPLE_TIME
    rows = {"motor_torque": ("motor torque [N m]", 1.0), "link_angle": ("link angle [urad]", 1e6)}
    return dict(part["numbers"]), {"kuka": histories(_drawn(part), every, rows, "run C")}


def staubli_study(parts: Mapping[str, Part]) -> Study:
    """Axes 1 to 4 alone, 5 and 6 together."""
    numbers: dict[str, Any] = {"axes": {name: dict(part["numbers"]) for name, part in parts.items()}}
    numbers |= {"published": {str(axis): value for axis, value in staubli.PUBLISHED.items()}, "coupled": staubli.COUPLED}
    figures: dict[str, Figure] = {}
    for name, part in parts.items():
        if part["shown"]:
            rows = {f"torque_{axis}": (f"torque of axis {axis} [N m]", 1.0) for axis in name.split("+")}
            every = staubli.THIN * staubli.SAMPLE_TIME
            figures["staubli_wrist"] = histories(_drawn(part), every, rows, staubli.HELD_OUT)
    return numbers, figures


def rk4_study(parts: Mapping[str, Part]) -> Study:
    """The run-up, known unbalances, and what tells their planes apart."""
    found = rk4.planes()
    return {**{name: dict(part["numbers"]) for name, part in parts.items()}, "planes": found}, {"rk4_planes": planes(found)}


@dataclass(frozen=True, kw_only=True)
class Kind:
    """A study: its parts, which can be worked on side by side, and what is made of them."""

    parts: tuple[str, ...]
    work: Callable[[str], Part]
    whole: Callable[[Mapping[str, Part]], Study]


STUDIES: dict[str, Kind] = {
    "kuka": Kind(parts=("axis 1",), work=kuka_part, whole=kuka_study),
    "staubli": Kind(parts=("1", "2", "3", "4", "5+6"), work=staubli_part, whole=staubli_study),
    "rk4": Kind(parts=("run_up", *CONDITIONS), work=rk4_part, whole=rk4_study),
}


def worked_on(point: Mapping[str, Any]) -> Part:
    """A part of a study (``study``, ``part``: their names)."""
    return STUDIES[point["study"]].work(point["part"])


def studied(name: str, where: Where) -> Study | None:
    """A whole study; None where a part of it failed, which has been said on stderr."""
    kind, facts = STUDIES[name], machine()
    found = where.sweep(worked_on, [{"study": name, "part": part} for part in kind.parts])
    if not found.done.all():
        return None
    numbers, figures = kind.whole(dict(zip(kind.parts, found.values, strict=True)))
    return numbers | {"seconds": float(np.sum(found.seconds)), "machine": facts}, figures


def _shown(tried: Mapping[str, Unseen]) -> dict[str, Any]:
    return {name: {field.name: dict(getattr(item, field.name)) for field in fields(item)} for name, item in tried.items()}


def _drawn(part: Part) -> dict[str, Unseen]:
    return {name: Unseen(**item) for name, item in part["shown"].items()}


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

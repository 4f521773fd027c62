"""The ways at the true model, and whole diagnoses with and without the elimination."""

from __future__ import annotations

import time
from typing import Any

import hdrive_mbs as hm
from benchmarks.in_rotation.case import AT, PLANTED, PlainBench, bench, fan, log
from benchmarks.in_rotation.ways import SHORT, ways
from benchmarks.machine import machine
from hdrive_mbs.diagnosis.bench import Bench
from hdrive_mbs.effects.effect import Effect

FEW: tuple[type[Effect], ...] = (hm.ProbeRunout, hm.GroundVibration, hm.RotorUnbalance)


def study(*, quick: bool, repeats: int) -> dict[str, Any]:
    """Numbers for the results."""
    scene = fan()
    true = scene.with_effect(PLANTED, at=AT)
    record = log(true)
    kinds: dict[str, type[Bench]] = {"run-in alone": PlainBench, "free vibration eliminated": Bench}
    return {
        "about": machine(),
        "planted": {name: value for name, value, _ in PLANTED.fields() if value},
        "laws": len(FEW) if quick else "all",
        "ways": ways(true, record, repeats),
        "diagnoses": [_diagnosed(name, bench(scene, SHORT, kind), record, FEW if quick else None) for name, kind in kinds.items()],
    }


def _diagnosed(name: str, known: Bench, record: hm.Record, laws: tuple[type[Effect], ...] | None) -> dict[str, Any]:
    begun = time.process_time()
    found = hm.diagnose(known, record, candidates=laws, pictures=False)
    values = {item.name.rpartition(".")[2]: item.value for cause in found.causes if cause.at == AT for item in cause.parameters}
    return {
        "way": name,
        "causes": [f"{cause.effect} at {cause.at}" for cause in found.causes],
        "refit": found.gap.refit.value,
        "left": found.gap.effect.value,
        "identified": {field: values[field] for field, value, _ in PLANTED.fields() if value and field in values},
        "seconds": time.process_time() - begun,
        "warnings": list(found.warnings),
    }

"""The rotor bench of the withheld cases: its causes, and how a case is made.

Two rotors on two bearings, driven in closed loop; the data are those of the public data sheet. Integrator, equations and laws are
the plant's own. Each cause is drawn with a strength between 0 (hardly seen) and 1 (strong); the detectability D of each goes into the
truth. Equations: rotor_line/equations.py; laws: rotor_line/laws.py; sizes: rotor_line/*_causes.py and wrong_values.py.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from benchmarks.withheld.case import Case, Cause
from benchmarks.withheld.plant.rotor_line import bearing_causes, shaft_causes, support_causes, unlisted_causes, wrong_values
from benchmarks.withheld.plant.rotor_line.detectability import detectability, linear, nominal, whitened
from benchmarks.withheld.plant.rotor_line.finer_detail import with_finer_detail
from benchmarks.withheld.plant.rotor_line.machine import NOMINAL, disturbed
from benchmarks.withheld.plant.rotor_line.planted import Planted
from benchmarks.withheld.plant.rotor_line.records import UnstableError
from benchmarks.withheld.plant.rotor_line.sensors import MEMORY, measured

Plant = Callable[[Planted, str, float, np.random.Generator], None]
_ROTORS, _BEARINGS, _SUPPORTS = ("rotor_1", "rotor_2"), ("bearing_1", "bearing_2"), ("support_1", "support_2")
_EFFECTS: dict[str, tuple[tuple[str, ...], Plant]] = {
    "unbalance": (_ROTORS, shaft_causes.unbalance),
    "bow": (("shaft",), shaft_causes.bow),
    "misalignment": (("drive_end",), shaft_causes.misalignment),
    "crack": (("shaft",), shaft_causes.crack),
    "rub": (_ROTORS, shaft_causes.rub),
    "internal_damping": (("shaft",), shaft_causes.internal_damping),
    "torque_ripple": (("drive_end",), shaft_causes.torque_ripple),
    "bearing_clearance": (_BEARINGS, bearing_causes.bearing_clearance),
    "bearing_cubic_stiffness": (_BEARINGS, bearing_causes.bearing_cubic_stiffness),
    "bearing_cross_coupling": (_BEARINGS, bearing_causes.bearing_cross_coupling),
    "oil_whirl": (_BEARINGS, bearing_causes.oil_whirl),
    "ball_pass": (_BEARINGS, bearing_causes.ball_pass),
    "looseness": (_SUPPORTS, support_causes.looseness),
    "hidden_mode_support": (_SUPPORTS, support_causes.hidden_mode_support),
}
_PARAMETERS: dict[str, tuple[tuple[str, ...], Plant]] = {
    "parameter_bearing_stiffness": (("bearings", *_BEARINGS), wrong_values.bearing_stiffness),
    "parameter_bearing_damping": (("bearings", *_BEARINGS), wrong_values.bearing_damping),
    "parameter_support_stiffness": (_SUPPORTS, wrong_values.support_stiffness),
    "parameter_shaft_stiffness": (("shaft",), wrong_values.shaft_stiffness),
    "parameter_rotor_mass": (_ROTORS, wrong_values.rotor_mass),
}
_SENSORS: dict[str, tuple[tuple[str, ...], Plant]] = {
    "probe_runout": (("probe_rotor_1", "probe_rotor_2"), wrong_values.probe_runout),
    "probe_gain": (("probe_r1_x", "probe_r1_y", "probe_r2_x", "probe_r2_y"), wrong_values.probe_gain),
}
_UNLISTED: dict[str, tuple[tuple[str, ...], Plant]] = {
    "support_dry_friction": (_SUPPORTS, unlisted_causes.support_dry_friction),
    "support_stiffness_drift": (_SUPPORTS, unlisted_causes.support_stiffness_drift),
    "support_quadratic_damping": (_SUPPORTS, unlisted_causes.support_quadratic_damping),
    "magnetic_pull": (_ROTORS, unlisted_causes.magnetic_pull),
    "floor_vibration": (_SUPPORTS, unlisted_causes.floor_vibration),
    "floor_shocks": (_SUPPORTS, unlisted_causes.floor_shocks),
    "loose_ball": (_ROTORS, unlisted_causes.loose_ball),
    "windage": (("drive_end",), unlisted_causes.windage),
    "seal_drag": (("drive_end",), unlisted_causes.seal_drag),
    "unsymmetric_shaft": (("shaft",), unlisted_causes.unsymmetric_shaft),
}
_KINDS = {"effect": _EFFECTS, "parameter": _PARAMETERS, "sensor": _SENSORS, "unlisted": _UNLISTED}
_PLANTS: dict[str, Plant] = {name: plant for group in _KINDS.values() for name, (_, plant) in group.items()}
CAUSES = tuple(Cause(name=name, places=places, kind=kind) for kind, group in _KINDS.items() for name, (places, _) in group.items())

# pairs whose two names explain nearly the same records (shares left over in the bench's public notes, or one law of the plant)
_TOO_NEAR = (
    {"unbalance", "bow"},
    {"internal_damping", "bearing_cross_coupling"},
    {"bearing_clearance", "bearing_cubic_stiffness"},
)
BARELY = 25.0  # fainter causes are drawn again: nobody could tell them from noise and tolerance
_TRIES = 12


def may_pair(first: tuple[str, str], second: tuple[str, str]) -> bool:
    """Two different effects that leave different traces."""
    return first[0] != second[0] and {first[0], second[0]} not in _TOO_NEAR


def plant(bench: Planted, causes: Sequence[tuple[str, str]], strengths: Sequence[float], seeds: Sequence[int]) -> Planted:
    """Plant causes of given strengths; the seed of each draws its laws and angles."""
    for (name, place), strength, seed in zip(causes, strengths, seeds, strict=True):
        _PLANTS[name](bench, place, strength, np.random.default_rng(seed))
    return bench


def make_case(causes: Sequence[tuple[str, str]], rng: np.random.Generator, *, noise: str = "stated") -> Case:
    """Draw sizes and parameters, simulate and measure; ``noise`` is "stated" (white) or "coloured" (half of it with a memory).

    Parameters, detail, sizes and noise have random streams of their own, so that they do not depend on the causes.
    """
    if noise not in ("stated", "coloured"):
        raise ValueError(f"noise = {noise!r}: choose 'stated' or 'coloured'.")
    of_parameters, of_detail, of_sizes, of_noise = rng.spawn(4)
    values, detail_seed = disturbed(of_parameters), int(of_detail.integers(2**62))
    for _ in range(_TRIES):
        strengths = [float(of_sizes.uniform(0.35, 1.0) if len(causes) > 1 else of_sizes.random()) for _ in causes]
        seeds = [int(of_sizes.integers(2**62)) for _ in causes]
        bench = Planted(values=dict(values))
        detail = with_finer_detail(np.random.default_rng(detail_seed), bench)
        try:
            runs = plant(bench, causes, strengths, seeds).runs()
            visible = _visible(causes, strengths, seeds)
        except UnstableError:
            continue
        if not causes or min(visible["each"]) >= BARELY:
            break
    else:
        raise ArithmeticError(
            f"No stable and visible size of {', '.join(f'{n} at {at}' for n, at in causes)} in {_TRIES} draws; widen its range."
        )
    memory = MEMORY if noise == "coloured" else 0.0
    return Case(
        records={record: measured(run, bench.sensors, of_noise, memory=memory) for record, run in runs.items()},
        truth=[_truth(cause, bench) for cause in causes],
        put_in={
            "effect": _plain(bench.effect),
            "sensor": _plain(bench.sensor),
            "parameter_factors": _plain(bench.factors),
            "causes": [name for name, _ in causes],
            "strength": strengths,
        },
        true_parameters=_plain(bench.values),
        more={"detectability": visible, "finer_detail": _plain(detail), "noise": {"kind": noise, "memory": memory}},
    )


def _visible(causes: Sequence[tuple[str, str]], strengths: Sequence[float], seeds: Sequence[int]) -> dict[str, Any]:
    """Detectability of all causes together, and of each beside the others (see rotor_line.detectability)."""
    if not causes:
        return {"linear": 0.0, "refitted": 0.0, "each": []}
    both = detectability(plant(Planted(values=dict(NOMINAL)), causes, strengths, seeds))
    found = {"linear": both.linear, "refitted": both.refitted, "each": [both.refitted]}
    if len(causes) == 2:
        base = nominal()[0]
        together = whitened(plant(Planted(values=dict(NOMINAL)), causes, strengths, seeds)) - base
        alone = [
            whitened(plant(Planted(values=dict(NOMINAL)), causes[k : k + 1], strengths[k : k + 1], seeds[k : k + 1])) - base for k in (0, 1)
        ]
        found["each"] = [linear(together - alone[1 - k], alone[1 - k]) for k in (0, 1)]
    return found


def _truth(cause: tuple[str, str], bench: Planted) -> dict[str, Any]:
    name, place = cause
    if name in _UNLISTED:
        return {"effect": "unknown", "at": place}
    found: dict[str, Any] = {"effect": name, "at": place}
    ours = {"unbalance": [place.replace("rotor_", "e_r"), place.replace("rotor_", "a_r")]}.get(name, [])
    if name.startswith("parameter_"):
        ours = list(bench.factors)
    if ours or name.startswith("parameter_"):
        found["true_over_nominal"] = {key: float(bench.values[key] / NOMINAL[key]) for key in ours}
    return found


def _plain(values: dict[str, Any]) -> dict[str, Any]:
    """Numbers of numpy as numbers of Python."""
    return {key: value if isinstance(value, (int, str, list, bool)) else float(value) for key, value in values.items()}

"""Static content of Figs 4-8: motor curve, catalogue curve, cubic fit, jump law with A and D, continuous law."""

from __future__ import annotations

from typing import Any

import numpy as np

import hdrive_mbs as hm
from benchmarks.stiffness_laws.claim import Claim, judged
from benchmarks.stiffness_laws.laws import CATALOGUE, CONTINUOUS, CUBIC, JUMP, LARGEST_TORQUE, LITERAL, laws
from models.harmonic_drive_train import build, motor

GRID = 4001
"""Twists at which the laws are compared, evenly from 0 to the twist at 137 N m."""


def shapes() -> tuple[dict[str, Any], list[Claim]]:
    """Deviations of each law from the catalogue curve, and what they do to twist, stiffness and first mode."""
    found = laws()
    curve = found[CATALOGUE]
    twist = np.linspace(0.0, float(curve.twist(LARGEST_TORQUE)), GRID)
    exact = np.asarray(curve.torque(twist))
    numbers: dict[str, Any] = {}
    for name, law in found.items():
        torque = np.asarray(law.torque(twist))
        numbers[name] = {
            "law": law.describe(),
            "largest_deviation": float(np.max(np.abs(torque - exact))),
            "rms_deviation": float(np.sqrt(np.mean((torque - exact) ** 2))),
            "torque_inside_gap": float(law.torque(0.999 * curve.half_gap)),
            "torque_at_edge": float(law.torque(1.000001 * curve.half_gap)),
            "twist_at_5": float(law.twist(5.0)),
            "twist_at_20": float(law.twist(20.0)),
            "first_mode": {str(load): _first_mode(law, load) for load in (5.0, 20.0, 100.0) if _balances(law, load)},
        }
    return {"laws": numbers, "motor": _motor()}, [_figure_4(), _figure_6(numbers), *_figures_7_and_8(numbers)]


def _balances(law: hm.StiffnessLaw, load: float) -> bool:
    """Whether the law has a twist with exactly this torque: the jump laws have none below M_A."""
    return abs(float(law.torque(float(law.twist(load)))) - load) < 1e-6 * load


def _first_mode(law: hm.StiffnessLaw, load: float) -> float:
    return float(hm.modes(build(law), torque=load).undamped[0])


def _motor() -> dict[str, float]:
    curve = motor()
    return {
        "synchronous_speed": curve.synchronous_speed,
        "breakdown_torque": curve.breakdown_torque,
        "breakdown_speed": curve.synchronous_speed * (1.0 - curve.breakdown_slip),
        "starting_torque": float(curve.torque(0.0, 0.0)),
        "rated_torque": float(curve.torque(0.0, curve.rated_speed)),
    }


def _figure_4() -> Claim:
    m, rpm = _motor(), 30.0 / np.pi
    curve = motor()
    return Claim(
        "Fig. 4, (5)-(6)",
        "torque-speed characteristic of an asynchronous motor",
        f"Kloss from the name plate: {m['starting_torque']:.2f} N m at rest, {m['breakdown_torque']:.2f} N m at "
        f"{m['breakdown_speed'] * rpm:.0f} rpm, {m['rated_torque']:.3f} N m at {curve.rated_speed * rpm:.0f} rpm, "
        f"0 at {m['synchronous_speed'] * rpm:.0f} rpm",
        "content reproduced; its numbers are not printed",
    )


def _figure_6(numbers: dict[str, Any]) -> Claim:
    cubic, curve = numbers[CUBIC], numbers[CATALOGUE]
    at_5 = cubic["twist_at_5"] / curve["twist_at_5"] - 1.0
    modes = {load: cubic["first_mode"][load] / curve["first_mode"][load] - 1.0 for load in cubic["first_mode"]}
    return Claim(
        "Fig. 6",
        "a cubic polynomial approximates the change of stiffness",
        f"largest deviation {cubic['largest_deviation']:.1f} N m, rms {cubic['rms_deviation']:.1f} N m, of {LARGEST_TORQUE:g}; "
        f"{cubic['torque_inside_gap']:.1f} N m inside the gap where there is none; twist at 5 N m {100.0 * at_5:+.0f} %; first mode "
        + ", ".join(f"{100.0 * error:+.1f} % at {float(load):g} N m" for load, error in modes.items()),
        judged(max(abs(at_5), *map(abs, modes.values())) < 0.05, "holds in part: not below about T1, where it has no lost motion"),
    )


def _figures_7_and_8(numbers: dict[str, Any]) -> list[Claim]:
    jump, literal, smooth = numbers[JUMP], numbers[LITERAL], numbers[CONTINUOUS]
    best = min(jump["rms_deviation"], literal["rms_deviation"])
    return [
        Claim(
            "Fig. 7, (11)-(14)",
            "behind the gap the stiffness increases to a certain value (A, and D on the other side); not the correct change",
            f"jump at the edge M_A = {jump['torque_at_edge']:.2f} N m (torque), {literal['torque_at_edge']:.2f} N m (literal stiffness); "
            f"the catalogue curve has {numbers[CATALOGUE]['torque_at_edge']:.2f} N m there",
            judged(jump["torque_at_edge"] > 1.0 and literal["torque_at_edge"] > 1.0),
        ),
        Claim(
            "Fig. 8, (15)-(17)",
            "the proposed polynomials describe the change of stiffness better",
            f"{smooth['torque_at_edge']:.2f} N m at the edge; rms deviation {smooth['rms_deviation']:.2f} N m against "
            f"{jump['rms_deviation']:.2f} (jump, torque) and {literal['rms_deviation']:.2f} N m (literal); "
            f"largest {smooth['largest_deviation']:.2f} N m; first mode at 20 N m "
            f"{100.0 * (smooth['first_mode']['20.0'] / numbers[CATALOGUE]['first_mode']['20.0'] - 1.0):+.1f} % of the catalogue law's",
            judged(smooth["rms_deviation"] < best and smooth["torque_at_edge"] < 0.01),
        ),
    ]

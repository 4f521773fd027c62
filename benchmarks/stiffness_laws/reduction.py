"""The model of two equations: when the shafts may be taken as rigid; and (5) put into (1)."""

from __future__ import annotations

from typing import Any

import numpy as np

import hdrive_mbs as hm
from benchmarks.stiffness_laws.claim import Claim, judged
from benchmarks.stiffness_laws.laws import CONTINUOUS, laws
from models.harmonic_drive_train import build, load_above_gap

FACTORS = (0.3, 1.0, 3.0, 10.0, 30.0, 100.0, 300.0)
"""Both shafts' stiffness over that of the train."""

LOAD = 20.0
"""N m, at which the first mode is compared."""


def reduction(duration: float) -> tuple[dict[str, Any], list[Claim]]:
    """First mode and start-up of the reduced model against the full one."""
    scene = build(laws()[CONTINUOUS], load_above_gap())
    errors = {}
    for factor in FACTORS:
        stiffer = scene.replacing(
            {f"{name}.stiffness": factor * scene.parts[name].stiffness for name in ("input_shaft", "output_shaft")}  # type: ignore[attr-defined]
        )
        errors[factor] = float(hm.reduce(stiffer, torque=LOAD).mode_error[0])
    own = hm.reduce(scene, torque=LOAD)
    needed = float(np.exp(np.interp(np.log(0.01), np.log([errors[f] for f in FACTORS[::-1]]), np.log(FACTORS[::-1]))))
    full = hm.simulate(scene, duration, progress=False)
    reduced = hm.simulate(hm.with_rigid_shafts(scene), duration, progress=False)
    peaks = [float(np.max(found["gear.torque"].values)) for found in (full, reduced)]
    numbers = {
        "first_mode_error": {str(factor): error for factor, error in errors.items()},
        "full_first_mode": float(own.full_undamped[0]),
        "reduced_first_mode": float(own.reduced_undamped[0]),
        "shaft_share": own.shaft_share,
        "good_to": own.good_to,
        "factor_for_one_percent": needed,
        "full_peak_torque": peaks[0],
        "reduced_peak_torque": peaks[1],
        "full_steps": full.steps,
        "reduced_steps": reduced.steps,
        "full_seconds": full.seconds,
        "reduced_seconds": reduced.seconds,
    }
    claims = [
        Claim(
            "section 2 [16]",
            "with shafts stiff against the flexspline two equations are enough",
            f"first mode at {LOAD:g} N m {own.full_undamped[0]:.1f} -> {own.reduced_undamped[0]:.1f} rad/s "
            f"({100.0 * errors[1.0]:+.1f} %): the shafts of this "
            f"train hold {100.0 * own.shaft_share:.0f} % of the compliance; they must be {needed:.0f}x stiffer for 1 %",
            judged(errors[1.0] < 0.01, f"does not hold for this train; from {needed:.0f}x stiffer shafts on it does"),
        ),
        Claim(
            "section 2 [16]",
            "(what it saves, and what it misses)",
            f"largest gear torque of the start-up {peaks[0]:.1f} -> {peaks[1]:.1f} N m ({100.0 * (peaks[1] / peaks[0] - 1.0):+.0f} %); "
            f"{full.steps} -> {reduced.steps} steps, {full.seconds:.3f} -> {reduced.seconds:.3f} s of CPU time",
            f"{full.steps / reduced.steps:.0f}x fewer steps",
        ),
    ]
    counted, claim = _rotor_counted_twice(scene, full)
    return {**numbers, **counted}, [*claims, claim]


def _rotor_counted_twice(scene: hm.Scene, full: hm.Response) -> tuple[dict[str, float], Claim]:
    """(5) put into (1):  J_s phi'' = M_s - J_s phi'' - ..., that is a rotor of 2 J_s."""
    twice = hm.simulate(scene.replacing({"motor.inertia": 2.0 * scene.parts["motor"].inertia}), full.times[-1], progress=False)  # type: ignore[attr-defined]
    goal = 0.9 * full["motor.speed"].values[-1]
    reached = [float(found.times[int(np.argmax(found["motor.speed"].values >= goal))]) for found in (full, twice)]
    numbers = {"time_to_90_percent": reached[0], "time_to_90_percent_as_printed": reached[1]}
    return numbers, Claim(
        "(5) in (1)",
        "the motor gives M_n = M_s(n) - J_s phi''",
        f"(1) has J_s phi'' already; counted twice, 90 % of the speed is reached after {1e3 * reached[1]:.1f} ms instead of "
        f"{1e3 * reached[0]:.1f} ms",
        judged(abs(reached[1] / reached[0] - 1.0) < 0.01, "does not hold; M_s(n) belongs into (1)"),
    )

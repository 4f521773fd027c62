"""Figures of the reference rotor line, kept in ``reference_rotor_values.json``.

    python -m tests.verification.reference_rotor_values        calculates them again, in about a minute

Peaks are the largest distance of the geometric centre from the axis, 0-peak, with the rotor's own speed.
``uncertainty`` is the relative difference from a run with the step doubled; at order 4 the error of the
finer run is about a fifteenth of it.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

from tests.verification.reference_rotors import Line, System, full, reference_line, simplified
from tests.verification.reference_run_up import RunUp, exponential
from tests.verification.reference_whirl import critical_speeds, damped_critical_speed, modes, unbalance_torque

PATH = Path(__file__).with_suffix(".json")
END = 2.5
ROTORS = ("rotor_1", "rotor_2")

CASES: dict[str, tuple[Callable[[Line], System], Line, float]] = {
    "m_ref full": (full, reference_line(), 1e-4),
    "m_ref full, linear tilts": (full, reference_line().with_linear_tilts(), 1e-4),
    "m_ref full, gravity": (full, reference_line(gravity=True), 1e-4),
    "m_ref full, bearings 1.2e7 N/m and 1e18 N/m3": (full, reference_line().with_bearings(stiffness=1.2e7, cubic=1e18), 5e-5),
    "m_ref simplified": (simplified, reference_line(), 1e-4),
    "m_ref2 full": (full, reference_line(damped_in_bearing=True), 1e-4),
    "m_ref2 simplified": (simplified, reference_line(damped_in_bearing=True), 1e-4),
}
"""Model, data and step [s]."""


def figures(run: RunUp) -> dict[str, Any]:
    peaks = {rotor: run.peak(rotor) for rotor in ROTORS}
    return {
        "peaks": {rotor: {"amplitude": p.amplitude, "speed": p.speed, "time": p.time} for rotor, p in peaks.items()},
        "final_speed": float(run.rate("rotor_1.phi")[-1]),
        "work": float(run.work[-1]),
        "dissipated": float(run.dissipated[-1]),
    }


def apart(fine: dict[str, Any], coarse: dict[str, Any]) -> dict[str, Any]:
    """Largest relative differences."""
    pairs = [(fine["peaks"][rotor], coarse["peaks"][rotor]) for rotor in ROTORS]
    return {
        **{name: max(abs(b[name] / a[name] - 1) for a, b in pairs) for name in ("amplitude", "speed", "time")},
        **{name: abs(coarse[name] / fine[name] - 1) for name in ("final_speed", "work", "dissipated")},
    }


def linear_figures(system: System) -> dict[str, Any]:
    found = critical_speeds(system, 1500.0)
    first = next(speed for speed, whirl in found if whirl == "forward")
    return {
        "critical_speeds": [
            {"whirl": whirl, "undamped": speed, "damped": damped_critical_speed(system, speed, whirl)} for speed, whirl in found
        ],
        "modes": {
            str(speed): [
                {"whirl": mode.whirl, "frequency": mode.frequency, "damping_ratio": mode.damping_ratio}
                for mode in modes(system, float(speed))
                if mode.frequency < 4000.0
            ]
            for speed in (0, 500, 1000)
        },
        "unbalance_torque_at_first_forward": unbalance_torque(system, first),
    }


def calculate() -> dict[str, Any]:
    values: dict[str, Any] = {}
    for name, (model, line, step) in CASES.items():
        system = model(line)
        fine, coarse = (exponential(system, end=END, step=h) for h in (step, 2 * step))
        values[name] = {
            "step": step,
            **figures(fine),
            "uncertainty": apart(figures(fine), figures(coarse)),
            "energy_error": fine.energy_error,
            **linear_figures(system),
        }
    return values


def load() -> dict[str, Any]:
    return dict(json.loads(PATH.read_text(encoding="utf-8")))


if __name__ == "__main__":
    PATH.write_text(json.dumps(calculate(), indent=1) + "\n", encoding="utf-8")

"""What the status of a run-up has to say: captured, still changing, or at its largest at the end."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from hdrive_mbs.analysis.run_up.run_up_figures import LAST_PART, LineFigures
from hdrive_mbs.analysis.run_up.torque_balance import TorqueBalance
from hdrive_mbs.analysis.time_response import Response
from hdrive_mbs.analysis.unbalance.synchronous_whirl import CriticalSpeed

STEADY = 0.01
"""Largest change of speed or amplitude over a tenth of the run, at its end, that counts as steady."""
FLAT = 0.9
"""Mean amplitude over that tenth, of the largest of the run, from which the run has not come down from a resonance."""


def status(response: Response, figures: LineFigures, criticals: Sequence[CriticalSpeed], notes: Sequence[str]) -> str:
    """``complete`` with what a reader of the peaks has to know, or why the run ended early."""
    done, _, remark = response.status.partition("; ")
    if done != "complete":
        return response.status
    said, end = [*filter(None, [remark]), *notes], float(response.times[-1])
    speeds = [item.speed for item in criticals]
    before = int(np.searchsorted(response.times, (1.0 - LAST_PART) * end, side="right"))
    if figures.balance is not None and figures.captured:
        said.insert(0, _captured(figures.balance, speeds))
    elif abs(figures.final_acceleration) * LAST_PART * end > STEADY * abs(figures.final_speed):
        said.append(f"the speed still changes, by {figures.final_acceleration:.3g} rad/s^2 at the end")
    growing: list[str] = []
    flat: list[str] = []
    for name, rotor in figures.rotors.items():
        whirl, peak = rotor.channels["whirl"][0], rotor.centre.amplitude
        if rotor.centre.time >= end * (1.0 - 1e-9) and float(np.max(whirl[:before])) < (1.0 - STEADY) * peak:
            growing.append(name)
        elif peak > 0.0 and float(np.mean(whirl[before:])) > FLAT * peak:
            flat.append(name)
    if growing:
        said.append(f"the amplitude of {', '.join(growing)} is largest at the very end: give a longer duration")
    passed = [speed for speed in speeds if speed < abs(figures.final_speed)]
    if flat and passed and not figures.captured:
        said.append(
            f"the amplitude of {', '.join(flat)} is largest at the end, though the speed is above the critical speed of"
            f" {max(passed):.5g} rad/s, which is that of the linearised line: a stiffening bearing moves the resonance up, strong damping"
            " leaves none; run up further to see which"
        )
    return "; ".join(["complete", *said])


def _captured(balance: TorqueBalance, criticals: Sequence[float]) -> str:
    text = f"captured: the speed stays at {balance.speed:.5g} rad/s"
    if criticals:
        near = min(criticals, key=lambda speed: abs(speed - abs(balance.speed)))
        text += f", {100.0 * abs(balance.speed) / near:.4g} % of the critical speed of {near:.5g} rad/s"
    drive = f"run up to {balance.driven_speed:.4g} rad/s" if math.isfinite(balance.driven_speed) else "go on running up"
    return f"{text}, where whirl takes {balance.whirl:.3g} of {balance.applied:.3g} N m; without whirl it would {drive}"

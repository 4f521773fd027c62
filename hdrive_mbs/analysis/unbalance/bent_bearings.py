"""What a linear response has to say about bearings that are not linear."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from hdrive_mbs.analysis.unbalance.unbalanced_line import UnbalancedLine

FloatArray = npt.NDArray[np.float64]

TRUSTED = 0.1
"""Change of a stiffness within a turn, over its value, up to which the linear response stands for the line."""


def bent_bearings(model: UnbalancedLine, speeds: FloatArray) -> list[str]:
    """Notes: which forces were linearised, and how much their stiffness changes where they whirl most.

    speeds : where to look for the largest amplitude, ascending
    """
    network, varying = model.line.lines.network, model.line.varying
    lateral = {body.name for body in network.bodies if body.lateral}
    bent = [name for name, on in varying.items() if not on or any(item.partition(":")[2] in lateral for item in on)]
    tabled = [name for name in varying if name not in bent]
    notes = []
    if tabled:
        notes.append(f"coefficients at {_parts(tabled)} change with speed and are those of each speed")
    if bent:
        speed, change = _largest_change(model, bent, speeds)
        advice = ": too much for these amplitudes to be right, simulate that speed" if change > TRUSTED else ""
        notes.append(
            f"forces at {_parts(bent)} are not linear and were linearised about the static deflection at each speed; whirling most, at "
            f"{speed:.6g} rad/s, they change a stiffness by {100.0 * change:.2g} % within a turn{advice}"
        )
    spins = {f"angle:{body.name}" for body in network.bodies if not body.lateral}
    if any(on & spins for on in varying.values()):
        notes.append("some depend on the angle of the spin and were taken at angle 0")
    return notes


def _parts(names: list[str]) -> str:
    return ", ".join(dict.fromkeys(name.partition(".")[0] for name in names))


def _largest_change(model: UnbalancedLine, bent: list[str], speeds: FloatArray) -> tuple[float, float]:
    """Speed of the largest amplitude at the bent coordinates, and the change of the stiffness there in four instants of a turn."""
    line = model.line
    _, amplitudes = model.amplitudes(0, speeds)
    moved = np.abs(amplitudes[:, [line.names.index(name) for name in bent]]).max(axis=1)
    k = int(np.argmax(np.where(np.isfinite(moved), moved, -1.0)))
    point = line.points[int(np.argmin(np.abs(line.knots - speeds[k])))]
    at = [line.lines.names.index(name) for name in line.names]

    def stiffness(turn: complex) -> FloatArray:
        away = dict(zip(line.names, np.real(amplitudes[k] * turn).tolist(), strict=True))
        angles = {name: angle + away.get(name, 0.0) for name, angle in point.angles.items()}
        return line.lines.at(angles, point.speeds, point.states).stiffness[np.ix_(at, at)]

    still = stiffness(0.0)
    size = np.sqrt(np.abs(np.diag(still)))
    scale = np.outer(size, size) + np.finfo(float).tiny
    changes = [float(np.max(np.abs(stiffness(turn) - still) / scale)) for turn in (1.0, 1j, -1.0, -1j)]
    return float(speeds[k]), max(changes)

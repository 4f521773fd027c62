"""Damped modes of a rotor line at a speed: whirl, torsion and axial motion."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from heapq import merge

import numpy as np

from hdrive_mbs.analysis.decay_note import decay_note
from hdrive_mbs.analysis.result import Result
from hdrive_mbs.analysis.whirl.line_block import BlockModel, line_blocks
from hdrive_mbs.analysis.whirl.roots import ComplexArray, FloatArray
from hdrive_mbs.analysis.whirl.spinning_line import SpinningLine
from hdrive_mbs.analysis.whirl.station_shapes import StationShapes
from hdrive_mbs.analysis.whirl.whirl_kind import WhirlKinds
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.printed_table import PrintedTable
from hdrive_mbs.scene import Scene

STABLE = 1e-9
"""Damping ratio down to minus this counts as zero: rounding of an undamped line."""


@dataclass(frozen=True, kw_only=True, eq=False)
class WhirlModes(Result):
    """Modes q = Re[shape exp(lambda t)] about steady rotation, seen from the fixed frame, ascending in |lambda|.

    speed : of the reference shaft [rad/s]
    eigenvalues : lambda = -damping + i frequency [1/s], (m,), of what oscillates
    frequencies : damped frequency Im(lambda) [rad/s], the one that is seen
    natural : |lambda| [rad/s]; with damping or gyroscopic moments this is not the frequency of the undamped line
    damping_ratios : -Re(lambda)/|lambda|; negative where the mode grows
    whirl : "forward", "backward", "torsional", "axial" or "mixed" (places whirl in opposite senses, or in straight
        lines, which are forward and backward circles of equal size)
    circularity : +1 forward circles, 0 straight lines, -1 backward circles
    places, positions : names of the p places and their positions along the axis [m]
    shapes : (m, p, 6), complex x, y, z, psi, theta, phi of each place, true sense; the largest amplitude is 1, 0-peak
    decay_rates : -Re(lambda) of motions that do not oscillate [1/s], ascending (damping ratio above 0.999)
    free_motions : number of motions that no spring resists (turning of a line without a load, sliding)
    """

    speed: float
    eigenvalues: ComplexArray
    frequencies: FloatArray
    natural: FloatArray
    damping_ratios: FloatArray
    whirl: tuple[str, ...]
    circularity: FloatArray
    places: tuple[str, ...]
    positions: FloatArray
    shapes: ComplexArray
    decay_rates: FloatArray
    free_motions: int

    @property
    def log_decrements(self) -> FloatArray:
        """ln of the ratio of successive peaks, 2 pi damping / frequency."""
        return np.asarray(-2.0 * np.pi * self.eigenvalues.real / self.eigenvalues.imag)

    @property
    def stable(self) -> bool:
        """Whether no motion grows."""
        return bool(np.all(self.damping_ratios >= -STABLE) and np.all(self.decay_rates >= 0.0))

    def tables(self) -> tuple[PrintedTable, ...]:
        """Whirl, frequency and damping of each mode."""
        heads = ("mode", "whirl", "damped [rad/s]", "|eigenvalue| [rad/s]", "damping ratio", "log decrement")
        numbers = (values.tolist() for values in (self.frequencies, self.natural, self.damping_ratios, self.log_decrements))
        rows = tuple((str(k), *row) for k, row in enumerate(zip(self.whirl, *numbers, strict=True), start=1))
        free = (f"{self.free_motions} motions are held by no spring",) if self.free_motions else ()
        title = f"modes at {self.speed:g} rad/s"
        return (PrintedTable(title=title, heads=heads, rows=rows, notes=(*free, *decay_note(self.decay_rates))),)

    def columns(self) -> dict[str, np.ndarray]:
        return {
            "mode": np.arange(1, len(self.frequencies) + 1),
            "whirl": np.array(self.whirl),
            "damped frequency [rad/s]": self.frequencies,
            "|eigenvalue| [rad/s]": self.natural,
            "damping ratio [1]": self.damping_ratios,
            "log decrement [1]": self.log_decrements,
            "circularity [1]": self.circularity,
        }


def whirl_modes(scene: Scene, speed: float = 0.0, *, count: int | None = 12) -> WhirlModes:
    """Modes of the line turning steadily at a speed [rad/s] of its reference shaft (the motor).

    count : how many of the lowest modes; None for all

    Bearings that are not linear are taken about the static deflection at this speed; rotors count as balanced;
    first-order states (hysteresis, a servo) are held.  At rest, modes of equal frequency come as the whirl into which they
    part at small speed, backward before forward.  Raises AnalysisError where no steady rotation exists.
    """
    check_speed("speed", speed)
    check_count(count)
    line = SpinningLine(scene)
    kinds, stations = WhirlKinds(line), StationShapes(line.network, line.names)
    form = kinds.form()
    found: list[list[tuple[complex, str, float, ComplexArray]]] = []
    decay: list[float] = []
    free = 0
    for block in line_blocks(line):
        model = BlockModel(block, form[np.ix_(block.index, block.index)])
        roots = model.solve(float(speed))
        decay += roots.decay.tolist()
        free += roots.free
        kept = roots.lowest(len(roots.values) if count is None else count)
        shapes = model.shapes(kept)
        words, circularity = kinds.classify(block.index, shapes, np.full(shapes.shape[1], -1.0 if speed < 0.0 else 1.0))
        found.append(list(zip(kept.values.tolist(), words, circularity.tolist(), stations.of(block.index, shapes, words), strict=True)))
    modes = list(merged(found))[:count]
    values = np.array([mode[0] for mode in modes], complex)
    ratios = -values.real / np.abs(values)
    return WhirlModes(
        scene=scene,
        status=_status(ratios, np.array(decay)),
        settings={"speed": float(speed), "count": count},
        speed=float(speed),
        eigenvalues=values,
        frequencies=values.imag,
        natural=np.abs(values),
        damping_ratios=ratios,
        whirl=tuple(mode[1] for mode in modes),
        circularity=np.array([mode[2] for mode in modes]),
        places=stations.places,
        positions=stations.positions,
        shapes=np.array([mode[3] for mode in modes]).reshape(len(modes), len(stations.places), 6),
        decay_rates=np.sort(np.array(decay)),
        free_motions=free,
    )


def merged(blocks: Iterable[list[tuple[complex, str, float, ComplexArray]]]) -> Iterable[tuple[complex, str, float, ComplexArray]]:
    """Modes of all blocks by |lambda|, without changing the order within a block (multiple roots)."""
    return merge(*blocks, key=lambda mode: abs(mode[0]))


def check_speed(name: str, speed: float) -> None:
    """Raise ParameterError for a speed that is not a finite number."""
    if not np.isfinite(speed):
        raise ParameterError(f"{name} = {speed} rad/s: must be a finite number.")


def check_count(count: int | None) -> None:
    """Raise ParameterError for a number of modes below 1."""
    if count is not None and (count != int(count) or count < 1):
        raise ParameterError(f"count = {count}: must be a whole number of at least 1, or None for all that matter.")


def _status(ratios: FloatArray, decay: FloatArray) -> str:
    notes = ["complete"]
    growing = int(np.sum(ratios < -STABLE))
    if growing:
        notes.append(f"unstable: {growing} of these modes grow{'s' if growing == 1 else ''}")
    if np.any(decay < 0.0):
        notes.append("unstable: a motion grows without oscillating")
    return "; ".join(notes)

"""Campbell diagram of a rotor line: whirl, torsional and axial branches over speed, critical speeds, stability."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from heapq import merge

import numpy as np
import numpy.typing as npt

from hdrive_mbs.analysis.campbell_tables import NONE_MET, branch_table, unrounded
from hdrive_mbs.analysis.drive_train.campbell import ExcitationOrder
from hdrive_mbs.analysis.result import Result
from hdrive_mbs.analysis.whirl.block_branches import FEWEST, BlockBranches
from hdrive_mbs.analysis.whirl.crossings import order_lines, zeros
from hdrive_mbs.analysis.whirl.line_block import LineBlock, line_blocks
from hdrive_mbs.analysis.whirl.mode_tracking import NONE
from hdrive_mbs.analysis.whirl.roots import ComplexArray, FloatArray
from hdrive_mbs.analysis.whirl.spinning_line import SpinningLine
from hdrive_mbs.analysis.whirl.whirl_kind import WhirlKinds
from hdrive_mbs.analysis.whirl.whirl_modes import STABLE, check_count
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.printed_table import PrintedTable, thinned
from hdrive_mbs.progress import progress_bar
from hdrive_mbs.scene import Scene

HEAVY = 0.2
"""Damping ratio from which a critical speed is marked: amplification 1/(2 zeta) below 2.5, where API RP 684 no longer counts it."""

BACKWARD = -0.98
"""Circularity below which a backward whirl is marked: forward circles, which alone unbalance drives, have 10 % of its amplitude."""

ABOVE = 1.5
"""Modes up to this multiple of the highest order line are calculated where no number of branches is given."""


@dataclass(frozen=True, kw_only=True, eq=False)
class WhirlCampbell(Result):
    """Damped frequencies over the speed of the reference shaft, tracked through crossings.

    speeds : rad/s, (s,), ascending
    frequencies : damped frequency of each branch [rad/s], (s, b); NaN where the branch does not oscillate
    damping_ratios : (s, b); negative where the branch grows
    natural : |lambda| of each branch [rad/s], (s, b)
    whirl : of each branch "forward", "backward", "torsional", "axial", or "mixed" where it is neither forward nor
        backward at most speeds
    whirl_at : the same word at each speed, (s, b); "" where the branch does not exist
    circularity : (s, b), +1 forward circles, 0 straight lines, -1 backward circles
    stable : at each speed, whether none of the calculated motions grows, (s,)
    order_numbers, order_places, order_slopes : the order lines, frequency = slope * |speed|
    critical_speeds : where a branch meets an order line [rad/s], ascending, found on the line itself
    critical_orders, critical_branches : index of the order line and of the branch
    critical_whirl, critical_damping_ratios : of the mode there
    critical_notes : "", or why unbalance does not excite this crossing much: "backward" (nearly circles; a flat backward
        orbit of unequal bearings is excited), "other shaft" (nothing but torque joins it to the shaft of the order),
        "heavily damped", "axial", ...
    threshold_speeds : where a branch begins or ceases to grow [rad/s], ascending
    threshold_branches, threshold_frequencies : which branch, and its frequency there [rad/s]
    threshold_notes : "unstable above" or "stable above"
    """

    speeds: FloatArray
    frequencies: FloatArray
    damping_ratios: FloatArray
    natural: FloatArray
    whirl: tuple[str, ...]
    whirl_at: npt.NDArray[np.str_]
    circularity: FloatArray
    stable: npt.NDArray[np.bool_]
    order_numbers: tuple[float, ...]
    order_places: tuple[str, ...]
    order_slopes: tuple[float, ...]
    critical_speeds: FloatArray
    critical_orders: tuple[int, ...]
    critical_branches: tuple[int, ...]
    critical_whirl: tuple[str, ...]
    critical_damping_ratios: FloatArray
    critical_notes: tuple[str, ...]
    threshold_speeds: FloatArray
    threshold_branches: tuple[int, ...]
    threshold_frequencies: FloatArray
    threshold_notes: tuple[str, ...]

    @property
    def log_decrements(self) -> FloatArray:
        """ln of the ratio of successive peaks, 2 pi zeta / sqrt(1 - zeta^2), (s, b)."""
        return np.asarray(2.0 * np.pi * self.damping_ratios * self.natural / self.frequencies)

    def tables(self) -> tuple[PrintedTable, ...]:
        """The branches at the first and the last speed, the critical speeds, and where branches begin or cease to grow."""
        criticals = {name: values for name, values in self.critical_columns().items() if not name.startswith("frequency")}
        criticals["damping ratio [1]"] = np.array([unrounded(float(value)) for value in self.critical_damping_ratios])
        found = [branch_table(self.speeds, self.frequencies, self.damping_ratios, "damped", self.whirl)]
        found.append(thinned(criticals, title="critical speeds") if len(self.critical_speeds) else NONE_MET)
        if len(self.threshold_speeds):
            limits = {
                "speed [rad/s]": self.threshold_speeds,
                "mode": np.array(self.threshold_branches, int) + 1,
                "frequency [rad/s]": self.threshold_frequencies,
                "note": np.array(self.threshold_notes),
            }
            found.append(thinned(limits, title="thresholds of stability"))
        return tuple(found)

    def columns(self) -> dict[str, np.ndarray]:
        table: dict[str, np.ndarray] = {"speed [rad/s]": self.speeds}
        decrements = self.log_decrements
        for k, word in enumerate(self.whirl):
            table[f"mode {k + 1} {word} damped frequency [rad/s]"] = self.frequencies[:, k]
            table[f"mode {k + 1} damping ratio [1]"] = self.damping_ratios[:, k]
            table[f"mode {k + 1} log decrement [1]"] = decrements[:, k]
            table[f"mode {k + 1} whirl"] = self.whirl_at[:, k]
        return table

    def critical_columns(self) -> dict[str, np.ndarray]:
        """The critical speeds as a table, for ``write_csv``."""
        slopes = np.array([self.order_slopes[order] for order in self.critical_orders])
        with np.errstate(divide="ignore"):
            amplification = 0.5 / self.critical_damping_ratios
        return {
            "critical speed [rad/s]": self.critical_speeds,
            "order": np.array([self.order_numbers[order] for order in self.critical_orders]),
            "of": np.array([self.order_places[order] for order in self.critical_orders]),
            "frequency [rad/s]": slopes * np.abs(self.critical_speeds),
            "mode": np.array(self.critical_branches, int) + 1,
            "whirl": np.array(self.critical_whirl),
            "damping ratio [1]": self.critical_damping_ratios,
            "amplification 1/(2 zeta) [1]": np.where(self.critical_damping_ratios > STABLE, amplification, np.inf),
            "note": np.array(self.critical_notes),
        }


def campbell(
    scene: Scene,
    speeds: Sequence[float] | FloatArray,
    orders: Sequence[float] | Mapping[str, Sequence[float]] = (1.0,),
    *,
    count: int | None = None,
    progress: bool | None = None,
) -> WhirlCampbell:
    """Damped modes at each speed of the reference shaft (the motor), joined to branches; critical speeds and thresholds.

    speeds : rad/s, increasing, at least two
    orders : multiples of the speed that may excite, or place -> multiples of the speed of that place
    count : number of branches, those that come lowest; None for all that come near the highest order line, at least six

    Branches are joined by their right and left shapes, with smaller steps where that leaves a doubt.  Critical speeds
    are roots of the eigenvalue problem, not of a line between two speeds.  Bearings that are not linear are taken about the
    static deflection at each speed; rotors count as balanced; first-order states are held.  Raises ParameterError for
    speeds that do not increase, AnalysisError where no steady rotation exists.
    """
    grid = _grid(speeds)
    check_count(count)
    line = SpinningLine(scene)
    lines = order_lines(line.network, orders)
    highest = ABOVE * max((order.slope for order in lines), default=0.0) * float(np.max(np.abs(grid)))
    kinds = WhirlKinds(line)
    form = kinds.form()
    blocks = line_blocks(line)
    with progress_bar(f"{scene.name}: Campbell", len(blocks) * len(grid), progress) as report:
        done = itertools.count(1)

        def step() -> None:
            if report is not None:
                report(next(done))

        parts = [
            BlockBranches(block, form[np.ix_(block.index, block.index)], grid, needed=count, highest=highest, report=step)
            for block in blocks
        ]
    branches = [_Branch(part, column) for part, column in _chosen(parts, count, highest)]
    values = np.array([branch.values for branch in branches]).T.reshape(len(grid), len(branches))
    direction = np.where(grid < 0.0, -1.0, 1.0)
    words, circularity = _classified(kinds, branches, direction)
    criticals = _criticals(kinds, grid, branches, lines)
    thresholds = _thresholds(grid, branches)
    ratios = _ratio(values)
    stable = np.array([_is_stable(parts, row) for row in range(len(grid))])
    return WhirlCampbell(
        scene=scene,
        status=_status(grid, stable, thresholds, any(np.any(part.roots(row).decay < 0.0) for part in parts for row in range(len(grid)))),
        settings={"speeds": f"{grid[0]:g} .. {grid[-1]:g} rad/s, {len(grid)} points", "count": count},
        speeds=grid,
        frequencies=values.imag,
        damping_ratios=ratios,
        natural=np.abs(values),
        whirl=tuple(_word(words[:, k]) for k in range(len(branches))),
        whirl_at=words,
        circularity=circularity,
        stable=stable,
        order_numbers=tuple(order.order for order in lines),
        order_places=tuple(order.place for order in lines),
        order_slopes=tuple(order.slope for order in lines),
        critical_speeds=np.array([critical.speed for critical in criticals]),
        critical_orders=tuple(critical.order for critical in criticals),
        critical_branches=tuple(critical.branch for critical in criticals),
        critical_whirl=tuple(critical.whirl for critical in criticals),
        critical_damping_ratios=np.array([critical.damping_ratio for critical in criticals]),
        critical_notes=tuple(critical.note for critical in criticals),
        threshold_speeds=np.array([threshold.speed for threshold in thresholds]),
        threshold_branches=tuple(threshold.branch for threshold in thresholds),
        threshold_frequencies=np.array([threshold.frequency for threshold in thresholds]),
        threshold_notes=tuple(threshold.note for threshold in thresholds),
    )


@dataclass(frozen=True)
class _Branch:
    """One column of a block's table."""

    part: BlockBranches
    column: int

    @property
    def values(self) -> ComplexArray:
        return np.asarray(self.part.values[:, self.column])


@dataclass(frozen=True)
class _Critical:
    speed: float
    order: int
    branch: int
    whirl: str
    circularity: float
    damping_ratio: float
    per_turn: float
    elsewhere: bool

    @property
    def note(self) -> str:
        notes = ["backward"] if self.whirl == "backward" and self.circularity < BACKWARD else []
        notes += ["other shaft"] if self.elsewhere else []
        notes += ["axial"] if self.whirl == "axial" and self.per_turn == 1.0 else []
        notes += ["heavily damped"] if self.damping_ratio > HEAVY else []
        notes += ["unstable"] if self.damping_ratio < -STABLE else []
        return ", ".join(notes)


@dataclass(frozen=True)
class _Threshold:
    speed: float
    branch: int
    frequency: float
    note: str


def _grid(speeds: Sequence[float] | FloatArray) -> FloatArray:
    try:
        grid = np.asarray(speeds, float)
    except (TypeError, ValueError):
        grid = np.zeros(0)
    if grid.ndim != 1 or len(grid) < 2 or not np.all(np.isfinite(grid)):
        raise ParameterError("speeds: give at least two speeds of the reference shaft [rad/s] in increasing order.")
    falls = np.flatnonzero(np.diff(grid) <= 0.0)
    if len(falls):
        k = int(falls[0])
        raise ParameterError(
            f"speeds: must increase, but {grid[k + 1]:g} rad/s follows {grid[k]:g} rad/s. Give them in increasing order; a line that "
            "turns the other way round has negative speeds."
        )
    return grid


def _chosen(parts: list[BlockBranches], count: int | None, highest: float) -> list[tuple[BlockBranches, int]]:
    """The branches that are shown: by |lambda| at the first speed, later ones behind."""
    smallest = []
    for part in parts:
        for column in range(part.values.shape[1]):
            size, frequency = np.abs(part.values[:, column]), part.values[:, column].imag
            smallest.append((float(np.nanmin(size)), float(np.nanmin(frequency)), part, column))
    smallest.sort(key=lambda item: item[0])
    if count is None:
        count = max(FEWEST, sum(size < highest and frequency < highest / ABOVE for size, frequency, _, _ in smallest))
        inside = [item for item in smallest if item[0] < highest and item[1] < highest / ABOVE]
        smallest = inside + [item for item in smallest if item not in inside]
    kept = {(id(part), column) for _, _, part, column in smallest[:count]}
    starts, late = [], []
    for part in parts:
        own = [column for column in range(part.values.shape[1]) if (id(part), column) in kept]
        starts.append([(abs(part.values[0, column]), part, column) for column in own if part.table[0, column] != NONE])
        late += [(part, column) for column in own if part.table[0, column] == NONE]
    return [(part, column) for _, part, column in merge(*starts, key=lambda item: item[0])] + late


def _classified(kinds: WhirlKinds, branches: list[_Branch], direction: FloatArray) -> tuple[npt.NDArray[np.str_], FloatArray]:
    words = np.full((len(direction), len(branches)), "", dtype="<U9")
    circularity = np.full(words.shape, np.nan)
    for part in dict.fromkeys(branch.part for branch in branches):
        own = [k for k, branch in enumerate(branches) if branch.part is part]
        columns = np.array([branches[k].column for k in own])
        places, shapes, signs = [], [], []
        for row in range(len(direction)):
            there = part.table[row, columns] != NONE
            places += [(row, k) for k, is_there in zip(own, there, strict=True) if is_there]
            shapes.append(part.shapes(row, columns[there]))
            signs.append(np.full(int(there.sum()), direction[row]))
        found, circles = kinds.classify(part.block.index, np.hstack(shapes), np.concatenate(signs))
        for (row, k), word, value in zip(places, found, circles, strict=True):
            words[row, k], circularity[row, k] = word, value
    return words, circularity


def _word(words: npt.NDArray[np.str_]) -> str:
    """The word that holds at most speeds; "mixed" where forward and backward both hold at more than a tenth of them."""
    known = [str(word) for word in words if word]
    share = {word: known.count(word) / len(known) for word in dict.fromkeys(known)}
    if min(share.get("forward", 0.0), share.get("backward", 0.0)) > 0.1:
        return "mixed"
    return max(share, key=lambda word: share[word])


def _criticals(kinds: WhirlKinds, grid: FloatArray, branches: list[_Branch], lines: list[ExcitationOrder]) -> list[_Critical]:
    found = []
    for number, branch in enumerate(branches):
        for order, line in enumerate(lines):
            slopes = branch.part.slopes(branch.column)
            rates = None if slopes is None else slopes.imag - line.slope * np.sign(grid)
            gap = branch.values.imag - line.slope * np.abs(grid)

            def exact(speed: float, branch: _Branch = branch, line: ExcitationOrder = line) -> float:
                there = branch.part.at(branch.column, speed)
                return np.nan if there is None else there[0].imag - line.slope * abs(speed)

            for speed in zeros(grid, gap, exact, rates):
                there = branch.part.at(branch.column, speed)
                if there is not None:
                    value, shape = there
                    words, circles = kinds.classify(branch.part.block.index, shape, np.array([-1.0 if speed < 0.0 else 1.0]))
                    damping = -value.real / abs(value)
                    elsewhere = _is_elsewhere(branch.part.block, line)
                    found.append(_Critical(speed, order, number, words[0], float(circles[0]), damping, line.order, elsewhere))
    return sorted(found, key=lambda critical: critical.speed)


def _is_elsewhere(block: LineBlock, line: ExcitationOrder) -> bool:
    """Whether a motion is of stations that all turn at another speed than the place of the order, and of no spin."""
    ratios = block.line.ratios
    if any(name in ratios for name in block.names):
        return False
    own = {abs(ratios[station]) for station in (name.rpartition(".")[0] for name in block.names) if station in ratios}
    turning = line.slope / line.order
    return bool(own) and all(abs(ratio - turning) > 1e-6 * max(ratio, turning) for ratio in own)


def _thresholds(grid: FloatArray, branches: list[_Branch]) -> list[_Threshold]:
    """Where branches begin or cease to grow: Re(lambda) = 0, or the edge of rounding where the other side is undamped."""
    found = []
    for number, branch in enumerate(branches):
        growth = -_ratio(branch.values)
        for k in np.flatnonzero((growth[:-1] > STABLE) != (growth[1:] > STABLE)):
            if not np.isfinite(growth[k] + growth[k + 1]):
                continue
            edge = 0.0 if min(growth[k], growth[k + 1]) < -STABLE else STABLE

            def exact(speed: float, branch: _Branch = branch, edge: float = edge) -> float:
                there = branch.part.at(branch.column, speed)
                return np.nan if there is None else -float(_ratio(np.array([there[0]]))[0]) - edge

            for speed in zeros(grid[k : k + 2], growth[k : k + 2] - edge, exact):
                there = branch.part.at(branch.column, speed)
                if there is not None:
                    note = "unstable above" if growth[k + 1] > STABLE else "stable above"
                    found.append(_Threshold(speed, number, there[0].imag, note))
    return sorted(found, key=lambda threshold: threshold.speed)


def _ratio(values: ComplexArray) -> FloatArray:
    """Damping ratio."""
    return np.asarray(-values.real / np.abs(values))


def _is_stable(parts: list[BlockBranches], row: int) -> bool:
    for part in parts:
        roots = part.roots(row) if part.model.is_whole else part.tracker.roots(float(part.speeds[row]))
        if np.any(roots.values.real > STABLE * np.abs(roots.values)) or np.any(roots.decay < 0.0):
            return False
    return True


def _status(grid: FloatArray, stable: npt.NDArray[np.bool_], thresholds: list[_Threshold], runs_away: bool) -> str:
    notes = ["complete"]
    notes += [f"{threshold.note} {threshold.speed:.6g} rad/s (mode {threshold.branch + 1})" for threshold in thresholds]
    if not np.all(stable) and not thresholds:
        where = f"at {int(np.sum(~stable))} speeds, first {grid[int(np.argmin(stable))]:.6g} rad/s" if np.any(stable) else "at all speeds"
        notes.append(f"unstable {where}")
    if runs_away:
        notes.append("a motion grows without oscillating (a spring that pushes, or a motor whose torque rises with the speed)")
    return "; ".join(notes)

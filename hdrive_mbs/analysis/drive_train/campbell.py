"""Torsional Campbell diagram: natural frequencies over speed, excitation orders, critical speeds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.optimize import linear_sum_assignment

from hdrive_mbs.analysis.campbell_tables import NONE_MET, branch_table
from hdrive_mbs.analysis.drive_train.modes import Modes, matching_damping, modes_at
from hdrive_mbs.analysis.operating_point import at_speed, operating_point, with_load
from hdrive_mbs.analysis.result import Result
from hdrive_mbs.analysis.whirl.spinning_line import without_unbalance
from hdrive_mbs.engine.assembly import assemble
from hdrive_mbs.errors import ParameterError, unknown_place
from hdrive_mbs.printed_table import PrintedTable
from hdrive_mbs.progress import progress_bar
from hdrive_mbs.scene import Scene

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class ExcitationOrder:
    """A line  frequency = order * |speed of a place|  in a Campbell diagram."""

    order: float
    place: str
    slope: float
    """Frequency per motor speed: order times the ideal speed ratio of the place."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Campbell(Result):
    """Tracked torsional frequencies over the motor speed.

    speeds : motor speed [rad/s], shape (s,), ascending
    frequencies : undamped natural frequency of each branch [rad/s], shape (s, b); NaN where the
        branch does not exist (a gap has opened)
    damping_ratios : damping ratio of the damped mode that belongs to the branch, shape (s, b); NaN
        where damping turns it into pure decay
    order_numbers, order_places, order_slopes : the excitation lines
    critical_speeds : motor speed of each crossing [rad/s], ascending
    critical_orders, critical_branches : which line and which branch (index) cross there
    """

    speeds: FloatArray
    frequencies: FloatArray
    damping_ratios: FloatArray
    order_numbers: tuple[float, ...]
    order_places: tuple[str, ...]
    order_slopes: tuple[float, ...]
    critical_speeds: FloatArray
    critical_orders: tuple[int, ...]
    critical_branches: tuple[int, ...]

    def tables(self) -> tuple[PrintedTable, ...]:
        """The branches at the first and the last speed, and the critical speeds."""
        criticals = tuple(
            (float(speed), f"{self.order_numbers[order]:g} x {self.order_places[order]}", str(branch + 1))
            for speed, order, branch in zip(self.critical_speeds, self.critical_orders, self.critical_branches, strict=True)
        )
        met = PrintedTable(title="critical speeds", heads=("speed [rad/s]", "order", "mode"), rows=criticals)
        return (branch_table(self.speeds, self.frequencies, self.damping_ratios, "undamped"), met if criticals else NONE_MET)

    def columns(self) -> dict[str, np.ndarray]:
        table: dict[str, np.ndarray] = {"motor speed [rad/s]": self.speeds}
        for k in range(self.frequencies.shape[1]):
            table[f"mode {k + 1} undamped [rad/s]"] = self.frequencies[:, k]
            table[f"mode {k + 1} damping ratio [1]"] = self.damping_ratios[:, k]
        return table


def torsional_campbell(
    scene: Scene,
    speeds: Sequence[float] | FloatArray,
    *,
    orders: Mapping[str, Sequence[float]] | None = None,
    torque: float | None = None,
    progress: bool | None = None,
) -> Campbell:
    """Modes at each motor speed, tracked by their shapes through crossings.

    speeds : motor speeds [rad/s], increasing, at least two
    orders : place -> excitation orders per turn of that place, e.g. ``{"gear.wave_generator": (1, 2, 4)}``;
        by default 1 and 2 of the motor
    torque : load torque [N m] in place of the scene's own load at t = 0

    Of a rotor line these are the torsional branches alone; ``campbell`` gives whirl, torsion and axial motion together.
    A train without speed-dependent stiffness has level branches; they bend with a load that grows
    with speed, because the flexspline stiffens with torque.  Raises ParameterError for speeds that
    do not increase.
    """
    try:
        grid = np.asarray(speeds, float)
    except (TypeError, ValueError):
        grid = np.zeros(0)
    if grid.ndim != 1 or len(grid) < 2 or not np.all(np.diff(grid) > 0.0) or not np.all(np.isfinite(grid)):
        raise ParameterError("speeds: give at least two motor speeds [rad/s] in increasing order.")
    balanced = without_unbalance(scene)
    loaded = balanced if torque is None else with_load(balanced, torque)
    network = loaded.network()
    lines = _lines(loaded, orders)
    assembly = assemble(network.turning())
    points: list[Modes] = []
    with progress_bar(f"{scene.name}: Campbell", len(grid), progress) as report:
        for k, speed in enumerate(grid):
            turning = at_speed(loaded, float(speed))  # another scene only where the motor's motion is prescribed
            built = assembly if turning is loaded else assemble(turning.network().turning())
            points.append(modes_at(turning, built, operating_point(turning, motor_speed=float(speed))))
            if report is not None:
                report(k + 1)
    frequencies, ratios = _track(points)
    criticals = _crossings(grid, frequencies, lines)
    corners = sorted({note for point in points for note in point.status.split("; ")[1:]})
    return Campbell(
        scene=scene,
        status="; ".join(["complete", *corners]),
        settings={"torque": torque, "speeds": f"{grid[0]:g} .. {grid[-1]:g} rad/s, {len(grid)} points"},
        speeds=grid,
        frequencies=frequencies,
        damping_ratios=ratios,
        order_numbers=tuple(line.order for line in lines),
        order_places=tuple(line.place for line in lines),
        order_slopes=tuple(line.slope for line in lines),
        critical_speeds=np.array([speed for speed, _, _ in criticals]),
        critical_orders=tuple(line for _, line, _ in criticals),
        critical_branches=tuple(branch for _, _, branch in criticals),
    )


def _lines(scene: Scene, orders: Mapping[str, Sequence[float]] | None) -> list[ExcitationOrder]:
    network = scene.network()
    ratios = {body.name: body.ratio for body in network.bodies} | {m.name: m.ratio for m in network.motions}
    if orders is None:
        reference = next((name for name, ratio in ratios.items() if abs(ratio - 1.0) < 1e-9), network.bodies[0].name)
        orders = {reference: (1.0, 2.0)}
    if not isinstance(orders, Mapping):
        raise ParameterError(f"orders = {orders!r}: must name places, like {{'motor': (1, 2)}}.")
    lines = []
    for place, numbers in orders.items():
        if place not in network.places:
            raise unknown_place("place", place, network.places)
        slope = abs(ratios[network.places[place]])
        if not all(np.isfinite(number) and number > 0.0 for number in np.atleast_1d(numbers)):
            raise ParameterError(f"orders of {place!r} = {numbers!r}: each must be a number greater than 0, per turn of the place.")
        lines += [ExcitationOrder(order=float(number), place=place, slope=float(number) * slope) for number in np.atleast_1d(numbers)]
    return lines


def _track(points: list[Modes]) -> tuple[FloatArray, FloatArray]:
    """Follow each mode from speed to speed by the likeness of its shape (MAC) and its frequency."""
    width = max(len(point.undamped) for point in points)
    frequencies = np.full((len(points), width), np.nan)
    ratios = np.full((len(points), width), np.nan)
    previous: Modes | None = None
    branch: list[int] = []
    for row, point in enumerate(points):
        branch = list(range(len(point.undamped))) if previous is None else _assign(previous, branch, point, width)
        damping = matching_damping(point)
        for k, column in enumerate(branch):
            frequencies[row, column] = point.undamped[k]
            ratios[row, column] = damping[k]
        if len(point.undamped):
            previous = point
    return frequencies, ratios


def _assign(previous: Modes, branch: list[int], point: Modes, width: int) -> list[int]:
    cost = np.empty((len(point.undamped), len(previous.undamped)))
    for i in range(cost.shape[0]):
        for j in range(cost.shape[1]):
            a, b = point.shapes[:, i], previous.shapes[:, j]
            likeness = (a @ b) ** 2 / ((a @ a) * (b @ b))
            cost[i, j] = (1.0 - likeness) + abs(np.log(point.undamped[i] / previous.undamped[j]))
    rows, columns = linear_sum_assignment(cost)
    found = {int(i): branch[int(j)] for i, j in zip(rows, columns, strict=True)}
    free = [k for k in range(width) if k not in found.values()]
    return [found[i] if i in found else free.pop(0) for i in range(cost.shape[0])]


def _crossings(speeds: FloatArray, frequencies: FloatArray, lines: list[ExcitationOrder]) -> list[tuple[float, int, int]]:
    """Where  slope * speed = frequency, by linear interpolation between the speeds."""
    found = []
    for index, line in enumerate(lines):
        for branch in range(frequencies.shape[1]):
            gap = line.slope * np.abs(speeds) - frequencies[:, branch]
            for k in range(len(speeds) - 1):
                a, b = gap[k], gap[k + 1]
                if not (np.isfinite(a) and np.isfinite(b)):
                    continue
                if a * b < 0.0:
                    found.append((float(speeds[k] - a * (speeds[k + 1] - speeds[k]) / (b - a)), index, branch))
                elif a == 0.0 or (b == 0.0 and k == len(speeds) - 2):
                    found.append((float(speeds[k] if a == 0.0 else speeds[k + 1]), index, branch))
    return sorted(found)

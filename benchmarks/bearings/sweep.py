"""Where each model is valid: maps over bearing stiffness, foundation stiffness and shaft diameter; and where the damping sits.

Everything in the frequency domain: undamped critical speeds up to the final speed, and the steady response around the
first one, of M-REF with changed numbers.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

import hdrive_mbs as hm
from benchmarks.bearings.cases import BEARINGS, FINAL, FULL, IMPROVED, M_REF, M_REF2, MERGED, SIMPLIFIED, Case, with_model
from benchmarks.bearings.run_up import ROTORS
from benchmarks.bearings.steady import forward_criticals
from benchmarks.campaign import Where
from hdrive_mbs.analysis.unbalance.response_peaks import ResponsePeak
from hdrive_mbs.analysis.unbalance.unbalance_response import unbalance_response

FloatArray = npt.NDArray[np.float64]

CHEAPER = (MERGED, SIMPLIFIED, IMPROVED)
KEYS = ("critical_speeds", *ROTORS, "largest", "warned")


@dataclass(frozen=True)
class Grid:
    """Diameters [m], stiffness of the bearings and of the foundations [N/m]; shares of damping moved into the bearings."""

    diameters: tuple[float, ...]
    bearing: tuple[float, ...]
    foundation: tuple[float, ...]
    shares: tuple[float, ...]


def _spaced(low: float, high: float, count: int) -> tuple[float, ...]:
    return tuple(float(value) for value in np.geomspace(low, high, count))


WHOLE = Grid(_spaced(0.016, 0.040, 9), _spaced(3e6, 3e9, 10), _spaced(3e5, 3e8, 10), tuple(k / 8.0 for k in range(9)))
QUICK = Grid((0.022, 0.030), (1.2e7, 1.2e8), (1e6, 6e6), (0.0, 1.0))


def changed(case: Case, diameter: float | None = None, **values: float) -> hm.Scene:
    """The full line of a case with other numbers in both bearings.

    bearing, foundation : stiffness [N/m];  bearing_damping, foundation_damping : N s/m
    """
    scene = case.scene(FULL)
    fields = {
        "bearing": ("law.stiffness_xx", "law.stiffness_yy"),
        "foundation": ("housing.stiffness_x", "housing.stiffness_y"),
        "bearing_damping": ("law.damping_xx", "law.damping_yy"),
        "foundation_damping": ("housing.damping_x", "housing.damping_y"),
    }
    changes = {f"{b}.{field}": value for name, value in values.items() for field in fields[name] for b in BEARINGS}
    if diameter is not None:
        changes |= {f"section_{k}.diameter": diameter for k in range(1, 5)}
    return scene.replacing(changes)


def first_peaks(scene: hm.Scene, first: float) -> dict[str, ResponsePeak]:
    """The highest maximum of each rotor around the first critical speed [rad/s]."""
    response = unbalance_response(scene, np.linspace(0.7, 1.3, 61) * first, progress=False)
    found = {}
    for rotor in ROTORS:
        peaks = [peak for peak in response.peaks if peak.place == rotor]
        if peaks:
            found[rotor] = max(peaks, key=lambda peak: peak.amplitude)
    return found


def deviations(full: hm.Scene, models: Sequence[str]) -> dict[str, dict[str, float]]:
    """Model -> largest deviation of the critical speeds met, signed ones of the first peaks, 1 where there were warnings.

    ``largest`` is that of the rotor that moves most.  NaN where there is no peak.
    """
    exact = forward_criticals(full)
    tops = first_peaks(full, exact[0])
    found = {}
    for model in models:
        scene, remarks = with_model(full, model)
        speeds = forward_criticals(scene, 3.0 * FINAL)
        met = max(1, sum(w <= FINAL for w in exact))
        row = {"warned": float(bool(remarks)), "critical_speeds": max(abs(b / a - 1.0) for a, b in zip(exact[:met], speeds, strict=False))}
        peaks = first_peaks(scene, speeds[0])
        for rotor in ROTORS:
            both = rotor in tops and rotor in peaks
            row[rotor] = peaks[rotor].amplitude / tops[rotor].amplitude - 1.0 if both else math.nan
        row["largest"] = row[max(tops, key=lambda rotor: tops[rotor].amplitude)]
        found[model] = row
    return found


def maps(grid: Grid, where: Where, report: Callable[[], None]) -> dict[str, Any]:
    """Two maps over the shaft diameter: with the bearing's and with the foundation's stiffness changed."""
    found: dict[str, Any] = {"diameters": list(grid.diameters)}
    lists = {"bearing": grid.bearing, "foundation": grid.foundation}
    points = [{"of": name, "diameter": d, "stiffness": k} for name, values in lists.items() for d in grid.diameters for k in values]
    rows = iter(where.sweep(at_a_stiffness, points, arrived=lambda point, values: report(), progress=False).values)
    for name, stiffness in lists.items():
        shape = len(grid.diameters), len(stiffness)
        table = {model: {key: np.full(shape, np.nan) for key in KEYS} for model in CHEAPER}
        for at in np.ndindex(*shape):
            for model, row in next(rows).items():
                for key, number in row.items():
                    table[model][key][at] = number
        found[name] = {"stiffness": list(stiffness), "models": table}
    return found


def at_a_stiffness(point: Mapping[str, Any]) -> dict[str, Any]:
    """Deviations of the cheaper models from the full one (``of``: "bearing" or "foundation"; ``diameter`` [m], ``stiffness`` [N/m])."""
    return deviations(changed(M_REF, point["diameter"], **{point["of"]: point["stiffness"]}), CHEAPER)


def damping_places(grid: Grid, where: Where, report: Callable[[], None]) -> dict[str, Any]:
    """Peaks of the simplified and the improved model while damping moves from the foundation into the bearing.

    c_b goes from 400 to 9e4 N s/m while c_h goes from 800 to 10 N s/m, with the stiffness of each case.  ``share`` is what
    the bearings' radial damping holds of the damping ratio at the first critical speed w, 1 - (ratio without it)/ratio, and
    ``loss`` is c_b w/k_b.
    """
    points = [{"case": case.name, "moved": s} for case in (M_REF, M_REF2) for s in grid.shares]
    rows = where.sweep(with_damping_moved, points, arrived=lambda point, values: report(), progress=False).values
    found: dict[str, Any] = {case.name: [] for case in (M_REF, M_REF2)}
    for point, row in zip(points, rows, strict=True):
        if row:
            found[str(point["case"])].append(dict(row))
    return found


def with_damping_moved(point: Mapping[str, Any]) -> dict[str, Any]:
    """A row of ``damping_places`` (``case``: its name; ``moved``: from 0, all in the foundation, to 1)."""
    [case] = [item for item in (M_REF, M_REF2) if item.name == point["case"]]
    values = {"bearing_damping": 400.0 * 225.0 ** point["moved"], "foundation_damping": 800.0 / 80.0 ** point["moved"]}
    full = changed(case, **values)
    first = forward_criticals(full)[0]
    top, without = (first_peaks(scene, first)["rotor_1"] for scene in (full, changed(case, **{**values, "bearing_damping": 0.0})))
    stiffness = float(full.parts["bearing_a"].law.stiffness_xx)  # type: ignore[attr-defined]
    row: dict[str, Any] = {
        **values,
        "share": 1.0 - without.width / top.width,
        "loss": values["bearing_damping"] * first / stiffness,
    }
    return row | deviations(full, (SIMPLIFIED, IMPROVED))


def work(grid: Grid) -> int:
    """How often ``report`` is called by both."""
    return len(grid.diameters) * (len(grid.bearing) + len(grid.foundation)) + 2 * len(grid.shares)


def valid_from(found: Mapping[str, Any], model: str, key: str, limit: float, diameter: float) -> float:
    """Lowest bearing stiffness [N/m] of the map from which on a deviation stays within a limit, at the diameter nearest to one."""
    i = int(np.argmin(np.abs(np.array(found["diameters"]) - diameter)))
    inside = np.abs(found["bearing"]["models"][model][key][i]) <= limit
    last = np.flatnonzero(~inside)
    start = int(last[-1]) + 1 if len(last) else 0
    return float(found["bearing"]["stiffness"][start]) if start < len(inside) else math.nan

"""How fast designs are judged, and how right: against full outlines and against shapely."""

from __future__ import annotations

import time
from typing import Any

import numpy as np
import shapely

import hdrive_mbs as hm
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.teeth.clearance import beside, clearances
from hdrive_mbs.teeth.design_points import VARIABLES
from hdrive_mbs.teeth.motion import tooth_motion
from hdrive_mbs.teeth.polygons import signed_gap
from models.double_harmonic_transmission import gear


def random_designs(task: hm.DesignTask, count: int, seed: int = 0) -> list[np.ndarray]:
    """Designs spread evenly over the search box."""
    box = task.search_box()
    rng = np.random.default_rng(seed)
    return [rng.uniform(*box[name], count) for name in VARIABLES]


def sweep(task: hm.DesignTask, count: int, repeats: int) -> dict[str, Any]:
    """CPU seconds of one call for ``count`` designs: median and range."""
    designs = random_designs(task, count)
    seconds = []
    for _ in range(repeats):
        start = time.process_time()
        points = task.evaluate(*designs)
        seconds.append(time.process_time() - start)
    return {
        "designs": count,
        "seconds": float(np.median(seconds)),
        "fastest": min(seconds),
        "slowest": max(seconds),
        "per_second": count / float(np.median(seconds)),
        "admissible": int(np.sum(points.admissible)),
        "placed": int(np.sum(np.isfinite(points.flank_gap))),
    }


def accuracy(task: hm.DesignTask, count: int) -> dict[str, Any]:
    """Verdicts of the sweep against full outlines with fine angles (both without a limit on the tip land)."""
    open_task = task.replacing(least_tip_thickness=0.0)
    designs = random_designs(open_task, count, seed=1)
    points = open_task.evaluate(*designs)
    same = different = refused = 0
    shallow, off = 0.0, 0.0
    for k in range(count):
        try:
            stage = open_task.stage(**{name: float(values[k]) for name, values in zip(VARIABLES, designs)})
        except ParameterError:
            refused += 1
            different += int(points.admissible[k])
            continue
        full = clearances(stage)
        if full.interferes == points.admissible[k]:
            different += 1
            shallow = max(shallow, abs(full.minimum))
        else:
            same += 1
        if points.admissible[k]:
            off = max(off, float(points.flank_gap[k]) - full.flank_clearance)
    return {
        "designs": count,
        "same": same,
        "cannot_be_built": refused,
        "different": different,
        "deepest_missed": shallow,
        "gap_too_large_by": off,
    }


def against_shapely(count: int, angles: int) -> dict[str, Any]:
    """The distances of one gear's teeth over a turn, by our arrays and by shapely, and their difference."""
    ours = theirs = 0.0
    off = 0.0
    for stage in gear("A").stages():
        phi = 2.0 * np.pi * np.arange(angles) / angles
        for _ in range(count):
            start = time.process_time()
            moving = beside(stage, phi)
            found = signed_gap(moving, stage.rigid.outline())
            ours += time.process_time() - start
            start = time.process_time()
            polygons = shapely.polygons(moving)
            tooth = shapely.Polygon(stage.rigid.outline())
            distance = shapely.distance(polygons, tooth)
            shapely.intersects(polygons, tooth)
            theirs += time.process_time() - start
            off = max(off, float(np.max(np.abs(found.distance - distance)[distance > 0.0])))
    return {"positions": 2 * count * angles * 2, "ours": ours, "shapely": theirs, "largest_difference": off}


def shapely_design(task: hm.DesignTask, count: int) -> dict[str, Any]:
    """CPU seconds per design when shapely does what the sweep does: 61 angles from the starting to the engagement axis."""
    designs = random_designs(task, 20 * count, seed=2)
    phi = np.linspace(0.0, np.pi / 2.0, 61)
    done, seconds = 0, 0.0
    for k in range(20 * count):
        try:
            stage = task.stage(**{name: float(values[k]) for name, values in zip(VARIABLES, designs)})
        except ParameterError:
            continue
        start = time.process_time()
        tooth = shapely.Polygon(stage.rigid.outline())
        shapely.prepare(tooth)
        polygons = shapely.polygons(beside(stage, phi))
        shapely.intersects(polygons, tooth)
        shapely.distance(polygons, tooth)
        seconds += time.process_time() - start
        done += 1
        if done == count:
            break
    return {"designs": done, "seconds_per_design": seconds / max(done, 1)}


def linearised() -> list[dict[str, Any]]:
    """Largest difference [m] between the paper's equations (corrected) and the exact motion, over 90 and 180 degrees."""
    rows = []
    for name in ("A", "C"):
        for stage in gear(name).stages():
            row: dict[str, Any] = {"set": name, "stage": stage.name}
            for end in (90, 180):
                phi = np.linspace(0.0, np.radians(end), 2 * end + 1)
                exact, printed = tooth_motion(stage, phi), tooth_motion(stage, phi, exact=False)
                row[f"to_{end}"] = max(float(np.max(np.hypot(*(a - b).T))) for a, b in ((exact.P, printed.P), (exact.R, printed.R)))
            rows.append(row)
    return rows

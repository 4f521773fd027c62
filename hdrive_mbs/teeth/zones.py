"""Where around the generator teeth are in engagement."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hdrive_mbs.teeth.clearance import clearances
from hdrive_mbs.teeth.gear import WaveGear
from hdrive_mbs.teeth.stage import Stage


@dataclass(frozen=True, kw_only=True)
class Zone:
    """One engagement zone: angles [rad] from the major axis of the generator, and the flexible teeth in it."""

    stage: str
    centre: float
    begin: float
    end: float
    teeth: float

    @property
    def width(self) -> float:
        return self.end - self.begin


def zones(gear: WaveGear) -> tuple[Zone, ...]:
    """The zones of all stages by their place around the generator: four in a double harmonic gear."""
    found = [zone for stage in gear.stages() for zone in stage_zones(stage)]
    return tuple(sorted(found, key=lambda zone: zone.centre))


def stage_zones(stage: Stage) -> tuple[Zone, ...]:
    """Zones of one stage, their ends interpolated where the common height is zero."""
    result = clearances(stage)
    order = np.argsort(np.mod(stage.start - result.angles, 2.0 * np.pi))
    s, depth = np.mod(stage.start - result.angles, 2.0 * np.pi)[order], result.depth[order]
    after_s, after = np.append(s[1:], s[0] + 2.0 * np.pi), np.roll(depth, -1)
    begins = np.flatnonzero((depth <= 0.0) & (after > 0.0))
    ends = np.flatnonzero((depth > 0.0) & (after <= 0.0))
    where = s + (after_s - s) * np.where(after != depth, depth / np.where(after != depth, depth - after, 1.0), 0.0)
    found = []
    for k in begins:
        begin = where[k]
        end = min(where[j] + (2.0 * np.pi if where[j] <= begin else 0.0) for j in ends)
        centre = 0.5 * (begin + end)
        turn = 2.0 * np.pi * np.floor(centre / (2.0 * np.pi) + 1e-9)
        centre, begin, end = (float(np.round(value - turn, 12)) + 0.0 for value in (centre, begin, end))
        teeth = (end - begin) / (2.0 * np.pi) * stage.flexible.teeth
        found.append(Zone(stage=stage.name, centre=centre, begin=begin, end=end, teeth=float(teeth)))
    return tuple(found)

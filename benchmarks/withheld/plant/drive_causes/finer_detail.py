"""What every specimen has beyond the data sheet, null or not: small enough to stay in the noise.

Rounded corners of the stiffness curve, rounded edges of the gap, a few permille in what the data sheet calls exact.
The sizes are small because the bench sees much: at its noise an edge of 3e-6 rad is already a finding
(detectability 300), 8e-7 rad is not (5); 0.3 % of the wave generator's inertia changes the sum of squares by 3e4 and
leaves 1.5 once the parameters are refitted.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from benchmarks.withheld.plant.drive_train.specimen import Specimen

CORNER = 8e-7  # rad, widest ramp at the corners of the stiffness curve
EDGE = 8e-7  # rad, widest ramp at the edges of the gap
EXACT = 0.003  # standard deviation of the relative error of J_wg and J_fs


def with_finer_detail(rng: np.random.Generator, specimen: Specimen) -> tuple[Specimen, dict[str, float]]:
    """The specimen with its detail, and the sizes."""
    sizes = {
        "corner": rng.uniform(0.2, 1.0) * CORNER,
        "edge": rng.uniform(0.2, 1.0) * EDGE,
        "wave_inertia": float(1.0 + EXACT * rng.standard_normal()),
        "flex_inertia": float(1.0 + EXACT * rng.standard_normal()),
    }
    line, spring = specimen.plant.line, specimen.plant.spring
    line = line._replace(wave_inertia=line.wave_inertia * sizes["wave_inertia"], flex_inertia=line.flex_inertia * sizes["flex_inertia"])
    spring = spring._replace(corner=sizes["corner"], edge=max(sizes["edge"], spring.edge))
    values = {**specimen.values, "J_wg": line.wave_inertia, "J_fs": line.flex_inertia}
    return replace(specimen, values=values, plant=specimen.plant._replace(line=line, spring=spring)), sizes

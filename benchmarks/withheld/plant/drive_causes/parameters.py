"""Parameters well outside their tolerance."""

from __future__ import annotations

import numpy as np

from benchmarks.withheld.case import Cause
from benchmarks.withheld.draws import either
from benchmarks.withheld.plant.drive_train.nominal import UNCERTAINTY

# symbols by effect and place; factors from 5 to about 15 standard deviations on top of the specimen's own error
SYMBOLS: dict[tuple[str, str], tuple[str, ...]] = {
    ("parameter_flexspline_stiffness", "flexspline"): ("K1", "K2", "K3"),
    ("parameter_load_inertia", "load"): ("J_l",),
    ("parameter_motor_inertia", "motor"): ("J_m",),
    ("parameter_output_shaft_stiffness", "output_shaft"): ("k_out",),
    ("parameter_input_shaft_stiffness", "input_shaft"): ("k_in",),
    ("parameter_viscous", "motor"): ("b_m",),
    ("parameter_viscous", "wave_generator"): ("b_wg",),
    ("parameter_viscous", "load"): ("b_l",),
}

CAUSES = tuple(
    Cause(name=name, places=tuple(place for other, place in SYMBOLS if other == name), kind="parameter")
    for name in dict.fromkeys(name for name, _ in SYMBOLS)
)


def factors(rng: np.random.Generator, site: tuple[str, str]) -> dict[str, float]:
    """One factor for all symbols of the site."""
    symbols = SYMBOLS[site]
    deviation = UNCERTAINTY[symbols[0]]
    factor = either(rng, float(np.exp(5.0 * deviation)), float(np.exp(15.0 * deviation)))
    return dict.fromkeys(symbols, factor)

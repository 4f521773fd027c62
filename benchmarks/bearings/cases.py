"""The lines that are compared: the two data sets of the model and three changes of the first."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import dataclass, field

import hdrive_mbs as hm
from hdrive_mbs.analysis.whirl.bearing_models import BearingModelWarning, with_bearings
from models.two_rotor_line import build

FULL, MERGED, SIMPLIFIED, IMPROVED = "full", "merged", "simplified", "improved"
MODELS = (FULL, MERGED, SIMPLIFIED, IMPROVED)
BEARINGS = ("bearing_a", "bearing_b")

FINAL = 1000.0
"""Speed at which the run-up ends [rad/s]."""

DURATION = 2.5
"""Of the run-up and the time at the final speed [s], as in the paper."""


def with_model(full: hm.Scene, model: str) -> tuple[hm.Scene, list[str]]:
    """A line with full bearings turned into one with another model, and the warnings that this gives.

    Merged: bearing B with rotor 2, the pair of the paper.
    """
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        scene = with_bearings(full, model, ["bearing_b"] if model == MERGED else None, highest_speed=FINAL)
    return scene, [str(item.message) for item in caught if issubclass(item.category, BearingModelWarning)]


@dataclass(frozen=True)
class Case:
    """One line, to be built with any bearing model.

    what : for the report;  options : of ``models.two_rotor_line.build``
    law : fields of the laws of both bearings that are changed after that
    """

    name: str
    what: str
    options: Mapping[str, float | str] = field(default_factory=dict, hash=False)
    law: Mapping[str, float] = field(default_factory=dict, hash=False)

    def scene(self, model: str) -> hm.Scene:
        """The line with one of MODELS."""
        full = build(FULL, **self.options)  # type: ignore[arg-type]
        changes = {f"{bearing}.law.{field}": value for bearing in BEARINGS for field, value in self.law.items()}
        return with_model(full.replacing(changes), model)[0]


M_REF = Case("M-REF", "damping in the foundation: bearing 1.2e8 N/m, 400 N s/m on 6e6 N/m, 800 N s/m")
M_REF2 = Case("M-REF2", "damping in the bearing: 3e7 N/m, 2e4 N s/m on 6e6 N/m, 100 N s/m", {"variant": "damped_bearings"})
CUBIC = Case(
    "cubic bearing",
    "M-REF with 1.2e7 N/m and 1e18 N/m^3 in the bearings",
    {"cubic": 1e18},
    {"stiffness_xx": 1.2e7, "stiffness_yy": 1.2e7},
)
CASES = (
    M_REF,
    M_REF2,
    Case("30 mm shaft", "M-REF with a shaft of 30 mm", {"diameter": 0.030}),
    Case("soft foundation", "M-REF on 1e6 N/m", {"foundation_stiffness": 1e6}),
    CUBIC,
)
PAPER = (M_REF, M_REF2)
"""The two for which everything is done: figures, all solvers, claims."""

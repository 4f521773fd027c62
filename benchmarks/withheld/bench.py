"""What a bench module of ``plant`` offers to the command that makes cases."""

from __future__ import annotations

import importlib
from collections.abc import Sequence
from typing import Protocol

import numpy as np

from benchmarks.withheld.case import Case, Cause

BENCHES = ("drive", "rotor")


class Bench(Protocol):
    """A module ``benchmarks.withheld.plant.NAME``."""

    CAUSES: tuple[Cause, ...]  # kinds "effect", "parameter", "sensor" and "unlisted"

    def may_pair(self, first: tuple[str, str], second: tuple[str, str]) -> bool:
        """Whether two effects, each (name, place), may sit in one case."""

    def make_case(self, causes: Sequence[tuple[str, str]], rng: np.random.Generator, *, noise: str) -> Case:
        """Draw sizes and parameters, simulate and measure; ``noise`` is "stated" or "coloured"."""


def load(name: str) -> Bench:
    """The bench of that name; loaded late because its plant is compiled."""
    if name not in BENCHES:
        raise ValueError(f"no bench {name!r}; there are: {', '.join(BENCHES)}.")
    module: Bench = importlib.import_module(f"benchmarks.withheld.plant.{name}")  # type: ignore[assignment]
    return module

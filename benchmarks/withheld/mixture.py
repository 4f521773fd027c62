"""What each case of a set holds: nulls, single causes over every name and place, pairs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from benchmarks.withheld.bench import Bench
from benchmarks.withheld.case import KINDS, Cause

SHARES = {"null": 0.15, "effect": 0.44, "parameter": 0.10, "sensor": 0.08, "unlisted": 0.12, "pair": 0.11}
ONLY = {
    name: {kind: float(kind == held) for kind in KINDS} for name, held in (("nulls", "null"), ("pairs", "pair"), ("unlisted", "unlisted"))
}
"""Shares of sets that hold one kind alone: nothing, two causes, or a cause without a name in every case."""
Site = tuple[str, str]  # name and place


def counts(cases: int, shares: Mapping[str, float] = SHARES) -> dict[str, int]:
    """Whole numbers in proportion to the shares, by largest remainder, that add up to ``cases``."""
    exact = {kind: cases * shares[kind] / sum(shares.values()) for kind in KINDS}
    found = {kind: int(value) for kind, value in exact.items()}
    for kind in sorted(KINDS, key=lambda kind: found[kind] - exact[kind])[: cases - sum(found.values())]:
        found[kind] += 1
    return found


def mixture(bench: Bench, cases: int, rng: np.random.Generator, shares: Mapping[str, float] = SHARES) -> list[list[Site]]:
    """The sites of each case, shuffled; an empty list is a null case."""
    wanted = counts(cases, shares)
    found: list[list[Site]] = [[] for _ in range(wanted["null"])]
    for kind in ("effect", "parameter", "sensor", "unlisted"):
        found += [[site] for site in _rounds([cause for cause in bench.CAUSES if cause.kind == kind], wanted[kind], rng)]
    found += _pairs(bench, wanted["pair"], rng)
    return [found[k] for k in rng.permutation(len(found))]


def singles(bench: Bench, names: Sequence[str], cases: int, rng: np.random.Generator) -> list[list[Site]]:
    """The sites of each case: one of the named causes."""
    return [[site] for site in _rounds([cause for cause in bench.CAUSES if cause.name in names], cases, rng)]


def _rounds(causes: Sequence[Cause], count: int, rng: np.random.Generator) -> list[Site]:
    """Every cause once, in random order, before any comes again; the place is drawn."""
    found: list[Site] = []
    while len(found) < count:
        for k in rng.permutation(len(causes)):
            found.append((causes[k].name, str(rng.choice(causes[k].places))))
    return found[:count]


def _pairs(bench: Bench, count: int, rng: np.random.Generator) -> list[list[Site]]:
    """Two different effects that the bench lets sit together."""
    effects = [cause for cause in bench.CAUSES if cause.kind == "effect"]
    found: list[list[Site]] = []
    while len(found) < count:
        pair = [(effects[k].name, str(rng.choice(effects[k].places))) for k in rng.choice(len(effects), 2, replace=False)]
        if bench.may_pair(pair[0], pair[1]):
            found.append(pair)
    return found

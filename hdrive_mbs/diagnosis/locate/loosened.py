"""What a parameter of a place explains if it may be off by more than its uncertainty says, all else linear."""

from __future__ import annotations

import math
from collections.abc import Collection

from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.locate.about import About
from hdrive_mbs.diagnosis.locate.likelihood import Explained
from hdrive_mbs.diagnosis.unknowns import Factor

LOOSE = 10.0
"""Times its prior standard deviation that a parameter of a place may be off."""


def loosened(about: About, hypothesis: Hypothesis, nowhere: Explained) -> dict[str, tuple[float, str]]:
    """Place -> gain of letting the one of its parameters loose that gains most, and its name, any of all being as probable.

    Of 15 right parameters one lies beyond 3 standard deviations every 25th time.
    nowhere : without a force
    """
    found: dict[str, tuple[float, str]] = {}
    many = math.log(max(hypothesis.nominal_size, 1))
    known = {source.at for item in about.responses for source in item.sources.values()}
    for k, unknown in enumerate(hypothesis.unknowns[: hypothesis.nominal_size]):
        assert isinstance(unknown, Factor)
        if unknown.wide == 1.0:
            gain = about.likelihood.loosened(nowhere, k, LOOSE) - many
            for owner in {_owner(path, known) for path in unknown.nominal}:
                found[owner] = max((gain, unknown.name), found.get(owner, (-math.inf, "")))
    return found


def _owner(path: str, places: Collection[str]) -> str:
    """The place that a parameter belongs to: the part of its path that is one, or the part of the scene."""
    parts = path.split(".")
    return next((at for k in range(len(parts), 0, -1) if (at := ".".join(parts[:k])) in places), parts[0])

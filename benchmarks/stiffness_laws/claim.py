"""A claim of the paper and what was found."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Claim:
    """One line of the verdict table.

    where : equation, figure or section of the paper
    says : what it says, or lets one expect
    found : our numbers
    verdict : "holds", "holds in part" or "does not hold", and the condition if there is one
    """

    where: str
    says: str
    found: str
    verdict: str


def judged(holds: bool, otherwise: str = "does not hold") -> str:
    """The verdict of a condition."""
    return "holds" if holds else otherwise

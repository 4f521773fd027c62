"""Whether probabilities mean what they say."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

BINS = 10


@dataclass(frozen=True, kw_only=True)
class Bin:
    """Answers of about the same confidence: its mean, the share that is right, how many."""

    confidence: float
    right: int
    of: int

    @property
    def share(self) -> float:
        return self.right / self.of


def curve(confidences: Sequence[float], right: Sequence[bool], bins: int = BINS) -> list[Bin]:
    """Bins of equal width over 0 to 1 that hold something."""
    sure, good = np.asarray(confidences, float), np.asarray(right, bool)
    number = np.minimum((sure * bins).astype(int), bins - 1)
    return [
        Bin(confidence=float(sure[number == k].mean()), right=int(good[number == k].sum()), of=int((number == k).sum()))
        for k in range(bins)
        if (number == k).any()
    ]


def expected_error(confidences: Sequence[float], right: Sequence[bool], bins: int = BINS) -> float:
    """Expected calibration error: mean over the answers of |share right - mean confidence| of their bin (Naeini et al. 2015).

    It is above zero even for perfect probabilities, by about the standard error of a bin.
    """
    found = curve(confidences, right, bins)
    total = sum(item.of for item in found)
    return sum(item.of * abs(item.share - item.confidence) for item in found) / total if total else math.nan


def chance_error(confidences: Sequence[float], bins: int = BINS, draws: int = 2000, seed: int = 5) -> float:
    """The expected calibration error that perfect probabilities of this number and size would show on average."""
    rng = np.random.default_rng(seed)
    sure = np.asarray(confidences, float)
    if not len(sure):
        return math.nan
    return float(np.mean([expected_error(confidences, list(rng.random(len(sure)) < sure), bins) for _ in range(draws)]))


def log_loss(confidences: Sequence[float], right: Sequence[bool], least: float = 1e-6) -> float:
    """Mean of -log of the probability that was given to what came out (right or wrong)."""
    sure = np.clip(np.asarray(confidences, float), least, 1.0 - least)
    good = np.asarray(right, bool)
    return float(-np.mean(np.where(good, np.log(sure), np.log(1.0 - sure)))) if len(sure) else math.nan

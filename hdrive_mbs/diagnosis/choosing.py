"""Which of many looks and fits are worth more work."""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence

import numpy as np

from hdrive_mbs.diagnosis.fit import Fitted
from hdrive_mbs.diagnosis.nearly import nearly_right
from hdrive_mbs.diagnosis.screening import Look
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.suspects import PARAMETER, Label, Suspect
from hdrive_mbs.diagnosis.tasks import Found, is_hopeless

PLACES = 2
"""Of one family that are looked at closer; what comes out best is tried at the others in the end."""
FAMILIES = 3
"""Whose other places are tried where nothing fits."""
SHARE = 0.08
"""Of the best one's gain: what gains less is followed up only to fill the least number."""
SEEN, PART = 1.02, 0.2
"""Mean square of the samples of a search above which a faint gap is not noise (they are 50,000 and more), and the share of the logarithm
of the nominal model's that may stay."""


def worth(before: float, costs: Sequence[float], limits: tuple[int, int]) -> int:
    """How many of the cheapest are worth more work: those that gain a fair share of what the best gains, within limits."""
    least, most = limits
    gains = [before - cost for cost in costs]
    fair = sum(gain > SHARE * gains[0] for gain in gains) if gains and gains[0] > 0.0 else 0
    return min(max(fair, least), most)


def spread_out(looks: Sequence[tuple[Suspect, Look]]) -> list[tuple[Suspect, Look]]:
    """The best looks without more than PLACES of one family: on a stiff shaft a torque looks the same everywhere.

    Parameters all count as families of their own.
    """
    seen: dict[str, int] = {}
    chosen = []
    for suspect, look in looks:
        family = suspect.label[1] if suspect.law == PARAMETER else suspect.label[0]
        seen[family] = seen.get(family, 0) + 1
        if seen[family] <= PLACES:
            chosen.append((suspect, look))
    return chosen


def passed_over(found: Sequence[Found], looks: Sequence[tuple[Suspect, Look]], labels: Collection[Label]) -> list[tuple[Suspect, Look]]:
    """Looks at the other places of the families that turned out best: beside a strong gap a look at the right place may show nothing.

    found : fitted laws, best first;  labels : those that were chosen for a fit
    """
    families = list(dict.fromkeys(item.suspect.label[0] for item in found if item.suspect.law != PARAMETER))[:FAMILIES]
    return [(suspect, look) for suspect, look in looks if suspect.label[0] in families and suspect.label not in labels]


def not_begun(
    found: Sequence[Found], looks: Sequence[tuple[Suspect, Look]], begun: Sequence[tuple[Suspect, Look]]
) -> list[tuple[Suspect, Look]]:
    """Looks at further laws of the label that came out best: each has starts of its own, and another law's values may hold it in a hollow.

    found : fitted laws, best first;  begun : looks that were fitted
    """
    laws = {suspect.law for suspect, _ in begun if suspect.label == found[0].suspect.label}
    return [(suspect, look) for suspect, look in looks if suspect.label == found[0].suspect.label and suspect.law not in laws]


def picked(looks: Sequence[tuple[Suspect, Look]], *, laws: int) -> list[tuple[Suspect, Look]]:
    """The best laws of each label, so many of each: first the best of every label, then the second ones, and so on.

    In a faint gap many laws look nearly alike, and three of a crack and two of a probe's scale are no reason to leave a bearing out (our
    own eighth rotor set, c09, labels open: it came eleventh, and once fitted gains twice what the best of the first ten does).
    """
    turns: list[list[tuple[Suspect, Look]]] = [[] for _ in range(laws)]
    seen: dict[Label, int] = {}
    for suspect, look in looks:
        number = seen.get(suspect.label, 0)
        if number < laws:
            seen[suspect.label] = number + 1
            turns[number].append((suspect, look))
    return [pair for turn in turns for pair in turn]


def beyond(fitted: Fitted, leading: Fitted) -> bool:
    """Whether a law is so far from the records that it will not catch up with one that is near."""
    return is_hopeless(fitted.chi_fit, leading.chi_fit)


def enough(base: Fitted, least: float) -> float:
    """Mean square below which nothing is left that is worth a search: some value, or what a law that is nearly right leaves."""
    return max(least, nearly_right(base.chi_fit))


def above_noise(simulator: Simulator) -> float:
    """Mean square that the fitted samples show of noise alone but for one time in six: one standard deviation above 1, sqrt(2/n) of n."""
    return 1.0 + math.sqrt(2.0 / int(np.count_nonzero(simulator.fit)))


def leaves(after: float, base: Fitted, least: float) -> bool:
    """Whether a mean square is worth a search for something else: see ``enough``, or much of a faint gap.

    What takes a part of a faint gap may be another cause that nibbles at it: in our own third rotor set (c12, labels open) a hardening
    bearing took 1.088 to 1.040 where a rub leaves 1.01.
    """
    return after > enough(base, least) or (after > SEEN and math.log(after) > PART * math.log(max(base.chi_fit, 1.0)))

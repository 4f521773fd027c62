"""A diagnosis in words: what the text report and the page in a browser both say."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

from hdrive_mbs.diagnosis.elsewhere import EXCLUDED, LEAVES, part_of, somewhere_else, wave_generators
from hdrive_mbs.diagnosis.readable import digits, interval, listed, named, percent, probability, with_unit
from hdrive_mbs.diagnosis.result import NOWHERE, VERDICTS, Cause, Diagnosis, DomainBin, Estimate, Place, Separation
from hdrive_mbs.diagnosis.unknowns import Factor

SEPARABLE = 25.0
"""Detectability from which two causes can be told apart."""
EVEN = 1.5
"""A bin with less than this many times its share of the samples stands out from nothing."""
REST = 1.26
"""Times the noise (root mean square) from which what a claim leaves is spoken of: a mean square of 1.6."""
ALL = 0.9
"""Share of the gap from which a place is said to explain nearly all of it."""
WHY = (
    "A signal at a place may be as large and as quick as it takes, so several can explain nearly all of the gap:"
    " the likelier is the one that needs less signal for it."
)
LEFT = (
    "What is left is noise by the verdict: no place and no part of the operating range is named,"
    " for those that fit noise best mean nothing (the JSON has them)."
)
CERTAIN = 0.9
"""Probability of a place from which a gap lies there, against a law that is not exact."""
MOST = 0.5
"""Share of the gap that is most of it."""
LIKELY, UNLIKELY = 0.5, 0.1
"""Those from which a reader takes the gap to lie there, and up to which not."""
FAR = 3.0
"""Standard deviations of its tolerance beyond which a parameter that is not claimed is told beside the verdict."""
SIGMA = (
    "sigma: the tolerance given for a parameter, a relative standard deviation;"
    " a value known to 10 % that halves has moved by (0.5 - 1)/0.1 = -5 sigma"
)
MOVED = 1.0
"""Standard deviations of its tolerance from which a parameter is said to have moved."""


def label(effect: str, at: str) -> str:
    """``coulomb friction at load``; ``parameter gear stiffness``; ``no cause``."""
    if effect == "none":
        return "no cause"
    if effect == "unknown":
        return "nothing in the library"
    if effect == "parameter":
        return f"parameter {named(at)}"
    return f"{named(effect)} at {at}" if at else named(effect)


def verdict(diagnosis: Diagnosis) -> str:
    """The answer in one sentence."""
    claimed = [label(cause.effect, cause.at) for cause in diagnosis.causes]
    words = VERDICTS.get(diagnosis.verdict, diagnosis.verdict)
    if not claimed:
        return f"{words[0].upper()}{words[1:]}."
    if len(claimed) > 1:
        return f"{'Two' if len(claimed) == 2 else str(len(claimed))} causes: {listed(claimed)}."
    return f"{words[0].upper()}{words[1:]}: {claimed[0]}."


def confidence(diagnosis: Diagnosis) -> str:
    """How sure that is."""
    if diagnosis.causes:
        chances = [cause.probability for cause in diagnosis.causes]
        if len(chances) == 2 and chances[0] == chances[1]:
            return f"Probability {probability(chances[0])} of both together."
        return "Probability " + listed([probability(chance) for chance in chances]) + "."
    none = next((item for item in diagnosis.ranking if item.effect == diagnosis.verdict), None)
    return f"Probability {probability(none.probability)}." if none is not None else ""


def ambiguity(diagnosis: Diagnosis) -> str:
    """What these records cannot tell from the claim; empty if everything can be told apart."""
    own = {(cause.effect, cause.at) for cause in diagnosis.causes}
    others = [label(*item) for item in diagnosis.indistinguishable if item not in own]
    if not others:
        return ""
    claimed = listed([label(cause.effect, cause.at) for cause in diagnosis.causes]) if own else "the claim"
    return f"These records cannot tell {claimed} from {listed(others, 'or')}."


def inexact(diagnosis: Diagnosis) -> str:
    """What a claim leaves that is not noise; empty where it leaves noise alone."""
    if not diagnosis.causes or not diagnosis.gaps:
        return ""
    gap = diagnosis.gap
    times = f"What is claimed leaves {digits(gap.effect.value / gap.floor, 3)} times the noise"
    if not gap.effect.value > REST * gap.floor:
        other = diagnosis.elsewhere
        if other is None:
            return ""
        at = listed(_claimed_at(diagnosis))
        return f"{times}, and by its place the gap lies at {other.at}, not at {at}: the law that is claimed, or its place, may be wrong."
    what = "the law" if len(diagnosis.causes) == 1 else "one of the laws"
    return (
        f"{times}: {what} is not exact,"
        f" or there is another cause beside it. Look at what is left before you trust the identified values.{_elsewhere(diagnosis)}"
    )


def _elsewhere(diagnosis: Diagnosis) -> str:
    """A warning where the gap lies at another place than all that is claimed."""
    at = _claimed_at(diagnosis)
    first = somewhere_else(diagnosis.where, at, CERTAIN, EXCLUDED)
    if first is None or part_of(first.at) in wave_generators(diagnosis.scene.network(), at):
        return ""
    return f" By its place the gap lies at {first.at}, not at {listed(at)}: a cause there is likelier than what is claimed."


def _claimed_at(diagnosis: Diagnosis) -> list[str]:
    return sorted({part_of(cause.at) for cause in diagnosis.causes})


def gap_sentences(diagnosis: Diagnosis) -> tuple[str, ...]:
    """How large the gap is, and how far it shrinks."""
    if not diagnosis.gaps:
        return ("No stretch was held out, so the gap was not measured.",)
    gap = diagnosis.gap
    claimed = bool(diagnosis.causes)
    cause, closes = ("the causes", "close") if len(diagnosis.causes) > 1 else ("the cause", "closes")
    steps = [f"the nominal model is off by {_size(gap.nominal.value)}", f"with refitted parameters by {_size(gap.refit.value)}"]
    if claimed:
        steps.append(f"with {cause} by {_size(gap.effect.value)}")
    noise = f"noise alone gives {digits(gap.floor, 3)}"
    first = f"On stretches that no fit saw, in standard deviations of the noise (rms): {listed(steps)}; {noise}."
    if math.isfinite(gap.nominal.value) and gap.nominal.value <= gap.floor:
        return (first, "The nominal model is not above the noise, so there is no gap to close.")
    parts = []
    if math.isfinite(diagnosis.closed_by_refit):
        parts.append(f"refitting alone closes {percent(diagnosis.closed_by_refit)}")
    if claimed and math.isfinite(diagnosis.closed):
        parts.append(f"{cause} {closes} {percent(diagnosis.closed)}")
    return (first, f"Of the gap's energy above the noise {listed(parts)}.") if parts else (first,)


def _size(value: float) -> str:
    return digits(value, 3) if math.isfinite(value) else "an amount that could not be computed"


def where(place: Place) -> str:
    """What a force at a place would explain."""
    text = f"{place.at}: probability {probability(place.probability)}"
    text += f"; {explaining(place)}" if place.at != NOWHERE else "; no signal at any place"
    return text + (f"; these records cannot tell it from {listed(place.tied, 'or')}" if place.tied else "")


def where_sentences(diagnosis: Diagnosis, top: int | None = None) -> tuple[str, ...]:
    """Places of the gap, the first ones, and why one of several that explain the same wins; none where only noise is left."""
    if only_noise(diagnosis) or not diagnosis.where:
        return ()
    shown = tuple(where(place) for place in diagnosis.where[:top])
    full = [place for place in diagnosis.where[:top] if place.share >= ALL and not place.parameter]
    return (*shown, *([WHY] if len(full) > 1 else []), *_fitting(diagnosis))


def _fitting(diagnosis: Diagnosis) -> tuple[str, ...]:
    """That a cause which leaves noise alone is not refuted by a list that puts the gap elsewhere; nothing where there is none such."""
    if diagnosis.verdict not in ("effect", "sensor") or not diagnosis.gaps or diagnosis.gap.effect.value > LEAVES * diagnosis.gap.floor:
        return ()
    at = _claimed_at(diagnosis)
    first = somewhere_else(diagnosis.where, at, LIKELY, UNLIKELY)
    if first is None or first.parameter or first.share < MOST or any(part_of(place) in at for place in first.tied):
        return ()
    return (
        f"What is claimed at {listed(at)} leaves noise alone and is not in doubt for its rank here: this list asks where one signal of"
        f" any form, added to the linearised model, explains most of the gap, and at {first.at} it does.",
    )


def only_noise(diagnosis: Diagnosis) -> bool:
    """Whether the verdict is that nothing is left to be put anywhere: then neither places nor operating range are told."""
    return diagnosis.verdict == "none"


def rest(diagnosis: Diagnosis) -> str:
    """In place of them, if they were looked for: that what is left is noise."""
    return LEFT if only_noise(diagnosis) and (diagnosis.where or diagnosis.domain) else ""


def explaining(place: Place) -> str:
    """What a place would explain, and how."""
    if place.parameter:
        return (
            f"in place of an unknown signal there {named(place.parameter)} off beyond its tolerance would do, and with less;"
            " this compares the two alone and is not the verdict"
        )
    if place.probability > LIKELY and place.share < UNLIKELY:
        return "the likeliest of all, though no signal there explains the gap of a linear model: what is missing changes the motion itself"
    return f"an unknown signal there explains {percent(place.share)} of the gap"


def moved(estimate: Estimate) -> float:
    """How far a nominal parameter went, in standard deviations of its tolerance as the fits count them; nan where it has none."""
    before, after, sigma = estimate.nominal, estimate.value, estimate.tolerance
    if not (math.isfinite(before) and math.isfinite(after) and sigma > 0.0 and before != 0.0):
        return math.nan
    return Factor.deviations(after / before, sigma) if after / before > 0.0 else math.nan


def moved_parameters(diagnosis: Diagnosis) -> list[tuple[Estimate, float]]:
    """Nominal parameters that went further than ``MOVED``, the furthest first."""
    pairs = [(item, moved(item)) for item in diagnosis.parameters]
    return sorted(((item, z) for item, z in pairs if abs(z) > MOVED), key=lambda pair: -abs(pair[1]))


def by_distance(diagnosis: Diagnosis) -> list[tuple[Estimate, float]]:
    """All nominal parameters and how far they went, the furthest first, those without a tolerance last."""
    pairs = [(item, moved(item)) for item in diagnosis.parameters]
    return sorted(pairs, key=lambda pair: -abs(pair[1]) if math.isfinite(pair[1]) else math.inf)


def strained(diagnosis: Diagnosis) -> str:
    """Parameters far outside their tolerance that nothing claims; empty where there is none."""
    claimed = {item.name for cause in diagnosis.causes if cause.effect == "parameter" for item in cause.parameters}
    far = [(item, z) for item, z in by_distance(diagnosis) if abs(z) > FAR and item.name not in claimed]
    if not far:
        return ""
    told = listed([f"{named(item.name)} by {z:+.1f} sigma" for item, z in far])
    return (
        f"The fit moved {told} of {'its' if len(far) == 1 else 'their'} tolerance, which the verdict does not claim:"
        " a data sheet may be wrong there, or a cause that is missing bends it."
    )


def domain_sentences(bins: Sequence[DomainBin]) -> tuple[str, ...]:
    """Where in the operating range the misfit of the refitted nominal model lies, one sentence for each quantity."""
    return tuple(_domain([item for item in bins if item.over == over]) for over in dict.fromkeys(item.over for item in bins))


def bin_name(item: DomainBin) -> str:
    """The range of a bin in words."""
    if item.over == "direction":
        return "at rest and at reversals" if item.low < 0.0 < item.high else "backward" if item.high <= 0.0 else "forward"
    if item.over == "order":
        return f"order {0.5 * (item.low + item.high):g}" if item.low > 0.0 else f"below order {item.high:g}"
    unit = "" if item.unit in ("", "1") else f" {item.unit}"
    if math.isinf(item.high):
        return f"above {item.low:.3g}{unit}"
    if math.isinf(item.low):
        return f"below {item.high:.3g}{unit}"
    return f"{item.low:.3g} to {item.high:.3g}{unit}"


def over_name(item: DomainBin) -> str:
    """Of what a bin is a range, with the place: ``motor speed``, ``direction of motor``, ``time``."""
    if not item.of:
        return item.over
    return f"{named(item.of)} {item.over}" if item.over in ("speed", "torque") else f"{item.over} of {named(item.of)}"


def _domain(bins: Sequence[DomainBin]) -> str:
    over = over_name(bins[0])
    energies = [max(item.excess, 0.0) * item.samples if math.isfinite(item.excess) else 0.0 for item in bins]
    total, samples = sum(energies), sum(item.samples for item in bins)
    if not total > 0.0 or not samples:
        return f"Over {over}: nothing above the noise."
    k = max(range(len(bins)), key=lambda i: bins[i].excess if energies[i] > 0.0 else -math.inf)
    worst, share, part = bins[k], energies[k] / total, bins[k].samples / samples
    if share < EVEN * part:
        return f"Over {over}: spread evenly (largest {bin_name(worst)}, {percent(share)} of the misfit in {percent(part)} of the samples)."
    after = f", with the cause {digits(max(worst.after, 0.0), 3)}" if math.isfinite(worst.after) else ""
    return (
        f"Over {over}: largest {bin_name(worst)}, where {percent(part)} of the samples hold {percent(share)} of the misfit"
        f" (mean square above the noise {digits(worst.excess, 3)} times the noise's{after})."
    )


def next_sentences(separations: Iterable[Separation]) -> tuple[str, ...]:
    """What to measure next, best first."""
    found = []
    for item in separations:
        pair = f"{label(*item.first)} from {label(*item.second)}"
        size = f"detectability {digits(item.detectability, 3)}"
        if item.detectability >= SEPARABLE:
            found.append(f"Record {item.record!r} would tell {pair} ({size}; {SEPARABLE:g} is enough).")
        else:
            found.append(f"Record {item.record!r} would not tell {pair} ({size}; {SEPARABLE:g} is needed).")
    return tuple(found)


def estimate_text(estimate: Estimate) -> str:
    """Value with interval, or why there is none."""
    if not estimate.identifiable:
        return f"not identifiable from these records (best {with_unit(estimate.value, estimate.unit, 2)})"
    found = interval(estimate.value, estimate.low, estimate.high, estimate.unit)
    return f"{found}, the end of what a fit may take" if estimate.at_end else found


def law_line(cause: Cause) -> str:
    """Law and what it is known by."""
    law = f"law {cause.law}, {cause.kind}" if cause.law else cause.kind
    return f"{law}; seen in a record as: {cause.signature}" if cause.signature else law


def title(diagnosis: Diagnosis) -> str:
    """What was diagnosed, by what."""
    number = len(diagnosis.records)
    return f"Diagnosis of {diagnosis.scene.name!r} by {number} record{'s' if number != 1 else ''}: {listed(diagnosis.records)}"


def made(diagnosis: Diagnosis) -> str:
    """Time it took, and versions."""
    versions = ", ".join(f"{name} {version}" for name, version in diagnosis.versions.items())
    return f"{digits(diagnosis.seconds, 3)} s." + (f" {versions}." if versions else "")

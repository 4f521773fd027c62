"""Whether a user's own effects can be run at all, before a search spends time on the rest."""

from __future__ import annotations

from collections.abc import Sequence

import hdrive_mbs
from hdrive_mbs.diagnosis.candidates import Candidate
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.refusals import taken
from hdrive_mbs.diagnosis.search import Search
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.unknowns import Factor
from hdrive_mbs.errors import ParameterError

LISTED = 6
"""Causes that a note names."""


def check_candidates(tried: Sequence[Candidate], simulator: Simulator, factors: Sequence[Factor]) -> None:
    """Run one start of every effect that is not of the library.

    Raises ParameterError for a class whose law raises or gives no finite values at any of its starts.
    """
    base = Hypothesis(factors=tuple(factors))
    if simulator.residuals(base, [base.start()])[0] is None:
        return  # the first fit says so
    for item in tried:
        if item.kind.__module__.partition(".")[0] == hdrive_mbs.__name__:
            continue
        where = f"{item.kind.__name__} at {item.at!r}"
        finite = False
        for added in item.first:
            hypothesis = Hypothesis(base.factors, (added,))
            taken()
            try:
                finite = finite or simulator.residuals(hypothesis, [hypothesis.start()])[0] is not None
            except Exception as error:
                raise _raised(where, f"{type(error).__name__}: {error}") from error
            for said in taken().values():
                raise _raised(where, said)
        if not finite:
            raise ParameterError(
                f"{where}: its law gives values that are not finite with {item.first[0].effect!r}, with which its search begins."
                " Mend it (a root or a quotient at rest, say), give its fields other typical values, or leave the class out."
            )


def _raised(where: str, said: str) -> ParameterError:
    return ParameterError(
        f"{where}: its law raised {said}. Mend it (a law may use numpy functions, but no if, min, float() on its arguments), or leave the"
        " class out."
    )


def left_out(tried: Sequence[Candidate], found: Search, step: float) -> tuple[str, ...]:
    """Which causes no run was possible of with steps of that length [s], in words."""
    failed = sorted({f"{item.label[0]} at {item.label[1]}" for item in tried} - _labels(tried, set(found.looks)))
    if not failed:
        return ()
    number = len({item.label for item in tried})
    more = "" if len(failed) <= LISTED else f", ... ({len(failed)} in all)"
    every = f"None of the {number} candidates" if len(failed) == number else f"{len(failed)} of {number} candidates"
    could = "could be run" if len(failed) == number else "could not be run"
    return (
        f"{every} {could} with their start values in steps of {1e3 * step:.3g} ms and half of that, and so were not tried: "
        f"{', '.join(failed[:LISTED])}{more}. Give a shorter step, or their fields other typical values.",
    )


def _labels(tried: Sequence[Candidate], looks: set[str]) -> set[str]:
    """Labels of which at least one law was looked at."""
    return {f"{item.label[0]} at {item.label[1]}" for item in tried if f"{item.kind.__name__} at {item.at}" in looks}

"""What laws raised at values that a search came to: these are passed over, the search goes on, and the answer says so."""

from __future__ import annotations

import threading

LISTED = 3
"""Of them that a note names."""

_kept: dict[str, str] = {}
_keeping = threading.Lock()


def refuse(label: str, error: Exception) -> None:
    """Note what the law of a hypothesis raised, where it is the first time.

    label : of the hypothesis, in words
    """
    with _keeping:
        _kept.setdefault(label, f"{type(error).__name__}: {error}")


def taken() -> dict[str, str]:
    """Label -> error of what has been refused in this process since this was asked last."""
    with _keeping:
        found = dict(_kept)
        _kept.clear()
    return found


def refused_words(refused: dict[str, str]) -> tuple[str, ...]:
    """Label -> error, as a warning: a parameter may lie where its law could not be asked, whatever its interval says."""
    if not refused:
        return ()
    named = "; ".join(f"{label} ({error})" for label, error in list(refused.items())[:LISTED])
    more = "" if len(refused) <= LISTED else f"; and {len(refused) - LISTED} more"
    return (
        f"A law raised at values that the search came to, which were passed over: {named}{more}. What it explains may lie"
        " there, outside the interval that is given. Mend it, or leave it out.",
    )

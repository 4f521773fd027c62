"""Whole records that no fit sees, in place of stretches of each."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace

import numpy as np

from hdrive_mbs.diagnosis.trial import Trial
from hdrive_mbs.errors import ParameterError, unknown_place


def split_up(
    trials_of: Mapping[str, Sequence[Trial]], searched: Sequence[str], held_out: Collection[str]
) -> tuple[tuple[Trial, ...], tuple[Trial, ...]]:
    """Trials that causes are searched on, and all trials, by record.

    held_out : records that no fit may see.  The others are then fitted whole in the end; the search holds stretches of these back, as
        it does without any

    Raises PlaceError for a name that no record has, ParameterError where nothing is left to be fitted.
    """
    for name in held_out:
        if name not in trials_of:
            raise unknown_place("record", name, trials_of, "Among the records that could be held out this diagnosis")
    fitted = {name: trials for name, trials in trials_of.items() if name not in held_out}
    if not fitted:
        raise ParameterError(f"All records are held out ({', '.join(trials_of)}); leave one at least to be fitted.")
    every = tuple(trial for trials in fitted.values() for trial in trials)
    chosen = tuple(trial for name in searched for trial in fitted.get(name, ())) or every
    if not held_out:
        return chosen, every
    return chosen, tuple(
        replace(trial, held_out=np.full(trial.samples, name in held_out)) for name, trials in trials_of.items() for trial in trials
    )

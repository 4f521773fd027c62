"""What a whirl gains on a fixed share of the spin, where that share changes with the speed."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from hdrive_mbs.effects.lateral_effect import Stretches
from hdrive_mbs.expression import Value
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment


def spin_speed(stretches: Stretches, moment: Moment) -> Value:
    """True speed [rad/s] of the place that an effect acts at."""
    return sum(factor * moment.speed(spin) for spin, factor in stretches["phi"].items())


def add_drift(draft: Draft, stretches: Stretches, name: str, slope: float, reference_speed: float) -> Callable[[Moment], Value]:
    """The angle d [rad], d' = s (|w|/w_0 - 1) w, as a state ``<name>.drift``; returns what reads it."""

    def rate(moment: Moment) -> Value:
        speed = spin_speed(stretches, moment)
        return slope * (np.abs(speed) / reference_speed - 1.0) * speed

    drift = draft.add_running_state(f"{name}.drift", unit="rad", rate=rate)
    return lambda moment: moment.state(drift)

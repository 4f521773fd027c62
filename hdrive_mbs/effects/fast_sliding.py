"""Sliding too fast for the steps of a solver, for the laws whose state builds up over an angle or a twist.

A friction or hysteresis state y with dy/dt = k v (1 - y sign(v)/L) builds up over L/k, and so decays at the rate
r = k |v|/L towards its limit L sign(v): fast sliding makes it stiff although the state then stands at its limit.  With
the share s = min(1, f/r), f being the fastest rate that is followed,

    dy/dt = s k v (1 - y sign(v)/L),  torque = s y + (1 - s) L sign(v)

* is the law itself while r <= f, so at every reversal, where v passes zero;
* has the same steady sliding, at every speed;
* decays at f at most, so explicit steps up to 2.7/f are stable (classical Runge-Kutta);
* stays passive with the energy y^2/(2 k) of the law: the heat is s times that of the law plus (1 - s) L |v|.

It leaves out how the torque builds up within 1/f after a speed that jumps: it then is at its limit at once.
"""

from __future__ import annotations

import numpy as np

from hdrive_mbs.expression import Value

FASTEST_RATE = 5e3
"""Rate [1/s] that the laws follow unless told otherwise: steps up to 0.5 ms are stable.  A very large one follows all."""


def followed_share(rate: Value, fastest: float) -> Value:
    """s = min(1, f/r) at a rate r >= 0 [1/s]."""
    return 1.0 / np.maximum(1.0, rate / fastest)


def mixed(share: Value, state: Value, limit: Value, rate: Value) -> Value:
    """s y + (1 - s) L sign(v)."""
    return share * state + (1.0 - share) * limit * np.sign(rate)

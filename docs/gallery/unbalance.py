"""Steady whirl of the two rotor line over its speed: amplitude and lag behind the unbalance."""

import numpy as np

import hdrive_mbs as hm
from models.two_rotor_line import build


def make():
    return hm.plot(hm.unbalance_response(build(), np.linspace(200.0, 1000.0, 401), progress=False))

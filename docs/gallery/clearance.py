"""Smallest distance of the flanks while a tooth passes through mesh, and where it would be below zero."""

import hdrive_mbs as hm
from models.double_harmonic_transmission import gear


def make():
    return hm.plot(hm.clearances(gear("A").stages()[0]))

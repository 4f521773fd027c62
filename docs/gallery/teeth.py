"""A tooth of the flexspline on its way into mesh and out again, between two teeth of the circular spline."""

import numpy as np

import hdrive_mbs as hm
from models.double_harmonic_transmission import gear


def make():
    stage = gear("A").stages()[0]
    return hm.plot(hm.tooth_motion(stage, np.radians(np.arange(0, 181, 10))))

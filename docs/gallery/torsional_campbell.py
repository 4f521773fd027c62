"""Torsional frequency of a train whose load grows with the speed: the flexspline stiffens, and the branch bends."""

import numpy as np

import hdrive_mbs as hm
from models.harmonic_drive_train import build


def make():
    smooth = hm.ContinuousStiffness.fitted_to(build().parts["gear"].stiffness, largest_torque=137.0)
    fan = build().replacing({"gear.stiffness": smooth, "load.torque": hm.QuadraticLoad(coefficient=55.0)})
    orders = {"gear.wave_generator": (1.0, 2.0, 4.0)}
    return hm.plot(hm.torsional_campbell(fan, np.linspace(5.0, 150.0, 30), orders=orders, progress=False), highest=450.0)

"""Catalogue curve of a gear of size 32, ratio 100 (Table 1 of Folega et al. 2014), and two laws fitted to it."""

import hdrive_mbs as hm
from models.harmonic_drive_train import build


def make():
    catalogue = build()
    measured = catalogue.parts["gear"].stiffness
    axes = hm.plot(hm.torsion(catalogue, largest_torque=137.0), label="catalogue: three stiffnesses and a gap")
    for law, label in ((hm.CubicStiffness, "cubic, fitted: no gap"), (hm.ContinuousStiffness, "polynomial behind the gap, fitted")):
        fitted = law.fitted_to(measured, largest_torque=137.0)
        hm.plot(hm.torsion(catalogue.replacing({"gear.stiffness": fitted}), largest_torque=137.0), axes, label=label)
    return axes

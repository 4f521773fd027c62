"""A motor is switched on: the shaft takes up the lost motion, the gear is struck, and the train swings into its speed."""

import hdrive_mbs as hm
from models.harmonic_drive_train import build


def make():
    train = build().with_effect(hm.KinematicError(amplitude=1e-4, order=2), at="gear.mesh")
    return hm.plot(hm.start_up(train, 0.6))

"""Whirl of rotor 1 during the run-up: unbalance along the line of order 1, natural frequencies that stand still."""

import hdrive_mbs as hm
from models.two_rotor_line import build


def make():
    run = hm.run_up(build(), 2.4, progress=False)
    return hm.plot(hm.waterfall(run, "rotor_1"))

"""Path of a rotor that passes its first critical speed, coloured by its speed."""

import hdrive_mbs as hm
from models.two_rotor_line import build


def make():
    run = hm.run_up(build(), 1.4, progress=False)
    return hm.plot(hm.orbit(run, "rotor_1", slowest=390.0, fastest=420.0))

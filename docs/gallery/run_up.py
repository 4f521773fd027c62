"""Two rotors on one shaft are driven by a limited torque through two critical speeds."""

import hdrive_mbs as hm
from models.two_rotor_line import build


def make():
    return hm.plot(hm.run_up(build(), 2.5, progress=False))

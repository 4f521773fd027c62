"""Torsional and lateral branches of a robot joint in one diagram: one linearisation has both."""

import math

import numpy as np

import hdrive_mbs as hm
from models.robot_joint_line import build


def make():
    joint = build(arm_angle=-0.5 * math.pi)  # a level arm, whose weight loads the teeth
    diagram = hm.campbell(joint, np.linspace(0.0, 500.0, 26), orders={"motor": (1.0, 2.0)}, progress=False)
    return hm.plot(diagram, highest=1200.0)

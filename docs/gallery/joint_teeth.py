"""One moment of an animation: the teeth of a robot joint's gear, their torque over twist, and the speeds of the run."""

import hdrive_mbs as hm
from hdrive_mbs.plots.drive_animation import DrivePicture
from models.robot_joint_line import build


def make():
    run = hm.run_up(build("improved"), 0.6)
    picture = DrivePicture(run, run.scene, "gear", window=None, count=60, seconds=6.0, magnification=None)
    picture.show(35)
    return picture.figure.axes[0]

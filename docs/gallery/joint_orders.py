"""Orders of the torque in the gear of the tutorial "A joint that does not follow its model", machine and model."""

import numpy as np

from docs.gallery.make import ran
from hdrive_mbs.plots.look import given_or_new, house_look, style


def make():
    left = ran("robot_joint")
    with house_look():
        axes = given_or_new(None)
        for k, order in enumerate((2.0, 1.0, 4.0)):
            tracked = left["tracked"]["machine"]
            axes.plot(tracked.speeds, np.abs(tracked.track(order)), **style(k), label=f"machine, order {order:g}")
        for k, (found, name) in enumerate(((left["tracked"]["model"], "model"), (left["again"], "better model")), start=3):
            axes.plot(found.speeds, np.abs(found.track(2.0)), **style(k), label=f"{name}, order 2")
        axes.set(xlabel="speed of the wave generator [rad/s]", ylabel="torque of the gear, 0-peak [N m]")
        axes.set_title("Orders of the gear torque during a run-up")
        axes.legend()
    return axes

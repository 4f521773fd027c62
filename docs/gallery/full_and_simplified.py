"""The same run-up with the full bearing, the simplified one of Matyja (2015) and the improved one of this package."""

import numpy as np

import hdrive_mbs as hm
from hdrive_mbs.plots.look import given_or_new, house_look, style
from models.two_rotor_line import build


def make():
    with house_look():
        axes = given_or_new(None)
        for k, bearing in enumerate(("full", "simplified", "improved")):
            wide = {"linewidth": 5.0, "alpha": 0.35} if bearing == "full" else {}  # the improved one lies on it
            run = hm.run_up(build(bearing), 1.6, progress=False)
            speed, size = run.values["rotor_1.speed"], 1e6 * run.values["rotor_1.radial"]
            near = (speed > 330.0) & (speed < 520.0)
            axes.plot(speed[near], size[near], **style(k), **wide, label=f"{bearing}: {np.max(size[near]):.0f} µm")
        axes.set(xlabel="speed of rotor 1 [rad/s]", ylabel="distance of rotor 1 from the axis, 0-peak [µm]")
        axes.set_title("Passing the first critical speed with three models of the bearings")
        axes.legend()
    return axes

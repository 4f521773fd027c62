"""The blower of the tutorial "A run-up through critical speeds" with linear and with hardening bearings."""

import itertools

import numpy as np

from docs.gallery.make import ran
from hdrive_mbs.plots.look import given_or_new, house_look, style


def make():
    left = ran("rotor_run_up")
    edges = np.arange(600.0, 901.0, 3.0)
    with house_look():
        axes = given_or_new(None)
        for k, name in enumerate(("linear", "hardening")):
            run = left[name]
            speed, whirl = run.values["wheel.speed"], 1e3 * run.values["wheel.whirl"]
            inside = [whirl[(speed >= low) & (speed < high)] for low, high in itertools.pairwise(edges)]
            middle = [low + 1.5 for low, size in zip(edges, inside) if len(size)]
            low, high = ([of(size) for size in inside if len(size)] for of in (np.min, np.max))
            axes.fill_between(middle, low, high, color=style(k)["color"], alpha=0.2, linewidth=0.0)  # twice per turn: flat orbits
            axes.plot(middle, high, **style(k), label=f"{name} bearings, largest of each orbit")
        axes.axvspan(710.6, 720.8, color="#DDDDDD", zorder=0, label="critical speeds of the linear line")
        axes.set(
            xlim=(600.0, 900.0), ylim=(0.0, None), xlabel="speed of the wheel [rad/s]", ylabel="whirl of the wheel about rest, 0-peak [mm]"
        )
        axes.set_title("Run-up of a blower with 30 N m")
        axes.legend()
    return axes

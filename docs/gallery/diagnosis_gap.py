"""What is left of the gap of the tutorial "From a bench log to a diagnosis" with each model, beside the noise."""

import hdrive_mbs as hm
from docs.gallery.make import ran


def make():
    return hm.plot_gap(ran("gear_bench")["found"])

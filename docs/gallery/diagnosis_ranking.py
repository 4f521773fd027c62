"""Causes of the gap of the tutorial "From a bench log to a diagnosis", by their probability."""

import hdrive_mbs as hm
from docs.gallery.make import ran


def make():
    return hm.plot_ranking(ran("gear_bench")["found"])

"""Pictures of the rankings: causes by probability and evidence, places by latent-force localisation."""

from __future__ import annotations

import math

import numpy as np
from matplotlib.axes import Axes

from hdrive_mbs.diagnosis.readable import digits, named, percent, probability
from hdrive_mbs.diagnosis.result import NOWHERE, Diagnosis, Place
from hdrive_mbs.diagnosis.sentences import label
from hdrive_mbs.plots.diagnosis_look import WIDTH, needed
from hdrive_mbs.plots.look import COLOURS, GREY, given_or_new, house_look, readable

TOP = 8
"""Causes that are drawn."""
PALE = "#A9CCE3"


def plot_ranking(diagnosis: Diagnosis, ax: Axes | None = None, *, top: int = TOP) -> Axes:
    """Causes with their calibrated probabilities; the evidence against the refitted nominal model is written beside each."""
    needed(diagnosis.ranking, "ranking", "It needs at least one candidate that was fitted.")
    shown = diagnosis.ranking[:top]
    claimed = {(cause.effect, cause.at) for cause in diagnosis.causes} or {(diagnosis.verdict, "")}
    alike = set(diagnosis.indistinguishable)
    colours = [
        COLOURS[0] if (item.effect, item.at) in claimed else PALE if (item.effect, item.at) in alike else "#BBBBBB" for item in shown
    ]
    names = [label(item.effect, item.at) for item in shown]
    notes = [f"{probability(item.probability)}, log odds {digits(item.log_odds, 3)}" for item in shown]
    with house_look():
        ax = given_or_new(ax, WIDTH, 1.0 + 0.36 * len(shown))
        _bars(ax, names, [item.probability for item in shown], notes, colours)
        ax.set_xlabel("calibrated probability" + ("\n(dark: claimed, pale: cannot be told from it)" if alike else ""))
    return ax


def plot_places(diagnosis: Diagnosis, ax: Axes | None = None, *, top: int = TOP) -> Axes:
    """Places where an unknown signal would explain the gap, by probability; the share it explains is written beside each."""
    needed(diagnosis.where, "places", "Places are searched for where there is a gap.")
    shown = diagnosis.where[:top]
    tied = set(shown[0].tied)
    colours = [COLOURS[0], *(PALE if place.at in tied else "#BBBBBB" for place in shown[1:])]
    notes = [", ".join([probability(place.probability), *_explains(place)]) for place in shown]
    with house_look():
        ax = given_or_new(ax, WIDTH, 1.0 + 0.36 * len(shown))
        _bars(ax, [place.at for place in shown], [place.probability for place in shown], notes, colours)
        ax.set_xlabel("probability among all places" + ("\n(pale: cannot be told from the first)" if tied else ""))
    return ax


def _explains(place: Place) -> list[str]:
    if place.at == NOWHERE:
        return []
    return [f"by {named(place.parameter)}" if place.parameter else f"explains {percent(place.share)}"]


def _bars(ax: Axes, names: list[str], values: list[float], notes: list[str], colours: list[str]) -> None:
    at = np.arange(len(names))[::-1]
    sizes = [value if math.isfinite(value) else 0.0 for value in values]
    ax.barh(at, sizes, 0.62, color=colours)
    for y, size, note in zip(at, sizes, notes, strict=True):
        inside = size > 0.55
        ax.annotate(
            note,
            (size, float(y)),
            (-5 if inside else 5, 0),
            textcoords="offset points",
            va="center",
            ha="right" if inside else "left",
            fontsize=8.5,
            color="white" if inside and colours[len(names) - 1 - int(y)] == COLOURS[0] else "#222222",
        )
    ax.axvline(0.0, color=GREY, linewidth=0.8, linestyle="-")
    ax.set_yticks(at, [readable(name) for name in names])
    ax.set_xlim(0.0, 1.0)
    ax.set_ylim(-0.6, len(names) - 0.4)
    ax.grid(False, axis="y")

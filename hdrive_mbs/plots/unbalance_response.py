"""Pictures of a steady unbalance response: Bode, polar, orbits, bearing forces."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes

from hdrive_mbs.analysis.unbalance.unbalance_response import UnbalanceResponse
from hdrive_mbs.errors import ParameterError, unknown_place
from hdrive_mbs.plots.dispatch import plot
from hdrive_mbs.plots.lengths import shown_unit
from hdrive_mbs.plots.look import GREY, given_or_new, house_look, legend_above, new_figure, number, other_unit, readable, style
from hdrive_mbs.plots.point_names import name_point

FloatArray = npt.NDArray[np.float64]

MOST_LINES = 4
"""Places in the automatic choice: rotors and bearings that move most."""

MOST_ORBITS = 6
"""Panels of orbits in one picture."""

RING: dict[str, Any] = {"linestyle": "none", "marker": "o", "markersize": 5, "markerfacecolor": "white", "markeredgewidth": 1.2}


@plot.register
def plot_unbalance_response(
    result: UnbalanceResponse,
    ax: Axes | None = None,
    *,
    view: str = "bode",
    places: Sequence[str] | None = None,
    speeds: Sequence[float] | None = None,
    logarithmic: bool = False,
) -> Axes:
    """Amplitudes, 0-peak, at the first frequency; returns the (first) Axes.  Curves have the speeds of ``result.refined()``.

    view : "bode" (major semi-axis and phase lag of x over speed), "polar" (x as a complex number), "orbits" (one panel
        a speed) or "forces" (of the bearings on their housings)
    places : which; if not given, those rotors and bearings that move most (for forces: all bearings)
    speeds : of the orbits [rad/s], the nearest calculated ones are drawn; those of the peaks if not given
    logarithmic : amplitudes of Bode and forces on a logarithmic scale
    """
    smooth = result.refined()
    views: dict[str, Callable[[], Axes]] = {
        "bode": lambda: _bode(smooth, ax, _chosen(smooth, places), logarithmic),
        "polar": lambda: _polar(smooth, ax, _chosen(smooth, places)),
        "orbits": lambda: _orbits(smooth if speeds is None else result, ax, _chosen(result, places), speeds),
        "forces": lambda: _forces(smooth, ax, places, logarithmic),
    }
    if view not in views:
        raise ParameterError(f"view = {view!r}: must be one of {', '.join(views)}.")
    with house_look():
        return views[view]()


def _chosen(result: UnbalanceResponse, places: Sequence[str] | None) -> list[str]:
    for name in places or ():
        if name not in result.places:
            raise unknown_place("place", name, result.places, "This response")
    if places is not None:
        if not places:
            raise ParameterError("places: name at least one place to draw.")
        return list(places)
    candidates = list(dict.fromkeys(result.peak_places)) or [place for place in result.places if np.any(result.of(place).major > 0.0)]
    candidates = _named(result, candidates)
    size = {place: float(np.nanmax(result.of(place).major, initial=0.0)) for place in candidates}
    largest = sorted(candidates, key=lambda place: -size[place])[:MOST_LINES]
    return [place for place in candidates if place in largest] or list(result.places[:1])


def _named(result: UnbalanceResponse, places: list[str]) -> list[str]:
    """Of the places those that are parts of their own, each station once; all if none is or the scene is not known."""
    if result.scene is None:
        return places
    nodes = result.scene.network().places
    return [place for place in places if place in result.scene.parts and nodes.get(place, place) == place] or places


def _scale(result: UnbalanceResponse, places: Sequence[str]) -> tuple[float, str]:
    """Factor and unit that make lengths readable."""
    return shown_unit("m", max(float(np.nanmax(result.of(place).major, initial=0.0)) for place in places))


def _title(result: UnbalanceResponse, what: str) -> str:
    name = result.scene.name if result.scene is not None else "rotor line"
    ratio = float(result.frequency_ratios[0])
    other = "" if abs(ratio - 1.0) < 1e-9 else f", frequency {ratio:.4g} x speed"
    return f"{name}: {what}{other}"


def _over_speed(ax: Axes, result: UnbalanceResponse) -> None:
    ax.set_xlim(float(result.speeds[0]), float(result.speeds[-1]) if len(result.speeds) > 1 else float(result.speeds[0]) + 1.0)
    ax.set_xlabel("speed of the reference shaft [rad/s]")


def _rpm_above(ax: Axes) -> None:
    above = ax.secondary_xaxis("top", functions=other_unit(30.0 / np.pi))
    above.set_xlabel("speed [rpm]")
    above.spines["top"].set_visible(True)


def _bode(result: UnbalanceResponse, ax: Axes | None, places: list[str], logarithmic: bool) -> Axes:
    scale, unit = _scale(result, places)
    if ax is not None:
        _amplitudes(ax, result, places, scale, unit, logarithmic)
        _over_speed(ax, result)
        legend_above(ax)
        return ax
    figure = new_figure(7.2, 5.6)
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(2.0, 1.0))
    _amplitudes(upper, result, places, scale, unit, logarithmic)
    for k, place in enumerate(places):
        one = result.of(place)
        angle = np.where(np.abs(one.x) > 0.0, np.degrees(one.phase_lag_x), np.nan)
        jump = np.flatnonzero(np.abs(np.diff(angle)) > 180.0) + 1
        lower.plot(np.insert(result.speeds, jump, np.nan), np.insert(angle, jump, np.nan), **style(k))
    lower.set_ylabel("lag of x [degrees]")
    lower.set_ylim(-50.0, 320.0)
    lower.set_yticks([0.0, 90.0, 180.0, 270.0])
    _over_speed(lower, result)
    _rpm_above(upper)
    figure.legend(*upper.get_legend_handles_labels(), loc="outside lower left", ncols=4)
    figure.suptitle(_title(result, "steady unbalance response"), x=0.01, ha="left")
    first: Axes = upper
    return first


def _amplitudes(ax: Axes, result: UnbalanceResponse, places: list[str], scale: float, unit: str, logarithmic: bool) -> None:
    for k, place in enumerate(places):
        ax.plot(result.speeds, scale * result.of(place).major, label=readable(place), **style(k))
    peaks = [peak for peak in result.peaks if peak.place in places and np.isfinite(peak.amplitude)]
    for peak in peaks:
        ax.plot([peak.speed], [scale * peak.amplitude], color=style(places.index(peak.place))["color"], **RING)
    _name_peaks(ax, [(peak.speed, scale * peak.amplitude) for peak in peaks], float(np.ptp(result.speeds)))
    ax.set_ylabel(f"major semi-axis, 0-peak [{unit}]")
    if logarithmic:
        ax.set_yscale("log")
    else:
        ax.set_ylim(bottom=0.0)


def _name_peaks(ax: Axes, peaks: list[tuple[float, float]], width: float) -> None:
    """The speed beside the highest of peaks that lie close together."""
    named: list[float] = []
    for speed, height in sorted(peaks, key=lambda item: -item[1]):
        if all(abs(speed - other) > 0.03 * width for other in named):
            named.append(speed)
            name_point(ax, f"{number(speed)} rad/s", speed, height)


def _polar(result: UnbalanceResponse, ax: Axes | None, places: list[str]) -> Axes:
    scale, unit = _scale(result, places)
    fresh = ax is None
    ax = given_or_new(ax, 5.6, 5.6)
    for k, place in enumerate(places):
        x = scale * result.of(place).x
        ax.plot(x.real, x.imag, label=readable(place), **style(k))
    named = max(places, key=lambda place: float(np.nanmax(np.abs(result.of(place).x), initial=0.0)))
    first = scale * result.of(named).x
    for k in _marks(first):
        ax.plot([first[k].real], [first[k].imag], color=style(places.index(named))["color"], **RING)
        name_point(ax, number(float(result.speeds[k])), float(first[k].real), float(first[k].imag))
    ax.axhline(0.0, color=GREY, linewidth=0.8, linestyle="-", zorder=0.5)
    ax.axvline(0.0, color=GREY, linewidth=0.8, linestyle="-", zorder=0.5)
    ax.set_aspect("equal", adjustable="datalim")
    ax.set_xlabel(f"in phase with the shaft: Re x, 0-peak [{unit}]")
    ax.set_ylabel(f"a quarter turn ahead: Im x, 0-peak [{unit}]")
    if fresh:
        ax.figure.figure.suptitle(_title(result, f"polar diagram, speeds of {readable(named)} in rad/s"), x=0.01, ha="left")
    legend_above(ax)
    return ax


def _marks(curve: npt.NDArray[np.complex128], most: int = 9) -> list[int]:
    """Points about evenly spaced along a curve, without the crowd about zero at both ends."""
    finite = np.flatnonzero(np.isfinite(curve))
    if len(finite) < 2:
        return [int(k) for k in finite]
    length = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(curve[finite])))])
    wanted = np.linspace(0.0, length[-1], most + 2)[1:-1]
    return sorted({int(finite[int(np.argmin(np.abs(length - value)))]) for value in wanted})


def _orbits(result: UnbalanceResponse, ax: Axes | None, places: list[str], speeds: Sequence[float] | None) -> Axes:
    scale, unit = _scale(result, places)
    at = _orbit_speeds(result, places, speeds)
    if ax is not None:
        if len(at) > 1:
            raise ParameterError(f"One Axes shows the orbits at one speed, {len(at)} were asked for; leave ax out for a panel each.")
        _orbit_panel(ax, result, places, at[0], scale, unit)
        legend_above(ax)
        return ax
    columns = min(3, len(at))
    rows = -(-len(at) // columns)
    figure = new_figure(max(6.0, 2.6 * columns + 0.8), 2.7 * rows + 1.0)
    panels = figure.subplots(rows, columns, squeeze=False).ravel()
    for panel, k in zip(panels, at):
        _orbit_panel(panel, result, places, k, scale, unit)
    for spare in panels[len(at) :]:
        spare.remove()
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower left", ncols=4)
    figure.suptitle(_title(result, "orbits, 0-peak about the static position; dot: shaft angle 0"), x=0.01, ha="left")
    first: Axes = panels[0]
    return first


def _orbit_speeds(result: UnbalanceResponse, places: list[str], speeds: Sequence[float] | None) -> list[int]:
    """Numbers of the calculated speeds nearest to those asked for, each once."""
    if speeds is not None and not len(speeds):
        raise ParameterError("speeds: name at least one speed [rad/s] for the orbits.")
    if speeds is None:
        at_peaks = _apart([peak.speed for peak in result.peaks if peak.place in places])
        speeds = at_peaks or np.quantile(result.speeds, [0.25, 0.5, 0.75]).tolist()
    return list(dict.fromkeys(int(np.argmin(np.abs(result.speeds - speed))) for speed in speeds))[:MOST_ORBITS]


def _apart(speeds: list[float]) -> list[float]:
    """Speeds in ascending order, of those within 2 % of each other the first."""
    kept: list[float] = []
    for speed in sorted(speeds):
        if not kept or abs(speed - kept[-1]) > 0.02 * abs(speed):
            kept.append(speed)
    return kept


def _orbit_panel(ax: Axes, result: UnbalanceResponse, places: list[str], k: int, scale: float, unit: str) -> None:
    turn = np.exp(1j * np.linspace(0.0, 2.0 * np.pi * 0.94, 200))  # open at the end, so that the direction shows
    for number_, place in enumerate(places):
        one = result.of(place)
        x, y = (scale * np.real(amplitude[k] * turn) for amplitude in (one.x, one.y))
        ax.plot(x, y, label=readable(place), **style(number_))
        ax.plot(x[:1], y[:1], "o", color=style(number_)["color"], markersize=4)
    ax.set_aspect("equal", adjustable="datalim")
    ax.set_title(f"{number(float(result.speeds[k]))} rad/s", fontsize=9.5)
    ax.set_xlabel(f"x [{unit}]")
    ax.set_ylabel(f"y [{unit}]")


def _forces(result: UnbalanceResponse, ax: Axes | None, bearings: Sequence[str] | None, logarithmic: bool) -> Axes:
    chosen = list(result.bearings if bearings is None else bearings)
    if not chosen:
        raise ParameterError("This line has no bearing that tells its force.")
    fresh = ax is None
    ax = given_or_new(ax, 7.2, 4.2)
    for k, bearing in enumerate(chosen):
        ax.plot(result.speeds, result.force(bearing).major, label=readable(bearing), **style(k))
    ax.set_ylabel("force on the housing, major semi-axis, 0-peak [N]")
    if logarithmic:
        ax.set_yscale("log")
    else:
        ax.set_ylim(bottom=0.0)
    _over_speed(ax, result)
    if fresh:
        _rpm_above(ax)
        ax.figure.figure.suptitle(_title(result, "bearing forces under unbalance"), x=0.01, ha="left")
        ax.legend(loc="best")
    else:
        legend_above(ax)
    return ax

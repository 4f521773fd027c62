"""A trial's network linearised along its motion, with unknown forces at all places."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.components.drive_torque import DriveTorque
from hdrive_mbs.components.rotor import Rotor
from hdrive_mbs.diagnosis.locate.linear import Linear, linearised
from hdrive_mbs.diagnosis.locate.motion import Motion
from hdrive_mbs.diagnosis.locate.observer import Observer, observer
from hdrive_mbs.diagnosis.locate.sources import Source, lateral_sources, pushed, sources, turning_sources
from hdrive_mbs.diagnosis.trial import Trial
from hdrive_mbs.network.network import Network

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]

WINDOW = 1024
"""Samples of a window; a quarter of the record where that is shorter."""
MOMENTS, ROTOR_MOMENTS = 64, 16
"""Moments of a window at which the model is linearised and averaged; that of rotors changes little but with speed."""


@dataclass(frozen=True, eq=False)
class Line:
    """A linearised trial.

    sources : that may show in it;  states : (name of the source, state of its force) by column of B and D
    linear : of each window, or of each half of one with an observer (rotors);  sensors : groups of columns that err together
    """

    sources: tuple[Source, ...]
    states: tuple[tuple[str, str], ...]
    linear: Linear
    observer: Observer | None
    sensors: Mapping[str, tuple[str, ...]]


def window_of(trial: Trial) -> int:
    """Samples of a window."""
    return min(WINDOW, trial.samples // 4 // 2 * 2)


def line(motion: Motion, at: str | None = None, like: Observer | None = None) -> Line:
    """Of a motion.

    at : of rotors only the sources of this place;  like : whose gains an observer takes over
    """
    trial, network = motion.trial, motion.network
    window = window_of(trial)
    driven = _driven(trial, network)
    sensors: dict[str, tuple[str, ...]] = {}
    if not network.is_lateral:
        given = sources(network)
    elif _lateral(trial, network):
        given, sensors = lateral_sources(network, _coupled(trial, driven)), _pairs(trial, network)
    else:
        given = turning_sources(network, driven)
    if network.is_lateral and at is not None:
        given = tuple(source for source in given if source.at == at)
    wide, states = pushed(network, given)
    moments = np.arange(0, trial.samples, max(1, window // (ROTOR_MOMENTS if network.is_lateral else MOMENTS)))
    channels = [item.channel for item in trial.measured.values()]
    along = {key: values[moments] for key, values in motion.values.items()}
    whole = linearised(wide, channels, [state for _, state in states], trial.times[moments], along)
    hop = window // 2
    if not network.is_lateral:
        firsts = hop * (np.arange(-(-trial.samples // hop) + 1) - 1)
        return Line(given, states, whole.mean(_spans(moments, firsts, window)), None, sensors)
    parts = whole.mean(_spans(moments, hop * np.arange(-(-trial.samples // hop)), hop))
    late = [item.late for item in trial.measured.values()]
    reads = np.array(
        [[row @ _ahead(a, share * trial.every) for row, share in zip(c, late, strict=True)] for a, c in zip(parts.a, parts.c, strict=True)]
    )
    noise = np.array([item.total for item in trial.measured.values()])
    watching = observer(parts.a, parts.b, reads, parts.d, noise, trial.every, hop) if like is None else like.moved(parts.a, reads)
    return Line(given, states, parts, watching, sensors)


def of_windows(parts: ComplexArray, windows: int) -> ComplexArray:
    """What stretches of half a window give for half-overlapping windows: the mean of the two that each one covers."""
    at = np.arange(windows)
    return 0.5 * (parts[np.clip(at - 1, 0, len(parts) - 1)] + parts[np.clip(at, 0, len(parts) - 1)])


def _spans(at: npt.NDArray[np.int64], firsts: npt.NDArray[np.int64], length: int) -> list[npt.NDArray[np.int64]]:
    spans = [np.flatnonzero((at >= first) & (at < first + length)) for first in firsts]
    return [span if len(span) else np.array([len(at) - 1]) for span in spans]  # the last one may begin after the last moment


def _ahead(a: FloatArray, time: float) -> FloatArray:
    return np.eye(len(a)) + time * a + 0.5 * time**2 * (a @ a) if time else np.eye(len(a))


def _driven(trial: Trial, network: Network) -> dict[str, str]:
    """Station -> part that drives it."""
    return {
        network.places[name]: name for name, part in trial.scene.parts.items() if isinstance(part, DriveTorque) and name in network.places
    }


def _coupled(trial: Trial, driven: Mapping[str, str]) -> dict[str, str]:
    """Those that a coupling joins to their drive: what shakes a rotor that is driven itself is its own."""
    return {station: part for station, part in driven.items() if not isinstance(trial.scene.parts.get(station), Rotor)}


def _reads(trial: Trial, network: Network, column: str) -> str:
    """Channel that a column shows, past its sensor."""
    name = trial.measured[column].channel
    channel = next((item for item in network.channels if item.name == name), None)
    return name if channel is None or channel.reads is None else channel.reads


def _lateral(trial: Trial, network: Network) -> bool:
    """Whether a column shows how something moves across the shaft."""
    names = tuple(body.name for body in network.bodies if body.lateral)
    read = [_reads(trial, network, column) for column in trial.columns]
    return any(name.startswith(names) or network.probed(name) is not None for name in read)


def _pairs(trial: Trial, network: Network) -> dict[str, tuple[str, ...]]:
    """Sensors that look at the same station: a surface that is not round shows in all of them."""
    found: dict[str, list[str]] = {}
    for column in trial.columns:
        read = _reads(trial, network, column)
        seen = network.probed(read) if read != trial.measured[column].channel else None
        if seen is not None:
            found.setdefault(f"{seen.place}.sensors", []).append(column)
    return {at: tuple(columns) for at, columns in found.items() if len(columns) > 1}

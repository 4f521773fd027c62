"""What an unknown force at each place does to the columns of a trial."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.diagnosis.locate.linear import linearised, transfers
from hdrive_mbs.diagnosis.locate.motion import Motion
from hdrive_mbs.diagnosis.locate.sources import Source, pushed, sources
from hdrive_mbs.diagnosis.locate.spectra import Spectra

ComplexArray = npt.NDArray[np.complex128]

MOMENTS = 64
"""Moments of a window at which the model is linearised and averaged."""
SLOWEST = 0.25
"""Of the distance of two bins: the frequency that stands for zero."""


@dataclass(frozen=True, eq=False)
class Response:
    """Transfers of one trial.

    sources : places with forces in this trial, by name
    of : place -> whitened transfer, shape (windows, bins, columns, d)
    """

    sources: Mapping[str, Source]
    of: Mapping[str, ComplexArray]


def response(motion: Motion, spectra: Spectra) -> Response:
    """Of all places of a trial: bodies, connections and the like, and sensors.

    A column that measures a channel without a sensor in the scene is a place by its own name.
    """
    trial, network = motion.trial, motion.network
    given = sources(network)
    wide, names = pushed(network, given)
    at = np.arange(0, trial.samples, max(1, spectra.window // MOMENTS))
    channels = [item.channel for item in trial.measured.values()]
    along = {key: values[at] for key, values in motion.values.items()}
    linear = linearised(wide, channels, [state for _, state in names], trial.times[at], along)
    spans = [np.flatnonzero((at >= first) & (at < first + spectra.window)) for first in spectra.starts]
    spans = [span if len(span) else np.array([len(at) - 1]) for span in spans]  # the last window may begin after the last moment
    rates = np.maximum(spectra.frequencies, SLOWEST * spectra.frequencies[1])
    transfer = transfers(linear.mean(spans), 1j * rates) * spectra.whitening[..., None]
    found = {source.at: transfer[..., [k for k, (place, _) in enumerate(names) if place == source.at]] for source in given}
    known = {channel.name: channel for channel in network.channels}
    readers = {}
    for k, (column, item) in enumerate(trial.measured.items()):
        channel = known.get(item.channel)
        sensor = channel is not None and channel.reads is not None
        if not sensor and item.channel.endswith(".torque"):
            continue  # a command: what is wrong with it is a force at the motor
        name = item.channel if sensor else column
        error = np.zeros((*transfer.shape[:3], 1), complex)
        error[:, :, k, 0] = spectra.whitening[..., k]
        found[name] = error
        readers[name] = Source(name, {}, channel.unit if channel is not None else "")
    return Response({source.at: source for source in given} | readers, found)

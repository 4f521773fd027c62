"""What an unknown force at each place does to the columns of a trial."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.diagnosis.locate.line import Line, of_windows
from hdrive_mbs.diagnosis.locate.linear import transfers
from hdrive_mbs.diagnosis.locate.motion import Motion
from hdrive_mbs.diagnosis.locate.sources import Source
from hdrive_mbs.diagnosis.locate.spectra import Spectra

ComplexArray = npt.NDArray[np.complex128]

SLOWEST = 0.25
"""Of the distance of two bins: the frequency that stands for zero."""


@dataclass(frozen=True, eq=False)
class Response:
    """Transfers of one trial.

    sources : what may act in this trial, by name
    of : source -> whitened transfer, shape (windows, bins, columns, d)
    """

    sources: Mapping[str, Source]
    of: Mapping[str, ComplexArray]


def response(motion: Motion, line: Line, spectra: Spectra) -> Response:
    """Of all places of a trial: bodies, connections and the like, and sensors.

    A column that measures a channel without a sensor in the scene is a place by its own name.
    """
    trial, network = motion.trial, motion.network
    rates = np.maximum(spectra.frequencies, SLOWEST * spectra.frequencies[1])
    transfer = transfers(line.linear, 1j * rates)
    late = np.array([item.late * trial.every for item in trial.measured.values()])
    transfer = transfer * np.exp(1j * spectra.frequencies[:, None] * late)[..., None]
    errors: ComplexArray = np.broadcast_to(np.eye(len(late), dtype=complex), (*spectra.values.shape[:2], len(late), len(late)))
    if line.observer is not None:
        seen = line.observer.noise_transfer(rates)
        transfer, errors = of_windows(seen @ transfer, len(errors)), of_windows(seen, len(errors))
    transfer, errors = spectra.whitening @ transfer, spectra.whitening @ errors
    found: dict[str, ComplexArray] = {}
    for source in line.sources:
        own = transfer[..., [k for k, (name, _) in enumerate(line.states) if name == source.name]]
        found[source.name] = own[..., 0::2] - 1j * own[..., 1::2] if source.rotating else own
    known = {channel.name: channel for channel in network.channels}
    readers = {}
    for k, (column, item) in enumerate(trial.measured.items()):
        channel = known.get(item.channel)
        sensor = channel is not None and channel.reads is not None
        if not sensor and item.channel.endswith((".torque", ".command")):
            continue  # a command: what is wrong with it is a force at the motor
        name = item.channel if sensor else column
        found[name] = errors[..., [k]]
        readers[name] = Source(name, {}, channel.unit if channel is not None else "")
    for at, columns in line.sensors.items():
        found[at] = errors[..., [list(trial.measured).index(column) for column in columns]]
        readers[at] = Source(at, {}, known[trial.measured[columns[0]].channel].unit, columns=columns)
    return Response({source.name: source for source in line.sources} | readers, found)

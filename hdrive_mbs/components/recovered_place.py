"""Channels of a place that a condensed part has inside: what a station there would have shown."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial

import numpy as np
import numpy.typing as npt

from hdrive_mbs.expression import Value
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.station import GROUND, LATERAL, UNITS, WORDS, Station

FloatArray = npt.NDArray[np.float64]


def factors_of(row: FloatArray, a: Station, b: Station, own: tuple[str, ...]) -> dict[str, float]:
    """A row over the 6-vectors of a and b and own coordinates as factors of coordinates."""
    values = np.concatenate([row[:6] @ a.arm(), row[6:12] @ b.arm(), row[12:]])
    factors: dict[str, float] = {}
    for coordinate, value in zip((*a.names, *b.names, *own), values, strict=True):
        if coordinate != GROUND and value != 0.0:
            factors[coordinate] = factors.get(coordinate, 0.0) + float(value)
    return factors


def add_place(name: str, draft: Draft, position: float, rows: Mapping[str, Mapping[str, float]], sag: FloatArray | None = None) -> None:
    """Channels of a place that is no station, as the full model has them: x ... theta and radial.

    position : on the axis [m];  rows : direction -> factors of coordinates;  sag : offset per gravity in x, y and z, (5, 3)
    """
    draft.set_position(name, position)

    def offset(row: int) -> float:
        return 0.0 if sag is None else float(sag[row] @ np.array(draft.gravity))

    for row, key in enumerate(LATERAL):
        draft.add_displacement(f"{name}.{key}", rows[key], UNITS[key], f"{WORDS[key]} of {name}", partial(offset, row))

    def radial(moment: Moment) -> Value:
        x, y = (sum((f * moment.angle(c) for c, f in rows[key].items()), offset(row)) for row, key in enumerate("xy"))
        return np.hypot(x, y)

    draft.add_channel(f"{name}.radial", "m", f"distance of the centre of {name} from the axis", radial)

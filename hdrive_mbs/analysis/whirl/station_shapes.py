"""Mode shapes by place: displacement, tilts and spin of every place along the line."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from hdrive_mbs.analysis.whirl.roots import ComplexArray
from hdrive_mbs.network.network import Network

DIRECTIONS = ("x", "y", "z", "psi", "theta", "phi")

FIRST = {"axial": 1, "torsional": 2}
"""Which motion the scale of a mode is taken from, if not from the orbit."""


class StationShapes:
    """Places with their axial positions, and their six motions (true sense) as sums of coordinates.

    places : names along the line; housings as ``bearing.housing``; places that only turn come last
    positions : m, NaN for a place that only turns
    """

    def __init__(self, network: Network, names: tuple[str, ...]) -> None:
        index = {name: k for k, name in enumerate(names)}
        senses = {body.name: body.sense for body in network.bodies if not body.lateral}
        factors = {channel.name: channel.factors for channel in network.channels if channel.factors is not None}
        known = {channel.name for channel in network.channels}
        at = network.positions
        found: dict[str, float] = {}
        for place, node in network.places.items():
            moves = f"{place}.x" in factors or node in index
            if moves and f"{place}.speed" in known and (place == node or at.get(place) != at.get(node)):
                found[place] = at.get(place, np.nan)
        for channel in factors:
            owner, dot, direction = channel.rpartition(".")
            if dot and direction == "x" and owner not in network.places:
                found[owner] = at.get(owner, at.get(owner.rpartition(".")[0], np.nan))
        self.places = tuple(sorted(found, key=lambda place: (np.isnan(found[place]), found[place])))
        self.positions = np.array([found[place] for place in self.places])
        self._matrix = np.zeros((len(self.places), 6, len(names)))
        for k, place in enumerate(self.places):
            for row, direction in enumerate(DIRECTIONS[:5]):
                for name, factor in (factors.get(f"{place}.{direction}") or {}).items():
                    self._matrix[k, row, index[name]] = factor
            node = network.places.get(place, "")
            if node in index:
                self._matrix[k, 5, index[node]] = senses[node]

    def of(self, index: npt.NDArray[np.intp], shapes: ComplexArray, kinds: Sequence[str]) -> ComplexArray:
        """Shapes over the coordinates ``index``, (n, k), as (k, places, 6), scaled.

        kinds : word of each shape; of a torsional one the spin has amplitude 1, of an axial one z, of any other one the
            displacement, or the tilt where nothing is displaced

        The place with the largest motion of that kind has amplitude 1 (0-peak, major semi-axis), and its larger
        coordinate (x of a circle) is there at time 0.
        """
        motion = np.einsum("pdn,nk->kpd", self._matrix[:, :, index], shapes)
        for mode, kind in zip(motion, kinds, strict=True):
            x, y, z, psi, theta, phi = mode.T
            orbit = 0.5 * (np.abs(x + 1j * y) + np.abs(x - 1j * y))
            tilt = 0.5 * (np.abs(theta - 1j * psi) + np.abs(theta + 1j * psi))
            options = [(orbit, (x, y)), (np.abs(z), (z,)), (np.abs(phi), (phi,)), (tilt, (theta, psi))]
            if kind in FIRST:
                options.insert(0, options.pop(FIRST[kind]))
            for size, both in options:
                if size.max(initial=0.0) > 1e-9 * np.abs(mode).max(initial=0.0):
                    place = int(np.argmax(size))
                    first, last = complex(both[0][place]), complex(both[-1][place])
                    lead = first if abs(first) > 0.999 * abs(last) else last  # x of a circle
                    mode *= abs(lead) / lead / size[place]
                    break
        return np.asarray(motion)

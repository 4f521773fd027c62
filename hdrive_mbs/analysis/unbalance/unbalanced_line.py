"""A line and what its unbalance does to it: sources, places and bearings by coordinate."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.analysis.unbalance.channel_slopes import ChannelSlopes
from hdrive_mbs.analysis.unbalance.deflection_line import force_places, lateral_places
from hdrive_mbs.analysis.unbalance.response_peaks import NARROW
from hdrive_mbs.analysis.unbalance.speed_line import SpeedLine
from hdrive_mbs.analysis.unbalance.unbalance_forces import UnbalanceSource, by_frequency, rotor_sources, trial_source
from hdrive_mbs.analysis.unbalance.whirl_orbit import WhirlOrbit
from hdrive_mbs.analysis.whirl.rotor_point import rotor_point
from hdrive_mbs.network.network import Network
from hdrive_mbs.progress import Report
from hdrive_mbs.scene import Scene

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]

DIRECTIONS = ("x", "y", "psi", "theta")


@dataclass(frozen=True, eq=False)
class UnbalancedLine:
    """Everything of a response that does not depend on the speed that is asked for.

    line : the matrices over speed
    places, senses : names, and the sense of the spin there
    bearings : those that tell their force
    groups : frequency over reference speed, and the sources of that frequency
    shapes : place and direction (x, y, psi, theta) by coordinate, (p, 4, n)
    transmission : bearing force by displacement and by velocity at the knots of the line, (knots, 2, 2 b, n)
    twists : spin -> true angle ahead of the reference shaft [rad] at twist_speeds
    """

    line: SpeedLine
    places: tuple[str, ...]
    senses: FloatArray
    bearings: tuple[str, ...]
    groups: list[tuple[float, list[UnbalanceSource]]]
    shapes: FloatArray
    transmission: FloatArray
    twist_speeds: FloatArray
    twists: dict[str, FloatArray]

    @classmethod
    def build(
        cls, scene: Scene, speeds: FloatArray, extra: Mapping[str, tuple[float, float]], rotors: bool, report: Report | None
    ) -> UnbalancedLine:
        network = scene.network()
        places, bearings = lateral_places(network), force_places(network)
        coordinates = [body.name for body in network.bodies]
        rows = _rows(network, places, coordinates)

        def factors(place: str, direction: int) -> dict[str, float]:
            if place not in places:
                return {}
            row = rows[places.index(place), direction]
            return {coordinates[k]: float(row[k]) for k in np.flatnonzero(row)}

        sources = rotor_sources(network) if rotors else []
        sources += [trial_source(network, place, value, factors(place, 0), factors(place, 1)) for place, value in extra.items()]
        groups = by_frequency(sources)
        reach = [name for source in sources for name, value in source.along.items() if value]
        line = SpeedLine.over(scene, speeds, reach, None if report is None else lambda done: report(0.9 * done / len(speeds)))
        kept = [coordinates.index(name) for name in line.names]
        slopes = ChannelSlopes(network, [f"{b}.force_{key}" for b in bearings for key in "xy"], line.names)
        points = line.points if not slopes.is_constant else line.points[:1] * len(line.knots)
        twist_speeds, twists = _twists(scene, line, sources, speeds)
        ratios = {body.name: body.ratio for body in network.bodies}
        turning = [ratios.get(network.places.get(place, network.places.get(place.removesuffix(".housing"), "")), 1.0) for place in places]
        return cls(
            line=line,
            places=places,
            senses=np.where(np.array(turning) < 0.0, -1.0, 1.0),
            bearings=bearings,
            groups=groups,
            shapes=rows[:, :, kept],
            transmission=np.array([slopes.at(point) for point in points]),
            twist_speeds=twist_speeds,
            twists=twists,
        )

    def amplitudes(self, group: int, speeds: FloatArray) -> tuple[FloatArray, ComplexArray]:
        """Frequencies [rad/s], (s,), and amplitudes of the coordinates, (s, n)."""
        ratio, sources = self.groups[group]
        index = {name: k for k, name in enumerate(self.line.names)}
        force = sum(source.amplitudes(index, speeds, np.interp(speeds, self.twist_speeds, self.twists[source.spin])) for source in sources)
        frequencies = ratio * np.abs(speeds)
        return frequencies, self.line.solve(speeds, frequencies, np.asarray(force, complex))

    def response(self, group: int, speeds: FloatArray) -> tuple[ComplexArray, ComplexArray]:
        """Motion of the places, (s, p, 4), and forces of the bearings, (s, b, 2)."""
        frequencies, q = self.amplitudes(group, speeds)
        motion = np.einsum("pdn,sn->spd", self.shapes, q)
        per = self.line.between(self.transmission, speeds)
        force = np.einsum("sfn,sn->sf", per[:, 0], q) + 1j * frequencies[:, None] * np.einsum("sfn,sn->sf", per[:, 1], q)
        return motion, force.reshape(len(speeds), len(self.bearings), 2)

    def major(self, speeds: FloatArray) -> FloatArray:
        """Major semi-axis of all places at the first frequency, (s, p)."""
        _, q = self.amplitudes(0, speeds)
        x, y = (q @ self.shapes[:, k].T for k in (0, 1))
        return WhirlOrbit(x, y, np.ones(x.shape)).major

    def curves(self, speeds: FloatArray) -> ComplexArray:
        """x and y at the first frequency of the places that move differently, (s, 2 places)."""
        _, q = self.amplitudes(0, speeds)
        return np.asarray(q @ self.shapes[self.own_places(), :2].reshape(-1, self.shapes.shape[2]).T)

    def hints(self, *, damped: bool = False) -> FloatArray:
        """Speeds at and beside the poles of the response, those with damping alone if asked for."""
        poles = self.line.poles(self.groups[0][0])
        if damped:
            poles = poles[np.abs(poles.imag) > NARROW * np.abs(poles)]
        return np.concatenate([poles.real + share * np.abs(poles.imag) for share in (-3.0, -1.0, 0.0, 1.0, 3.0)])

    def own_places(self) -> list[int]:
        """Columns of places that move differently from all before them; stations inside a shaft left out."""
        chosen: list[int] = []
        for k, place in enumerate(self.places):
            inner = place.rpartition(".")[2].isdigit()
            if not inner and not any(np.array_equal(self.shapes[k], self.shapes[j]) for j in chosen) and self.shapes[k].any():
                chosen.append(k)
        return chosen


def _rows(network: Network, places: tuple[str, ...], coordinates: list[str]) -> FloatArray:
    """x, y, psi and theta of the places by coordinate, (p, 4, n); zero where there is no tilt."""
    known = {channel.name for channel in network.channels}
    rows = np.zeros((len(places), 4, len(coordinates)))
    wanted = [(k, d, f"{place}.{key}") for k, place in enumerate(places) for d, key in enumerate(DIRECTIONS) if f"{place}.{key}" in known]
    slopes = ChannelSlopes(network, [name for _, _, name in wanted], coordinates)
    for (k, d, _), row in zip(wanted, slopes.linear(), strict=True):
        rows[k, d] = row
    return rows


def _twists(scene: Scene, line: SpeedLine, sources: list[UnbalanceSource], speeds: FloatArray) -> tuple[FloatArray, dict[str, FloatArray]]:
    """True twist [rad] of each unbalanced body against the reference shaft at some speeds."""
    senses = {source.spin: source.sense for source in sources}
    points, at = line.points, line.knots
    twisted = any(abs(point.angles[spin]) > 1e-12 for point in points for spin in senses)
    if twisted and len(at) < len(speeds):
        points, at = tuple(rotor_point(scene, float(speed), lines=line.lines) for speed in speeds), speeds
    return at, {spin: np.array([sense * point.angles[spin] for point in points]) for spin, sense in senses.items()}

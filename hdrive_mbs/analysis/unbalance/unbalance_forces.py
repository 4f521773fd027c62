"""Forces of unbalance at steady rotation, as complex amplitudes, sorted by frequency."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.errors import AnalysisError, ParameterError, unknown_place
from hdrive_mbs.network.network import Network

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]

SAME = 1e-9
"""Relative difference below which two speed ratios are one."""


@dataclass(frozen=True, eq=False)
class UnbalanceSource:
    """What one turning body or trial mass puts on the line.

    spin, sense, ratio : its spin coordinate, the sense of that and true speed per speed of the reference shaft
    along : coordinate -> b, complex: the force is Re[b w^2 exp(i phi)] with the true spin angle phi
    """

    spin: str
    sense: int
    ratio: float
    along: Mapping[str, complex]

    def amplitudes(self, index: Mapping[str, int], speeds: FloatArray, twist: FloatArray) -> ComplexArray:
        """F of Re[F exp(i |w| t)] over the speeds of the reference shaft, (s, coordinates).

        twist : true angle by which the body runs ahead of the reference shaft [rad], (s,)

        A body that turns about -z has phi = -|w| t, so its factors are conjugated.
        """
        speed = self.ratio * speeds
        turned = np.exp(1j * twist)[:, None] * np.array([[self.along.get(name, 0.0) for name in index]])
        return np.asarray(speed[:, None] ** 2 * np.where(speed[:, None] < 0.0, np.conj(turned), turned))


def rotor_sources(network: Network) -> list[UnbalanceSource]:
    """Static and dynamic unbalance of all rotors.

    F_x + i F_y = U w^2 exp(i phi) and M_y - i M_x = -J w^2 exp(i phi) with U = m e and J = J_xz + i J_yz.
    """
    ratios = {body.name: body.ratio for body in network.bodies}
    prescribed = [element.name.partition(".unbalance_")[0] for element in network.elements if ".unbalance_" in element.name]
    if prescribed:
        raise AnalysisError(
            f"The motion of the unbalanced rotor {prescribed[0]!r} is prescribed by something else than a motor, so its speed cannot "
            "be varied. Drive it by a Motor with an IdealSpeedMotor."
        )
    sources = []
    for rotor in network.rotors:
        static, product = rotor.body.static_unbalance, rotor.body.product_unbalance
        x, y, _, psi, theta, spin = rotor.coordinates
        along = {x: static, y: -1j * static, theta: -product, psi: -1j * product}
        if ratios[spin] and (static or product):
            sources.append(UnbalanceSource(spin, rotor.sense, ratios[spin], along))
    return sources


def trial_source(
    network: Network, place: str, unbalance: tuple[float, float], x: Mapping[str, float], y: Mapping[str, float]
) -> UnbalanceSource:
    """A mass times radius [kg m] at an angle [rad] in the frame that turns with the place.

    x, y : displacements of the place as factors of coordinates (virtual work spreads the force over them)
    """
    bodies = {body.name: body for body in network.bodies}
    body = bodies.get(network.places.get(place, ""))
    if body is None or not body.ratio or not x:
        stations = {name: node for name, node in network.places.items() if not name.endswith((".a", ".b"))}
        turning = [name for name, node in stations.items() if node in bodies and bodies[node].ratio and f"{node}.x" in bodies]
        raise unknown_place("turning place", place, turning)
    try:
        size, angle = (float(value) for value in unbalance)
    except (TypeError, ValueError):
        raise ParameterError(f"extra[{place!r}] = {unbalance!r}: give (mass times radius [kg m], angle [rad]).") from None
    if not (np.isfinite(size) and np.isfinite(angle) and size >= 0.0):
        raise ParameterError(f"extra[{place!r}] = ({size:g} kg m, {angle:g} rad): must be finite, and the unbalance at least 0 kg m.")
    static = size * np.exp(1j * angle)
    along: dict[str, complex] = {}
    for factors, part in ((x, static), (y, -1j * static)):
        for name, factor in factors.items():
            along[name] = along.get(name, 0.0) + factor * part
    return UnbalanceSource(body.name, body.sense, body.ratio, along)


def by_frequency(sources: list[UnbalanceSource]) -> list[tuple[float, list[UnbalanceSource]]]:
    """Sources in groups of one frequency per reference speed: first that of the reference shaft, then ascending.

    Raises AnalysisError where there is nothing.
    """
    if not sources:
        raise AnalysisError(
            "The line is balanced: no rotor has an eccentricity or a tilt, so its steady response is zero. "
            "Give a Rotor an eccentricity, or a trial mass: extra={'rotor': (1e-5, 0.0)} [kg m, rad]."
        )
    groups: list[tuple[float, list[UnbalanceSource]]] = []
    for source in sorted(sources, key=lambda item: (abs(abs(item.ratio) - 1.0) > SAME, abs(item.ratio))):
        size = abs(source.ratio)
        if groups and abs(groups[-1][0] - size) <= SAME * size:
            groups[-1][1].append(source)
        else:
            groups.append((size, [source]))
    return groups

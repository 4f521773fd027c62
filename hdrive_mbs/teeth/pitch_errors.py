"""From pitch and eccentricity errors of the wheels to orders and amplitudes of the kinematic error."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from hdrive_mbs.errors import unknown_place
from hdrive_mbs.quantities import Described, option, parameter
from hdrive_mbs.teeth.gear import WaveGear


@dataclass(frozen=True, kw_only=True)
class WheelError(Described):
    """One harmonic of the cumulative pitch deviation around a wheel:  f = A sin(n a + p), along the pitch circle.

    An eccentricity e is the harmonic 1 with A = e, an ovality d (half the difference of the
    diameters' halves) a harmonic 2.  Source: kinematics.  Leaves out deviations of single flanks.
    """

    wheel: str = option("wheel: circular_spline, flexspline, and in a double gear flexspline_inner and output_wheel")
    harmonic: int = parameter("1", "n, periods around the wheel", low=1, high=1000)
    amplitude: float = parameter("m", "A, amplitude (0-peak)", low=0.0, high=1e-2)
    phase: float = parameter("rad", "p", default=0.0)


@dataclass(frozen=True, kw_only=True)
class ErrorOrder:
    """One order of the kinematic error with the circular spline held.

    order : periods per turn of the wave generator
    amplitude : at the output [rad], 0-peak
    """

    order: float
    amplitude: float
    phase: float
    cause: str


def eccentricity(wheel: str, amount: float) -> WheelError:
    """A wheel off its axis by ``amount`` [m]."""
    return WheelError(wheel=wheel, harmonic=1, amplitude=amount)


def error_orders(gear: WaveGear, errors: Iterable[WheelError], imbalance: float = 0.0) -> tuple[ErrorOrder, ...]:
    """Kinematic error that the wheels' errors cause at the output.

    The teeth in mesh average the deviation: over the U zones, which lie 2 pi/U apart, and over the
    zone's width 2 b, all teeth sharing alike.  An error of harmonic n then comes through by

        |sum_k share_k exp(2 pi i n k/U)| * |sin(n b)/(n b)|,   share_k = (1 + imbalance cos(2 pi k/U))/U

    so eccentricities cancel between two zones that carry alike, ovalities do not.  The generator
    meets the wheel's errors n (1 - w_wheel/w_generator) times a turn: n on the held ring, slightly
    more on the others; the beat between them is the slow error once or twice per turn of the output.

    imbalance : 0 for zones that carry alike, 1 for one that carries nothing (two waves)
    Source: derived here; the orders are those measured by Nye, Kraml, NASA CP-3113 (1991) 237.
    Leaves out uneven sharing within a zone, the elastic part, and errors of the generator itself.
    """
    stages, gains, meshes = gear.stages(), gear.gains(), gear.meshes()
    wheels: dict[str, tuple[int, str, float]] = {}
    for k, (stage, mesh) in enumerate(zip(stages, meshes)):
        flexible = "flexspline" if k == 0 else "flexspline_inner"
        wheels[flexible] = (k, mesh[0], stage.flexible.tip_radius)
        wheels[mesh[2]] = (k, mesh[2], stage.rigid.tip_radius)
    speeds = gear.speeds()
    clear = gear.clearances()
    found = []
    for error in errors:
        if error.wheel not in wheels:
            raise unknown_place("wheel", error.wheel, wheels, "This gear")
        k, member, radius = wheels[error.wheel]
        n, waves = int(error.harmonic), stages[k].waves
        turns = np.arange(waves) / waves * 2.0 * np.pi
        shared = abs(np.sum((1.0 + imbalance * np.cos(turns)) / waves * np.exp(1j * n * turns)))
        width = np.pi * clear[k].zone / waves
        averaged = abs(np.sinc(n * width / np.pi))
        found.append(
            ErrorOrder(
                order=float(n * (1.0 - speeds[member])),
                amplitude=float(error.amplitude / radius * shared * averaged * abs(gains[k])),
                phase=error.phase,
                cause=f"harmonic {n} of {error.wheel}, {1e6 * error.amplitude:.3g} um",
            )
        )
    return tuple(found)

"""Where a run-up starts: static deflection and steady orbits at its first speed, or just above rest under an oil film."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from hdrive_mbs.analysis.run_up.rest_positions import FreeLine
from hdrive_mbs.analysis.unbalance.synchronous_whirl import steady_whirl
from hdrive_mbs.bearings.friction import WithFriction
from hdrive_mbs.bearings.journal import JournalBearing
from hdrive_mbs.components.bearing import Bearing
from hdrive_mbs.errors import AnalysisError
from hdrive_mbs.network.network import Network
from hdrive_mbs.scene import Scene

CREEPING = (0.1, 1.0)
"""Speeds [rad/s] of the reference shaft at which a line on oil films is started where it cannot start from rest."""


@dataclass(frozen=True)
class Start:
    """Speed of the reference shaft [rad/s], initial values, and what the status has to say about it."""

    speed: float
    values: Mapping[str, float]
    note: str = ""


def starts(scene: Scene, line: FreeLine, speed: float, *, from_static: bool) -> Iterator[Start]:
    """The start that is asked for; from rest on oil films also those just above it, slowest first.

    At rest a film answers squeezing alone: without a wall it carries no weight, and where a journal lies on its wall
    the film's damping jumps as it begins to turn.

    Raises AnalysisError where there is no static deflection at any of them.
    """
    films = oil_films(scene) if speed == 0.0 else []
    network = scene.network()
    sense = _sense(network) if films else 1.0
    error: AnalysisError | None = None
    found = False
    for at in (speed, *(sense * creeping for creeping in CREEPING if films)):
        carried = f"as at rest the film of {', '.join(films)} carries nothing"
        note = "" if at == speed else f"started at {at:g} rad/s, {carried}"
        try:
            values = _values(scene, line, at) if from_static else {}
        except AnalysisError as caught:
            error = error or caught
            continue
        found = True
        if at != speed and network.motions_drive:  # the spin is given: only the position is that of the speed
            note = f"started in the position of {at:g} rad/s, {carried}"
            yield Start(speed, {name: value for name, value in values.items() if not name.endswith("_rate")}, note)
        else:
            yield Start(at, values, note)
    if not found:
        hint = f" At rest the film of {', '.join(films)} carries nothing; a wall_stiffness would." if films else ""
        raise AnalysisError(f"{error}{hint} Or start at another initial_speed, or with from_static=False.") from None


def oil_films(scene: Scene) -> list[str]:
    """Names of the bearings with an oil film."""
    found = []
    for name, part in scene.parts.items():
        law = part.law if isinstance(part, Bearing) else None
        while isinstance(law, WithFriction):
            law = law.law
        found += [name] if isinstance(law, JournalBearing) else []
    return found


def _sense(network: Network) -> float:
    """Sense in which the torques at rest turn the reference shaft; forward where there are none."""
    still = dict.fromkeys((body.name for body in network.bodies), np.float64(0.0))
    torques = network.torques(network.moment(np.float64(0.0), still, still, {state.name: state.initial for state in network.states}))
    total = sum(body.sense * body.ratio * float(np.asarray(torques[body.name])) for body in network.bodies if not body.lateral)
    return math.copysign(1.0, total) if total else 1.0


def _values(scene: Scene, line: FreeLine, speed: float) -> dict[str, float]:
    """Initial values: static deflection and, if the line turns, the steady orbits."""
    point = line.point(speed)
    bodies = scene.network().bodies
    values = {body.name: point.angles[body.name] for body in bodies if body.lateral}
    values |= {f"{body.name}.angle": body.sense * point.angles[body.name] for body in bodies if not body.lateral}
    if speed != 0.0:
        places, rates = steady_whirl(line.lines, point)
        for name in places:
            values[name] = values.get(name, 0.0) + places[name]
            values[f"{name}_rate"] = rates[name]
    return {name: value for name, value in values.items() if value != 0.0}

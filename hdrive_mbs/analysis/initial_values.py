"""Where a run begins: forward angles, speeds and states from what is given by the names of channels."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from hdrive_mbs.errors import ParameterError, unknown_place
from hdrive_mbs.network.network import Body, Network
from hdrive_mbs.network.starting import angles_with_the_rest


def initial_values(network: Network, speed: float, given: Mapping[str, float]) -> dict[str, dict[str, float]]:
    """Forward angles, speeds and states at t = 0."""
    speed = finite_number("initial_speed", speed, "rad/s")
    angles = {body.name: 0.0 for body in network.bodies} | angles_with_the_rest(network, {})  # of a motion that begins at an angle
    speeds = {body.name: body.sense * body.ratio * speed for body in network.bodies}
    states = {state.name: state.initial for state in network.states}
    bodies = {body.name: body for body in network.bodies}
    units = {"angle": "rad", "speed": "rad/s"} | {state.name: state.unit for state in network.states}
    shown: dict[str, float] = {}
    hidden = {body.shown_as + ending: body for body in network.bodies if body.shown_as for ending in ("", "_rate")}
    for name, given_value in given.items():
        value = finite_number(f"initial value of {name}", given_value, units.get(name.rpartition(".")[2], units.get(name, "SI units")))
        place, _, quantity = name.rpartition(".")
        body = bodies.get(network.places.get(place, place))
        if name in states:
            states[name] = value
        elif body is not None and quantity == "angle":
            angles[body.name] = body.sense * value
        elif body is not None and quantity == "speed":
            speeds[body.name] = body.sense * value
        elif name in bodies and bodies[name].lateral:
            angles[name] = value
        elif name.removesuffix("_rate") in bodies and bodies[name.removesuffix("_rate")].lateral:
            speeds[name.removesuffix("_rate")] = value
        elif name in hidden:
            shown[name] = value
        else:
            known = [body.shown_as or body.name if body.lateral else f"{body.name}.angle/.speed" for body in network.bodies] + list(states)
            raise unknown_place("initial value", name, known)
    for body in network.bodies:
        for ending, values in (("", angles), ("_rate", speeds)):
            if body.shown_as and f"{body.name}{ending}" not in given:
                values[body.name] = _hidden_value(network, body, values, shown.get(f"{body.shown_as}{ending}", 0.0))
    return {"angles": angles, "speeds": speeds, "states": states}


def _hidden_value(network: Network, body: Body, values: Mapping[str, float], wanted: float) -> float:
    """Value of a coordinate at which the displacement that stands for it is the wanted one."""
    channel = next(channel for channel in network.channels if channel.name == body.shown_as)
    assert channel.factors is not None
    rest = sum(factor * values[name] for name, factor in channel.factors.items() if name != body.name)
    return (wanted - rest) / channel.factors[body.name]


def finite_number(name: str, value: Any, unit: str) -> float:
    """The number that is given for a quantity.  Raises ParameterError for anything else."""
    try:
        number = float("x" if isinstance(value, str) else value)
    except (TypeError, ValueError):
        raise ParameterError(f"{name} = {value!r}: must be a number, in {unit}.") from None
    if not np.isfinite(number):
        raise ParameterError(f"{name} = {value} {unit}: must be a finite number.")
    return number

"""Where the bodies of a train start: those of which nothing is said turn with the others."""

from __future__ import annotations

from collections.abc import Mapping

from hdrive_mbs.expression import Value
from hdrive_mbs.network.network import Body, Motion, Network


def angles_with_the_rest(network: Network, given: Mapping[str, float]) -> dict[str, float]:
    """Forward angles at the start [rad], by body, with those of bodies that are not named.

    These are turned by their ideal ratios with a place whose motion is given, or else with the first body that is named; lateral
    coordinates [m, rad] are left as they are.
    """
    return _completed(network, given, {motion.name: motion.angle(0.0) for motion in network.motions})


def speeds_with_the_rest(network: Network, given: Mapping[str, float]) -> dict[str, float]:
    """Forward speeds at the start [rad/s] likewise."""
    return _completed(network, given, {motion.name: motion.speed(0.0) for motion in network.motions})


def _completed(network: Network, given: Mapping[str, float], held: Mapping[str, Value]) -> dict[str, float]:
    """held : forward values of the places whose motion is given, by coordinate"""
    turning = [body for body in network.bodies if not body.lateral and body.ratio != 0.0]
    driven = [motion for motion in network.motions if motion.name != "ground" and motion.ratio != 0.0]
    known: list[tuple[Body | Motion, float]] = [(motion, float(held[motion.name])) for motion in driven]
    known += [(body, given[body.name]) for body in turning if body.name in given]
    if not known:
        return dict(given)
    first, value = known[0]
    per_motor = value * first.sense / first.ratio
    return {body.name: body.sense * body.ratio * per_motor for body in turning if per_motor != 0.0} | dict(given)

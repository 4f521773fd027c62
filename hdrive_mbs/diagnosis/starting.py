"""Where the bodies of a train start: those of which nothing is said turn with the others."""

from __future__ import annotations

from collections.abc import Mapping

from hdrive_mbs.network.network import Network


def with_the_rest(network: Network, angles: Mapping[str, float], speeds: Mapping[str, float]) -> tuple[dict[str, float], dict[str, float]]:
    """Forward angles and speeds at the start, by body, with those of bodies that are not named.

    These turn by their ideal ratios with a place whose motion is given, or else with the first body that is named; lateral
    motions are left as they are.

    angles, speeds : rad, rad/s (m, m/s of lateral motions), by body
    """
    return _completed(network, angles, "angle"), _completed(network, speeds, "speed")


def _completed(network: Network, given: Mapping[str, float], kind: str) -> dict[str, float]:
    turning = [body for body in network.bodies if not body.lateral]
    held = [motion for motion in network.motions if motion.name != "ground" and motion.ratio != 0.0]
    named = [body for body in turning if body.name in given and body.ratio != 0.0]
    if held:
        per_motor = float(getattr(held[0], kind)(0.0)) * held[0].sense / held[0].ratio
    elif named:
        per_motor = given[named[0].name] * named[0].sense / named[0].ratio
    else:
        return dict(given)
    return {body.name: body.sense * body.ratio * per_motor for body in turning if body.ratio * per_motor != 0.0} | dict(given)

"""Which fields of an effect act only through sizes of it that may be zero.

A Stribeck speed says nothing where the drop that fades with it may be none.  No effect declares this: the scene is built with the
sizes at the ends of their intervals and next to nothing, the field is changed, and accelerations and readings of the scene at
random moments tell whether the change is felt.  States and bodies that the effect brings along are drawn anew for the
comparison: a field that acts through them acts through a size only if they, too, are not felt without it.  Where the force of
such a state does not vanish with the size (LuGre's bristles), the field keeps its interval.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Collection, Mapping

import numpy as np
import numpy.typing as npt

from hdrive_mbs.errors import HdriveError
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.network import Network
from hdrive_mbs.scene import Scene

FloatArray = npt.NDArray[np.float64]

MOMENTS = 200
"""Random moments at which both are compared."""
NOTHING = 1e-9
"""Of the end of its interval: a size that is next to nothing."""
CHANGE = 1.3
"""By which a field is changed."""
VANISHED = 1e-3
"""Of what is felt with the sizes at a moment: what may be left without them."""
ROUNDING = 1e-12
"""Of a value: a difference that says nothing."""


def idle_without(scene: Scene, name: str, fields: Collection[str], sizes: Mapping[str, float]) -> frozenset[str]:
    """Those of the fields of an effect that are felt with the sizes and not without.

    scene : with the effect;  name : of the effect in it
    fields : paths;  sizes : paths of sizes that may be zero -> ends of their intervals
    """
    try:
        return frozenset(path for path in fields if _is_idle(scene, name, path, sizes))
    except (HdriveError, ArithmeticError, np.linalg.LinAlgError):
        return frozenset()  # a law that bears no such sizes is left as it is


def _is_idle(scene: Scene, name: str, path: str, sizes: Mapping[str, float]) -> bool:
    free = scene.parameters()[path]
    typical = free.quantity.typical
    upward = CHANGE * free.value <= free.high
    value = free.value * (CHANGE if upward else 1.0 / CHANGE)
    changed = {path: value if value != 0.0 or typical is None else (CHANGE - 1.0) * typical[1]}
    plain = dataclasses.replace(scene, effects=tuple(item for item in scene.effects if item.name != name)).network()
    felt = _felt(scene.replacing(sizes), changed, plain)
    left = _felt(scene.replacing({size: NOTHING * value for size, value in sizes.items()}), changed, plain)
    seen = any(bool(values.any()) for values in felt.values())
    return seen and all(bool(np.all(left[key] <= VANISHED * felt[key])) for key in felt)


def _felt(scene: Scene, changed: Mapping[str, float], plain: Network) -> dict[str, FloatArray]:
    """Differences that a change makes to what the scene without the effect has too; 0 where they are of the order of rounding."""
    before, after = scene.network(), scene.replacing(changed).network()
    moment = before.random_moment(np.random.default_rng(1), MOMENTS)
    own = {body.name for body in before.bodies} - {body.name for body in plain.bodies}
    own |= {state.name for state in before.states} - {state.name for state in plain.states}
    other = before.random_moment(np.random.default_rng(2), MOMENTS)
    redrawn = Moment(
        time=moment.time,
        angles={key: other.angles[key] if key in own else value for key, value in moment.angles.items()},
        speeds={key: other.speeds[key] if key in own else value for key, value in moment.speeds.items()},
        states={key: other.states[key] if key in own else value for key, value in moment.states.items()},
    )
    with np.errstate(all="ignore"):
        first, second = _outputs(before, moment, plain), _outputs(after, redrawn, plain)
    found = {}
    for key, values in first.items():
        difference = np.abs(second[key] - values)
        clear = np.isfinite(difference) & (difference > ROUNDING * np.abs(values))
        found[key] = np.where(clear, difference, 0.0)
    return found


def _outputs(network: Network, moment: Moment, plain: Network) -> dict[str, FloatArray]:
    known = {body.name for body in plain.bodies} | {state.name for state in plain.states}
    found = {key: value for key, value in network.accelerations(moment).items() if key in known}
    shown = {channel.name for channel in plain.channels}
    found |= {f"channel {channel.name}": channel.read(moment) for channel in network.channels if channel.name in shown}
    return {key: np.broadcast_to(np.asarray(value, float), (MOMENTS,)) for key, value in found.items()}

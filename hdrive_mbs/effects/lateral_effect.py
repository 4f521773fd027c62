"""The shape of effects that push a rotor line across its axis."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import ClassVar

from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.errors import PlaceError
from hdrive_mbs.expression import Value
from hdrive_mbs.network.coupling import Coupling
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.excitation import Excitation
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.station import Station

Stretches = dict[str, dict[str, float]]
"""Direction -> factors of coordinates."""
Push = Callable[[Moment, Value, Value, Value, Value, Value, Value, Value], tuple[Value, Value]]
"""(moment, time, angle, speed, x, y, x_rate, y_rate) -> force in x and y."""


@dataclass(frozen=True, kw_only=True)
class LateralEffect(Effect):
    """A force across the axis, and moments and a torque that come with it.

    What x and y are, and on what the force acts, follows from ``acts_on``:

    * "station", "rotor", "drive end": displacement of the place; on the place
    * "bearing": displacement of the ring against the housing; on the ring, its reaction on the housing
    * "support": displacement of the housing of that bearing; on the housing

    The spin is that of the place in the true sense, twisted as it is.  The channels ``<effect>.force_x`` and
    ``force_y`` show the force; that of the bearing does not include it.
    """

    acts_on: ClassVar[str] = "station"
    excites: ClassVar[bool] = False
    """Whether the force depends on time and spin alone: static deflection and whirl then leave it out, like unbalance."""

    @abstractmethod
    def force(self, time: Value, angle: Value, speed: Value, x: Value, y: Value, x_rate: Value, y_rate: Value) -> tuple[Value, Value]:
        """Force in x and y [N] at a true spin angle [rad] and speed [rad/s], displacements [m] and their rates [m/s]."""

    def moments(
        self, time: Value, angle: Value, speed: Value, psi: Value, theta: Value, psi_rate: Value, theta_rate: Value
    ) -> tuple[Value, Value] | None:
        """Moments about x and y [N m] at tilts [rad] and their rates [rad/s]; None for none.  Housings do not tilt."""
        return None

    def torque(self, time: Value, angle: Value, speed: Value, x: Value, y: Value, x_rate: Value, y_rate: Value) -> Value | None:
        """Torque on the spin in the true sense [N m], from the ground; None for none."""
        return None

    def pushing(self, draft: Draft, stretches: Stretches, name: str) -> Push:
        """``force`` at a moment.  Override it where the force depends on more than the motion of the place: on states that it adds."""
        return lambda moment, *across: self.force(*across)

    def factor(self, draft: Draft, place: str) -> Callable[[Moment], Value] | None:
        """What force, moments and torque are multiplied by, where that depends on more than the motion of the place; None for 1."""
        return None

    def apply(self, draft: Draft, place: str, name: str) -> None:
        stretches, factor = stretches_of(self, draft, place), self.factor(draft, place)
        push = self.pushing(draft, stretches, name)

        def forces(moment: Moment, s: Mapping[str, Value], v: Mapping[str, Value]) -> Mapping[str, Value]:
            across = (moment.time, s["phi"], v["phi"], s["x"], s["y"], v["x"], v["y"])
            found = dict(zip("xy", push(moment, *across), strict=True))
            tilting = None
            if "psi" in s:
                tilting = self.moments(moment.time, s["phi"], v["phi"], s["psi"], s["theta"], v["psi"], v["theta"])
            if tilting is not None:
                found |= dict(zip(("psi", "theta"), tilting, strict=True))
            torque = self.torque(*across)
            if torque is not None:
                found["phi"] = torque
            size = -1.0 if factor is None else -factor(moment)
            return {key: size * value for key, value in found.items()}

        kind = Excitation if self.excites else Coupling
        element = kind(name, stretches, forces, self.dissipative)
        draft.add_element(element)
        add_force_channels(draft, name, element)


def add_force_channels(draft: Draft, name: str, element: Coupling) -> None:
    """The channels ``<effect>.force_x`` and ``force_y`` of what an element pushes with [N]."""
    for key in "xy":

        def read(moment: Moment, key: str = key) -> Value:
            return -element.values(moment)[key] + 0.0 * moment.time

        draft.add_channel(f"{name}.force_{key}", "N", f"force of {name} in {key}", read)


def moving_station(effect: Effect, draft: Draft, place: str) -> Station:
    """The place as a station.  Raises PlaceError where it only turns or where the ground holds it."""
    kind = type(effect).__name__
    station = draft.station(place, kind)
    if station.held:
        raise PlaceError(f"{kind} at {place!r} would do nothing: that place is held by the ground. Put it on a place that can move.")
    return station


def stretches_of(effect: Effect, draft: Draft, place: str) -> Stretches:
    """What the ``acts_on`` of an effect means at a place: x, y, phi, and but for supports psi and theta.

    Raises PlaceError where the place is of another kind.
    """
    kind = type(effect).__name__
    if effect.acts_on == "bearing":
        found = draft.bearing(place, kind).stretches
    elif effect.acts_on == "support":
        found = draft.support(place, kind).displacement
    else:
        found = {}
    station = moving_station(effect, draft, place)
    own = {direction: station.stretch(direction) for direction in ("x", "y", "psi", "theta")}
    wanted = ("x", "y") if effect.acts_on == "support" else tuple(own)
    return {direction: dict(found.get(direction, own[direction])) for direction in wanted} | {"phi": station.stretch("phi")}

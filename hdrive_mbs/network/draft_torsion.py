"""What turns in a network while it is being built: connections, torques, states and prescribed motions."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from hdrive_mbs.errors import LawError, ParameterError, PlaceError
from hdrive_mbs.expression import TraceError, Value, gradient
from hdrive_mbs.network.connection_draft import ConnectionDraft, Torque
from hdrive_mbs.network.draft_channels import DraftChannels
from hdrive_mbs.network.elements import AppliedTorque, Connection, Element, StateRate
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.network import State
from hdrive_mbs.network.node import Node
from hdrive_mbs.network.varying_inertia import Share, VaryingInertia

Change = Callable[[Callable[[Moment], Value]], Callable[[Moment], Value]]
"""Torque of a moment -> what reaches the body in its place."""


class DraftTorsion(DraftChannels):
    """Connections, torques, states and prescribed motions."""

    def __init__(self, nodes: dict[str, Node], flanges: dict[str, str]) -> None:
        super().__init__(nodes, flanges)
        self._motions: dict[str, Callable[[Value], Value]] = {}
        self._states: dict[str, State] = {}
        self._varying: dict[str, VaryingInertia] = {}  # by node
        self._finished: tuple[Element, ...] = ()

    def add_connection(
        self,
        name: str,
        factors: dict[str, float],
        law: Torque,
        *,
        aliases: tuple[str, ...] = (),
        bodies: dict[str, str] | None = None,
        gap: float = 0.0,
    ) -> ConnectionDraft:
        """A torsional element along  x = sum(f_i q_i); channels twist, twist_rate and torque.

        gap : full width about zero in which the law has no elastic torque
        """
        merged: dict[str, float] = {}
        for coordinate, factor in factors.items():
            merged[coordinate] = merged.get(coordinate, 0.0) + factor
        draft = ConnectionDraft(name, merged, law, bodies=dict(bodies or {}), gap=gap)
        self._connections[name] = draft
        self._aliases |= dict.fromkeys(aliases, name)
        return draft

    def add_torque(
        self,
        name: str,
        coordinate: str,
        torque: Callable[[Moment], Value],
        *,
        dissipative: bool = False,
        stored: Callable[[Moment], Value] | None = None,
        is_motor: bool = False,
        is_load: bool = False,
    ) -> None:
        """A torque on a coordinate, positive in its forward sense.

        stored : energy in its states
        is_motor : it is that of the motor ``<motor>`` and called ``<motor>.torque``; effects may change what reaches the rotor
        is_load : likewise of the load ``<load>``
        """
        self._elements.append(AppliedTorque(name, coordinate, torque, dissipative, stored, is_motor, is_load))

    def add_inertia(self, place: str, inertia: float, asked_by: str = "This") -> None:
        """More inertia [kg m^2] at a place, or less.  Raises PlaceError where it leaves none, or where the place moves across the axis."""
        node = self.body(place, asked_by)
        if node.lateral or not node.inertia + inertia > 0.0:
            known = [path for path, name in self._flanges.items() if not self._nodes[name].lateral and self._nodes[name].inertia > -inertia]
            raise PlaceError(
                f"{asked_by} changes the inertia of {place!r} by {inertia:g} kg m^2, which has {node.inertia:g} kg m^2 "
                f"that only turn. Places where it can be done: {', '.join(known) or 'none'}."
            )
        self._nodes[node.name] = replace(node, inertia=node.inertia + inertia)

    def vary_inertia(
        self, place: str, share: Share, most: float, asked_by: str = "This"
    ) -> tuple[Callable[[Moment], Value], Callable[[Moment], Value]]:
        """Torque and energy of an inertia that varies by a share of that at the place (see VaryingInertia).

        most : largest size of the share

        Raises PlaceError where the place moves across the axis, ParameterError where shares may leave no inertia.
        """
        node = self.body(place, asked_by)
        if node.lateral:
            raise PlaceError(
                f"{asked_by} varies the inertia of {place!r} about its axis, which moves across the axis too: masses that make an inertia "
                "vary would shake it. Put it on a body that only turns."
            )
        varying = self._varying.setdefault(
            node.name,
            VaryingInertia(lambda: self._nodes[node.name], lambda: self._finished, lambda: self._given_acceleration(node.name)),
        )
        if not varying.most + most < 1.0:
            raise ParameterError(
                f"{asked_by} varies the inertia of {place!r} by up to {most:g} of it, with what else varies there {varying.most + most:g}: "
                "must be below 1 together, or there is none left at some angle."
            )
        return varying.add(share, most)

    def _given_acceleration(self, name: str) -> Callable[[Moment], Value] | None:
        """Acceleration [rad/s^2] of a place whose motion is given."""
        if name not in self._motions:
            return None
        twice = gradient(gradient(self._motions[name]))
        return lambda moment: twice(moment.time)

    def add_relative_torque(self, name: str, factors: dict[str, float], torque: Torque, *, dissipative: bool = False) -> None:
        """A torque(moment, x, dx/dt) that resists along  x = sum(f_i q_i), with its reactions; no twist channels."""
        self._elements.append(Connection(name, dict(factors), torque, (), dissipative))

    def motor_torque(self, place: str, asked_by: str = "This") -> Callable[[Moment], Value]:
        """The torque ``<place>.torque`` that a part puts on its body.

        Raises PlaceError when there is none (a motor with a prescribed motion has none).
        """
        torques = {element.name: element.torque for element in self._elements if isinstance(element, AppliedTorque)}
        if f"{place}.torque" in torques:
            return torques[f"{place}.torque"]
        known = [name.removesuffix(".torque") for name in torques if name.endswith(".torque")]
        raise PlaceError(f"{asked_by} needs a part with a torque law, but {place!r} has none. Such parts: {', '.join(known) or 'none'}.")

    def fed_in(self, place: str, asked_by: str = "This") -> Callable[[Moment], Value]:
        """Torque [N m] that shafts and gears carry away from a place, forward sense: what is fed into the line there, at a steady speed.

        With what effects change of them.  Raises PlaceError where no shaft or gear ends.
        """
        node = self.body(place, asked_by)
        ending = [item for item in self._connections.values() if node.name in item.factors]
        if not ending:
            known = [path for path, name in self._flanges.items() if any(name in item.factors for item in self._connections.values())]
            raise PlaceError(
                f"{asked_by} needs the torque that a shaft carries away from {place!r}, where none ends. "
                f"Places where one does: {', '.join(known) or 'none'}."
            )

        def read(moment: Moment) -> Value:
            return -sum(item.build().contribution(moment)[node.name] for item in ending)

        return read

    def change_motor(self, place: str, change: Change, asked_by: str = "This") -> Callable[[Moment], Value]:
        """Let ``change(torque)`` reach the rotor of a motor in place of its torque; returns it.

        The channel ``<place>.torque`` stays what the characteristic gives.  Raises PlaceError where no motor with a torque law is.
        """
        torques = {k: item for k, item in enumerate(self._elements) if isinstance(item, AppliedTorque) and item.is_motor}
        return self._change_torque(torques, place, change, asked_by, "motor")

    def change_load(self, place: str, change: Change, asked_by: str = "This") -> Callable[[Moment], Value]:
        """Let ``change(torque)`` reach the body of a load in place of its torque, both in the forward sense; returns it.

        The channel ``<place>.torque`` stays what the load law gives.  Raises PlaceError where no load is.
        """
        torques = {k: item for k, item in enumerate(self._elements) if isinstance(item, AppliedTorque) and item.is_load}
        return self._change_torque(torques, place, change, asked_by, "load")

    def _change_torque(
        self, torques: dict[int, AppliedTorque], place: str, change: Change, asked_by: str, what: str
    ) -> Callable[[Moment], Value]:
        self.body(place, asked_by)
        for k, element in torques.items():
            if element.name == f"{place}.torque":
                changed = replace(element, torque=change(element.torque))
                self._elements[k] = changed
                return changed.torque
        known = ", ".join(item.name.removesuffix(".torque") for item in torques.values())
        raise PlaceError(f"{asked_by} needs a {what} with a torque law, but {place!r} is none. {what.capitalize()}s: {known or 'none'}.")

    def add_state(self, name: str, *, unit: str, initial: float, rate: Callable[[Moment], Value]) -> str:
        """A first-order state dz/dt = rate(moment); returns its (unique) name."""
        return self._with_state(name, unit, initial, lambda unique: StateRate(unique, rate))

    def _with_state(self, name: str, unit: str, initial: float, equation: Callable[[str], StateRate]) -> str:
        unique, number = name, 2
        while unique in self._states:
            unique, number = f"{name}_{number}", number + 1
        self._states[unique] = State(unique, unit, initial)
        self._elements.append(equation(unique))
        self.add_channel(unique, unit, f"state {unique}", lambda moment: moment.state(unique))
        return unique

    def prescribe(self, coordinate: str, angle: Callable[[Value], Value]) -> None:
        """Make the forward angle of a coordinate a function of time.

        Raises LawError where the angle cannot be differentiated.
        """
        try:
            gradient(gradient(angle))
        except TraceError as error:
            raise LawError(f"The motion of {coordinate!r} must be written with numpy functions, to be differentiated: {error}.") from None
        self._motions[coordinate] = angle

    def holding_torque(self, node: Node) -> Callable[[Moment], Value]:
        """Torque [N m] that keeps a prescribed place on its motion:  J d2(angle)/dt2 - sum of the torques on it.

        Leaves out what the unbalance of a whirling rotor asks for, m e times its lateral acceleration.
        """

        def read(moment: Moment) -> Value:
            acceleration = gradient(gradient(self._motions[node.name]))(moment.time)
            total: Value = (node.inertia + node.mass.polar) * acceleration + 0.0 * moment.time
            for element in self._finished:
                total = total - element.contribution(moment).get(node.name, 0.0)
            return total

        return read

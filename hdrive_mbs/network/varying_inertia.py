"""Inertia of a place that varies with its angle, as a torque on a body of constant inertia."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from hdrive_mbs.expression import Value, gradient
from hdrive_mbs.network.elements import AppliedTorque, Element
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.node import Node

Share = Callable[[Value], Value]
"""True angle [rad] of the place -> by what share of its inertia there is more."""


@dataclass(eq=False)
class VaryingInertia:
    """Of one place: J (1 + r(a)), r the sum of shares, a = s q the true angle of the forward coordinate q.

    Lagrange's equation of J (1 + r) w^2/2 with the torque T of everything else is

        J (1 + r) dw/dt + s J r' w^2/2 = T

    which is J dw/dt = T + tau with

        tau = -J r dw/dt - s J r' w^2/2,  dw/dt = (T - s J r' w^2/2)/(J (1 + r))

    so no acceleration has to be known and the mass matrix stays as it is.  Each share has its own torque, by its own r and r' and
    the common dw/dt, and takes the power d(J r w^2/2)/dt.

    node : the place as it ends up, asked for when torques are read
    elements : all of the network, likewise
    acceleration : of a place whose motion is given [rad/s^2], of the moment, or None
    most : sum of the largest sizes of the shares
    """

    node: Callable[[], Node]
    elements: Callable[[], Sequence[Element]]
    acceleration: Callable[[], Callable[[Moment], Value] | None]
    most: float = 0.0
    _shares: list[tuple[Share, Callable[[Value], Value]]] = field(default_factory=list)
    _torques: list[Callable[[Moment], Value]] = field(default_factory=list)

    def add(self, share: Share, most: float) -> tuple[Callable[[Moment], Value], Callable[[Moment], Value]]:
        """One more share: its torque [N m], forward sense, and its energy J r w^2/2 [J]."""
        slope = gradient(share)

        def torque(moment: Moment) -> Value:
            node = self.node()
            angle, square = self._angle(moment), 0.5 * moment.speed(node.name) * moment.speed(node.name)
            return -node.inertia * (share(angle) * self._accelerated(moment) + node.sense * slope(angle) * square)

        def energy(moment: Moment) -> Value:
            node = self.node()
            return 0.5 * node.inertia * share(self._angle(moment)) * moment.speed(node.name) * moment.speed(node.name)

        self._shares.append((share, slope))
        self._torques.append(torque)
        self.most += most
        return torque, energy

    def _angle(self, moment: Moment) -> Value:
        node = self.node()
        return node.sense * moment.angle(node.name)

    def _accelerated(self, moment: Moment) -> Value:
        """dw/dt [rad/s^2]."""
        given = self.acceleration()
        if given is not None:
            return given(moment)
        node, angle = self.node(), self._angle(moment)
        onto: Value = 0.0
        for element in self.elements():
            # a torque on another place may be that of its own varying inertia, which would ask for this one
            if not (isinstance(element, AppliedTorque) and (element.coordinate != node.name or element.torque in self._torques)):
                onto = onto + element.contribution(moment).get(node.name, 0.0)
        shares = sum(share(angle) for share, _ in self._shares)
        slopes = sum(slope(angle) for _, slope in self._shares)
        square = 0.5 * moment.speed(node.name) * moment.speed(node.name)
        return (onto - node.sense * node.inertia * slopes * square) / (node.inertia * (1.0 + shares))

"""Ball bearing: Hertzian contacts, clearance, balls that travel with the cage."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from hdrive_mbs.bearings.hertz import STEEL_MODULUS, STEEL_POISSON, groove_stiffness, in_series
from hdrive_mbs.bearings.law import FloatArray, RelativeMotion
from hdrive_mbs.bearings.radial import RadialBearing
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class BallBearing(RadialBearing):
    """Radial ball bearing whose balls roll with the cage (varying compliance, ball-pass frequencies).

    F = sum_j Q_j (cos a_j, sin a_j),  Q_j = k max(delta_j, 0)^1.5 max(1 + b delta_j', 0),
    delta_j = x cos a_j + y sin a_j - clearance + preload,
    a_j = first ball + phi (1 - d/D)/2 + 2 pi j/Z

    A ball can push, never pull.  delta_j' is the rate from the motion of the ring, so that damping in
    the contacts takes energy from the vibration only.  Since the balls pass, the elastic forces depend
    on the spin angle: the moment dV/dphi of their energy V = sum 2/5 k delta_j^2.5 acts about the axis,
    and without it the bearing would make energy out of nothing.  ``damping`` is a linear film beside
    the contacts that acts in the clearance too.

    Source: Sunnersjo, J. Sound Vib. 58 (1978) 363 (varying compliance); Hunt, Crossley, J. Appl. Mech.
    42 (1975) 440 (contact damping).  Leaves out mass, slip and centrifugal force of the balls, the
    contact angle, and thereby the coupling of radial, axial and tilting motion; outer ring at rest.
    """

    balls: float = parameter("1", "number Z of balls", low=3.0, high=400.0)
    contact_stiffness: float = parameter("N/m^1.5", "k of a ball between both rings", above=0.0)
    ball_diameter: float = parameter("m", "ball diameter d", above=0.0)
    pitch_diameter: float = parameter("m", "pitch diameter D: circle of the ball centres", above=0.0)
    radial_clearance: float = parameter(
        "m",
        "gap at each ball with concentric rings, half the internal clearance; an interference is given as preload",
        default=0.0,
        low=0.0,
    )
    preload: float = parameter("m", "interference at each ball with the rings concentric", default=0.0, low=0.0)
    contact_damping: float = parameter("s/m", "damping factor b of a contact", default=0.0, low=0.0)
    damping: float = parameter("N s/m", "linear radial damping between the rings", default=0.0, low=0.0)
    first_ball: float = parameter("rad", "place of ball 0 at spin angle zero, from x towards y", default=0.0)

    def check(self) -> None:
        if self.balls % 1.0:
            raise ParameterError(f"BallBearing.balls = {self.balls:g}: must be a whole number.")
        if self.ball_diameter >= self.pitch_diameter or self.balls * math.asin(self.ball_diameter / self.pitch_diameter) > math.pi:
            raise ParameterError(
                f"BallBearing: {self.balls:g} balls with ball_diameter = {self.ball_diameter:g} m overlap on "
                f"pitch_diameter = {self.pitch_diameter:g} m. Correct the diameters or the number."
            )
        if self.radial_clearance > 0.0 and self.preload > 0.0:
            raise ParameterError(
                f"BallBearing has radial_clearance = {self.radial_clearance:g} m and preload = {self.preload:g} m; give one of them."
            )

    @classmethod
    def from_geometry(
        cls,
        *,
        ball_diameter: float,
        pitch_diameter: float,
        inner_conformity: float,
        outer_conformity: float,
        elastic_modulus: float = STEEL_MODULUS,
        poisson_ratio: float = STEEL_POISSON,
        **fields: Any,
    ) -> Self:
        """A deep-groove bearing with Hertz's stiffness of both contacts in series.

        inner_conformity, outer_conformity : groove radius over ball diameter, above 0.5 (catalogue
        bearings 0.515 to 0.53); elastic_modulus [Pa] and poisson_ratio of balls and rings; fields : the others
        """
        for name, value in (("inner_conformity", inner_conformity), ("outer_conformity", outer_conformity)):
            if not 0.5 < value < math.inf:
                raise ParameterError(f"BallBearing.from_geometry: {name} = {value:g}: must be above 0.5, a groove wider than the ball.")
        if not 0.0 < ball_diameter < pitch_diameter:
            raise ParameterError(
                f"BallBearing.from_geometry: ball_diameter = {ball_diameter:g} m must be above 0 m and below "
                f"pitch_diameter = {pitch_diameter:g} m."
            )
        inner, outer = (
            groove_stiffness(ball_diameter, pitch_diameter, conformity, is_inner, elastic_modulus, poisson_ratio)
            for conformity, is_inner in ((inner_conformity, True), (outer_conformity, False))
        )
        return cls(ball_diameter=ball_diameter, pitch_diameter=pitch_diameter, contact_stiffness=in_series(inner, outer), **fields)

    @property
    def cage_ratio(self) -> float:
        """Cage speed over spin speed, rolling without slip: (1 - d/D)/2."""
        return 0.5 * (1.0 - self.ball_diameter / self.pitch_diameter)

    def cage_frequency(self, speed: Value) -> Value:
        """Angular speed of the cage [rad/s] at a spin speed [rad/s]."""
        return self.cage_ratio * speed

    def ball_pass_outer(self, speed: Value) -> Value:
        """Angular frequency [rad/s] at which balls pass a place of the outer ring."""
        return self.balls * self.cage_ratio * speed

    def ball_pass_inner(self, speed: Value) -> Value:
        """Angular frequency [rad/s] at which balls pass a place of the inner ring."""
        return self.balls * (1.0 - self.cage_ratio) * speed

    def damping_matrix(self) -> FloatArray:
        return np.asarray(super().damping_matrix() + np.diag([self.damping, self.damping, 0.0, 0.0, 0.0, 0.0]))

    def approaches(self, motion: RelativeMotion) -> list[tuple[Value, Value, Value]]:
        """(delta [m], cos a, sin a) of each ball; negative delta is a gap."""
        result = []
        for number in range(int(self.balls)):
            place = self.cage_ratio * motion.angle + (self.first_ball + 2.0 * math.pi * number / self.balls)
            cosine, sine = np.cos(place), np.sin(place)
            result.append((motion.x * cosine + motion.y * sine + (self.preload - self.radial_clearance), cosine, sine))
        return result

    def elastic_energy(self, motion: RelativeMotion) -> Value:
        """V [J] of all contacts."""
        return sum(0.4 * self.contact_stiffness * np.maximum(delta, 0.0) ** 2.5 for delta, _, _ in self.approaches(motion))

    def ball_forces(self, motion: RelativeMotion) -> list[Value]:
        """Push Q [N] of each ball."""
        return [push for _, push, _, _ in self._contacts(motion)]

    def _contacts(self, motion: RelativeMotion) -> list[tuple[Value, Value, Value, Value]]:
        """(elastic push, whole push, cos a, sin a) of each ball."""
        result = []
        for delta, cosine, sine in self.approaches(motion):
            elastic = self.contact_stiffness * np.maximum(delta, 0.0) ** 1.5
            whole = elastic
            if self.contact_damping:
                whole = elastic * np.maximum(1.0 + self.contact_damping * (motion.vx * cosine + motion.vy * sine), 0.0)
            result.append((elastic, whole, cosine, sine))
        return result

    def forces(self, motion: RelativeMotion) -> Mapping[str, Value]:
        contacts = self._contacts(motion)
        return {
            "x": sum(push * cosine for _, push, cosine, _ in contacts),
            "y": sum(push * sine for _, push, _, sine in contacts),
            "phi": self.cage_ratio * sum(push * (motion.y * cosine - motion.x * sine) for push, _, cosine, sine in contacts),
        }

"""Friction of a harmonic drive that grows with the torque through the mesh and builds up over an angle."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.effects.fast_sliding import FASTEST_RATE, followed_share, mixed
from hdrive_mbs.expression import Value
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.quantities import parameter

LEAST = 1e-7
"""Sliding torque [N m] that is left where the mesh carries none: the build-up divides by it."""


@dataclass(frozen=True, kw_only=True)
class MeshPreslidingFriction(Effect):
    """Load-dependent friction between wave generator and circular spline, with bristles that give way.

    tau = -y,  dy/dt = k v (1 - y sign(v)/L),  v = w_wg - w_cs,
    L = (T_0 + mu A(T)/u)(1 + d exp(-|v|/w_S)),  A(T) = sqrt(T^2 + T_r^2) - T_r

    on the wave generator, with the reaction on the circular spline; T is the torque through the mesh, A the part of it
    that rubs: |T| - T_r under load, little below T_r, where few teeth are in contact.  Friction is larger by 1 + d at low speed.
    Sliding steadily the torque is L sign(v), as of MeshFriction where T_r = d = 0.  With the stored energy y^2/(2 k) the
    heat is |v| y^2/L, never negative whatever the load does.  Building up faster than at the rate f is as in fast_sliding.py.

    Source: load-dependent gear friction as in MeshFriction, with bristles after Dahl, AIAA Journal 14 (1976) 1675; A and
    the fall with speed are our own, as simple as can be.  Leaves out temperature and the split between teeth and ball bearing.
    """

    loss_factor: float = parameter(
        "1", "mu, friction torque over ideal torque of the wave generator", low=0.0, high=2.0, typical=(0.01, 0.6)
    )
    no_load: float = parameter("N m", "T_0, friction torque on the wave generator without load", default=0.0, low=0.0, high=1e2)
    rounding_torque: float = parameter("N m", "T_r, torque above which the mesh rubs", default=0.0, low=0.0, high=1e3, typical=(0.05, 20.0))
    drop: float = parameter("1", "d, share by which friction is larger at low speed", default=0.0, low=0.0, high=10.0, typical=(0.02, 2.0))
    drop_speed: float = parameter("rad/s", "w_S, speed at which that has fallen to 1/e", default=10.0, above=0.0, typical=(1.0, 100.0))
    stiffness: float = parameter("N m/rad", "k of the bristles on the wave generator", default=100.0, above=0.0, typical=(1.0, 3e3))
    fastest_rate: float = parameter("1/s", "f, rate up to which the state is followed", default=FASTEST_RATE, above=0.0)

    acts_on: ClassVar[str] = "gear"
    family: ClassVar[str] = "mesh_friction"
    signature: ClassVar[str] = "motor torque grows with the size of the load in both senses of power; it turns over within an angle"

    def sliding_torque(self, torque: Value, speed: Value, share: float) -> Value:
        """L [N m] on the wave generator at a torque through the mesh; share is 1/u."""
        size = np.abs(torque)
        if self.rounding_torque > 0.0:
            size = np.sqrt(size * size + self.rounding_torque**2) - self.rounding_torque
        return LEAST + (self.no_load + self.loss_factor * share * size) * (1.0 + self.drop * np.exp(-np.abs(speed) / self.drop_speed))

    def apply(self, draft: Draft, place: str, name: str) -> None:
        kind = type(self).__name__
        gear = draft.connection(place, kind, flanges=("wave_generator", "circular_spline"))
        if self.loss_factor == 0.0 and self.no_load == 0.0:
            return
        wave, ring = (draft.body(gear.bodies[flange]) for flange in ("wave_generator", "circular_spline"))
        share = abs(gear.factors[wave.name])  # 1/u
        relative = {wave.name: 1.0, ring.name: -float(wave.sense * ring.sense)}

        def sliding(moment: Moment) -> tuple[Value, Value, Value]:
            """Speed v, L, and the share of the build-up that is followed."""
            speed = sum(factor * moment.speed(body) for body, factor in relative.items())
            limit = self.sliding_torque(gear.build().value(moment), speed, share)
            return speed, limit, followed_share(self.stiffness * np.abs(speed) / limit, self.fastest_rate)

        def rate(moment: Moment) -> Value:
            speed, limit, followed = sliding(moment)
            return followed * self.stiffness * (speed - np.abs(speed) * moment.state(state) / limit)

        def friction(moment: Moment, angle: Value, relative_speed: Value) -> Value:
            speed, limit, followed = sliding(moment)
            return mixed(followed, moment.state(state), limit, speed)

        def on_wave(moment: Moment) -> Value:
            return -friction(moment, 0.0, 0.0)

        def on_ring(moment: Moment) -> Value:
            return -wave.sense * on_wave(moment)

        state = draft.add_state(f"{name}.bristle_torque", unit="N m", initial=0.0, rate=rate)
        draft.add_relative_torque(name, relative, friction)
        draft.add_channel(f"{name}.torque", "N m", f"torque of {name} on the wave generator, positive when driving", on_wave)
        draft.add_channel(f"{name}.housing_torque", "N m", f"torque of {name} on the circular spline, true sense", on_ring)

"""Friction of a harmonic drive that grows with the torque through the mesh."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.expression import Value
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class MeshFriction(Effect):
    """Load-dependent friction between wave generator and circular spline of a gear.

    tau = -(T_0 + mu |T|/u) tanh(v / w_0),  v = w_wg - w_cs

    on the wave generator, with the reaction on the circular spline (channel ``housing_torque``);
    T is the torque through the mesh and T/u its ideal reaction on the wave generator, with u from
    the gear itself.  Teeth and wave-generator balls slide and roll as the wave runs round the
    circular spline, so v is the speed of the wave, not of the slow output.  The heat is
    (T_0 + mu |T|/u) |v|: with T_0 = 0 and a held circular spline the efficiency is 1/(1 + mu) when
    driving and 1 - mu when driven back (mu >= 1 locks).  mu is a loss factor of the whole gear, not
    a coefficient of tooth friction.

    Source: load-dependent gear friction as in Tuttle, Seering, IEEE Trans. Robotics and Automation
    12 (1996) 368 and Taghirad, Belanger, ASME J. Dyn. Syst. Meas. Control 120 (1998) 439, sign(v)
    regularised by tanh.  Leaves out sticking (it creeps below w_0), the split between teeth and ball
    bearing (which rolls on the flexspline: v larger by 1/u), lubricant and temperature.
    """

    loss_factor: float = parameter(
        "1", "mu, friction torque over ideal torque of the wave generator", low=0.0, high=2.0, typical=(0.01, 0.6)
    )
    no_load: float = parameter("N m", "T_0, friction torque on the wave generator without load", default=0.0, low=0.0, high=1e2)
    smoothing_speed: float = parameter("rad/s", "speed w_0 of the smooth step through zero", default=0.5, above=0.0, typical=(0.05, 5.0))

    acts_on: ClassVar[str] = "gear"
    family: ClassVar[str] = "mesh_friction"
    dissipative: ClassVar[bool] = True
    signature: ClassVar[str] = "motor torque grows with the size of the load in both senses of power; efficiency below 1 at every speed"

    def apply(self, draft: Draft, place: str, name: str) -> None:
        gear = draft.connection(place, "MeshFriction", flanges=("wave_generator", "circular_spline"))
        wave, ring = (draft.body(gear.bodies[flange]) for flange in ("wave_generator", "circular_spline"))
        share = abs(gear.factors[wave.name])  # 1/u
        relative = {wave.name: 1.0, ring.name: -float(wave.sense * ring.sense)}

        def friction(moment: Moment, angle: Value, speed: Value) -> Value:
            size = self.no_load
            if self.loss_factor > 0.0:
                size = size + self.loss_factor * share * np.abs(gear.build().value(moment))
            return size * np.tanh(speed / self.smoothing_speed)

        def on_wave(moment: Moment) -> Value:
            return -friction(moment, 0.0, sum(factor * moment.speed(body) for body, factor in relative.items()))

        def on_ring(moment: Moment) -> Value:
            return -wave.sense * on_wave(moment)

        draft.add_relative_torque(name, relative, friction, dissipative=self.dissipative)
        draft.add_channel(f"{name}.torque", "N m", f"torque of {name} on the wave generator, positive when driving", on_wave)
        draft.add_channel(f"{name}.housing_torque", "N m", f"torque of {name} on the circular spline, true sense", on_ring)

"""A working machine: inertia and load torque."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from hdrive_mbs.components.component import Component, Flange
from hdrive_mbs.components.inertia import add_viscous
from hdrive_mbs.expression import Value
from hdrive_mbs.loads.constant import ConstantTorque
from hdrive_mbs.loads.law import LoadFunction, LoadLaw
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.quantities import option, parameter


@dataclass(frozen=True, kw_only=True)
class Load(Component):
    """The working machine:  J_MR dw/dt = torque of the shaft - viscous * w - M_MR.

    The inertia is the one on the axis where the load sits: seed F says J_MR is reduced to the
    wave generator's axis, but (4) uses it on the output axis.
    """

    inertia: float = parameter("kg m^2", "inertia J_MR on its own axis", above=0.0)
    torque: LoadLaw | Callable[..., Value] = option(
        "load law, or a function of (time) or (time, angle, speed); positive resists; none if not given",
        default=ConstantTorque(value=0.0),
        called_with=(("time",), ("time", "angle", "speed")),
    )
    viscous: float = parameter("N m s/rad", "viscous drag on the absolute speed", default=0.0, low=0.0)

    def check(self) -> None:
        if not isinstance(self.torque, LoadLaw):
            object.__setattr__(self, "torque", LoadFunction(function=self.torque))

    def flanges(self) -> tuple[Flange, ...]:
        return (Flange(name="", inertia=self.inertia),)

    def build(self, name: str, draft: Draft) -> None:
        law, body = self.torque, draft.body(name).name
        assert isinstance(law, LoadLaw)

        def resisting(moment: Moment) -> Value:
            return law.torque(moment.time, moment.angle(body), moment.speed(body))

        draft.add_torque(f"{name}.torque", body, lambda moment: -resisting(moment), is_load=True)
        draft.add_channel(f"{name}.torque", "N m", f"load torque of {name}, positive when resisting", resisting)
        add_viscous(name, self.viscous, draft)

"""PI speed control with a torque limit: the law that the servo motor and the controller share."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from hdrive_mbs.errors import SceneError
from hdrive_mbs.expression import Value
from hdrive_mbs.motors.profiles.profile import SpeedFunction, SpeedProfile
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.quantities import Described, option, parameter


@dataclass(frozen=True, kw_only=True)
class SpeedLoop(Described):
    """u = kp e + ki I,   e = w_ref(t) - w,   dI/dt = e,   torque command = u within +-limit.

    Anti-windup by conditional integration: dI/dt = 0 while |u| >= limit and e pushes u further out.
    (Without the last condition a loop with kp = 0 could never leave its limit.)  A weakly damped
    loop, ki J > kp^2, slides along its limit while it comes back from it, and an adaptive solver
    then takes small steps.

    Source: Astrom and Hagglund, PID Controllers, 1995, section 3.5.  Leaves out sampling, filters
    and the quantisation of the encoder.
    """

    proportional_gain: float = parameter("N m s/rad", "kp, torque per speed error", low=0.0)
    integral_gain: float = parameter("N m/rad", "ki, torque per integral of the speed error", low=0.0)
    reference: SpeedProfile | Callable[[Value], Value] = option(
        "wanted speed [rad/s]: a profile or a function of time [s]", called_with=(("time",),)
    )

    def check(self) -> None:
        if not isinstance(self.reference, SpeedProfile):
            object.__setattr__(self, "reference", SpeedFunction(function=self.reference))

    def error(self, time: Value, speed: Value) -> Value:
        """Speed error e [rad/s]."""
        assert isinstance(self.reference, SpeedProfile)
        return self.reference.speed(time) - speed

    def command(self, error: Value, integral: Value) -> Value:
        """Torque command u before the limit [N m]."""
        return self.proportional_gain * error + self.integral_gain * integral

    def integral_rate(self, error: Value, integral: Value, limit: Value) -> Value:
        """dI/dt [rad/s]."""
        wanted = self.command(error, integral)
        held = (np.abs(wanted) >= limit) & (wanted * error > 0.0)
        return np.where(held, 0.0, error)

    def add_loop(
        self, name: str, motor: str, draft: Draft, *, speed: Callable[[Moment], Value], limit: Callable[[Moment], Value]
    ) -> Callable[[Moment], Value]:
        """The state ``<name>.integral`` and the channel ``<motor>.command``; returns the command u(moment)."""
        if draft.has_channel(f"{motor}.command"):
            raise SceneError(f"{motor!r} has two speed controllers, the second is {name!r}; remove one.")

        def error(moment: Moment) -> Value:
            return self.error(moment.time, speed(moment))

        state = draft.add_state(
            f"{name}.integral",
            unit="rad",
            initial=0.0,
            rate=lambda moment: self.integral_rate(error(moment), moment.state(state), limit(moment)),
        )

        def command(moment: Moment) -> Value:
            return self.command(error(moment), moment.state(state))

        draft.add_channel(f"{motor}.command", "N m", f"torque command to {motor} before its limit", command)
        draft.add_channel(f"{name}.error", "rad/s", f"speed error of {name}, forward sense", error)
        return command

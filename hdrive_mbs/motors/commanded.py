"""Torque-controlled motor that follows a command."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from hdrive_mbs.expression import Value
from hdrive_mbs.motors.characteristic import MotorCharacteristic
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.node import Node
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class CommandedMotor(MotorCharacteristic):
    """M = command within +-torque_limit, or with a current loop  lag dM/dt + M = limited command.

    The command comes from a SpeedController part that names this motor.  Leaves out the limit of
    voltage (torque falling at high speed) and the ripple of the motor.
    """

    torque_limit: float = parameter("N m", "largest torque, both senses", above=0.0)
    current_lag: float = parameter("s", "time constant of the current loop; 0 for none", default=0.0, low=0.0)

    def drive(self, name: str, node: Node, draft: Draft) -> None:
        command = draft.read_channel(
            f"{name}.command", asked_by=f"CommandedMotor of {name!r}", hint=f"Add a part SpeedController(motor={name!r}, ...)."
        )
        self.deliver(name, node, draft, command)

    def deliver(self, name: str, node: Node, draft: Draft, command: Callable[[Moment], Value]) -> None:
        """Put the limited command on the rotor."""
        limit, lag = self.torque_limit, self.current_lag

        def limited(moment: Moment) -> Value:
            return np.clip(command(moment), -limit, limit)

        torque: Callable[[Moment], Value] = limited
        if lag > 0.0:
            state = draft.add_state(
                f"{name}.lagged_torque", unit="N m", initial=0.0, rate=lambda moment: (limited(moment) - moment.state(state)) / lag
            )
            torque = _state_reader(state)
        draft.add_torque(f"{name}.torque", node.name, torque, is_motor=True)
        draft.add_channel(f"{name}.torque", "N m", f"air-gap torque of {name}", torque)
        draft.add_channel(f"{name}.torque_limit", "N m", f"torque limit of {name}", lambda moment: limit + 0.0 * moment.time)


def _state_reader(state: str) -> Callable[[Moment], Value]:
    return lambda moment: moment.state(state)

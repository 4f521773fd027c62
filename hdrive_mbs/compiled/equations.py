"""The rates of a network as expressions: what machine code is made from."""

from __future__ import annotations

from collections.abc import Mapping

from hdrive_mbs.compiled.rotor_equations import coupled_accelerations
from hdrive_mbs.expression import Value
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.network import Network


def accelerations(network: Network, moment: Moment) -> Mapping[str, Value]:
    """Forward acceleration of each coordinate [rad/s^2, m/s^2] and the rate of each state, at a moment of expressions.

    Raises ParameterError for rotors of which rotor_equations makes no explicit equations.
    """
    return coupled_accelerations(network, moment) if network.is_coupled else network.accelerations(moment)

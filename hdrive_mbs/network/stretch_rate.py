"""A first-order state that follows sums of coordinates."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from hdrive_mbs.expression import Value
from hdrive_mbs.network.elements import StateRate
from hdrive_mbs.network.moment import Moment

RateOver = Callable[[Moment, Mapping[str, Value], Mapping[str, Value]], Value]


@dataclass(frozen=True)
class StretchRate(StateRate):
    """dz/dt = law(moment, stretches s, their rates) with s_k = sum(f_ki q_i).

    of : the coupling whose stretches they are: an engine that makes coordinates of them makes them once
    """

    of: str
    stretches: Mapping[str, Mapping[str, float]]
    law: RateOver

    def over(self, stretches: Mapping[str, Mapping[str, float]]) -> StretchRate:
        """The same with stretches of other coordinates."""
        return stretch_rate(self.state, self.of, stretches, self.law)


def stretch_rate(state: str, of: str, stretches: Mapping[str, Mapping[str, float]], law: RateOver) -> StretchRate:
    """The equation of a state over stretches."""

    def along(values: Mapping[str, Value]) -> dict[str, Value]:
        return {key: sum(factor * values[name] for name, factor in factors.items()) for key, factors in stretches.items()}

    return StretchRate(state, lambda moment: law(moment, along(moment.angles), along(moment.speeds)), of, stretches, law)

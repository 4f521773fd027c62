"""A force law over several stretches at once: a bearing whose x force depends on y, on spin and on tilt."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from hdrive_mbs.expression import Value
from hdrive_mbs.network.elements import Claim
from hdrive_mbs.network.moment import Moment

Forces = Callable[[Moment, Mapping[str, Value], Mapping[str, Value]], Mapping[str, Value]]


@dataclass(frozen=True)
class Coupling:
    """Forces F_k along stretches s_k = sum(f_ki q_i), each of which may depend on all stretches and rates.

    ``forces(moment, stretches, rates)`` gives direction -> force, positive when it resists a positive
    stretch; by virtual work coordinate i feels -sum(F_k f_ki).
    """

    name: str
    stretches: Mapping[str, Mapping[str, float]]
    forces: Forces
    dissipative: bool = False
    stored: Callable[[Moment], Value] | None = None
    """Energy [J] held in states: what a dissipative law may still give back."""

    def claims(self) -> tuple[Claim, ...]:
        """What the element promises."""
        return (Claim(self.name, self.power, self.stored),) if self.dissipative else ()

    def along(self, values: Mapping[str, Value]) -> dict[str, Value]:
        """Stretches of coordinates, or their rates of speeds."""
        return {key: sum(factor * values[name] for name, factor in factors.items()) for key, factors in self.stretches.items()}

    def values(self, moment: Moment) -> Mapping[str, Value]:
        """Force of each direction [N, N m]."""
        return self.forces(moment, self.along(moment.angles), self.along(moment.speeds))

    def contribution(self, moment: Moment) -> dict[str, Value]:
        result: dict[str, Value] = {}
        for key, force in self.values(moment).items():
            for name, factor in self.stretches[key].items():
                result[name] = result.get(name, 0.0) - factor * force
        return result

    def power(self, moment: Moment) -> Value:
        """Power that the element takes from the coordinates [W]."""
        rates = self.along(moment.speeds)
        return sum(force * rates[key] for key, force in self.values(moment).items())


@dataclass(frozen=True)
class Gyroscope:
    """Gyroscopic moments of a spinning station with small tilts.

    M_psi = -Jp phi' theta',  M_theta = +Jp phi' psi'.  Source: seed M (8); its third line, a torque
    Jp psi' theta' on the spin, would break the balance of energy and is left out.
    """

    name: str
    psi: str
    theta: str
    spin: str
    polar: float
    """Polar moment of inertia times the sense of the spin coordinate [kg m^2]."""

    def claims(self) -> tuple[Claim, ...]:
        """It does no work: nothing to promise."""
        return ()

    def contribution(self, moment: Moment) -> dict[str, Value]:
        momentum = self.polar * moment.speed(self.spin)
        return {self.psi: -momentum * moment.speed(self.theta), self.theta: momentum * moment.speed(self.psi)}

    def power(self, moment: Moment) -> Value:
        """Zero."""
        return 0.0 * moment.speed(self.spin)

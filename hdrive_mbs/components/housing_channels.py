"""What is shown of a housing: the displacement across its bearing, as a probe on the housing sees it, and the force on its foundation."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from hdrive_mbs.components.housing import Housing
from hdrive_mbs.expression import Value
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment

Factors = Mapping[str, float]


def add_across(name: str, draft: Draft, stretches: Mapping[str, Factors], offset: Callable[[int], float] = lambda row: 0.0) -> None:
    """``<bearing>.across_x`` and ``across_y``: the ring less the housing [m], where they are no coordinates already.

    offset : what the channels add in x (0) and in y (1) [m]
    """
    for row, key in enumerate("xy"):
        draft.add_displacement(
            f"{name}.across_{key}",
            stretches[key],
            "m",
            f"displacement across {name} in {key}",
            lambda row=row: offset(row),  # type: ignore[misc]
        )


def add_foundation_force(name: str, draft: Draft, housing: Housing, displacement: Mapping[str, Factors]) -> None:
    """``<bearing>.foundation_force_x`` and ``_y``: k x + k_n x^n + b x' of the housing [N], what effects add to it not counted.

    displacement : of the housing against the ground, as factors of coordinates
    """
    for key in "xy":
        factors = displacement[key]

        def read(moment: Moment, key: str = key, factors: Factors = factors) -> Value:
            x = sum(factor * moment.angle(c) for c, factor in factors.items())
            v = sum(factor * moment.speed(c) for c, factor in factors.items())
            return housing.force(key, x, v)

        draft.add_channel(f"{name}.foundation_force_{key}", "N", f"force of the housing of {name} on its foundation in {key}", read)

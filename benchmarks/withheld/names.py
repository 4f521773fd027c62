"""From the words of our library to the names of the answer format, and back to places."""

from __future__ import annotations

import importlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TypeVar

Claim = TypeVar("Claim")
Label = tuple[str, str]
"""(family, place in our scene), or ("parameter", group of the bench)."""
Name = tuple[str, str]
"""(effect, at) of the answer format."""

SENSORS = frozenset({"encoder_eccentricity", "load_encoder_delay", "torque_sensor_gain", "probe_runout", "probe_gain"})
"""Names whose verdict is "sensor"."""
PARAMETER = "parameter_"
"""Begins the names whose verdict is "parameter"."""


@dataclass(frozen=True, kw_only=True)
class Names:
    """The names of a bench.

    causes : label -> name; what is missing here has no name and is answered "unknown"
    places : place or parameter group of our bench -> place of the answer format; a place that is missing keeps its name
    both : two places -> the place that stands for one cause at both of them
    elsewhere : label without a name -> its place, where that is another than the place in our bench says
    """

    causes: Mapping[Label, Name]
    places: Mapping[str, str]
    elsewhere: Mapping[Label, str] = field(default_factory=dict)
    both: Mapping[frozenset[str], str] = field(default_factory=dict)

    def name(self, label: Label) -> Name | None:
        """The name of a cause, None where it has none."""
        return self.causes.get(label)

    def place(self, at: str) -> str:
        """The place of something at one of our places."""
        return self.places.get(at, at)

    def place_of(self, label: Label) -> str:
        """The place of a cause, with a name or without."""
        named = self.name(label)
        return self.elsewhere.get(label, self.place(label[1])) if named is None else named[1]

    def joined(self, claimed: Sequence[tuple[Name, Claim]]) -> list[tuple[Name, Claim]]:
        """What is claimed, the same cause at two places that have a name together as one, with the first one's values."""
        if len(claimed) == 2 and claimed[0][0][0] == claimed[1][0][0]:
            together = self.both.get(frozenset(name[1] for name, _ in claimed))
            if together is not None:
                return [((claimed[0][0][0], together), claimed[0][1])]
        return list(claimed)

    def labels(self, name: Name) -> tuple[Label, ...]:
        """All labels that are answered with a name."""
        return tuple(label for label, other in self.causes.items() if other == name)


def verdict_of(effect: str) -> str:
    """The verdict that a name stands for."""
    if effect.startswith(PARAMETER):
        return "parameter"
    return "sensor" if effect in SENSORS else effect if effect in ("none", "unknown") else "effect"


def names_of(bench: str) -> Names:
    """The names of a bench, "drive" or "rotor"."""
    module = importlib.import_module(f"benchmarks.withheld.{bench}_names")
    names: Names = module.NAMES
    return names

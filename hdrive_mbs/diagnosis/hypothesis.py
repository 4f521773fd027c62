"""What is tried: the nominal scene with effects at places, and which parameters are let loose."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import numpy.typing as npt

from hdrive_mbs.diagnosis.unknowns import Factor, Shape, Signed, Strength, Unknown, Vector
from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.quantity import Quantity
from hdrive_mbs.scene import PlacedEffect, Scene

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Added:
    """An effect at a place, with the values from which its search starts.

    effect : with start values in all its fields;  at : place;  name : in the scene
    """

    effect: Effect
    at: str
    name: str

    @property
    def label(self) -> tuple[str, str]:
        """(family, place)."""
        return type(self.effect).family, self.at

    @cached_property
    def unknowns(self) -> tuple[Unknown, ...]:
        """What of it is searched, in the order of its fields."""
        return unknowns_of(self.effect, self.name)

    @cached_property
    def choices(self) -> int:
        """Ways to choose what a search tries but does not vary: orders, sides."""
        kind = type(self.effect)
        return math.prod(len(values) for name, values in kind.starts.items() if name not in searched_fields(kind))


PERIOD = 1e-6
"""Difference of the search coordinate of a period, for derivatives: that of other shapes, 0.01, moves an order by 0.3 %, which over
thousands of radians is whole turns of its phase."""


def searched_fields(kind: type[Effect]) -> dict[str, Quantity]:
    """The fields of an effect that a search varies: those with a typical range."""
    quantities = {item.name: item.metadata.get("quantity") for item in dataclasses.fields(kind)}
    return {name: item for name, item in quantities.items() if item is not None and item.typical is not None}


def unknowns_of(effect: Effect, name: str) -> tuple[Unknown, ...]:
    """The unknowns of an effect's fields with typical ranges."""
    kind = type(effect)
    phases = {phase: amplitude for amplitude, phase in kind.vectors}
    found: list[Unknown] = []
    for key, item in searched_fields(kind).items():
        assert item.typical is not None
        low, high = item.typical
        path = f"{name}.{key}"
        value = float(getattr(effect, key))
        if key in phases:
            continue
        if key in dict(kind.vectors):
            found.append(Vector(path, f"{name}.{dict(kind.vectors)[key]}", low, high, value or low))
        elif low <= 0.0:
            found.append(Signed(path, high, -np.inf if item.low is None else item.low, np.inf if item.high is None else item.high))
        elif item.low == 0.0:
            found.append(Strength(path, low, high, value or low, np.inf if item.high is None else item.high))
        else:
            bottom, top = item.low if item.low is not None else 0.0, np.inf if item.high is None else item.high
            found.append(Shape(path, low, high, bottom, top, PERIOD if key in kind.periodic else Shape.difference))
    return tuple(found)


def start_of(unknown: Unknown, effect: Effect, name: str) -> tuple[float, ...]:
    """Search coordinates of the values that an effect has."""
    field_name = unknown.path.removeprefix(f"{name}.")
    value = float(getattr(effect, field_name))
    match unknown:
        case Vector(scale=scale, phase_path=phase_path):
            phase = float(getattr(effect, phase_path.removeprefix(f"{name}.")))
            return (value / scale * float(np.cos(phase)), value / scale * float(np.sin(phase)))
        case Strength(scale=scale):
            return (value / scale,)
        case Signed(half_width=width):
            return (2.0 * value / width,)
        case Shape():
            return (unknown.coordinate(value),)
    raise TypeError(unknown)


@dataclass(frozen=True, eq=False)
class Hypothesis:
    """Nominal parameters with their uncertainty, and effects that are added.

    factors : nominal parameters;  added : effects, none for the nominal model
    loose : names of parameters with a prior that is wider, by this factor
    """

    factors: tuple[Factor, ...]
    added: tuple[Added, ...] = ()
    loose: Mapping[str, float] = field(default_factory=dict)

    @cached_property
    def unknowns(self) -> tuple[Unknown, ...]:
        """All unknowns: factors first."""
        factors = [dataclasses.replace(item, wide=self.loose.get(item.name, 1.0)) for item in self.factors]
        return (*factors, *(unknown for item in self.added for unknown in item.unknowns))

    @cached_property
    def slices(self) -> tuple[slice, ...]:
        """Where each unknown sits among the search coordinates."""
        ends = np.cumsum([unknown.size for unknown in self.unknowns])
        return tuple(slice(int(end) - unknown.size, int(end)) for unknown, end in zip(self.unknowns, ends, strict=True))

    @property
    def size(self) -> int:
        """Number of search coordinates."""
        return self.slices[-1].stop if self.slices else 0

    @property
    def nominal_size(self) -> int:
        """Number of those of nominal parameters, which come first."""
        return len(self.factors)

    @property
    def label(self) -> str:
        """In words, for logs and reports."""
        parts = [f"{type(item.effect).__name__} at {item.at}" for item in self.added] + [f"{name} off" for name in self.loose]
        return " + ".join(parts) or "nominal"

    @property
    def is_nominal(self) -> bool:
        """Whether there is no cause in it."""
        return not (self.added or self.loose)

    @property
    def labels(self) -> frozenset[tuple[str, str]]:
        """(family, place) of the effects."""
        return frozenset(item.label for item in self.added)

    def start(self, nominal: FloatArray | None = None) -> FloatArray:
        """Coordinates of the start values; the nominal ones as given (in prior standard deviations of the nominal model)."""
        z = np.zeros(self.size)
        if nominal is not None:
            z[: len(self.factors)] = nominal[: len(self.factors)]
            for k, item in enumerate(self.factors):
                z[k] /= self.loose.get(item.name, 1.0)
        at = len(self.factors)
        for added in self.added:
            for unknown in added.unknowns:
                z[at : at + unknown.size] = start_of(unknown, added.effect, added.name)
                at += unknown.size
        return z

    def nominal_part(self, z: FloatArray) -> FloatArray:
        """Nominal coordinates in standard deviations of the nominal prior."""
        return np.array([z[k] * self.loose.get(item.name, 1.0) for k, item in enumerate(self.factors)])

    def values(self, z: FloatArray, *, to_run: bool = False) -> dict[str, float]:
        """Values by path;  to_run : next to nothing in place of zeros."""
        found: dict[str, float] = {}
        for unknown, part in zip(self.unknowns, self.slices, strict=True):
            own = z[part].tolist()
            found |= unknown.run_values(own) if to_run else unknown.values(own)
        return found

    def clipped(self, z: FloatArray) -> FloatArray:
        """The nearest allowed coordinates."""
        result = z.copy()
        for unknown, part in zip(self.unknowns, self.slices, strict=True):
            result[part] = unknown.clipped(z[part].tolist())
        return result

    def scene(self, scene: Scene, z: FloatArray, *, to_run: bool = False) -> Scene:
        """The scene with these parameters and effects.

        to_run : with next to nothing in place of zeros, so that other points have the same equations

        Raises ParameterError where values do not go together.
        """
        return self.with_values(scene, self.values(z, to_run=to_run))

    def with_values(self, scene: Scene, values: Mapping[str, float]) -> Scene:
        """The scene with the effects, and with these numbers by path.  Raises ParameterError where they do not go together."""
        values, placed = dict(values), []
        for item in self.added:
            prefix = f"{item.name}."
            own = {path.removeprefix(prefix): values.pop(path) for path in list(values) if path.startswith(prefix)}
            placed.append(PlacedEffect(name=item.name, effect=item.effect.replacing(**own), at=item.at))
        return scene.changed(values, placed)

    def log_prior(self, z: FloatArray) -> float:
        """Logarithm of the prior density; of choices that an effect begins with, like an order, each is as likely."""
        choices = sum(math.log(item.choices) for item in self.added)
        return sum(unknown.log_prior(z[part].tolist()) for unknown, part in zip(self.unknowns, self.slices, strict=True)) - choices

    def prior_cost(self, z: FloatArray) -> float:
        """Of the normal priors that the fit uses: sum of precision z^2/2."""
        return 0.5 * float(self.precisions @ z**2)

    @cached_property
    def precisions(self) -> FloatArray:
        """Of the normal priors, by coordinate."""
        return np.concatenate([np.full(unknown.size, unknown.precision) for unknown in self.unknowns]) if self.unknowns else np.zeros(0)

    def reaches(self, z: FloatArray) -> FloatArray:
        """Longest changes in one step of a fit, by coordinate."""
        pairs = zip(self.unknowns, self.slices, strict=True)
        return np.concatenate([np.zeros(0), *(np.full(unknown.size, unknown.reach(z[part].tolist())) for unknown, part in pairs)])

    def rescaled(self, z: FloatArray) -> tuple[Hypothesis, FloatArray]:
        """The same hypothesis with strengths measured in their present values, and the coordinates of the same point."""
        values = self.values(z)
        added = []
        for item in self.added:
            prefix = f"{item.name}."
            own = {path.removeprefix(prefix): value for path, value in values.items() if path.startswith(prefix)}
            added.append(Added(item.effect.replacing(**own), item.at, item.name))
        new = Hypothesis(self.factors, tuple(added), self.loose)
        start = new.start()
        start[: self.nominal_size] = z[: self.nominal_size]
        return new, start

    def curvatures(self, z: FloatArray) -> FloatArray:
        """Of the priors, by coordinate."""
        pairs = zip(self.unknowns, self.slices, strict=True)
        return np.concatenate([np.zeros(0), *(np.full(unknown.size, unknown.curvature(z[part].tolist())) for unknown, part in pairs)])

    def steps(self, z: FloatArray) -> FloatArray:
        """Differences for numerical derivatives, by coordinate."""
        pairs = zip(self.unknowns, self.slices, strict=True)
        return np.concatenate([np.zeros(0), *(np.full(unknown.size, unknown.step(z[part].tolist())) for unknown, part in pairs)])

"""Effects and places that are tried: every law of the library, and a user's own, wherever it makes sense."""

from __future__ import annotations

import dataclasses
import importlib
import inspect
import itertools
import pkgutil
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

from hdrive_mbs import effects as library
from hdrive_mbs.diagnosis.hypothesis import Added
from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.errors import HdriveError, ParameterError
from hdrive_mbs.network.network import Network
from hdrive_mbs.quantities import snake_case
from hdrive_mbs.quantity import Quantity
from hdrive_mbs.scene import Scene

SHAPES = {1: 3, 2: 2}
"""Number of shapes of a law -> values of each from which a search begins, where the law names none; with more shapes one."""
MOST = 9
"""Starts of a law at a place; of more an even selection is taken."""


@dataclass(frozen=True, eq=False)
class Candidate:
    """One law at one place, with the points from which its search starts.

    starts : the effect with start values, strengths at the low end of their typical ranges
    first : those of them for a first look: shapes in the middle of their ranges, all choices
    """

    kind: type[Effect]
    at: str
    starts: tuple[Added, ...]
    first: tuple[Added, ...]

    @property
    def label(self) -> tuple[str, str]:
        """(family, place): what is reported."""
        return self.kind.family, self.at


def known_effects() -> list[type[Effect]]:
    """Every effect that can be searched: of the library, and whatever has been imported that subclasses Effect."""
    for module in pkgutil.iter_modules(library.__path__):
        importlib.import_module(f"{library.__name__}.{module.name}")
    found: list[type[Effect]] = []

    def visit(kind: type[Effect]) -> None:
        for child in kind.__subclasses__():
            if not inspect.isabstract(child) and child.tried and _searched(child) and child not in found:
                found.append(child)
            visit(child)

    visit(Effect)  # type: ignore[type-abstract]
    return sorted(found, key=lambda kind: (kind.family, kind.__name__))


def _quantities(kind: type[Effect]) -> dict[str, Quantity]:
    pairs = ((item.name, item.metadata.get("quantity")) for item in dataclasses.fields(kind))
    return {name: quantity for name, quantity in pairs if quantity is not None}


def _searched(kind: type[Effect]) -> bool:
    """Whether it can be searched."""
    return not _unsearchable(kind)


def _unsearchable(kind: type[Effect]) -> str:
    """Why a law cannot be searched: nothing of it can, a whole series of numbers would have to be, or a field has no value to begin at."""
    typical = {name: quantity for name, quantity in _quantities(kind).items() if quantity.typical is not None}
    if not typical or any(quantity.sequence for quantity in typical.values()):
        return "has nothing to search: give its fields a typical range, parameter(..., typical=(low, high))"
    for item in dataclasses.fields(kind):
        without = item.default is dataclasses.MISSING and item.default_factory is dataclasses.MISSING
        if without and item.name not in typical and item.name not in kind.starts:
            return f"cannot be searched: {item.name!r} has no value to begin at; give it a default, a typical range or starts"
    return ""


def candidates(scene: Scene, kinds: Iterable[type[Effect]] | type[Effect] | None = None) -> list[Candidate]:
    """Every law at every place of a scene where it may sit.

    kinds : effect classes to try, or one; all known ones if not given

    Raises ParameterError for a class that says nothing to search, or for a user's effect whose ``places`` raises.
    """
    network = scene.network()
    found = []
    for kind in known_effects() if kinds is None else [kinds] if isinstance(kinds, type) else kinds:
        if not (isinstance(kind, type) and issubclass(kind, Effect)):
            raise ParameterError(f"{kind!r} is no effect class; give classes that subclass Effect, like CoulombStribeckFriction.")
        if not _searched(kind):
            raise ParameterError(f"{kind.__name__} {_unsearchable(kind)}.")
        for place in _places(kind, network):
            name = _free_name(scene, kind)
            options = _options(kind)
            known: dict[str, bool] = {}
            starts = tuple(item for effect in _made(kind, options) if _fits(scene, item := Added(effect, place, name), known))
            if starts:
                few = _made(kind, _few(kind, options))  # most of them are among the starts
                first = tuple(item for effect in few if _fits(scene, item := Added(effect, place, name), known))
                found.append(Candidate(kind, place, starts, first or starts[:1]))
    return found


def _free_name(scene: Scene, kind: type[Effect]) -> str:
    taken = {placed.name for placed in scene.effects} | set(scene.parts)
    stem = name = snake_case(kind.__name__)
    number = 2
    while name in taken:
        name, number = f"{stem}_{number}", number + 1
    return name


def _places(kind: type[Effect], network: Network) -> tuple[str, ...]:
    try:
        return kind.places(network)
    except HdriveError:
        return ()
    except Exception as error:
        raise ParameterError(f"{kind.__name__}.places raised {type(error).__name__}: {error}. Mend it, or leave the class out.") from error


def _fits(scene: Scene, item: Added, known: dict[str, bool]) -> bool:
    """As ``_goes_there``;  known : answers for effects at this place, by their text, which takes this one up."""
    key = repr(item.effect)
    if key not in known:
        known[key] = _goes_there(scene, item)
    return known[key]


def _goes_there(scene: Scene, item: Added) -> bool:
    """Whether an effect can be put there at all."""
    try:
        scene.with_effect(item.effect, at=item.at)
    except HdriveError:
        return False
    except Exception as error:
        kind = type(item.effect).__name__
        raise ParameterError(
            f"{kind} at {item.at!r} raised {type(error).__name__}: {error}. Mend its law, or leave the class out."
        ) from error
    return True


def _options(kind: type[Effect]) -> dict[str, tuple[Any, ...]]:
    """Start values of its shapes and choices, by field."""
    chosen: dict[str, tuple[Any, ...]] = {}
    phases = {phase for _, phase in kind.vectors}
    shapes = [name for name, item in _quantities(kind).items() if _is_shape(name, item, kind) and name not in kind.periodic]
    count = SHAPES.get(len(shapes), 1)
    for name, quantity in _quantities(kind).items():
        if name in kind.starts:
            chosen[name] = tuple(kind.starts[name])
        elif quantity.typical is not None and name not in phases:
            low, high = quantity.typical
            if low < 0.0:
                chosen[name] = (0.0,)
            elif quantity.low == 0.0:
                chosen[name] = (low,)
            else:
                number = 1 if name in kind.periodic else count  # begins elsewhere in the end: beginnings.py
                ends = [(k + 0.5) / number for k in range(number)]
                chosen[name] = tuple(low * (high / low) ** end for end in ends)
    for name, values in kind.starts.items():
        chosen.setdefault(name, tuple(values))
    return chosen


def _few(kind: type[Effect], options: Mapping[str, tuple[Any, ...]]) -> dict[str, tuple[Any, ...]]:
    """Those for a first look: of a shape that is searched the middle one, of a number of either sign the smallest."""
    found = dict(options)
    for name, quantity in _quantities(kind).items():
        if name in options and quantity.typical is not None and quantity.low != 0.0 and name not in kind.decisive:
            values = sorted(options[name])
            either = values[0] < 0.0 < values[-1]
            found[name] = (min(values, key=abs) if either else values[len(values) // 2],)
    return found


def _made(kind: type[Effect], options: Mapping[str, tuple[Any, ...]]) -> Iterator[Effect]:
    """The effect at each combination of start values that is allowed; where they are too many, of each value of what is decisive some."""
    decisive = _products({name: values for name, values in options.items() if name in kind.decisive})
    if len(decisive) > MOST:
        decisive = [{}]
    others = _products({name: values for name, values in options.items() if name not in decisive[0]})
    stride = -(-len(others) // round(MOST / len(decisive))) if _continuous(kind) else 1
    for number, values in enumerate(decisive):
        # one of each row of so many, another place in the next row: along a row alone a field would keep one of its values
        rows = [others[first : first + stride] for first in range(0, len(others), stride)]
        for k, row in enumerate(rows, number):
            if k % stride < len(row):
                try:
                    yield kind(**values, **row[k % stride])
                except HdriveError:
                    continue


def _products(options: Mapping[str, tuple[Any, ...]]) -> list[dict[str, Any]]:
    """Each combination of values, by field."""
    return [dict(zip(options, some, strict=True)) for some in itertools.product(*options.values())]


def _is_shape(name: str, quantity: Quantity, kind: type[Effect]) -> bool:
    """Whether a field is searched on a logarithmic scale from values that the law does not name."""
    if quantity.typical is None or name in kind.starts or name in {phase for _, phase in kind.vectors}:
        return False
    return quantity.typical[0] > 0.0 and quantity.low != 0.0


def _continuous(kind: type[Effect]) -> bool:
    """Whether all fields with start values are searched on from there, so that a few starts will do."""
    quantities = _quantities(kind)
    return all(name in quantities and quantities[name].typical is not None for name in kind.starts)

"""A scene: parts, connections and effects at named places.  Immutable; a change is a copy."""

from __future__ import annotations

import difflib
import itertools
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Any

from hdrive_mbs.components.component import Component
from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.errors import HdriveError, LawError, PlaceError, SceneError, unknown_place
from hdrive_mbs.network.claims import check_claims
from hdrive_mbs.network.network import Network
from hdrive_mbs.part_table import part_table
from hdrive_mbs.quantities import FreeParameter, snake_case
from hdrive_mbs.topology import GROUND, check_connections, resolve_flanges, start_draft


@dataclass(frozen=True, kw_only=True)
class PlacedEffect:
    """An effect with its name in the scene and its place."""

    name: str
    effect: Effect
    at: str


@dataclass(frozen=True, kw_only=True)
class Scene:
    """Parts connected at named places, and the effects that act there.

    parts : name -> part.  Names are plain words (``motor``, ``input_shaft``).
    connections : chains of places that are rigidly joined, e.g. ``("motor", "input_shaft", "gear")``.
        A part in the middle of a chain is entered by its entry flange and left by its exit flange;
        a flange can be named: ``("gear.circular_spline", "housing")``; ``"ground"`` holds.
    effects : see ``with_effect``.

    Raises SceneError or PlaceError when a place is unknown or an end stays loose.
    """

    name: str
    parts: Mapping[str, Component]
    connections: Sequence[Sequence[str]]
    effects: tuple[PlacedEffect, ...] = ()
    notes: str = ""
    _cache: dict[str, Network] = field(default_factory=dict, init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        if not isinstance(self.name, str):
            raise SceneError(f"Scene name {self.name!r}: must be a text.")
        if not isinstance(self.parts, Mapping) or not self.parts:
            raise SceneError(f"Scene {self.name!r} has no parts; give parts={{'motor': Motor(...), ...}}.")
        for chain in self.connections:
            if isinstance(chain, str) or isinstance(self.connections, str):
                raise SceneError(f"connections = {self.connections!r}: must be a list of chains, like [('motor', 'shaft', 'load')].")
        object.__setattr__(self, "parts", MappingProxyType(dict(self.parts)))
        object.__setattr__(self, "connections", tuple(tuple(chain) for chain in self.connections))
        object.__setattr__(self, "effects", tuple(self.effects))
        for placed in self.effects:
            if not isinstance(placed.effect, Effect):
                raise SceneError(f"{placed.name!r} is a {type(placed.effect).__name__}, not an effect.")
        for name, part in self.parts.items():
            if not isinstance(name, str) or not name.isidentifier() or name == GROUND:
                raise SceneError(f"Part name {name!r}: use a plain word (letters, digits, underscore), and not 'ground'.")
            if not isinstance(part, Component):
                raise SceneError(f"Part {name!r} is a {type(part).__name__}, not a component.")
        check_connections(self.parts, self.connections)

    def __hash__(self) -> int:
        return hash((self.name, frozenset(self.parts), self.connections))

    # -- changes ---------------------------------------------------------------------------------
    def with_effect(self, effect: Effect, *, at: str, name: str | None = None) -> Scene:
        """A copy with an effect at a place.  The name defaults to the effect's type, made unique."""
        if not isinstance(effect, Effect):
            raise SceneError(f"{effect!r} is not an effect.")
        taken = {placed.name for placed in self.effects} | set(self.parts)
        stem = name or snake_case(type(effect).__name__)
        if name is not None and name in taken:
            raise SceneError(f"The name {name!r} is taken. In use: {', '.join(sorted(taken))}.")
        if not stem.isidentifier():
            raise SceneError(f"Effect name {stem!r}: use a plain word (letters, digits, underscore).")
        unique, number = stem, 2
        while unique in taken:
            unique, number = f"{stem}_{number}", number + 1
        changed = replace(self, effects=(*self.effects, PlacedEffect(name=unique, effect=effect, at=at)))
        changed._check_place(effect, at)
        return changed

    def _check_place(self, effect: Effect, at: str) -> None:
        draft = start_draft(self.parts, self.connections)
        for name, part in self.parts.items():
            part.build(name, draft)
        effect.apply(draft, at, "checked")

    def without(self, name: str) -> Scene:
        """A copy without the effect (or part) of that name."""
        if any(placed.name == name for placed in self.effects):
            return replace(self, effects=tuple(placed for placed in self.effects if placed.name != name))
        if name not in self.parts:
            raise unknown_place("effect or part", name, [*(e.name for e in self.effects), *self.parts])
        parts = {key: part for key, part in self.parts.items() if key != name}
        chains: list[Sequence[str]] = []
        for chain in self.connections:
            piece: list[str] = []
            for place in chain:
                if place.split(".")[0] == name:
                    chains.append(piece)
                    piece = []
                else:
                    piece.append(place)
            chains.append(piece)
        changed = replace(self, parts=parts, connections=[chain for chain in chains if len(chain) > 1])
        for placed in changed.effects:
            try:
                changed._check_place(placed.effect, placed.at)
            except PlaceError as error:
                raise PlaceError(
                    f"Without {name!r} the effect {placed.name!r} at {placed.at!r} has no place; remove it first. {error}"
                ) from None
        return changed

    def replacing(self, changes: Mapping[str, Any] | None = None, **parts: Any) -> Scene:
        """A copy with values, laws or whole parts replaced by path.

        ``scene.replacing({"motor.inertia": 2e-3, "gear.stiffness": law})`` or ``scene.replacing(motor=part)``.
        Paths of effects begin with the effect's name.  Raises PlaceError for an unknown path.
        """
        return self.changed({**(changes or {}), **parts})

    def changed(self, changes: Mapping[str, Any], more: Sequence[PlacedEffect] = ()) -> Scene:
        """A copy with values, laws or whole parts replaced by path, and further effects, whose places are checked when it is built."""
        changed: dict[str, Component] = dict(self.parts)
        effects = {placed.name: placed for placed in self.effects}
        inside: dict[str, dict[str, Any]] = {}
        for path, value in changes.items():
            head, _, rest = path.partition(".")
            if head not in changed and head not in effects:
                raise self._unknown_path(path, unknown_place("part or effect", head, [*changed, *effects]))
            if rest:
                inside.setdefault(head, {})[rest] = value
            elif head in changed:
                changed[head] = value
            else:
                effects[head] = replace(effects[head], effect=value)
        for head, fields in inside.items():
            try:
                if head in changed:
                    changed[head] = changed[head].setting_all(fields)
                else:
                    effects[head] = replace(effects[head], effect=effects[head].effect.setting_all(fields))
            except PlaceError as error:
                known = self.parameters()
                path = next((f"{head}.{rest}" for rest in fields if f"{head}.{rest}" not in known), f"{head}.{next(iter(fields))}")
                raise self._unknown_path(path, error) from None
        return replace(self, parts=changed, effects=(*effects.values(), *more))

    def _unknown_path(self, path: str, error: PlaceError) -> PlaceError:
        near = difflib.get_close_matches(path, list(self.parameters()), n=1)
        if not near:
            return PlaceError(f"{path!r}: {error}")
        return PlaceError(f"{path!r}: {str(error).partition(' Did you mean')[0]} Did you mean {near[0]!r}?")

    # -- questions -------------------------------------------------------------------------------
    def effect(self, name: str) -> PlacedEffect:
        """The effect of that name."""
        for placed in self.effects:
            if placed.name == name:
                return placed
        raise unknown_place("part or effect", name, [*self.parts, *(placed.name for placed in self.effects)])

    def parameters(self) -> dict[str, FreeParameter]:
        """Every number that can be set, by path, with unit, range and meaning."""
        found: dict[str, FreeParameter] = {}
        for name, part in self.parts.items():
            found |= {item.path: item for item in part.free_parameters(name)}
        for placed in self.effects:
            found |= {item.path: item for item in placed.effect.free_parameters(placed.name)}
        return found

    def places(self) -> tuple[str, ...]:
        """Names that a connection, effect or sensor can refer to."""
        return tuple(resolve_flanges(self.parts))

    def network(self) -> Network:
        """The equations of the scene (kept, so asking twice costs nothing).

        Raises SceneError for bodies without inertia and LawError for a law that breaks its claim.
        """
        if "network" not in self._cache:
            draft = start_draft(self.parts, self.connections)
            for name, part in self.parts.items():
                part.build(name, draft)
            for placed in self.effects:
                placed.effect.apply(draft, placed.at, placed.name)
            network = draft.finish()
            check_claims(network)
            self._cache["network"] = network
        return self._cache["network"]

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "parts": dict(self.parts), "_cache": {}}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state, parts=MappingProxyType(state["parts"]))

    def __str__(self) -> str:
        return describe(self)


def describe(scene: Scene) -> str:
    """The scene in readable lines: parts with units, connections, effects, senses of rotation."""
    lines = [f"Scene {scene.name!r}", "  parts"]
    is_lateral = any(flange.lateral for part in scene.parts.values() for flange in part.flanges())
    width = max(len(name) for name in scene.parts)
    plain = [f"{name:<{width}}  {part.describe()}" for name, part in scene.parts.items()]
    lines += [f"    {line}" for line in (part_table(scene.parts) if is_lateral else plain)]
    lines.append("  connections")
    lines += [f"    {' - '.join(chain)}" for chain in scene.connections]
    if scene.effects:
        lines.append("  effects")
        lines += [f"    {placed.name} at {placed.at}: {placed.effect.describe()}" for placed in scene.effects]
    try:
        bodies = [body for body in scene.network().bodies if not body.lateral]
    except HdriveError as error:
        return "\n".join([*lines, f"  it cannot be solved: {error}"])
    width = max(len(body.name) for body in bodies)
    lines.append("  turns per turn of the motor")
    if is_lateral:
        alike = itertools.groupby(bodies, key=lambda body: f"{body.ratio:+.6g}")
        return "\n".join([*lines, *(f"    {ratio}  {', '.join(body.name for body in group)}" for ratio, group in alike)])
    lines += [f"    {body.name:<{width}}  {body.ratio:+.6g}" for body in bodies]
    return "\n".join(lines)


def names(items: Iterable[str]) -> str:
    """A readable list."""
    return ", ".join(items) or "none"


__all__ = ["GROUND", "LawError", "PlacedEffect", "Scene", "describe"]

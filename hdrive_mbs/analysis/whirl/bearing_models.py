"""One scene, four models of its bearings: full, merged with a rotor, simplified, improved."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from hdrive_mbs.analysis.whirl.mode_shifts import ModeShifts, mode_shifts
from hdrive_mbs.components.bearing import Bearing, has_forces
from hdrive_mbs.components.component import Component
from hdrive_mbs.components.improved_section import ImprovedSection
from hdrive_mbs.components.rigid_section import RigidSection
from hdrive_mbs.components.shaft_section import ShaftSection
from hdrive_mbs.components.simplified_section import SimplifiedSection
from hdrive_mbs.components.supported_section import SupportedSection
from hdrive_mbs.errors import ParameterError, PlaceError, SceneError, unknown_place
from hdrive_mbs.scene import Scene
from hdrive_mbs.topology import GROUND, joints

FloatArray = npt.NDArray[np.float64]

MODELS = ("full", "merged", "simplified", "improved")

LIMITS = {"merged": (0.02, 0.2), "simplified": (0.02, 0.2), "improved": (5e-4, 0.02)}
"""Share by which frequencies and damping ratios of the lowest modes may part before there is a warning."""

Pairs = list[tuple[str, str]]


class BearingModelWarning(UserWarning):
    """A simplified model of a bearing is used outside what it can do."""


def with_bearings(scene: Scene, model: str, bearings: Sequence[str] | None = None, *, highest_speed: float | None = None) -> Scene:
    """The scene with another model of its bearings, made of the same data.

    model : "full" (ring and housing as bodies), "merged" (one body with the rotor next to it, seed M Fig. 2(b)),
        "simplified" (seed M section 5) or "improved" (component-mode synthesis)
    bearings : names; None for all that can be
    highest_speed : fastest rotation or vibration that must come out right [rad/s]

    A section keeps the name of its bearing; back in the full model its pieces are ``<bearing>_left`` and ``_right``.
    Merging cannot be undone.  Warns BearingModelWarning with what a model leaves out of these data, and where its modes
    part from those of the full model: all up to ``highest_speed``, at rest and at that speed, else the lowest four.
    Raises SceneError for a bearing that the model cannot take, PlaceError where an effect loses its place.
    """
    if model not in MODELS:
        raise ParameterError(f"model = {model!r}: must be one of {', '.join(MODELS)}.")
    known = [name for name, part in scene.parts.items() if isinstance(part, (Bearing, SupportedSection))]
    for name in bearings or ():
        if name not in known:
            raise unknown_place("bearing", name, known)
    line = _Line(dict(scene.parts), joints(scene.parts, scene.connections))
    wanted = known if bearings is None else list(bearings)
    for name in wanted:
        line.unfold(name)
    full = line.scene(scene) if any(isinstance(scene.parts[name], SupportedSection) for name in wanted) else scene
    if model == "full":
        return full
    for name in wanted:
        try:
            if model == "merged":
                line.merge(name)
            else:
                line.fold(name, model, highest_speed)
        except SceneError as error:
            if bearings is not None:
                raise
            warnings.warn(f"{name} stays as it is: {error}", BearingModelWarning, stacklevel=2)
    changed = line.scene(scene)
    shifts = mode_shifts(full, changed, highest_speed, deflected=model != "improved")
    for remark in [*_left_out(changed.parts, wanted), *_parting(model, shifts)]:
        warnings.warn(remark, BearingModelWarning, stacklevel=2)
    return changed


@dataclass
class _Line:
    """Parts and joints of a scene while bearings change."""

    parts: dict[str, Component]
    pairs: Pairs

    def scene(self, source: Scene) -> Scene:
        """The scene with the parts and joints as they are now, and the effects of the source."""
        changed = replace(source, parts=self.parts, connections=_chains(self.parts, self.pairs), effects=())
        for placed in source.effects:
            try:
                changed = changed.with_effect(placed.effect, at=placed.at, name=placed.name)
            except PlaceError as error:
                raise PlaceError(
                    f"The effect {placed.name!r} at {placed.at!r} has no place in this model of the bearings; remove it, or leave its "
                    f"bearing out of ``bearings``. {error}"
                ) from None
        return changed

    def unfold(self, name: str) -> None:
        """A supported section as section, bearing and section; nothing to do for a bearing."""
        part = self.parts[name]
        if not isinstance(part, SupportedSection):
            return
        left, right = f"{name}_left", f"{name}_right"
        for piece in (left, right):
            if piece in self.parts:
                raise SceneError(f"The full model of {name!r} needs the name {piece!r}, which is taken; rename that part.")
        made: dict[str, Component] = {left: part.left, name: part.bearing, right: part.right}
        self._replace(name, made, {f"{name}.a": f"{left}.a", f"{name}.b": f"{right}.b"})
        ends = [k for k, pair in enumerate(self.pairs) if f"{left}.a" in pair]
        at = ends[-1] + 1 if ends else 0
        self.pairs[at:at] = [(f"{left}.b", name), (name, f"{right}.a")]

    def fold(self, name: str, model: str, highest_speed: float | None) -> None:
        """Section, bearing and section as one part."""
        bearing = self._bearing(name)
        left, right = self._neighbours(name)
        if left is None or right is None:
            raise SceneError(
                f"the {model} bearing replaces a section of shaft on both sides, and {name!r} has one on "
                f"{'one side' if left or right else 'neither side'} only. Leave it full, or continue the shaft beyond it."
            )
        data: dict[str, Any] = {"left": self.parts[left], "bearing": bearing, "right": self.parts[right]}
        made: Component
        try:
            made = SimplifiedSection(**data) if model == "simplified" else ImprovedSection(**data, highest_speed=highest_speed)
        except ParameterError as error:
            raise SceneError(f"{name!r}: {error}") from error
        self.pairs = [pair for pair in self.pairs if name not in pair]
        del self.parts[left], self.parts[right]
        self._replace(name, {name: made}, {f"{left}.a": f"{name}.a", f"{right}.b": f"{name}.b"})

    def merge(self, name: str) -> None:
        """The shorter section between the bearing and a rotor as a rigid one."""
        self._bearing(name)
        found = []
        for section, far in zip(self._neighbours(name), ("a", "b"), strict=True):
            part = self.parts.get(section or "")
            if isinstance(part, ShaftSection) and self._has_rotor(f"{section}.{far}"):
                found.append((part.length, str(section)))
        if not found:
            raise SceneError(f"{name!r} has no rotor at the other end of a section next to it, so there is nothing to merge it with.")
        length, section = min(found)
        part = self.parts[section]
        if isinstance(part, ShaftSection) and part.density > 0.0:
            raise SceneError(
                f"{section!r} between {name!r} and its rotor has mass (density = {part.density:g} kg/m^3), and a rigid section has none. "
                "Add its mass to the rotor and give it density 0."
            )
        self.parts[section] = RigidSection(length=length)

    def _bearing(self, name: str) -> Bearing:
        part = self.parts[name]
        assert isinstance(part, Bearing)
        return part

    def _replace(self, name: str, made: Mapping[str, Component], paths: Mapping[str, str]) -> None:
        """Put parts in the place of one, and give its flanges other paths."""
        items = [(key, part) for key, part in self.parts.items()]
        self.parts = {k: p for key, part in items for k, p in (made.items() if key == name else [(key, part)])}
        self.pairs = [(paths.get(a, a), paths.get(b, b)) for a, b in self.pairs]

    def _partners(self, path: str) -> list[str]:
        return [b if a == path else a for a, b in self.pairs if path in (a, b)]

    def _neighbours(self, name: str) -> tuple[str | None, str | None]:
        """The sections that end and begin at a bearing; SceneError where something else sits there too."""
        found: dict[str, str] = {}
        for partner in self._partners(name):
            part, _, flange = partner.partition(".")
            if isinstance(self.parts.get(part), SupportedSection):
                raise SceneError(
                    f"the section between {part!r} and {name!r} belongs to {part!r} already, and a section serves one bearing. "
                    "Leave one of the two full, or put a station between them."
                )
            if not isinstance(self.parts.get(part), ShaftSection) or flange in found:
                raise SceneError(
                    f"at {name!r} sits {part!r} too, and only a bearing by itself between two shaft sections can be replaced. "
                    "Leave it full, or put a short section between them."
                )
            found[flange] = part
        return found.get("b"), found.get("a")

    def _has_rotor(self, path: str) -> bool:
        """Whether a rotor is rigidly joined to a flange, directly."""
        partners = [partner.partition(".")[0] for partner in self._partners(path)]
        return any(flange.is_rotor for name in partners if name != GROUND for flange in self.parts[name].flanges())


def _chains(parts: Mapping[str, Component], pairs: Pairs) -> list[tuple[str, ...]]:
    """Joints as chains that read well."""
    chains: list[list[str]] = []
    for left, right in pairs:
        first, last = _short(parts, left, leaving=True), _short(parts, right, leaving=False)
        if chains and chains[-1][-1] == first and "." not in first:
            chains[-1].append(last)
        else:
            chains.append([first, last])
    return [tuple(chain) for chain in chains]


def _short(parts: Mapping[str, Component], path: str, *, leaving: bool) -> str:
    name, _, flange = path.partition(".")
    if not flange:
        return path
    return name if flange == (parts[name].exit if leaving else parts[name].entry) else path


def _left_out(parts: Mapping[str, Component], wanted: Iterable[str]) -> list[str]:
    """What the data of simplified bearings say and the model does not."""
    remarks = []
    for name in wanted:
        part = parts[name]
        if not isinstance(part, SimplifiedSection):
            continue
        law, housing = part.bearing.law, part.bearing.housing
        if has_forces(law):
            remarks.append(
                f"{name}: the simplified bearing leaves out all forces of {type(law).__name__} beyond its constant axial and tilt "
                "stiffness. The improved model keeps them."
            )
        if housing is not None and (housing.power_stiffness_x or housing.power_stiffness_y):
            remarks.append(f"{name}: the simplified bearing leaves out the power term of the foundation. The improved model keeps it.")
    return remarks


def _parting(model: str, shifts: Sequence[ModeShifts]) -> list[str]:
    """Where the modes of the model and of the full one part by more than the model should allow."""
    frequency_limit, damping_limit = LIMITS[model]
    way_out = "Raise highest_speed, or use the full model." if model == "improved" else "Use the improved or the full model."
    remarks = []
    for shift in shifts:
        if (k := _worst(shift.frequency, frequency_limit)) is not None:
            remarks.append(
                f"{model} bearings change the frequency of lateral mode {k + 1} at {shift.speed:g} rad/s by "
                f"{100.0 * shift.frequency[k]:+.3g} %, from {shift.full.frequency[k]:.5g} rad/s; more than {100.0 * frequency_limit:g} %. "
                f"Critical speeds are wrong by about as much. {way_out}"
            )
        if (k := _worst(shift.damping, damping_limit)) is not None:
            remarks.append(
                f"{model} bearings change the damping ratio of lateral mode {k + 1} at {shift.speed:g} rad/s by "
                f"{100.0 * shift.damping[k]:+.3g} %, from {shift.full.damping_ratio[k]:.4g}; more than {100.0 * damping_limit:g} %. "
                f"Resonant amplitudes are wrong by about as much, the other way. {way_out}"
            )
    return remarks


def _worst(change: FloatArray, limit: float) -> int | None:
    """Place of the largest change, if it is over the limit."""
    if not len(change):
        return None
    worst = int(np.argmax(np.abs(change)))
    return None if abs(change[worst]) <= limit else worst

"""Parameter sets of a hypothesis as compiled lines, each built once for all trials that differ in their inputs alone."""

from __future__ import annotations

import copy
import functools
import gc
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace

from hdrive_mbs.compiled.equilibrium import equilibria
from hdrive_mbs.compiled.idle_coordinates import without_idle
from hdrive_mbs.compiled.line import CompiledLine
from hdrive_mbs.compiled.program import Program
from hdrive_mbs.compiled.slowed import Slowed
from hdrive_mbs.compiled.structure import Structure
from hdrive_mbs.compiled.time_inputs import TimeInput
from hdrive_mbs.diagnosis.following import following
from hdrive_mbs.diagnosis.hypothesis import FloatArray, Hypothesis
from hdrive_mbs.diagnosis.refusals import refuse
from hdrive_mbs.diagnosis.templates import Templates, alike
from hdrive_mbs.diagnosis.trial import Trial
from hdrive_mbs.errors import HdriveError, LawError, ParameterError, PlaceError
from hdrive_mbs.network.network import Network
from hdrive_mbs.quantities import Described
from hdrive_mbs.scene import Scene

Inputs = tuple[TimeInput, ...]


class Start:
    """A line with the angles at which it starts."""

    def __init__(self, line: CompiledLine, angles: dict[str, float]) -> None:
        self.line, self.angles = line, angles

    @property
    def key(self) -> tuple[object, ...]:
        """What its run depends on."""
        program = self.line.program
        return program.structure, program.constants.tobytes(), *(table.values.tobytes() for table in program.tables), program.inputs


class Lines:
    """Compiled lines of trials.

    Records of one bench differ in tables of time alone: their equations are recorded for one of them, and the others
    take their own tables.  Whether that is right is checked on the first parameter set of each form of equations:
    structure and numbers have to be equal, and no searched parameter may sit in a part in which the scenes differ.
    """

    def __init__(self, trials: Sequence[Trial], slowed: Sequence[Slowed] = ()) -> None:
        self._trials, self._slowed = tuple(trials), tuple(slowed)
        self._families: list[list[int]] = []
        for k, trial in enumerate(self._trials):
            for family in self._families:
                if _alike(self._trials[family[0]].scene, trial.scene):
                    family.append(k)
                    break
            else:
                self._families.append([k])
        # the scene that most trials of a family have comes first: its network serves all of its views
        for family in self._families:
            scenes = [self._trials[k].scene for k in family]
            family.sort(key=lambda k: -sum(scene is self._trials[k].scene for scene in scenes))
        self._followed: set[int] = set()
        self._inputs: dict[int, list[str]] = {}
        for family in self._families:
            first = self._trials[family[0]].scene
            others = [self._trials[k].scene for k in family[1:]]
            parts = ((name, part, other.parts[name]) for other in others if other is not first for name, part in first.parts.items())
            self._inputs[family[0]] = sorted({path for name, a, b in parts for path in _differing(a, b, name)})
        self._known: dict[tuple[int, Structure], tuple[Inputs, Inputs] | None] = {}
        of_rotors = Templates(large=True), Templates(large=True, held=True)
        self._templates = {False: (Templates(),), True: of_rotors}  # by whether the scene is lateral

    def at(self, hypothesis: Hypothesis, points: Sequence[FloatArray], skipped: Collection[int] = frozenset()) -> list[list[Start | None]]:
        """For each trial the line at each point; None where values do not go together, and for trials that are skipped."""
        found: list[list[Start | None]] = [[None] * len(points) for _ in self._trials]
        with _collector_at_rest():
            for family in self._families:
                for some in self._apart(family, hypothesis, points):
                    for k, starts in self._family(some, hypothesis, points, skipped).items():
                        found[k] = starts
        return found

    def _apart(self, family: list[int], hypothesis: Hypothesis, points: Sequence[FloatArray]) -> list[list[int]]:
        """The family, or each member alone where a searched parameter sits in what tells them apart."""
        if not points:
            return [family]
        differing = self._inputs[family[0]]
        apart = any(_meet(path, other) for path in hypothesis.values(points[0]) for other in differing)
        return [[k] for k in family] if apart else [family]

    def _family(
        self, family: list[int], hypothesis: Hypothesis, points: Sequence[FloatArray], skipped: Collection[int]
    ) -> dict[int, list[Start | None]]:
        scene = self._trials[family[0]].scene
        asked = {self._view(k) for k in family if k not in skipped}
        if not asked:
            return {}
        # whatever is skipped, of each view the same one is the first, and all start where the forces of the same one balance
        asked |= {self._view(k) for k in [k for k in family if self._trials[k].settled][:1]}
        family = [k for k in family if self._view(k) in asked]
        network = functools.cache(lambda number: _network(hypothesis, scene, points[number]))
        bases: dict[tuple[object, ...], tuple[int, list[CompiledLine | None]]] = {}
        resting: list[dict[str, float]] | None = None
        found: dict[int, list[Start | None]] = {}
        for k in family:
            trial = self._trials[k]
            view = self._view(k)
            if view not in bases:
                bases[view] = k, self._built(k, hypothesis, scene, points, network)
            of, lines = bases[view]
            if of != k or trial.scene is not scene:
                lines = [self._taking(k, line, of, scene, hypothesis, point) for line, point in zip(lines, points, strict=True)]
            if trial.settled and resting is None:
                resting = _resting(lines, trial.angles)
            rest = resting if trial.settled and resting is not None else [{} for _ in lines]
            if k not in skipped:
                both = zip(lines, rest, strict=True)
                found[k] = [None if line is None else Start(line, {**angles, **trial.angles}) for line, angles in both]
        return found

    def _built(
        self, k: int, hypothesis: Hypothesis, scene: Scene, points: Sequence[FloatArray], network: Callable[[int], Network | None]
    ) -> list[CompiledLine | None]:
        """Lines of a scene as trial k sees it: from templates where there are any, else each of its own network."""
        found: list[CompiledLine | None] = [None] * len(points)
        for templates in self._templates[scene.network().is_lateral]:
            missing = [number for number, line in enumerate(found) if line is None]
            made = templates.lines(hypothesis, scene, [points[number] for number in missing], k, lambda made: self._compiled(made, k))
            for number, line in zip(missing, made, strict=True):
                found[number] = line
        return [self._line(network(number), k, hypothesis) if line is None else line for number, line in enumerate(found)]

    def _view(self, k: int) -> tuple[str, ...]:
        """What of the scene a trial shows."""
        trial = self._trials[k]
        return (*sorted(trial.motions), "/", *_channels(trial))

    def _taking(
        self, k: int, base: CompiledLine | None, of: int, scene: Scene, hypothesis: Hypothesis, point: FloatArray
    ) -> CompiledLine | None:
        """The line of trial k, from that of another one (of) with the same parameters if only inputs differ.

        scene : that the base was made of
        """
        if base is None:
            return None
        key = (k, base.structure)
        own: CompiledLine | None = None
        if key not in self._known:
            own = self._own(k, hypothesis, point)
            same = own is not None and alike(own.program, base.program)
            if own is not None and not same:  # built as the own one is: numbers that happen to be equal may have made one of two
                other = self._line(_network(hypothesis, scene, point), of, hypothesis)
                same = other is not None and _same(own.program, other.program)
            self._known[key] = (base.program.inputs, own.program.inputs) if same and own is not None else None
        known = self._known[key]
        if known is not None and known[0] == base.program.inputs:
            line = copy.copy(base)
            line.program = replace(base.program, inputs=known[1])
            return line
        return own if own is not None else self._own(k, hypothesis, point)

    def _own(self, k: int, hypothesis: Hypothesis, point: FloatArray) -> CompiledLine | None:
        return self._line(_network(hypothesis, self._trials[k].scene, point), k, hypothesis)

    def _line(self, network: Network | None, k: int, hypothesis: Hypothesis) -> CompiledLine | None:
        """As ``_compiled``; None for a cause whose law raises too, which is noted."""
        try:
            return self._compiled(network, k)
        except Exception as error:
            _refuse(hypothesis, error)
            return None

    def _compiled(self, network: Network | None, k: int) -> CompiledLine | None:
        """The line of trial k; None for values with which no compiled run can follow it, like a weight that makes a disc uneven.

        Raises ParameterError where none can follow the scene as it was given.
        """
        if network is None:
            return None
        trial = self._trials[k]
        try:
            return _compiled(network, trial, self._slowed)
        except ParameterError:
            if k not in self._followed:
                _compiled(trial.scene.network(), trial, self._slowed)
                self._followed.add(k)
            return None


@contextmanager
def _collector_at_rest() -> Iterator[None]:
    """No search for garbage meanwhile: recording makes many small objects that need none, and a fifth of its time went there."""
    enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if enabled:
            gc.enable()


def _resting(lines: Sequence[CompiledLine | None], angles: Mapping[str, float]) -> list[dict[str, float]]:
    """Of each line, with spins at the angles at which the trial starts: a place that is turned to an angle would twist the others."""
    found = iter(equilibria([line for line in lines if line is not None], angles=angles))
    return [{} if line is None else next(found) for line in lines]


def _channels(trial: Trial) -> list[str]:
    return [trial.measured[column].channel for column in trial.columns]


def _compiled(network: Network, trial: Trial, slowed: Sequence[Slowed] = ()) -> CompiledLine:
    driven = following(network, trial.motions)
    if driven.is_lateral:
        driven = without_idle(driven, {**trial.angles, **{f"{name}_rate": value for name, value in trial.speeds.items()}})
    return CompiledLine(driven, _channels(trial), slowed)


def _network(hypothesis: Hypothesis, scene: Scene, point: FloatArray) -> Network | None:
    try:
        return hypothesis.scene(scene, point, to_run=True).network()
    except (ParameterError, LawError, PlaceError):  # PlaceError: a cause found elsewhere that does not go with this place
        return None
    except Exception as error:
        _refuse(hypothesis, error)
        return None


def _refuse(hypothesis: Hypothesis, error: Exception) -> None:
    """Note what the law of a cause raised; raises it where there is no cause, or where it is no fault of a law."""
    if not hypothesis.added or isinstance(error, HdriveError | MemoryError):
        raise error
    refuse(hypothesis.label, error)


def _alike(a: Scene, b: Scene) -> bool:
    """Whether scenes may differ in the numbers of some parts alone."""
    return a is b or (
        a.connections == b.connections
        and a.effects == b.effects
        and {name: type(part) for name, part in a.parts.items()} == {name: type(part) for name, part in b.parts.items()}
    )


def _differing(a: Described, b: Described, path: str) -> list[str]:
    """Paths of the fields in which two parts differ, as deep as they are of the same kind."""
    if a is b or a == b:
        return []
    if type(a) is not type(b):
        return [path]
    found = []
    for name, own, _ in a.fields():
        other = getattr(b, name)
        if isinstance(own, Described) and isinstance(other, Described):
            found += _differing(own, other, f"{path}.{name}")
        elif own is not other and own != other:
            found.append(f"{path}.{name}")
    return found


def _meet(path: str, other: str) -> bool:
    """Whether one path holds the other."""
    return path == other or path.startswith(f"{other}.") or other.startswith(f"{path}.")


def _same(a: Program, b: Program) -> bool:
    """Whether programs differ in their inputs at most."""
    return (
        a.structure == b.structure
        and bool((a.constants == b.constants).all())
        and all(x.values.tobytes() == y.values.tobytes() for x, y in zip(a.tables, b.tables, strict=True))
    )

"""Lines for many parameter sets of a hypothesis from one that was recorded with tracked numbers.

Building a scene and recording its equations takes about as long as running it through a record.  Of sets that differ in searched numbers
alone the equations are the same, and their constants follow from the numbers (tracked.py).  Each template is held against a
line that was built for other numbers before it is used, and again in its 2nd, 4th, 8th ... use; where it fails, or where a
comparison in the making of the scene comes out otherwise, lines are built one by one.

A rotor line has many more numbers, and its templates are made where that many lines are asked for that it pays.  Where the law of an
effect takes its numbers out of sight, or where masses and stiffnesses come out of a matrix otherwise, templates hold all numbers but those
of the effect that was added last, as looks from a fitted model do.
"""

from __future__ import annotations

import copy
from collections import OrderedDict
from collections.abc import Callable, Hashable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from hdrive_mbs.compiled.line import CompiledLine
from hdrive_mbs.compiled.program import Program
from hdrive_mbs.diagnosis.hypothesis import FloatArray, Hypothesis
from hdrive_mbs.network.network import Network
from hdrive_mbs.scene import Scene
from hdrive_mbs.tracked import Replay, Tape, Tracked, plain

Compile = Callable[[Network], CompiledLine | None]

SAME = 1e-11
"""Relative difference of constants that rounding may make."""
KEPT, KEPT_LARGE = 256, 8
"""Templates that are kept; of rotor lines, which are large and asked for one hypothesis after another, fewer."""
PAYS = 6
"""Lines for which a template of a rotor line is made: it takes as long as two or three, and its checks as many."""
GOLDEN = 0.6180339887498949


@dataclass(eq=False)
class Template:
    """A line recorded with tracked numbers.

    replay : what its constants follow from;  paths : of the searched numbers;  uses : how often it was asked
    """

    replay: Replay
    line: CompiledLine
    paths: tuple[str, ...]
    uses: int = 0

    def lines(self, values: Sequence[dict[str, float]]) -> list[CompiledLine | None]:
        """The line for each set of numbers by path; None where its making would go another way."""
        program = self.line.program
        inputs = {path: np.array([item[path] for item in values]) for path in self.paths}
        found, holds = self.replay.again(inputs)
        constants = program.numbers.constants(found)
        made: list[CompiledLine | None] = []
        for row, right in zip(constants, holds, strict=True):
            line = copy.copy(self.line) if right else None
            if line is not None:
                line.program = replace(program, constants=np.ascontiguousarray(row))
            made.append(line)
        return made


class Templates:
    """Templates of the hypotheses that were asked for last.

    held : whether all numbers but those of the effect added last are held
    large : whether they are of rotor lines: few are kept, and made where it pays
    """

    def __init__(self, *, held: bool = False, large: bool = False) -> None:
        self._held, self._large = held, large
        self._kept: OrderedDict[Hashable, Template] = OrderedDict()
        self._asked: OrderedDict[Hashable, int] = OrderedDict()
        self._never: set[Hashable] = set()

    def lines(
        self, hypothesis: Hypothesis, scene: Scene, points: Sequence[FloatArray], view: Hashable, compiled: Compile
    ) -> list[CompiledLine | None]:
        """The line at each point from templates, None where it has to be built.

        view : of the trial that the lines are for;  compiled : the line of a network
        """
        found: list[CompiledLine | None] = [None] * len(points)
        values = [hypothesis.values(z, to_run=True) for z in points]
        free = _Free.of(hypothesis, held=self._held)
        groups: dict[tuple[float, ...], list[int]] = {}
        for k, item in enumerate(values):
            groups.setdefault(free.held(item), []).append(k)
        for numbers in groups.values():
            template = self.of(hypothesis, scene, points[numbers[0]], view, compiled, asked=len(numbers))
            if template is not None:
                for k, line in zip(numbers, template.lines([values[k] for k in numbers]), strict=True):
                    found[k] = line
        return found

    def of(
        self, hypothesis: Hypothesis, scene: Scene, point: FloatArray, view: Hashable, compiled: Compile, *, asked: int = 1
    ) -> Template | None:
        """The template of a hypothesis on a scene; None where there can be none, or where none is worth while.

        point : one of those that are asked for;  asked : how many
        """
        free = _Free.of(hypothesis, held=self._held)
        law = _key(hypothesis, scene, point, view) if free.paths else None  # with nothing to search there is one set alone
        if law is None or law in self._never:
            return None
        key = law, free.held(hypothesis.values(point, to_run=True))
        found = self._kept.get(key)
        if found is None:
            if self._large and not self._is_worth_while(key, asked):
                return None
            found = _made(hypothesis, scene, point, compiled, free)
            if found is None:
                self._never.add(law)
                return None
            self._kept[key] = found
            while len(self._kept) > (KEPT_LARGE if self._large else KEPT):
                self._kept.popitem(last=False)
        self._kept.move_to_end(key)
        found.uses += 1
        if found.uses > 1 and found.uses & (found.uses - 1) == 0:
            beside = free.moved(hypothesis, point, 1.0)
            if _agrees(found, hypothesis, scene, beside, compiled) is False:
                del self._kept[key]
                self._never.add(law)
                return None
        return found

    def _is_worth_while(self, key: Hashable, asked: int) -> bool:
        self._asked[key] = self._asked.get(key, 0) + asked
        while len(self._asked) > KEPT:
            self._asked.popitem(last=False)
        return self._asked[key] >= PAYS


@dataclass(frozen=True)
class _Free:
    """What of a hypothesis a template leaves free: its coordinates from a first one on, and their paths."""

    first: int
    paths: frozenset[str]

    @staticmethod
    def of(hypothesis: Hypothesis, *, held: bool) -> _Free:
        unknowns = hypothesis.unknowns
        if held:
            unknowns = hypothesis.added[-1].unknowns if hypothesis.added else ()
        paths = frozenset(path for unknown in unknowns for path in unknown.values([0.0] * unknown.size))
        return _Free(hypothesis.size - sum(unknown.size for unknown in unknowns), paths)

    def held(self, values: Mapping[str, float]) -> tuple[float, ...]:
        """The numbers that are held, in the order of their paths."""
        return tuple(values[path] for path in sorted(values) if path not in self.paths)

    def moved(self, hypothesis: Hypothesis, point: FloatArray, far: float) -> FloatArray:
        """A point beside another one at which no two free coordinates have moved alike."""
        part = np.array([(k * GOLDEN) % 1.0 for k in range(1, len(point) + 1)])
        found = hypothesis.clipped(point + far * (1.0 + part) * hypothesis.steps(point))
        found[: self.first] = point[: self.first]
        return found


def alike(a: Program, b: Program) -> bool:
    """Whether programs differ in their inputs at most, but for rounding."""
    return (
        a.structure == b.structure
        and bool(np.all(np.abs(a.constants - b.constants) <= SAME * np.abs(b.constants)))
        and all(x.values.tobytes() == y.values.tobytes() for x, y in zip(a.tables, b.tables, strict=True))
    )


def _key(hypothesis: Hypothesis, scene: Scene, point: FloatArray, view: Hashable) -> Hashable | None:
    """What the equations depend on apart from the searched numbers; None where that cannot be said."""
    paths = tuple(sorted(hypothesis.values(point, to_run=True)))
    fixed = []
    for item in hypothesis.added:
        kept = tuple((name, value) for name, value, _ in item.effect.fields() if f"{item.name}.{name}" not in paths)
        fixed.append((type(item.effect), item.at, item.name, kept))
    key = (id(scene), view, paths, tuple(fixed))
    try:
        hash(key)
    except TypeError:
        return None
    return key


def _made(hypothesis: Hypothesis, scene: Scene, point: FloatArray, compiled: Compile, free: _Free) -> Template | None:
    """A template recorded beside a point and checked farther off.

    First one that holds where a number becomes zero or one too, as angles do where a search begins; it multiplies by a zero what a built
    line leaves out, which differs only where that is infinite.  Of a law that makes numbers which
    are one whatever comes in, a built line is shorter than such a template; then one that leaves out what a built line does.
    """
    here, elsewhere = free.moved(hypothesis, point, 1.0), free.moved(hypothesis, point, 2.7)
    values, others = (hypothesis.values(z, to_run=True) for z in (here, elsewhere))
    if any(values[path] == others[path] for path in free.paths):
        return None
    for simplified in (False, True):
        made = _recorded(hypothesis, scene, values, compiled, free, Tape(simplified=simplified))
        if made is not None and _agrees(made, hypothesis, scene, elsewhere, compiled):
            return made
    return None


def _recorded(
    hypothesis: Hypothesis, scene: Scene, values: Mapping[str, float], compiled: Compile, free: _Free, tape: Tape
) -> Template | None:
    tracked = {path: tape.start(path, value) if path in free.paths else value for path, value in values.items()}
    try:
        line = compiled(hypothesis.with_values(scene, tracked).network())
    except Exception:  # whatever a law of one's own makes of such numbers: what is wrong with it shows where it is built without
        return None
    if line is None or tape.lost is not None or any(type(state.initial) is Tracked for state in line.network.states):
        return None
    return Template(tape.replay(line.program.numbers.found), _light(line), tuple(path for path in values if path in free.paths))


def _light(line: CompiledLine) -> CompiledLine:
    """The line without what its making alone needed, which takes most of the memory: laws, and what was done with tracked numbers."""
    bodies = tuple(replace(body, inertia=plain(body.inertia)) for body in line.network.bodies)
    light = copy.copy(line)
    light.network = replace(line.network, bodies=bodies, elements=(), channels=(), rotors=(), members={})
    light.program = replace(line.program, numbers=replace(line.program.numbers, found=()))
    return light


def _agrees(template: Template, hypothesis: Hypothesis, scene: Scene, point: FloatArray, compiled: Compile) -> bool | None:
    """Whether the template gives the line that is built for a point; None where it says that it has none there."""
    values = hypothesis.values(point, to_run=True)
    [line] = template.lines([values])
    if line is None:
        return None
    try:
        built = compiled(hypothesis.with_values(scene, values).network())
    except Exception:  # as above
        built = None
    return built is not None and alike(line.program, built.program) and line.program.inputs == built.program.inputs

"""Lines for many parameter sets of a hypothesis from one that was recorded with tracked numbers.

Building a scene and recording its equations takes about as long as running it through a record.  Of sets that differ in searched numbers
alone the equations are the same, and their constants follow from the numbers (tracked.py).  Each template is held against a
line that was built for other numbers before it is used, and again in its 2nd, 4th, 8th ... use; where it fails, or where a
comparison in the making of the scene comes out otherwise, lines are built one by one.
"""

from __future__ import annotations

import copy
from collections import OrderedDict
from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from hdrive_mbs.compiled.line import CompiledLine
from hdrive_mbs.compiled.program import Program
from hdrive_mbs.diagnosis.hypothesis import FloatArray, Hypothesis
from hdrive_mbs.errors import HdriveError
from hdrive_mbs.network.network import Network
from hdrive_mbs.scene import Scene
from hdrive_mbs.tracked import Tape, Tracked

Compile = Callable[[Network], CompiledLine | None]

SAME = 1e-11
"""Relative difference of constants that rounding may make."""
KEPT = 256
"""Templates that are kept."""
GOLDEN = 0.6180339887498949


@dataclass(eq=False)
class Template:
    """A line recorded with tracked numbers.

    paths : of the searched numbers;  uses : how often it was asked
    """

    tape: Tape
    line: CompiledLine
    paths: tuple[str, ...]
    uses: int = 0

    def lines(self, values: Sequence[dict[str, float]]) -> list[CompiledLine | None]:
        """The line for each set of numbers by path; None where its making would go another way."""
        program = self.line.program
        inputs = {path: np.array([item[path] for item in values]) for path in self.paths}
        found, holds = self.tape.again(inputs, program.numbers.found)
        constants = program.numbers.constants(found)
        made: list[CompiledLine | None] = []
        for row, right in zip(constants, holds, strict=True):
            line = copy.copy(self.line) if right else None
            if line is not None:
                line.program = replace(program, constants=np.ascontiguousarray(row))
            made.append(line)
        return made


class Templates:
    """Templates of the hypotheses that were asked for last."""

    def __init__(self) -> None:
        self._kept: OrderedDict[Hashable, Template | None] = OrderedDict()

    def of(self, hypothesis: Hypothesis, scene: Scene, point: FloatArray, view: Hashable, compiled: Compile) -> Template | None:
        """The template of a hypothesis on a scene; None where there can be none.

        point : one of those that are asked for;  view : of the trial that the line is for;  compiled : the line of a network
        """
        key = _key(hypothesis, scene, point, view) if hypothesis.size else None  # with nothing to search there is one set alone
        if key is None:
            return None
        if key not in self._kept:
            self._kept[key] = _made(hypothesis, scene, point, compiled)
            while len(self._kept) > KEPT:
                self._kept.popitem(last=False)
        self._kept.move_to_end(key)
        found = self._kept[key]
        if found is not None:
            found.uses += 1
            if found.uses > 1 and found.uses & (found.uses - 1) == 0:
                beside = _moved(hypothesis, point, 1.0)
                if _agrees(found, hypothesis, scene, beside, compiled) is False:
                    found = self._kept[key] = None
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


def _moved(hypothesis: Hypothesis, point: FloatArray, far: float) -> FloatArray:
    """A point beside another one at which no two coordinates have moved alike."""
    part = np.array([(k * GOLDEN) % 1.0 for k in range(1, len(point) + 1)])
    return hypothesis.clipped(point + far * (1.0 + part) * hypothesis.steps(point))


def _made(hypothesis: Hypothesis, scene: Scene, point: FloatArray, compiled: Compile) -> Template | None:
    """A template recorded beside a point and checked farther off."""
    here, elsewhere = _moved(hypothesis, point, 1.0), _moved(hypothesis, point, 2.7)
    values, others = (hypothesis.values(z, to_run=True) for z in (here, elsewhere))
    if any(values[path] == others[path] for path in values):
        return None
    tape = Tape()
    tracked = {path: tape.start(path, value) for path, value in values.items()}
    try:
        network = hypothesis.with_values(scene, tracked).network()
        line = compiled(network)
    except Exception:  # whatever a law of one's own makes of such numbers: what is wrong with it shows where it is built without
        return None
    if line is None or tape.lost is not None or any(type(state.initial) is Tracked for state in network.states):
        return None
    made = Template(tape, line, tuple(values))
    return made if _agrees(made, hypothesis, scene, elsewhere, compiled) else None


def _agrees(template: Template, hypothesis: Hypothesis, scene: Scene, point: FloatArray, compiled: Compile) -> bool | None:
    """Whether the template gives the line that is built for a point; None where it says that it has none there."""
    values = hypothesis.values(point, to_run=True)
    [line] = template.lines([values])
    if line is None:
        return None
    try:
        built = compiled(hypothesis.with_values(scene, values).network())
    except HdriveError:
        built = None
    return built is not None and alike(line.program, built.program) and line.program.inputs == built.program.inputs

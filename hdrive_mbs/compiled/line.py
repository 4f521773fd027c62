"""Networks as machine code: many runs of the same equations with other numbers."""

from __future__ import annotations

import functools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.compiled.equations import accelerations
from hdrive_mbs.compiled.lanes import Lanes, run_lanes
from hdrive_mbs.compiled.machine import processor
from hdrive_mbs.compiled.program import program
from hdrive_mbs.compiled.readings import readings
from hdrive_mbs.compiled.slowed import Slowed, slowed_accelerations
from hdrive_mbs.compiled.structure import Structure
from hdrive_mbs.compiled.threads import side_by_side
from hdrive_mbs.errors import ParameterError, SimulationError
from hdrive_mbs.expression import Expression, Value, record, trace, variable
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.network import Network

FloatArray = npt.NDArray[np.float64]
Values = Mapping[str, float]


@dataclass(frozen=True, eq=False)
class CompiledRun:
    """Samples of a run: times [s], shape (n,), and channel -> values, shape (n,)."""

    times: FloatArray
    values: Mapping[str, FloatArray]


class CompiledLine:
    """The equations of a network and some of its channels, ready to be run as machine code.

    A network whose laws have the same form as an earlier one's, with other numbers, takes the code that is there.
    :func:`run_many` runs many such lines at once.

    channels : names of what a run returns (angles, speeds, torques, readings; accelerations are rates of speeds)
    slowed : vibrations that are slowed, see ``slowed_vibrations``; none if not given

    Raises TraceError for a law that cannot be recorded, and ParameterError for a network whose equations cannot be compiled.
    """

    def __init__(self, network: Network, channels: Sequence[str], slowed: Sequence[Slowed] = ()) -> None:
        self.network, self.channels = network, tuple(channels)
        self.names = tuple(body.name for body in network.bodies)
        states = [state.name for state in network.states]
        variables = ["t", *(f"angle:{name}" for name in self.names), *(f"speed:{name}" for name in self.names)]
        variables += [f"state:{name}" for name in states]
        moment = self._recording()
        found = functools.cache(lambda: slowed_accelerations(accelerations(network, moment), slowed))
        read = _recorded(lambda: readings(network, self.channels, moment, found))
        rates = _recorded(lambda: [moment.speed(n) for n in self.names] + [found()[name] for name in (*self.names, *states)])
        self.program = program(rates, read, variables)

    @property
    def structure(self) -> Structure:
        """What the equations compute, without the numbers: lines with equal structures share one code."""
        return self.program.structure

    def _recording(self) -> Moment:
        time = variable("t")
        angles = {name: variable(f"angle:{name}") for name in self.names}
        speeds = {name: variable(f"speed:{name}") for name in self.names}
        states = {state.name: variable(f"state:{state.name}") for state in self.network.states}
        return self.network.moment(time, angles, speeds, states)

    def run(
        self,
        samples: int,
        every: float,
        *,
        step: float,
        start: float = 0.0,
        angles: Values | None = None,
        speeds: Values | None = None,
        states: Values | None = None,
    ) -> CompiledRun:
        """Integrate by the classical Runge-Kutta method; forward angles and speeds and states at the start, 0 if not given.

        samples, every : number and distance [s] of the samples;  step : longest step of the integration [s]

        Raises SimulationError where values stop being finite.
        """
        [found] = run_many([self], samples, every, step=step, start=start, angles=angles, speeds=speeds, states=states)
        if isinstance(found, SimulationError):
            raise found
        return found

    def initial(self, angles: Values | None, speeds: Values | None, states: Values | None) -> list[float]:
        """The state at the start from what is given of it."""
        found = [(angles or {}).get(name, 0.0) for name in self.names] + [(speeds or {}).get(name, 0.0) for name in self.names]
        return found + [(states or {}).get(state.name, state.initial) for state in self.network.states]


def run_many(
    lines: Sequence[CompiledLine],
    samples: int | Sequence[int],
    every: float,
    *,
    step: float,
    start: float = 0.0,
    angles: Values | Sequence[Values] | None = None,
    speeds: Values | Sequence[Values] | None = None,
    states: Values | Sequence[Values] | None = None,
) -> list[CompiledRun | SimulationError]:
    """Run every line as ``CompiledLine.run`` does; lines of the same structure side by side in vector registers.

    samples : of all lines, or the number for each of them: the shorter ones go along to the end of the longest beside them
    angles, speeds, states : at the start, for all lines, or one mapping for each of them

    Returns a run for each line, or the SimulationError of a line whose values stop being finite; the others go on.
    """
    counts = [samples] * len(lines) if isinstance(samples, int) else list(samples)
    if not (every > 0.0 and step > 0.0 and min(counts, default=1) >= 1):
        raise ParameterError(f"samples = {min(counts)}, every = {every:g} s, step = {step:g} s: must be greater than 0.")
    if len(counts) != len(lines):
        raise ParameterError(f"{len(counts)} numbers of samples for {len(lines)} lines; give one for all or one for each.")
    inner = max(1, math.ceil(every / step * (1.0 - 1e-9)))
    given = [_for_each(item, name, len(lines)) for item, name in ((angles, "angles"), (speeds, "speeds"), (states, "states"))]
    initial = [np.array(line.initial(*values), float) for line, *values in zip(lines, *given, strict=True)]
    groups: dict[Structure, list[int]] = {}
    for k, line in enumerate(lines):
        groups.setdefault(line.structure, []).append(k)
    for group in groups.values():
        group.sort(key=lambda k: -counts[k])
    times = np.asarray(start + every * np.arange(max(counts, default=0)), float)
    found: dict[int, CompiledRun | SimulationError] = {}
    lanes, wide = processor().lanes, processor().wide
    parts = [group[first : first + wide] for group in groups.values() for first in range(0, len(group), wide)]
    # one line alone takes as long in all lanes as in one, and needs no machine code of its own
    prepared = [Lanes([lines[k].program for k in part], lanes if len(part) <= lanes else wide) for part in parts]

    def run(number: int) -> tuple[FloatArray, npt.NDArray[np.int64]]:
        part = parts[number]
        return run_lanes(prepared[number], np.array([initial[k] for k in part]), counts[part[0]], every, inner, start)

    for part, (out, good) in zip(parts, side_by_side(run, range(len(parts))), strict=True):
        for lane, k in enumerate(part):
            if good[lane] < counts[k]:
                found[k] = _not_finite(start + int(good[lane]) * every, every / inner)
            else:
                values = {name: out[i, lane, : counts[k]] for i, name in enumerate(lines[k].channels)}
                found[k] = CompiledRun(times[: counts[k]], values)
    return [found[k] for k in range(len(lines))]


def _for_each(given: Values | Sequence[Values] | None, name: str, count: int) -> Sequence[Values | None]:
    if given is None or isinstance(given, Mapping):
        return [given] * count
    if len(given) != count:
        raise ParameterError(f"{len(given)} mappings of {name} for {count} lines; give one for all or one for each.")
    return given


def _not_finite(time: float, step: float) -> SimulationError:
    return SimulationError(f"The compiled run is not finite from t = {time:.6g} s on (step {step:.3g} s). Use a shorter step.")


def _recorded(make: object) -> list[Expression]:
    found: list[Value] = []

    def total() -> Value:
        found.extend(make())  # type: ignore[operator]
        return 0.0

    trace(total)
    return [record(value) for value in found]

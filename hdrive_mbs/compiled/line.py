"""A network as machine code: many runs of the same equations with other numbers."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.compiled.machine import machine, pointer
from hdrive_mbs.compiled.program import Program, program
from hdrive_mbs.errors import ParameterError, SimulationError, unknown_place
from hdrive_mbs.expression import Expression, Value, record, trace, variable
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.network import Network

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class CompiledRun:
    """Samples of a run: times [s], shape (n,), and channel -> values, shape (n,)."""

    times: FloatArray
    values: Mapping[str, FloatArray]


class CompiledLine:
    """The equations of a network and some of its channels, compiled.

    A network whose laws have the same form as an earlier one's, with other numbers, takes the code that is there:
    making this object then costs some milliseconds, a run some ten nanoseconds per operation.

    channels : names of what a run returns (angles, speeds, torques, readings; accelerations are rates of speeds)

    Raises TraceError for a law that cannot be recorded, ParameterError for a rotor line, whose masses depend on its
    state: those run on the engine.
    """

    def __init__(self, network: Network, channels: Sequence[str]) -> None:
        if network.is_coupled:
            raise ParameterError("A line with rotors or matrices of mass cannot be compiled; simulate it on the engine.")
        self.network, self.channels = network, tuple(channels)
        self._names = [body.name for body in network.bodies]
        states = [state.name for state in network.states]
        variables = ["t", *(f"angle:{name}" for name in self._names), *(f"speed:{name}" for name in self._names)]
        variables += [f"state:{name}" for name in states]
        known = {channel.name: channel for channel in network.channels}
        for name in self.channels:
            if name not in known:
                raise unknown_place("channel", name, known, "This scene")

        def rates(moment: Moment) -> list[Value]:
            found = network.accelerations(moment)
            return [moment.speed(name) for name in self._names] + [found[name] for name in (*self._names, *states)]

        moment = self._recording()
        self._rates = program(_recorded(lambda: rates(moment)), variables)
        self._read = program(_recorded(lambda: [known[name].read(moment) for name in self.channels]), variables)
        self._machine = machine(self._rates.structure, self._read.structure)

    def _recording(self) -> Moment:
        time = variable("t")
        angles = {name: variable(f"angle:{name}") for name in self._names}
        speeds = {name: variable(f"speed:{name}") for name in self._names}
        states = {state.name: variable(f"state:{state.name}") for state in self.network.states}
        return self.network.moment(time, angles, speeds, states)

    def run(
        self,
        samples: int,
        every: float,
        *,
        step: float,
        start: float = 0.0,
        angles: Mapping[str, float] | None = None,
        speeds: Mapping[str, float] | None = None,
        states: Mapping[str, float] | None = None,
    ) -> CompiledRun:
        """Integrate by the classical Runge-Kutta method; forward angles and speeds and states at the start, 0 if not given.

        samples, every : number and distance [s] of the samples;  step : longest step of the integration [s]

        Raises SimulationError where values stop being finite.
        """
        if not (every > 0.0 and step > 0.0 and samples >= 1):
            raise ParameterError(f"samples = {samples}, every = {every:g} s, step = {step:g} s: must be greater than 0.")
        inner = max(1, math.ceil(every / step * (1.0 - 1e-9)))
        given = [(angles or {}).get(name, 0.0) for name in self._names] + [(speeds or {}).get(name, 0.0) for name in self._names]
        given += [(states or {}).get(state.name, state.initial) for state in self.network.states]
        y = np.array(given, float)
        path = np.empty((samples, len(y)))
        done = self._machine.run(
            pointer(y), start, every / inner, inner, samples, pointer(self._rates.constants), pointer(self._rates.tables), pointer(path)
        )
        if done < samples:
            raise SimulationError(
                f"The compiled run is not finite from t = {start + done * every:.6g} s on (step {every / inner:.3g} s). Use a shorter step."
            )
        times = np.asarray(start + every * np.arange(samples), float)
        return CompiledRun(times, self._observed(path, start, every))

    def _observed(self, path: FloatArray, start: float, every: float) -> dict[str, FloatArray]:
        out = np.empty((len(path), max(1, len(self.channels))))
        read: Program = self._read
        self._machine.observe(start, every, len(path), pointer(path), pointer(read.constants), pointer(read.tables), pointer(out))
        return {name: out[:, k] for k, name in enumerate(self.channels)}


def _recorded(make: object) -> list[Expression]:
    found: list[Value] = []

    def total() -> Value:
        found.extend(make())  # type: ignore[operator]
        return 0.0

    trace(total)
    return [record(value) for value in found]

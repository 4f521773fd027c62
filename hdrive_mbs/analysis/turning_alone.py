"""The turning of a line run alone, without lateral motion: quick, and nearly what it does in the whole line."""

from __future__ import annotations

import warnings
from collections.abc import Mapping

import numpy as np

from hdrive_mbs.analysis.initial_values import initial_values
from hdrive_mbs.engine.assembly import LoweringWarning, assemble
from hdrive_mbs.engine.simulation import run
from hdrive_mbs.engine.solvers import Trapezoidal
from hdrive_mbs.errors import SimulationError
from hdrive_mbs.network.network import Network
from hdrive_mbs.signals import FloatArray

STEPS = 2000
"""Steps of the run that the highest speeds are read from."""


class TurningAlone:
    """What turns in a line, assembled once and run with any number of steps of the trapezoidal rule.

    duration : s;  initial_speed : of the reference shaft [rad/s];  initial : start values by the names of channels, as for simulate
    """

    def __init__(self, network: Network, duration: float, initial_speed: float, initial: Mapping[str, float] | None = None) -> None:
        self.duration = duration
        turning = network.turning()
        self.motions = {item.name: item.speed for item in network.motions if item.name != "ground"}
        self.places = {node: place for place, node in reversed(list(network.places.items()))}
        self.bodies = tuple(body.name for body in turning.bodies)
        starts = initial_values(network, initial_speed, initial or {})
        names = {"angles": self.bodies, "speeds": self.bodies, "states": tuple(state.name for state in turning.states)}
        self._start = [{name: starts[kind][name] for name in wanted} for kind, wanted in names.items()]
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", LoweringWarning)  # the run itself says it
            self._assembly = assemble(turning) if turning.bodies else None

    def speeds(self, steps: int, newton_tolerance: float = 1e-6) -> tuple[FloatArray, dict[str, FloatArray]]:
        """Times [s] and the speed of each spin there [rad/s, forward], shapes (steps + 1,).

        The engine takes shorter steps where Newton's method does not converge: then there are more of them.  Raises
        SimulationError where that does not help.
        """
        times, free = np.linspace(0.0, self.duration, steps + 1), dict[str, FloatArray]()
        if self._assembly is not None:
            solver = Trapezoidal(step=self.duration / steps, newton_tolerance=newton_tolerance)
            angles, speeds, states = self._start
            raw = run(self._assembly, duration=self.duration, solver=solver, angles=angles, speeds=speeds, states=states)
            times, free = raw.times, {name: raw.speeds[name] for name in self.bodies}
        prescribed = {name: np.broadcast_to(np.asarray(speed(times), float), times.shape) for name, speed in self.motions.items()}
        return times, prescribed | free

    def fastest(self) -> dict[str, float]:
        """Highest speed of each spin [rad/s, size]: whirl only takes energy from it, so nothing in the line turns faster.

        Bearing friction is left out: an upper limit again.  Torsional vibrations that are quicker than a two-thousandth of
        the run count roughly.  Raises SimulationError where even this run fails.
        """
        steps = STEPS
        while True:
            try:
                return {name: float(np.max(np.abs(values))) for name, values in self.speeds(steps)[1].items()}
            except SimulationError:
                steps *= 10
                if steps > 100 * STEPS:
                    raise

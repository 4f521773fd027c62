"""One scenario with one law and one solver: steps, CPU time and torques."""

from __future__ import annotations

import statistics
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

import hdrive_mbs as hm
from hdrive_mbs.engine.assembly import assemble
from hdrive_mbs.engine.simulation import run
from hdrive_mbs.errors import SimulationError
from models.harmonic_drive_train import RATIO, build

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Measured:
    """What a run did.  ``failure`` is empty if it reached its end; else the numbers are NaN.

    elastic : torque of the law [N m] at the solver's own times
    output : spring torque of the output shaft [N m]
    pulses : passages from inside the gap to outside
    """

    duration: float
    seconds: float
    steps: int
    rejected: int
    times: FloatArray
    elastic: FloatArray
    output: FloatArray
    output_twist: FloatArray
    load_speed: FloatArray
    pulses: int
    failure: str = ""

    def numbers(self) -> dict[str, float | str]:
        """The figures for the table, per simulated second where that makes sense."""
        if self.failure:
            return {"failure": self.failure}
        lengths = np.diff(self.times)[:-1]  # the last one is cut to end in time
        late = self.times >= 0.5 * self.duration
        return {
            "simulated_seconds": self.duration,
            "steps_per_second": self.steps / self.duration,
            "rejected_per_second": self.rejected / self.duration,
            "cpu_per_second": self.seconds / self.duration,
            "median_step": float(np.median(lengths)),
            "shortest_step": float(np.min(lengths)),
            "pulses_per_second": self.pulses / self.duration,
            "smallest_torque": float(np.min(self.elastic[late])),
            "largest_torque": float(np.max(self.elastic[late])),
            "final_load_speed": float(self.load_speed[-1]),
        }


def steady_start(law: hm.StiffnessLaw, load: hm.LoadLaw) -> dict[str, Mapping[str, float]]:
    """Angles and speeds of steady running under the load at t = 0.

    A jump law cannot balance a load below M_A; it starts at the edge of its gap.
    """
    scene = build(law, load)
    torque = float(load.torque(0.0, 0.0, 0.0))
    k_in, k_out = (scene.parts[name].stiffness for name in ("input_shaft", "output_shaft"))  # type: ignore[attr-defined]
    generator = -torque / RATIO / k_in
    flexspline = generator / RATIO - float(law.twist(torque))
    curve = scene.parts["motor"].characteristic  # type: ignore[attr-defined]
    speed = _balanced(curve, torque / RATIO)
    return {
        "angles": {
            "motor": 0.0,
            "gear.wave_generator": generator,
            "gear.flexspline": flexspline,
            "load": flexspline - torque / k_out,
        },
        "speeds": {"motor": speed, "gear.wave_generator": speed, "gear.flexspline": speed / RATIO, "load": speed / RATIO},
    }


def _balanced(curve: hm.AsynchronousMotor, torque: float) -> float:
    """Speed at which the motor gives this torque, on its stable branch."""
    from scipy.optimize import brentq

    low, high = curve.synchronous_speed * (1.0 - curve.breakdown_slip), curve.synchronous_speed
    return float(brentq(lambda w: float(curve.torque(0.0, w)) - torque, low, high, xtol=1e-13))


REST: dict[str, Mapping[str, float]] = {"angles": {}, "speeds": {}}


def measure(
    law: hm.StiffnessLaw,
    load: hm.LoadLaw,
    solver: hm.Solver,
    duration: float,
    *,
    start: Mapping[str, Mapping[str, float]] | None = None,
    repeats: int = 1,
    damping_in_gap: bool = True,
) -> Measured:
    """Run the train; ``start`` is steady running if not given.  CPU time is the median of the repeats."""
    scene = build(law, load).replacing({"gear.damping_in_gap": damping_in_gap})
    begin = start if start is not None else steady_start(law, load)
    assembly = assemble(scene.network())
    seconds = []
    for _ in range(repeats):
        try:
            raw = run(assembly, duration=duration, solver=solver, angles=begin["angles"], speeds=begin["speeds"], states={})
        except SimulationError as error:
            none = np.zeros(0)
            return Measured(duration, np.nan, 0, 0, none, none, none, none, none, 0, failure=str(error).split(" with ")[0])
        seconds.append(raw.seconds)
    twist = raw.angles["gear.wave_generator"] / RATIO - raw.angles["gear.flexspline"]
    outside = np.abs(twist) > law.half_gap
    output_twist = raw.angles["gear.flexspline"] - raw.angles["load"]
    return Measured(
        duration=duration,
        seconds=statistics.median(seconds),
        steps=raw.steps,
        rejected=raw.rejected,
        times=raw.times,
        elastic=np.asarray(law.torque(twist), float),
        output=scene.parts["output_shaft"].stiffness * output_twist,  # type: ignore[attr-defined]
        output_twist=output_twist,
        load_speed=raw.speeds["load"],
        pulses=int(np.sum(outside[1:] & ~outside[:-1])),
    )

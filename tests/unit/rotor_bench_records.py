"""Records of the rotor bench from compiled runs, for tests of its diagnosis."""

from __future__ import annotations

import functools

import numpy as np

import hdrive_mbs as hm
from hdrive_mbs.compiled.equilibrium import equilibria
from hdrive_mbs.compiled.idle_coordinates import without_idle
from hdrive_mbs.compiled.line import CompiledLine
from hdrive_mbs.diagnosis.unknowns import Factor
from hdrive_mbs.records.measurement import Measurement
from hdrive_mbs.records.record import Record
from models import rotor_bench

UNITS = {"motor_torque": "N m", "spin_angle": "rad", **dict.fromkeys(rotor_bench.PROBES, "m")}
PROBE = 3e-4
"""m; an offset of probes."""


@functools.cache
def bench() -> rotor_bench.RotorBench:
    return rotor_bench.bench()


def factors(*names: str) -> tuple[Factor, ...]:
    known = {name: bench().knowledge[name] for name in names}
    return tuple(
        Factor(path=item.paths[0], name=name, nominal=dict(zip(item.paths, bench().nominal(name), strict=True)), sigma=item.sigma)
        for name, item in known.items()
    )


def recorded(name: str, columns: dict[str, np.ndarray], *, noisy: bool) -> Record:
    """A record of the bench from what its channels are: with offsets of probes, noise and rounding of the data sheet."""
    rng = np.random.default_rng(sum(name.encode()))
    channels = {}
    for column, values in columns.items():
        seen = values + PROBE if column in rotor_bench.PROBES else values
        if noisy:
            seen = seen + rotor_bench.NOISE[column] * rng.standard_normal(len(values))
            step = rotor_bench.RESOLUTION[column]
            seen = step * np.round(seen / step)
        channels[column] = Measurement(name=column, unit=UNITS.get(column, "m/s^2"), values=seen)
    times = rotor_bench.SAMPLE_TIME * np.arange(len(next(iter(columns.values()))))
    return Record(name=name, times=times, channels=channels)


def compiled(name: str, duration: float, scene: hm.Scene | None = None) -> dict[str, np.ndarray]:
    """Columns of a record from a compiled run under the controller, from rest in the static deflection."""
    scene = rotor_bench.build(name) if scene is None else scene
    columns = {item.channel: column for column, item in bench().measured.items()}
    line = CompiledLine(without_idle(scene.network()), list(columns))
    [rest] = equilibria([line])
    speeds = dict.fromkeys(rotor_bench.POSITIONS, rotor_bench.REFERENCES[name][1][0])
    run = line.run(round(duration / rotor_bench.SAMPLE_TIME), rotor_bench.SAMPLE_TIME, step=1.0 / 24000.0, angles=rest, speeds=speeds)
    return {columns[channel]: values for channel, values in run.values.items()}

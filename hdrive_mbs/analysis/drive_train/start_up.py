"""Start-up from rest: time response and the figures that a designer asks for."""

from __future__ import annotations

import dataclasses
import threading
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from hdrive_mbs.analysis.coarse_step import warn_of
from hdrive_mbs.analysis.drive_train.elastic_law import elastic_laws
from hdrive_mbs.analysis.time_response import Response, integrate
from hdrive_mbs.components.motor import Motor
from hdrive_mbs.engine.solvers import Solver
from hdrive_mbs.errors import SceneError
from hdrive_mbs.printed_table import PrintedTable
from hdrive_mbs.scene import Scene
from hdrive_mbs.signals import FloatArray, TimeHistory

RISEN = 0.95
"""Share of the final speed that counts as started."""

LAST_PART = 0.1
"""Share of the run at its end over which final values are averaged."""

STEADY = 0.01
"""Largest change of the mean speed from the last but one to the last tenth of the run that counts as steady."""


@dataclass(frozen=True, kw_only=True, eq=False)
class StartUp(Response):
    """A response from rest, with its figures.

    motor : the motor whose speed is meant
    final_speed : mean speed of the motor over the last tenth of the run [rad/s], true sense
    rise_time : when the motor first reaches 95 % of it [s]; NaN if it does not start
    overshoot : largest speed over final speed, less 1
    peak_torque : connection -> torque of largest size [N m], with its sign
    peak_time : connection -> when [s]
    final_torque : connection -> mean torque over the last tenth of the run [N m]
    peak_motor_torque : air-gap torque of largest size [N m]; NaN for a motor without one
    take_up_time : connection with lost motion -> when it first carries torque [s]; NaN if never
    """

    motor: str
    final_speed: float
    rise_time: float
    overshoot: float
    peak_torque: Mapping[str, float]
    peak_time: Mapping[str, float]
    final_torque: Mapping[str, float]
    peak_motor_torque: float
    take_up_time: Mapping[str, float]

    def tables(self) -> tuple[PrintedTable, ...]:
        """The figures of the start: of the motor, and of each connection."""
        figures = {
            f"final speed of {self.motor} [rad/s]": self.final_speed,
            "rise time to 95 % of it [s]": self.rise_time,
            "overshoot [%]": 100.0 * self.overshoot,
            "peak of the motor's torque [N m]": self.peak_motor_torque,
        }
        rows = [
            (name, torque, self.peak_time[name], self.final_torque[name], self.take_up_time.get(name, "-"))
            for name, torque in self.peak_torque.items()
        ]
        heads = ("connection", "peak torque [N m]", "at [s]", "final torque [N m]", "carries torque from [s]")
        return (PrintedTable(heads=("figure", "value"), rows=tuple(figures.items())), PrintedTable(heads=heads, rows=tuple(rows)))


def start_up(
    scene: Scene,
    duration: float,
    *,
    motor: str | None = None,
    solver: Solver | None = None,
    estimate_error: bool = False,
    progress: bool | None = None,
    cancel: threading.Event | None = None,
) -> StartUp:
    """Simulate from rest (all angles and speeds zero: in the middle of the lost motion) and read the figures.

    duration : s, long enough to reach a steady speed; the status says so if it was not
    motor : name of the motor; the only one if not given
    Peaks are the largest values at the solver's own times.  Take-up is the moment at which the twist
    leaves the gap of the elastic law; damping inside the gap, which gives a small torque before, does
    not count.
    """
    name = _motor(scene, motor)
    response = integrate(scene, duration, solver=solver, estimate_error=estimate_error, progress=progress, cancel=cancel)
    warn_of(scene.name, response.status)
    speed = response[f"{name}.speed"]
    end = float(response.times[-1])
    final = _mean(speed, end * (1.0 - LAST_PART), end)
    before = _mean(speed, end * (1.0 - 2.0 * LAST_PART), end * (1.0 - LAST_PART))
    rise_time = _first_reached(speed, RISEN * final) if final != 0.0 else float("nan")
    laws = elastic_laws(scene.network())
    torques = {item: response[f"{item}.torque"] for item in laws}
    largest = {item: int(np.argmax(np.abs(history.values))) for item, history in torques.items()}
    gaps = {item: law.edges() for item, law in laws.items()}
    air_gap = f"{name}.torque"
    fields = {item.name: getattr(response, item.name) for item in dataclasses.fields(response)}
    return StartUp(
        **fields | {"status": _status(response.status, final, before), "settings": {**response.settings, "motor": name}},
        motor=name,
        final_speed=final,
        rise_time=rise_time,
        overshoot=max(float(np.max(speed.values * np.sign(final))) / abs(final) - 1.0, 0.0) if final != 0.0 else float("nan"),
        peak_torque={item: float(history.values[largest[item]]) for item, history in torques.items()},
        peak_time={item: float(response.times[k]) for item, k in largest.items()},
        final_torque={item: _mean(history, end * (1.0 - LAST_PART), end) for item, history in torques.items()},
        peak_motor_torque=_of_largest_size(response.values[air_gap]) if air_gap in response else float("nan"),
        take_up_time={item: _left(response[f"{item}.twist"], *gap) for item, gap in gaps.items() if gap[1] > gap[0]},
    )


def _motor(scene: Scene, motor: str | None) -> str:
    motors = [name for name, part in scene.parts.items() if isinstance(part, Motor)]
    if motor is not None:
        if motor not in motors:
            raise SceneError(f"{motor!r} is not a motor of this scene. Motors: {', '.join(motors) or 'none'}.")
        return motor
    if len(motors) != 1:
        raise SceneError(f"A start-up needs to know the motor; this scene has {', '.join(motors) or 'none'}. Give motor=...")
    return motors[0]


def _of_largest_size(values: FloatArray) -> float:
    return float(values[int(np.argmax(np.abs(values)))])


def _mean(history: TimeHistory, start: float, end: float) -> float:
    """Mean over a span, weighted by time."""
    times = np.concatenate([[start], history.times[(history.times > start) & (history.times < end)], [end]])
    return float(np.trapezoid(history.at(times), times) / (end - start))


def _first_reached(history: TimeHistory, level: float) -> float:
    """First time at which the size of the history reaches that of the level, in its direction."""
    sign = float(np.sign(level))
    reached = np.nonzero(sign * history.values >= sign * level)[0]
    if not len(reached):
        return float("nan")
    return _crossing(history, int(reached[0]), level)


def _left(twist: TimeHistory, lower: float, upper: float) -> float:
    """When the twist first leaves the gap."""
    outside = np.nonzero((twist.values < lower) | (twist.values > upper))[0]
    if not len(outside):
        return float("nan")
    k = int(outside[0])
    return _crossing(twist, k, upper if twist.values[k] > upper else lower)


def _crossing(history: TimeHistory, k: int, level: float) -> float:
    """When the (Hermite) history passes the level, in the step that ends at sample k."""
    from scipy.optimize import brentq

    if k == 0:
        return float(history.times[0])
    low, high = float(history.times[k - 1]), float(history.times[k])
    return float(brentq(lambda t: float(history.at(t)) - level, low, high, xtol=1e-15, rtol=1e-14))


def _status(status: str, final: float, before: float) -> str:
    if not status.startswith("complete"):
        return status
    if final == 0.0:
        return f"{status}; the motor does not start"
    change = abs(final - before) / abs(final)
    if change > STEADY:
        return f"{status}; not steady: the mean speed still changes by {100.0 * change:.2g} % in the last tenth, give a longer duration"
    return status

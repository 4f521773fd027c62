"""Analyses of a scene as figures: what one row of a campaign's table holds.  SI units; amplitudes are 0-peak."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from hdrive_mbs.errors import unknown_place
from hdrive_mbs.scene import Scene

Figures = dict[str, Any]


def modes(scene: Scene, *, torque: float | None = None, speed: float | None = None, count: int = 6) -> Figures:
    """Frequencies and damping ratios, those of a rotor line with the kind of whirl.

    torque : load torque [N m] in place of the scene's own
    speed : of the motor [rad/s]; by default where motor and load balance, of a rotor line 0
    count : number of modes
    """
    from hdrive_mbs.analysis.operating_point import with_load

    if scene.network().is_lateral:
        from hdrive_mbs.analysis.whirl.whirl_modes import whirl_modes

        whirl = whirl_modes(scene if torque is None else with_load(scene, torque), speed or 0.0, count=count)
        figures: Figures = {}
        for k, word in enumerate(whirl.whirl):
            figures |= {
                f"mode {k + 1} whirl": word,
                f"mode {k + 1} damped [rad/s]": float(whirl.frequencies[k]),
                f"mode {k + 1} damping ratio [1]": float(whirl.damping_ratios[k]),
            }
        return {**figures, "status": whirl.status}
    from hdrive_mbs.analysis.drive_train.modes import modes as torsional

    result = torsional(scene, torque=torque, motor_speed=speed)
    rows = {"undamped [rad/s]": result.undamped, "damped [rad/s]": result.damped, "damping ratio [1]": result.damping_ratio}
    found = {f"mode {k + 1} {name}": float(value) for name, values in rows.items() for k, value in enumerate(values[:count])}
    return {**dict(sorted(found.items(), key=lambda item: int(item[0].split()[1]))), "status": result.status}


def campbell(
    scene: Scene,
    *,
    speeds: Sequence[float] = tuple(np.linspace(0.0, 1000.0, 101)),
    orders: Sequence[float] | Mapping[str, Sequence[float]] = (1.0,),
    count: int | None = None,
) -> Figures:
    """Critical speeds of a rotor line with whirl and damping, and the lowest speed at which it becomes unstable.

    speeds : of the reference shaft [rad/s]
    orders : of its speed, or place -> orders
    count : number of branches, by default all that come near the highest order line
    """
    from hdrive_mbs.analysis.whirl.whirl_campbell import campbell as analyse

    result = analyse(scene, speeds, orders, count=count, progress=False)
    figures: Figures = {}
    for k, speed in enumerate(result.critical_speeds):
        figures |= {
            f"critical speed {k + 1} [rad/s]": float(speed),
            f"critical speed {k + 1} whirl": result.critical_whirl[k],
            f"critical speed {k + 1} damping ratio [1]": float(result.critical_damping_ratios[k]),
        }
    unstable = [speed for speed, note in zip(result.threshold_speeds, result.threshold_notes, strict=True) if note == "unstable above"]
    return {**figures, "unstable above [rad/s]": float(min(unstable, default=np.nan)), "status": result.status}


def run_up(
    scene: Scene,
    *,
    duration: float = 2.5,
    initial_speed: float = 0.0,
    accuracy: float = 1e-3,
    step: float | None = None,
    estimate_error: bool = False,
) -> Figures:
    """Peak whirl of each rotor and the speed there, and the final speed.

    duration : s
    initial_speed : rad/s
    accuracy : relative error of peaks that the step is chosen for
    step : of the trapezoidal rule [s] in place of that
    estimate_error : run again with half the step and state the error
    """
    from hdrive_mbs.analysis.run_up.run_up import run_up as analyse
    from hdrive_mbs.engine.solvers import Trapezoidal

    solver = None if step is None else Trapezoidal(step=step, newton_tolerance=min(max(0.01 * accuracy, 1e-10), 1e-5))
    result = analyse(
        scene, duration, solver=solver, accuracy=accuracy, initial_speed=initial_speed, estimate_error=estimate_error, progress=False
    )
    figures: Figures = {}
    for rotor in result.rotors:
        figures |= {
            f"{rotor} peak amplitude, 0-peak [m]": result.peak_amplitude[rotor],
            f"{rotor} speed at peak [rad/s]": result.peak_speed[rotor],
        }
        if rotor in result.peak_error:
            figures[f"{rotor} estimated relative error [1]"] = result.peak_error[rotor]
    return {**figures, "final speed [rad/s]": result.final_speed, "captured": result.captured, "status": result.status}


def start_up(scene: Scene, *, duration: float = 1.0, estimate_error: bool = False) -> Figures:
    """Final speed, rise time and overshoot of a train started from rest, and the largest torque of each connection.

    duration : s
    estimate_error : run again finer, for the status
    """
    from hdrive_mbs.analysis.drive_train.start_up import start_up as analyse

    result = analyse(scene, duration, estimate_error=estimate_error, progress=False)
    torques = {f"{name} peak torque [N m]": value for name, value in result.peak_torque.items()}
    return {
        "final speed [rad/s]": result.final_speed,
        "rise time [s]": result.rise_time,
        "overshoot [1]": result.overshoot,
        **torques,
        "status": result.status,
    }


ANALYSES: dict[str, Callable[..., Figures]] = {"modes": modes, "campbell": campbell, "run_up": run_up, "start_up": start_up}
"""By name, for SceneAnalysis and the command line."""


def analysis_of(name: str) -> Callable[..., Figures]:
    """The analysis of that name."""
    if name not in ANALYSES:
        raise unknown_place("analysis", name, ANALYSES, "A sweep")
    return ANALYSES[name]

"""Run-up and coast-down: a line driven by its torque, whose unbalance acts back on the spin."""

from __future__ import annotations

import dataclasses
import math
import threading
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from hdrive_mbs.analysis.coarse_step import warn_of
from hdrive_mbs.analysis.run_up.rest_positions import FreeLine, RestPositions, without_drive
from hdrive_mbs.analysis.run_up.run_up_figures import LineFigures, line_figures
from hdrive_mbs.analysis.run_up.run_up_start import Start, oil_films, starts
from hdrive_mbs.analysis.run_up.run_up_status import status
from hdrive_mbs.analysis.run_up.run_up_step import NEAR, choose_step, reference_speed
from hdrive_mbs.analysis.run_up.speed_peaks import SpeedPeak
from hdrive_mbs.analysis.time_response import Response, integrate
from hdrive_mbs.analysis.torsional_step import OF_SPEEDS, torsional_step
from hdrive_mbs.analysis.turning_alone import TurningAlone
from hdrive_mbs.analysis.unbalance.synchronous_whirl import CriticalSpeed, critical_speeds
from hdrive_mbs.analysis.whirl.rotor_places import reference_shaft, rotor_masses, spin_ratios
from hdrive_mbs.engine.solvers import Solver, Trapezoidal
from hdrive_mbs.errors import AnalysisError, ParameterError, SimulationError, unknown_place
from hdrive_mbs.network.network import Network
from hdrive_mbs.network.rigid_mass import NOTHING, RigidMass
from hdrive_mbs.printed_table import PrintedTable
from hdrive_mbs.scene import Scene
from hdrive_mbs.signals import FloatArray

FALLEN = 0.01
"""A coast-down that loses less than this share of its speed has nothing that brakes it."""


@dataclass(frozen=True, kw_only=True, eq=False)
class RunUp(Response):
    """A run through critical speeds, with its figures.  Every amplitude is 0-peak, every speed in true sense.

    C is the geometric centre of a rotor, P its centre of mass.  Whirl counts from the static deflection (the channels
    ``<rotor>.whirl`` and ``<rotor>.mass_centre_whirl``), a distance from the axis (``<rotor>.radial`` and
    ``<rotor>.mass_centre_radial``).  Both are the same without weight.

    rotors : names of the rotors (or of the places asked for)
    reference : place whose speed the line is judged by
    peak_amplitude, peak_speed, peak_time : rotor -> largest whirl of C [m], its speed [rad/s] and time [s] then; after the
        first revolution of the rotor, in which a journal lifts off or a start rings (of the whole run if it turns less)
    mass_centre_amplitude, mass_centre_speed, mass_centre_time : the same of P
    peak_distance : rotor -> largest distance of C from the axis [m], from the start on
    maxima : rotor -> rows of (speed, amplitude, time, prominence, critical speed), see ``peaks``
    final_speed : of the reference at the end: parabola through the last two revolutions [rad/s]
    final_speeds : rotor -> the same
    critical_speeds : undamped, of the reference, excited by the unbalance, as far as the run could meet them [rad/s]; none
        with oil films, whose stiffness changes with the speed and whose damping and cross terms make the critical speeds
        (``campbell`` has them all in it)
    captured : whether the spin stays below a speed that its drive would reach, because whirl takes the torque
    acceleration : mean over the last part of the run [rad/s^2]
    applied_torque, whirl_torque : mean torque of drive, loads and drag over the last part, and what whirl takes of
        it [N m, on the reference]; NaN for a prescribed motion
    driven_speed : speed at which the applied torque would vanish without whirl [rad/s]; infinite if it goes on driving
    static_deflection : rotor -> rows of speeds of the reference [rad/s], x and y of C [m]; one column if it is the same at all
    peak_error : rotor -> estimated relative error of peak_amplitude (empty if not asked for)
    """

    rotors: tuple[str, ...]
    reference: str
    peak_amplitude: Mapping[str, float]
    peak_speed: Mapping[str, float]
    peak_time: Mapping[str, float]
    mass_centre_amplitude: Mapping[str, float]
    mass_centre_speed: Mapping[str, float]
    mass_centre_time: Mapping[str, float]
    peak_distance: Mapping[str, float]
    maxima: Mapping[str, FloatArray]
    final_speed: float
    final_speeds: Mapping[str, float]
    critical_speeds: FloatArray
    captured: bool
    acceleration: float
    applied_torque: float
    whirl_torque: float
    driven_speed: float
    static_deflection: Mapping[str, FloatArray]
    peak_error: Mapping[str, float]

    def tables(self) -> tuple[PrintedTable, ...]:
        """Peaks of each rotor, the final speed and the critical speeds."""
        heads = ["rotor", "peak of C, 0-peak [um]", "at [rad/s]", "at [s]", "peak of P, 0-peak [um]"]
        rows = [
            [
                rotor,
                1e6 * self.peak_amplitude[rotor],
                self.peak_speed[rotor],
                self.peak_time[rotor],
                1e6 * self.mass_centre_amplitude[rotor],
                *([100.0 * self.peak_error[rotor]] if self.peak_error else []),
            ]
            for rotor in self.rotors
        ]
        heads += ["estimated error of the peak of C [%]"] if self.peak_error else []
        criticals = ", ".join(f"{speed:.5g}" for speed in self.critical_speeds) or "none met"
        criticals = str(self.settings.get("critical_speeds", criticals))
        notes = (f"final speed {self.final_speed:.6g} rad/s; undamped critical speeds [rad/s]: {criticals}",)
        return (PrintedTable(heads=tuple(heads), rows=tuple(map(tuple, rows)), notes=notes),)

    def peaks(self, rotor: str) -> tuple[SpeedPeak, ...]:
        """Local maxima of the whirl of C over the run, in the order of time; beats after a critical speed are not counted."""
        if rotor not in self.maxima:
            raise unknown_place("rotor", rotor, self.maxima, "This run")
        return tuple(SpeedPeak(*row) for row in self.maxima[rotor].tolist())


def run_up(
    scene: Scene,
    duration: float,
    *,
    solver: Solver | None = None,
    accuracy: float = 1e-3,
    from_static: bool = True,
    initial_speed: float = 0.0,
    places: Sequence[str] | None = None,
    sample_step: float = 0.0,
    estimate_error: bool = False,
    progress: bool | None = None,
    cancel: threading.Event | None = None,
) -> RunUp:
    """Simulate a line driven by its own torque, and find the peaks of its rotors.

    duration : s
    solver : if not given, the trapezoidal rule with the step that ``accuracy`` asks for (see ``settings``)
    accuracy : relative error of peak amplitudes that is aimed at; speeds may be off by four times as much of the highest.
        The rule is calibrated for whirl in step with the spin, and its step is cut, as far as that is affordable, where a torsional
        vibration asks for it; where balls or teeth excite at a multiple of the spin, and for stiff nonlinear laws, look
        at estimate_error
    from_static : start in the static deflection at the initial speed and, if the line turns, on the steady orbits of
        the linearised line; else undeflected, which rings
    initial_speed : of the reference shaft [rad/s]; if 0, that of a prescribed motion at t = 0.  A line on oil films that
        cannot start from 0 starts at 0.1 rad/s, or at 1 rad/s, which the status says
    places : whose peaks are wanted; every rotor if not given
    sample_step : as for simulate
    estimate_error : run with half the step too, return that run and the error of its peaks from their difference
        (a third of it for the trapezoidal rule)

    Whirl counts from the static deflection of the balanced line, at the speed of that moment where it depends on
    speed.  A line without static deflection (a journal bearing at rest) is counted from the axis, which the status
    says.  Peaks are found between samples too (Hermite interpolation).

    Captured (Sommerfeld effect) is judged over the last tenth of the run: the spin gains less than 5 % of what its
    drive would give it without whirl, and without whirl it would run more than 2 % faster.  A line that creeps
    through its critical speed slower than that is called captured too: give a longer run.
    """
    return _run(scene, duration, solver, accuracy, from_static, initial_speed, places, sample_step, estimate_error, progress, cancel)


def coast_down(
    scene: Scene,
    duration: float,
    *,
    initial_speed: float,
    driven: bool = False,
    solver: Solver | None = None,
    accuracy: float = 1e-3,
    from_static: bool = True,
    places: Sequence[str] | None = None,
    sample_step: float = 0.0,
    estimate_error: bool = False,
    progress: bool | None = None,
    cancel: threading.Event | None = None,
) -> RunUp:
    """A run from a speed with the drive switched off: friction, drag, loads and whirl slow the line down.

    initial_speed : of the reference shaft [rad/s]
    driven : keep the torques of Motor and DriveTorque (a characteristic that brakes) instead of switching them off

    Other arguments and the result as for ``run_up``.
    """
    if initial_speed == 0.0:
        raise ParameterError("initial_speed = 0 rad/s: a coast-down needs a speed to fall from.")
    free = scene if driven else without_drive(scene)
    result = _run(free, duration, solver, accuracy, from_static, initial_speed, places, sample_step, estimate_error, progress, cancel)
    lost = 1.0 - result.final_speed / initial_speed
    if result.status.startswith("complete") and lost < FALLEN:
        note = f"the speed falls by only {100.0 * lost:.2g} %: nothing brakes the line, give it drag or a longer run"
        return dataclasses.replace(result, status=f"{result.status}; {note}")
    return result


def _run(
    scene: Scene,
    duration: float,
    solver: Solver | None,
    accuracy: float,
    from_static: bool,
    initial_speed: float,
    places: Sequence[str] | None,
    sample_step: float,
    estimate_error: bool,
    progress: bool | None,
    cancel: threading.Event | None,
) -> RunUp:
    if not (isinstance(duration, (int, float)) and math.isfinite(duration) and duration > 0.0):
        raise ParameterError(f"duration = {duration!r} s: must be greater than 0 s.")
    if not 1e-8 <= accuracy <= 0.1:
        raise ParameterError(f"accuracy = {accuracy:g}: must be between 1e-8 and 0.1 (relative error of peak amplitudes).")
    network, masses = scene.network(), _chosen(scene, places)
    line, ratios, reference, notes = FreeLine(scene), spin_ratios(scene), reference_shaft(scene), list[str]()
    initial_speed = initial_speed or _prescribed_speed(network)
    turning = TurningAlone(network, duration, initial_speed)
    fastest = turning.fastest()
    top = reference_speed(fastest, ratios) or 1.0
    criticals: tuple[CriticalSpeed, ...] = ()
    try:
        static = RestPositions.over(line, tuple(masses), top)
        found = critical_speeds(line.lines, static.points[-2], static.points[-1], tuple(masses))
        criticals = tuple(item for item in found if item.speed <= NEAR * top)
    except AnalysisError:
        static = RestPositions.none(tuple(masses))
        notes.append("there is no static deflection, so whirl counts from the axis")
    reason, given = "solver given", solver is not None
    if solver is None:
        moving = {body.name for body in network.bodies if body.lateral}
        whirling = {name: speed for name, speed in fastest.items() if f"{name}.x" in moving}
        chosen = choose_step(whirling, ratios, criticals, duration, accuracy, max(fastest.values(), default=0.0))
        cut = torsional_step(turning, chosen.step, OF_SPEEDS * accuracy, chosen.newton_tolerance)
        solver = Trapezoidal(step=cut.step, newton_tolerance=chosen.newton_tolerance)
        reason = "; ".join(filter(None, [chosen.reason, cut.reason]))
        notes += [cut.remark] if cut.remark else []

    films = oil_films(scene)
    told = () if films else criticals

    def once(with_solver: Solver, start: Start) -> tuple[Response, LineFigures]:
        response = integrate(
            scene,
            duration,
            solver=with_solver,
            initial_speed=start.speed,
            initial=start.values,
            sample_step=sample_step,
            progress=progress,
            cancel=cancel,
            judged=given,
        )
        return response, line_figures(network, response, reference, masses, static.table, [item.speed for item in told])

    failed: SimulationError | None = None
    for start in starts(scene, line, initial_speed, from_static=from_static):
        try:
            response, figures = once(solver, start)
        except SimulationError as error:
            failed = failed or error
            continue
        notes += [start.note] if start.note else []
        break
    else:
        assert failed is not None
        raise _from_rest(failed, scene, initial_speed)
    errors: dict[str, float] = {}
    if estimate_error and response.status.startswith("complete"):
        finer, better = once(solver.refined(), start)
        if finer.status.startswith("complete"):
            errors = _errors(figures, better, 1.0 if solver.adaptive else 2.0**solver.order - 1.0)
            if figures.captured != better.captured:
                notes.append("capture or passage depends on the step here: give a smaller accuracy")
            response, figures = finer, better
    warn_of(scene.name, response.status, stacklevel=2)
    if not np.any(response.values[f"{reference}.speed"]):
        notes.append("nothing turns the line: give it a DriveTorque or a Motor, or an initial_speed")
    settings: dict[str, object] = {"accuracy": accuracy, "from_static": from_static, "places": tuple(masses), "step": reason}
    if films:
        settings["critical_speeds"] = f"left out, as the film of {', '.join(films)} makes them another matter: see campbell"
    return _result(response, figures, reference, told, static, errors, settings, notes)


def _from_rest(error: SimulationError, scene: Scene, speed: float) -> SimulationError:
    """The error, with the way out where an oil film is run up from rest."""
    films = oil_films(scene) if speed == 0.0 else []
    if not films:
        return error
    hint = f"At rest the film of {', '.join(films)} carries nothing, and as it begins to, its damping jumps. "
    return SimulationError(f"{error} {hint}Start with more speed, initial_speed=10.0 (rad/s), give a shorter step, or from_static=False.")


def _prescribed_speed(network: Network) -> float:
    """Speed of the reference shaft at t = 0 that a prescribed motion asks for; 0 without one."""
    motion = next((item for item in network.motions if item.name != "ground" and item.ratio), None)
    return float(motion.sense * motion.speed(np.float64(0.0)) / motion.ratio) if motion else 0.0


def _chosen(scene: Scene, places: Sequence[str] | None) -> dict[str, RigidMass]:
    """Places whose peaks are wanted, with the mass of those that are rotors."""
    network = scene.network()
    if not network.is_lateral:
        raise AnalysisError(
            f"A run-up needs a line that moves laterally, but everything in {scene.name!r} only turns; use start_up, or "
            "build it of Rotor, ShaftSection and Bearing parts."
        )
    masses = rotor_masses(scene)
    known = [channel.name.removesuffix(".radial") for channel in network.channels if channel.name.endswith(".radial")]
    if places is not None:
        for place in places:
            if place not in known:
                raise unknown_place("place with lateral motion", place, known)
        return {place: masses.get(place, NOTHING) for place in places}
    chosen = {name: mass for name, mass in masses.items() if name in known}
    if not chosen:
        raise AnalysisError(f"{scene.name!r} has no rotor; name the places whose peaks are wanted. Places: {', '.join(known)}.")
    return chosen


def _errors(rough: LineFigures, fine: LineFigures, divisor: float) -> dict[str, float]:
    """Relative error of each peak of the finer run."""
    sizes = {name: (rough.rotors[name].centre.amplitude, rotor.centre.amplitude) for name, rotor in fine.rotors.items()}
    return {name: abs(before / after - 1.0) / divisor if after else 0.0 for name, (before, after) in sizes.items()}


def _result(
    response: Response,
    figures: LineFigures,
    reference: str,
    criticals: Sequence[CriticalSpeed],
    static: RestPositions,
    errors: Mapping[str, float],
    settings: Mapping[str, object],
    notes: Sequence[str],
) -> RunUp:
    rotors, balance, nan = figures.rotors, figures.balance, math.nan
    added = {f"{name}.{ending}": item for name, rotor in rotors.items() for ending, item in rotor.channels.items()}
    fields = {item.name: getattr(response, item.name) for item in dataclasses.fields(response)}
    fields["values"] = {**response.values, **{name: values for name, (values, _) in added.items()}}
    fields["units"] = {**response.units, **dict.fromkeys(added, "m")}
    fields["docs"] = {**response.docs, **{name: doc for name, (_, doc) in added.items()}}
    fields["settings"] = {**response.settings, **settings}
    fields["status"] = status(response, figures, criticals, notes)
    return RunUp(
        **fields,
        rotors=tuple(rotors),
        reference=reference,
        peak_amplitude={name: rotor.centre.amplitude for name, rotor in rotors.items()},
        peak_speed={name: rotor.centre.speed for name, rotor in rotors.items()},
        peak_time={name: rotor.centre.time for name, rotor in rotors.items()},
        mass_centre_amplitude={name: rotor.mass_centre.amplitude for name, rotor in rotors.items()},
        mass_centre_speed={name: rotor.mass_centre.speed for name, rotor in rotors.items()},
        mass_centre_time={name: rotor.mass_centre.time for name, rotor in rotors.items()},
        peak_distance={name: rotor.distance for name, rotor in rotors.items()},
        maxima={name: rotor.maxima for name, rotor in rotors.items()},
        final_speed=figures.final_speed,
        final_speeds={name: rotor.final_speed for name, rotor in rotors.items()},
        critical_speeds=np.array([item.speed for item in criticals]),
        captured=figures.captured,
        acceleration=balance.acceleration if balance else nan,
        applied_torque=balance.applied if balance else nan,
        whirl_torque=balance.whirl if balance else nan,
        driven_speed=balance.driven_speed if balance else nan,
        static_deflection=static.table,
        peak_error=dict(errors),
    )

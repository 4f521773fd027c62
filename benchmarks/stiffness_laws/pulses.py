"""Figs 9-10: load inside and above the gap torque, jump laws against continuous ones, explicit and implicit."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

import hdrive_mbs as hm
from benchmarks.stiffness_laws.claim import Claim, judged
from benchmarks.stiffness_laws.laws import CATALOGUE, CONTINUOUS, CUBIC, JUMP, LITERAL, SmoothedJump, laws
from benchmarks.stiffness_laws.measure import REST, Measured, measure, steady_start
from hdrive_mbs.engine.assembly import assemble
from hdrive_mbs.engine.simulation import run
from models.harmonic_drive_train import RATIO, build, load_above_gap, load_in_gap

SMOOTHED = "jump, drawn out"
RAMP_SHARE = 0.01
"""Width of the ramp of the drawn-out jump over half the lost motion."""

EXPLICIT = "explicit, adaptive"
FIXED = "explicit, fixed step"
IMPLICIT = "implicit"
SOLVERS: dict[str, hm.Solver] = {
    EXPLICIT: hm.DormandPrince(relative_tolerance=1e-6, absolute_tolerance=1e-8),
    FIXED: hm.RungeKutta4(step=2e-5),
    IMPLICIT: hm.Trapezoidal(step=1e-4),
}
COARSE = hm.DormandPrince(relative_tolerance=1e-4, absolute_tolerance=1e-6)


@dataclass(frozen=True)
class Durations:
    """Simulated seconds of each scenario; the jump law inside its gap costs minutes of CPU time for one second."""

    normal: float
    in_gap: float
    resonance: float
    contacts: float


FULL = Durations(normal=1.0, in_gap=0.02, resonance=0.3, contacts=2e-4)
QUICK = Durations(normal=0.02, in_gap=1e-3, resonance=0.05, contacts=3e-5)


@dataclass(frozen=True)
class Pulses:
    """All runs by (scenario, law, solver), and the sequence of contacts at the edge."""

    runs: dict[tuple[str, str, str], Measured]
    contacts: dict[str, Any]

    def numbers(self) -> dict[str, Any]:
        """For results.json."""
        return {
            "runs": {" / ".join(key): found.numbers() for key, found in self.runs.items()},
            "contacts": {name: value for name, value in self.contacts.items() if np.isscalar(value)},
        }


IN_GAP, ABOVE = "load in the gap torque", "load above it"
START_UP, RESONANCE, NO_DAMPING = "start-up, load above it", "load at the first mode", "in the gap torque, B_FS off in the gap"


def planned(durations: Durations, repeats: int) -> dict[tuple[str, str, str], Callable[[], Measured]]:
    """The runs, as functions to call."""
    found = laws()
    every = {**found, SMOOTHED: smoothed(found[JUMP])}
    plan: dict[tuple[str, str, str], Callable[[], Measured]] = {}

    def add(scenario: str, name: str, kind: str, load: hm.LoadLaw, duration: float, times: int = repeats, **options: Any) -> None:
        solver = SOLVERS.get(kind, COARSE)
        plan[scenario, name, kind] = lambda: measure(every[name], load, solver, duration, repeats=times, **options)

    for name in every:
        jumps = name in (JUMP, LITERAL)
        add(IN_GAP, name, EXPLICIT, load_in_gap(), durations.in_gap if jumps else durations.normal, 1 if jumps else repeats)
        for kind in (FIXED, IMPLICIT):
            add(IN_GAP, name, kind, load_in_gap(), durations.normal)
        for kind in (EXPLICIT, IMPLICIT) if name != SMOOTHED else ():
            add(ABOVE, name, kind, load_above_gap(), durations.normal)
    for name in (JUMP, LITERAL, CONTINUOUS, CATALOGUE):
        add(START_UP, name, EXPLICIT, load_above_gap(), durations.normal, 1, start=REST)
    for name in (JUMP, CONTINUOUS):
        add(NO_DAMPING, name, EXPLICIT, load_in_gap(), durations.in_gap, 1, damping_in_gap=False)
        add(RESONANCE, name, "explicit, coarse", at_resonance(), durations.resonance, 1)
    add(IN_GAP, JUMP, "explicit, coarse", load_in_gap(), durations.in_gap, 1)
    return plan


def smoothed(jump: hm.StiffnessLaw) -> SmoothedJump:
    """The jump law with its step drawn out over one hundredth of the half gap."""
    return SmoothedJump(jump=jump, width=RAMP_SHARE * jump.half_gap)


def at_resonance() -> hm.SineTorque:
    """The load above the gap torque, its 5 N m swinging with the first mode of the catalogue law."""
    first = float(hm.modes(build(), torque=20.0).undamped[0])
    return load_above_gap().replacing(frequency=first / (2.0 * math.pi))


# -- why: the sequence of contacts ------------------------------------------------------------------


def contacts(duration: float) -> dict[str, Any]:
    """Contacts at the edge of the jump law after a push of 0.02 rad/s into the gap, at a tolerance of 1e-10.

    Inside the gap the surplus torque F/J drives the flexspline out, outside (M_A - F)/J drives it
    back, both constant for small excursions of length T = 2 v/a.  Drag b v on both sides takes
    b v^2 T/3 of energy per excursion, that is 2 b v^2/(3 a J) of the speed of contact; so

        dv/dt = -(b/3J) v,   and the contacts follow each other at a rate that grows with exp(+b t/3J).

    b = B_FS + B_wwy, J = that of the flexspline: here both sides drag.
    """
    law, load = laws()[JUMP], load_in_gap()
    scene = build(law, load)
    begin = steady_start(law, load)
    speeds = dict(begin["speeds"])
    speeds["gear.flexspline"] -= 0.02
    tight = hm.DormandPrince(relative_tolerance=1e-10, absolute_tolerance=1e-12)
    raw = run(assemble(scene.network()), duration=duration, solver=tight, angles=begin["angles"], speeds=speeds, states={})
    twist = raw.angles["gear.wave_generator"] / RATIO - raw.angles["gear.flexspline"]
    rate = raw.speeds["gear.wave_generator"] / RATIO - raw.speeds["gear.flexspline"]
    outside = np.abs(twist) > law.half_gap
    at = np.flatnonzero(outside[1:] & ~outside[:-1]) + 1
    times, speed = raw.times[at], np.abs(rate[at])
    gear, shaft = scene.parts["gear"], scene.parts["output_shaft"]
    inertia = gear.flexspline_inertia + 0.5 * shaft.inertia  # type: ignore[attr-defined]
    theory = (gear.damping + shaft.damping) / (3.0 * inertia)  # type: ignore[attr-defined]
    growth = -float(np.polyfit(times, np.log(speed), 1)[0])
    return {
        "growth_rate": growth,
        "growth_rate_theory": theory,
        "contacts": len(times),
        "first_interval": float(times[1] - times[0]),
        "times": times,
        "speed": speed,
    }


# -- judgement ----------------------------------------------------------------------------------------


def judge(pulses: Pulses) -> list[Claim]:
    """The claims of section 2 about (11)-(14) and (15)-(17)."""
    n = {key: found.numbers() for key, found in pulses.runs.items()}
    edge = {name: float(laws()[name].edge_torque) for name in (JUMP, LITERAL)}  # type: ignore[attr-defined]
    claims = [_pulses(n, edge), _steps(n), _time(n), _false(pulses, n), _excitation(pulses)]
    claims += [_continuous(n), _above(pulses, n), _start_up(n), _resonance(pulses), _implicit(n), _no_damping(n)]
    return claims


Numbers = dict[tuple[str, str, str], dict[str, Any]]


def _ratio(n: Numbers, key: str, scenario: str = IN_GAP) -> tuple[float, float]:
    smooth = n[scenario, CONTINUOUS, EXPLICIT][key]
    return n[scenario, JUMP, EXPLICIT][key] / smooth, n[scenario, LITERAL, EXPLICIT][key] / smooth


def _pulses(n: Numbers, edge: dict[str, float]) -> Claim:
    parts, holds = [], True
    for name in (JUMP, LITERAL):
        fixed, adaptive = n[IN_GAP, name, FIXED], n[IN_GAP, name, EXPLICIT]
        parts.append(
            f"{name}: {fixed['smallest_torque']:.2f} - {fixed['largest_torque']:.2f} N m (M_A = {edge[name]:.2f}), "
            f"{fixed['pulses_per_second']:.3g} pulses/s at h = 20 us, {adaptive['pulses_per_second']:.3g}/s adaptive"
        )
        holds &= fixed["smallest_torque"] == 0.0 and 0.0 <= fixed["largest_torque"] / edge[name] - 1.0 < 0.02
    return Claim("Figs 9-10", "load below M_A: the torque jumps between 0 and M_A", "; ".join(parts), judged(holds))


def _steps(n: Numbers) -> Claim:
    torque, literal = _ratio(n, "steps_per_second")
    jump, smooth = n[IN_GAP, JUMP, EXPLICIT], n[IN_GAP, CONTINUOUS, EXPLICIT]
    return Claim(
        "below Fig. 8",
        "with a variable step this shortens the step",
        f"{torque:.0f}x (torque) and {literal:.0f}x (literal) the steps of the continuous law; median step {jump['median_step']:.1e} s, "
        f"shortest {jump['shortest_step']:.1e} s, against {smooth['median_step']:.1e} s",
        judged(min(torque, literal) > 2.0),
    )


def _time(n: Numbers) -> Claim:
    torque, literal = _ratio(n, "cpu_per_second")
    fixed = n[IN_GAP, JUMP, FIXED]["cpu_per_second"] / n[IN_GAP, CONTINUOUS, FIXED]["cpu_per_second"]
    jump, smooth = n[IN_GAP, JUMP, EXPLICIT], n[IN_GAP, CONTINUOUS, EXPLICIT]
    return Claim(
        "below Fig. 8",
        "and lengthens the calculation",
        f"{torque:.0f}x (torque) and {literal:.0f}x (literal): {jump['cpu_per_second']:.0f} s of CPU time per simulated second "
        f"against {smooth['cpu_per_second']:.2f} s. With the fixed step {fixed:.2f}x",
        judged(min(torque, literal) > 2.0),
    )


def _false(pulses: Pulses, n: Numbers) -> Claim:
    jump, ramp = pulses.runs[IN_GAP, JUMP, EXPLICIT], pulses.runs[IN_GAP, SMOOTHED, EXPLICIT]
    late = jump.times >= 0.5 * jump.duration
    exact = np.interp(jump.times[late], ramp.times, ramp.load_speed)
    motion = float(np.max(np.abs(jump.load_speed[late] / exact - 1.0)))
    rates = [n[key]["pulses_per_second"] for key in ((IN_GAP, JUMP, EXPLICIT), (IN_GAP, JUMP, "explicit, coarse"), (IN_GAP, JUMP, FIXED))]
    growth, theory = pulses.contacts["growth_rate"], pulses.contacts["growth_rate_theory"]
    return Claim(
        "below Fig. 8",
        "and leads to false results",
        f"the torque never converges: {rates[0]:.1e}, {rates[1]:.1e}, {rates[2]:.1e} pulses/s at a tolerance of 1e-6, 1e-4, at h = 20 us; "
        f"the exact law makes them denser by exp(t * {growth:.3g}/s) (theory (B_FS + B_wwy)/3J = {theory:.3g}/s). "
        f"The motion does converge: load speed within {motion:.0e} of the drawn-out jump's",
        judged(rates[0] > 2.0 * rates[1] and motion > 1e-4, "holds for the torque, not for the motion"),
    )


def _excitation(pulses: Pulses) -> Claim:
    """Ripple of the output shaft above what the drawn-out jump gives, both with the fixed step."""
    rms = {}
    ramp = pulses.runs[IN_GAP, SMOOTHED, FIXED]
    late = ramp.times >= 0.5 * ramp.duration
    for name in (JUMP, LITERAL, CONTINUOUS):
        swing = pulses.runs[IN_GAP, name, FIXED].output - ramp.output
        rms[name] = float(np.std(swing[late]))
    return Claim(
        "below Fig. 8",
        "artificial excitation of vibrations",
        f"rms of the output shaft's torque about that of the drawn-out jump: {rms[JUMP]:.3f} (torque), {rms[LITERAL]:.3f} (literal), "
        f"{rms[CONTINUOUS]:.4f} N m (continuous), at a mean of 4 N m and h = 20 us",
        judged(min(rms[JUMP], rms[LITERAL]) > 5.0 * rms[CONTINUOUS], "does not hold here"),
    )


def _continuous(n: Numbers) -> Claim:
    smooth, curve = n[IN_GAP, CONTINUOUS, EXPLICIT], n[IN_GAP, CATALOGUE, EXPLICIT]
    return Claim(
        "(15)-(17)",
        "the continuous law makes no such pulses",
        f"{smooth['pulses_per_second']:.0f} pulses/s, torque {smooth['smallest_torque']:.2f} - {smooth['largest_torque']:.2f} N m, "
        f"{smooth['steps_per_second']:.3g} steps/s. Nor does the catalogue law (7)-(10): {curve['pulses_per_second']:.0f} pulses/s, "
        f"{curve['steps_per_second']:.3g} steps/s",
        judged(smooth["pulses_per_second"] == 0.0),
    )


def _above(pulses: Pulses, n: Numbers) -> Claim:
    steps, _ = _ratio(n, "steps_per_second", ABOVE)
    cpu, _ = _ratio(n, "cpu_per_second", ABOVE)
    smooth = pulses.runs[ABOVE, CONTINUOUS, EXPLICIT]
    differences = {}
    for name in (JUMP, LITERAL, CATALOGUE, CUBIC):
        one = pulses.runs[ABOVE, name, EXPLICIT]
        other = np.interp(one.times, smooth.times, smooth.output)
        differences[name] = float(np.max(np.abs(one.output - other)))
    worst = max(differences[JUMP], differences[LITERAL])
    return Claim(
        "below Fig. 10",
        "reliable with (11)-(14) too, if the load stays off the range D - A",
        f"running under 20 + 5 sin(2 pi t) N m: {n[ABOVE, JUMP, EXPLICIT]['pulses_per_second']:.0f} passages of the edge, "
        f"{steps:.2f}x the steps, {cpu:.2f}x the time; "
        f"output torque within {differences[JUMP]:.3f} (torque), {differences[LITERAL]:.3f} (literal), "
        f"{differences[CATALOGUE]:.3f} (catalogue) N m of the continuous law's",
        judged(n[ABOVE, JUMP, EXPLICIT]["pulses_per_second"] == 0.0 and steps < 1.1 and worst < 0.01 * 20.0),
    )


def _start_up(n: Numbers) -> Claim:
    jump, literal, smooth = (n[START_UP, name, EXPLICIT] for name in (JUMP, LITERAL, CONTINUOUS))
    ratio = [run["steps_per_second"] / smooth["steps_per_second"] for run in (jump, literal)]
    passages = [run["pulses_per_second"] * run["simulated_seconds"] for run in (jump, literal, smooth)]
    return Claim(
        "below Fig. 10",
        "the value of the load torque decides whether (11)-(14) can be used",
        f"not at a start: from rest under the same load the train rebounds through the gap, {passages[0]:.3g} and {passages[1]:.3g} "
        f"passages of the edge against {passages[2]:.0f}, {ratio[0]:.1f}x and {ratio[1]:.1f}x the steps",
        judged(max(ratio) < 1.1, "holds in part: in steady running, not at a start"),
    )


def _resonance(pulses: Pulses) -> Claim:
    jump, smooth = (pulses.runs[RESONANCE, name, "explicit, coarse"] for name in (JUMP, CONTINUOUS))
    return Claim(
        "below Fig. 10",
        "near resonance the range D - A is entered under a higher load too",
        f"20 + 5 sin N m at the first mode: torque {jump.elastic.min():.1f} - {jump.elastic.max():.1f} N m, {jump.pulses} passages "
        f"of the edge in {jump.duration:g} s (continuous law: {smooth.pulses})",
        judged(jump.pulses > 0 and smooth.pulses > 0),
    )


def _implicit(n: Numbers) -> Claim:
    failed = [name for name in (JUMP, LITERAL) if "failure" in n[IN_GAP, name, IMPLICIT]]
    smooth = n[IN_GAP, CONTINUOUS, IMPLICIT]
    above = n[ABOVE, JUMP, IMPLICIT]
    outcome = f"Newton's method fails at the edge ({', '.join(failed)})" if failed else "both jump laws ran"
    return Claim(
        "(not in the paper)",
        "an implicit solver (trapezoidal rule, h = 0.1 ms)",
        f"{outcome}; continuous {smooth['cpu_per_second']:.3f} s of CPU time per simulated second; above the gap torque the jump law runs, "
        f"{above.get('cpu_per_second', math.nan):.3f} s",
        "does not help the jump law" if len(failed) == 2 else "runs the jump law",
    )


def _no_damping(n: Numbers) -> Claim:
    jump, smooth = n[NO_DAMPING, JUMP, EXPLICIT], n[NO_DAMPING, CONTINUOUS, EXPLICIT]
    pulses, before = jump["pulses_per_second"], n[IN_GAP, JUMP, EXPLICIT]["pulses_per_second"]
    return Claim(
        "(2)-(3)",
        "B_FS acts inside the gap too, as written",
        f"switched off there, the jump law makes {pulses:.2g} pulses/s ({before:.2g} with it), "
        f"{jump['steps_per_second']:.2g} steps/s; continuous {smooth['steps_per_second']:.2g} steps/s",
        "a switch of ours; not the cause of the pulses" if pulses > 0.0 else "a switch of ours; without it no pulses",
    )

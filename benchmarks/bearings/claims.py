"""Each claim of the paper, and each aim set for the improved model, against what was found."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from benchmarks.bearings.cases import FINAL, FULL, IMPROVED, MERGED, PAPER, SIMPLIFIED, Case
from benchmarks.bearings.findings import Findings
from benchmarks.bearings.precision import ADAPTIVE, FIXED, IMPLICIT, STEPS, TARGET, TOLERANCES
from benchmarks.bearings.run_up import ROTORS
from benchmarks.bearings.steady import ABOVE, BELOW, BETWEEN
from benchmarks.bearings.sweep import CHEAPER, valid_from
from benchmarks.stiffness_laws.claim import Claim, judged
from hdrive_mbs.analysis.whirl.bearing_models import LIMITS

FOUNDATION = 6e6
"""Stiffness of each foundation of M-REF [N/m]."""

CLOSE = 0.05
"""What we take for "close" and for "very good agreement": within 5 %."""


def percent(value: float | None, digits: int = 1) -> str:
    """Signed, or a dash."""
    return "-" if value is None or not math.isfinite(value) else f"{100.0 * value:+.{digits}f} %"


def _cases(found: Findings) -> Sequence[Case]:
    return [case for case in PAPER if case in found.runs]


def _where(verdicts: dict[str, bool]) -> str:
    """A verdict that names the cases for which a claim holds."""
    good = [name for name, holds in verdicts.items() if holds]
    if len(good) == len(verdicts):
        return "holds"
    return f"holds in part: for {', '.join(good)}" if good else "does not hold"


def claims(found: Findings) -> list[Claim]:
    """Of the paper."""
    return [
        _criticals(found),
        _peaks(found),
        _peaks_steady(found),
        _damping_place(found),
        _torsion(found),
        *_bands(found),
        _run_up_bands(found),
        *_times(found),
        _dampers(found),
        _tilt(found),
        _merged(found),
        _locked(found),
    ]


def _criticals(found: Findings) -> Claim:
    texts, verdicts = [], {}
    for case in _cases(found):
        steady = found.steady_deviation(case, SIMPLIFIED)
        deviations, damped = steady["critical_speeds"], steady["damped_critical_speeds"]
        at_peak = found.peak_speed_deviation(case, SIMPLIFIED)
        listed = ", ".join(percent(value) for value in deviations)
        with_damping = ", ".join(percent(value) for value in damped)
        texts.append(f"{case.name}: {listed} undamped, {with_damping} damped; speed of the run-up peak {percent(at_peak)}")
        verdicts[case.name] = max(map(abs, (*deviations, *damped, at_peak))) <= CLOSE
    says = f"the critical speeds are close to each other (up to {FINAL:g} rad/s; we ask for 5 %)"
    return Claim("section 6", says, "; ".join(texts), _where(verdicts))


def _peaks(found: Findings) -> Claim:
    texts, verdicts = [], {}
    for case in _cases(found):
        deviations = found.peak_deviation(case, SIMPLIFIED)
        texts.append(f"{case.name}: " + ", ".join(f"{r.replace('_', ' ')} {percent(v)}" for r, v in deviations.items()))
        verdicts |= {f"{r.replace('_', ' ')} of {case.name}": value > 0.0 for r, value in deviations.items()}
    says = "during passage the transverse amplitudes are higher (run-up)"
    return Claim("section 6, Figs 6, 10", says, "; ".join(texts), _where(verdicts))


def _peaks_steady(found: Findings) -> Claim:
    texts, verdicts = [], {}
    for case in _cases(found):
        for rotor, values in found.steady_deviation(case, SIMPLIFIED)["peaks"].items():
            name = f"{rotor.replace('_', ' ')} of {case.name}"
            texts.append(f"{name} {', '.join(percent(value) for value in values)}")
            verdicts[name] = all(value > 0.0 for value in values if value is not None)
    return Claim("section 6", "the same in steady rotation at each critical speed", "; ".join(texts), _where(verdicts))


def _damping_place(found: Findings) -> Claim:
    texts, verdicts = [], []
    for name, rows in found.swept["damping"].items():
        for rotor in ROTORS:
            share = 100.0 * np.array([row["share"] for row in rows])
            values = np.array([row[SIMPLIFIED][rotor] for row in rows])
            lower = values <= 0.0
            verdicts.append(not lower.any())
            crossed = "everywhere" if not lower.any() else "nowhere" if lower.all() else f"above {share[lower].max():.0f} %"
            ends = f"{percent(values[0])} at {share[0]:.1f} %, {percent(values[-1])} at {share[-1]:.0f} %"
            texts.append(f"stiffness of {name}, {rotor.replace('_', ' ')}: {crossed} ({ends})")
    return Claim(
        "section 6",
        "they are higher, without a condition; here damping moves from the foundation into the bearing",
        "steady first peak higher where the bearing element holds this share of the damping ratio: " + "; ".join(texts),
        judged(all(verdicts), "does not hold in general: only with enough of the damping in the bearing, which section 5 leaves out"),
    )


def _torsion(found: Findings) -> Claim:
    texts, verdicts = [], {}
    for case in _cases(found):
        values = {model: found.run_ups[case][model]["ripple"] for model in (FULL, SIMPLIFIED, IMPROVED)}
        listed = ", ".join(f"{model} {1e3 * value:.2f}" for model, value in values.items())
        texts.append(f"{case.name}: {listed} mrad/s ({percent(values[SIMPLIFIED] / values[FULL] - 1.0)})")
        verdicts[case.name] = values[SIMPLIFIED] > values[FULL]
    return Claim("section 6, Fig. 9", "the torsional amplitudes are higher too", "; ".join(texts) + ", 0-peak", _where(verdicts))


def _bands(found: Findings) -> list[Claim]:
    made = []
    for band in (BELOW, BETWEEN, ABOVE):
        texts, verdicts = [], {}
        for case in _cases(found):
            deviations = found.steady_deviation(case, SIMPLIFIED)["bands"].get(band)
            for rotor, value in (deviations or {}).items():
                name = f"{rotor.replace('_', ' ')} of {case.name}"
                texts.append(f"{name} {100.0 * value:.1f} %")
                verdicts[name] = value <= CLOSE
        if texts:
            says = f"very good agreement at sub- and supercritical speeds: {band}, steady (we ask for 5 %)"
            made.append(Claim("section 6, Fig. 11", says, "largest deviation: " + ", ".join(texts), _where(verdicts)))
    texts, verdicts = [], {}
    for case in _cases(found):
        for rotor, value in found.steady_deviation(case, SIMPLIFIED)["at_the_final_speed"].items():
            name = f"{rotor.replace('_', ' ')} of {case.name}"
            texts.append(f"{name} {percent(value)}")
            verdicts[name] = abs(value) <= CLOSE
    made.append(Claim("section 6, Fig. 11", f"the same at {FINAL:g} rad/s", ", ".join(texts), _where(verdicts)))
    return made


def _run_up_bands(found: Findings) -> Claim:
    texts, verdicts = [], {}
    for case in _cases(found):
        parts = found.run_ups[case][SIMPLIFIED]["bands"]
        for rotor in ROTORS:
            values = {band: item[rotor] for band, item in parts.items() if item[rotor] is not None}
            name = f"{rotor.replace('_', ' ')} of {case.name}"
            texts.append(f"{name}: " + ", ".join(f"{100.0 * value:.0f} % {band}" for band, value in values.items()))
            verdicts |= {f"{name} {band}": value <= CLOSE for band, value in values.items()}
    return Claim(
        "section 6, Fig. 11",
        "the same in the run-up itself, where the whirl of the passage still rings (rms of the difference over rms)",
        "; ".join(texts),
        _where(verdicts),
    )


def _times(found: Findings) -> list[Claim]:
    made = []
    for case in _cases(found):
        texts, ratios = [], []
        for kind, value in ((ADAPTIVE, TOLERANCES[-1]), (ADAPTIVE, TOLERANCES[0]), (IMPLICIT, STEPS[2])):
            same = found.same_setting(case, SIMPLIFIED, kind, value)
            if math.isfinite(same["seconds"]):
                texts.append(f"{kind}, {value:g}: {same['seconds']:.2f}x the time, {same['steps']:.2f}x the steps")
                ratios.append(same["seconds"])
        if texts:
            says = "the simulation time is close to 50 % shorter (same solver and setting)"
            verdict = judged(max(ratios) <= 0.6, "holds in part: not for every solver" if min(ratios) <= 0.6 else "does not hold")
            made.append(Claim(f"section 6, {case.name}", says, "; ".join(texts), verdict))
        ratio = found.time_ratio(case, SIMPLIFIED)
        full, simple = (found.runs[case][model].best() for model in (FULL, SIMPLIFIED))
        made.append(
            Claim(
                f"section 6, {case.name}",
                f"the same at equal accuracy ({100.0 * TARGET:g} % of the own peaks), each with its best solver",
                f"{ratio:.2f}x the time: simplified {simple[1]:.3f} s ({simple[0]}), full {full[1]:.3f} s ({full[0]})",
                judged(ratio <= 0.6),
            )
        )
    return made


def _dampers(found: Findings) -> Claim:
    texts, verdicts = [], {}
    for case in _cases(found):
        steady = found.steady_deviation(case, SIMPLIFIED)
        value, exact = steady["damping_ratio"][0], steady["damping_ratio_of_full"][0]
        if value is None or exact is None:
            continue
        texts.append(f"{case.name}: {100.0 * value:.3f} % against {100.0 * exact:.3f} % ({percent(value / exact - 1.0)})")
        verdicts[case.name] = abs(value / exact - 1.0) <= 0.2
    return Claim(
        "section 7",
        "good enough to choose the parameters of dampers beforehand (damping ratio at the first critical speed; we ask for 20 %)",
        "; ".join(texts),
        _where(verdicts),
    )


def _tilt(found: Findings) -> Claim:
    texts, verdicts = [], {}
    for case in _cases(found):
        with_tilt, without = found.steady_deviation(case, SIMPLIFIED), found.without_tilt[case]
        pairs = [(with_tilt["peaks"][rotor][0], without["peaks"][rotor][0]) for rotor in ROTORS]
        listed = ", ".join(f"{r.replace('_', ' ')} {percent(a)} -> {percent(b)}" for r, (a, b) in zip(ROTORS, pairs, strict=True))
        first = with_tilt["critical_speeds"][0], without["critical_speeds"][0]
        texts.append(f"{case.name}: first critical speed {percent(first[0], 2)} -> {percent(first[1], 2)}; its peaks {listed}")
        verdicts[case.name] = abs(first[1]) > abs(first[0])
    return Claim("section 5", "without the tilt terms (J_t, b_psi, k_psi) the accuracy is inadequate", "; ".join(texts), _where(verdicts))


def _merged(found: Findings) -> Claim:
    texts, faster, accurate = [], [], []
    for case in _cases(found):
        full, merged = found.runs[case][FULL], found.runs[case][MERGED]
        steady = found.steady_deviation(case, MERGED)
        fixed = full.time_at_target(FIXED) / merged.time_at_target(FIXED)
        best = full.best()[1] / merged.best()[1]
        second = steady["peaks"]["rotor_2"][-1]
        texts.append(
            f"{case.name}: {best:.2f}x as fast with the best solver, {fixed:.2f}x with the fixed explicit step "
            f"(fastest eigenvalue {full.fastest:.3g} -> {merged.fastest:.3g} 1/s: bearing A beside the drive disc is as stiff); "
            f"critical speeds {', '.join(percent(v, 2) for v in steady['critical_speeds'])}, run-up peaks "
            f"{', '.join(percent(v, 2) for v in found.peak_deviation(case, MERGED).values())}, steady peak of rotor 2 at the last one "
            f"{percent(second)}"
        )
        faster.append(best > 1.05)
        accurate.append(max(map(abs, steady["critical_speeds"])) <= CLOSE and (second is None or abs(second) <= CLOSE))
    slow = (
        "does not hold"
        if not all(faster)
        else "holds for the time; 70 mm of shaft are too long to be rigid beyond the first critical speed"
    )
    says = "the section between rotor 2 and its bearing is a very stiff element, better to merge the two"
    return Claim("section 2, Fig. 2", says, "; ".join(texts), judged(all(faster) and all(accurate), slow))


def _locked(found: Findings) -> Claim:
    maps = found.swept["maps"]
    stiffness, diameters = np.array(maps["bearing"]["stiffness"]), np.array(maps["diameters"])
    texts, speeds = [], []
    for diameter in (diameters[int(np.argmin(np.abs(diameters - 0.022)))], diameters[-1]):
        speed = valid_from(maps, SIMPLIFIED, "critical_speeds", 0.01, diameter)
        peak = valid_from(maps, SIMPLIFIED, "rotor_1", 0.05, diameter)
        table = maps["bearing"]["models"][SIMPLIFIED]["critical_speeds"][int(np.argmin(np.abs(diameters - diameter)))]
        parts = [
            f"{what} {f'from {value / FOUNDATION:.0f} times' if math.isfinite(value) else 'nowhere'}"
            for what, value in (("critical speeds within 1 %", speed), ("first peak of rotor 1 within 5 %", peak))
        ]
        left = f"the stiffest bearing leaves {100.0 * table[-1]:.2f} % on the critical speeds"
        texts.append(f"shaft of {1e3 * diameter:.1f} mm: {', '.join(parts)}, {left}")
        speeds.append(speed)
    return Claim(
        "sections 1, 5",
        "locking ring and housing together is admissible where the bearing is stiff against its foundation",
        f"bearing up to {stiffness[-1] / FOUNDATION:.0f} times as stiff as the foundation; {'; '.join(texts)}",
        _where_stiff(speeds),
    )


def _where_stiff(speeds: Sequence[float]) -> str:
    """A slender shaft errs for another reason: one cubic over the section is stiffer than two."""
    valid = [math.isfinite(speed) for speed in speeds]
    if all(valid):
        return "holds"
    return "holds in part: with a thick shaft; a slender one bends differently on both sides" if any(valid) else "does not hold"


def aims(found: Findings) -> list[Claim]:
    """Of the improved model, and of run time."""
    made = []
    for case in found.runs:
        steady = found.steady_deviation(case, IMPROVED)
        undamped, damped = (max(map(abs, steady[key])) for key in ("critical_speeds", "damped_critical_speeds"))
        peaks = max(map(abs, found.peak_deviation(case, IMPROVED).values()))
        ratio = found.time_ratio(case, IMPROVED)
        solvers = ", ".join(f"{model}: {found.runs[case][model].best()[0]}" for model in (IMPROVED, FULL))
        made.append(
            Claim(
                case.name,
                "improved: critical speeds within 0.05 %, peaks of the run-up within 0.5 %, at most 50 % of the time of the full model",
                f"{100.0 * undamped:.4f} % (with damping {100.0 * damped:.4f} %), {100.0 * peaks:.4f} %, {100.0 * ratio:.0f} % ({solvers})",
                _aims_verdict(max(undamped, damped) <= 5e-4, peaks <= 5e-3, ratio <= 0.5),
            )
        )
    made.append(_defaults(found))
    made += [_warned(found, model) for model in CHEAPER]
    case = next(iter(found.runs))
    for model, limit in ((FULL, 1.0), (SIMPLIFIED, 0.5), (IMPROVED, 0.5)):
        kind, seconds = found.runs[case][model].best()
        share = found.duration / 2.5
        made.append(
            Claim(
                case.name,
                f"{model}: a run-up of 2.5 s under {limit:g} s of CPU time ({limit / 2.5:g} of the simulated time) at {100.0 * TARGET:g} % "
                "error of its peaks",
                f"{seconds:.3f} s for {found.duration:g} s: {seconds / found.duration:.3f} of the simulated time ({kind})",
                "reached" if seconds <= limit * share else "missed",
            )
        )
    return made


def _defaults(found: Findings) -> Claim:
    every = [(case.name, model, item["error"]) for case, of in found.defaults.items() for model, item in of.items()]
    worst = max(every, key=lambda row: row[2])
    return Claim(
        "all lines",
        f"run_up chooses a step that keeps the peaks within the {100.0 * TARGET:g} % it is asked for, if not told otherwise",
        f"largest error {100.0 * worst[2]:.3f} % ({worst[0]}, {worst[1]}), smallest {100.0 * min(row[2] for row in every):.3f} %",
        "reached" if worst[2] <= TARGET else "missed",
    )


def _warned(found: Findings, model: str) -> Claim:
    """Whether a warning came exactly where a model of the maps, or of moved damping, is off."""
    frequency, damping = LIMITS[model]
    off, good = [], []
    cells = found.swept_cells(model)
    for cell in cells:
        sizes = cell["critical_speeds"] / frequency, abs(cell["largest"]) / damping
        if max(sizes) > 1.0:
            off.append(bool(cell["warned"]))
        elif max(sizes) < 0.5:
            good.append(bool(cell["warned"]))
    return Claim(
        "sweeps",
        f"{model}: with_bearings warns where critical speeds are off by more than {100.0 * frequency:g} % or the larger first peak by "
        f"{100.0 * damping:g} %, and does not where both are within half of that",
        f"it warned in {sum(off)} of {len(off)} cases that are off, and in {sum(good)} of {len(good)} that are not; {len(cells)} in all",
        "missed: some go unnoticed" if not all(off) else "reached, with false alarms" if any(good) else "reached",
    )


def _aims_verdict(*reached: bool) -> str:
    names = ("critical speeds", "peaks", "time")
    missed = [name for name, good in zip(names, reached, strict=True) if not good]
    return "reached" if not missed else f"missed: {', '.join(missed)}"

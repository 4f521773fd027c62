"""The right law at the right place, fitted from where a search begins: by four ways, to the end."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from unittest.mock import patch

import numpy as np
import numpy.typing as npt
from scipy.optimize import least_squares

from benchmarks.machine import machine as about
from benchmarks.withheld.make import make_set
from benchmarks.withheld.methods import bench_of, records_of
from benchmarks.withheld.names import names_of
from hdrive_mbs.diagnosis import differences
from hdrive_mbs.diagnosis.candidates import candidates
from hdrive_mbs.diagnosis.curved import Valley
from hdrive_mbs.diagnosis.differences import jacobian
from hdrive_mbs.diagnosis.fit import fit
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.prepared import EVERY, factors_of
from hdrive_mbs.diagnosis.screening import Look, Screen
from hdrive_mbs.diagnosis.search import fit_nominal
from hdrive_mbs.diagnosis.simulator import Simulator, chi_square
from hdrive_mbs.diagnosis.step import suitable_step
from hdrive_mbs.diagnosis.suspects import simplest, suspects
from hdrive_mbs.diagnosis.tasks import CONVERGED, FINE

FloatArray = npt.NDArray[np.float64]

CAUSES = {
    "drive": ("hysteresis_flexspline", "coupling_backlash", "lost_motion", "friction_mesh_load", "hidden_mode_load", "quadratic_drag"),
    "rotor": ("parameter_bearing_stiffness", "bearing_clearance", "crack", "rub", "looseness", "bearing_cross_coupling"),
}
"""Names of the generator, by bench: what bends valleys (springs that parameters imitate) and what has corners."""
SEED = 2711


@dataclass(frozen=True, eq=False)
class Problem:
    """A law to fit, from a look at it."""

    bench: str
    case: str
    law: str
    place: str
    simulator: Simulator
    look: Look


def study(*, quick: bool, repeats: int) -> dict[str, Any]:
    """Rows: bench, case, cause, law, place, way; begun: mean square of the fitted samples; what ``ends`` says; runs; seconds (CPU)."""
    causes = {"drive": CAUSES["drive"][:1]} if quick else CAUSES
    rows: list[dict[str, Any]] = []
    with tempfile.TemporaryDirectory() as folder:
        for bench, names in causes.items():
            for problem, cause in problems(bench, names, repeats, Path(folder) / bench):
                simulator, hypothesis, start = problem.simulator, problem.look.hypothesis, problem.look.z
                about_it = {"bench": bench, "case": problem.case, "cause": cause, "law": problem.law, "place": problem.place}
                for way, method in WAYS.items():
                    before, begun = simulator.runs, time.process_time()
                    z = method(simulator, hypothesis, start)
                    cost = {"runs": simulator.runs - before, "seconds": time.process_time() - begun}
                    rows.append(
                        {**about_it, "way": way, "begun": chi_square(problem.look.residuals, simulator.fit)}
                        | ends(simulator, hypothesis, z)
                        | cost
                    )
    return {"about": about(), "seed": SEED, "repeats": repeats, "rows": rows}


def ends(simulator: Simulator, hypothesis: Hypothesis, z: FloatArray) -> dict[str, float]:
    """At a point: ``left``, the mean square of the fitted samples, and ``misfit``, what the diagnosis minimises, per half a sample.

    The second is 1 where noise alone is left, and counts stretches that fit badly by their logarithm (robust.py); both are infinite
    where the point cannot be run.
    """
    [run] = simulator.residuals(hypothesis, [z])
    if run is None:
        return {"left": float("inf"), "misfit": float("inf")}
    cost = simulator.blocks.cost(run[simulator.fit]) + hypothesis.prior_cost(z)
    return {"left": chi_square(run, simulator.fit), "misfit": 2.0 * cost / int(np.count_nonzero(simulator.fit))}


def problems(bench: str, names: tuple[str, ...], repeats: int, folder: Path) -> Iterator[tuple[Problem, str]]:
    """Of each cause the law that a search looks at first, at the right place; causes whose place has none are left out."""
    labels = make_set(bench, repeats * len(names), SEED, folder, names=names)
    known, meant = bench_of(bench), names_of(bench)
    for case in sorted(labels):
        [truth] = labels[case]["truth"]
        trials = [trial for record in records_of(folder / case) for trial in known.trials(record)]
        simulator = Simulator(trials, suitable_step(trials, factors_of(known)), EVERY)
        null = fit_nominal(simulator, factors_of(known))
        wanted = meant.labels((truth["effect"], truth["at"]))
        groups = {group: own for group, own in known.groups.items() if ("parameter", group) in wanted}
        tried = [item for item in candidates(trials[0].scene) if item.label in wanted]
        screen = Screen(simulator, null, jacobian(simulator, null.hypothesis, null.z, null.residuals))
        looks = [(suspect, screen.look(suspect.all)) for suspect in simplest(suspects(null.hypothesis, groups, tried))]
        found = [(suspect, look) for suspect, look in looks if look is not None]
        if found:
            suspect, look = min(found, key=lambda pair: pair[1].cost)
            yield Problem(bench, case, suspect.law, suspect.label[1], simulator, look), truth["effect"]


def curved(simulator: Simulator, hypothesis: Hypothesis, start: FloatArray) -> FloatArray:
    """The fit of the diagnosis; returns where it ended."""
    return fit(simulator, hypothesis, start, steps=CONVERGED, share=FINE).z


def straight(simulator: Simulator, hypothesis: Hypothesis, start: FloatArray) -> FloatArray:
    """The same fit without curved steps."""
    with patch.object(Valley, "followed", lambda *_: []):
        return fit(simulator, hypothesis, start, steps=CONVERGED, share=FINE).z


def with_long_differences(simulator: Simulator, hypothesis: Hypothesis, start: FloatArray) -> FloatArray:
    """The same fit with differences as long as the coordinates' steps, as it was before differences.py shortened them."""
    with patch.object(differences, "lengths", lambda steps, _: steps):
        return fit(simulator, hypothesis, start, steps=CONVERGED, share=FINE).z


def scipys(simulator: Simulator, hypothesis: Hypothesis, start: FloatArray) -> FloatArray:
    """Trust region reflective of scipy on the plain squares, with the same Jacobian and priors and the same relative change as its end.

    What leaves its range is put at its edge, where the residuals stay as they are.
    """
    mask, root = simulator.fit, np.sqrt(hypothesis.precisions)
    last: dict[bytes, FloatArray] = {}

    def residuals(z: FloatArray) -> FloatArray:
        inside = hypothesis.clipped(z)
        [run] = simulator.residuals(hypothesis, [inside])
        if run is None:
            return np.full(int(np.count_nonzero(mask)) + len(z), np.inf)
        last.clear()
        last[inside.tobytes()] = run
        return np.concatenate([run[mask], root * inside])

    def slopes(z: FloatArray) -> FloatArray:
        inside = hypothesis.clipped(z)
        run = last.get(inside.tobytes())
        if run is None:
            [run] = simulator.residuals(hypothesis, [inside])
        if run is None:
            raise ValueError("a point that was accepted cannot be run")
        return np.vstack([jacobian(simulator, hypothesis, inside, run), np.diag(root)])

    found = least_squares(residuals, start, jac=slopes, x_scale="jac", ftol=FINE, max_nfev=4 * CONVERGED)
    return hypothesis.clipped(found.x)


WAYS: dict[str, Callable[[Simulator, Hypothesis, FloatArray], FloatArray]] = {
    "curved": curved,
    "straight": straight,
    "long": with_long_differences,
    "scipy": scipys,
}
"""Name of a way -> function of simulator, hypothesis and start that returns where it ended."""

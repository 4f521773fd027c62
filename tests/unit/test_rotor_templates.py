"""Templates of rotor lines that leave all numbers free, those of masses and stiffnesses too."""

from __future__ import annotations

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.compiled.line import CompiledLine
from hdrive_mbs.diagnosis.candidates import candidates
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.lines import _compiled
from hdrive_mbs.diagnosis.templates import PAYS, Templates, alike
from hdrive_mbs.diagnosis.trial import Trial
from hdrive_mbs.diagnosis.unknowns import Factor
from hdrive_mbs.network.network import Network
from models import rotor_bench
from tests.unit.rotor_bench_records import bench, compiled, factors, recorded

LAWS = (
    *(hm.ShaftBow, hm.ShaftKink, hm.PhasedCrack, hm.ArcCrack, hm.InternalDamping, hm.RelaxingDamping, hm.ShaftStiffnessAsymmetry),
    *(hm.RotorUnbalance, hm.DynamicUnbalance, hm.SupportMassChange, hm.SupportStiffnessChange, hm.BearingStiffnessChange),
    *(hm.Looseness, hm.OilWhirl, hm.Rub, hm.TorqueRipple),
)
UNCERTAIN = ("youngs_modulus", "shaft_damping", "bearing_stiffness", "support_stiffness_x", "support_damping", "rotor_1_mass")
UNEVEN = ("rotor_1_polar_inertia", "rotor_1_transverse_inertia", "rotor_1_eccentricity")


@pytest.fixture(scope="module")
def trials() -> dict[str, Trial]:
    return {item.name: item for item in bench().trials(recorded("run_up", compiled("run_up", 0.05), noisy=False))}


def about(hypothesis: Hypothesis, number: int) -> list[np.ndarray]:
    rng = np.random.default_rng(5)
    start = hypothesis.start()
    return [hypothesis.clipped(start + 0.3 * rng.standard_normal(len(start))) for _ in range(number)]


@pytest.mark.parametrize("view", ["run_up, lateral", "run_up, torsion"])
@pytest.mark.parametrize("law", [None, *LAWS])
def test_lines_with_other_masses_and_stiffnesses_come_from_a_template(
    law: type[hm.Effect] | None, view: str, trials: dict[str, Trial]
) -> None:
    added = () if law is None else candidates(bench().scene, law)[0].starts[:1]
    hypothesis, trial = Hypothesis(factors(*UNCERTAIN, *UNEVEN), added), trials[view]
    built: list[Network] = []

    def made(network: Network) -> CompiledLine:
        built.append(network)
        return _compiled(network, trial)

    points = about(hypothesis, 2 * PAYS)
    kept = Templates(large=True)
    lines = kept.lines(hypothesis, trial.scene, points, view, made)
    assert 2 <= len(built) <= 3  # one that holds zeros or one that leaves them out, and one to hold it against
    assert sum(line is not None for line in lines) > PAYS  # a way may part where a size comes to its limit
    for z, line in zip(points, lines, strict=True):
        if line is not None:
            assert alike(line.program, made(hypothesis.scene(trial.scene, z, to_run=True).network()).program)


def test_a_line_from_a_template_runs_as_the_one_that_is_built(trials: dict[str, Trial]) -> None:
    """What LDL^T and springs of tracked numbers round otherwise grows by no more than rounding does."""
    hypothesis, trial = Hypothesis(factors(*UNCERTAIN, *UNEVEN)), trials["run_up, lateral"]
    points = about(hypothesis, PAYS)
    lines = Templates(large=True).lines(hypothesis, trial.scene, points, "lateral", lambda made: _compiled(made, trial))
    for z, line in zip(points[:2], lines[:2], strict=True):
        assert line is not None
        built = _compiled(hypothesis.scene(trial.scene, z, to_run=True).network(), trial)
        runs = [item.run(400, trial.every, step=trial.every / 6, speeds=trial.speeds).values for item in (line, built)]
        for name, values in runs[1].items():
            np.testing.assert_allclose(runs[0][name], values, rtol=0.0, atol=1e-10 * np.abs(values).max())


def test_a_template_is_not_changed_by_lines_that_are_built_with_its_own_numbers(trials: dict[str, Trial]) -> None:
    """A part of plain numbers that equals a tracked one is another part: else it would be a comparison that holds for these alone."""
    hypothesis, trial = Hypothesis(factors("youngs_modulus")), trials["run_up, lateral"]
    points = about(hypothesis, PAYS)
    kept = Templates(large=True)

    def made(network: Network) -> CompiledLine:
        return _compiled(network, trial)

    for _ in range(9):  # checked beside the same point, at which it was recorded, in the 2nd, 4th and 8th use
        lines = kept.lines(hypothesis, trial.scene, points, "lateral", made)
        assert all(line is not None for line in lines)


@pytest.mark.parametrize(
    ("changes", "path", "has_one"),
    [
        ({}, "youngs_modulus", True),
        ({}, "diameter", True),
        ({}, "length", False),  # positions along the shaft
        ({"shear": True}, "youngs_modulus", False),  # the matrix changes its shape
        ({"density": 7850.0}, "youngs_modulus", True),
        ({"density": 7850.0}, "diameter", False),  # masses out of plain arrays
        ({"density": 7850.0}, "density", False),
    ],
)
def test_what_of_a_shaft_leads_through_arrays_that_keep_no_numbers_is_built(changes: dict[str, object], path: str, has_one: bool) -> None:
    section = rotor_bench.build("bump").parts["section_2"].replacing(**changes)
    scene = rotor_bench.build("bump").replacing({"section_2": section})
    value = getattr(section, path)
    factor = Factor(path=f"section_2.{path}", name=path, nominal={f"section_2.{path}": value}, sigma=0.02)
    points = [np.array([0.1 * k]) for k in range(PAYS)]
    lines = Templates(large=True).lines(Hypothesis((factor,)), scene, points, "bump", lambda made: CompiledLine(made, ["rotor_1.x"]))
    assert [line is not None for line in lines] == [has_one] * PAYS

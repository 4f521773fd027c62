"""The benchmarks run with --quick and give finite numbers under the promised keys.  No time is judged here."""

from __future__ import annotations

import importlib.util
import json
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

import hdrive_mbs
from benchmarks.bearings.cases import MODELS
from benchmarks.bearings.run_up import RunUp
from benchmarks.bearings.stability import longest_step
from benchmarks.speed import train
from benchmarks.speed.study import TARGET, time_at
from benchmarks.stiffness_laws import __main__ as stiffness_laws
from hdrive_mbs.cli.main import app
from hdrive_mbs.errors import PlaceError, SceneError

HAS_NUMBA = importlib.util.find_spec("numba") is not None


def run(command: Any, folder: Path) -> tuple[dict[str, Any], str]:
    """Results and text of a quick run."""
    assert command.main(["--quick", "--out", str(folder)]) == 0
    return json.loads((folder / "results.json").read_text("utf-8")), (folder / "results.md").read_text("utf-8")


def leaves(value: Any, path: str = "") -> Iterator[tuple[str, Any]]:
    """Every number and text of a document with its path."""
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else None
    if items is None:
        yield path, value
        return
    for key, item in items:
        yield from leaves(item, f"{path}/{key}")


def is_finite(value: Any) -> bool:
    return not isinstance(value, (int, float)) or math.isfinite(value)


def pictures(folder: Path) -> set[str]:
    """Names of the files that really are PNG."""
    return {path.name for path in folder.glob("*.png") if path.read_bytes().startswith(b"\x89PNG")}


@pytest.fixture(scope="module")
def speed(tmp_path_factory: pytest.TempPathFactory) -> tuple[dict[str, Any], str, Path]:
    folder = tmp_path_factory.mktemp("speed")
    return *run(train, folder), folder


@pytest.fixture(scope="module")
def laws(tmp_path_factory: pytest.TempPathFactory) -> tuple[dict[str, Any], str, Path]:
    folder = tmp_path_factory.mktemp("laws")
    return *run(stiffness_laws, folder), folder


# -- speed -----------------------------------------------------------------------------------------


@pytest.mark.slow
def test_speed_gives_finite_numbers_for_every_method(speed: tuple[dict[str, Any], str, Path]) -> None:
    results, text, folder = speed
    methods = results["cases"]["train"]["methods"]
    expected = {
        "engine, symbolic: DormandPrince",
        "engine, Python functions: DormandPrince",
        "engine, symbolic: RungeKutta4",
        "engine, symbolic: Trapezoidal",
        "scipy LSODA (solve_ivp), Python right side",
        "scipy LSODA (odeint), Python right side",
        "scipy Radau, Python right side",
        "scipy LSODA (solve_ivp), numpy right side",
        "scipy LSODA (odeint), numpy right side",
    }
    if HAS_NUMBA:
        expected |= {f"{name}, compiled right side" for name in ("scipy LSODA (solve_ivp)", "scipy LSODA (odeint)", "scipy Radau")}
        expected |= {"compiled loop: RungeKutta4", "compiled loop: DormandPrince"}
    assert set(methods) == expected
    assert all(name in text for name in expected)
    for path, value in leaves(results):
        # None stands for an error of 1e-6 that the ladder does not reach
        assert is_finite(value) if value is not None else path.endswith("seconds_at_target"), path
    assert {"fresh_processes", "around_a_run", "machine", "repeats", "target_error"} <= set(results)
    assert results["machine"]["exudyn"] in text
    assert pictures(folder) == {"error_against_time.png"}


@pytest.mark.slow
def test_every_method_of_the_speed_benchmark_solves_the_same_train(speed: tuple[dict[str, Any], str, Path]) -> None:
    # the right-hand side by hand and the engine's equations have nothing in common but the scene:
    # a wrong term in either would leave an error that no finer setting lowers
    case = speed[0]["cases"]["train"]
    # two families of methods must agree clearly better than the error at which times are compared
    assert case["reference_agreement"] < 0.1 * TARGET
    for name, method in case["methods"].items():
        coarse, fine = method["error"]
        assert fine < 0.7 * coarse, name
        # the trapezoidal rule with h = 1e-5 s on a mode at 8000 rad/s: phase error (w h)^2/12 per rad, 80 rad in 10 ms
        assert fine < 80.0 * 0.08**2 / 12.0, name


def test_time_at_an_error_is_read_from_the_log_log_line() -> None:
    # error = 1e-4 / time^2 in all three runs: 1e-6 after 10 s
    assert time_at(1e-6, [1e-4 / 4.0, 1e-4 / 64.0, 1e-4 / 2500.0], [2.0, 8.0, 50.0]) == pytest.approx(10.0, rel=1e-12)


def test_time_at_an_error_that_no_run_reaches_is_not_a_number() -> None:
    assert math.isnan(time_at(1e-6, [1e-4, 2e-6], [1.0, 2.0]))


def test_time_at_an_error_is_that_of_the_fastest_run_where_none_near_it_is_worse() -> None:
    assert time_at(1e-6, [1e-7, 2e-8, 1e-3], [1.0, 2.0, 0.1]) == 1.0


# -- stiffness laws ----------------------------------------------------------------------------------


@pytest.mark.slow
def test_stiffness_laws_gives_finite_numbers_for_every_part(laws: tuple[dict[str, Any], str, Path]) -> None:
    results, text, folder = laws
    assert {"machine", "durations", "table_1", "shapes", "pulses", "output_shaft", "reduction", "claims"} == set(results) - {"repeats"}
    for path, value in leaves(results):
        assert value is not None, path
        assert is_finite(value), path
    assert set(results["shapes"]["laws"]) == {"catalogue", "cubic", "jump, torque", "jump, literal", "continuous"}
    assert pictures(folder) == {
        "figure_4_motor.png",
        "figures_5_6_catalogue_and_cubic.png",
        "figures_7_8_jump_and_continuous.png",
        "figures_9_10_load_in_the_gap_torque.png",
        "figure_11_output_shaft.png",
        "contacts_of_the_jump_law.png",
        "steps_and_time.png",
        "reduction_to_two_equations.png",
    }
    assert "## Claims" in text


@pytest.mark.slow
def test_every_claim_of_the_paper_has_numbers_and_a_verdict(laws: tuple[dict[str, Any], str, Path]) -> None:
    claims = laws[0]["claims"]
    places = {claim["where"] for claim in claims}
    assert {"Table 1, (9)", "Table 1, (10)", "Fig. 6", "Fig. 7, (11)-(14)", "Fig. 8, (15)-(17)", "Figs 9-10", "Fig. 11"} <= places
    for claim in claims:
        assert any(character.isdigit() for character in claim["found"]), claim
        assert claim["verdict"], claim


@pytest.mark.slow
def test_table_1_holds_and_the_printed_9_and_10_do_not_give_it(laws: tuple[dict[str, Any], str, Path]) -> None:
    rows = {row["equation"]: row for row in laws[0]["table_1"]["rows"]}
    assert all(f"{row['corrected']:.2e}" == f"{row['table']:.2e}" for row in rows.values())
    # phi0/2 + 98/3.2e4 + 74.5/6.4e4 and phi0/2 + 137/3.2e4 + 113.5/6.4e4 + 39/11e4 by hand
    assert f"{rows['(9)']['as_printed']:.2e}" == "5.54e-03"
    assert f"{rows['(10)']['as_printed']:.2e}" == "7.72e-03"


@pytest.mark.slow
def test_contacts_of_the_jump_law_get_denser_as_derived(laws: tuple[dict[str, Any], str, Path]) -> None:
    contacts = laws[0]["pulses"]["contacts"]
    # (B_FS + B_wwy)/3J with J = 4e-4 + 2.465e-5/2; the derivation drops terms of order b T/J, which is 0.2 for the first
    # excursions (T = 4 us) of a quick run
    assert contacts["growth_rate_theory"] == pytest.approx(25.0 / (3.0 * (4e-4 + 0.5 * 2.465e-5)), rel=1e-4)
    assert contacts["growth_rate"] == pytest.approx(contacts["growth_rate_theory"], rel=0.2)


@pytest.mark.slow
def test_inside_the_gap_torque_only_the_jump_laws_pulse(laws: tuple[dict[str, Any], str, Path]) -> None:
    runs = laws[0]["pulses"]["runs"]
    for law in ("catalogue", "cubic", "continuous", "jump, drawn out"):
        assert runs[f"load in the gap torque / {law} / explicit, fixed step"]["pulses_per_second"] == 0.0
    for law in ("jump, torque", "jump, literal"):
        assert runs[f"load in the gap torque / {law} / explicit, fixed step"]["pulses_per_second"] > 100.0
        assert runs[f"load in the gap torque / {law} / explicit, adaptive"]["steps_per_second"] > 1e6


# -- bearings -----------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def bearings(tmp_path_factory: pytest.TempPathFactory) -> tuple[dict[str, Any], str, Path]:
    """By the command line, which starts a process of its own."""
    folder = tmp_path_factory.mktemp("bearings")
    done = CliRunner().invoke(app, ["bench", "bearings", "--quick", "--workers", "0", "--out", str(folder)], catch_exceptions=False)
    assert done.exit_code == 0, done.output
    return json.loads((folder / "results.json").read_text("utf-8")), (folder / "results.md").read_text("utf-8"), folder


@pytest.mark.slow
def test_bearings_gives_finite_numbers_for_every_model(bearings: tuple[dict[str, Any], str, Path]) -> None:
    results, text, folder = bearings
    models = results["cases"]["M-REF"]["models"]
    assert set(models) == set(MODELS)
    # without a number: bands beyond the end of a quick run-up, the solver it leaves out, maxima that two merge into, widths
    # of peaks with a neighbour
    may_lack = ("above them", "adaptive", "peaks", "damping_ratio", "rotor_1", "rotor_2", "largest")
    for path, value in leaves(results):
        assert is_finite(value) if value is not None else any(word in path for word in may_lack), path
    assert pictures(folder) == {
        "campbell.png",
        "error_against_time.png",
        "figure_6_rotor_1_distances.png",
        "figure_7_rotor_1_trajectory.png",
        "figure_8_rotor_1_vibration.png",
        "figure_9_rotor_1_torsion.png",
        "figure_10_rotor_2_distances.png",
        "figure_11_constant_speed.png",
        "steady_response.png",
        "validity_critical_speeds.png",
        "validity_peaks.png",
        "where_the_damping_sits.png",
    }
    for claim in (*results["claims"], *results["aims"]):
        assert any(character.isdigit() for character in claim["found"]), claim
        assert claim["verdict"], claim
    assert "## Claims of the paper" in text


@pytest.mark.slow
def test_the_converged_run_up_is_that_of_the_independent_model(bearings: tuple[dict[str, Any], str, Path]) -> None:
    # the peak of M-REF lies before the end of the quick run; the kept values are known to 1.1e-6/15 (their ``uncertainty``)
    assert bearings[0]["scipy"]["M-REF"]["amplitude"] < 1e-6
    assert bearings[0]["scipy"]["M-REF"]["speed"] < 1e-6


@pytest.mark.slow
def test_the_two_solvers_of_a_model_agree_where_they_are_converged(bearings: tuple[dict[str, Any], str, Path]) -> None:
    # extrapolation from h = 1e-4 and 2e-4 leaves terms of h^4: (w h)^4 = 4e-5 of 60 rad of phase at 2e-4 and 400 rad/s
    for name, model in bearings[0]["cases"]["M-REF"]["models"].items():
        assert model["agreement"] < 4e-4, name
        coarse, fine = (
            next(run["error"] for run in model["runs"] if run["solver"] == "implicit" and run["setting"] == step) for step in (2e-4, 1e-4)
        )
        assert coarse / fine == pytest.approx(4.0, rel=0.1), name  # order 2


@pytest.mark.slow
def test_the_improved_bearing_keeps_to_the_full_one_and_the_simplified_one_does_not(bearings: tuple[dict[str, Any], str, Path]) -> None:
    models = bearings[0]["cases"]["M-REF"]["models"]
    # aims of the improved model; the limits for the other one are where the paper would call it accurate
    assert max(map(abs, models["improved"]["steady"]["critical_speeds"])) < 5e-4
    assert max(map(abs, models["improved"]["run_up_peak_deviation"].values())) < 5e-3
    assert max(map(abs, models["simplified"]["steady"]["critical_speeds"])) > 0.01
    assert max(map(abs, models["simplified"]["run_up_peak_deviation"].values())) > 0.05


def test_the_longest_step_of_runge_kutta_4_is_that_of_its_stability_region() -> None:
    # Hairer & Wanner II, IV.2: 2.7853 on the negative real axis, 2 sqrt(2) on the imaginary one
    assert longest_step(np.array([-100.0 + 0j])) == pytest.approx(0.027852936, rel=1e-7)
    assert longest_step(np.array([0.0 + 50.0j, 0.0 - 50.0j])) == pytest.approx(2.0 * math.sqrt(2.0) / 50.0, rel=1e-7)


def _run(times: np.ndarray, distance: np.ndarray, speed: np.ndarray) -> RunUp:
    zero = np.zeros_like(times)
    return RunUp(
        times=times,
        angle={"rotor_1": zero},
        speed={"rotor_1": speed},
        lateral={"rotor_1": {"x": distance, "y": zero}},
        eccentricity={"rotor_1": 0.0},
        drive_speed=speed,
        seconds=0.0,
        steps=0,
        rejected=0,
    )


def test_a_peak_between_unequal_samples_is_that_of_their_parabola() -> None:
    times = np.array([0.0, 0.1, 0.3, 0.35, 0.6])
    peak = _run(times, 2.0 - (times - 0.27) ** 2, 10.0 * times).peak("rotor_1")
    assert peak.amplitude == pytest.approx(2.0, rel=1e-12)
    assert peak.speed == pytest.approx(2.7, rel=1e-12)


def test_histories_over_speed_take_the_last_passage_and_nothing_beyond_the_end() -> None:
    times = np.arange(6.0)
    run = _run(times, times, np.array([0.0, 2.0, 1.0, 3.0, 4.0, 4.5]))
    # 1.5 rad/s is passed upwards at t = 0.75 s and, for the last time, at 2.25 s
    found = run.over_speed(times, "rotor_1", np.array([1.5, 3.5, 5.0]))
    assert found[:2] == pytest.approx([2.25, 3.5])
    assert math.isnan(found[2])


def test_bench_passes_options_on_and_names_the_benchmarks_it_has() -> None:
    done = CliRunner().invoke(app, ["bench", "bearings", "--repeats", "0"])
    assert done.exit_code == 2
    with pytest.raises(PlaceError, match=r"No benchmark 'bearing'.*bearings, .*speed, stiffness_laws, .*teeth"):
        CliRunner().invoke(app, ["bench", "bearing"], catch_exceptions=False)


def test_bench_without_a_checkout_says_where_the_benchmarks_are(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(hdrive_mbs, "__file__", str(tmp_path / "site-packages" / "hdrive_mbs" / "__init__.py"))
    monkeypatch.chdir(tmp_path)
    with pytest.raises(SceneError, match=r"not part of the installed package.*source archive \(hdrive_mbs-.*in its folder"):
        CliRunner().invoke(app, ["bench", "bearings"], catch_exceptions=False)

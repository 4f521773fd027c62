"""The drive bench of the withheld cases: its equations, laws and accuracy, independence of the package, sealed labels."""

from __future__ import annotations

import ast
import json
import re
import subprocess
import sys
import tomllib
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import cumulative_trapezoid, solve_ivp

pytest.importorskip("numba", reason="the plants of the withheld cases are compiled with numba (extra: bench)")
pytest.importorskip("pyarrow", reason="withheld cases are Parquet files")

from benchmarks.withheld import make, noise, open_labels, sealing
from benchmarks.withheld.case import KINDS, Case, Cause, Column
from benchmarks.withheld.folder import read_record
from benchmarks.withheld.mixture import SHARES, counts, mixture
from benchmarks.withheld.plant import drive
from benchmarks.withheld.plant.drive_causes import parameters
from benchmarks.withheld.plant.drive_causes.finer_detail import CORNER, EDGE, EXACT
from benchmarks.withheld.plant.drive_train import excitation, line
from benchmarks.withheld.plant.drive_train.banks import LOAD_BANK, bank_torque, no_banks, no_memory, remember, with_bank
from benchmarks.withheld.plant.drive_train.excitation import RECORDS
from benchmarks.withheld.plant.drive_train.gear_error import error, orders, with_side_bands
from benchmarks.withheld.plant.drive_train.motion import TOLERANCE, Motion, follow, motion
from benchmarks.withheld.plant.drive_train.nominal import NOMINAL, UNCERTAINTY
from benchmarks.withheld.plant.drive_train.rates import gear_twist
from benchmarks.withheld.plant.drive_train.sensors import clean
from benchmarks.withheld.plant.drive_train.specimen import Specimen, specimen
from benchmarks.withheld.plant.drive_train.springs import gear_spring, modulated, spring_torque
from benchmarks.withheld.plant.drive_train.whitening import in_noise
from benchmarks.withheld.plant.drive_visibility import Yardstick, signals

ROOT = Path(__file__).parents[2]
SHARED = ROOT.parent / "shared" / "withheld"
WITHHELD = ROOT / "benchmarks" / "withheld"
SHARED_PARTS = ("bench", "case", "draws", "folder", "make", "mixture", "noise", "open_labels", "sealing")

needs_round_1 = pytest.mark.skipif(not SHARED.exists(), reason="needs ../shared/withheld with the data of round 1")


# independence


def generator_sources() -> list[Path]:
    return [*(WITHHELD / f"{name}.py" for name in SHARED_PARTS), *sorted((WITHHELD / "plant").rglob("*.py"))]


def test_no_source_of_the_generator_imports_the_package() -> None:
    sources = generator_sources()
    assert len(sources) > 25
    for source in sources:
        for node in ast.walk(ast.parse(source.read_text(encoding="utf-8"))):
            names = [item.name for item in node.names] if isinstance(node, ast.Import) else []
            names += [node.module or ""] if isinstance(node, ast.ImportFrom) else []
            assert not any(name.split(".")[0] == "hdrive_mbs" for name in names), source


def test_making_cases_loads_nothing_of_the_package() -> None:
    program = "import sys, benchmarks.withheld.make, benchmarks.withheld.plant.drive; print([m for m in sys.modules if 'hdrive' in m])"
    done = subprocess.run([sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


# the bench is that of round 1


@needs_round_1
def test_nominal_parameters_are_those_of_the_data_sheet() -> None:
    sheet = tomllib.loads((SHARED / "drive_bench.toml").read_text(encoding="utf-8"))
    gear, known = sheet["flexspline"], sheet["knowledge"]
    expected = {
        "J_m": sheet["motor"]["inertia"],
        "J_wg": sheet["wave_generator"]["inertia"],
        "J_fs": gear["inertia"],
        "J_l": sheet["load"]["inertia"],
        "k_in": sheet["input_shaft"]["stiffness"],
        "d_in": sheet["input_shaft"]["damping"],
        "k_out": sheet["output_shaft"]["stiffness"],
        "d_out": sheet["output_shaft"]["damping"],
        "d_fs": gear["damping"],
        "b_m": sheet["motor"]["viscous"],
        "b_wg": sheet["wave_generator"]["viscous"],
        "b_l": sheet["load"]["viscous"],
        "u": gear["ratio"],
        **{name: gear[name] for name in ("K1", "K2", "K3", "T1", "T2", "lost_motion")},
        **{name: sheet["motor"]["controller"][name] for name in ("kp", "ki")},
        "tau_max": sheet["motor"]["torque_limit"],
    }
    assert expected == NOMINAL
    for name, deviation in UNCERTAINTY.items():
        group = "lost_motion" if name == "lost_motion" else "damping_and_viscous" if name[0] in "db" else "masses_and_stiffnesses"
        assert deviation == known[group]
    assert tuple(sheet["records"]["names"]) == RECORDS
    assert sheet["records"]["sample_rate"] == excitation.RATE


@needs_round_1
@pytest.mark.parametrize("record", RECORDS)
def test_inputs_are_those_of_the_practice_cases(record: str) -> None:
    values, _ = read_record(SHARED / "practice" / "drive-p01" / f"{record}.parquet")
    reference, brake = excitation.inputs(record)
    np.testing.assert_allclose(excitation.times(), values["time"], atol=1e-12)
    np.testing.assert_allclose(reference, values["speed_reference"], atol=1e-10)
    np.testing.assert_allclose(brake, values["load_torque"], atol=1e-10)


@needs_round_1
@pytest.mark.parametrize("record", RECORDS)
def test_practice_null_is_reproduced_to_its_noise(record: str) -> None:
    """What is left after simulating with the true parameters has the variance of the stated noise.

    For N independent samples the variance spreads by sqrt(2/N); 4 of these are allowed.  The torque
    channel is whitened first, its offset taken out.  The motor encoder only rounds: every sample must be equal.
    """
    folder = SHARED / "practice" / "drive-p01"
    truth = json.loads((folder / "truth.json").read_text(encoding="utf-8"))
    assert truth["truth"] == []
    measured, _ = read_record(folder / f"{record}.parquet")
    channels = specimen(truth["true_parameters"]).channels(record)
    step = 2.0 * np.pi / 16384
    np.testing.assert_array_equal(np.round(channels["motor_angle"] / step), np.round(measured["motor_angle"] / step))
    left = in_noise({name: measured[name] - channels[name] for name in channels}).reshape(4, -1)
    count = left.shape[1]
    assert count == excitation.COUNT
    variance = (left**2).mean(axis=1)
    assert np.all(np.abs(variance[[0, 2, 3]] - 1.0) < 4.0 * np.sqrt(2.0 / count)), variance


@needs_round_1
def test_tables_look_like_those_of_round_1(tmp_path: Path) -> None:
    import pyarrow.parquet as pq

    from benchmarks.withheld.folder import write_case

    home = write_case(tmp_path, "drive-c01", drive.make_case([], np.random.default_rng(1)))
    for record in RECORDS:
        ours = pq.read_schema(home / f"{record}.parquet")
        theirs = pq.read_schema(SHARED / "practice" / "drive-p01" / f"{record}.parquet")
        assert ours.equals(theirs, check_metadata=True)


@needs_round_1
def test_every_name_of_the_answer_format_can_be_put_in_and_no_other() -> None:
    text = (SHARED / "README.md").read_text(encoding="utf-8")
    rows = [row for row in text.splitlines() if row.startswith("| drive")]
    names = {name for row in rows for name in re.findall(r"`(\w+)`", row.split("|")[2])}
    places = {place for row in rows for place in re.findall(r"`(\w+)`", row.split("|")[3])}
    assert len(names) == 23
    assert {cause.name for cause in drive.CAUSES if cause.kind != "unlisted"} == names
    assert {place for cause in drive.CAUSES for place in cause.places} <= places
    assert not {cause.name for cause in drive.CAUSES if cause.kind == "unlisted"} & names


# motion

SHORT = 1e-4  # s, sample of the runs below


def shaken(made: Specimen, *, seconds: float = 0.5, tolerance: float = TOLERANCE) -> tuple[np.ndarray, np.ndarray, Motion]:
    """Times, brake torque and motion of a specimen driven to and fro through every zero crossing."""
    time = np.arange(0.0, seconds, SHORT)
    reference = 80.0 * np.sin(2 * np.pi * 5.0 * time)
    brake = 70.0 * np.sin(2 * np.pi * 7.0 * time + 0.3) * np.minimum(time / 0.05, 1.0)
    return time, brake, follow(made.plant, made.tables, reference, brake, SHORT, tolerance=tolerance)


@pytest.mark.slow
def test_motion_agrees_with_an_implicit_solver_and_equations_written_out_again() -> None:
    """The nominal bench by scipy's Radau on equations written here from the data sheet; 0.01 noise units are allowed."""
    p = NOMINAL
    time, brake, moved = shaken(specimen(NOMINAL), seconds=0.25, tolerance=1e-2 * TOLERANCE)
    reference = 80.0 * np.sin(2 * np.pi * 5.0 * time)

    def spring(twist: float) -> float:
        x = abs(twist) - p["lost_motion"] / 2
        table = [0.0, p["T1"] / p["K1"], p["T1"] / p["K1"] + (p["T2"] - p["T1"]) / p["K2"]]
        if x <= 0.0:
            return 0.0
        torque = np.interp(x, table, [0.0, p["T1"], p["T2"]]) + p["K3"] * max(x - table[2], 0.0)
        return float(np.sign(twist) * torque)

    def rate(at: float, y: np.ndarray) -> list[float]:
        a, wa, b, wb, c, wc, d, wd, i = y
        miss = np.interp(at, time, reference) - wa
        command = np.clip(p["kp"] * miss + p["ki"] * i, -p["tau_max"], p["tau_max"])
        into = p["k_in"] * (a - b) + p["d_in"] * (wa - wb)
        gear = spring(b / p["u"] - c) + p["d_fs"] * (wb / p["u"] - wc)
        out = p["k_out"] * (c - d) + p["d_out"] * (wc - wd)
        return [
            wa,
            (command - into - p["b_m"] * wa) / p["J_m"],
            wb,
            (into - gear / p["u"] - p["b_wg"] * wb) / p["J_wg"],
            wc,
            (gear - out) / p["J_fs"],
            wd,
            (out - p["b_l"] * wd - np.interp(at, time, brake)) / p["J_l"],
            miss if abs(p["kp"] * miss + p["ki"] * i) < p["tau_max"] else 0.0,
        ]

    assert np.abs(moved.command).max() < p["tau_max"]  # no saturation: nothing there for Radau to miss
    found = solve_ivp(rate, (0.0, time[-1]), np.zeros(9), method="Radau", rtol=1e-8, atol=1e-11, max_step=2e-3, t_eval=time[::50])
    assert np.abs(found.y[0] - moved.states[::50, line.MOTOR]).max() < 0.01 * 1.1e-4
    assert np.abs(found.y[6] - moved.states[::50, line.LOAD]).max() < 0.01 * 1.5e-6


@pytest.mark.slow
@pytest.mark.parametrize("name", ["friction_load", "hysteresis_flexspline", "coupling_backlash", "kinematic_error", "brake_lag"])
def test_tighter_tolerance_changes_the_channels_by_less_than_noise(name: str) -> None:
    """Against a hundredth of the tolerance; 0.1 noise units add one part in a hundred thousand to chi-square."""
    place = next(cause.places[-1] for cause in drive.CAUSES if cause.name == name)
    for seed in range(3):
        made = planted(name, place, seed)
        rough, fine = (motion(made.plant, made.tables, "sweep", tolerance=t, samples=8000) for t in (TOLERANCE, 0.01 * TOLERANCE))
        apart = in_noise(clean(rough, made.sensors)) - in_noise(clean(fine, made.sensors))
        assert np.abs(apart).max() < 0.1, (name, seed)


def test_saturated_motor_stays_at_its_limit_and_the_integrator_stops() -> None:
    made = specimen(NOMINAL)
    time = np.arange(0.0, 0.3, SHORT)
    reference = 150.0 * np.minimum(time / 0.01, 1.0)
    moved = follow(made.plant, made.tables, reference, np.zeros(time.size), SHORT)
    integral = moved.states[:, line.INTEGRAL]
    wanted = NOMINAL["kp"] * (reference - moved.states[:, line.MOTOR_SPEED]) + NOMINAL["ki"] * integral
    held = wanted > NOMINAL["tau_max"]
    assert held.sum() > 50  # 5 ms
    np.testing.assert_array_equal(moved.command[held], NOMINAL["tau_max"])
    np.testing.assert_array_equal(np.diff(integral)[held[1:] & held[:-1]], 0.0)
    free = np.abs(wanted) < NOMINAL["tau_max"] - 0.01
    assert np.all(np.abs(np.diff(integral))[free[1:] & free[:-1]] > 0.0)


# energy


def planted(name: str, place: str, seed: int) -> Specimen:
    """The nominal bench with a drawn cause."""
    return drive._PUT[name](np.random.default_rng(seed), place, specimen(NOMINAL), 1.0)


def lost(made: Specimen, *, shafts: Sequence[str] = ("input", "output")) -> tuple[np.ndarray, float]:
    """Energy [J] over time that went in and is neither in inertias and springs nor in the linear dampers, and all that went to and fro.

    ``shafts`` are those whose own linear spring and damper count.
    """
    time, brake, moved = shaken(made)
    y, p, t = moved.states, made.plant, made.tables
    b = p.line
    a, wa, _, wb, c, wc, d, wd = y[:, :8].T
    twist, rate, _, _ = np.array([gear_twist(row, b.ratio, t) for row in y]).T
    grid = np.linspace(twist.min(), twist.max(), 20001)
    stored = cumulative_trapezoid([spring_torque(x, p.spring) for x in grid], grid, initial=0.0)
    beyond = np.maximum(twist - p.spring.half_gap, 0.0) - np.maximum(-twist - p.spring.half_gap, 0.0)
    swing = np.sin(p.spring.modulation_order * y[:, line.WAVE] + p.spring.modulation_phase)
    inertia = b.load_inertia * (1.0 - p.load.hidden_share) * (1.0 + p.load.inertia_depth * np.cos(2 * d + p.load.inertia_phase))
    held = 0.5 * (b.motor_inertia * wa**2 + b.wave_inertia * wb**2 + b.flex_inertia * wc**2 + inertia * wd**2)
    held += 0.5 * b.load_inertia * p.load.hidden_share * y[:, line.HIDDEN_SPEED] ** 2
    held += np.interp(twist, grid, stored) + 0.5 * p.spring.modulation * p.spring.first * swing * beyond**2
    held -= p.load.weight * (
        np.cos(d + p.load.weight_phase) + 0.5 * p.load.weight_second * np.cos(2 * d + p.load.weight_second_phase)
    )  # fmt: skip
    slack = d - p.load.cable_angle
    slope = np.hypot(slack, p.load.cable_width)
    bent = p.load.cable_width**2 * np.arcsinh(slack / (p.load.cable_width or 1.0))
    held += 0.25 * p.load.cable * (slack**2 + slack * slope + bent)  # the integral of the hyperbola
    heat = b.motor_viscous * wa**2 + b.wave_viscous * wb**2 + b.load_viscous * wd**2 + b.flex_damping * rate**2
    if "input" in shafts:
        held += 0.5 * b.input_stiffness * (a - y[:, line.WAVE]) ** 2
        heat += b.input_damping * (wa - wb) ** 2
    if "output" in shafts:
        held += 0.5 * b.output_stiffness * (c - d) ** 2
        heat += b.output_damping * (wc - wd) ** 2
    into = moved.command * wa - brake * wd
    power = into - heat
    return cumulative_trapezoid(power, time, initial=0.0) - (held - held[0]), float(np.trapezoid(np.abs(into) + heat, time))


def with_every_lossless_effect() -> Specimen:
    made = specimen(NOMINAL).part("spring", asymmetry=0.2, asymmetry_twist=1e-4, modulation=0.1, modulation_order=2.0, modulation_phase=0.4)
    made = made.part("load", weight=8.0, weight_phase=0.7, weight_second=0.1, inertia_depth=0.2, inertia_phase=0.3)
    made = made.part("load", cable=300.0, cable_angle=5e-3, cable_width=2e-3)
    error_table, output_table = orders(*with_side_bands(1e-4, 2.0, 0.3, 0.2, 0.01)), orders((2e-3, 2.0, 0.9), (3e-4, 40.0, 0.2))
    return replace(made, tables=made.tables._replace(wave_error=error_table, output_error=output_table))


@pytest.mark.parametrize("made", [specimen(NOMINAL), with_every_lossless_effect()], ids=["nominal", "every lossless effect"])
def test_lossless_effects_keep_the_energy_balance(made: Specimen) -> None:
    """What the sums of 0.1 ms samples miss (second-order in the sample at 600 Hz) is below 1e-4 of what goes to and fro."""
    gone, moved_energy = lost(made)
    assert np.abs(gone).max() < 1e-4 * moved_energy


LOSSY = [
    ("friction_motor", "motor"),
    ("friction_wave_generator", "wave_generator"),
    ("friction_load", "load"),
    ("friction_mesh_load", "mesh"),
    ("hysteresis_flexspline", "flexspline"),
    ("quadratic_drag", "motor"),
    ("coupling_backlash", "input_shaft"),
    ("coupling_backlash", "output_shaft"),
    ("rub_at_an_angle", "wave_generator"),
    ("one_way_drag", "load"),
    ("warming_drag", "motor"),
    ("relaxing_shaft", "output_shaft"),
]


@pytest.mark.parametrize(("name", "place"), LOSSY)
def test_lossy_effects_only_take_energy(name: str, place: str) -> None:
    """Heat and what the law stores add up to more than nothing at every instant, whatever the draw."""
    for seed in range(6):
        shafts = [shaft for shaft in ("input", "output") if place != f"{shaft}_shaft" or name != "coupling_backlash"]
        gone, moved_energy = lost(planted(name, place, seed), shafts=shafts)
        assert gone.min() > -1e-4 * moved_energy, seed
        assert gone[-1] > 0.0, seed


def test_hysteresis_loop_loses_the_same_at_any_speed() -> None:
    """Sliders are rate-independent, so torque depends on the path alone: the loop between two turns has one area."""
    banks = with_bank(no_banks(), LOAD_BANK, 4.0, 1e-3, 3.0)
    areas = []
    for points in (40, 4000):
        memory, work = no_memory(), []
        for turn in (4e-3, -4e-3, 4e-3):
            path = np.linspace(memory.place[LOAD_BANK], turn, points)
            torque = []
            for place in path:
                torque.append(bank_torque(LOAD_BANK, place, 1.0, banks, memory))
                remember(LOAD_BANK, place, 1.0, banks, memory)
            work.append(np.trapezoid(torque, path))
        areas.append(work[1] + work[2])
    assert areas[0] == pytest.approx(areas[1], rel=5e-3)  # the trapezoidal rule on 40 points with ten corners
    # 4 N m over 8 mrad there and back, less the corners: each slider loses 4 L (swing/2 - yield)
    yields = 1e-3 * np.geomspace(1 / 3, 3, 10)
    assert areas[1] == pytest.approx(float(np.sum(4 * 0.4 * (4e-3 - yields))), rel=1e-4)


def test_slope_of_the_kinematic_error_is_its_derivative() -> None:
    table = orders(*with_side_bands(1e-4, 2.0, 0.3, 0.2, 0.01), (2e-5, 6.0, 1.0))
    for angle in (0.0, 1.3, -40.0):
        ahead, behind = (error(angle + step, table)[0] for step in (1e-5, -1e-5))
        assert error(angle, table)[1] == pytest.approx((ahead - behind) / 2e-5, rel=1e-6, abs=1e-12)
    assert error(0.0, table)[0] == pytest.approx(0.0, abs=1e-18)


def test_stiffness_that_follows_the_angle_has_a_potential() -> None:
    """d(torque)/d(angle) equals d(torque on the wave generator)/d(twist)."""
    s = gear_spring(dict(NOMINAL))._replace(modulation=0.1, modulation_order=2.0, modulation_phase=0.4)
    twist, angle, step = 9e-4, 0.8, 1e-6
    by_angle = (modulated(twist, angle + step, s)[0] - modulated(twist, angle - step, s)[0]) / (2 * step)
    by_twist = (modulated(twist + step, angle, s)[1] - modulated(twist - step, angle, s)[1]) / (2 * step)
    assert by_angle == pytest.approx(by_twist, rel=1e-6)


# cases


def test_same_seed_gives_the_same_case_and_another_seed_another() -> None:
    first, again, other = (drive.make_case([], np.random.default_rng(seed)) for seed in (5, 5, 6))
    assert first.labels("x") == again.labels("x")
    for one, two in zip(first.records["sweep"], again.records["sweep"], strict=True):
        np.testing.assert_array_equal(one.values, two.values)
    assert first.true_parameters != other.true_parameters


def test_parameters_and_detail_do_not_depend_on_the_cause() -> None:
    null = drive.make_case([], np.random.default_rng(9))
    wrong = drive.make_case([("parameter_load_inertia", "load")], np.random.default_rng(9))
    assert wrong.more["finer_detail"] == null.more["finer_detail"]
    changed = {name for name in NOMINAL if wrong.true_parameters[name] != null.true_parameters[name]}
    assert changed == {"J_l"}
    factor = wrong.put_in["parameter_factors"]["J_l"]
    assert wrong.true_parameters["J_l"] == pytest.approx(factor * null.true_parameters["J_l"])
    assert wrong.truth[0]["true_over_nominal"]["J_l"] == pytest.approx(wrong.true_parameters["J_l"] / 1.8)


def test_wrong_parameters_are_well_outside_their_tolerance() -> None:
    rng = np.random.default_rng(2)
    for site, symbols in parameters.SYMBOLS.items():
        for _ in range(20):
            factors = parameters.factors(rng, site)
            assert set(factors) == set(symbols)
            deviations = abs(np.log(factors[symbols[0]])) / UNCERTAINTY[symbols[0]]
            assert 5.0 - 1e-9 <= deviations <= 15.0 + 1e-9


def test_records_of_a_case_hold_the_stated_noise() -> None:
    """Measured less simulated in noise units has the variance 1 in every channel (4 spreads of sqrt(2/N) are allowed)."""
    case = drive.make_case([], np.random.default_rng(11))
    detail = case.more["finer_detail"]
    assert case.true_parameters["J_wg"] == pytest.approx(4.5e-4 * detail["wave_inertia"])
    made = specimen(case.true_parameters).part("spring", corner=detail["corner"], edge=detail["edge"])
    measured = {column.name: column.values for column in case.records["staircase"]}
    channels = made.channels("staircase")
    left = in_noise({name: measured[name] - channels[name] for name in channels}).reshape(4, -1)
    variance = (left**2).mean(axis=1)
    assert np.all(np.abs(variance[[0, 2, 3]] - 1.0) < 4.0 * np.sqrt(2.0 / left.shape[1])), variance
    assert np.abs(measured["motor_angle"] - channels["motor_angle"]).max() <= np.pi / 16384 + 1e-12


@pytest.mark.slow
def test_finer_detail_of_nulls_stays_invisible_and_faint_causes_stay_visible() -> None:
    """The same yardstick that no labelled effect may fall below holds for the detail of nulls, at its widest."""
    yardstick = Yardstick(NOMINAL)
    rounded = specimen(NOMINAL).part("spring", corner=CORNER, edge=EDGE)
    heavier = rounded.part("line", wave_inertia=4.5e-4 * (1 + 2 * EXACT), flex_inertia=0.012 * (1 + 2 * EXACT))
    assert yardstick.linear(signals(rounded)) < drive.BARELY
    assert yardstick.linear(signals(heavier)) < 2 * drive.BARELY
    maker = drive._Maker(dict(NOMINAL), 1)
    made, found = maker._one([("gravity_load", "load")], {("gravity_load", "load"): 3}, yardstick, 300.0)
    assert 200.0 <= found["linear"] <= 450.0
    assert made.plant.load.weight < 0.1  # far below what is drawn without scaling
    # moving a parameter is no finding: 0.1 standard deviations cost their prior of 0.01 and what is not linear in so small a step
    moved = specimen({**NOMINAL, "b_l": NOMINAL["b_l"] * np.exp(0.1 * UNCERTAINTY["b_l"])})
    seen = signals(moved)
    assert float((seen - yardstick.plain) @ (seen - yardstick.plain)) > 1000.0
    assert yardstick.linear(seen) < 0.1


def test_first_order_and_coloured_noise_have_the_stated_size_and_memory() -> None:
    rng = np.random.default_rng(4)
    values = noise.first_order(rng, 0.21, 0.9, 400_000)
    # effective number of independent samples of a variance: N (1 - m^2)/(1 + m^2)
    spread = np.sqrt(2.0 / (400_000 * (1 - 0.81) / (1 + 0.81)))
    assert values.var() == pytest.approx(0.21**2, rel=4 * spread)
    assert np.corrcoef(values[1:], values[:-1])[0, 1] == pytest.approx(0.9, abs=0.01)
    mixed = noise.coloured(rng, 2.0, 0.9, 400_000)
    assert mixed.std() == pytest.approx(2.0, rel=0.01)
    assert np.corrcoef(mixed[1:], mixed[:-1])[0, 1] == pytest.approx(0.45, abs=0.01)


# sets and sealed labels


def test_shares_add_up_and_every_effect_occurs() -> None:
    assert sum(counts(60).values()) == 60
    assert set(counts(60)) == set(KINDS) == set(SHARES)
    sets = mixture(drive, 60, np.random.default_rng(0))
    assert [len(sites) for sites in sets].count(0) == counts(60)["null"]
    single = [sites[0][0] for sites in sets if len(sites) == 1]
    assert {cause.name for cause in drive.CAUSES if cause.kind == "effect"} <= set(single)
    places = {cause.name: cause.places for cause in drive.CAUSES}
    assert all(at in places[name] for sites in sets for name, at in sites)
    assert all(drive.may_pair(*sites) and sites[0][0] != sites[1][0] for sites in sets if len(sites) == 2)


class QuickBench:
    """A bench of one record with ten samples."""

    CAUSES = (
        *(Cause(name=kind, places=("here", "there"), kind=kind) for kind in ("effect", "parameter", "sensor", "unlisted")),
        Cause(name="other", places=("here",)),
    )

    def may_pair(self, first: tuple[str, str], second: tuple[str, str]) -> bool:
        return True

    def make_case(self, causes: Sequence[tuple[str, str]], rng: np.random.Generator, *, noise: str) -> Case:
        column = Column(name="time", unit="s", values=rng.standard_normal(10))
        truth = [{"effect": "unknown" if name == "unlisted" else name, "at": at} for name, at in causes]
        return Case(records={"run": [column]}, truth=truth, put_in={}, true_parameters={})


@pytest.fixture
def quick(monkeypatch: pytest.MonkeyPatch) -> QuickBench:
    bench = QuickBench()
    monkeypatch.setattr(make, "load", lambda name: bench)
    return bench


def answers_for(cases: Sequence[str], path: Path) -> Path:
    path.write_text(json.dumps([{"case": case, "verdict": "none", "effects": []} for case in cases]), encoding="utf-8")
    return path


def test_labels_are_sealed_until_every_case_is_answered(quick: QuickBench, tmp_path: Path) -> None:
    folder = tmp_path / "set"
    assert make.main(["--bench", "drive", "--cases", "12", "--out", str(folder)]) == 0
    cases = sorted(path.name for path in folder.iterdir() if path.is_dir())
    assert cases == [f"drive-c{k:02d}" for k in range(1, 13)]
    assert {path.name for path in folder.rglob("*") if path.is_file()} == {"run.parquet", "commitments.json"}
    out = tmp_path / "truths.json"
    early = answers_for(cases[:-1], tmp_path / "early.json")
    assert open_labels.main([str(folder), str(early), "--out", str(out)]) == 1
    assert not out.exists()
    answers = answers_for(cases, tmp_path / "answers.json")
    assert open_labels.main([str(folder), str(answers), "--out", str(out)]) == 0
    truths = json.loads(out.read_text(encoding="utf-8"))
    assert sorted(truths) == cases
    committed = json.loads((folder / "commitments.json").read_text(encoding="utf-8"))
    assert all(re.fullmatch(r"[0-9a-f]{64}", item) for item in committed.values())
    made = json.loads((tmp_path / "made.json").read_text(encoding="utf-8"))
    again = tmp_path / "again"
    assert (made["bench"], made["noise"], made["nulls"]) == ("drive", "stated", False)
    assert make.main(["--bench", "drive", "--cases", str(made["cases"]), "--seed", str(made["seed"]), "--out", str(again)]) == 0
    for case in cases:  # the seed in made.json gives the same records
        assert (again / case / "run.parquet").read_bytes() == (folder / case / "run.parquet").read_bytes()
    assert len(set(committed.values())) == 12  # nulls with the same text differ by their salt


def test_a_changed_truth_is_noticed(tmp_path: Path) -> None:
    sealed = {"drive-c01": sealing.seal({"case": "drive-c01", "truth": []})}
    sealing.write_commitments(tmp_path, sealed)
    forged = {"drive-c01": replace(sealed["drive-c01"], text='{"case": "drive-c01", "truth": [1]}')}
    honest, false = (sealing.write_key(tmp_path / name, item, {}) for name, item in (("a.zip", sealed), ("b.zip", forged)))
    commitments = tmp_path / sealing.COMMITMENTS
    assert sealing.open_key(honest, commitments, answered=["drive-c01"]) == {"drive-c01": {"case": "drive-c01", "truth": []}}
    with pytest.raises(sealing.SealError, match="does not belong to its commitment"):
        sealing.open_key(false, commitments, answered=["drive-c01"])


def test_a_set_is_never_overwritten(quick: QuickBench, tmp_path: Path) -> None:
    arguments = ["--bench", "drive", "--cases", "3", "--seed", "1", "--out", str(tmp_path / "set"), "--open"]
    assert make.main(arguments) == 0
    with pytest.raises(SystemExit):
        make.main(arguments)


def test_a_set_of_named_causes_holds_nothing_else_and_is_never_sealed(
    quick: QuickBench, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    names = [cause.name for cause in quick.CAUSES if cause.kind == "effect"][:2]
    arguments = ["--bench", "drive", "--cases", "6", "--seed", "1", "--causes", ",".join(names)]
    assert make.main([*arguments, "--open", "--out", str(tmp_path / "set")]) == 0
    found = [json.loads(path.read_text(encoding="utf-8"))["truth"] for path in sorted(tmp_path.glob("set/*/truth.json"))]
    assert len(found) == 6
    assert all(len(truth) == 1 for truth in found)
    assert {truth[0]["effect"] for truth in found} == set(names)
    unknown = [*arguments[:-1], "nonsense", "--open"]
    for wrong, words in ((arguments, "it goes with --open"), (unknown, "--causes nonsense: the drive bench has")):
        with pytest.raises(SystemExit):
            make.main([*wrong, "--out", str(tmp_path / "other")])
        assert words in capsys.readouterr().err
    assert not (tmp_path / "other").exists()


def test_a_set_of_nulls_holds_no_cause_and_is_sealed_all_the_same(
    quick: QuickBench, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "set"
    assert make.main(["--bench", "drive", "--cases", "5", "--nulls", "--out", str(folder)]) == 0
    answers = answers_for([f"drive-c{k:02d}" for k in range(1, 6)], tmp_path / "answers.json")
    assert open_labels.main([str(folder), str(answers), "--out", str(tmp_path / "truths.json")]) == 0
    truths = json.loads((tmp_path / "truths.json").read_text(encoding="utf-8"))
    assert [labels["truth"] for labels in truths.values()] == [[]] * 5
    assert json.loads((tmp_path / "made.json").read_text(encoding="utf-8"))["nulls"] is True
    with pytest.raises(SystemExit):
        make.main(["--bench", "drive", "--nulls", "--open", "--causes", "other", "--out", str(tmp_path / "other")])
    assert "argument --causes: not allowed with argument --nulls" in capsys.readouterr().err


def test_a_set_of_pairs_holds_two_different_causes_in_every_case(
    quick: QuickBench, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    folder = tmp_path / "set"
    assert make.main(["--bench", "drive", "--cases", "4", "--pairs", "--seed", "3", "--open", "--out", str(folder)]) == 0
    truths = [json.loads(path.read_text(encoding="utf-8"))["truth"] for path in sorted(folder.glob("*/truth.json"))]
    assert len(truths) == 4
    assert all(len({cause["effect"] for cause in truth}) == 2 for truth in truths)
    with pytest.raises(SystemExit):
        make.main(["--bench", "drive", "--pairs", "--nulls", "--out", str(tmp_path / "other")])
    assert "argument --nulls: not allowed with argument --pairs" in capsys.readouterr().err


def test_a_set_of_causes_without_a_name_holds_one_in_every_case(quick: QuickBench, tmp_path: Path) -> None:
    folder = tmp_path / "set"
    assert make.main(["--bench", "drive", "--cases", "3", "--unlisted", "--seed", "3", "--open", "--out", str(folder)]) == 0
    truths = [json.loads(path.read_text(encoding="utf-8"))["truth"] for path in sorted(folder.glob("*/truth.json"))]
    assert [[cause["effect"] for cause in truth] for truth in truths] == [["unknown"]] * 3


@needs_round_1
def test_the_scorer_of_round_1_reads_the_labels(quick: QuickBench, tmp_path: Path) -> None:
    folder = tmp_path / "set"
    assert make.main(["--bench", "drive", "--cases", "20", "--seed", "1", "--out", str(folder), "--open"]) == 0
    answers: list[dict[str, Any]] = []
    for path in sorted(folder.glob("*/truth.json")):
        labels = json.loads(path.read_text(encoding="utf-8"))
        named = [item for item in labels["truth"] if item["effect"] != "unknown"]
        where = [{"at": item["at"], "probability": 1.0} for item in labels["truth"]]
        verdict = "none" if not labels["truth"] else "effect" if named else "unknown"
        verdict = "parameter" if verdict == "effect" and named[0]["effect"].startswith("parameter_") else verdict
        answers.append({"case": labels["case"], "verdict": verdict, "effects": named, "where": where, "ranking": []})
    (tmp_path / "answers.json").write_text(json.dumps(answers), encoding="utf-8")
    scored = [sys.executable, str(SHARED / "score.py"), str(tmp_path / "answers.json"), str(folder)]
    done = subprocess.run(scored, capture_output=True, text=True, check=True)
    assert "effect 20/20" in done.stdout

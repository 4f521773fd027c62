"""Compiled lines: every operation means what numpy means, runs equal those of the engine, code is shared by structure."""

from __future__ import annotations

import dataclasses
import math
import threading
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import hdrive_mbs as hm
from hdrive_mbs.compiled import lanes, threads
from hdrive_mbs.compiled import line as compiled_line
from hdrive_mbs.compiled import machine as compiled_machine
from hdrive_mbs.compiled.lanes import Lanes, run_lanes
from hdrive_mbs.compiled.line import CompiledLine, CompiledRun, run_many
from hdrive_mbs.compiled.machine import machine, processor
from hdrive_mbs.compiled.program import Program, program
from hdrive_mbs.compiled.time_inputs import Grid
from hdrive_mbs.errors import PlaceError, SimulationError
from hdrive_mbs.expression import Expression, constant, evaluate, record, variable
from hdrive_mbs.expression.node import NUMERIC
from hdrive_mbs.expression.pieces import lines_between
from models.harmonic_drive_train import build
from tests.patience import PATIENCE

x, v, t = variable("x"), variable("v"), variable("t")
POINTS = (-2.5, -1.0, -0.3, -0.0, 0.0, 1e-9, 0.3, 1.0, 2.0, 3.75)
CHANNELS = ("motor.speed", "load.speed", "load.angle", "gear.torque", "gear.twist")


def law_program(law: Expression) -> Program:
    """The law as what is read from two variables that stand still."""
    return program([constant(0.0), constant(0.0)], [record(law)], ["t", "x", "v"])


def computed(law: Expression, at_x: float, at_v: float, at_t: float = 0.5) -> float:
    """The law by machine code, the same in one lane and beside others."""
    made = law_program(law)
    width = processor().lanes
    alone, _ = run_lanes(Lanes([made], 1), np.array([[at_x, at_v]]), 1, 1.0, 1, at_t)
    others = np.array([[at_x, at_v], [3.0, -1.0], *[[at_x, at_v]] * (width - 2)])
    beside, _ = run_lanes(Lanes([made] * width, width), others, 1, 1.0, 1, at_t)
    for lane in {0, width - 1} - {1}:
        assert_same(beside[0, lane, 0], alone[0, 0, 0])
    return float(alone[0, 0, 0])


def assert_same(got: float, want: float) -> None:
    if math.isnan(want) or math.isinf(want):
        assert got == want or (math.isnan(got) and math.isnan(want))
    else:
        assert got == pytest.approx(want, rel=1e-13, abs=1e-15)  # another libm, another last bit


@pytest.mark.parametrize("operation", NUMERIC)
def test_every_operation_means_what_numpy_means(operation: str) -> None:
    function = NUMERIC[operation]
    arguments: tuple[Expression, ...] = (x, v, constant(7.0))[: function.nin if isinstance(function, np.ufunc) else 3]
    if operation in ("and", "or"):
        arguments = (x < 0.5, v <= 0.0)
    elif operation == "not":
        arguments = (x < 0.5,)
    elif operation == "where":
        arguments = (x < v, x, constant(7.0))
    law = Expression(operation, arguments)
    for at_x in POINTS:
        for at_v in POINTS:
            with np.errstate(all="ignore"):
                want = float(evaluate(law, {"x": np.float64(at_x), "v": np.float64(at_v), "t": np.float64(0.5)}))
            assert_same(computed(law, at_x, at_v), want)


@settings(max_examples=60, deadline=None)
@given(st.lists(st.floats(-5.0, 5.0), min_size=2, max_size=40, unique=True), st.floats(-7.0, 7.0))
def test_a_table_of_any_length_is_read_as_numpy_reads_it(points: list[float], at: float) -> None:
    grid = np.array(sorted(points))
    heights = np.sin(3.0 * grid) + grid**2
    law = lines_between(grid, heights, heights[0], heights[-1])(x)
    assert_same(computed(law, at, 0.0), float(np.interp(at, grid, heights)))
    assert_same(computed(law, float(grid[0]), 0.0), float(heights[0]))


def test_comparisons_of_comparisons_and_numbers_from_them_come_out() -> None:
    law = np.where((x < 1.0) & ~(v < 0.0), 1.0, 0.0) + (x < v) * 3.0
    for at_x, at_v, want in ((0.5, 0.7, 4.0), (0.5, -1.0, 0.0), (2.0, 3.0, 3.0)):
        assert computed(record(law), at_x, at_v) == want


def test_equal_laws_with_other_numbers_share_one_code() -> None:
    first, second = (law_program(record(k * x + np.tanh(v / w))) for k, w in ((3.7, 0.2), (9.1, 0.4)))
    assert first.structure == second.structure
    assert machine(first.structure) is machine(second.structure)
    assert list(first.constants) != list(second.constants)


def operations(law: Expression) -> list[str]:
    return [step.operation for step in law_program(law).structure.steps]


def hardening(exponent: float, smallest: float = 1e-6) -> Expression:
    return record(np.maximum(abs(v) / 3.1, smallest) ** exponent)


def test_a_power_that_a_law_asks_for_twice_is_computed_once_and_comes_out_the_same() -> None:
    twice = record(hardening(1.3) * x + np.tanh(x) / (1.0 + hardening(1.3)))
    assert operations(twice).count("pow") == 1
    for at_v in POINTS:
        want = float(evaluate(twice, {"x": np.float64(0.7), "v": np.float64(at_v), "t": np.float64(0.5)}))
        assert_same(computed(twice, 0.7, at_v), want)


def test_powers_that_differ_in_a_number_are_computed_apart() -> None:
    for other in (hardening(1.4), hardening(1.3, smallest=1e-5), record(np.maximum(abs(x) / 3.1, 1e-6) ** 1.3)):
        assert operations(record(hardening(1.3) + other)).count("pow") == 2


def test_sums_and_products_with_numbers_that_are_equal_by_chance_keep_their_structure() -> None:
    for part in (x, hardening(1.3), record(np.tanh(x))):
        laws = [record(a * part + b * part + (part + a) * (part + b)) for a, b in ((3.7, 3.7), (3.7, 4.1))]
        first, second = (law_program(law).structure for law in laws)
        assert first == second


def test_sine_and_cosine_of_one_angle_are_those_of_each_alone() -> None:
    angle = record(3.0 * x + v)
    sine, cosine = np.sin(angle), np.cos(angle)
    for at_x in (*POINTS, 1e3, -7.5e5, 2e13):
        alone = computed(sine, at_x, 0.4), computed(cosine, at_x, 0.4)
        together = computed(record(2.0 * sine + 3.0 * cosine), at_x, 0.4)
        np.testing.assert_equal(together, 2.0 * alone[0] + 3.0 * alone[1])


@pytest.mark.parametrize("effect", [hm.PreslidingFriction, hm.LuGreFriction, hm.DahlFriction])
def test_a_law_of_friction_has_each_power_once_whatever_its_values(effect: type[hm.Effect]) -> None:
    def structure(**values: float) -> object:
        law = effect(coulomb=0.02, **values)
        return CompiledLine(build().with_effect(law, at="motor").network(), CHANNELS).structure

    plain = {hm.PreslidingFriction: {"presliding": 1e-3, "drop": 0.3, "stribeck_speed": 2.3, "stribeck_exponent": 1.2, "exponent": 1.4},
             hm.LuGreFriction: {"drop": 0.3, "stribeck_speed": 2.3, "stiffness": 40.0, "damping": 1e-4},
             hm.DahlFriction: {"presliding": 1e-3, "exponent": 1.4}}[effect]  # fmt: skip
    made = structure(**plain)
    costly = [step for step in made.steps if step.operation in ("pow", "exp")]  # type: ignore[attr-defined]
    contents = {(step.operation, step.arguments) for step in costly}
    assert len(contents) == len(costly) <= 2
    # values that are equal by chance change nothing
    chance = {"stiffness": 2.3} if effect is hm.LuGreFriction else {"exponent": 1.2}
    assert structure(**plain | chance) == made


def with_effects() -> hm.Scene:
    """The train with laws of many kinds: states, kinematic terms, branches, tables."""
    train = build().replacing({"load.torque": hm.TableTorque(times=(0.0, 0.05, 0.1, 0.2), torques=(0.0, 8.0, 20.0, 20.0))})
    train = train.with_effect(hm.KinematicError(amplitude=1e-4, order=2), at="gear.mesh")
    train = train.with_effect(hm.CoulombStribeckFriction(coulomb=0.02, smoothing_speed=0.5), at="motor")
    train = train.with_effect(hm.MeshFriction(loss_factor=0.1), at="gear.mesh")
    return train.with_effect(hm.BoucWenHysteresis(torque_limit=3.0, yield_twist=2e-4), at="gear.mesh")


@pytest.mark.parametrize("scene", [build(), with_effects()], ids=["nominal", "effects"])
def test_a_compiled_run_equals_that_of_the_engine(scene: hm.Scene) -> None:
    line = CompiledLine(scene.network(), CHANNELS)
    run = line.run(101, 2e-3, step=5e-6)
    half = line.run(101, 2e-3, step=1e-5)
    engine = hm.simulate(scene, 0.2, solver=hm.DormandPrince(relative_tolerance=1e-10, absolute_tolerance=1e-12, max_step=1e-4))
    for name in CHANNELS:
        size = float(np.max(np.abs(run.values[name])))
        wanted = engine.at(name, run.times)
        own = float(np.max(np.abs(run.values[name] - half.values[name]))) / size
        assert own < 1e-6, name
        np.testing.assert_allclose(run.values[name], wanted, rtol=0.0, atol=1e-6 * size, err_msg=name)


def test_the_compiled_method_is_of_order_four() -> None:
    # a train without corners and with little damping, so that steps can be long enough for the error to stand out of rounding
    smooth = {"gear.stiffness": lambda twist: 3e4 * twist + 4e9 * twist**3, "load.torque": hm.ConstantTorque(value=5.0)}
    scene = build().replacing({**smooth, "gear.damping": 0.2, "output_shaft.damping": 0.05})
    line = CompiledLine(scene.network(), CHANNELS)
    ends = [line.run(2, 0.02, step=step).values["gear.torque"][-1] for step in (4e-5, 2e-5, 1e-5)]
    order = math.log2(abs(ends[0] - ends[1]) / abs(ends[1] - ends[2]))
    assert order == pytest.approx(4.0, abs=0.4)


def test_a_scene_with_other_numbers_runs_on_the_same_code() -> None:
    first = CompiledLine(build().network(), CHANNELS)
    heavier = CompiledLine(build().replacing({"motor.inertia": 1.9e-3}).network(), CHANNELS)
    assert machine(heavier.structure) is machine(first.structure)
    slow, fast = (line.run(2, 0.05, step=1e-5).values["motor.speed"][-1] for line in (heavier, first))
    assert slow < fast


def test_a_run_that_grows_without_bound_says_from_when_on() -> None:
    line = CompiledLine(build().network(), CHANNELS)
    with pytest.raises(SimulationError, match=r"not finite from t = .* Use a shorter step"):
        line.run(200, 1e-3, step=1e-3)


def test_an_unknown_channel_is_refused_with_those_there_are() -> None:
    with pytest.raises(PlaceError, match=r"No channel 'motor\.sped'.*motor\.speed"):
        CompiledLine(build().network(), ["motor.sped"])


# -- many lines at once ------------------------------------------------------------------------------------------------


def trains(count: int) -> list[hm.Scene]:
    """Trains that differ in numbers: inertia, loss of the mesh, and the heights of the load's table."""
    scenes = []
    for k in range(count):
        heights = tuple(value * (1.0 + 0.1 * k) for value in (0.0, 8.0, 20.0, 20.0))
        table = hm.TableTorque(times=(0.0, 0.05, 0.1, 0.2), torques=heights)
        changes = {"motor.inertia": 1e-3 * (1.0 + 0.05 * k), "load.torque": table, "mesh_friction.loss_factor": 0.05 + 0.01 * k}
        scenes.append(with_effects().replacing(changes))
    return scenes


def finished(found: CompiledRun | SimulationError) -> CompiledRun:
    assert isinstance(found, CompiledRun)
    return found


@pytest.mark.parametrize("count", [1, 3, processor().lanes, processor().lanes + 1, processor().wide + 1])
def test_lines_side_by_side_come_out_as_each_line_alone(count: int) -> None:
    lines = [CompiledLine(scene.network(), CHANNELS) for scene in trains(count)]
    assert len({line.structure for line in lines}) == 1
    together = [finished(found) for found in run_many(lines, 101, 2e-3, step=1e-5)]
    for line, run in zip(lines, together, strict=True):
        alone = line.run(101, 2e-3, step=1e-5)
        for name in CHANNELS:
            size = float(np.max(np.abs(alone.values[name])))
            np.testing.assert_allclose(run.values[name], alone.values[name], rtol=1e-12, atol=1e-12 * size, err_msg=name)
    ends = {float(run.values["load.speed"][-1]) for run in together}
    assert len(ends) == count  # other numbers, another end


def test_lines_of_several_structures_come_back_in_their_order() -> None:
    scenes = [build(), with_effects(), build().replacing({"motor.inertia": 1.5e-3}), with_effects().replacing({"motor.inertia": 2e-3})]
    lines = [CompiledLine(scene.network(), CHANNELS) for scene in scenes]
    for line, found in zip(lines, run_many(lines, 11, 2e-3, step=1e-5), strict=True):
        np.testing.assert_allclose(finished(found).values["motor.speed"], line.run(11, 2e-3, step=1e-5).values["motor.speed"], rtol=1e-12)


def test_threads_change_no_bit_of_a_run() -> None:
    scenes = [*trains(2 * processor().lanes + 1), with_effects(), build().replacing({"output_shaft.stiffness": 5e9})]
    lines = [CompiledLine(scene.network(), CHANNELS) for scene in scenes]
    alone = run_many(lines, 31, 1e-3, step=2e-5)
    with threads.allowed(lambda: 3):
        assert threads.at_hand() == 3
        together = run_many(lines, 31, 1e-3, step=2e-5)
    assert threads.at_hand() == 1
    assert isinstance(alone[-1], SimulationError)
    for one, other in zip(alone, together, strict=True):
        if isinstance(one, SimulationError):
            assert str(other) == str(one)
            continue
        for name in CHANNELS:
            np.testing.assert_array_equal(finished(other).values[name], one.values[name], err_msg=name)


def test_threads_run_side_by_side_and_give_their_answers_in_order() -> None:
    meeting = threading.Barrier(3, timeout=PATIENCE)  # nobody passes before three are there

    def meet(number: int) -> int:
        meeting.wait()
        return number

    with threads.allowed(lambda: 3):
        assert threads.side_by_side(meet, range(6)) == list(range(6))
    assert threads.side_by_side(lambda number: -number, range(3)) == [0, -1, -2]


def test_a_lane_that_diverges_leaves_the_others_alone() -> None:
    nominal = CompiledLine(build().network(), CHANNELS)
    stiff = CompiledLine(build().replacing({"output_shaft.stiffness": 5e9}).network(), CHANNELS)
    assert stiff.structure == nominal.structure
    first, broken, last = run_many([nominal, stiff, nominal], 21, 1e-3, step=2e-5)
    assert isinstance(broken, SimulationError)
    with pytest.raises(SimulationError) as alone:
        stiff.run(21, 1e-3, step=2e-5)
    assert str(broken) == str(alone.value)
    wanted = nominal.run(21, 1e-3, step=2e-5).values["gear.torque"]
    for found in (first, last):
        np.testing.assert_allclose(finished(found).values["gear.torque"], wanted, rtol=1e-12)


def test_each_lane_reads_its_own_table_whatever_its_length() -> None:
    scenes = []
    for points in (3, 9, 30):
        twists = np.linspace(-2e-3, 2e-3, points)
        table = hm.TableStiffness(twists=tuple(twists), torques=tuple(3e4 * twists + 2e9 * twists**3))
        scenes.append(build().replacing({"gear.stiffness": table}))
    lines = [CompiledLine(scene.network(), CHANNELS) for scene in scenes]
    assert len({line.structure for line in lines}) == 1
    ends = set()
    for line, found in zip(lines, run_many(lines, 51, 1e-3, step=1e-5), strict=True):
        got, alone = finished(found).values["gear.twist"], line.run(51, 1e-3, step=1e-5).values["gear.twist"]
        np.testing.assert_allclose(got, alone, rtol=1e-12, atol=1e-15)
        ends.add(float(got[-1]))
    assert len(ends) == 3


def test_a_table_of_time_is_evaluated_once_for_all_lines_that_share_it() -> None:
    tables = [((0.0, 0.05, 0.1, 0.2), (0.0, 8.0, 20.0, top)) for top in (20.0, 20.0, 21.0)]
    lines = []
    for k, (times, torques) in enumerate(tables):
        scene = build().replacing({"motor.inertia": 1e-3 + 1e-5 * k, "load.torque": hm.TableTorque(times=times, torques=torques)})
        lines.append(CompiledLine(scene.network(), CHANNELS))
    grid = Grid(0.0, 1e-3, 2, 0, 5)
    first, same, other = ([item.column(grid) for item in line.program.inputs] for line in lines)
    assert len(first) == 2  # the time and the load
    assert first[1] is same[1]
    assert first[1] is not other[1]
    np.testing.assert_allclose(first[1], np.interp(grid.times(), *tables[0]), rtol=1e-13)


def test_a_table_of_tuples_is_read_once_and_one_that_can_change_each_time() -> None:
    points, heights = tuple(np.arange(5.0)), tuple(np.arange(5.0) ** 2)
    first, again = (record(np.interp(x, points, heights)).data for _ in range(2))
    assert first is again
    array = np.array(heights)
    before = record(np.interp(x, points, array))
    array[1] = 7.0
    after = record(np.interp(x, points, array))
    assert (evaluate(before, {"x": 1.0}), evaluate(after, {"x": 1.0})) == (1.0, 7.0)


def test_the_grid_of_inputs_meets_every_half_step_and_every_sample() -> None:
    times = Grid(0.1, 1e-3, 3, 4, 10).times()
    np.testing.assert_allclose(np.diff(times), 0.5e-3 / 3.0, rtol=1e-9)
    assert list(times[::6]) == [0.1 + 1e-3 * k for k in range(4, 15)]


def test_a_run_in_blocks_equals_a_run_in_one(monkeypatch: pytest.MonkeyPatch) -> None:
    line = CompiledLine(with_effects().network(), CHANNELS)
    whole = line.run(50, 1e-3, step=1e-5)
    monkeypatch.setattr(lanes, "BLOCK", 7 * 200)  # 7 samples of 200 half steps
    parts = line.run(50, 1e-3, step=1e-5)
    for name in CHANNELS:
        np.testing.assert_array_equal(parts.values[name], whole.values[name])
    monkeypatch.setattr(lanes, "BLOCK", 4)  # 2 samples of 2 half steps
    with pytest.raises(SimulationError, match=r"not finite from t = ") as late:
        CompiledLine(build().network(), CHANNELS).run(200, 1e-3, step=1e-3)
    monkeypatch.undo()
    with pytest.raises(SimulationError) as at_once:
        CompiledLine(build().network(), CHANNELS).run(200, 1e-3, step=1e-3)
    assert str(late.value) == str(at_once.value)


def test_initial_values_are_given_for_all_lines_or_for_each() -> None:
    line = CompiledLine(build().network(), CHANNELS)
    each = [{"motor": 10.0}, {"motor": 20.0}]
    slow, fast = run_many([line, line], 2, 1e-4, step=1e-5, speeds=each)
    for found, own in zip((slow, fast), each, strict=True):
        alone = line.run(2, 1e-4, step=1e-5, speeds=own)
        np.testing.assert_allclose(finished(found).values["motor.speed"], alone.values["motor.speed"], rtol=1e-12)
    both = [finished(found).values["motor.speed"][0] for found in run_many([line, line], 2, 1e-4, step=1e-5, speeds={"motor": 5.0})]
    assert both == [5.0, 5.0]
    with pytest.raises(hm.ParameterError, match="1 mappings of speeds for 2 lines"):
        run_many([line, line], 2, 1e-4, step=1e-5, speeds=[{"motor": 5.0}])


def test_no_lines_make_no_runs() -> None:
    assert run_many([], 2, 1e-4, step=1e-5) == []
    assert run_many([], [], 1e-4, step=1e-5) == []


def test_lines_of_several_lengths_go_side_by_side_the_longest_first(monkeypatch: pytest.MonkeyPatch) -> None:
    wide = processor().wide
    counts = [(11, 31, 21)[k % 3] for k in range(wide + 2)]
    lines = [CompiledLine(scene.network(), CHANNELS) for scene in trains(len(counts))]
    went: list[int] = []

    def counted(lanes: Lanes, initial: np.ndarray, samples: int, *more: Any) -> Any:
        went.append(samples)
        return run_lanes(lanes, initial, samples, *more)

    monkeypatch.setattr(compiled_line, "run_lanes", counted)
    together = run_many(lines, counts, 1e-3, step=2e-5)
    longest = sorted(counts, reverse=True)
    assert went == [longest[0], longest[wide]]
    for line, count, found in zip(lines, counts, together, strict=True):
        alone = line.run(count, 1e-3, step=2e-5)
        np.testing.assert_array_equal(finished(found).times, alone.times)
        for name in CHANNELS:
            np.testing.assert_array_equal(finished(found).values[name], alone.values[name], err_msg=name)


def test_what_grows_after_the_end_of_a_shorter_line_is_none_of_it() -> None:
    stiff = CompiledLine(build().replacing({"output_shaft.stiffness": 5e9}).network(), CHANNELS)
    nominal = CompiledLine(build().network(), CHANNELS)
    short, long, other = run_many([stiff, stiff, nominal], [1, 21, 21], 1e-3, step=2e-5)
    assert len(finished(short).times) == 1
    assert isinstance(long, SimulationError)
    assert len(finished(other).times) == 21


@pytest.mark.parametrize(
    ("samples", "message"), [([2], "1 numbers of samples for 2 lines"), ([2, 0], "samples = 0, every"), (0, "samples = 0, every")]
)
def test_numbers_of_samples_that_do_not_fit_are_refused(samples: int | list[int], message: str) -> None:
    line = CompiledLine(build().network(), CHANNELS)
    with pytest.raises(hm.ParameterError, match=message):
        run_many([line, line], samples, 1e-4, step=1e-5)


def test_wide_lanes_serve_only_groups_that_narrow_ones_do_not_hold(monkeypatch: pytest.MonkeyPatch) -> None:
    """Twice as many lanes take longer: a few lines do without them, and need no machine code for them."""
    monkeypatch.setattr(compiled_line, "processor", lambda: dataclasses.replace(processor(), lanes=2, wide=4))
    went: list[int] = []

    def counted(lanes: Lanes, *more: Any) -> Any:
        went.append(lanes.width)
        return run_lanes(lanes, *more)

    monkeypatch.setattr(compiled_line, "run_lanes", counted)
    for count, widths in ((1, [2]), (2, [2]), (3, [4]), (5, [4, 2]), (7, [4, 4])):
        went.clear()
        lines = [CompiledLine(scene.network(), CHANNELS) for scene in trains(count)]
        together = run_many(lines, 11, 1e-3, step=2e-5)
        assert went == widths
        for line, found in zip(lines, together, strict=True):
            np.testing.assert_array_equal(finished(found).values["load.speed"], line.run(11, 1e-3, step=2e-5).values["load.speed"])


@pytest.mark.parametrize("name", ["sin", "cos", "exp", "tanh", "log"])
def test_functions_of_all_lanes_are_exact_over_their_range(name: str) -> None:
    rng = np.random.default_rng(5)
    reach = {"sin": 1e4, "cos": 1e4, "exp": 700.0, "tanh": 30.0, "log": 1e12}[name]
    sizes = np.concatenate((rng.uniform(0.0, reach, 400), 10.0 ** rng.uniform(-12.0, math.log10(reach), 400)))
    at = sizes if name == "log" else np.where(rng.random(800) < 0.5, -1.0, 1.0) * sizes
    made = law_program(Expression(name, (x,)))
    width = processor().lanes
    got = []
    for first in range(0, len(at), width):
        states = np.column_stack((at[first : first + width], np.zeros(width)))
        got += list(run_lanes(Lanes([made] * width, width), states, 1, 1.0, 1, 0.0)[0][0, :, 0])
    # numpy's functions are good to one unit in the last place; beside zeros of sin and cos at 1e4 rad 1e-29 is left
    np.testing.assert_allclose(
        got, {"sin": np.sin, "cos": np.cos, "exp": np.exp, "tanh": np.tanh, "log": np.log}[name](at), rtol=2e-15, atol=2e-29
    )


def test_angles_beyond_all_measure_make_a_lane_that_is_not_finite() -> None:
    assert math.isnan(computed(record(np.sin(x)), 2e13, 0.0))
    assert computed(record(np.sin(x)), 0.9e13, 0.0) == pytest.approx(math.sin(0.9e13), rel=1e-12)


def test_half_and_whole_powers_are_those_of_numpy() -> None:
    for exponent in (-9.0, -1.5, -0.5, 0.5, 1.5, 2.5, 3.0, 9.0):
        for base in (1e-6, 0.37, 1.0, 42.0):
            assert_same(computed(x**exponent, base, 0.0), base**exponent)


@pytest.mark.parametrize(("width", "fused"), [(2, False), (4, True), (8, False)])
def test_other_processors_compute_the_same(width: int, fused: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    scene = with_effects().replacing({"bouc_wen_hysteresis.exponent": 1.7})
    line = CompiledLine(scene.network(), CHANNELS)
    wanted = line.run(51, 2e-3, step=1e-5)
    other = dataclasses.replace(processor(), lanes=width, wide=width, fused=fused)
    for module in (compiled_line, compiled_machine):
        monkeypatch.setattr(module, "processor", lambda: other)
    machine.cache_clear()
    found = run_many([line, line], 51, 2e-3, step=1e-5)
    machine.cache_clear()
    for name in CHANNELS:
        size = float(np.max(np.abs(wanted.values[name])))
        np.testing.assert_allclose(finished(found[1]).values[name], wanted.values[name], rtol=0.0, atol=1e-11 * size, err_msg=name)

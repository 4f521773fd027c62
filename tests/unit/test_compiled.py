"""Compiled lines: every operation means what numpy means, runs equal those of the engine, code is shared by structure."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import hdrive_mbs as hm
from hdrive_mbs.compiled.line import CompiledLine
from hdrive_mbs.compiled.machine import machine, pointer
from hdrive_mbs.compiled.program import program
from hdrive_mbs.errors import PlaceError, SimulationError
from hdrive_mbs.expression import Expression, constant, evaluate, record, variable
from hdrive_mbs.expression.node import NUMERIC
from hdrive_mbs.expression.pieces import lines_between
from models.harmonic_drive_train import build

pytest.importorskip("llvmlite", reason='compiled runs need the extra "diagnosis"')

x, v, t = variable("x"), variable("v"), variable("t")
POINTS = (-2.5, -1.0, -0.3, -0.0, 0.0, 1e-9, 0.3, 1.0, 2.0, 3.75)
CHANNELS = ("motor.speed", "load.speed", "load.angle", "gear.torque", "gear.twist")


def computed(law: Expression, at_x: float, at_v: float, at_t: float = 0.5) -> float:
    """The law by machine code."""
    made = program([record(law)], ["t", "x", "v"])
    code = machine(made.structure, made.structure)
    state, out = np.array([at_x, at_v]), np.empty(1)
    code.observe(at_t, 1.0, 1, pointer(state), pointer(made.constants), pointer(made.tables), pointer(out))
    return float(out[0])


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
    first, second = (program([record(k * x + np.tanh(v / w))], ["t", "x", "v"]) for k, w in ((3.7, 0.2), (9.1, 0.4)))
    assert first.structure == second.structure
    assert machine(first.structure, first.structure) is machine(second.structure, second.structure)
    assert list(first.constants) != list(second.constants)


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
    assert heavier._machine is first._machine
    slow, fast = (line.run(2, 0.05, step=1e-5).values["motor.speed"][-1] for line in (heavier, first))
    assert slow < fast


def test_a_run_that_grows_without_bound_says_from_when_on() -> None:
    line = CompiledLine(build().network(), CHANNELS)
    with pytest.raises(SimulationError, match=r"not finite from t = .* Use a shorter step"):
        line.run(200, 1e-3, step=1e-3)


def test_an_unknown_channel_is_refused_with_those_there_are() -> None:
    with pytest.raises(PlaceError, match=r"No channel 'motor\.sped'.*motor\.speed"):
        CompiledLine(build().network(), ["motor.sped"])


def test_a_rotor_line_is_refused_for_the_engine() -> None:
    from models.jeffcott import build as jeffcott

    with pytest.raises(hm.ParameterError, match="simulate it on the engine"):
        CompiledLine(jeffcott().network(), [])

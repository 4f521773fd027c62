"""One battery of tests over every bearing law of the package, and over one of a user's own.

Every law in hdrive_mbs.bearings is found by walking the package; there is no list of exclusions.  A
new law needs one line in EXAMPLES.
"""

from __future__ import annotations

import importlib
import inspect
import json
import math
import pkgutil
import re
from collections.abc import Mapping
from dataclasses import dataclass, fields

import numpy as np
import pytest

import hdrive_mbs.bearings
from hdrive_mbs.bearings.ball import BallBearing
from hdrive_mbs.bearings.friction import WithFriction
from hdrive_mbs.bearings.gradients import derivatives
from hdrive_mbs.bearings.journal import JournalBearing
from hdrive_mbs.bearings.law import DIRECTIONS, BearingLaw, RelativeMotion
from hdrive_mbs.bearings.linear import LinearBearing
from hdrive_mbs.bearings.power import PowerBearing
from hdrive_mbs.bearings.speed_table import TableBearing
from hdrive_mbs.engine.symbolic import LARGEST_LAW, generic_function, written_out
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.expression import Value, evaluate, record, variable
from hdrive_mbs.quantities import parameter
from hdrive_mbs.scene_file import _build, _plain, all_types


@dataclass(frozen=True, kw_only=True)
class RubberBearing(BearingLaw):
    """A bearing law of a user's own.

    F = F_0 (x, y)/(r_0 + r),  r the displacement

    Source: made up for this test.  Leaves out everything about real rubber.
    """

    largest: float = parameter("N", "force F_0 that it tends to", above=0.0)
    half_way: float = parameter("m", "displacement r_0 at half of it", above=0.0)

    def forces(self, motion: RelativeMotion) -> Mapping[str, Value]:
        factor = self.largest / (self.half_way + np.sqrt(motion.x**2 + motion.y**2 + 1e-24))
        return {"x": factor * motion.x, "y": factor * motion.y}


@dataclass(frozen=True)
class Example:
    """A law, a displacement [m] of the size that it sees, and a load [N] that it carries."""

    law: BearingLaw
    size: float
    load: tuple[float, float] = (300.0, -800.0)


BALLS = BallBearing.from_geometry(
    balls=9,
    ball_diameter=7.94e-3,
    pitch_diameter=39.04e-3,
    inner_conformity=0.52,
    outer_conformity=0.52,
    radial_clearance=5e-6,
    contact_damping=2.0,
    damping=50.0,
    axial_stiffness=1e6,
    tilt_stiffness=50.0,
)
COUPLED = np.diag([3e7, 4e7, 1e7, 5e3, 6e3, 0.0]) + 0.0
COUPLED[0, 1], COUPLED[1, 0], COUPLED[0, 4], COUPLED[4, 0] = 8e6, -9e6, 2e4, 3e4

EXAMPLES = {
    type(example.law): example
    for example in (
        Example(LinearBearing.from_matrices(stiffness=COUPLED, damping=1e-4 * (COUPLED + COUPLED.T)), 2e-5),
        Example(
            PowerBearing.from_matrices(
                stiffness=COUPLED,
                damping=np.diag([400.0, 300.0, 10.0, 0.5, 0.5, 0.0]),
                power_stiffness=COUPLED @ np.diag([1e10, 1e10, 1e10, 1e6, 1e6, 0.0]),  # doubles the force at 10 um and 1 mrad
            ),
            2e-5,
        ),
        Example(
            TableBearing(
                speeds=(0.0, 100.0, 400.0),
                stiffness_xx=(3e7, 4e7, 5e7),
                stiffness_yy=(2e7, 3e7, 6e7),
                stiffness_xy=(0.0, 1e7, 2e7),
                stiffness_yx=(0.0, -2e7, -3e7),
                damping_xx=(300.0, 400.0, 500.0),
                damping_yy=(200.0, 300.0, 600.0),
                damping_xy=(100.0, 50.0, 0.0),
                damping_yx=(100.0, 50.0, 0.0),
                axial_stiffness=1e6,
                axial_damping=30.0,
            ),
            2e-5,
        ),
        Example(BALLS, 2e-5),
        Example(JournalBearing(diameter=0.1, length=0.03, radial_clearance=1e-4, viscosity=0.1, tilt_damping=0.2), 7e-5),
        Example(WithFriction(law=BALLS, bore=0.025, friction=0.1, turning_friction=2e-3, smoothing_speed=0.1), 2e-5),
        Example(RubberBearing(largest=2000.0, half_way=1e-5), 2e-5),
    )
}


def laws_of_package() -> list[type[BearingLaw]]:
    """Every bearing law of the package that is no base of others (a base names its kind)."""
    for module in pkgutil.walk_packages(hdrive_mbs.bearings.__path__, "hdrive_mbs.bearings."):
        importlib.import_module(module.name)
    found, stack = [], [BearingLaw]
    while stack:
        kind = stack.pop()
        stack += kind.__subclasses__()
        if kind.__module__.startswith("hdrive_mbs.bearings.") and "_kind" not in vars(kind):
            found.append(kind)
    return sorted(found, key=lambda kind: kind.__name__)


LAWS = [*laws_of_package(), RubberBearing]
NAMES = [field.name for field in fields(RelativeMotion)]
PLACES, RATES = ["x", "y", "z", "psi", "theta", "angle"], ["vx", "vy", "vz", "psi_rate", "theta_rate", "speed"]
SPEED = 150.0


@pytest.fixture(params=LAWS, ids=lambda kind: kind.__name__)
def example(request: pytest.FixtureRequest) -> Example:
    if request.param not in EXAMPLES:
        pytest.fail(f"{request.param.__name__} has no example: add a line to EXAMPLES in {__file__}.")
    return EXAMPLES[request.param]


def motions(size: float, count: int = 200) -> dict[str, np.ndarray]:
    """Values of all motion fields, displacements up to the size; the first is the middle at rest."""
    rng = np.random.default_rng(11)
    scale = {"x": size, "y": size, "z": size, "psi": 1e-3, "theta": 1e-3, "angle": 30.0, "speed": 500.0}
    values = {name: rng.uniform(-1.0, 1.0, count) * scale.get(name, 0.1) for name in NAMES}
    radius = np.hypot(values["x"], values["y"])
    values |= {name: values[name] * np.minimum(1.0, size / radius) for name in "xy"}
    for array in values.values():
        array[0] = 0.0
    return values


def computed(law: BearingLaw, values: Mapping[str, Value]) -> np.ndarray:
    total = law.total_forces(RelativeMotion(**values))
    return np.array([total[direction] + 0.0 * values["x"] for direction in DIRECTIONS])


def at(law: BearingLaw, place: np.ndarray, rate: np.ndarray, angle: float = 0.3) -> np.ndarray:
    """The five forces and moments at one displacement and rate."""
    values = dict(zip(PLACES[:5], place.tolist(), strict=True)) | dict(zip(RATES[:5], rate.tolist(), strict=True))
    return computed(law, {**values, "angle": angle, "speed": SPEED})[:5]


# -- what every law must keep ---------------------------------------------------------------------


def test_the_walk_finds_the_laws_and_not_their_bases() -> None:
    names = {kind.__name__ for kind in laws_of_package()}
    assert {"LinearBearing", "BallBearing", "JournalBearing", "WithFriction"} <= names
    assert not names & {"BearingLaw", "RadialBearing", "RubberBearing"}


def test_it_records_itself(example: Example) -> None:
    values = motions(example.size)
    total = example.law.total_forces(RelativeMotion(**{name: variable(name) for name in NAMES}))
    plain = computed(example.law, values)
    for direction, expected in zip(DIRECTIONS, plain, strict=True):
        recorded = evaluate(record(total[direction]), values) + 0.0 * values["x"]
        np.testing.assert_allclose(recorded, expected, rtol=0.0, atol=1e-12 * max(np.max(np.abs(expected)), 1e-300), err_msg=direction)
    assert np.max(np.abs(plain)) > 0.0


def test_plain_floats_give_the_same_as_arrays(example: Example) -> None:
    values = motions(example.size, 40)
    arrays = computed(example.law, values)
    for k in range(40):
        numbers = computed(example.law, {name: float(array[k]) for name, array in values.items()})
        # numpy's sin and pow on arrays may round differently
        np.testing.assert_allclose(numbers, arrays[:, k], rtol=1e-12, atol=1e-12 * np.max(np.abs(arrays)))


def test_the_engine_computes_it_without_a_python_callback(example: Example) -> None:
    import exudyn

    mbs = exudyn.SystemContainer().AddSystem()
    total = example.law.total_forces(RelativeMotion(**{name: variable(name) for name in NAMES}))
    outputs = [record(total[direction]) for direction in DIRECTIONS]
    assert all(written_out(output) < LARGEST_LAW for output in outputs)
    function = generic_function(mbs, outputs, PLACES, RATES)
    values = motions(example.size, 40)
    plain = computed(example.law, values)
    for k in range(40):
        q, q_t = ([float(values[name][k]) for name in names] for names in (PLACES, RATES))
        lowered = np.array(function.Evaluate(mbs, 0.0, 0, q, q_t))
        np.testing.assert_allclose(lowered, plain[:, k], rtol=1e-11, atol=1e-11 * np.max(np.abs(plain)))


def test_its_matrices_leave_the_spin_alone(example: Example) -> None:
    for matrix in (example.law.stiffness_matrix(), example.law.damping_matrix()):
        assert matrix.shape == (6, 6)
        assert np.isfinite(matrix).all()
        assert not matrix[5].any()
        assert not matrix[:, 5].any()


def test_at_standstill_its_damping_takes_power(example: Example) -> None:
    values = motions(example.size) | {"speed": np.zeros(200)}
    moving = computed(example.law, values)
    still = computed(example.law, values | dict.fromkeys(RATES, np.zeros(200)))
    rates = np.array([values[name] for name in RATES[:5]])
    power = np.sum((moving - still)[:5] * rates, axis=0)
    rounding = 1e-14 * np.sum((np.abs(moving) + np.abs(still))[:5] * np.abs(rates), axis=0)
    assert np.all(power >= -rounding)


def test_its_derivatives_are_finite_in_the_middle_at_rest(example: Example) -> None:
    for speed in (0.0, SPEED):
        for part in derivatives(example.law)(np.array([0.0] * 11 + [speed])):
            assert np.isfinite(part).all()


def test_its_static_position_carries_the_load(example: Example) -> None:
    position = example.law.static_position(load=example.load, speed=SPEED, angle=0.3)
    carried = at(example.law, position[:5], np.zeros(5))
    np.testing.assert_allclose(carried, [*example.load, 0.0, 0.0, 0.0], rtol=0.0, atol=1e-9 * math.hypot(*example.load))
    assert position.shape == (6,)
    assert position[5] == 0.0


def test_linearised_it_has_the_slopes_of_its_forces(example: Example) -> None:
    """Central differences: (h/size)^2 = 1e-8 of the slope, rounding 1e-16 size/h = 1e-12."""
    law = example.law
    linear = law.linearised(load=example.load, speed=SPEED, angle=0.3)
    place, zero = law.static_position(load=example.load, speed=SPEED, angle=0.3)[:5], np.zeros(5)
    assert isinstance(linear, LinearBearing)
    for column, unit in enumerate(np.eye(5)):
        step = 1e-4 * (example.size if column < 3 else 1e-3)
        stiffness = (at(law, place + step * unit, zero) - at(law, place - step * unit, zero)) / (2.0 * step)
        damping = (at(law, place, step * unit) - at(law, place, -step * unit)) / (2.0 * step)
        for exact, quotient in ((linear.stiffness_matrix(), stiffness), (linear.damping_matrix(), damping)):
            rounding = 1e-15 * math.hypot(*example.load) / step
            np.testing.assert_allclose(exact[:5, column], quotient, rtol=0.0, atol=1e-7 * np.max(np.abs(quotient)) + rounding)


def test_it_survives_a_scene_file(example: Example) -> None:
    text = json.dumps(_plain(example.law, "bearing"))
    known = all_types() | {RubberBearing.__name__: RubberBearing}
    assert _build(json.loads(text), "bearing", (BearingLaw,), known) == example.law


def test_it_describes_itself_in_one_line(example: Example) -> None:
    line = example.law.describe()
    assert line.startswith(type(example.law).__name__)
    assert "\n" not in line


def test_its_text_states_equation_source_and_what_it_leaves_out(example: Example) -> None:
    text = inspect.getdoc(type(example.law)) or ""
    assert re.search(r"^\w+ = \S", text, re.MULTILINE), "no line with an equation"
    assert "Source:" in text
    assert re.search(r"[Ll]eaves\s+out", text)
    for name, _, metadata in example.law.fields():
        quantity = metadata.get("quantity")
        assert (quantity.doc and quantity.unit) if quantity else metadata.get("doc"), f"{name} has no doc or unit"


def test_it_refuses_numbers_that_are_not_finite(example: Example) -> None:
    for name, value, metadata in example.law.fields():
        if "quantity" not in metadata or value is None:
            continue
        for bad in (math.nan, math.inf):
            with pytest.raises(ParameterError, match=rf"{type(example.law).__name__}\.{name}.*finite"):
                example.law.replacing(**{name: (*value[:-1], bad) if isinstance(value, tuple) else bad})

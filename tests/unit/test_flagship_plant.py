"""The plant of benchmarks/flagship: independent of the package, and of the same joint."""

from __future__ import annotations

import ast
import json
import math
from pathlib import Path

import numpy as np
import pytest

import hdrive_mbs as hm
from models import robot_joint_line as joint

pytest.importorskip("numba", reason='the plant is compiled by numba (extra "bench")')

from benchmarks.flagship import make_bundled, plant, records
from benchmarks.flagship.cases import CASES

FOLDER = Path(plant.__file__).parent
SOLVER = hm.DormandPrince(relative_tolerance=1e-8, absolute_tolerance=1e-10)
TIMES = 2e-3 * np.arange(601)


def test_the_plant_imports_nothing_of_the_package() -> None:
    for name in ("plant", "cases", "records", "make_bundled"):
        tree = ast.parse((FOLDER / f"{name}.py").read_text("utf-8"))
        imported = [alias.name for node in ast.walk(tree) if isinstance(node, ast.Import) for alias in node.names]
        imported += [node.module or "" for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)]
        assert imported
        assert not [module for module in imported if module.split(".")[0] in ("hdrive_mbs", "models")]


def test_the_data_sheet_is_that_of_the_model() -> None:
    sheet, law = plant.DATA_SHEET, joint.drive(joint.gear())
    known = joint.build().parameters()
    same = {
        "motor_inertia": "motor.inertia",
        "motor_viscous": "motor.viscous",
        "motor_power": "motor.characteristic.rated_power",
        "motor_rated_speed": "motor.characteristic.rated_speed",
        "motor_breakdown_ratio": "motor.characteristic.breakdown_ratio",
        "coupling_stiffness": "coupling.stiffness",
        "coupling_damping": "coupling.damping",
        "wave_generator_inertia": "wave_generator.polar_inertia",
        "ratio": "gear.ratio",
        "lost_motion": "gear.stiffness.lost_motion",
        **{f"gear_stiffness_{k}": f"gear.stiffness.stiffness_{k}" for k in (1, 2, 3)},
        **{f"gear_torque_{k}": f"gear.stiffness.torque_{k}" for k in (1, 2)},
        "gear_damping": "gear.damping",
        "gear_housing_inertia": "gear_housing.inertia",
        "foot_stiffness": "housing_foot.stiffness",
        "foot_damping": "housing_foot.damping",
        "ovality_error": "ovality.amplitude",
        "arm_inertia": "arm.polar_inertia",
        "arm_mass": "weight_of_arm.mass",
        "arm_radius": "weight_of_arm.radius",
        "arm_drag": "drag_of_arm.coefficient",
    }
    for name, path in same.items():
        assert sheet[name] == pytest.approx(known[path].value, rel=1e-12), name
    # a bearing's ring turns with the next body
    rings = {
        "hub_inertia": "hub",
        "brake_disc_inertia": "brake_disc",
        "flange_inertia": "output_flange",
        "encoder_disc_inertia": "encoder_disc",
    }
    for name, body in rings.items():
        assert sheet[name] == pytest.approx(joint.POLAR_INERTIA[body] + joint.RING, rel=1e-12)
    assert sheet["motor_synchronous_speed"] == pytest.approx(2.0 * math.pi * 100.0)
    assert law.ratio == sheet["ratio"]


def test_plant_and_five_bodies_turn_alike() -> None:
    feed = records.FEEDS["to_and_fro"]
    exact = plant.Joint(plant.DATA_SHEET).run(*feed, len(TIMES), 2e-3)
    scene = joint.torsional_line(feed=hm.SpeedTable(times=tuple(feed[0]), speeds=tuple(feed[1])))
    response = hm.simulate(scene, 1.2, solver=SOLVER, sample_step=2e-3, progress=False)
    for column, channel in (("motor_torque", "motor.torque"), ("motor_angle", "motor_encoder"), ("output_angle", "output_encoder")):
        difference = exact[column] - response.at(channel, TIMES)
        # what five bodies leave out of eight may reach the noise, before any parameter is fitted
        assert np.sqrt(np.mean(difference**2)) < records.NOISE[column], column
        assert np.ptp(exact[column]) > 100.0 * records.NOISE[column]


def test_the_benchs_noise_is_that_of_the_records() -> None:
    known = joint.bench()
    assert {name: item.noise for name, item in known.measured.items()} == records.NOISE
    assert set(known.inputs) | set(known.measured) == set(records.UNITS)


@pytest.mark.parametrize("case", [case for case in CASES if case.name != "none"], ids=lambda case: case.name)
def test_every_planted_effect_is_seen(case: object) -> None:
    feed = records.FEEDS["to_and_fro"]
    plain = plant.Joint(plant.DATA_SHEET).run(*feed, len(TIMES), 2e-3)
    planted = case.joint(plant.DATA_SHEET).run(*feed, len(TIMES), 2e-3)  # type: ignore[attr-defined]
    changes = {name: np.sqrt(np.mean((planted[name] - plain[name]) ** 2)) / records.NOISE[name] for name in plain}
    assert max(changes.values()) > 1.0


def test_hysteresis_loses_energy_and_friction_brakes() -> None:
    # elements of 1.6 N m in all: at +-2 mrad all slide, and a loop encloses nearly 4 * 1.6 N m * (2 - 0.15) mrad
    bank = plant.sliders(1.6, 1.5e-4, 3.0)
    assert bank.limit.sum() == pytest.approx(1.6)
    assert np.max(bank.limit / bank.stiffness) == pytest.approx(4.5e-4)
    wind = 2e-3 * np.sin(np.linspace(0.0, 4.0 * np.pi, 4001))
    place, force, torques = 0.0, np.zeros(len(bank.limit)), []
    for value in wind:
        torques.append(plant._sliding(value, place, force, bank))
        force = np.clip(force + bank.stiffness * (value - place), -bank.limit, bank.limit)
        place = value
    loop = np.trapezoid(torques[2000:], wind[2000:])
    lost = 4.0 * np.sum(bank.limit * (2e-3 - bank.limit / bank.stiffness))
    assert loop == pytest.approx(lost, rel=1e-3)


def test_the_bundled_record_and_its_label_are_what_their_script_makes(tmp_path: Path) -> None:
    made, label = make_bundled.made(tmp_path)
    kept = make_bundled.FOLDER / made.name
    assert label == json.loads((FOLDER / "bundled_label.json").read_text("utf-8"))
    (head, *new), (title, *old) = (path.read_text("utf-8").splitlines() for path in (made, kept))
    assert head == title
    now, before = (np.array([line.split(",") for line in lines], float) for lines in (new, old))
    names = [column.partition(" ")[0] for column in title.split(",")]
    # another machine rounds sums otherwise, which may turn the last printed digit
    last = np.array([10.0 ** -records.DIGITS.get(name, 4) for name in names])
    assert now.shape == before.shape
    assert np.all(np.abs(now - before) <= 1.001 * last)

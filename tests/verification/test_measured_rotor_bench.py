"""A rotor bench recorded with another integrator by other people: the engine must reproduce it to its noise.

The records and the true parameters of the bench without any hidden effect come with the project's shared data
(withheld/practice/rotor-p01); they are not part of the package, so the tests skip where they are missing.
Scene, noise and resolution are those of models/rotor_bench.py.  What is left over is white noise, so its standard
deviation over n samples is known to 1/sqrt(2 n); four of these are the tolerance everywhere.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

import hdrive_mbs as hm
from models import rotor_bench
from tests.verification.practice_case import PracticeCase, data_sheet

SYMBOLS = {
    "E": "youngs_modulus",
    "G": "shear_modulus",
    "d": "shaft_diameter",
    "d_shaft": "shaft_damping",
    "d_drag": "drag",
    **{f"m_r{k}": f"rotor_{k}_mass" for k in (1, 2)},
    **{f"Jp_r{k}": f"rotor_{k}_polar_inertia" for k in (1, 2)},
    **{f"Jt_r{k}": f"rotor_{k}_transverse_inertia" for k in (1, 2)},
    **{f"e_r{k}": f"rotor_{k}_eccentricity" for k in (1, 2)},
    **{f"a_r{k}": f"rotor_{k}_angle" for k in (1, 2)},
    "tau_r1": "rotor_1_tilt",
    "b_r1": "rotor_1_tilt_angle",
    "m_b": "ring_mass",
    "Jp_b": "ring_polar_inertia",
    "Jt_b": "ring_transverse_inertia",
    "k_b": "bearing_stiffness",
    "d_b": "bearing_damping",
    "k_bt": "tilt_stiffness",
    "d_bt": "tilt_damping",
    "m_h": "housing_mass",
    "k_hx": "support_stiffness_x",
    "k_hy": "support_stiffness_y",
    "d_h": "support_damping",
}
CASE = PracticeCase(name="rotor-p01", symbols=SYMBOLS)
pytestmark = CASE.needed


def simulated(record: str, scene: hm.Scene, samples: int) -> hm.Response:
    """The record's run; one sample longer, because the last torque is held for one."""
    response = hm.simulate(scene, samples * rotor_bench.SAMPLE_TIME, solver=rotor_bench.SOLVER, **rotor_bench.start(record, scene))
    assert set(response.lowering.values()) <= {"native", "symbolic"}
    return response


def misfit(column: str, data: dict[str, np.ndarray], response: hm.Response) -> float:
    """Rms of measured - simulated over the noise, the mean taken off where the offset is unknown."""
    held = 0.5 * rotor_bench.SAMPLE_TIME if column in rotor_bench.HELD else 0.0
    residual = data[column] - response.at(rotor_bench.CHANNELS[column], data["time"] + held)
    if column in rotor_bench.OFFSET_FREE:
        residual = residual - np.mean(residual)
    return float(np.sqrt(np.mean(residual**2))) / rotor_bench.noise()[column]


def white(samples: int) -> float:
    return 4.0 / math.sqrt(2.0 * samples)


LATERAL = tuple(name for name in rotor_bench.CHANNELS if name.startswith(("r", "h1", "h2")))


@pytest.mark.parametrize("record", ["run_up", "steps", "bump"])
def test_a_bench_without_hidden_effect_is_reproduced_to_its_noise(record: str) -> None:
    data = CASE.columns(record)
    samples = len(data["time"])
    assert np.allclose(data["time"], rotor_bench.sample_times(record), rtol=0.0, atol=1e-12)
    response = simulated(record, rotor_bench.build(record, **CASE.true_parameters()), samples)
    for column in (*LATERAL, "motor_torque"):
        assert misfit(column, data, response) == pytest.approx(1.0, abs=white(samples)), column
    if record == "bump":  # the weight of the eccentric rotors turns the standing shaft by less than half a count
        count = rotor_bench.RESOLUTION["spin_angle"]
        assert np.all(np.round(response["bearing_1.angle"].values / count) == 0.0)
        assert not data["spin_angle"].any()
        for column in rotor_bench.INPUTS:
            assert misfit(column, data, response) == pytest.approx(1.0, abs=white(samples)), column
    else:
        assert misfit("spin_angle", data, response) == pytest.approx(1.0, abs=white(samples))


def test_driven_by_its_measured_spin_a_wrong_drag_does_not_matter() -> None:
    data = {name: values[:8000] for name, values in CASE.columns("run_up").items()}  # through the first critical speed
    times = data["time"]
    true = CASE.true_parameters()
    wrong = true | {"drag": 1.5 * true["drag"]}
    (angles, speeds, _), (lagging, _, _) = (rotor_bench.held_control("run_up", rotor_bench.undriven("run_up", **p)) for p in (true, wrong))
    # four drags c, each too large by half, are 2 c w more torque: k u + J u' = 2 c w for the speed u that is lost, so the
    # angle lags by the integral of u,  2 c/k (turned - w J/k)  after many time constants J/k = 0.1 s; c itself adds 4 c/k = 0.2 %
    inertia = sum(true[f"{name}_polar_inertia"] for name in ("rotor_1", "rotor_2")) + 2.0 * true["ring_polar_inertia"]
    k, turned, speed, lag = rotor_bench.GAIN, angles[8000], speeds[8000], angles[8000] - lagging[8000]
    assert lag == pytest.approx(2.0 * true["drag"] / k * (turned - speed * inertia / k), rel=0.01)
    orbit = float(np.ptp(data["r1_x"])) / 2.0
    assert lag * orbit > 100.0 * rotor_bench.NOISE["r1_x"]  # so the controlled line is far off where the orbit is large
    scene = rotor_bench.build("run_up", spin=(times, data["spin_angle"]), **wrong)
    response = simulated("run_up", scene, len(times))
    for column in (*LATERAL, "spin_angle"):
        assert misfit(column, data, response) == pytest.approx(1.0, abs=white(len(times))), column


def test_the_model_has_the_numbers_of_the_data_sheet() -> None:
    sheet = data_sheet("rotor")
    scene = rotor_bench.build("steps")
    values = {path: item.value for path, item in scene.parameters().items()}
    shaft, bearing, support = sheet["shaft"], sheet["bearing"], sheet["support"]
    positions = [scene.network().positions[name] for name in shaft["z"]]
    assert positions == pytest.approx(list(shaft["z"].values()))
    wanted: dict[str, float] = {}
    for name in rotor_bench.SECTIONS:
        wanted |= {f"{name}.youngs_modulus": shaft["E"], f"{name}.shear_modulus": shaft["G"], f"{name}.diameter": shaft["diameter"]}
        wanted[f"{name}.damping"] = shaft["stiffness_proportional_damping"]
    wanted |= {f"drag_{name}.coefficient": shaft["drag"] for name in shaft["z"]}
    for name in ("rotor_1", "rotor_2"):
        rotor = sheet[name]
        wanted |= {f"{name}.mass": rotor["mass"], f"{name}.polar_inertia": rotor["Jp"], f"{name}.transverse_inertia": rotor["Jt"]}
        wanted |= {f"{name}.eccentricity": rotor["static_unbalance"]["eccentricity"], f"{name}.angle": rotor["static_unbalance"]["angle"]}
        leaning = rotor.get("dynamic_unbalance", {"tilt": 0.0, "angle": 0.0})
        wanted |= {f"{name}.tilt": leaning["tilt"], f"{name}.tilt_angle": leaning["angle"]}
    for name in rotor_bench.BEARINGS:
        wanted |= {f"{name}.mass": bearing["mass"], f"{name}.polar_inertia": bearing["Jp"], f"{name}.transverse_inertia": bearing["Jt"]}
        for d, tilt in (("xx", "psi"), ("yy", "theta")):
            wanted |= {f"{name}.law.stiffness_{d}": bearing["radial_stiffness"], f"{name}.law.damping_{d}": bearing["radial_damping"]}
            wanted |= {f"{name}.law.stiffness_{tilt}": bearing["tilt_stiffness"], f"{name}.law.damping_{tilt}": bearing["tilt_damping"]}
        wanted |= {f"{name}.housing.{field}": support[field] for field in ("mass", "stiffness_x", "stiffness_y")}
        wanted |= {f"{name}.housing.damping_{d}": support["damping"] for d in "xy"}
    assert {path: values[path] for path in wanted} == wanted
    assert {value for value in sheet["knowledge"].values() if isinstance(value, float)} == set(rotor_bench.KNOWLEDGE.values())
    channels = sheet["channels"]
    for group, prefixes in (
        ("motor_torque", ("motor",)),
        ("probes", ("r1", "r2")),
        ("accelerometers", ("h1", "h2")),
        ("hammer", ("hammer",)),
    ):
        for column in (name for name in rotor_bench.NOISE if name.startswith(prefixes)):
            assert rotor_bench.NOISE[column] == channels[group]["noise"], column
            assert rotor_bench.RESOLUTION.get(column) == channels[group].get("resolution"), column
    assert rotor_bench.SAMPLE_TIME * sheet["records"]["sample_rate"] == 1.0

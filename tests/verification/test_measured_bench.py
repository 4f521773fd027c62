"""A drive bench recorded with another integrator by other people: the engine must reproduce it to its noise.

The records and the true parameters of the bench without any hidden effect come with the project's shared data
(withheld/practice/drive-p01); they are not part of the package, so the test skips where they are missing.
Noise and resolution of each channel are those of the bench's data sheet (withheld/drive_bench.toml).
"""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest

import hdrive_mbs as hm

CASE = Path(__file__).parents[3] / "shared" / "withheld" / "practice" / "drive-p01"
pytestmark = pytest.mark.skipif(not CASE.is_dir(), reason="the shared bench records are not beside this checkout")


def bench(times: np.ndarray, reference: np.ndarray, load: np.ndarray) -> hm.Scene:
    """The bench of drive_bench.toml with the true parameters of this case."""
    p = json.loads((CASE / "truth.json").read_text())["true_parameters"]
    servo = hm.ServoMotor(
        torque_limit=p["tau_max"],
        proportional_gain=p["kp"],
        integral_gain=p["ki"],
        reference=hm.SpeedTable(times=times, speeds=reference),
    )
    stiffness = hm.PiecewiseLinearStiffness(
        lost_motion=p["lost_motion"],
        stiffness_1=p["K1"],
        stiffness_2=p["K2"],
        stiffness_3=p["K3"],
        torque_1=p["T1"],
        torque_2=p["T2"],
    )
    return hm.Scene(
        name="drive bench",
        parts={
            "motor": hm.Motor(inertia=p["J_m"], viscous=p["b_m"], characteristic=servo),
            "input_shaft": hm.Shaft(stiffness=p["k_in"], damping=p["d_in"]),
            "wave_generator": hm.Inertia(inertia=p["J_wg"], viscous=p["b_wg"]),
            "gear": hm.HarmonicDrive(
                ratio=p["u"], output_sense="same", stiffness=stiffness, damping=p["d_fs"], flexspline_inertia=p["J_fs"]
            ),
            "output_shaft": hm.Shaft(stiffness=p["k_out"], damping=p["d_out"]),
            "load": hm.Load(inertia=p["J_l"], viscous=p["b_l"], torque=hm.TableTorque(times=times, torques=load)),
        },
        connections=[("motor", "input_shaft", "wave_generator", "gear", "output_shaft", "load")],
    )


@pytest.mark.parametrize("record", ["staircase", "load_cycle", "sweep"])
def test_a_bench_without_hidden_effect_is_reproduced_to_its_noise(record: str) -> None:
    parquet = pytest.importorskip("pyarrow.parquet", reason="pyarrow reads the records")
    table = parquet.read_table(CASE / f"{record}.parquet")
    data = {name: table[name].to_numpy().astype(float) for name in table.column_names}
    times = data["time"]
    scene = bench(times, data["speed_reference"], data["load_torque"])
    solver = hm.DormandPrince(relative_tolerance=1e-7, absolute_tolerance=1e-9)
    response = hm.simulate(scene, float(times[-1]), solver=solver, sample_step=5e-4)
    assert set(response.lowering.values()) <= {"native", "symbolic"}

    def rounding(resolution: float) -> float:  # standard deviation of a uniform error of one step
        return resolution / math.sqrt(12.0)

    noise = {
        "motor.angle": ("motor_angle", rounding(2.0 * math.pi / 16384.0)),
        "load.angle": ("load_angle", math.hypot(1.5e-6, rounding(2.0 * math.pi / 4e6))),
        "motor.torque": ("motor_torque", math.hypot(0.02, rounding(0.005))),
        "output_shaft.torque": ("output_torque", math.hypot(0.35, rounding(0.1))),
    }
    for channel, (measured, sigma) in noise.items():
        residual = data[measured] - response[channel].at(times)
        # the offset of a torque sensor is drawn anew for each record and unknown; n = 18000 samples, of which the
        # coloured part of the output torque (0.95 a sample) leaves about 18000 * 0.05/1.95 = 460 independent ones:
        # 4 standard deviations of the estimate of sigma are 4 / sqrt(2 * 460) = 0.13, and 0.02 for white noise
        tolerance = 0.13 if channel == "output_shaft.torque" else 0.02
        assert np.std(residual) / sigma == pytest.approx(1.0, abs=tolerance), channel

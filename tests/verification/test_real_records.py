"""Measurements of other people are read with their units, and nothing healthy in them is refused.

The files come with the project's shared data (see the README beside them for sources and licences); they
are not part of the package, so the tests skip where they are missing.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import hdrive_mbs as hm

SHARED = Path(__file__).parents[3] / "shared"
BENCHES = SHARED / "withheld" / "practice"
REAL = SHARED / "real"
KUKA = REAL / "kuka_kr300" / "data" / "recorded_trajectories" / "2020-10-21 10s FF A 08ms" / "data.mat"

needs_benches = pytest.mark.skipif(not BENCHES.is_dir(), reason="the shared bench records are not beside this checkout")
needs_real = pytest.mark.skipif(not REAL.is_dir(), reason="the shared real measurements are not beside this checkout")

UNITS = {"rec.time_cont": "s", "*_deg": "deg", "*_deg_per_s": "deg/s", "*_nm": "N m"}


@needs_benches
@pytest.mark.parametrize("case", ["drive-p01", "drive-p04", "rotor-p01", "rotor-p04"])
def test_the_records_of_a_bench_are_read_whole_and_nothing_is_refused(case: str) -> None:
    pytest.importorskip("pyarrow", reason="pyarrow reads the records")
    records = hm.read_records(BENCHES / case)
    rate = {"drive": 2000.0, "rotor": 4000.0}[case.partition("-")[0]]  # of the benches' data sheets
    for record in records:
        assert record.step == pytest.approx(1.0 / rate, rel=1e-9)
        assert not record.blocking
        # at standstill (record bump) the encoder shows one number, which may be right
        assert {finding.kind for finding in record.findings} <= {"constant"}
    assert records.names == (("load_cycle", "staircase", "sweep") if case.startswith("drive") else ("bump", "run_up", "steps"))


@needs_benches
def test_a_bench_speed_in_the_wrong_unit_is_refused() -> None:
    pytest.importorskip("pyarrow", reason="pyarrow reads the records")
    record = hm.read_record(BENCHES / "drive-p01" / "staircase.parquet")
    # the reference is followed to a few per cent, so it stands in for a measured speed; 30/pi is the factor of rpm
    speed = record["speed_reference"].replacing(name="motor_speed", values=record["speed_reference"].values * 30.0 / math.pi)
    wrong = record.with_channels([record["motor_angle"], speed])
    with pytest.raises(hm.RecordError, match="motor_speed is in rpm"):
        wrong.checked()


@needs_real
def test_a_matlab_file_with_objects_is_read_without_opening_them() -> None:
    channels = {"rec.act_pos_se_deg[1]": "arm.angle", "rec.act_pos_mot_deg[1]": None, "rec.act_torque_abs_nm[1]": "motor.torque"}
    record = hm.read_record(KUKA, time="rec.time_cont", units=UNITS, channels=channels)
    assert (len(record), record.step) == (2501, pytest.approx(4e-3))  # 10 s at 250 Hz, says the README beside it
    # torsion of the gear: 0.15 to 0.16 degrees peak to peak, says the README beside it
    torsion = np.degrees(record["arm.angle"].values - record["rec.act_pos_mot_deg[1]"].values)
    assert 0.14 < np.ptp(torsion) < 0.17
    assert record["motor.torque"].unit == "N m"
    assert record.findings == ()
    with pytest.raises(hm.UnitError, match=r"no unit for rec.act_pos_se_deg\[1\].*the file names none"):
        hm.read_record(KUKA, time="rec.time_cont", units={"rec.time_cont": "s"}, channels=["rec.act_pos_se_deg[1]"])


@needs_real
def test_a_robot_speed_in_the_wrong_unit_is_found_on_every_moving_axis() -> None:
    wrong = UNITS | {"*_deg_per_s": "rad/s"}
    record = hm.read_record(KUKA, time="rec.time_cont", units=wrong, channels=["rec.act_pos*", "rec.act_vel*"], refuse=False)
    found = {finding.channel for finding in record.blocking if finding.kind == "units" and "is in deg/s" in finding.text}
    # of the link encoders only axes 1 to 3 move; the motor encoders of all six do
    assert found == {f"rec.act_vel_{side}_deg_per_s[{axis}]" for side, axes in (("se", 3), ("mot", 6)) for axis in range(1, axes + 1)}
    healthy = hm.read_record(KUKA, time="rec.time_cont", units=UNITS, channels=["rec.act_pos*", "rec.act_vel*"])
    assert {finding.kind for finding in healthy.findings} == {"constant"}


@needs_real
def test_a_table_without_time_and_units_is_read_once_both_are_given() -> None:
    folder = REAL / "staubli_tx40"
    with pytest.raises(hm.RecordError, match="no column is the time"):
        hm.read_record(folder / "pos_read_data.csv")
    with pytest.raises(hm.UnitError, match="no unit for Joint_1"):
        hm.read_record(folder / "pos_read_data.csv", time="5 kHz")
    angles = hm.read_record(folder / "pos_read_data.csv", time="5 kHz", units={"Joint_*": "deg"})
    currents = hm.read_record(folder / "curr_data.csv", time="5 kHz", units={"Joint_*": "A"})
    assert len(angles) == len(currents) == 45000  # 9 s at 5 kHz, says the README beside it
    assert angles["Joint_2"].values[0] == pytest.approx(math.radians(50.265))
    assert angles.blocking == currents.blocking == ()  # joints that come to rest are not stuck


@needs_real
def test_a_bode_table_has_no_time_and_is_read_as_columns() -> None:
    path = REAL / "rk4_rotor" / "runup_bode_1037_2003rpm.csv"
    with pytest.raises(hm.RecordError, match="a table over something else is read by read_columns"):
        hm.read_record(path)
    columns = hm.read_columns(path, units={"rpm": "rpm", "amp*": "um", "phase*": "deg"})
    assert {column.unit for column in columns.values()} == {"rad/s", "m", "rad"}
    peak = int(np.argmax(columns["amp_1x_um"].values))
    # first critical speed 1648 rpm, say the authors; the run-up passes it and peaks a little later
    assert 1640.0 < columns["rpm"].values[peak] * 30.0 / math.pi < 1720.0

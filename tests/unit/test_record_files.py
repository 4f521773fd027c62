"""Files of measurements: every format gives the same record, odd files give clear errors."""

from __future__ import annotations

import contextlib
import math
import os
import string
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import hdrive_mbs as hm
from hdrive_mbs.records import si_units
from hdrive_mbs.records.formats import apart
from hdrive_mbs.records.formats.file_format import format_of, formats
from hdrive_mbs.records.reading import read_record
from hdrive_mbs.records.si_units import conversion
from tests.unit.warm_reader import WarmReader

TIMES = np.arange(200) * 1e-3
SPEED = 1200.0 + 50.0 * np.sin(40.0 * TIMES)  # rpm
TORQUE = 3.0 + np.cos(25.0 * TIMES)  # N m


def rows(delimiter: str = ",", comma: bool = False) -> list[str]:
    lines = [delimiter.join(f"{value:.17g}" for value in row) for row in zip(TIMES, SPEED, TORQUE, strict=True)]
    return [line.replace(".", ",") for line in lines] if comma else lines


def write(path: Path, *lines: str) -> Path:
    path.write_text("\n".join(lines) + "\n", "utf-8")
    return path


def csv_file(folder: Path) -> Path:
    return write(folder / "run.csv", "time [s],speed [rpm],torque [Nm]", *rows())


def parquet_file(folder: Path) -> Path:
    arrow = pytest.importorskip("pyarrow")
    parquet = pytest.importorskip("pyarrow.parquet")
    fields = [
        arrow.field(name, arrow.float64(), metadata={"unit": unit}) for name, unit in (("time", "s"), ("speed", "rpm"), ("torque", "Nm"))
    ]
    parquet.write_table(arrow.table([TIMES, SPEED, TORQUE], schema=arrow.schema(fields)), folder / "run.parquet")
    return folder / "run.parquet"


def mat_file(folder: Path) -> Path:
    from scipy.io import savemat

    def channel(values: np.ndarray, unit: str) -> dict[str, object]:
        return {"values": values, "unit": unit}

    savemat(folder / "run.mat", {"time": channel(TIMES, "s"), "speed": channel(SPEED, "rpm"), "torque": channel(TORQUE, "Nm")})
    return folder / "run.mat"


def mat_7_3_file(folder: Path) -> Path:
    h5py = pytest.importorskip("h5py")
    path = folder / "run.mat"
    with h5py.File(path, "w", userblock_size=512) as file:
        for name, values, unit in (("time", TIMES, "s"), ("speed", SPEED, "rpm"), ("torque", TORQUE, "Nm")):
            group = file.create_group(name)
            group.attrs["MATLAB_class"] = np.bytes_("struct")
            group["values"] = values[None, :]  # MATLAB keeps columns first
            group["values"].attrs["MATLAB_class"] = np.bytes_("double")
            group["unit"] = np.array([[ord(letter)] for letter in unit], dtype=np.uint16)
            group["unit"].attrs["MATLAB_class"] = np.bytes_("char")
        file["handle"] = np.zeros((1, 3), dtype=np.uint32)
        file["handle"].attrs["MATLAB_class"] = np.bytes_("function_handle")
    with open(path, "r+b") as raw:
        raw.write(b"MATLAB 7.3 MAT-file, made for a test".ljust(124) + b"\x00\x02IM")
    return path


def hdf5_file(folder: Path) -> Path:
    h5py = pytest.importorskip("h5py")
    with h5py.File(folder / "run.h5", "w") as file:
        for name, values, unit in (("time", TIMES, "s"), ("speed", SPEED, "rpm"), ("torque", TORQUE, "Nm")):
            file[name] = values
            file[name].attrs["units" if name == "torque" else "unit"] = unit
    return folder / "run.h5"


def mdf_file(folder: Path) -> Path:
    asammdf = pytest.importorskip("asammdf")
    with asammdf.MDF(version="4.10") as file:
        signals = [
            asammdf.Signal(samples=values, timestamps=TIMES, name=name, unit=unit)
            for name, values, unit in (("speed", SPEED, "rpm"), ("torque", TORQUE, "Nm"))
        ]
        file.append(signals)
        file.save(folder / "run.mf4", overwrite=True)
    return folder / "run.mf4"


MAKERS = (csv_file, parquet_file, mat_file, mat_7_3_file, hdf5_file, mdf_file)


@pytest.mark.parametrize("make", MAKERS)
def test_every_format_gives_the_same_record_in_si_units(make: Callable[[Path], Path], tmp_path: Path) -> None:
    path = make(tmp_path)
    record = hm.read_record(path, channels={"speed": "motor.speed", "torque": None})
    assert np.allclose(record.times, TIMES, rtol=0.0, atol=1e-12)
    assert record["motor.speed"].unit == "rad/s"
    # rpm -> rad/s is pi/30; both numbers went through at most 17 digits
    assert np.allclose(record["speed"].values, SPEED * math.pi / 30.0, rtol=1e-14)
    assert record["torque"].unit == "N m"
    assert np.allclose(record["torque"].values, TORQUE, rtol=1e-14)
    assert record.source == str(path)
    assert len(record.sha256) == 64
    assert record.findings == ()


@pytest.mark.parametrize("make", MAKERS)
def test_a_truncated_file_of_any_format_is_refused_by_name(make: Callable[[Path], Path], tmp_path: Path) -> None:
    path = make(tmp_path)
    content = path.read_bytes()
    path.write_bytes(content[: len(content) // 2])
    if path.suffix == ".csv":  # half a table is a table, but its cut last line is told of
        assert any("cut off" in note for note in hm.read_record(path).notes) or len(hm.read_record(path)) < 200
        return
    with pytest.raises(hm.HdriveError, match="run"):
        hm.read_record(path)


DAMAGED = 48
"""Damaged files of each format."""


def damages(content: bytes, count: int) -> Iterator[bytes]:
    """In turn: cut off, eight bytes changed, a stretch of zeros, two bits flipped."""
    rng = np.random.default_rng(5)
    for number in range(count):
        damaged = bytearray(content)
        if number % 4 == 0:
            del damaged[int(rng.integers(16, len(content))) :]
        elif number % 4 == 1:
            for place in rng.integers(16, len(content), 8):
                damaged[place] = int(rng.integers(256))
        elif number % 4 == 2:
            start, length = int(rng.integers(16, len(content))), int(rng.integers(1, 512))
            damaged[start : start + length] = bytes(len(damaged[start : start + length]))
        else:
            for place in rng.integers(16, len(content), 2):
                damaged[place] ^= 1 << int(rng.integers(8))
        yield bytes(damaged)


@pytest.mark.parametrize("make", MAKERS[1:])
def test_a_damaged_file_never_gives_anything_but_an_error_of_ours(
    make: Callable[[Path], Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = make(tmp_path)
    content = path.read_bytes()
    read = refused = 0
    with contextlib.ExitStack() as stack:
        if format_of(path).apart:
            reader = stack.enter_context(WarmReader.start(format_of(path).needs))
            monkeypatch.setattr(apart.subprocess, "run", reader.run)
        for number, damaged in enumerate(damages(content, DAMAGED)):
            path.write_bytes(damaged)
            try:
                said = hm.read_record(path, refuse=False).describe()
                read += 1
            except hm.HdriveError as error:
                said = str(error)
                refused += 1
            assert "run" in said, f"damage {number}: {said}"
            # C code may end its process with a signal, or loop until it is stopped; a reader in Python says itself what is wrong
            assert "ended with status" not in said, f"damage {number}: {said}"
    assert read > 5
    assert refused > 5


@pytest.mark.parametrize(
    ("program", "limit", "message"),
    [
        ("import os; os.abort()", 60.0, "its reader ended with signal 6"),
        ("raise MemoryError('too large')", 60.0, r"ended with status 1 \(MemoryError: too large\)"),
        ("import time; time.sleep(60)", 0.2, "took longer than"),
    ],
)
def test_a_reader_that_crashes_or_hangs_gives_an_error(
    program: str, limit: float, message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    # random damage makes the C code behind MATLAB and MDF files end the process with a signal now and then
    monkeypatch.setattr(apart, "_PROGRAM", program)
    monkeypatch.setattr(apart, "TIME_LIMIT", limit)
    with pytest.raises(hm.FileFormatError, match=message):
        hm.read_record(mat_file(tmp_path))


def test_every_known_format_is_found_without_registration() -> None:
    assert {item.name for item in formats()} == {"text table", "Parquet", "MATLAB", "MATLAB 7.3", "MDF 4", "HDF5"}


def test_a_missing_optional_package_names_the_command_that_installs_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "run.mf4"
    path.write_bytes(b"MDF     4.10    " + bytes(100))
    monkeypatch.setitem(__import__("sys").modules, "asammdf", None)
    with pytest.raises(hm.FileFormatError, match=r"needs asammdf.*python -m pip install 'hdrive-mbs\[records\]'"):
        hm.read_record(path)


# ---- text tables


@pytest.mark.parametrize(
    ("delimiter", "comma"), [(",", False), (";", False), (";", True), ("\t", False), ("\t", True), ("|", False), (" ", True)]
)
def test_delimiter_and_decimal_sign_are_found(delimiter: str, comma: bool, tmp_path: Path) -> None:
    head = delimiter.join(("time[s]", "speed[rpm]", "torque[Nm]"))
    record = hm.read_record(write(tmp_path / "a.txt", head, *rows(delimiter, comma)))
    assert np.allclose(record["speed"].values, SPEED * math.pi / 30.0, rtol=1e-14)


@pytest.mark.parametrize(
    "head",
    [
        ["time [s],speed [rpm],torque [N m]"],
        ["time (s),speed (rpm),torque (N*m)"],
        ["time,speed,torque", "s,rpm,Nm"],
        ["time,speed,torque", "[s],[rpm],[N·m]"],
        ["# recorded by hand", "# time [s],speed [rpm],torque [Nm]"],
        ["Logger 7", "Date: today", "", "time [s],speed [rpm],torque [Nm]"],
        ['"time [s]","speed [rpm]","torque [Nm]"'],
    ],
)
def test_units_are_read_from_the_header(head: list[str], tmp_path: Path) -> None:
    record = hm.read_record(write(tmp_path / "a.csv", *head, *rows()))
    assert list(record.channels) == ["speed", "torque"]
    assert record["speed"].values[0] == pytest.approx(1200.0 * math.pi / 30.0, rel=1e-14)
    assert record["torque"].unit == "N m"


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "latin-1"])
def test_text_of_other_encodings_is_read(encoding: str, tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_bytes("\r\n".join(["time [s];Winkel am Prüfstand [°];x [µm]", "0,0;1,5;2", "0,5;3;4", "1;4,5;6"]).encode(encoding))
    record = hm.read_record(path)
    assert record["Winkel am Prüfstand"].values[1] == pytest.approx(math.radians(3.0))
    assert record["x"].values[2] == pytest.approx(6e-6)


def test_a_time_of_dates_keeps_its_digits(tmp_path: Path) -> None:
    lines = [f"2026-11-21T10:00:{index / 1000:06.3f}Z,{index}" for index in range(30)]
    record = hm.read_record(write(tmp_path / "a.csv", "time,x [mm]", *lines))
    # seconds since 1970 need 1.8e9 s at a step of 1 ms: kept relative to the first sample, whose time is the origin
    assert np.allclose(np.diff(record.times), 1e-3, rtol=0.0, atol=1e-12)
    assert record.origin == pytest.approx(1795255200.0, abs=1.0)
    assert any("the clock showed" in note for note in record.notes)


def test_cells_that_are_no_numbers_are_told_of_and_block_the_record(tmp_path: Path) -> None:
    lines = rows()
    lines[20] = "0.02,ERR,1"
    lines[30] = "0.03,,1"
    path = write(tmp_path / "a.csv", "time [s],speed [rpm],torque [Nm]", *lines)
    with pytest.raises(hm.RecordError, match="not_finite in 'speed': 2 of 200 values"):
        hm.read_record(path)
    record = hm.read_record(path, refuse=False)
    assert any("'speed': 2 cells hold no number (the first: 'ERR' in line 21" in note for note in record.notes)
    assert np.isnan(record["speed"].values[[20, 30]]).all()
    mended = hm.read_record(path, repair={"not_finite": "interpolate"})
    assert mended["speed"].values[20] == pytest.approx(0.5 * (mended["speed"].values[19] + mended["speed"].values[21]), rel=1e-14)


def test_a_text_column_is_left_out_and_named(tmp_path: Path) -> None:
    record = hm.read_record(write(tmp_path / "a.csv", "time [s],state,x [m]", *(f"{k},running,{k}" for k in range(20))))
    assert list(record.channels) == ["x"]
    assert any("state was not read: text, like 'running'" in note for note in record.notes)


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        (["time [s],x [m]"], "no line of numbers|no table of numbers"),
        (["this is", "no table"], "no table of numbers"),
        (["# only", "# comments"], "no line of a table"),
        (["time [s];x [m]", "0;1", "1;2", "2;3;4", "3;4"], "line 3 of the data has 3 fields"),
        (["time [s],x", "0,1", "1,2"], "no unit for x; the file names none. Give it with units={'x': '...'}"),
        (["time,x [m]", "0,1", "1,2"], "the time 'time' has no unit; give it with units={'time': 's'}"),
        (["time [m],x [m]", "0,1", "1,2"], "unit 'm' is no unit of time"),
        (["time [s],x [furry]", "0,1", "1,2"], "channel 'x': unit 'furry' is not known.*units={'x': '...'}"),
        (["time [s],x [mol]", "0,1", "1,2"], "channel 'x': unit 'mol' measures nothing that a record"),
        (["time [s],n [1/min]", "0,1", "1,2"], "'1/min' does not say what is counted; write 'rpm'"),
        (["time [s],a [g]", "0,1", "1,2"], "'g' is the gram; an acceleration in multiples of gravity is 'g_0'"),
        (["x [m],y [m]", "0,1", "1,2"], "no column is the time. It has: x, y."),
    ],
)
def test_a_bad_table_is_refused_with_the_way_out(lines: list[str], message: str, tmp_path: Path) -> None:
    with pytest.raises(hm.HdriveError, match=message) as caught:
        hm.read_record(write(tmp_path / "a.csv", *lines))
    assert "a.csv" in str(caught.value)


def test_what_is_no_file_is_refused(tmp_path: Path) -> None:
    (tmp_path / "empty.csv").touch()
    os.mkfifo(tmp_path / "pipe.csv")  # reading it would wait for ever
    (tmp_path / "a.xyz").write_bytes(b"?")
    for name, message in (
        ("empty.csv", "is empty"),
        ("pipe.csv", "no regular file"),
        ("none.csv", "no such file"),
        ("a.xyz", "Known formats: "),
    ):
        with pytest.raises(hm.FileFormatError, match=message):
            hm.read_record(tmp_path / name)
    with pytest.raises(hm.FileFormatError, match="is a folder"):
        hm.read_record(tmp_path)


def test_a_binary_file_with_a_text_suffix_is_refused(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_bytes(bytes(range(256)) * 10)
    with pytest.raises(hm.FileFormatError, match="zero bytes"):
        hm.read_record(tmp_path / "a.csv")


NAMES = st.text(alphabet=string.ascii_letters, min_size=2, max_size=8).filter(
    lambda name: name.lower() not in ("time", "times", "zeit", "sec", "nan", "na")
)
NUMBERS = st.floats(allow_nan=False, allow_infinity=False, width=64)


@settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    names=st.lists(NAMES, min_size=1, max_size=4, unique=True),
    data=st.data(),
    delimiter=st.sampled_from([",", ";", "\t"]),
    comma=st.booleans(),
)
def test_any_table_that_is_written_is_read_back(names: list[str], data: Any, delimiter: str, comma: bool, tmp_path: Path) -> None:
    comma = comma and delimiter != ","
    count = data.draw(st.integers(2, 8))
    values = [data.draw(st.lists(NUMBERS, min_size=count, max_size=count)) for _ in names]
    head = delimiter.join(["time [s]", *(f"{name} [m]" for name in names)])
    lines = [delimiter.join([f"{0.5 * index}", *(repr(column[index]) for column in values)]) for index in range(count)]
    path = write(tmp_path / "a.csv", head, *((line.replace(".", ",") for line in lines) if comma else lines))
    record = hm.read_record(path, refuse=False)
    for name, column in zip(names, values, strict=True):
        assert record[name].values.tolist() == column


@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    content=st.one_of(st.binary(max_size=300), st.text(alphabet="0123456789.,;:-+eE \t\n\r\"'#[]()smNarpd", max_size=300).map(str.encode))
)
def test_any_text_gives_a_record_or_an_error_of_ours(content: bytes, tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_bytes(content)
    with contextlib.suppress(hm.HdriveError):  # any other error fails the test
        record = hm.read_record(path, time=1e-3, units={"*": "1"}, refuse=False)
        assert len(record) >= 1
        assert "a.csv" in record.describe()


# ---- MATLAB, HDF5, MDF


def test_a_matrix_of_a_structure_gives_numbered_channels(tmp_path: Path) -> None:
    from scipy.io import savemat

    angles = np.vstack((TIMES, 2.0 * TIMES, 3.0 * TIMES))
    savemat(tmp_path / "a.mat", {"rec": {"clock": TIMES, "pos_deg": angles, "inner": {"torque": TORQUE}}, "para": {"ratio": 100.0}})
    record = hm.read_record(
        tmp_path / "a.mat",
        time="rec.clock",
        units={"rec.clock": "s", "*_deg": "deg", "rec.inner.torque": "Nm"},
        channels={"rec.pos_deg[2]": "gear.angle", "rec.inner.torque": None},
    )
    assert np.allclose(record["gear.angle"].values, np.radians(2.0 * TIMES), rtol=1e-14)
    assert np.array_equal(record["rec.inner.torque"].values, TORQUE)
    with pytest.raises(hm.FileFormatError, match=r"'para.ratio' cannot be read as a channel: it is a single number"):
        hm.read_record(tmp_path / "a.mat", time="rec.clock", units={"*": "s"}, channels=["para.ratio"])


def test_cells_functions_and_text_of_a_mat_file_are_named_but_not_opened(tmp_path: Path) -> None:
    from scipy.io import savemat

    cell = np.empty(2, dtype=object)
    cell[:] = ["a", TIMES]
    savemat(tmp_path / "a.mat", {"time": TIMES, "x": TORQUE, "cell": cell, "text": "hello", "wave": TORQUE * 1j})
    record = hm.read_record(tmp_path / "a.mat", units={"time": "s", "x": "N m"})
    assert list(record.channels) == ["x"]
    for name, kind in (("cell", "objects"), ("text", "text"), ("wave", "complex numbers")):
        assert any(note == f"{name} was not read: {kind}" for note in record.notes), record.notes


def test_a_pickle_in_disguise_is_not_run(tmp_path: Path) -> None:
    import pickle

    class Bomb:
        def __reduce__(self) -> tuple[Any, ...]:
            return os.mkdir, (str(tmp_path / "exploded"),)

    for suffix in (".mat", ".csv", ".h5", ".parquet", ".mf4"):
        (tmp_path / f"a{suffix}").write_bytes(pickle.dumps(Bomb()))
        with pytest.raises(hm.HdriveError):
            hm.read_record(tmp_path / f"a{suffix}")
    assert not (tmp_path / "exploded").exists()


def test_hdf5_links_to_other_files_are_not_followed(tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    path = hdf5_file(tmp_path)
    other = tmp_path / "other"
    other.mkdir()
    hdf5_file(other)
    with h5py.File(path, "a") as file:
        file["away"] = h5py.ExternalLink("other/run.h5", "/speed")
        file["round"] = h5py.SoftLink("/")
        file["group"] = file["/"]  # a hard link to the root: a group inside itself
    record = hm.read_record(path)
    assert sorted(record.channels) == ["speed", "torque"]
    assert sum("was not read: a link, which is not followed" in note for note in record.notes) == 2
    assert any("a group inside itself" in note for note in record.notes)


def test_groups_with_times_of_their_own_become_sensor_sets_of_one_run(tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "run.h5", "w") as file:
        for group, step in (("encoder", 1e-3), ("probe", 2.5e-4)):
            times = np.arange(int(0.2 / step)) * step
            for name, values, unit in (("time", times, "s"), ("x", np.sin(times), "m")):
                file[f"{group}/{name}"] = values
                file[f"{group}/{name}"].attrs["unit"] = unit
    with pytest.raises(hm.RecordError, match=r"2 different times: run:encoder \(200 samples: encoder/x\); run:probe \(800 samples"):
        hm.read_record(tmp_path / "run.h5")
    records = hm.read_records(tmp_path / "run.h5")
    assert [(record.name, record.run, len(record)) for record in records] == [("run:encoder", "run", 200), ("run:probe", "run", 800)]
    assert len(hm.read_record(tmp_path / "run.h5", channels=["probe/x"])) == 800


def test_sensor_sets_with_clocks_since_1970_keep_their_common_time(tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "run.h5", "w") as file:
        for group, start in (("encoder", 1_795_255_200.25), ("probe", 1_795_255_200.0)):
            file[f"{group}/time"] = start + TIMES
            file[f"{group}/x"] = np.sin(9.0 * (start - 1_795_255_200.0 + TIMES))
            file[f"{group}/time"].attrs["unit"] = "s"
            file[f"{group}/x"].attrs["unit"] = "m"
    records = hm.read_records(tmp_path / "run.h5")
    assert [record.times[0] for record in records] == pytest.approx([0.25, 0.0], abs=1e-6)
    assert {record.origin for record in records} == {1_795_255_200.0}
    shifted = records["run:encoder"].with_origin(1_795_255_200.25)
    assert shifted.times[0] == pytest.approx(0.0, abs=1e-6)


def test_a_unit_for_a_channel_that_does_not_exist_is_refused(tmp_path: Path) -> None:
    with pytest.raises(hm.PlaceError, match=r"No channel 'sped'.*has: time, speed, torque"):
        hm.read_record(csv_file(tmp_path), units={"sped": "rad/s"})
    with pytest.raises(hm.PlaceError, match=r"No channel 'sped'. None of the files has: speed, torque"):
        hm.read_records([csv_file(tmp_path)], noise={"sped": 1.0})


def test_an_empty_table_of_any_kind_is_refused(tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    arrow, parquet = pytest.importorskip("pyarrow"), pytest.importorskip("pyarrow.parquet")
    with h5py.File(tmp_path / "run.h5", "w") as file:
        file["time"] = np.zeros(0)
    parquet.write_table(arrow.table({"time [s]": np.zeros(0), "x [m]": np.zeros(0)}), tmp_path / "run.parquet")
    for name in ("run.h5", "run.parquet"):
        with pytest.raises(hm.FileFormatError, match="holds no column of numbers"):
            hm.read_record(tmp_path / name)


def test_mdf_groups_formulas_and_invalid_samples(tmp_path: Path) -> None:
    asammdf = pytest.importorskip("asammdf")
    slow = TIMES[::4]
    with asammdf.MDF(version="4.10") as file:
        file.append([asammdf.Signal(samples=SPEED, timestamps=TIMES, name="speed", unit="rpm")])
        linear = asammdf.Signal(
            samples=np.arange(50, dtype=np.int16), timestamps=slow, name="raw", unit="mm", conversion={"a": 0.5, "b": 1.0}
        )
        formula = asammdf.Signal(samples=np.arange(50.0), timestamps=slow, name="computed", unit="m", conversion={"formula": "X1 * 2"})
        marked = asammdf.Signal(samples=np.arange(50.0), timestamps=slow, name="marked", unit="m", invalidation_bits=np.arange(50) == 7)
        file.append([linear, formula, marked])
        file.save(tmp_path / "run.mf4", overwrite=True)
    records = hm.read_records(tmp_path / "run.mf4", refuse=False)
    assert [len(record) for record in records] == [200, 50]
    second = records.records[1]
    assert np.allclose(second["raw"].values, 1e-3 * (0.5 * np.arange(50) + 1.0), rtol=1e-14)
    assert "computed" not in second
    assert any("computed was not read: a channel that is converted by a formula, which is not run" in note for note in second.notes)
    assert np.flatnonzero(np.isnan(second["marked"].values)).tolist() == [7]
    with pytest.raises(hm.RecordError, match="marked"):
        hm.read_records(tmp_path / "run.mf4")


# ---- several files, columns without a time, units


def test_a_folder_is_read_file_by_file_with_the_channels_that_each_has(tmp_path: Path) -> None:
    csv_file(tmp_path)
    write(tmp_path / "other.csv", "time [s],x [mm]", *(f"{k},{k % 7}" for k in range(30)))
    (tmp_path / "notes.md").write_text("no data")
    records = hm.read_records(tmp_path, channels={"speed": "motor.speed", "x": None}, noise={"speed": 0.1})
    assert records.names == ("other", "run")
    assert records["run"]["motor.speed"].noise == 0.1
    assert list(records["other"].channels) == ["x"]
    with pytest.raises(hm.PlaceError, match="No channel 'angle'"):
        hm.read_records(tmp_path, channels=["speed", "angle"])
    empty = tmp_path / "empty"
    empty.mkdir()
    with pytest.raises(hm.FileFormatError, match="holds no file"):
        hm.read_records(empty)


def test_runs_of_one_name_in_two_folders_are_told_apart(tmp_path: Path) -> None:
    paths = []
    for name in ("one", "two"):
        (tmp_path / name).mkdir()
        paths.append(csv_file(tmp_path / name))
    assert hm.read_records(paths).names == ("one/run", "two/run")


def test_a_missing_channel_lists_those_that_exist(tmp_path: Path) -> None:
    with pytest.raises(hm.PlaceError, match=r"No channel 'sped'.*has: speed, time, torque"):
        hm.read_record(csv_file(tmp_path), channels=["sped"])


def test_a_table_without_a_time_is_read_as_columns_or_with_a_step(tmp_path: Path) -> None:
    path = write(tmp_path / "bode.csv", "rpm,amplitude [um]", *(f"{1000 + 10 * k},{k * k}" for k in range(40)))
    columns = hm.read_columns(path, units={"rpm": "rpm"})
    assert columns["rpm"].values[0] == pytest.approx(1000.0 * math.pi / 30.0)
    assert columns["amplitude"].values[3] == pytest.approx(9e-6)
    for step in (2e-4, "0.2 ms", "5 kHz"):
        record = hm.read_record(path, time=step, channels=["amplitude"])
        assert np.allclose(record.times, 2e-4 * np.arange(40), rtol=1e-12)
    with pytest.raises(hm.PlaceError, match="No time column 'clock'"):
        hm.read_record(path, time="clock")
    with pytest.raises(hm.ParameterError, match="must be greater than 0 s"):
        hm.read_record(path, time=-1.0, channels=["amplitude"])


@pytest.mark.parametrize(
    ("given", "unit", "value"),
    [
        ("rpm", "rad/s", math.pi / 30.0),
        ("U/min", "rad/s", math.pi / 30.0),
        ("rev/min", "rad/s", math.pi / 30.0),
        ("deg/s", "rad/s", math.pi / 180.0),
        ("°", "rad", math.pi / 180.0),
        ("Nm", "N m", 1.0),
        ("N·m", "N m", 1.0),
        ("mNm", "N m", 1e-3),
        ("kNm", "N m", 1e3),
        ("Ncm", "N m", 1e-2),
        ("J", "J", 1.0),
        ("µm", "m", 1e-6),
        ("m/s2", "m/s^2", 1.0),
        ("m/s²", "m/s^2", 1.0),
        ("g_0", "m/s^2", 9.80665),
        ("kgm2", "kg m^2", 1.0),
        ("%", "1", 1e-2),
        ("-", "1", 1.0),
        ("ms", "s", 1e-3),
        ("mV", "V", 1e-3),
        ("kHz", "Hz", 1e3),
        ("bar", "Pa", 1e5),
        ("2.5e-4 rad", "rad", 2.5e-4),
        ("100 N m", "N m", 100.0),
    ],
)
def test_spellings_of_loggers_are_understood(given: str, unit: str, value: float) -> None:
    found = conversion(given, "here")
    assert (found.unit, found.offset) == (unit, 0.0)
    assert found.factor == pytest.approx(value, rel=1e-12)


def test_a_temperature_in_degrees_celsius_becomes_kelvin() -> None:
    assert conversion("degC", "here").apply(np.array([20.0]))[0] == pytest.approx(293.15)


@pytest.mark.parametrize(
    "given",
    ["1/min", "min^-1", "g", "mil", "counts", "C", "dB", "mol", "Nmm3", "", "9**9**9**9", "x" * 500, "0 rad", "2 degC", "__import__"],
)
def test_ambiguous_and_impossible_units_are_refused(given: str) -> None:
    with pytest.raises(hm.UnitError, match=r"^here"):
        conversion(given, "here")


def test_what_a_record_writes_is_read_back(tmp_path: Path) -> None:
    record = hm.read_record(csv_file(tmp_path))
    again = hm.read_record(record.to_csv(tmp_path / "again.csv"))
    for channel in record:
        assert again[channel.name].unit == channel.unit
        assert np.allclose(again[channel.name].values, channel.values, rtol=1e-11)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("dgr", r"unit 'dgr' would be a decigrain, in which nobody records\. Did you mean 'deg'\?"),
        ("Prad", r"unit 'Prad' would be a petaradian, in which nobody records\. Did you mean 'rad'\?"),
        ("das", r"unit 'das' would be a decasecond"),
    ],
)
def test_a_prefix_that_nobody_writes_is_a_slip(text: str, words: str) -> None:
    with pytest.raises(hm.UnitError, match=words):
        conversion(text, "a.csv, channel 'x'")


@pytest.mark.parametrize(
    "text", ["mdeg", "hPa", "dm", "cN m", "kN", "urad/s", "mm/s^2", "krpm", "kgf", "ft", "inch", "min", "kWh", "Nm", "g_0"]
)
def test_usual_prefixes_are_read(text: str) -> None:
    assert conversion(text, "x").factor > 0.0


def test_units_that_are_read_at_once_are_read_as_pint_reads_them(monkeypatch: pytest.MonkeyPatch) -> None:
    at_once = {unit: conversion(unit, "here") for unit in si_units.SI_UNITS if unit != "C"}
    monkeypatch.setattr(si_units, "READ_AT_ONCE", frozenset())
    assert at_once == {unit: conversion(unit, "here") for unit in at_once}


@pytest.mark.parametrize(("kind", "missing"), [("float64", False), ("float64", True), ("float32", True), ("int32", False), ("int64", True)])
def test_columns_of_parquet_in_several_parts_and_with_gaps(tmp_path: Path, kind: str, missing: bool) -> None:
    pa = pytest.importorskip("pyarrow")
    parquet = pytest.importorskip("pyarrow.parquet")
    numbers = [1.0, None, 3.0, 4.0, 5.0] if missing else [1.0, 2.0, 3.0, 4.0, 5.0]
    table = pa.table({"t [s]": pa.array(np.arange(5.0)), "a [rad]": pa.array(numbers).cast(kind)})
    parquet.write_table(table, tmp_path / "r.parquet", row_group_size=2)
    values = read_record(tmp_path / "r.parquet", refuse=False).channels["a"].values
    np.testing.assert_array_equal(values, [math.nan if item is None else item for item in numbers])


def test_a_record_in_si_units_is_read_without_what_takes_long_to_load(tmp_path: Path) -> None:
    """pint, and what it and pyarrow load besides where it is installed."""
    pa = pytest.importorskip("pyarrow")
    parquet = pytest.importorskip("pyarrow.parquet")
    parquet.write_table(pa.table({"t [s]": np.arange(9.0), "a [rad/s]": np.arange(9.0)}), tmp_path / "r.parquet")
    program = (
        "import sys; from hdrive_mbs.records.reading import read_record; read_record(sys.argv[1]);"
        "print(sorted({'pint', 'pandas', 'dask'} & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", program, str(tmp_path / "r.parquet")], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"

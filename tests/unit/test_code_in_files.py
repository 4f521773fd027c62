"""Code inside real files of data: it is read as data or refused, and never run."""

from __future__ import annotations

import json
import os
import pickle
import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.analysis.result import FORMAT
from hdrive_mbs.campaign.job_files import FinishedJob, JobFiles
from hdrive_mbs.diagnosis.journal import Journal

TIMES = np.arange(200) * 1e-3
TORQUE = 3.0 + np.cos(25.0 * TIMES)  # N m


class Bomb:
    """Leaves a folder where it is unpickled."""

    def __init__(self, marker: Path) -> None:
        self.marker = str(marker)

    def __reduce__(self) -> tuple[Any, ...]:
        return os.mkdir, (self.marker,)


@pytest.fixture
def marker(tmp_path: Path) -> Path:
    return tmp_path / "exploded"


def test_the_bomb_of_these_tests_goes_off_where_it_is_unpickled(marker: Path) -> None:
    pickle.loads(pickle.dumps(Bomb(marker)))
    assert marker.is_dir()


def fuse(marker: Path) -> np.ndarray:
    """The pickle as bytes."""
    return np.frombuffer(pickle.dumps(Bomb(marker), protocol=0), dtype=np.uint8)


# ---- MATLAB


def element(kind: int, content: bytes) -> bytes:
    """A data element of a MATLAB 5 file, filled up to 8 bytes."""
    return struct.pack("<II", kind, len(content)) + content + bytes(-len(content) % 8)


def numbers(name: str, values: np.ndarray) -> bytes:
    """A variable of doubles (class 6) or bytes (class 9)."""
    of_bytes = values.dtype == np.uint8
    flags = element(6, struct.pack("<II", 9 if of_bytes else 6, 0))
    shape = element(5, struct.pack("<ii", 1, len(values)))
    return element(14, flags + shape + element(1, name.encode()) + element(2 if of_bytes else 9, values.tobytes()))


def mat_with(folder: Path, *variables: bytes) -> Path:
    """A MATLAB 5 file with a torque over time, and these variables."""
    path = folder / "run.mat"
    head = b"MATLAB 5.0 MAT-file, made for a test".ljust(124) + b"\x00\x01IM"
    path.write_bytes(head + numbers("time", TIMES) + numbers("torque", TORQUE) + b"".join(variables))
    return path


def opaque_of_matlab(folder: Path, marker: Path) -> Path:
    """An object of a class of MATLAB's (class 17), whose content is the pickle."""
    words = b"".join(element(1, word) for word in (b"thing", b"MCOS", b"os.system"))
    return mat_with(folder, element(14, element(6, struct.pack("<II", 17, 0)) + words + numbers("", fuse(marker))))


def function_of_matlab(folder: Path, marker: Path) -> Path:
    """A function handle (class 16) that is made of the pickle."""
    shape = element(5, struct.pack("<ii", 1, 1))
    return mat_with(folder, element(14, element(6, struct.pack("<II", 16, 0)) + shape + element(1, b"thing") + numbers("", fuse(marker))))


def cell_and_object_of_matlab(folder: Path, marker: Path) -> Path:
    """What scipy makes of an array with the object itself, a cell with the pickle, and an object of a class."""
    from scipy.io import savemat
    from scipy.io.matlab import MatlabObject

    bombs = np.empty(2, dtype=object)
    bombs[:] = [Bomb(marker), fuse(marker)]
    made = MatlabObject(np.array([(fuse(marker),)], dtype=[("state", object)]), "os.system")
    savemat(folder / "run.mat", {"time": TIMES, "torque": TORQUE, "thing": bombs, "made": made, "own": {"reduce": fuse(marker)}})
    return folder / "run.mat"


# ---- HDF5


def hdf5_with(folder: Path, change: Callable[[Any, Any], object], name: str = "run.h5") -> Path:
    """An HDF5 file with a torque over time, changed."""
    h5py = pytest.importorskip("h5py")
    with h5py.File(folder / name, "w") as file:
        for column, values, unit in (("time", TIMES, "s"), ("torque", TORQUE, "Nm")):
            file[column] = values
            file[column].attrs["unit"] = unit
        change(h5py, file)
    return folder / name


def pickles_of_hdf5(folder: Path, marker: Path) -> Path:
    """The pickle as an opaque value, as text of any length, as bytes and as attributes that other programs unpickle."""

    def change(h5py: Any, file: Any) -> None:
        data = pickle.dumps(Bomb(marker), protocol=0)
        file["opaque"] = np.void(data)
        file["opaques"] = np.array([data, data], dtype=f"V{len(data)}")
        file.create_dataset("texts", data=[data, data], dtype=h5py.string_dtype("ascii"))
        file["bytes"] = fuse(marker)
        for name in ("CLASS", "pandas_type", "VERSION", "units"):  # names that PyTables and pandas unpickle
            file["torque"].attrs[name] = np.void(data)
            file.attrs[name] = np.bytes_(data)

    return hdf5_with(folder, change)


def addresses_of_hdf5(folder: Path, marker: Path) -> Path:
    """Opaque values whose tag makes h5py take them for addresses of Python objects; also where a unit is looked for."""
    return hdf5_with(folder, lambda h5py, file: forged(h5py, file, "forged", file["torque"], "unit"))


def addresses_of_matlab(folder: Path, marker: Path) -> Path:
    """The same in a file of MATLAB 7.3."""
    h5py = pytest.importorskip("h5py")
    path = folder / "run.mat"
    with h5py.File(path, "w", userblock_size=512) as file:
        for name, values in (("time", TIMES), ("torque", TORQUE)):
            file[name] = values[None, :]
            file[name].attrs["MATLAB_class"] = np.bytes_("double")
        forged(h5py, file, "forged", file["torque"], "MATLAB_empty")
        file["forged"].attrs["MATLAB_class"] = np.bytes_("double")
        forged(h5py, file.create_group("thing"), "unit", file["time"], "MATLAB_fields")
        file["thing/unit"].attrs["MATLAB_class"] = np.bytes_("char")
    with open(path, "r+b") as raw:
        raw.write(b"MATLAB 7.3 MAT-file, made for a test".ljust(124) + b"\x00\x02IM")
    return path


def forged(h5py: Any, group: Any, name: str, item: Any, attribute: str) -> None:
    kind = h5py.h5t.create(h5py.h5t.OPAQUE, 8)
    kind.set_tag(b"NUMPY:|O")
    content = np.array([b"A" * 8] * 3, dtype="V8")
    space = h5py.h5s.create_simple((3,))
    h5py.h5d.create(group.id, name.encode(), kind, space).write(h5py.h5s.ALL, h5py.h5s.ALL, content, mtype=kind)
    if attribute in item.attrs:
        del item.attrs[attribute]
    h5py.h5a.create(item.id, attribute.encode(), kind, space).write(content, mtype=kind)


# ---- Parquet


def pickles_of_parquet(folder: Path, marker: Path) -> Path:
    """The pickle as a type of its author's own, which pyarrow unpickled before 14.0.1, and as metadata of pandas and of a column."""
    arrow = pytest.importorskip("pyarrow")
    parquet = pytest.importorskip("pyarrow.parquet")
    data = fuse(marker).tobytes()
    own = {b"ARROW:extension:name": b"arrow.py_extension_type", b"ARROW:extension:metadata": data}
    pandas = {"index_columns": ["thing"], "columns": [{"name": "thing", "numpy_type": "object", "metadata": {"encoding": "pickle"}}]}
    schema = arrow.schema(
        [
            arrow.field("time", arrow.float64(), metadata={"unit": "s"}),
            arrow.field("torque", arrow.float64(), metadata={"unit": "Nm", **own}),
            arrow.field("thing", arrow.binary(), metadata={"unit": data}),
            arrow.field("count", arrow.int64(), metadata={b"unit": b"1", b"\xff": b"\x80" + data}),
        ],
        metadata={b"pandas": json.dumps(pandas).encode(), b"pickle": data},
    )
    parquet.write_table(arrow.table([TIMES, TORQUE, [data] * len(TIMES), np.arange(len(TIMES))], schema=schema), folder / "run.parquet")
    return folder / "run.parquet"


MAKERS = (
    opaque_of_matlab,
    function_of_matlab,
    cell_and_object_of_matlab,
    pickles_of_hdf5,
    addresses_of_hdf5,
    addresses_of_matlab,
    pickles_of_parquet,
)


@pytest.mark.parametrize("make", MAKERS)
def test_a_record_beside_code_is_read_and_the_code_is_not_run(make: Callable[[Path, Path], Path], tmp_path: Path, marker: Path) -> None:
    path = make(tmp_path, marker)
    record = hm.read_record(path, units={"time": "s", "torque": "N m"}, channels=["torque"])
    assert np.array_equal(record["torque"].values, TORQUE)
    whole = hm.read_record(path, units={"*": "1", "time": "s"}, refuse=False)
    assert np.array_equal(whole["torque"].values, TORQUE)
    assert any(" was not read: " in note for note in whole.notes), "the thing is named"
    assert "run" in whole.describe()
    assert not marker.exists()


# ---- results and what campaigns and diagnoses keep


def with_objects(folder: Path, bomb: Bomb) -> Path:
    """A result one of whose arrays holds the object, as numpy saves it."""
    path = finished(folder)
    with np.load(path) as archive:
        arrays = {name: archive[name] for name in archive.files}
    arrays["values/y"] = np.array([bomb], dtype=object)
    np.savez(path, **arrays)
    return path


def with_a_head_of_objects(folder: Path, bomb: Bomb) -> Path:
    path = folder / "result.npz"
    np.savez(path, head=np.array([bomb], dtype=object))
    return path


def with_an_array_that_is_a_pickle(folder: Path, bomb: Bomb) -> Path:
    """An entry of the archive that is no array at all."""
    import zipfile

    path = finished(folder)
    with zipfile.ZipFile(path) as archive:
        entries = {name: archive.read(name) for name in archive.namelist()}
    with zipfile.ZipFile(path, "w") as archive:
        for name, content in entries.items():
            archive.writestr(name, pickle.dumps(bomb) if "values" in name else content)
    return path


def that_is_a_pickle(folder: Path, bomb: Bomb) -> Path:
    path = folder / "result.npz"
    path.write_bytes(pickle.dumps(bomb))
    return path


def with_a_class_to_call(folder: Path, bomb: Bomb) -> Path:
    """A head that asks for a call by its words, as some formats of JSON allow."""
    path = folder / "result.npz"
    call = {"class": "os:mkdir", "py/reduce": [{"py/function": "os.mkdir"}, {"py/tuple": [bomb.marker]}], "fields": {"path": bomb.marker}}
    head = {"format": FORMAT, "result": "os.mkdir", "fields": {"values": call}, "scene": call}
    np.savez(path, head=np.frombuffer(json.dumps(head).encode(), dtype=np.uint8))
    return path


def finished(folder: Path) -> Path:
    return FinishedJob(
        scene=None,
        status="complete",
        settings={},
        parameters={"x": 1},
        values={"y": np.arange(5.0)},
        seconds=1.0,
        worker="here:1",
        attempts=1,
    ).save(folder / "result.npz")


RESULTS = (with_objects, with_a_head_of_objects, with_an_array_that_is_a_pickle, that_is_a_pickle, with_a_class_to_call)


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("make", RESULTS)
def test_a_result_with_code_is_refused_and_not_run(make: Callable[[Path, Bomb], Path], tmp_path: Path, marker: Path) -> None:
    path = make(tmp_path, Bomb(marker))
    for load in (hm.load, FinishedJob.load):
        for verify in (True, False):
            with pytest.raises(hm.FileFormatError, match=r"result\.npz"):
                load(path, verify=verify)
    assert not marker.exists()


@pytest.mark.parametrize("make", RESULTS)
def test_what_a_campaign_or_a_diagnosis_kept_is_worked_out_again_where_it_holds_code(
    make: Callable[[Path, Bomb], Path], tmp_path: Path, marker: Path
) -> None:
    hostile = make(tmp_path, Bomb(marker)).read_bytes()
    (tmp_path / "jobs").mkdir()
    (tmp_path / "jobs" / "key.npz").write_bytes(hostile)
    assert JobFiles(folder=tmp_path).read("key") is None
    journal = Journal(tmp_path / "journal", {"records": 1})
    journal.write("key", (1.0,))
    (journal.folder / "key.npz").write_bytes(hostile)
    assert journal.read("key", None) is None
    np.savez(journal.folder / "key", json=np.array([Bomb(marker)], dtype=object))
    assert journal.read("key", None) is None
    assert not marker.exists()


def test_a_report_with_code_is_data(tmp_path: Path, marker: Path) -> None:
    path = tmp_path / "diagnosis.json"
    call = {"py/reduce": [{"py/function": "os.mkdir"}, {"py/tuple": [str(marker)]}], "__class__": "os.mkdir"}
    path.write_text(json.dumps({"schema": "hdrive-mbs diagnosis", "schema_version": 1, "causes": [call]}))
    assert hm.read_report_json(path)["causes"] == [call]
    assert not marker.exists()

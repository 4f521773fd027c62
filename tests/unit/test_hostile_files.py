"""Files made to do harm: none runs code, fills the memory or keeps a reader busy, and each error has the file's name."""

from __future__ import annotations

import copy
import json
import os
import time
import warnings
import zipfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import hdrive_mbs as hm
from hdrive_mbs import memory_limit
from hdrive_mbs.analysis.result import FORMAT, _checksum
from hdrive_mbs.campaign.job_files import FinishedJob, JobFiles
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.journal import Journal
from hdrive_mbs.diagnosis.report_json import read_report_json, report_document, write_report_json
from hdrive_mbs.errors import FileFormatError, HdriveError, UnitError
from hdrive_mbs.records.formats import apart
from hdrive_mbs.scene_file import scene_from_dict, scene_to_dict
from models.harmonic_drive_train import build
from tests.unit.diagnosis_samples import SAMPLES

BUSY = 5.0
"""Seconds of processor time that no bad file may take; those here take less than 1."""


@contextmanager
def soon() -> Iterator[None]:
    before = time.process_time()
    yield
    assert time.process_time() - before < BUSY


def job(folder: Path) -> Path:
    """A small result as a file."""
    return FinishedJob(
        scene=build(),
        status="complete",
        settings={"at": (1.0, "x")},
        parameters={"x": 1},
        values={"y": np.arange(5.0), "z": ("a", {"b": None})},
        seconds=1.0,
        worker="here:1",
        attempts=1,
    ).save(folder / "job.npz")


# scenes and rotors of ROSS

DEEP = 100_000


@pytest.mark.parametrize("read", [hm.load_scene, hm.load_ross])
@pytest.mark.parametrize(
    ("suffix", "content", "said"),
    [
        (".toml", "a." * DEEP + "a = 1\n", "line 1 has a key of more than 200 parts"),
        (".toml", "x = 1\n[" + '"a" . ' * DEEP + "a]\n", "line 2 has a key of more than 200 parts"),
        (".toml", "x = {" + "'a'." * DEEP + "a = 1}\n", "line 1 has a key of more than 200 parts"),
        (".toml", "x = " + "[" * DEEP, "cannot be parsed"),
        (".toml", "x = " + "{a=" * DEEP, "cannot be parsed"),
        (".toml", "x = " + "9" * DEEP, "cannot be parsed"),
        (".json", "[" * DEEP, "cannot be parsed"),
        (".json", '{"a":' * DEEP, "cannot be parsed"),
        (".json", '{"a": ' + "9" * DEEP + "}", "cannot be parsed"),
        (".json", '"\\ud800"', "bad"),
    ],
)
def test_a_document_that_is_deep_or_long_is_refused_soon(
    read: Callable[[Path], hm.Scene], suffix: str, content: str, said: str, tmp_path: Path
) -> None:
    path = tmp_path / f"bad{suffix}"
    path.write_text(content)
    with soon(), pytest.raises(FileFormatError, match=rf"bad\{suffix}.*{said}|{said}"):
        read(path)


def test_text_with_many_dots_is_no_deep_key(tmp_path: Path) -> None:
    scene = hm.Scene(name="dots", parts=build().parts, connections=build().connections, notes="1.0.0, a.b " + "e.g. this. " * 60)
    assert hm.load_scene(hm.save_scene(scene, tmp_path / "dots.toml")) == scene


@pytest.mark.parametrize("read", [hm.load_scene, hm.load_ross])
def test_a_document_of_any_size_and_a_pipe_are_refused_before_they_are_read(read: Callable[[Path], hm.Scene], tmp_path: Path) -> None:
    path = tmp_path / "large.toml"
    with path.open("wb") as file:
        file.truncate(2**40)  # takes no room on the disk
    with soon(), pytest.raises(FileFormatError, match=r"large\.toml has 1048576 MiB; .* at most 16 MiB"):
        read(path)
    os.mkfifo(tmp_path / "pipe.toml")
    with pytest.raises(FileFormatError, match=r"pipe\.toml is no regular file"):
        read(tmp_path / "pipe.toml")


@pytest.mark.parametrize(
    "value",
    [
        "1 x" + " " * DEEP + "y",
        "1" + " " * DEEP,
        "1" * DEEP + " kg*m^2",
        "1 " + "kg*" * DEEP,
        "1 " + "(" * DEEP,
        "1 kg**9**9**9",
        "1e999999999 kg*m^2",
        "__import__('os').system('true') kg",
        10**4000,
        {"unit": "rpm", "values": [10**4000]},
        json.loads("[" * 300 + "]" * 300),
    ],
    ids=lambda value: str(value)[:12] if isinstance(value, str) else type(value).__name__,
)
@pytest.mark.parametrize("place", [("motor", "inertia"), ("gear", "stiffness"), ("motor", "characteristic")])
def test_a_value_of_a_scene_that_is_long_or_deep_is_refused_soon(value: Any, place: tuple[str, str], tmp_path: Path) -> None:
    changed = copy.deepcopy(scene_to_dict(build()))
    changed["parts"][place[0]][place[1]] = value
    path = tmp_path / "bad.json"
    path.write_text(json.dumps(changed))
    with soon(), pytest.raises(HdriveError, match=r"bad\.json"):
        hm.load_scene(path)


def test_a_table_of_whole_numbers_without_end_is_refused(tmp_path: Path) -> None:
    drag = {"type": "TableLoad", "speeds": {"unit": "rpm", "values": [0, 10**4000]}, "torques": {"unit": "N m", "values": [0, 1]}}
    changed = scene_to_dict(build())
    known = changed["parts"]["load"]["torque"]["type"]
    changed["parts"]["load"]["torque"] = drag
    with pytest.raises(HdriveError):
        scene_from_dict(changed)
    assert known != "TableLoad"


# results


def repacked(path: Path, change: Callable[[dict[str, Any], dict[str, np.ndarray]], object]) -> None:
    """Write the file with another content and the checksum that fits it, as one who means harm would."""
    with np.load(path) as archive:
        arrays = {name: archive[name] for name in archive.files}
    document = json.loads(bytes(arrays.pop("head")).decode())
    del document["sha256"]
    change(document, arrays)
    document["sha256"] = _checksum(document, arrays)
    np.savez_compressed(path, head=np.frombuffer(json.dumps(document).encode(), np.uint8), **arrays)


@pytest.mark.parametrize(
    "change",
    [
        lambda d, a: d.pop("result"),
        lambda d, a: d.update(result=["FinishedJob"]),
        lambda d, a: d.update(result={"a": 1}),
        lambda d, a: d.update(result="Result"),
        lambda d, a: d.update(result="__class__"),
        lambda d, a: d.update(result="simulate"),
        lambda d, a: d.pop("fields"),
        lambda d, a: d.update(fields=[1, 2]),
        lambda d, a: d["fields"].update(values={"array": "nothing"}),
        lambda d, a: d["fields"].update(values={"map": 3}),
        lambda d, a: d["fields"].update(values={"map": [[{"a": 1}, 2]]}),
        lambda d, a: d["fields"].update(values={"neither": 1}),
        lambda d, a: d["fields"].update(values={"tuple": 5}),
        lambda d, a: d.pop("scene"),
        lambda d, a: a.pop("values/y"),
    ],
)
def test_a_forged_head_with_a_right_checksum_is_refused(
    change: Callable[[dict[str, Any], dict[str, np.ndarray]], object], tmp_path: Path
) -> None:
    path = job(tmp_path)
    repacked(path, change)
    with pytest.raises(FileFormatError, match=r"job\.npz"):
        hm.load(path)
    assert JobFiles(folder=None).read("job") is None


@pytest.mark.parametrize("depth", [100, 300, 480, 900, 990, 20_000])
def test_a_head_that_is_nested_deep_is_refused(depth: int, tmp_path: Path) -> None:
    path = tmp_path / "deep.npz"
    head = f'{{"format": "{FORMAT}", "fields": {{"values": ' + '{"tuple": [' * depth + "]}" * depth + "}}"
    np.savez(path, head=np.frombuffer(head.encode(), dtype=np.uint8))
    warnings.simplefilter("ignore")  # pytest sets it back
    with pytest.raises(FileFormatError, match=r"deep\.npz"):
        hm.load(path, verify=False)


PLAIN = st.recursive(
    st.none() | st.booleans() | st.integers(-5, 5) | st.floats() | st.sampled_from(["values/y", "Modes", "x", ""]),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.sampled_from(["array", "map", "tuple", "type", "x"]), inner, max_size=2),
    max_leaves=5,
)


def spots(value: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    entries = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, inner in entries:
        yield (*path, key)
        yield from spots(inner, (*path, key))


@settings(max_examples=60, deadline=None, derandomize=True, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data())
def test_whatever_stands_in_a_head_gives_a_result_or_an_error_of_ours(data: st.DataObject, tmp_path: Path) -> None:
    path = job(tmp_path)

    def change(document: dict[str, Any], arrays: dict[str, np.ndarray]) -> None:
        spot = data.draw(st.sampled_from([path for path in spots(document) if path[0] != "scene" or len(path) < 4]))
        inside: Any = document
        for key in spot[:-1]:
            inside = inside[key]
        inside[spot[-1]] = data.draw(PLAIN)

    repacked(path, change)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            found: Any = hm.load(path)
        except HdriveError as error:
            found = str(error)
    assert isinstance(found, hm.Result) or str(path) in found


def test_a_damaged_result_can_be_read_as_it_is(tmp_path: Path) -> None:
    path = job(tmp_path)
    with np.load(path) as archive:
        arrays = {name: archive[name] for name in archive.files}
    arrays["values/y"] = arrays["values/y"] + 1.0
    np.savez_compressed(path, **arrays)
    with pytest.raises(FileFormatError, match=r"job\.npz: the checksum does not fit.*load\(path, verify=False\)"):
        FinishedJob.load(path)
    with pytest.warns(UserWarning, match="the checksum does not fit"):
        found = FinishedJob.load(path, verify=False)
    assert list(found.values["y"]) == [1.0, 2.0, 3.0, 4.0, 5.0]
    assert found.scene == build()
    with zipfile.ZipFile(path, "a") as archive:
        archive.writestr("note.txt", "no array")
    with pytest.raises(FileFormatError, match=r"job\.npz is not a result"):
        hm.load(path, verify=False)


def test_a_result_that_unfolds_to_more_than_half_of_the_memory_is_refused_unread(tmp_path: Path) -> None:
    path = job(tmp_path)
    with zipfile.ZipFile(path, "a", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("values.npy", b"\0" * 10**6)
    content = path.read_bytes()
    entry = content.rindex(b"PK\x01\x02")  # its entry in the directory says how much it unfolds to
    path.write_bytes(content[: entry + 24] + (2**32 - 2).to_bytes(4, "little") + content[entry + 28 :])
    assert path.stat().st_size < 10**5
    claims = pytest.MonkeyPatch()
    with claims.context() as patch:
        patch.setattr(memory_limit, "largest", lambda: 2**31)
        with soon(), pytest.raises(FileFormatError, match=r"job\.npz has .* MiB and claims to hold 4 GiB of numbers"):
            hm.load(path)


# records


def spread(folder: Path) -> Path:
    """An HDF5 file with 1024 columns of 2 GiB that were never written."""
    h5py = pytest.importorskip("h5py")
    path: Path = folder / "spread.h5"
    with h5py.File(path, "w") as file:
        for number in range(1024):
            file.create_dataset(f"c{number}", shape=(2**28,), dtype="f8", chunks=(2**20,))
    return path


def long_runs(folder: Path) -> Path:
    """A Parquet file with 8 columns of 2^20 equal numbers."""
    pa = pytest.importorskip("pyarrow")
    from pyarrow import parquet

    column = pa.array(np.zeros(2**20, dtype=np.int8))
    path = folder / "long_runs.parquet"
    parquet.write_table(pa.table({f"c{number}": column for number in range(8)}), path)
    return path


@pytest.mark.parametrize(("make", "limit"), [(spread, 2**34), (long_runs, 2**25)])
def test_a_record_that_unfolds_to_more_than_half_of_the_memory_is_refused(
    make: Callable[[Path], Path], limit: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = make(tmp_path)
    monkeypatch.setattr(memory_limit, "largest", lambda: limit)  # the reader of HDF5 is a process of its own: half of the real memory
    assert path.stat().st_size < 2**22
    with soon(), pytest.raises(FileFormatError, match=rf"{path.stem}.* GiB of numbers.*channels=\[\.\.\.\]"):
        hm.read_record(path, time=1e-3, units={"*": "1"})


def test_a_reader_of_its_own_process_has_bounded_memory(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from scipy.io import savemat

    path, small = tmp_path / "zeros.mat", tmp_path / "small.mat"
    savemat(path, {"x": np.zeros(2**23)}, do_compression=True)  # 64 MiB
    savemat(small, {"x": np.arange(100.0)}, do_compression=True)
    assert path.stat().st_size < 2**18
    bound = (
        "import sys; sys.path.insert(0, sys.argv[1]); import scipy.io; from hdrive_mbs.records.formats import apart, mat;"
        "pages = int(open('/proc/self/statm').read().split()[0]);"
        "apart.largest = lambda: 0; apart.SMALLEST_BOUND = 4096 * pages + 2**25; apart.main(*sys.argv[2:])"
    )
    monkeypatch.setattr(apart, "_PROGRAM", bound)
    assert len(hm.read_record(small, time=1e-3, units={"x": "1"}, refuse=False)) == 100
    with pytest.raises(FileFormatError, match=r"zeros\.mat"):
        hm.read_record(path, time=1e-3, units={"x": "1"}, refuse=False)


def test_a_matrix_with_more_channels_than_a_record_can_have_is_refused_soon(tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py")
    path = tmp_path / "wide.h5"
    with h5py.File(path, "w") as file:
        file["time"] = np.arange(4.0)
        file["wide"] = np.zeros((4, 200_000), dtype=np.int8)
    with soon(), pytest.raises(FileFormatError, match=r"wide\.h5 has 200000 columns"):
        hm.read_record(path)


@pytest.mark.parametrize(
    "head",
    ["a" + " " * DEEP + "b", "[" * DEEP, "(" * DEEP + "a", "a (" + "(b)" * DEEP, "a [" + "m*" * DEEP + "]", "a [" + "1 " * DEEP + "rad]"],
    ids=["spaces", "brackets", "parentheses", "pairs", "unit", "numbers"],
)
def test_a_heading_of_any_length_is_read_soon(head: str, tmp_path: Path) -> None:
    path = tmp_path / "long.csv"
    path.write_text(f"time [s];{head}\n" + "".join(f"{0.001 * k:.3f};{k}\n" for k in range(60)))
    with soon(), pytest.raises((FileFormatError, UnitError), match=r"long\.csv"):
        hm.read_record(path)


@pytest.mark.parametrize("unit", ["1" * DEEP, "1" + " " * DEEP + "x", "m^2*" * DEEP, "/min" * DEEP])
def test_a_unit_of_any_length_is_read_soon(unit: str, tmp_path: Path) -> None:
    path = tmp_path / "long.csv"
    path.write_text(f"time;a\ns;{unit}\n" + "".join(f"{0.001 * k:.3f};{k}\n" for k in range(60)))
    for units in ({}, {"a": unit}):
        with soon(), pytest.raises(HdriveError, match=r"long\.csv"):
            hm.read_record(path, units=units)


def test_text_that_is_hardly_a_table_is_read_soon(tmp_path: Path) -> None:
    path = tmp_path / "odd.csv"
    for content in ('"' * DEEP, '"' + "a\n" * DEEP, "1;" * DEEP, "1," * DEEP + "\n" + "1," * DEEP, ";\n" * DEEP, "\n" * DEEP, "#" * DEEP):
        path.write_text(content)
        with soon(), pytest.raises(HdriveError, match=r"odd\.csv"):
            hm.read_record(path)


# what a diagnosis keeps


def test_a_damaged_answer_of_a_journal_is_worked_out_again(tmp_path: Path) -> None:
    journal = Journal(tmp_path, {"records": 1})
    answer = (Hypothesis(factors=()), {"z": np.arange(4.0)}, (1.0, "x"))
    journal.write("key", answer)
    file = journal.folder / "key.npz"
    whole = file.read_bytes()
    kept = journal.read("key", None)
    assert kept is not None
    assert kept[0][0].factors == ()
    assert (list(kept[0][1]["z"]), kept[0][2]) == ([0.0, 1.0, 2.0, 3.0], answer[2])
    rng = np.random.default_rng(3)
    lost = 0
    for number in range(150):
        damaged = bytearray(whole[: int(rng.integers(len(whole)))] if number % 5 == 0 else whole)
        for place in rng.integers(0, len(damaged), 3) if damaged else ():
            damaged[place] = int(rng.integers(256))
        file.write_bytes(bytes(damaged))
        lost += journal.read("key", None) is None
    assert lost > 50
    for text in ("[" * DEEP, '{"class": "os:system", "fields": {"command": "true"}}', '{"array": "none"}', '{"tuple": 3}'):
        np.savez(file.with_suffix(""), json=np.frombuffer(text.encode(), dtype=np.uint8))
        assert journal.read("key", None) is None


@pytest.mark.parametrize("content", [b"", b"[" * DEEP, b"{}", b'{"schema": 1}', b"\xff\xfe", b'{"schema": "hdrive-mbs diagnosis"}'])
def test_a_report_that_is_none_is_refused(content: bytes, tmp_path: Path) -> None:
    path = tmp_path / "report.json"
    path.write_bytes(content)
    with pytest.raises(FileFormatError, match=r"report\.json"):
        read_report_json(path)


def test_a_report_of_any_size_and_a_pipe_are_refused_before_they_are_read(tmp_path: Path) -> None:
    path = tmp_path / "large.json"
    with path.open("wb") as file:
        file.truncate(2**40)  # takes no room on the disk
    with soon(), pytest.raises(FileFormatError, match=r"large\.json has 1048576 MiB; .* at most 128 MiB"):
        read_report_json(path)
    os.mkfifo(tmp_path / "pipe.json")
    with pytest.raises(FileFormatError, match=r"pipe\.json is no regular file"):
        read_report_json(tmp_path / "pipe.json")
    with pytest.raises(FileFormatError, match="cannot be read"):
        read_report_json(tmp_path)


def taken(path: Path, *, verify: bool = True) -> dict[str, Any] | None:
    """What the file of a report gives; None where it is refused by its name."""
    try:
        return read_report_json(path, verify=verify)
    except HdriveError as error:
        said = str(error)
    assert path.name in said
    return None


ODD = st.sampled_from([10**400, -(10**310), True, "\ud800", "sha256", 10.0**300, json.loads("[" * 300 + "]" * 300)])
"""What no report that was written holds, on top of what PLAIN gives."""


@settings(max_examples=100, deadline=None, derandomize=True, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data())
def test_whatever_stands_in_a_report_gives_its_data_or_an_error_of_ours(data: st.DataObject, tmp_path: Path) -> None:
    written = report_document(SAMPLES["without_pictures"]())
    changed: Any = copy.deepcopy(written)
    spot = data.draw(st.sampled_from([path for path in spots(changed) if not path[0].endswith("_scene") or len(path) < 4]))
    inside = changed
    for key in spot[:-1]:
        inside = inside[key]
    if data.draw(st.booleans()):
        inside[spot[-1]] = data.draw(PLAIN | ODD)
    else:
        del inside[spot[-1]]
    path = tmp_path / "report.json"
    path.write_text(json.dumps(changed))
    found = taken(path)
    if json.dumps(json.loads(path.read_text())) == json.dumps(written):  # as text: True is no 1 there
        assert found == written
    elif found is not None:  # numbers that are written in another way, or no checksum
        assert "sha256" not in found or all(found[name] == written[name] for name in written)
    unverified = taken(path, verify=False)
    assert unverified is None or unverified["schema"] == written["schema"]


@settings(max_examples=150, deadline=None, derandomize=True, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    content=st.binary(max_size=200) | st.text(alphabet='{}[]",:0123456789eE+-.truefalsn \\ud8', max_size=200).map(str.encode),
    within=st.booleans(),
)
def test_any_text_in_a_report_gives_its_data_or_an_error_of_ours(content: bytes, within: bool, tmp_path: Path) -> None:
    path = tmp_path / "report.json"
    head = b'{"schema": "hdrive-mbs diagnosis", "schema_version": 1, "sha256": "x", "causes": '
    path.write_bytes(head + content + b"}" if within else content)
    assert taken(path) is None
    assert within or taken(path, verify=False) is None


def test_a_report_with_flipped_or_missing_bytes_is_refused_or_reads_the_same(tmp_path: Path) -> None:
    answer = SAMPLES["without_pictures"]()
    path = write_report_json(answer, tmp_path / "report.json")
    whole, written = path.read_bytes(), report_document(answer)
    rng = np.random.default_rng(6)
    refused = 0
    for number in range(200):
        damaged = bytearray(whole[: int(rng.integers(len(whole)))] if number % 4 == 0 else whole)
        for place in rng.integers(0, len(damaged), 1 + number % 3) if damaged else ():
            damaged[place] = int(rng.integers(256))
        path.write_bytes(bytes(damaged))
        found = taken(path)
        assert found is None or found == written  # spaces between the values may be others
        refused += found is None
    assert refused > 100

"""Results: saved whole, loaded equal, refused when they are damaged, foreign or of another version."""

from __future__ import annotations

import csv
import dataclasses
import functools
import json
import pickle
import zipfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.analysis.result import FORMAT, Result, _checksum
from hdrive_mbs.errors import FileFormatError, HdriveError, unknown_place
from tests.verification.scenes import train


@functools.cache
def response() -> hm.Response:
    return hm.simulate(train(), 0.05, initial_speed=10.0, estimate_error=True)


@functools.cache
def modes() -> hm.Modes:
    return hm.modes(train(), torque=50.0)


@functools.cache
def campbell() -> hm.Campbell:
    return hm.torsional_campbell(train(), np.linspace(5.0, 150.0, 8), orders={"gear.wave_generator": (1, 2)}, torque=4.0)


MAKERS: dict[str, Callable[[], Result]] = {"Response": response, "Modes": modes, "Campbell": campbell}
results = pytest.mark.parametrize("make", MAKERS.values(), ids=MAKERS.keys())


def assert_equal(got: Any, want: Any, where: str = "") -> None:
    if isinstance(want, np.ndarray):
        assert got.dtype == want.dtype, where
        np.testing.assert_array_equal(got, want, err_msg=where)
    elif isinstance(want, Mapping):
        assert list(got) == list(want), where
        for key in want:
            assert_equal(got[key], want[key], f"{where}.{key}")
    elif isinstance(want, (tuple, list)):
        assert len(got) == len(want), where
        for k, item in enumerate(want):
            assert_equal(got[k], item, f"{where}[{k}]")
    else:
        assert got == want, where


@results
def test_every_field_of_a_result_comes_back_equal(make: Callable[[], Result], tmp_path: Path) -> None:
    result = make()
    path = result.save(tmp_path / "result.npz")
    for again in (hm.load(path), type(result).load(path)):
        assert type(again) is type(result)
        for field in dataclasses.fields(result):
            assert_equal(getattr(again, field.name), getattr(result, field.name), field.name)


@results
def test_a_result_knows_scene_settings_versions_and_status(make: Callable[[], Result]) -> None:
    result = make()
    assert isinstance(result.scene, hm.Scene)
    assert result.status.startswith("complete")
    assert set(result.versions) == {"python", "hdrive-mbs", "exudyn", "numpy", "scipy"}
    assert "unknown" not in result.versions.values()
    assert result.settings
    with pytest.raises(dataclasses.FrozenInstanceError):
        result.status = "other"  # type: ignore[misc]


def test_a_loaded_response_answers_as_the_fresh_one(tmp_path: Path) -> None:
    again = hm.Response.load(response().save(tmp_path / "r.npz"))
    assert again.channels == response().channels
    times = np.linspace(0.0, 0.05, 7)
    np.testing.assert_array_equal(again["gear.torque"].at(times), response()["gear.torque"].at(times))
    assert again.summary() == response().summary()
    assert ("motor.speed" in again, "motor.sped" in again) == (True, False)
    with pytest.raises(HdriveError, match=r"No channel 'motor\.sped'\. This response has: motor\.angle"):
        again["motor.sped"]


@results
def test_csv_has_one_headed_column_per_quantity_with_its_unit(make: Callable[[], Result], tmp_path: Path) -> None:
    result = make()
    columns = result.columns()
    with result.to_csv(tmp_path / "r.csv").open(newline="") as file:
        head, *rows = list(csv.reader(file))
    assert head == list(columns)
    assert all("[" in name and name.endswith("]") for name in head if name != "mode")
    table = np.array([[float(value) for value in row] for row in rows])
    assert table.shape == (len(next(iter(columns.values()))), len(head))
    for k, values in enumerate(columns.values()):
        np.testing.assert_allclose(table[:, k], values, rtol=1e-11, equal_nan=True)  # twelve digits are written


def test_a_result_is_no_result_of_another_type(tmp_path: Path) -> None:
    path = modes().save(tmp_path / "m.npz")
    with pytest.raises(FileFormatError, match=r"m\.npz holds a Modes, not a Response"):
        hm.Response.load(path)


# -- scenes that a file cannot hold -------------------------------------------------------------------


def test_a_result_of_a_scene_with_a_python_function_keeps_its_histories_and_loses_its_scene(tmp_path: Path) -> None:
    own = hm.simulate(train(load=lambda time: 5.0 + np.sin(time)), 0.02)
    again = hm.Response.load(own.save(tmp_path / "r.npz"))
    assert again.scene is None
    assert again.status == own.status
    for name in own.channels:
        np.testing.assert_array_equal(again[name].values, own[name].values)


def test_a_result_whose_scene_names_an_unknown_class_keeps_its_histories_and_says_so(tmp_path: Path) -> None:
    path = response().save(tmp_path / "r.npz")

    def change(document: dict[str, Any]) -> None:
        document["scene"]["parts"]["load"]["torque"]["type"] = "LawOfSomebodyElse"

    repack(path, change)
    with pytest.warns(UserWarning, match=r"numbers are complete, but the scene cannot be made again .*'LawOfSomebodyElse'"):
        again = hm.Response.load(path)
    assert again.scene is None
    np.testing.assert_array_equal(again["load.speed"].values, response()["load.speed"].values)


# -- files that are refused -----------------------------------------------------------------------------


def repack(path: Path, change: Callable[[dict[str, Any]], None], *, right_checksum: bool = True, **arrays: np.ndarray) -> None:
    """Write the file again with its head changed, as another version of the package would."""
    with np.load(path) as archive:
        content = {name: archive[name] for name in archive.files} | arrays
    document = json.loads(bytes(content.pop("head")).decode())
    checksum = document.pop("sha256")
    change(document)
    document["sha256"] = _checksum(document, content) if right_checksum else checksum
    np.savez_compressed(path, head=np.frombuffer(json.dumps(document).encode(), np.uint8), **content)


def nothing(_: dict[str, Any]) -> None:
    return


def test_repacking_alone_changes_nothing(tmp_path: Path) -> None:
    path = response().save(tmp_path / "r.npz")
    repack(path, nothing)
    assert_equal(hm.Response.load(path).values, response().values)


def test_a_file_cut_off_anywhere_is_refused(tmp_path: Path) -> None:
    whole = modes().save(tmp_path / "whole.npz").read_bytes()
    path = tmp_path / "cut.npz"
    for cut in [*range(0, len(whole), max(1, len(whole) // 40)), len(whole) - 1]:
        path.write_bytes(whole[:cut])
        with pytest.raises(FileFormatError, match=r"cut\.npz .*(truncated|not a result)"):
            hm.load(path)


def test_a_changed_byte_is_refused_or_was_of_no_meaning(tmp_path: Path) -> None:
    whole = modes().save(tmp_path / "whole.npz").read_bytes()
    path = tmp_path / "changed.npz"
    rng = np.random.default_rng(5)
    refused = 0
    for position in rng.integers(0, len(whole), 150):
        changed = bytearray(whole)
        changed[position] ^= 1 << int(rng.integers(0, 8))
        path.write_bytes(bytes(changed))
        try:
            again = hm.load(path)
        except FileFormatError:
            refused += 1
        else:  # a date or a comment field of the archive
            assert isinstance(again, hm.Modes)
            assert_equal(again.undamped, modes().undamped)
            assert_equal(again.status, modes().status)
    assert refused > 75


@pytest.mark.parametrize(
    "change",
    [
        lambda document: document["fields"].update(status="better than complete"),
        lambda document: document["fields"].update(motor_speed=1.0),
        lambda document: document["scene"].update(name="another"),
    ],
)
def test_a_head_that_was_edited_does_not_fit_its_checksum(change: Callable[[dict[str, Any]], None], tmp_path: Path) -> None:
    path = modes().save(tmp_path / "m.npz")
    repack(path, change, right_checksum=False)
    with pytest.raises(FileFormatError, match=r"m\.npz: the checksum does not fit; the file was changed or damaged"):
        hm.load(path)


def test_numbers_that_were_edited_do_not_fit_their_checksum(tmp_path: Path) -> None:
    path = modes().save(tmp_path / "m.npz")
    for other in (modes().undamped * 1.000001, modes().undamped.reshape(-1, 1)):
        repack(path, nothing, right_checksum=False, undamped=other)
        with pytest.raises(FileFormatError, match=r"checksum does not fit"):
            hm.load(path)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda d: d.update(format="hdrive-mbs result 2"), r"found 'hdrive-mbs result 2'\)\. A newer version of hdrive_mbs wrote it"),
        (lambda d: d.update(format="somebody's result"), rf"is not in the format '{FORMAT}' \(found \"somebody's result\"\)\.$"),
        (lambda d: d.update(result="Hologram"), r"holds a 'Hologram', which this version does not know"),
        (lambda d: d["fields"].pop("undamped"), r"the fields of a Modes have changed with the version \(undamped\)"),
        (lambda d: d["fields"].update(colour="red"), r"the fields of a Modes have changed with the version \(colour\)"),
    ],
)
def test_a_file_of_another_version_says_so(change: Callable[[dict[str, Any]], None], message: str, tmp_path: Path) -> None:
    path = modes().save(tmp_path / "m.npz")
    repack(path, change)
    with pytest.raises(FileFormatError, match=message):
        hm.load(path)


class Trap:
    """Runs code when it is unpickled."""

    def __init__(self, path: Path) -> None:
        self.path = path

    def __reduce__(self) -> tuple[Any, ...]:
        return Path.touch, (self.path,)


def test_foreign_files_are_refused_and_nothing_in_them_is_run(tmp_path: Path) -> None:
    touched = tmp_path / "touched"

    def text(path: Path) -> None:
        path.write_text("time,speed\n0,1\n")

    def empty(path: Path) -> None:
        path.write_bytes(b"")

    def noise(path: Path) -> None:
        path.write_bytes(np.random.default_rng(1).bytes(5000))

    def other_archive(path: Path) -> None:
        with path.open("wb") as file:
            np.savez(file, a=np.zeros(3))

    def array(path: Path) -> None:
        with path.open("wb") as file:
            np.save(file, np.zeros(3))

    def pickled(path: Path) -> None:
        path.write_bytes(pickle.dumps(Trap(touched)))

    def pickled_head(path: Path) -> None:
        with path.open("wb") as file:
            np.savez(file, head=np.array([Trap(touched)], dtype=object))

    def pickled_array(path: Path) -> None:
        modes().save(path)
        repack(path, nothing, undamped=np.array([Trap(touched)], dtype=object))

    def number_head(path: Path) -> None:
        with path.open("wb") as file:
            np.savez(file, head=np.arange(4.0))

    def list_head(path: Path) -> None:
        with path.open("wb") as file:
            np.savez(file, head=np.frombuffer(b"[1, 2]", np.uint8))

    def zip_of_texts(path: Path) -> None:
        with zipfile.ZipFile(path, "w") as archive:
            archive.writestr("head.npy", "not an array")

    def scene_file(path: Path) -> None:
        hm.save_scene(train(), path.with_suffix(".json")).replace(path)

    for write in (
        text, empty, noise, other_archive, array, pickled, pickled_head, pickled_array, number_head, list_head, zip_of_texts, scene_file,
    ):  # fmt: skip
        path = tmp_path / f"{write.__name__}.npz"
        write(path)
        with pytest.raises(FileFormatError, match=rf"{write.__name__}\.npz"):
            hm.load(path)
    assert not touched.exists()


def test_a_file_that_is_not_there_and_a_folder_are_named(tmp_path: Path) -> None:
    with pytest.raises(FileFormatError, match=r"nothing\.npz: no such file"):
        hm.load(tmp_path / "nothing.npz")
    with pytest.raises(FileFormatError, match=tmp_path.name):
        hm.load(tmp_path)


# -- writing ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("write", [Result.save, Result.to_csv])
def test_a_folder_that_cannot_be_written_to_is_named_and_nothing_is_left(write: Callable[..., Path], tmp_path: Path) -> None:
    blocker = tmp_path / "file"
    blocker.write_text("in the way")
    with pytest.raises(FileFormatError, match=r"Cannot write .*Choose a folder that can be written to"):
        write(modes(), blocker / "m.npz")
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


def test_a_result_that_cannot_be_saved_leaves_the_old_file_untouched(tmp_path: Path) -> None:
    path = modes().save(tmp_path / "m.npz")
    before = path.read_bytes()
    odd = dataclasses.replace(modes(), undamped=np.array([object()], dtype=object))
    with pytest.raises(TypeError, match="undamped: an array of Python objects"):
        odd.save(path)
    assert path.read_bytes() == before
    assert [item.name for item in tmp_path.iterdir()] == ["m.npz"]


def test_results_of_a_user_s_own_are_saved_and_loaded(tmp_path: Path) -> None:
    @dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
    class GapOfThisTest(Result):
        """A result with every kind of field."""

        numbers: np.ndarray
        nested: Mapping[str, Any]
        flag: bool
        nothing: None = None

    nested = {"a": (1, 2.5, "x"), "b": {"c": np.arange(3) * 1j}, "d": None, "e": [np.float64(1.5), np.int64(3), np.True_]}
    own = GapOfThisTest(scene=None, status="complete", settings={}, numbers=np.array([1.0, np.nan]), nested=nested, flag=True)
    again = hm.load(own.save(tmp_path / "own.npz"))
    assert isinstance(again, GapOfThisTest)
    assert_equal(again.numbers, own.numbers)
    assert_equal(again.nested, nested)
    assert (again.flag, again.nothing, again.scene) == (True, None, None)
    with pytest.raises(NotImplementedError, match="GapOfThisTest has no table"):
        own.to_csv(tmp_path / "own.csv")


def test_a_response_writes_the_channels_that_are_asked_for(tmp_path: Path) -> None:
    run = response()
    path = run.to_csv(tmp_path / "few.csv", ["motor.speed", "gear.torque"])
    rows = path.read_text().splitlines()
    assert rows[0] == "time [s],motor.speed [rad/s],gear.torque [N m]"
    assert len(rows) == len(run.times) + 1
    with pytest.raises(hm.PlaceError, match="No channel 'gear'"):
        run.to_csv(tmp_path / "none.csv", ["gear"])


def test_of_many_names_an_error_lists_those_that_are_spelt_alike() -> None:
    names = [f"place_{k}.{axis}" for k in range(30) for axis in "xy"]
    text = str(unknown_place("channel", "place_7.z", names, "This response"))
    assert text.startswith("No channel 'place_7.z'. This response has 60, like it: place_7.")
    assert text.count(",") < 20
    assert "This response has 60, for instance: place_0.x" in str(unknown_place("channel", "???", names, "This response"))
    assert str(unknown_place("place", "gaer", ["motor", "gear"])) == "No place 'gaer'. This scene has: motor, gear. Did you mean 'gear'?"
    assert str(unknown_place("place", "x", ["motor", "gear"])) == "No place 'x'. This scene has: motor, gear."

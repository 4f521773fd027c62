"""Results for other programs: what is written is read back by the programs' own readers."""

from __future__ import annotations

import csv
import dataclasses
import json
import sys
from pathlib import Path

import numpy as np
import pytest
from scipy.io import loadmat

import hdrive_mbs as hm
from hdrive_mbs.errors import DependencyError, FileFormatError
from hdrive_mbs.export.matlab import LONGEST, identifiers
from hdrive_mbs.export.table import table_of
from hdrive_mbs.scene_file import scene_from_dict
from models.harmonic_drive_train import build


@pytest.fixture(scope="module")
def response() -> hm.Response:
    return hm.simulate(build(), 0.01, solver=hm.RungeKutta4(step=1e-5))


@pytest.fixture(scope="module")
def campaign() -> hm.Campaign:
    """A table with texts, numbers that are missing, and switches."""
    points = [{"x": 1.0, "kind": "full"}, {"x": 2.0, "kind": "merged"}]
    return hm.sweep(lambda point: {"peak/mean [1]": 1.5} if point["x"] > 1 else {"even": True}, points, executor="here", units={"x": "m"})


def test_parquet_keeps_numbers_to_the_last_bit_units_and_how_it_was_made(response: hm.Response, tmp_path: Path) -> None:
    parquet = pytest.importorskip("pyarrow.parquet", reason="pyarrow comes with the records extra")
    table = parquet.read_table(response.export(tmp_path / "run.parquet"))
    assert table.column_names == ["time", *response.channels]
    assert np.array_equal(table.column("gear.torque").to_numpy(), response["gear.torque"].values)
    assert table.schema.field("gear.torque").metadata == {b"unit": b"N m"}
    head = table.schema.metadata
    assert head[b"hdrive_mbs.result"] == b"Response"
    assert json.loads(head[b"hdrive_mbs.versions"])["exudyn"] == response.versions["exudyn"]
    assert scene_from_dict(json.loads(head[b"hdrive_mbs.scene"])) == build()


def head_of(file: Path) -> dict[str, str]:
    """What a file says of its result, by the reader of its format alone."""
    if file.suffix == ".parquet":
        parquet = pytest.importorskip("pyarrow.parquet", reason="pyarrow comes with the records extra")
        return {name.decode(): text.decode() for name, text in parquet.read_schema(file).metadata.items()}
    if file.suffix == ".h5":
        h5py = pytest.importorskip("h5py", reason="h5py comes with the records extra")
        with h5py.File(file) as found:
            long = {name: data[()].decode() for name, data in found.items() if name.startswith("hdrive_mbs.")}
            return {**found.attrs, **long}
    head = loadmat(file, squeeze_me=True, struct_as_record=False)["hdrive_mbs"]
    return {f"hdrive_mbs.{name}": str(getattr(head, name)) for name in head._fieldnames}


@pytest.mark.parametrize("suffix", ["parquet", "h5", "mat"])
@pytest.mark.parametrize("notes", ["", "x" * 100_000], ids=["short", "longer_than_an_attribute_of_hdf5"])
def test_every_format_holds_the_whole_origin_and_the_checksum_of_the_saved_result(tmp_path: Path, suffix: str, notes: str) -> None:
    train = build()
    scene = hm.Scene(name=train.name, parts=train.parts, connections=train.connections, effects=train.effects, notes=notes)
    curve = hm.torsion(scene, [20.0, 40.0])
    saved = hm.load(curve.save(tmp_path / "curve.npz"))
    head = head_of(saved.export(tmp_path / f"curve.{suffix}"))
    assert set(head) == {f"hdrive_mbs.{name}" for name in ("result", "status", "settings", "versions", "scene", "sha256")}
    told = {name: json.loads(head[f"hdrive_mbs.{name}"]) for name in ("settings", "versions", "scene")}
    assert {"result": head["hdrive_mbs.result"], "status": head["hdrive_mbs.status"], **told} == curve.made_from()
    assert scene_from_dict(told["scene"]) == scene
    with np.load(tmp_path / "curve.npz") as archive:
        written = json.loads(bytes(archive["head"]))
    assert head["hdrive_mbs.sha256"] == written["sha256"] == curve.checksum()


@pytest.mark.parametrize("suffix", ["parquet", "h5", "mat"])
def test_numbers_in_the_settings_are_written_and_other_numbers_have_another_checksum(
    campaign: hm.Campaign, tmp_path: Path, suffix: str
) -> None:
    asked = dataclasses.replace(campaign, settings={"speeds": np.array([0.0, 100.0])})
    head = head_of(asked.export(tmp_path / f"asked.{suffix}"))
    assert json.loads(head["hdrive_mbs.settings"]) == {"speeds": [0.0, 100.0]}
    other = dataclasses.replace(asked, settings={"speeds": np.array([0.0, 101.0])})
    assert head_of(other.export(tmp_path / f"other.{suffix}"))["hdrive_mbs.sha256"] != head["hdrive_mbs.sha256"]


@pytest.mark.parametrize("suffix", ["parquet", "h5", "mat", "csv"])
def test_our_own_reader_of_records_takes_what_was_exported(response: hm.Response, tmp_path: Path, suffix: str) -> None:
    for package in {"parquet": ["pyarrow"], "h5": ["h5py"]}.get(suffix, []):
        pytest.importorskip(package, reason=f"{package} comes with the records extra")
    file = response.export(tmp_path / f"run.{suffix}")
    name = "gear_torque" if suffix == "mat" else "gear.torque"  # MATLAB has no dots in names
    record = hm.read_record(file, time="time", channels=[name], refuse=False)
    assert record[name].unit == "N m"
    # CSV has 12 digits
    assert record.history(name).values == pytest.approx(response["gear.torque"].values, rel=1e-11 if suffix == "csv" else 0.0)


def test_hdf5_holds_texts_switches_and_missing_numbers(campaign: hm.Campaign, tmp_path: Path) -> None:
    h5py = pytest.importorskip("h5py", reason="h5py comes with the records extra")
    with h5py.File(campaign.export(tmp_path / "table.h5")) as file:
        assert list(file) == ["x", "kind", "even", "peak|mean", "job"]
        assert file["x"].attrs["unit"] == "m"
        assert file["peak|mean"].attrs["name"] == "peak/mean"
        assert list(file["kind"].asstr()[:]) == ["full", "merged"]
        assert np.array_equal(file["peak|mean"][:], [np.nan, 1.5], equal_nan=True)
        assert file.attrs["hdrive_mbs.status"] == "complete"


def test_matlab_holds_structures_with_values_unit_and_name(campaign: hm.Campaign, tmp_path: Path) -> None:
    found = loadmat(campaign.export(tmp_path / "table.mat"), squeeze_me=True, struct_as_record=False)
    assert found["hdrive_mbs"].result == "Campaign"
    assert list(found["kind"].values) == ["full", "merged"]
    assert found["x"].unit == "m"
    assert found["peak_mean"].name == "peak/mean"
    assert np.array_equal(found["peak_mean"].values, [np.nan, 1.5], equal_nan=True)


def test_parquet_holds_texts(campaign: hm.Campaign, tmp_path: Path) -> None:
    parquet = pytest.importorskip("pyarrow.parquet", reason="pyarrow comes with the records extra")
    table = parquet.read_table(campaign.export(tmp_path / "table.parquet"))
    assert table.column("kind").to_pylist() == ["full", "merged"]
    assert table.column("job").to_pylist() == ["done", "done"]


def test_csv_is_that_of_to_csv(campaign: hm.Campaign, tmp_path: Path) -> None:
    with campaign.export(tmp_path / "a.csv").open() as file:
        assert next(csv.reader(file)) == ["x [m]", "kind", "even", "peak/mean [1]", "job"]
    assert (tmp_path / "a.csv").read_bytes() == campaign.to_csv(tmp_path / "b.csv").read_bytes()


def test_names_are_unique_and_such_that_matlab_takes_them() -> None:
    found = identifiers(["a.b", "a b", "1st", "", "Ω", "n" * 90, "n" * 91, "hdrive_mbs"])
    assert found[:5] == ["a_b", "a_b_2", "x_1st", "column", "column_2"]
    assert len(set(found)) == 8
    assert all(name.isidentifier() and name.isascii() and len(name) <= LONGEST for name in found)
    assert "hdrive_mbs" not in found


def test_complex_columns_are_split_and_equal_names_keep_their_units() -> None:
    table = table_of({"a [m]": np.array([1 + 2j]), "b [m]": np.ones(1), "b [rad]": np.ones(1)}, {})
    assert [(column.name, column.unit) for column in table.columns] == [
        ("a real", "m"),
        ("a imaginary", "m"),
        ("b [m]", "m"),
        ("b [rad]", "rad"),
    ]
    assert table.columns[1].values == pytest.approx([2.0])


def test_other_suffixes_and_missing_packages_say_the_way_out(
    campaign: hm.Campaign, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with pytest.raises(FileFormatError, match=r"written as \.csv, \.parquet, .*\.mat"):
        campaign.export(tmp_path / "table.xlsx")
    monkeypatch.setitem(sys.modules, "h5py", None)
    with pytest.raises(DependencyError, match=r'needs h5py: python -m pip install "hdrive-mbs\[records\]"'):
        campaign.export(tmp_path / "table.h5")
    assert list(tmp_path.iterdir()) == []

"""``--export FILE`` of the commands: the table of the result, in the format of the ending."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

import hdrive_mbs as hm
from hdrive_mbs.cli.main import app
from hdrive_mbs.errors import DependencyError
from models import harmonic_drive_train, two_rotor_line
from tests.patience import PATIENCE

COMMANDS = [
    (harmonic_drive_train, ("modes", "--torque", "0")),
    (harmonic_drive_train, ("torsion", "--torques", "20,40")),
    (harmonic_drive_train, ("run", "--duration", "0.01")),
    (harmonic_drive_train, ("sweep", "--vary", "gear.ratio=80,100", "--workers", "1")),
    (two_rotor_line, ("modes", "--speed", "100")),
    (two_rotor_line, ("campbell", "--speeds", "0:200:3")),
    (two_rotor_line, ("unbalance", "--speeds", "100:200:3")),
    (two_rotor_line, ("run-up", "--duration", "0.02")),
]


@pytest.mark.slow
@pytest.mark.parametrize(("model", "words"), COMMANDS, ids=[f"{words[0]}_{model.__name__}" for model, words in COMMANDS])
def test_the_table_of_a_command_has_the_columns_and_the_checksum_of_its_saved_result(
    model: Any, words: tuple[str, ...], tmp_path: Path
) -> None:
    parquet = pytest.importorskip("pyarrow.parquet", reason="pyarrow comes with the records extra")
    table, plain, out = tmp_path / "table.parquet", tmp_path / "table.csv", tmp_path / "out"
    files = ("--export", str(table), "--export", str(plain), "--out", str(out))
    done = CliRunner().invoke(app, [words[0], str(model.__file__), *words[1:], *files], catch_exceptions=False)
    assert done.exit_code == 0, done.output
    (saved,) = (hm.load(path) for path in out.glob("*.npz"))
    assert parquet.read_schema(table).metadata[b"hdrive_mbs.sha256"].decode() == saved.checksum()
    read = parquet.read_table(table)
    real = [values for values in saved.columns().values() if values.dtype.kind == "f"]
    assert real, "a column of numbers is compared"
    written = [read.column(k).to_numpy() for k in range(read.num_columns)]
    for values in real:
        assert any(other.dtype == values.dtype and np.array_equal(other, values, equal_nan=True) for other in written)
    assert plain.read_bytes() == saved.to_csv(tmp_path / "own.csv").read_bytes()


@pytest.mark.parametrize("suffix", ["h5", "mat"])
def test_other_endings_are_other_formats(suffix: str, tmp_path: Path) -> None:
    if suffix == "h5":
        pytest.importorskip("h5py", reason="h5py comes with the records extra")
    file = tmp_path / f"curve.{suffix}"
    words = ["torsion", str(harmonic_drive_train.__file__), "--torques", "20,40", "--export", str(file)]
    assert CliRunner().invoke(app, words, catch_exceptions=False).exit_code == 0
    assert hm.read_record(file, time="1 Hz", channels=["torque"], refuse=False).history("torque").values.tolist() == [20.0, 40.0]


@pytest.mark.parametrize("command", ["modes", "torsion", "run", "sweep", "campbell", "unbalance", "run-up"])
def test_another_ending_is_refused_before_anything_else_is_looked_at(command: str, tmp_path: Path) -> None:
    words = [command, "no_such_scene.py", "--export", "table.xlsx", *(["--vary", "a=1,2"] if command == "sweep" else [])]
    code = "import sys; from hdrive_mbs.cli.main import main; main()"
    done = subprocess.run([sys.executable, "-c", code, *words], capture_output=True, text=True, timeout=PATIENCE, cwd=tmp_path)
    assert done.returncode == 2
    assert done.stderr == "error: table.xlsx: a table is written as .csv, .parquet, .pq, .h5, .hdf5, .mat.\n"


def test_a_missing_package_is_told_before_anything_else_is_looked_at(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    with pytest.raises(DependencyError, match="needs pyarrow"):
        CliRunner().invoke(app, ["run", "no_such_scene.py", "--export", "table.parquet"], catch_exceptions=False)


def test_stdout_is_json_alone_where_that_is_asked_for(tmp_path: Path) -> None:
    words = ["torsion", str(harmonic_drive_train.__file__), "--torques", "20,40", "--export", str(tmp_path / "t.csv"), "--json", "-"]
    done = CliRunner().invoke(app, words, catch_exceptions=False)
    assert json.loads(done.stdout)["torque"] == [20.0, 40.0]

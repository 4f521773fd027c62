"""Machine code that is kept between runs: the same, whole, this user's alone, and not without end."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from hdrive_mbs.compiled import kept_code as kept_code_
from hdrive_mbs.compiled import machine as machine_
from hdrive_mbs.compiled.kept_code import FOLDER, HASH, KeptCode, kept_code, key_of
from hdrive_mbs.compiled.line import CompiledLine
from hdrive_mbs.compiled.machine import machine
from models import drive_bench


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Code is kept there, and none of this process' is known."""
    monkeypatch.setenv(FOLDER, str(tmp_path / "cache"))
    kept_code.cache_clear()
    machine.cache_clear()
    yield tmp_path / "cache" / "machine_code"
    kept_code.cache_clear()
    machine.cache_clear()


def ran() -> np.ndarray:
    line = CompiledLine(drive_bench.build().network(), ["motor.speed"])
    return line.run(50, 1e-3, step=1e-4).values["motor.speed"]


def made(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Texts that are compiled from now on."""
    texts: list[str] = []
    llvm = machine_._llvm()
    parse = llvm.parse_assembly
    monkeypatch.setattr(llvm, "parse_assembly", lambda text: (texts.append(text), parse(text))[1])
    return texts


def test_code_is_made_once_and_then_taken_from_the_folder(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    texts = made(monkeypatch)
    first = ran()
    assert len(texts) == 1
    [file] = folder.iterdir()
    assert folder.stat().st_mode & 0o777 == 0o700
    machine.cache_clear()
    np.testing.assert_array_equal(ran(), first)
    assert len(texts) == 1
    assert [file] == list(folder.iterdir())


def test_a_damaged_file_is_made_anew(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    texts = made(monkeypatch)
    first = ran()
    [file] = folder.iterdir()
    whole = file.read_bytes()
    for damaged in (b"", whole[: len(whole) // 2], whole[:HASH] + b"\xff" + whole[HASH + 1 :]):
        file.write_bytes(damaged)
        machine.cache_clear()
        np.testing.assert_array_equal(ran(), first)
        assert file.read_bytes() == whole
    assert len(texts) == 4


def test_code_for_another_processor_is_not_taken() -> None:
    assert key_of(["define", "zen4"]) != key_of(["define", "zen5"])
    assert key_of(["ab", "c"]) != key_of(["a", "bc"])


@pytest.mark.skipif(os.name != "posix", reason="rights of files as POSIX has them")
def test_a_folder_that_others_may_write_to_is_not_used(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder.mkdir(parents=True)
    folder.chmod(0o777)
    texts = made(monkeypatch)
    first = ran()
    assert kept_code() is None
    assert not list(folder.iterdir())
    machine.cache_clear()
    np.testing.assert_array_equal(ran(), first)
    assert len(texts) == 2


def test_none_is_kept_where_that_is_asked_for_or_cannot_be(folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "file"
    file.write_text("in the way")
    for asked in ("", str(file)):
        monkeypatch.setenv(FOLDER, asked)
        kept_code.cache_clear()
        machine.cache_clear()
        assert kept_code() is None
        assert np.isfinite(ran()).all()
    assert not folder.exists()


def test_without_a_name_for_it_the_folder_is_the_user_s(tmp_path: Path) -> None:
    """As a fresh process finds it, on Linux by XDG_CACHE_HOME."""
    known = {name: value for name, value in os.environ.items() if name != FOLDER} | {"XDG_CACHE_HOME": str(tmp_path)}
    code = "from hdrive_mbs.compiled.kept_code import kept_code; print(kept_code().folder)"
    said = subprocess.run([sys.executable, "-c", code], env=known, capture_output=True, text=True, check=True).stdout.strip()
    assert Path(said).name == "machine_code"
    if sys.platform == "linux":
        assert Path(said) == tmp_path / "hdrive_mbs" / "machine_code"


def test_what_was_not_used_for_longest_is_removed_first(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(kept_code_, "MOST", 10 * (HASH + 100))
    monkeypatch.setattr(kept_code_, "BETWEEN", 1)
    store = KeptCode(tmp_path)
    for k in range(10):
        store.write(f"{k}", bytes(100))
        os.utime(tmp_path / f"{k}", (k, k))
    assert len(list(tmp_path.iterdir())) == 10
    assert store.read("0") == bytes(100)  # used now
    store.write("10", bytes(100))
    assert {path.name for path in tmp_path.iterdir()} == {"0", "5", "6", "7", "8", "9", "10"}  # three quarters of ten, at most
    assert store.read("1") is None


def test_a_folder_that_is_lost_while_it_is_used_stops_nothing(tmp_path: Path) -> None:
    """Its place taken by a file, it can be neither read, written nor counted."""
    store = KeptCode(tmp_path / "code")
    store.write("a", bytes(10))
    assert store.read("a") == bytes(10)
    (tmp_path / "code" / "a").unlink()
    (tmp_path / "code").rmdir()
    (tmp_path / "code").write_text("in the way")
    store.write("a", bytes(10))
    store._written = 0  # counts next
    store.write("a", bytes(10))
    assert store.read("a") is None

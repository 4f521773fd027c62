"""What stops a file from being written is told as what it is, and leaves nothing behind."""

from __future__ import annotations

import zipfile
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
import pytest

from hdrive_mbs.errors import FileFormatError
from hdrive_mbs.writing import write_whole


def test_ctrl_c_stays_ctrl_c_where_an_archive_cannot_close_after_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As numpy leaves an archive whose writing is interrupted: its clean-up raises that there is an open writing handle."""

    def stopped(self: zipfile.ZipFile, *given: Any, **options: Any) -> Any:
        self._writing = True  # type: ignore[attr-defined]
        raise KeyboardInterrupt

    old = tmp_path / "kept.npz"
    old.write_bytes(b"before")
    with monkeypatch.context() as patched:
        patched.setattr(zipfile.ZipFile, "open", stopped)
        with pytest.raises(KeyboardInterrupt) as caught:
            write_whole(old, lambda file: np.savez_compressed(file, values=np.ones(3)))
        assert "writing handle" in str(caught.value.__cause__)
        for frame in _frames(caught.value.__cause__):
            if isinstance(archive := frame.f_locals.get("zipf"), zipfile.ZipFile):
                archive._writing, archive._didModify = False, False  # type: ignore[attr-defined]  # closes without a word
    assert old.read_bytes() == b"before"
    assert list(tmp_path.iterdir()) == [old]


def _frames(error: BaseException | None) -> list[Any]:
    found, trace = [], None if error is None else error.__traceback__
    while trace is not None:
        found.append(trace.tb_frame)
        trace = trace.tb_next
    return found


def test_a_full_disk_after_ctrl_c_is_told_as_such(tmp_path: Path) -> None:
    def full(file: BinaryIO) -> None:
        raise OSError(28, "No space left on device")

    def stopped() -> None:
        try:
            raise KeyboardInterrupt
        except KeyboardInterrupt:  # what is finished is written still
            write_whole(tmp_path / "a.npz", full)

    with pytest.raises(FileFormatError, match="No space left"):
        stopped()
    assert list(tmp_path.iterdir()) == []


def test_an_error_of_its_own_goes_on_as_it_is(tmp_path: Path) -> None:
    def wrong(file: BinaryIO) -> None:
        raise ValueError("no such array")

    with pytest.raises(ValueError, match="no such array"):
        write_whole(tmp_path / "a.npz", wrong)
    assert list(tmp_path.iterdir()) == []

"""Files are written whole or not at all: to a temporary file beside the target, then renamed."""

from __future__ import annotations

import os
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import BinaryIO

from hdrive_mbs.errors import FileFormatError


def write_whole(path: str | os.PathLike[str], write: Callable[[BinaryIO], object]) -> Path:
    """Call ``write(file)`` on a temporary file in the target's folder and rename it to ``path``.

    Makes missing folders.  Raises FileFormatError when the folder cannot be written to; then an
    older file of that name is untouched.  Ctrl-C while it writes comes out as KeyboardInterrupt, whatever a library raises
    that was interrupted (numpy's archives cannot close then).
    """
    target = Path(path)
    before = sys.exception()
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        handle, temporary = tempfile.mkstemp(prefix=f".{target.name}.", suffix=".part", dir=target.parent)
    except OSError as error:
        raise FileFormatError(f"Cannot write {target}: {error.strerror or error}. Choose a folder that can be written to.") from error
    try:
        with os.fdopen(handle, "wb") as file:
            write(file)
        os.chmod(temporary, 0o666 & ~_umask())
        os.replace(temporary, target)
    except BaseException as error:
        Path(temporary).unlink(missing_ok=True)
        if not isinstance(error, KeyboardInterrupt) and _interrupted(error, before):
            raise KeyboardInterrupt from error
        if isinstance(error, OSError):
            raise FileFormatError(f"Cannot write {target}: {error.strerror or error}.") from error
        raise
    return target


def write_text(path: str | os.PathLike[str], text: str) -> Path:
    """Write a text file (UTF-8) whole or not at all."""
    return write_bytes(path, text.encode("utf-8"))


def write_bytes(path: str | os.PathLike[str], data: bytes) -> Path:
    """Write a file whole or not at all."""
    return write_whole(path, lambda file: file.write(data))


def _interrupted(error: BaseException, before: BaseException | None) -> bool:
    """Whether it was raised while an interrupt was handled that had not come ``before``."""
    found: BaseException | None = error
    while found is not None and found is not before:
        if isinstance(found, KeyboardInterrupt):
            return True
        found = found.__context__
    return False


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask

"""Machine code that was made before, on disk: a diagnosis compiles hundreds of structures, and the next one mostly the same.

It lies in the user's folder for such things, or where ``HDRIVE_MBS_CACHE`` says; with that set to nothing none is kept.  Each file is
named by the hash of what its code was made from and for, and begins with the hash of the code.  A folder that others may write to is
not used, for what lies there is run.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import stat
from collections.abc import Iterable
from functools import cache
from pathlib import Path

from hdrive_mbs.errors import FileFormatError
from hdrive_mbs.writing import write_bytes

FOLDER = "HDRIVE_MBS_CACHE"
"""Environment variable."""
MOST = 256_000_000
"""Bytes that are kept, whenever they are counted: of more the code that was not used for longest is removed, down to three quarters."""
BETWEEN = 200
"""Pieces of code that a process writes between two counts of what is kept."""
HASH = 32
"""Bytes of a hash."""


class KeptCode:
    """A folder of machine code."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._written = 0

    def read(self, key: str) -> bytes | None:
        """The code that was kept under a key; None where there is none, or it is damaged."""
        path = self.folder / key
        try:
            data = path.read_bytes()
            os.utime(path)  # used now
        except OSError:
            return None
        code = data[HASH:]
        return code if hashlib.sha256(code).digest() == data[:HASH] else None

    def write(self, key: str, code: bytes) -> None:
        """Keep a piece of code; where that cannot be done it is made anew another time."""
        with contextlib.suppress(FileFormatError, OSError):
            write_bytes(self.folder / key, hashlib.sha256(code).digest() + code)
            if self._written % BETWEEN == 0:
                self._remove_the_oldest()
            self._written += 1

    def _remove_the_oldest(self) -> None:
        found = []
        for path in self.folder.iterdir():
            with contextlib.suppress(OSError):  # another process may have removed it
                known = path.stat()
                found.append((known.st_mtime, known.st_size, path))
        kept = sum(size for _, size, _ in found)
        for _, size, path in sorted(found) if kept > MOST else ():
            if kept <= 0.75 * MOST:
                break
            path.unlink(missing_ok=True)
            kept -= size


def key_of(parts: Iterable[str]) -> str:
    """Name of what is made from and for some texts."""
    return hashlib.sha256("\0".join(parts).encode()).hexdigest()


@cache
def kept_code() -> KeptCode | None:
    """This user's; None where none is to be kept, or there is no folder that is this user's alone to write to."""
    asked = os.environ.get(FOLDER)
    if asked == "":
        return None
    try:
        folder = (Path(asked) if asked else _of_this_user()) / "machine_code"
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)
        known = folder.stat()
    except (OSError, RuntimeError):  # no home, or a place that cannot be written to
        return None
    shared = os.name == "posix" and (known.st_uid != os.getuid() or known.st_mode & (stat.S_IWGRP | stat.S_IWOTH))
    return None if shared or not os.access(folder, os.W_OK) else KeptCode(folder)


def _of_this_user() -> Path:
    import platformdirs

    return Path(platformdirs.user_cache_dir("hdrive_mbs"))

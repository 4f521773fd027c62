"""Readers that run in a process of their own.

The libraries for HDF5, MATLAB and MDF files are partly written in C and can crash on a damaged file, which
would end the user's session; they can also run for ever.  Here that ends a child process, and the user
gets an error.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from hdrive_mbs.errors import FileFormatError
from hdrive_mbs.memory_limit import largest

if TYPE_CHECKING:
    from hdrive_mbs.records.formats.file_format import Contents, Format, Wanted

TIME_LIMIT, RATE = 60.0, 1e6
"""Seconds for any file, and bytes a second more."""

SMALLEST_BOUND = 2**32
"""Bytes of address space that any reader may have: libraries and their threads claim some."""

_PROGRAM = "import sys; sys.path.insert(0, sys.argv[1]); from hdrive_mbs.records.formats.apart import main; main(*sys.argv[2:])"


def read_apart(file_format: Format, path: Path, wanted: Wanted) -> Contents:
    """What ``file_format.read(path, wanted)`` gives, read in a child process.

    Raises FileFormatError when the reader refuses the file, crashes or takes too long.
    """
    from hdrive_mbs.records.formats.file_format import Column, Contents

    root = str(Path(__file__).resolve().parents[3])
    limit = TIME_LIMIT + path.stat().st_size / RATE
    with tempfile.TemporaryDirectory(prefix="hdrive_mbs_") as folder:
        target = Path(folder) / "columns.npz"
        command = [sys.executable, "-P", "-c", _PROGRAM, root, file_format.name, str(path), json.dumps(wanted.patterns), str(target)]
        try:
            done = subprocess.run(command, capture_output=True, stdin=subprocess.DEVNULL, timeout=limit, check=False)
        except subprocess.TimeoutExpired:
            raise FileFormatError(
                f"{path}: reading it as {file_format.name} took longer than {limit:.0f} s; the file seems damaged."
            ) from None
        if done.returncode or not target.exists():
            end = f"signal {-done.returncode}" if done.returncode < 0 else f"status {done.returncode}"
            said = done.stderr.decode("utf-8", "replace").strip().splitlines()[-1:] if done.returncode > 0 else []
            raise FileFormatError(
                f"{path} is no readable {file_format.name} file, or it is damaged: "
                f"its reader ended with {end}{f' ({said[0][:200]})' if said else ''}."
            )
        with np.load(target, allow_pickle=False) as archive:
            head = json.loads(bytes(archive["head"]).decode())
            if "error" in head:
                raise FileFormatError(head["error"])
            columns = tuple(
                Column(
                    name=item["name"], unit=item["unit"], values=archive[f"values_{index}"], group=tuple(item["group"]), clock=item["clock"]
                )
                for index, item in enumerate(head["columns"])
            )
    return Contents(columns=columns, skipped=head["skipped"], notes=tuple(head["notes"]))


def main(name: str, path: str, patterns: str, target: str) -> None:
    """The child: read the file and write its columns, or the reason why not."""
    from hdrive_mbs.records.formats.file_format import Wanted, formats

    _bound_memory()
    file_format = next(item for item in formats() if item.name == name)
    chosen = json.loads(patterns)
    head: dict[str, Any]
    try:
        contents = file_format.read(Path(path), Wanted(None if chosen is None else tuple(chosen)))
    except FileFormatError as error:
        _write(target, {"error": str(error)}, {})
        return
    except MemoryError:
        _write(target, {"error": f"{path} unfolds to more than half of this machine's memory; it seems damaged."}, {})
        return
    kept = ("name", "unit", "group", "clock")
    head = {
        "columns": [{key: getattr(column, key) for key in kept} for column in contents.columns],
        "skipped": dict(contents.skipped),
        "notes": list(contents.notes),
    }
    _write(target, head, {f"values_{index}": np.asarray(column.values) for index, column in enumerate(contents.columns)})


def _bound_memory() -> None:
    """Let a file that unfolds to more than the memory fail here, and not the user's other programs."""
    try:
        import resource
    except ImportError:
        return
    bound = max(largest(), SMALLEST_BOUND)
    resource.setrlimit(resource.RLIMIT_AS, (bound, bound))


def _write(target: str, head: dict[str, Any], arrays: dict[str, np.ndarray]) -> None:
    packed = np.frombuffer(json.dumps(head).encode(), dtype=np.uint8)
    partial = f"{target}.part"
    with open(partial, "wb") as file:
        np.savez(file, head=packed, **arrays)  # type: ignore[arg-type]
    Path(partial).rename(target)

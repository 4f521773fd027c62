"""One case of many: the records of a folder diagnosed in a worker, with its report as files."""

from __future__ import annotations

import contextlib
import hashlib
import importlib
import math
import sys
import tempfile
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from hdrive_mbs.cli.diagnose import measured_in, open_bench, tried, write_answer
from hdrive_mbs.errors import FileFormatError, HdriveError
from hdrive_mbs.scene import Scene

if TYPE_CHECKING:
    from hdrive_mbs.diagnosis.result import Diagnosis
    from hdrive_mbs.effects.effect import Effect


@dataclass(frozen=True, kw_only=True)
class GivenFile:
    """A Python file that each worker opens under the same path, and the hash of its name and text."""

    path: str
    sha256: str

    @classmethod
    def of(cls, path: Path) -> GivenFile:
        """The file as it is now.  Raises FileFormatError for one that cannot be read."""
        return cls(path=str(path.resolve()), sha256=content_hash([path]))

    def opened(self) -> Path:
        """Its path, once it is known that the text is the same here.  Raises FileFormatError where it is not."""
        path = Path(self.path)
        if content_hash([path]) != self.sha256:
            raise FileFormatError(f"{path} differs on this machine from the caller's; copy it there, or share the folder.")
        # a worker of a cluster outlives the text of a file, and meets files of one name from several campaigns
        before = str(getattr(sys.modules.get(path.stem), "__file__", None))
        if before in _OPENED and (before, _OPENED[before]) != (self.path, self.sha256):
            del sys.modules[path.stem]
        _OPENED[self.path] = self.sha256
        folder = str(path.parent)
        sys.path[:] = [folder, *(item for item in sys.path if item != folder)]
        importlib.invalidate_caches()
        return path


_OPENED: dict[str, str] = {}
"""Files that this process has imported, and of which text."""


@dataclass(frozen=True, kw_only=True)
class CaseDiagnosis:
    """Diagnoses the records under the path ``records`` of a point; gives figures and the files of the report.

    bench : a .py file, or the scene of a scene file;  effects : files with effects of the user's own
    only : classes or families of effects that are tried; all if empty
    reading : how records are read;  program : hash of the program, so that another one makes another job
    work : folder in which fits are kept while a case is not finished; not used by a worker that does not see it
    every : of so many samples the search compares one
    search_seconds : after which the search of a case looks for no more [s]
    """

    bench: GivenFile | Scene
    effects: tuple[GivenFile, ...]
    only: tuple[str, ...] = ()
    reading: Mapping[str, Any]
    program: str
    work: str
    every: int | None = None
    search_seconds: float | None = None

    def __call__(self, point: Mapping[str, Any]) -> dict[str, Any]:
        from hdrive_mbs.records.reading import record_files

        files = record_files(Path(str(point["records"])))
        if content_hash(files) != point["sha256"]:
            raise FileFormatError(f"{point['records']}: the records differ on this machine from the caller's, or have changed since.")
        own = [item.opened() for item in self.effects]
        bench = open_bench(self.bench.opened(), own) if isinstance(self.bench, GivenFile) else self.bench
        kinds = tried(own, self.only)  # once the bench's file is read, whose own effects count too
        measured = measured_in(files, self.reading, bench)
        from hdrive_mbs.diagnosis.diagnose import diagnose as run

        kept = Path(self.work) / str(point["case"]) if Path(self.work).is_dir() else None
        found = _living(kinds)
        result = run(bench, measured, candidates=found, workers=1, folder=kept, every=self.every, search_seconds=self.search_seconds)
        return {**figures(result), "report": report_files(result)}

    def made_of(self) -> tuple[Scene, dict[str, Any]]:
        """The nominal scene, and the files with their digests and how records are read; the records are in the points."""
        settings = {
            "effects": tuple({"file": item.path, "digest": item.sha256} for item in self.effects),
            "only": self.only,
            "reading": dict(self.reading),
            "program": self.program,
            "every": self.every,
            "search_seconds": self.search_seconds,
        }
        if isinstance(self.bench, Scene):
            return self.bench, settings
        bench = open_bench(Path(self.bench.path))
        scene = bench if isinstance(bench, Scene) else bench.scene
        return scene, {"bench": {"file": self.bench.path, "digest": self.bench.sha256}, **settings}


def figures(result: Diagnosis) -> dict[str, Any]:
    """The answer as one line of a table."""
    first = result.causes[0] if result.causes else None
    second = result.causes[1] if len(result.causes) > 1 else None
    found: dict[str, Any] = {
        "verdict": result.verdict,
        "effect": "" if first is None else first.effect,
        "at": "" if first is None else first.at,
        "probability": math.nan if first is None else first.probability,
        "second effect": "" if second is None else second.effect,
        "second at": "" if second is None else second.at,
        "not told apart from": "; ".join(f"{effect} at {at}" for effect, at in result.indistinguishable),
    }
    if result.gaps:
        found |= {"gap closed": result.closed, "closed by refit": result.closed_by_refit}
    return found | {"time [s]": result.seconds}


def report_files(result: Diagnosis) -> dict[str, Any]:
    """Every file that ``hdrive-mbs diagnose`` writes, by name, as bytes."""
    with tempfile.TemporaryDirectory(prefix="hdrive_mbs_") as folder:
        with contextlib.redirect_stderr(sys.stdout):
            write_answer(result, Path(folder), stays=False)
        written = (path for path in sorted(Path(folder).rglob("*")) if path.is_file())
        return {path.relative_to(folder).as_posix(): np.frombuffer(path.read_bytes(), dtype=np.uint8) for path in written}


def content_hash(files: Iterable[Path]) -> str:
    """Hash of names and contents.  Raises FileFormatError for one that cannot be read."""
    digest = hashlib.sha256()
    for path in files:
        digest.update(f"{path.name}\n".encode())
        try:
            with path.open("rb") as file:
                digest.update(hashlib.file_digest(file, "sha256").digest())
        except OSError as error:
            raise FileFormatError(f"{path}: cannot be read here ({error.strerror or error}).") from error
    return digest.hexdigest()


def _living(kinds: Iterable[type[Effect]] | None) -> list[type[Effect]]:
    """Effects to try, without what a worker has left from a file's earlier text or from another campaign."""
    from hdrive_mbs.diagnosis.candidates import known_effects

    def stands(kind: type[Effect]) -> bool:
        return getattr(sys.modules.get(kind.__module__), kind.__name__, None) is kind

    return [kind for kind in (known_effects() if kinds is None else kinds) if stands(kind)]


def cases_in(paths: Iterable[Path]) -> dict[str, Path]:
    """Name of each case -> folder or file of its records.

    A file is a case, and so is a folder with record files; of a folder without any each of its folders that has some is
    a case.  Raises FileFormatError where nothing is found.
    """
    found: list[Path] = []
    for path in paths:
        if not path.exists():
            raise FileFormatError(f"{path}: no such file or folder. Give folders with measured records with --records.")
        here = [path] if _has_records(path) else [item for item in sorted(path.iterdir()) if item.is_dir() and _has_records(item)]
        if not here:
            raise FileFormatError(f"{path} holds no measured records, and none of its folders does.")
        found += [item.resolve() for item in here]
    return _names(list(dict.fromkeys(found)))


def _has_records(path: Path) -> bool:
    from hdrive_mbs.records.reading import record_files

    try:
        return bool(record_files(path))
    except HdriveError:
        return False


def _names(paths: list[Path]) -> dict[str, Path]:
    """Names as short as tells them apart: the last part of the path, or the last two, ..."""
    most = max(len(path.parts) for path in paths)
    for depth in range(1, most):
        names = ["_".join((*path.parts[-depth:-1], path.stem if path.is_file() else path.name)) for path in paths]
        if len(set(names)) == len(names):
            return dict(zip(names, paths, strict=True))
    return {str(number): path for number, path in enumerate(paths)}

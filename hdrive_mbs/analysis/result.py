"""What every result offers: status, settings, versions, save and load, CSV."""

from __future__ import annotations

import csv
import dataclasses
import functools
import hashlib
import inspect
import io
import json
import os
import platform
import warnings
import zipfile
from collections.abc import Mapping
from dataclasses import dataclass, field
from importlib import metadata
from pathlib import Path
from typing import Any, BinaryIO, Self

import numpy as np

from hdrive_mbs.errors import FileFormatError, HdriveError
from hdrive_mbs.export.formats import write_table, writer_for
from hdrive_mbs.export.table import table_of
from hdrive_mbs.memory_limit import check_claim
from hdrive_mbs.printed_table import PrintedTable
from hdrive_mbs.scene import Scene
from hdrive_mbs.scene_file import scene_from_dict, scene_to_dict
from hdrive_mbs.writing import write_text, write_whole

FORMAT = "hdrive-mbs result 1"


def versions() -> dict[str, str]:
    """Versions of what computes: this package, exudyn, numpy, scipy, Python."""
    return dict(_versions())


@functools.cache
def _versions() -> Mapping[str, str]:
    found = {"python": platform.python_version()}
    for name in ("hdrive-mbs", "exudyn", "numpy", "scipy"):
        try:
            found[name] = metadata.version(name)
        except metadata.PackageNotFoundError:
            found[name] = "unknown"
    return found


@dataclass(frozen=True, kw_only=True, eq=False)
class Result:
    """Base of all results.  Fields are arrays, numbers, texts, and mappings or tuples of these.

    scene : the scene that was analysed (None for a loaded file whose scene holds Python functions)
    status : "complete", or what is missing and what to do
    settings : what the analysis was asked for
    versions : of the packages that computed it
    """

    scene: Scene | None
    status: str
    settings: Mapping[str, Any]
    versions: Mapping[str, str] = field(default_factory=versions)

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        if "__repr__" not in vars(cls):  # else dataclass makes one with all the numbers in it
            cls.__repr__ = Result.__repr__  # type: ignore[method-assign]

    def __repr__(self) -> str:
        """Name, scene and status; ``print`` shows the figures."""
        return f"{self._head()} (print it to see its figures)"

    def __str__(self) -> str:
        """Name, scene, status, and the tables of this result; without any a line on each field, the own ones first."""
        tables = self.tables()
        if tables:
            return "\n".join([self._head(), *map(str, tables)])
        shown = [item.name for item in dataclasses.fields(self) if item.name not in ("scene", "status", "settings", "versions")]
        own = inspect.get_annotations(type(self))
        shown.sort(key=lambda name: name not in own)
        width = max(map(len, shown), default=0)
        return "\n".join([self._head(), *(f"  {name:<{width}}  {_in_short(getattr(self, name))}" for name in shown)])

    def _head(self) -> str:
        of = f" of {self.scene.name!r}" if self.scene is not None else ""
        return f"{type(self).__name__}{of}: {self.status}"

    def tables(self) -> tuple[PrintedTable, ...]:
        """Its figures with their units, as print() shows them and the command line draws them; none for most results."""
        return ()

    def made_from(self) -> dict[str, Any]:
        """Where the numbers come from, as plain data: kind of result, status, settings, versions, and the scene.

        The scene is what ``scene_from_dict`` takes, and as a .json file ``load_scene``; None where it holds Python
        functions.
        """
        return {
            "result": type(self).__name__,
            "status": self.status,
            "settings": _readable(self.settings),
            "versions": dict(self.versions),
            "scene": _packed_scene(self.scene)[0],
        }

    def columns(self) -> dict[str, np.ndarray]:
        """Equally long columns for CSV, headed ``name [unit]``."""
        raise NotImplementedError(f"{type(self).__name__} has no table.")

    def to_csv(self, path: str | os.PathLike[str]) -> Path:
        """Write the columns as CSV (comma, point, one header line with units)."""
        return write_csv(path, self.columns())

    def export(self, path: str | os.PathLike[str]) -> Path:
        """Write the columns for other programs: .csv, .parquet, .h5 (HDF5) or .mat (MATLAB), by the suffix.

        Units, ``made_from`` and ``checksum`` go with them (into CSV the units alone).  Parquet and HDF5 need
        ``hdrive-mbs[records]``.  Only ``save`` keeps everything and can be loaded again.

        Raises FileFormatError for another suffix and DependencyError when a package for it is missing.
        """
        if Path(path).suffix.lower() == ".csv":
            return self.to_csv(path)
        origin = self.made_from()
        head = {
            "result": origin["result"],
            "status": origin["status"],
            "settings": json.dumps(origin["settings"]),
            "versions": json.dumps(origin["versions"]),
            "scene": json.dumps(origin["scene"]) if origin["scene"] is not None else _packed_scene(self.scene)[1],
            "sha256": self.checksum(),
        }
        return write_table(path, table_of(self.columns(), head))

    def checksum(self) -> str:
        """SHA-256 over everything that ``save`` writes; it stands in the saved file, and in an exported one that is of the same result."""
        checksum: str = self._saved_form()[0]["sha256"]
        return checksum

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Write the whole result to one file (numpy archive with a JSON head and a checksum)."""
        document, arrays = self._saved_form()
        packed = np.frombuffer(json.dumps(document).encode(), dtype=np.uint8)

        def write(file: BinaryIO) -> None:
            np.savez_compressed(file, head=packed, **arrays)  # type: ignore[arg-type]

        return write_whole(path, write)

    def _saved_form(self) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
        """Head with checksum, and arrays, of the saved file."""
        arrays: dict[str, np.ndarray] = {}
        fields = {item.name: getattr(self, item.name) for item in dataclasses.fields(self) if item.name != "scene"}
        head = {name: _pack(value, name, arrays) for name, value in fields.items()}
        scene, problem = _packed_scene(self.scene)
        document = {
            "format": FORMAT,
            "result": type(self).__name__,
            "fields": head,
            "scene": scene,
            "scene_problem": problem,
        }
        return {**document, "sha256": _checksum(document, arrays)}, arrays

    @classmethod
    def load(cls, path: str | os.PathLike[str], *, verify: bool = True) -> Self:
        """Read a result of this type.  Raises FileFormatError for a truncated, changed or foreign file; see ``load``."""
        result = load(path, verify=verify)
        if not isinstance(result, cls):
            raise FileFormatError(f"{path} holds a {type(result).__name__}, not a {cls.__name__}.")
        return result


def check_export(path: str | os.PathLike[str]) -> None:
    """Raise what ``export`` to this file would raise for its suffix or a missing package, before there is a result."""
    if Path(path).suffix.lower() != ".csv":
        writer_for(path)


def write_csv(path: str | os.PathLike[str], columns: Mapping[str, np.ndarray]) -> Path:
    """Write equally long columns as CSV (comma, point, one header line)."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(columns)
    for row in zip(*columns.values(), strict=True):
        writer.writerow([f"{value:.12g}" if isinstance(value, (float, np.floating)) else value for value in row])
    return write_text(path, text.getvalue())


def load(path: str | os.PathLike[str], *, verify: bool = True) -> Result:
    """Read any saved result.

    verify : refuse a file whose checksum does not fit its content; False reads it with a warning

    Raises FileFormatError when the file is missing, truncated, changed, too large for the memory, or not a result of
    ours.  Warns and leaves ``scene`` None when only the scene cannot be made again (it names a class of a
    user's own that is not imported).  No code is executed from the file.
    """
    document, arrays = _content(path)
    found = document.get("format")
    if found != FORMAT:
        newer = " A newer version of hdrive_mbs wrote it; update this one." if str(found).startswith(FORMAT[:-1]) else ""
        raise FileFormatError(f"{path} is not in the format {FORMAT!r} (found {found!r}).{newer}")
    told = document.pop("sha256", None)
    try:
        right = _checksum(document, arrays)
    except RecursionError as error:
        raise FileFormatError(f"{path} is not a result of hdrive_mbs: its head is nested too deep.") from error
    if told != right:
        said = f"{path}: the checksum does not fit; the file was changed or damaged"
        if verify:
            raise FileFormatError(f"{said}. Take another copy, or read it as it is with load(path, verify=False).")
        warnings.warn(f"{said}, and is read as it is.", stacklevel=2)
    try:
        return _rebuilt(path, document, arrays)
    except HdriveError:
        raise
    except Exception as error:  # the checksum is no secret: whatever may stand there
        raise FileFormatError(f"{path} does not hold what a result of hdrive_mbs holds ({type(error).__name__}: {error}).") from error


def _content(path: str | os.PathLike[str]) -> tuple[dict[str, Any], dict[str, np.ndarray]]:
    """Head and arrays of a file.  Raises FileFormatError for one that is no archive of these."""
    if Path(path).exists() and not Path(path).is_file():
        raise FileFormatError(f"{path} is no file with a result.")
    try:
        with zipfile.ZipFile(path) as archive:
            check_claim(path, sum(item.file_size for item in archive.infolist()))
        with np.load(Path(path), allow_pickle=False) as numbers:
            arrays = {name: numbers[name] for name in numbers.files}
        document = json.loads(bytes(arrays.pop("head")).decode())
        if not isinstance(document, dict) or not all(isinstance(item, np.ndarray) for item in arrays.values()):
            raise ValueError("its head is no table, or a member is no array")
    except FileNotFoundError:
        raise FileFormatError(f"{path}: no such file.") from None
    except FileFormatError:
        raise
    except Exception as error:  # zip, zlib, numpy and json each raise their own kinds for a damaged file
        raise FileFormatError(f"{path} is not a result of hdrive_mbs, or it is truncated ({error}).") from error
    return document, arrays


def _rebuilt(path: str | os.PathLike[str], document: Mapping[str, Any], arrays: Mapping[str, np.ndarray]) -> Result:
    kind = _kind(document["result"])
    if kind is None:
        raise FileFormatError(f"{path} holds a {document['result']!r}, which this version does not know.")
    values = {name: _unpack(value, arrays) for name, value in document["fields"].items()}
    fields = {item.name: item for item in dataclasses.fields(kind) if item.name != "scene"}
    unset = dataclasses.MISSING
    needed = {name for name, item in fields.items() if item.default is unset and item.default_factory is unset}
    if not needed <= set(values) <= set(fields):
        odd = sorted((needed - set(values)) | (set(values) - set(fields)))
        raise FileFormatError(f"{path}: the fields of a {kind.__name__} have changed with the version ({', '.join(odd)}).")
    return kind(scene=_unpacked_scene(document["scene"], path), **values)


def _in_short(value: Any) -> str:
    """A field in one line of at most about 100 characters."""
    if isinstance(value, np.ndarray):
        if value.size <= 6:
            return " ".join(np.array2string(value, precision=6).split())
        size = " x ".join(map(str, value.shape))
        if np.iscomplexobj(value) or not np.issubdtype(value.dtype, np.number) or not np.any(np.isfinite(value)):
            return f"{size} values"
        finite = value[np.isfinite(value)]
        return f"{size} values, {finite.min():.6g} to {finite.max():.6g}"
    if isinstance(value, Mapping):
        words = [f"{key} {item:.6g}" if isinstance(item, (float, np.floating)) else str(key) for key, item in value.items()]
        return _cut(", ".join(words) or "none", len(words))
    if isinstance(value, (tuple, list)):
        return _cut(", ".join(f"{item:.6g}" if isinstance(item, float) else str(item) for item in value) or "none", len(value))
    return f"{value:.6g}" if isinstance(value, (float, np.floating)) else str(value)


def _cut(text: str, count: int) -> str:
    return text if len(text) <= 90 else f"{text[:80].rpartition(', ')[0]}, ... ({count} in all)"


def _unpacked_scene(document: dict[str, Any] | None, path: str | os.PathLike[str]) -> Scene | None:
    if document is None:
        return None
    try:
        return scene_from_dict(document)
    except (HdriveError, RecursionError) as error:
        warnings.warn(f"{path}: the numbers are complete, but the scene cannot be made again ({error}).", stacklevel=4)
        return None


def _kind(name: str) -> type[Result] | None:
    """The result type of that name, also one of a package above this one that ``hdrive_mbs`` offers."""
    import hdrive_mbs

    kinds = {kind.__name__: kind for kind in _subclasses(Result)}
    offered = getattr(hdrive_mbs, name) if name not in kinds and name in hdrive_mbs.__all__ else None
    return offered if isinstance(offered, type) and issubclass(offered, Result) else kinds.get(name)


@functools.cache
def _import_analyses() -> None:
    import importlib
    import pkgutil

    from hdrive_mbs import analysis

    for module in pkgutil.walk_packages(analysis.__path__, "hdrive_mbs.analysis."):
        importlib.import_module(module.name)


def _subclasses(kind: type[Result]) -> list[type[Result]]:
    _import_analyses()
    found: list[type[Result]] = []
    stack = [kind]
    while stack:
        for child in stack.pop().__subclasses__():
            found.append(child)
            stack.append(child)
    return found


def _packed_scene(scene: Scene | None) -> tuple[dict[str, Any] | None, str]:
    if scene is None:
        return None, "no scene"
    try:
        return scene_to_dict(scene), ""
    except FileFormatError as error:
        return None, str(error)


def _readable(value: Any) -> Any:
    """Settings as plain data for a reader: arrays as lists, other objects as text."""
    if isinstance(value, Mapping):
        return {str(key): _readable(item) for key, item in value.items()}
    if isinstance(value, np.ndarray):
        return _readable(value.tolist())
    if isinstance(value, (tuple, list)):
        return [_readable(item) for item in value]
    if isinstance(value, np.generic):
        return value.item()
    return value if value is None or isinstance(value, (str, int, float, bool)) else str(value)


def _checksum(document: Mapping[str, Any], arrays: Mapping[str, np.ndarray]) -> str:
    digest = hashlib.sha256(json.dumps(document).encode())
    for name in sorted(arrays):
        digest.update(name.encode())
        digest.update(f"{arrays[name].dtype} {arrays[name].shape}".encode())
        digest.update(np.ascontiguousarray(arrays[name]).tobytes())
    return digest.hexdigest()


def _pack(value: Any, path: str, arrays: dict[str, np.ndarray]) -> Any:
    if isinstance(value, np.ndarray):
        if value.dtype == object:
            raise TypeError(f"{path}: an array of Python objects cannot be saved; results hold arrays of numbers.")
        arrays[path] = value
        return {"array": path}
    if isinstance(value, Mapping):
        return {"map": [[key, _pack(item, f"{path}/{key}", arrays)] for key, item in value.items()]}
    if isinstance(value, (tuple, list)):
        return {"tuple": [_pack(item, f"{path}/{index}", arrays) for index, item in enumerate(value)]}
    if isinstance(value, (np.integer, np.floating, np.bool_)):
        return value.item()
    if value is None or isinstance(value, (str, int, float, bool)):
        return value
    return str(value)


def _unpack(value: Any, arrays: Mapping[str, np.ndarray]) -> Any:
    if not isinstance(value, dict):
        return value
    if "array" in value:
        return arrays[value["array"]]
    if "map" in value:
        return {key: _unpack(item, arrays) for key, item in value["map"]}
    return tuple(_unpack(item, arrays) for item in value["tuple"])

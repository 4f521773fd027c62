"""The answer as JSON, for programs: SI units, frequencies in rad/s, null for what is not a finite number."""

from __future__ import annotations

import dataclasses
import hashlib
import json
import math
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from hdrive_mbs.diagnosis import sentences
from hdrive_mbs.diagnosis.result import VERDICTS, Diagnosis
from hdrive_mbs.documents import document_text
from hdrive_mbs.errors import FileFormatError
from hdrive_mbs.scene import Scene
from hdrive_mbs.scene_file import scene_to_dict
from hdrive_mbs.writing import write_text

SCHEMA = "hdrive-mbs diagnosis"
VERSION = 1
"""Rises when a key goes or changes its meaning; new keys leave it."""
SERIES = ("traces", "forces", "loops", "order_maps")
"""Fields that hold long arrays."""
LARGEST = 2**27
"""Bytes of a report that is read: 160 traces of full length have as many; a report without series has less than 2**20."""


def report_document(diagnosis: Diagnosis, *, series: bool = False) -> dict[str, Any]:
    """The answer as plain data: dicts, lists, texts, finite numbers, None.

    series : with the curves of the pictures too
    """
    document: dict[str, Any] = {
        "schema": SCHEMA,
        "schema_version": VERSION,
        "units": "SI; speeds and frequencies in rad/s",
        "scene": diagnosis.scene.name,
        "records": list(diagnosis.records),
        "files": diagnosis.files,
        "settings": diagnosis.settings,
        "verdict": diagnosis.verdict,
        "verdict_text": VERDICTS.get(diagnosis.verdict, diagnosis.verdict),
        "summary": sentences.verdict(diagnosis),
        "causes": diagnosis.causes,
        "indistinguishable": [{"effect": effect, "at": at} for effect, at in diagnosis.indistinguishable],
        "ranking": diagnosis.ranking,
        "where": diagnosis.where,
        "gaps": [{**_plain(gap), "in_unit": _in_unit(gap)} for gap in diagnosis.gaps],
        "closed": diagnosis.closed if diagnosis.gaps else None,
        "closed_by_refit": diagnosis.closed_by_refit if diagnosis.gaps else None,
        "parameters": [{**_plain(item), "moved_sigmas": sentences.moved(item)} for item in diagnosis.parameters],
        "domain": diagnosis.domain,
        "next_records": [
            {
                "record": item.record,
                "first": {"effect": item.first[0], "at": item.first[1]},
                "second": {"effect": item.second[0], "at": item.second[1]},
                "detectability": item.detectability,
                "enough": sentences.SEPARABLE,
            }
            for item in diagnosis.next_records
        ],
        "warnings": diagnosis.warnings,
        "notes": diagnosis.notes,
        "inputs": diagnosis.inputs,
        "nominal_scene": _scene(diagnosis.scene),
        "improved_scene": _scene(diagnosis.improved),
        "seconds": diagnosis.seconds,
        "versions": diagnosis.versions,
    }
    if series:
        document |= {name: getattr(diagnosis, name) for name in SERIES}
    plain = _plain(document)
    assert isinstance(plain, dict)
    return {**plain, "sha256": _checksum(plain)}


def write_report_json(diagnosis: Diagnosis, path: str | os.PathLike[str], *, series: bool = False) -> Path:
    """Write it, whole or not at all."""
    return write_text(path, json.dumps(report_document(diagnosis, series=series), indent=2, allow_nan=False) + "\n")


def read_report_json(path: str | os.PathLike[str], *, verify: bool = True) -> dict[str, Any]:
    """The data of a written report; null is None.

    verify : refuse a file whose checksum is not that of its content

    Raises FileFormatError for a file that cannot be read, is no regular file, has more than 128 MiB, is no such report, is of a
    later schema, or was changed.
    """
    text = document_text(Path(path), LARGEST)
    try:
        document = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise FileFormatError(f"{path} cannot be parsed: {error}.") from error
    if not isinstance(document, dict) or document.get("schema") != SCHEMA:
        raise FileFormatError(f"{path} is no report of a diagnosis: 'schema' must be {SCHEMA!r}.")
    version = document.get("schema_version")
    if not isinstance(version, int) or isinstance(version, bool) or version > VERSION:
        raise FileFormatError(f"{path} has schema_version {version!r}; this package reads up to {VERSION}. Install a later hdrive-mbs.")
    if verify and "sha256" in document and not _is_whole(document):
        raise FileFormatError(
            f"{path}: the checksum does not fit; the file was changed or damaged."
            " Take another copy, or read it as it is with read_report_json(path, verify=False)."
        )
    return document


def _is_whole(document: Mapping[str, Any]) -> bool:
    """Whether the checksum is that of the content; never where that is too deep, or holds numbers too large, to have been written."""
    try:
        return bool(document["sha256"] == _checksum(document))
    except (OverflowError, RecursionError):
        return False


def _checksum(document: Mapping[str, Any]) -> str:
    """Of everything but the checksum itself, whatever the order of the keys and whether whole numbers are written with a point."""
    rest = {key: _same_numbers(value) for key, value in document.items() if key != "sha256"}
    return hashlib.sha256(json.dumps(rest, sort_keys=True).encode()).hexdigest()


def _same_numbers(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _same_numbers(item) for key, item in value.items()}
    if isinstance(value, list):
        return [_same_numbers(item) for item in value]
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return float(value) + 0.0  # no -0.0
    return value


def _in_unit(gap: Any) -> dict[str, Any]:
    """Root mean squares in the column's unit; nothing for all columns together, which have no common unit."""
    if not gap.column:
        return {}
    steps = {name: getattr(gap, name) for name in ("nominal", "refit", "effect")}
    scaled = {name: {key: gap.noise * value for key, value in dataclasses.asdict(item).items()} for name, item in steps.items()}
    return {"unit": gap.unit, **scaled, "floor": gap.noise * gap.floor}


def _scene(scene: Scene) -> dict[str, Any] | None:
    try:
        return scene_to_dict(scene)
    except FileFormatError:
        return None  # it holds Python functions; the scene itself is diagnosis.improved


def _plain(value: Any) -> Any:
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        return {item.name: _plain(getattr(value, item.name)) for item in dataclasses.fields(value)}
    if isinstance(value, Mapping):
        return {str(key): _plain(item) for key, item in value.items()}
    if isinstance(value, np.ndarray):
        return _plain(value.tolist())
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    if isinstance(value, (bool, np.bool_)):
        return bool(value)
    if isinstance(value, np.integer):
        return int(value)
    if isinstance(value, (float, np.floating)):
        return float(value) if math.isfinite(value) else None
    return value

"""What is to be known of the improved scene before it is run: whose inputs it holds, and which files its classes are from."""

from __future__ import annotations

import itertools
import os
import re
import shlex
import sys
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

import hdrive_mbs
from hdrive_mbs.diagnosis.readable import listed
from hdrive_mbs.diagnosis.result import Diagnosis, Driven
from hdrive_mbs.quantities import Described
from hdrive_mbs.scene import Scene

FOLDER = "improved"
"""Folder beside improved.toml with a scene for each record."""
HEAD = "The improved scene with the inputs of record"
"""Begins each of these files."""


def improved_words(diagnosis: Diagnosis, folder: Path | None = None) -> tuple[str, ...]:
    """Sentences for the report and the head of the scene file; none where the scene can be run as it is.

    folder : of the scene file, from which own files are named; their names alone if not given
    """
    found = []
    if diagnosis.inputs:
        driven = listed([f"{path} (driven by column {column!r})" for column, path in diagnosis.inputs.items()])
        found.append(
            f"The improved scene holds {driven} as the bench file has {'it' if len(diagnosis.inputs) == 1 else 'them'}, not as in a record:"
            " where that is zero, 'hdrive-mbs run improved.toml' gives zeros."
        )
    if diagnosis.driven:
        found.append(
            f"The improved scene with the inputs of each record is diagnosis.driven in Python; 'hdrive-mbs diagnose' writes it as"
            f" {FOLDER}/RECORD.toml, the command that runs it at the head of the file."
        )
    files = own_files(diagnosis.improved, folder)
    if files:
        options = " ".join(f"--effects {shlex.quote(file)}" for file in files)
        found.append(f"The improved scene has classes of your own: hdrive-mbs run improved.toml {options}")
    return tuple(found)


def file_names(driven: Sequence[Driven]) -> tuple[str, ...]:
    """Names of the scene files of records, no two alike."""
    found: list[str] = []
    for item in driven:
        stem = re.sub(r"\W+", "_", item.record).strip("_") or "record"
        names = itertools.chain([stem], (f"{stem}_{k}" for k in itertools.count(2)))
        found.append(next(name for name in names if name.casefold() not in {other.casefold() for other in found}))
    return tuple(f"{name}.toml" for name in found)


def driven_words(item: Driven, file: str, folder: Path | None = None) -> tuple[str, ...]:
    """Head of the scene file of a record: how it is run in its own folder, which own files are named from if it is given."""
    starts = "".join(f" --initial {name}={value!r}" for name, value in item.initial.items())
    effects = "".join(f" --effects {shlex.quote(name)}" for name in own_files(item.scene, folder))
    return (
        f"{HEAD} {item.record!r}. In the folder of this file:",
        f"hdrive-mbs run {file} --duration {item.duration!r}{starts}{effects}",
    )


def own_files(scene: Scene, folder: Path | None = None) -> tuple[str, ...]:
    """Files that define effects, laws or parts of the scene and are not of the library: their names, or their paths from a folder."""
    modules = [type(item).__module__ for item in _all_of((*scene.parts.values(), *(placed.effect for placed in scene.effects)))]
    own = [name for name in dict.fromkeys(modules) if name.partition(".")[0] != hdrive_mbs.__name__]
    return tuple(_from(folder, getattr(sys.modules.get(name), "__file__", None) or f"{name}.py") for name in own)


def _from(folder: Path | None, file: str) -> str:
    if folder is None or not Path(file).is_absolute():
        return Path(file).name
    try:
        return Path(os.path.relpath(file, folder.resolve())).as_posix()
    except ValueError:  # on another drive
        return Path(file).as_posix()


def _all_of(items: Iterable[object]) -> Iterator[Described]:
    """The described objects among these, and those in them."""
    for item in items:
        if isinstance(item, Described):
            yield item
            yield from _all_of(value for _, value, _ in item.fields())
        elif isinstance(item, tuple):
            yield from _all_of(item)

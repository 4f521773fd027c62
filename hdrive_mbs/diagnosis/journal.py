"""Finished work of a diagnosis on disk, so that an interrupted one goes on from there.

Every answer (a look at a candidate, a fit) is one file, written whole or not at all when it comes in: numbers as numpy
arrays, the rest as JSON, nothing pickled.  It lies in a folder named by the hash of the scene, its knowledge, records,
candidates and this program, under the hash of the task; other inputs lead to another folder.
"""

from __future__ import annotations

import contextlib
import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from hdrive_mbs.diagnosis.answer_text import as_plain, from_plain
from hdrive_mbs.diagnosis.digest import digest, program
from hdrive_mbs.diagnosis.screening import Screen
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.errors import FileFormatError
from hdrive_mbs.writing import write_text, write_whole

INPUTS, TEXT = "inputs.json", "json"
"""File that says what a folder's answers are about, and the member of an answer's file that is no array."""


class Journal:
    """A folder of answers for one set of inputs.

    inputs : what the answers depend on, by a name in words;  program is added

    taken : number of answers from an earlier run
    """

    def __init__(self, folder: str | Path, inputs: Mapping[str, Any]) -> None:
        parts = {name: digest(value) for name, value in inputs.items()} | {"program": program()}
        top = Path(folder)
        if top.exists() and not top.is_dir():
            raise FileFormatError(f"{top} is a file; folder= must be a folder in which finished work can be kept.")
        self.folder = top / digest(sorted(parts.items()))[:20]
        self.taken = 0
        self._own: set[str] = set()
        self.notes = _notes(top, self.folder, parts)
        if not (self.folder / INPUTS).is_file():
            write_text(self.folder / INPUTS, json.dumps(parts, indent=2) + "\n")

    def identity(self, shared: Any) -> str:
        """What tasks share: of records and their models what makes them differ within one diagnosis."""
        if isinstance(shared, Simulator):
            unseen = sorted((name, tuple(sorted(trials))) for name, trials in shared.unseen.items())
            return digest("simulator", shared.steps, shared.every, len(shared.slowed), unseen)
        if isinstance(shared, Screen):
            return digest("screen", self.identity(shared.simulator), shared.null.hypothesis, shared.null.z)
        if isinstance(shared, tuple):
            return digest("together", *(self.identity(item) for item in shared))
        return digest(shared)

    def key(self, function: Callable[..., Any], shared: str, item: Any) -> str:
        """Name of an answer."""
        return digest(function.__qualname__, shared, item)[:32]

    def read(self, key: str, item: Any) -> tuple[Any] | None:
        """The answer, in a tuple; None where there is none, or its file cannot be read.

        item : what was asked, which holds all classes that the answer may be made of
        """
        try:
            with np.load(self._path(key), allow_pickle=False) as file:
                text = json.loads(file[TEXT].tobytes().decode())
                arrays = {name: file[name] for name in file.files if name != TEXT}
            answer = from_plain(text, arrays, item)
        except Exception:  # zip, zlib, numpy and json each raise their own kinds for a damaged file
            return None
        self.taken += key not in self._own
        return (answer,)

    def write(self, key: str, answer: Any) -> None:
        """Keep an answer; one that is not made of plain data is not kept, and is worked out again."""
        with contextlib.suppress(TypeError):
            arrays: dict[str, Any] = {}
            text = json.dumps(as_plain(answer, arrays)).encode()
            arrays[TEXT] = np.frombuffer(text, dtype=np.uint8)
            write_whole(self._path(key), lambda file: np.savez(file, allow_pickle=False, **arrays))
            self._own.add(key)

    def _path(self, key: str) -> Path:
        return self.folder / f"{key}.npz"

    @property
    def said(self) -> tuple[str, ...]:
        """What a reader of the answer has to know."""
        taken = f"{self.taken} of {self.taken + len(self._own)} looks and fits were taken from {self.folder}."
        return (*self.notes, taken) if self.taken else self.notes


def _notes(top: Path, own: Path, parts: Mapping[str, str]) -> tuple[str, ...]:
    """Says so where the folder holds work on other inputs and none on these."""
    if (own / INPUTS).is_file():
        return ()
    nearest: list[str] | None = None
    for file in sorted(top.glob(f"*/{INPUTS}")):
        try:
            known = json.loads(file.read_text("utf-8"))
            differ = [name for name in parts if known.get(name) != parts[name]]
        except (OSError, ValueError, AttributeError, RecursionError):
            continue
        if nearest is None or len(differ) < len(nearest):
            nearest = differ
    if nearest is None:
        return ()
    return (f"{top} holds work on other inputs ({', '.join(nearest)} differ): this diagnosis was begun anew.",)

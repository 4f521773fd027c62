"""Sealed labels: a hash of each truth lies beside the cases, the truths lie elsewhere until the answers are in.

commitment = SHA-256(salt + text of truth.json), hexadecimal, with a random salt of 32 hexadecimal digits a case.
"""

from __future__ import annotations

import hashlib
import json
import secrets
import zipfile
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

COMMITMENTS = "commitments.json"


class SealError(Exception):
    """A truth does not belong to its commitment, or it is too early to open it."""


@dataclass(frozen=True)
class Sealed:
    """The text of one truth with its salt."""

    salt: str
    text: str

    @property
    def commitment(self) -> str:
        return hashlib.sha256((self.salt + self.text).encode()).hexdigest()


def seal(labels: Mapping[str, Any]) -> Sealed:
    """Salt a truth."""
    return Sealed(secrets.token_hex(16), truth_text(labels))


def truth_text(labels: Mapping[str, Any]) -> str:
    """The text of truth.json that the hash counts."""
    return json.dumps(labels, indent=1, allow_nan=False)


def write_commitments(folder: Path, sealed: Mapping[str, Sealed]) -> Path:
    """{case: hash} beside the cases."""
    path = folder / COMMITMENTS
    path.write_text(json.dumps({case: item.commitment for case, item in sorted(sealed.items())}, indent=1) + "\n", encoding="utf-8")
    return path


def write_key(path: Path, sealed: Mapping[str, Sealed], about: Mapping[str, Any]) -> Path:
    """Salts and truths in one compressed archive, away from the cases."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with zipfile.ZipFile(path, "x", compression=zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("about.json", json.dumps(dict(about), indent=1))
        archive.writestr("key.json", json.dumps({case: {"salt": item.salt, "text": item.text} for case, item in sealed.items()}))
    return path


def open_key(path: Path, commitments: Path, *, answered: Iterable[str]) -> dict[str, dict[str, Any]]:
    """{case: labels}, each proven by its hash; every committed case must have been answered before."""
    committed = json.loads(commitments.read_text(encoding="utf-8"))
    missing = sorted(set(committed) - set(answered))
    if missing:
        raise SealError(
            f"{len(missing)} of {len(committed)} cases have no answer yet ({', '.join(missing[:3])}); answer all of them first."
        )
    with zipfile.ZipFile(path) as archive:
        key = json.loads(archive.read("key.json"))
    labels = {}
    for case, commitment in committed.items():
        if case not in key:
            raise SealError(f"{path.name} has no truth for case {case}; it belongs to another set.")
        item = Sealed(key[case]["salt"], key[case]["text"])
        if item.commitment != commitment:
            raise SealError(
                f"The truth of case {case} in {path.name} does not belong to its commitment; the key or the commitments were changed."
            )
        labels[case] = json.loads(item.text)
    return labels


def read_about(path: Path) -> dict[str, Any]:
    """How the set of a key was made: bench, number of cases, seed, noise; for after the labels were opened."""
    with zipfile.ZipFile(path) as archive:
        about: dict[str, Any] = json.loads(archive.read("about.json"))
    return about

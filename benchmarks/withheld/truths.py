"""Opened truths of a set."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any


def read_truths(path: Path) -> dict[str, dict[str, Any]]:
    """Labels by case, of a file as open_labels writes it, or of a folder with CASE/truth.json."""
    if path.is_dir():
        found = {file.parent.name: json.loads(file.read_text(encoding="utf-8")) for file in sorted(path.glob("*/truth.json"))}
        if not found:
            raise ValueError(f"{path} has no CASE/truth.json; open the labels first (benchmarks.withheld.open_labels).")
        return found
    labels: dict[str, dict[str, Any]] = json.loads(path.read_text(encoding="utf-8"))
    return labels

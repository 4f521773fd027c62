"""Where the measurements lie: beside the checkout, never in it."""

from __future__ import annotations

from pathlib import Path

REAL = Path(__file__).resolve().parents[3] / "shared" / "real"
"""Measurements of others with their sources and licences (README.txt in each folder)."""


def missing(name: str) -> str | None:
    """Why the measurements of that name cannot be used; None where they can."""
    folder = REAL / name
    return None if folder.is_dir() else f"no folder shared/real/{name} beside this checkout"

"""Which state of this repository a benchmark ran."""

from __future__ import annotations

import subprocess
from collections.abc import Sequence
from pathlib import Path

SOURCES = ("hdrive_mbs", "models", "benchmarks/*.py")
"""What results depend on."""


def commit(sources: Sequence[str] = SOURCES) -> str:
    """Its commit, marked where sources differ from it; "unknown" outside of a repository."""
    home = Path(__file__).parents[1]
    try:
        found = subprocess.run(["git", "rev-parse", "HEAD"], cwd=home, capture_output=True, text=True, check=True).stdout.strip()
        status = ["git", "status", "--porcelain", "--", *sources]
        changed = subprocess.run(status, cwd=home, capture_output=True, text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return "unknown"
    return f"{found} with changes" if changed else found

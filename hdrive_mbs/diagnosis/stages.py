"""What a diagnosis says of how far it is."""

from __future__ import annotations

from collections.abc import Callable

Report = Callable[[str, int, int], None]
"""Told of a stage, how much of it is done and how much there is."""


def under(said: Report, about: str, stage: str, done: int, total: int) -> None:
    """Say it of a stage that is a part of something."""
    said(f"{about}: {stage}", done, total)

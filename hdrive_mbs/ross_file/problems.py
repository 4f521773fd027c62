"""What of a ROSS rotor has no counterpart here, collected by name, so that one look tells all."""

from __future__ import annotations

from collections.abc import Sequence
from fnmatch import fnmatchcase
from pathlib import Path

from hdrive_mbs.errors import FileFormatError


class Problems:
    """Collects what does not map: ``told`` is what the caller has agreed to leave out."""

    def __init__(self, leave_out: Sequence[str]) -> None:
        self._patterns = tuple(leave_out)
        self._open: list[str] = []
        self.told: list[str] = []

    def add(self, name: str, reason: str) -> None:
        """Note that ``name`` (an element, or element.field) does not map."""
        agreed = any(fnmatchcase(name, pattern) for pattern in self._patterns)
        (self.told if agreed else self._open).append(f"{name}: {reason}")

    @property
    def is_open(self) -> bool:
        """Whether something was not agreed to."""
        return bool(self._open)

    def check(self, path: Path) -> None:
        """Raise FileFormatError when something was not agreed to."""
        if not self.is_open:
            return
        listed = "".join(f"\n  {line}" for line in self._open[:30]) + ("\n  ..." if len(self._open) > 30 else "")
        first = self._open[0].partition(":")[0]
        raise FileFormatError(
            f"{path}: {len(self._open)} of this rotor do not map to a scene:{listed}\nChange the rotor in ROSS, or agree to go without "
            f"them: leave_out=[{first!r}, ...], where * stands for any text."
        )

"""Work that a team begins now and is asked for later."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any


@dataclass(eq=False)
class Later:
    """Work that goes on beside other work: what was asked, and what has come of it.

    state : "waiting" (nobody is at it), "begun", "good" or "failed" (``answer`` is the error)
    file : what a process reads of ``shared``
    """

    function: Any
    shared: Any
    item: Any
    state: str = "waiting"
    answer: Any = None
    file: Path | None = None

    def came(self, good: bool, answer: Any) -> None:
        self.state, self.answer = "good" if good else "failed", answer

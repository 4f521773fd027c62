"""A process of one's own that stays warm: what it has loaded serves every question that it is asked."""

from __future__ import annotations

import contextlib
import json
import os
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

ROOT = Path(__file__).parents[1]


@dataclass(frozen=True)
class Warm:
    """A module that answers each line of JSON on its standard input with one."""

    process: subprocess.Popen[str]

    @classmethod
    @contextlib.contextmanager
    def of(cls, module: str, *words: str) -> Iterator[Self]:
        """Begin it with these arguments; it ends with the context."""
        environment = {**os.environ, "PYTHONPATH": str(ROOT)}
        command = [sys.executable, "-m", module, *words]
        with subprocess.Popen(command, env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
            try:
                yield cls(process)
            finally:
                process.kill()

    def ask(self, question: object) -> Any:
        """Its answer."""
        assert self.process.stdin is not None
        assert self.process.stdout is not None
        print(json.dumps(question), file=self.process.stdin, flush=True)
        line = self.process.stdout.readline()
        assert line, f"the warm process ended at {question!r}"
        return json.loads(line)

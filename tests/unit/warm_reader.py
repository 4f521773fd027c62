"""The process of a reader, warmed up once and forked for each file: dozens of damaged files take as long as three cold ones."""

from __future__ import annotations

import contextlib
import importlib
import json
import os
import resource
import signal
import subprocess
import sys
import tempfile
import traceback
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[2]
SECONDS = 5
"""Of processor time, after which a reader hangs, surely: each takes less than one."""


@dataclass(frozen=True)
class WarmReader:
    """Stands in for ``subprocess.run`` where a reader's process is started."""

    process: subprocess.Popen[str]

    @classmethod
    @contextlib.contextmanager
    def start(cls, packages: Sequence[str]) -> Iterator[WarmReader]:
        """A reader that has these packages loaded."""
        command = [sys.executable, "-m", "tests.unit.warm_reader", *packages]
        environment = {**os.environ, "PYTHONPATH": str(ROOT)}
        with subprocess.Popen(command, env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
            try:
                yield cls(process)
            finally:
                process.kill()

    def run(self, command: Sequence[str], **options: Any) -> subprocess.CompletedProcess[bytes]:
        """What ``main`` of the reader gives for the last words of a command."""
        assert self.process.stdin is not None
        assert self.process.stdout is not None
        print(json.dumps(command[-4:]), file=self.process.stdin, flush=True)
        code, said = json.loads(self.process.stdout.readline())
        if code == -signal.SIGXCPU:
            raise subprocess.TimeoutExpired(command, SECONDS)
        return subprocess.CompletedProcess(command, code, stdout=b"", stderr=said.encode())


def main(packages: Sequence[str]) -> None:
    """Fork for each line of arguments, and say how that process ended."""
    from hdrive_mbs.records.formats import apart, file_format

    file_format.formats()
    for name in ("scipy.io", "scipy.io.matlab", *packages):
        importlib.import_module(name)
    answers = os.fdopen(os.dup(1), "w")
    for line in sys.stdin:
        with tempfile.TemporaryFile() as said:
            child = os.fork()
            if child == 0:
                os.dup2(said.fileno(), 1)
                os.dup2(said.fileno(), 2)
                resource.setrlimit(resource.RLIMIT_CPU, (SECONDS, SECONDS + 1))
                code = 1
                try:
                    apart.main(*json.loads(line))
                    code = 0
                except BaseException:
                    traceback.print_exc()
                finally:
                    sys.stderr.flush()
                    os._exit(code)
            ended = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
            said.seek(0)
            print(json.dumps([ended, said.read().decode("utf-8", "replace")]), file=answers, flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])

"""The process of a reader, warmed up once and forked for each file: dozens of damaged files take as long as three cold ones."""

from __future__ import annotations

import importlib
import json
import os
import resource
import signal
import subprocess
import sys
import tempfile
import traceback
from collections.abc import Sequence
from contextlib import AbstractContextManager
from typing import Any, Self

from tests.warm import Warm

SECONDS = 5
"""Of processor time, after which a reader hangs, surely: each takes less than one."""


class WarmReader(Warm):
    """Stands in for ``subprocess.run`` where a reader's process is started."""

    @classmethod
    def start(cls, packages: Sequence[str]) -> AbstractContextManager[Self]:
        """A reader that has these packages loaded."""
        return cls.of("tests.unit.warm_reader", *packages)

    def run(self, command: Sequence[str], **options: Any) -> subprocess.CompletedProcess[bytes]:
        """What ``main`` of the reader gives for the last words of a command."""
        code, said = self.ask(command[-4:])
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

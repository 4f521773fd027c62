"""A process that has the package loaded and forks for each script: its imports take longer than most examples.

Each script still has a process of its own, with ``__main__``, arguments, folder and standard streams of its own.
"""

from __future__ import annotations

import json
import os
import runpy
import signal
import subprocess
import sys
import time
import traceback
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Self

from tests.warm import Warm

LOADED = (
    "hdrive_mbs",
    "hdrive_mbs.diagnosis.diagnose",
    "hdrive_mbs.engine.assembly",
    "hdrive_mbs.plots",
    "scipy.interpolate",
    "scipy.optimize",
)
POLL = 0.02


class WarmProcess(Warm):
    """Runs scripts."""

    @classmethod
    def start(cls) -> AbstractContextManager[Self]:
        """A process that has the package loaded."""
        return cls.of("tests.examples.warm_process")

    def run(self, script: Path, timeout: float) -> subprocess.CompletedProcess[str]:
        """A script, run in its own folder.  Raises subprocess.TimeoutExpired."""
        code, out, err = self.ask([str(script), timeout])
        if code == -signal.SIGKILL:
            raise subprocess.TimeoutExpired(str(script), timeout, out, err)
        return subprocess.CompletedProcess([str(script)], code, out, err)


def _run(script: Path) -> int:
    """In the forked process."""
    sys.argv = [str(script)]
    sys.path[0] = str(script.parent)
    os.chdir(script.parent)
    try:
        runpy.run_path(str(script), run_name="__main__")
    except SystemExit as ended:
        return ended.code if isinstance(ended.code, int) else int(ended.code is not None)
    except BaseException:
        traceback.print_exc()
        return 1
    return 0


def _forked(script: Path, out: Path, err: Path, timeout: float) -> int:
    """Exit code, negative for the signal that ended it."""
    child = os.fork()
    if child == 0:
        code = 1
        try:
            os.setpgid(0, 0)
            for path, number in ((out, 1), (err, 2)):
                os.dup2(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_TRUNC), number)
            code = _run(script)
            sys.stdout.flush()
            sys.stderr.flush()
        finally:
            os._exit(code)
    end = time.monotonic() + timeout
    while time.monotonic() < end:
        done, status = os.waitpid(child, os.WNOHANG)
        if done:
            return os.waitstatus_to_exitcode(status)
        time.sleep(POLL)
    os.killpg(child, signal.SIGKILL)
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])


def main() -> None:
    """Fork for each line of standard input, and say how that process ended and what it printed."""
    for name in LOADED:
        __import__(name)
    answers = os.fdopen(os.dup(1), "w")
    for line in sys.stdin:
        name, timeout = json.loads(line)
        script = Path(name)
        out, err = script.with_suffix(".out"), script.with_suffix(".err")
        code = _forked(script, out, err, timeout)
        said = [path.read_text("utf-8", "replace") for path in (out, err)]
        print(json.dumps([code, *said]), file=answers, flush=True)


if __name__ == "__main__":
    main()

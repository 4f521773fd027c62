"""A process that has the package loaded and forks for each script: its imports take longer than most examples.

Each script still has a process of its own, with ``__main__``, arguments, folder and standard streams of its own.
"""

from __future__ import annotations

import contextlib
import json
import os
import runpy
import signal
import subprocess
import sys
import time
import traceback
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]
LOADED = (
    "hdrive_mbs",
    "hdrive_mbs.diagnosis.diagnose",
    "hdrive_mbs.engine.assembly",
    "hdrive_mbs.plots",
    "scipy.interpolate",
    "scipy.optimize",
)
POLL = 0.02


@dataclass(frozen=True)
class WarmProcess:
    """Runs scripts."""

    process: subprocess.Popen[str]

    @classmethod
    @contextlib.contextmanager
    def start(cls) -> Iterator[WarmProcess]:
        """A process that has the package loaded."""
        environment = {**os.environ, "PYTHONPATH": str(ROOT)}
        command = [sys.executable, "-m", "tests.examples.warm_process"]
        with subprocess.Popen(command, env=environment, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
            try:
                yield cls(process)
            finally:
                process.kill()

    def run(self, script: Path, timeout: float) -> subprocess.CompletedProcess[str]:
        """A script, run in its own folder.  Raises subprocess.TimeoutExpired."""
        assert self.process.stdin is not None
        assert self.process.stdout is not None
        print(json.dumps([str(script), timeout]), file=self.process.stdin, flush=True)
        line = self.process.stdout.readline()
        assert line, f"the process that runs scripts ended at {script}"
        code, out, err = json.loads(line)
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

"""Answers every case of a set: ``python -m benchmarks.withheld.run --bench drive --cases FOLDER --out answers.json``.

Answers are written as they come, whole or not at all, so an interrupted run goes on where it stopped; existing answers
are kept unless --again is given.  A case that fails is answered "unknown" with the error, and the others go on.  Beside
answers.json lie answers.raw/CASE.json with the figures of all fits, and answers.about.json with method and versions.
"""

from __future__ import annotations

import argparse
import json
import os
import pickle
import sys
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

for _name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_name, "1")  # before numpy is loaded

from benchmarks.commit import commit  # noqa: E402
from benchmarks.machine import machine  # noqa: E402
from benchmarks.withheld.answer import failed_answer  # noqa: E402
from benchmarks.withheld.methods import METHODS, method  # noqa: E402
from hdrive_mbs.campaign.dask_cluster import packed, run_on_cluster  # noqa: E402
from hdrive_mbs.campaign.in_this_process import run_here  # noqa: E402
from hdrive_mbs.campaign.local_processes import run_on_processes  # noqa: E402
from hdrive_mbs.campaign.outcome import Outcome  # noqa: E402
from hdrive_mbs.diagnosis import verdict  # noqa: E402
from hdrive_mbs.errors import DependencyError, SimulationError  # noqa: E402
from hdrive_mbs.writing import write_text  # noqa: E402

SOURCES = ("hdrive_mbs", "models", "benchmarks/withheld/*.py")
"""What answers depend on."""
RETRIES = 1
"""How often a case is begun again whose process was lost (out of memory, say)."""


@dataclass(frozen=True)
class Job:
    """Answers one case by a method; its point holds the folder of the case.

    more : what the method asks for besides, (name, path);  each : processes for the diagnosis of one case
    search_seconds : after which the search looks for no more
    """

    bench: str
    method: str
    more: tuple[tuple[str, str], ...] = ()
    each: int = 1
    search_seconds: float | None = None

    def __call__(self, point: Mapping[str, Any]) -> dict[str, str]:
        more: dict[str, Any] = {name: Path(path) for name, path in self.more}
        if self.each > 1:
            more["workers"] = self.each
        if self.search_seconds is not None:
            more["search_seconds"] = self.search_seconds
        solved = method(self.method)(self.bench, Path(point["folder"]), **more)
        return {"answer": _text(solved.answer), "raw": _text(solved.raw)}


def main(arguments: Sequence[str] | None = None) -> int:
    """Run; returns 0, or 1 when a case failed."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.withheld.run", description="Answers withheld cases.")
    parser.add_argument("--bench", choices=("drive", "rotor"), required=True)
    parser.add_argument("--cases", type=Path, required=True, help="folder with one folder a case; those of this bench are taken")
    parser.add_argument("--out", type=Path, required=True, help="answers.json, written as answers come")
    parser.add_argument("--only", default="", help="names of cases, with commas between them")
    parser.add_argument("--workers", type=int, default=1, help="cases side by side, a process each (default 1); 0: in this process")
    parser.add_argument("--each", type=int, default=1, help="processes for one case (default 1), with --workers 0 and --method full")
    parser.add_argument(
        "--scheduler",
        metavar="ADDRESS",
        help="use the dask cluster of this scheduler, like tcp://host:8786; its workers see the same folders and have this on PYTHONPATH",
    )
    parser.add_argument("--method", choices=tuple(METHODS), default="full", help="the diagnosis, or a baseline")
    parser.add_argument("--search-seconds", type=float, metavar="S", help="look for no more after these, with --method full")
    parser.add_argument("--raw", type=Path, help="raw figures of the diagnosis, for --method training")
    parser.add_argument("--truths", type=Path, help="opened truths, for --method oracle")
    again = parser.add_mutually_exclusive_group()
    again.add_argument("--again", action="store_true", help="answer anew what is answered already")
    again.add_argument("--failed", action="store_true", help="answer anew what failed")
    options = parser.parse_args(arguments)
    wanted = [name for name in options.only.split(",") if name]
    try:
        cases = cases_of(options.cases, options.bench, wanted)
    except ValueError as error:
        parser.error(str(error))
    if options.workers < 0:
        parser.error("--workers must be at least 0")
    if options.each < 1 or (options.each > 1 and (options.workers or options.scheduler or options.method != "full")):
        parser.error("--each is at least 1, and more than that goes with --workers 0 and --method full alone")
    if options.search_seconds is not None and options.method != "full":
        parser.error("--search-seconds goes with --method full alone")
    for name, reader in (("raw", "training"), ("truths", "oracle")):
        if getattr(options, name) and options.method != reader:
            parser.error(f"--{name} goes with --method {reader} alone")
    more = tuple((name, str(path)) for name in ("raw", "truths") if (path := getattr(options, name)))
    return answer_cases(
        Job(options.bench, options.method, more, options.each, options.search_seconds),
        cases,
        options.out,
        workers=options.workers,
        scheduler=options.scheduler,
        again=lambda answer: options.again or (options.failed and "error" in answer),
    )


def cases_of(folder: Path, bench: str, wanted: Sequence[str] = ()) -> dict[str, Path]:
    """Folders with records, by name.  Raises ValueError where one that is wanted is missing, or there is none."""
    found = {path.name: path for path in sorted(folder.glob(f"{bench}-*")) if any(path.glob("*.parquet"))}
    missing = [name for name in wanted if name not in found]
    if missing or not found:
        raise ValueError(f"{folder} has no case {missing[0] if missing else f'{bench}-*'} with Parquet records.")
    return {name: path for name, path in found.items() if not wanted or name in wanted}


def answer_cases(
    job: Job,
    cases: Mapping[str, Path],
    out: Path,
    *,
    workers: int,
    scheduler: str | None = None,
    again: Callable[[Mapping[str, Any]], bool] = lambda answer: False,
) -> int:
    """Answer cases into a file; returns 0, or 1 when one failed or the cluster was lost.

    workers : processes; 0 for this process alone;  scheduler : address of a dask scheduler, whose workers are used instead
    again : says of an answer that is there already whether it is made anew
    """
    answers = read_answers(out)
    points = {name: {"folder": str(path.resolve())} for name, path in cases.items() if name not in answers or again(answers[name])}
    kept = len(cases) - len(points)
    print(f"{len(cases)} cases, {kept} answered already", file=sys.stderr)
    write_text(out.with_suffix(".about.json"), json.dumps(about(job), indent=1) + "\n")
    start, failed = time.monotonic(), 0
    try:
        for done, (name, outcome) in enumerate(_outcomes(job, points, workers, scheduler), start=1):
            answers[name] = _answer(name, outcome, out)
            failed += "error" in answers[name]
            write_answers(out, answers)
            _tell(name, answers[name], done, len(points), start)
    except KeyboardInterrupt:
        print(f"stopped; the same command goes on from {out}", file=sys.stderr)
        return 130
    except (SimulationError, DependencyError) as error:
        print(f"error: {error}\nwhat is answered is kept; the same command goes on from {out}", file=sys.stderr)
        return 1
    return 1 if failed else 0


def _outcomes(job: Job, points: Mapping[str, Mapping[str, Any]], workers: int, scheduler: str | None) -> Iterator[tuple[str, Outcome]]:
    """Name and outcome of each case, as they come."""
    if not points:
        return iter(())
    if scheduler is not None:
        return run_on_cluster(scheduler, packed(job), points, retries=RETRIES)
    return run_on_processes(pickle.dumps(job), points, workers=workers, retries=RETRIES) if workers else run_here(job, points)


def _answer(name: str, outcome: Outcome, out: Path) -> dict[str, Any]:
    raw = out.with_suffix(".raw") / f"{name}.json"
    if outcome.values is None:
        write_text(raw, json.dumps({"case": name, "error": outcome.error, "traceback": outcome.traceback}, indent=1) + "\n")
        return failed_answer(name, outcome.error, outcome.seconds)
    write_text(raw, str(outcome.values["raw"]) + "\n")
    answer: dict[str, Any] = json.loads(str(outcome.values["answer"]))
    return answer


def read_answers(path: Path) -> dict[str, dict[str, Any]]:
    """Answers by case; empty where there is no file yet."""
    if not path.exists():
        return {}
    return {answer["case"]: answer for answer in json.loads(path.read_text(encoding="utf-8"))}


def write_answers(path: Path, answers: Mapping[str, Mapping[str, Any]]) -> Path:
    """Write them, by name of the case, whole or not at all."""
    return write_text(path, json.dumps([answers[name] for name in sorted(answers)], indent=1, allow_nan=False) + "\n")


def about(job: Job) -> dict[str, Any]:
    """Method, constants of the verdict, commit and machine."""
    constants = {name: value for name, value in vars(verdict).items() if name.isupper() and isinstance(value, float)}
    found: dict[str, Any] = {"bench": job.bench, "method": job.method, "processes_each": job.each}
    found |= {} if job.search_seconds is None else {"search_seconds": job.search_seconds}
    return {**found, "commit": commit(SOURCES), "verdict": constants, "machine": machine()}


def _tell(name: str, answer: Mapping[str, Any], done: int, of: int, start: float) -> None:
    said = answer.get("error") or " + ".join(f"{item['effect']} at {item['at']}" for item in answer["effects"])
    left = (time.monotonic() - start) * (of - done) / done
    line = f"{done}/{of} {name}: {answer['verdict']} {said} ({answer['seconds'] or 0.0:.0f} s), {left:.0f} s left"
    print(line, file=sys.stderr, flush=True)


def _text(value: Any) -> str:
    return json.dumps(_finite(value), allow_nan=False)


def _finite(value: Any) -> Any:
    """The same with null for what is not finite."""
    if isinstance(value, Mapping):
        return {str(key): _finite(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_finite(item) for item in value]
    if isinstance(value, float) and value - value != 0.0:
        return None
    return value


if __name__ == "__main__":
    sys.exit(main())

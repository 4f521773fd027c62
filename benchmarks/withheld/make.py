"""Makes withheld cases: ``python -m benchmarks.withheld.make --bench drive --cases 60 --seed 7 --out FOLDER``.

Sealed by default: FOLDER holds the records and the commitments, FOLDER.key.zip (or --key) the truths.
With --open each case folder holds its truth.json: for practice, training and calibration, never for a result.
"""

from __future__ import annotations

import argparse
import os
import secrets
import sys
import time
from collections.abc import Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before numpy is loaded

import numpy as np

from benchmarks.withheld import sealing
from benchmarks.withheld.bench import BENCHES, load
from benchmarks.withheld.folder import write_case
from benchmarks.withheld.mixture import ONLY, SHARES, Site, mixture, singles


def main(arguments: Sequence[str] | None = None) -> int:
    """Make a set; returns 0."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.withheld.make", description="Makes withheld cases of a bench.")
    parser.add_argument("--bench", choices=BENCHES, required=True)
    parser.add_argument("--cases", type=int, default=60, help="number of cases (default 60)")
    parser.add_argument("--seed", type=int, help="without it one is drawn and goes into the key only")
    parser.add_argument("--out", type=Path, required=True, help="new folder for the cases")
    parser.add_argument("--key", type=Path, help="archive for the truths; default: OUT.key.zip beside OUT")
    parser.add_argument("--open", action="store_true", help="truth.json in each case folder, nothing sealed")
    held = parser.add_mutually_exclusive_group()
    held.add_argument("--causes", help="names of causes, separated by commas: one of these in every case; for open sets")
    held.add_argument("--nulls", action="store_true", help="nothing planted in any case: for the rate of false alarms")
    held.add_argument("--pairs", action="store_true", help="two causes in every case: for the share of which both are found")
    held.add_argument("--unlisted", action="store_true", help="a cause without a name in every case: for the share answered unknown")
    parser.add_argument("--noise", choices=("stated", "coloured"), default="stated", help="coloured: part of the white noise has a memory")
    parser.add_argument("--jobs", type=int, default=1, help="processes (default 1)")
    options = parser.parse_args(arguments)
    if options.cases < 1 or options.jobs < 1:
        parser.error("--cases and --jobs must be at least 1")
    key = options.key or options.out.with_name(options.out.name + ".key.zip")
    if options.out.exists():
        parser.error(f"{options.out} exists already; name a new folder, a set is never overwritten")
    if not options.open and key.exists():
        parser.error(f"{key} exists already; name a new --key, a key is never overwritten")

    if options.causes and not options.open:
        parser.error("--causes says what a set holds; it goes with --open")
    names = tuple(options.causes.split(",")) if options.causes else ()
    known = [cause.name for cause in load(options.bench).CAUSES]
    if unknown := [name for name in names if name not in known]:
        parser.error(f"--causes {','.join(unknown)}: the {options.bench} bench has {', '.join(known)}")

    seed = options.seed if options.seed is not None else secrets.randbits(63)
    shares = next((kind for name, kind in ONLY.items() if getattr(options, name)), SHARES)
    labels = make_set(options.bench, options.cases, seed, options.out, noise=options.noise, jobs=options.jobs, names=names, shares=shares)
    if options.open:
        for case, truth in labels.items():
            (options.out / case / "truth.json").write_text(sealing.truth_text(truth), encoding="utf-8")
        return 0
    sealed = {case: sealing.seal(truth) for case, truth in labels.items()}
    about = {
        "bench": options.bench,
        "cases": options.cases,
        "seed": seed,
        "noise": options.noise,
        **{name: getattr(options, name) for name in ONLY},
    }
    sealing.write_key(key, sealed, about)
    sealing.write_commitments(options.out, sealed)
    print(f"{len(sealed)} cases in {options.out}, truths in {key}", file=sys.stderr)
    return 0


def make_set(
    bench: str,
    cases: int,
    seed: int,
    out: Path,
    *,
    noise: str = "stated",
    jobs: int = 1,
    names: Sequence[str] = (),
    shares: Mapping[str, float] = SHARES,
) -> dict[str, dict[str, Any]]:
    """Write the records of every case; returns the labels.  Each case has random numbers of its own.

    names : of the only causes; if not given a mixture of all, with these shares of each kind
    """
    order, *streams = np.random.SeedSequence(seed).spawn(cases + 1)
    rng = np.random.default_rng(order)
    sites = singles(load(bench), names, cases, rng) if names else mixture(load(bench), cases, rng, shares)
    width = max(2, len(str(cases)))
    work = [(bench, f"{bench}-c{k + 1:0{width}d}", sites[k], streams[k], noise, out) for k in range(cases)]
    out.mkdir(parents=True)
    labels: dict[str, dict[str, Any]] = {}
    start = time.monotonic()
    if jobs == 1:
        for item in work:
            labels[item[1]] = _make_one(item)
            _tell(len(labels), cases, start)
    else:
        with ProcessPoolExecutor(jobs) as pool:
            for item, truth in zip(work, pool.map(_make_one, work), strict=True):
                labels[item[1]] = truth
                _tell(len(labels), cases, start)
    return labels


def _make_one(item: tuple[str, str, list[Site], np.random.SeedSequence, str, Path]) -> dict[str, Any]:
    bench, name, sites, stream, noise, out = item
    case = load(bench).make_case(sites, np.random.default_rng(stream), noise=noise)
    write_case(out, name, case)
    return case.labels(name)


def _tell(done: int, of: int, start: float) -> None:
    left = (time.monotonic() - start) * (of - done) / done
    print(f"\rcase {done}/{of}, {left:.0f} s left ", end="" if done < of else "\n", file=sys.stderr, flush=True)


if __name__ == "__main__":
    sys.exit(main())

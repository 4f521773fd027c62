"""One sweep run in several ways: the same jobs, timed from the call to the result."""

from __future__ import annotations

import contextlib
import importlib.util
import time
from collections.abc import Iterator
from importlib import metadata
from typing import Any

import numpy as np

import hdrive_mbs as hm
from benchmarks.machine import machine
from models.two_rotor_line import build

WAYS = (("in this process", 1), ("processes", 1), ("processes", 2), ("dask", 1), ("dask", 2))


def nothing(point: dict[str, Any]) -> float:
    """A job that takes no time: what is left is the sweep's own."""
    return 0.0


def study(quick: bool = False, repeats: int = 3) -> dict[str, Any]:
    """Wall seconds of every way, and whether all gave the same numbers."""
    count, duration, empty = (3, 0.05, 10) if quick else (16, 2.5, 400)
    task = hm.SceneAnalysis(scene=build(), analysis="run_up", options={"duration": duration, "step": 1e-4, "accuracy": 1e-3})
    points = hm.grid({"rotor_1.eccentricity": np.linspace(10e-6, 30e-6, count)})
    nothings = [{"x": x} for x in range(empty)]
    ways = [way for way in WAYS if way[0] != "dask" or importlib.util.find_spec("distributed")]
    found: dict[tuple[str, int], dict[str, list[float]]] = {way: {"run_ups": [], "nothing": []} for way in ways}
    tables = []
    for _ in range(repeats):  # the ways take turns, so that what else the machine does hits all alike
        for way in ways:
            with executor(*way) as options:
                campaign, seconds = timed(task, points, options)
                tables.append(campaign.columns())
                found[way]["run_ups"].append(seconds)
                found[way]["nothing"].append(timed(nothing, nothings, options)[1])
    rows = [
        {"way": way, "workers": workers, "run_ups_seconds": times["run_ups"], "nothing_seconds": times["nothing"]}
        for (way, workers), times in found.items()
    ]
    return {
        "machine": machine() | ({"distributed": metadata.version("distributed")} if len(ways) == len(WAYS) else {}),
        "repeats": repeats,
        "run_ups": count,
        "duration": duration,
        "nothings": empty,
        "ways": rows,
        "equal": all(same(table, tables[0]) for table in tables),
        "peaks": tables[0]["rotor_1 peak amplitude, 0-peak [m]"],
    }


@contextlib.contextmanager
def executor(way: str, workers: int) -> Iterator[dict[str, Any]]:
    """Options of ``sweep``; a dask cluster is started before and stopped after, outside the timed part."""
    if way == "dask":
        from distributed import LocalCluster

        with LocalCluster(n_workers=workers, threads_per_worker=1, processes=True, dashboard_address=None) as cluster:
            yield {"executor": cluster.scheduler_address}
    else:
        yield {"executor": "here"} if way == "in this process" else {"executor": "processes", "workers": workers}


def timed(task: Any, points: Any, options: dict[str, Any]) -> tuple[hm.Campaign, float]:
    """The campaign and its wall seconds."""
    started = time.perf_counter()
    campaign = hm.sweep(task, points, progress=False, **options)
    seconds = time.perf_counter() - started
    if campaign.status != "complete":
        raise RuntimeError(f"{options}: {campaign.status}\n{campaign.failures}")
    return campaign, seconds


def same(first: dict[str, np.ndarray], second: dict[str, np.ndarray]) -> bool:
    """Whether two tables are equal to the last bit."""
    return list(first) == list(second) and all(np.array_equal(first[name], second[name]) for name in first)

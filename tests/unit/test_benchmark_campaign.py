"""Benchmarks whose cases run side by side: here, on processes, on a dask cluster, and from where an interrupted one stopped."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from benchmarks.bearings.sweep import Grid, at_a_stiffness, damping_places, maps
from benchmarks.campaign import Where, add_where, where
from benchmarks.flagship import study as flagship
from benchmarks.flagship.report import report as flagship_report
from benchmarks.locate import study as locate
from benchmarks.locate.report import report as locate_report
from benchmarks.machine import machine
from benchmarks.real import studies as real
from tests.unit import campaign_jobs as jobs
from tests.unit.test_campaign import log_lines, points
from tests.unit.test_campaign_cluster import cluster  # noqa: F401  (a fixture)

SMALL = Grid((0.022, 0.030), (1.2e7, 1.2e8), (1e6,), (0.0, 1.0))


def same(a: Any, b: Any) -> bool:
    """Equal numbers, NaN beside NaN, through mappings and arrays."""
    if isinstance(a, Mapping):
        return a.keys() == b.keys() and all(same(a[key], b[key]) for key in a)
    if isinstance(a, (list, tuple)):
        return len(a) == len(b) and all(map(same, a, b))
    if isinstance(a, str):
        return bool(a == b)
    return bool(np.array_equal(a, b, equal_nan=True))


@pytest.fixture(scope="module")
def here() -> dict[str, Any]:
    """Maps and damping rows of a small grid, worked on in this process."""
    return {"maps": maps(SMALL, Where(), lambda: None), "damping": damping_places(SMALL, Where(), lambda: None)}


@pytest.mark.slow
def test_maps_on_processes_are_those_of_this_process_and_are_kept(here: dict[str, Any], tmp_path: Path) -> None:
    seen = []
    far = Where(workers=2, kept=tmp_path)
    found = {"maps": maps(SMALL, far, lambda: seen.append(1)), "damping": damping_places(SMALL, far, lambda: seen.append(1))}
    assert same(found, here)
    assert len(seen) == 2 * 3 + 2 * 2  # diameters times stiffnesses; shares of two cases
    assert len(list((tmp_path / "jobs").iterdir())) == len(seen)
    again = maps(SMALL, Where(kept=tmp_path), lambda: None)
    assert same(again, here["maps"])


@pytest.mark.slow
def test_maps_on_a_cluster_are_those_of_this_process(here: dict[str, Any], cluster: str) -> None:  # noqa: F811
    assert same(maps(SMALL, Where(scheduler=cluster), lambda: None), here["maps"])


def test_a_map_holds_at_its_place_what_its_point_gives(here: dict[str, Any]) -> None:
    row = at_a_stiffness({"of": "bearing", "diameter": 0.030, "stiffness": 1.2e7})
    for model, numbers in row.items():
        for key, value in numbers.items():
            assert same(here["maps"]["bearing"]["models"][model][key][1, 0], value)


def test_a_stopped_benchmark_says_how_to_go_on_and_goes_on(tmp_path: Path) -> None:
    log = tmp_path / "log"
    asked = points(5, log=str(log))

    def stop(point: Mapping[str, Any], values: Mapping[str, Any]) -> None:
        if point["x"] == 2:
            raise KeyboardInterrupt

    with pytest.raises(SystemExit, match=r"stopped with 3 of 5 jobs done; the same call with the same folder goes on"):
        Where(kept=tmp_path).sweep(jobs.logged, asked, arrived=stop)
    with pytest.raises(SystemExit, match=r"give --kept FOLDER"):
        Where().sweep(jobs.logged, asked, arrived=stop)
    before = len(log_lines(log))
    found = Where(kept=tmp_path).sweep(jobs.logged, asked)
    assert list(found["double"]) == [2.0 * x for x in range(5)]
    assert [x for x, _ in log_lines(log)[before:]] == ["3", "4"]


def test_a_failing_case_is_said_and_does_not_stop_the_others(capsys: pytest.CaptureFixture[str]) -> None:
    found = Where().sweep(jobs.fails_at_three, points(5))
    assert list(found.done) == [True, True, True, False, True]
    assert "failed: {'x': 3}: ValueError: no root at x = 3" in capsys.readouterr().err


def test_options_ask_for_processes_a_cluster_and_a_folder() -> None:
    parser = argparse.ArgumentParser()
    add_where(parser)
    assert where(parser.parse_args([])) == Where(workers=None)
    assert where(parser.parse_args(["--workers", "0"])) == Where()
    asked = where(parser.parse_args(["--workers", "3", "--kept", "there", "--scheduler", "tcp://host:8786"]))
    assert asked == Where(workers=3, scheduler="tcp://host:8786", kept=Path("there"))
    with pytest.raises(SystemExit, match=r"--workers -1: must be at least 0"):
        where(parser.parse_args(["--workers", "-1"]))


def test_the_flagship_tells_a_case_that_failed_beside_those_that_did_not(monkeypatch: pytest.MonkeyPatch) -> None:
    def answered(point: dict[str, Any]) -> dict[str, Any]:
        if point["case"] == names[1]:
            raise ValueError("no steady state")
        gap = {name: {"value": 1.0, "low": 0.9, "high": 1.1} for name in ("nominal", "refitted", "with_cause")}
        causes = [{"effect": "mesh_friction", "place": point["laws"], "law": "MeshFriction", "probability": 0.9}]
        right = {f"{word}_right": True for word in ("verdict", "effect", "place")}
        return {"case": point["case"], "planted": "it", "verdict": "effect", "causes": causes, "gap": gap, "cpu_s": 2.0, **right}

    names = [case.name for case in flagship.CASES[:2]]
    monkeypatch.setattr(flagship, "diagnosed", answered)
    numbers = flagship.study(quick=False, names=names)
    assert [case["case"] for case in numbers["cases"]] == names
    text = flagship_report(numbers)
    assert "stopped: ValueError: no steady state" in text
    assert "mesh_friction at one (MeshFriction)" in text
    assert "1 of 2 right" in text


def test_a_study_of_measurements_is_put_together_from_parts_that_were_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Numbers and curves come back from files as they were; a part that fails leaves the study as it was."""
    curve = np.linspace(0.0, 1.0, 5)

    def work(part: str) -> dict[str, Any]:
        if part == "C":
            raise ValueError("no such run")
        shown = {"nominal": {"measured": {"torque": curve}, "simulated": {"torque": 0.5 * curve}, "rms": {"torque": 0.3}}}
        return {"numbers": {"part": part, "rounds": [{"causes": [], "gap": {"nominal": [2.0, 1.9, 2.1]}}]}, "shown": shown}

    def whole(parts: Mapping[str, dict[str, Any]]) -> tuple[dict[str, Any], dict[str, Any]]:
        unseen = {name: real._drawn(part)["nominal"] for name, part in parts.items()}
        assert all(same(item.measured["torque"] - item.simulated["torque"], 0.5 * curve) for item in unseen.values())
        return {"of": [part["numbers"]["part"] for part in parts.values()]}, {}

    kept = Where(kept=tmp_path)
    monkeypatch.setitem(real.STUDIES, "own", real.Kind(parts=("A", "B"), work=work, whole=whole))
    for _ in range(2):
        found = real.studied("own", kept)
        assert found is not None
        assert found[0]["of"] == ["A", "B"]
        assert {"seconds", "machine"} <= set(found[0])
        assert len(list((tmp_path / "jobs").iterdir())) == 2
    monkeypatch.setitem(real.STUDIES, "own", real.Kind(parts=("A", "C"), work=work, whole=whole))
    assert real.studied("own", kept) is None
    assert "failed: {'study': 'own', 'part': 'C'}: ValueError: no such run" in capsys.readouterr().err


def test_the_localisation_counts_a_case_that_failed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    truths = {f"drive-c{k}": {"truth": [{"effect": "quadratic_drag", "at": "load"}]} for k in (1, 2)}
    place = {"at": "load", "probability": 0.97, "gain": 50.0, "share": 0.9, "tied": []}

    def found(point: dict[str, Any]) -> dict[str, Any]:
        if point["folder"].endswith("c2"):
            raise ValueError("no records")
        return {"places": [place], "trusted": True, "left": 1.02, "seconds": 3.0}

    monkeypatch.setattr(locate, "read_truths", lambda folder: truths)
    monkeypatch.setattr(locate, "places_of", found)
    numbers = locate.study({"drive": [tmp_path]})
    assert [(row["case"], row["outcome"]) for row in numbers["cases"]["drive"]] == [("drive-c1", "right")]
    assert "Not located, because the case failed: drive-c2." in locate_report({**numbers, "machine": machine()})

"""Jobs for the tests of campaigns; worker processes import them from here."""

from __future__ import annotations

import os
import signal
import time
from pathlib import Path
from typing import Any

import numpy as np

FACTOR = 2.0


def scaled(x: float) -> float:
    return FACTOR * x


def square(point: dict[str, Any]) -> dict[str, Any]:
    return {"square [m^2]": point["x"] ** 2, "even": point["x"] % 2 == 0}


def seeded(point: dict[str, Any]) -> dict[str, Any]:
    """Random numbers from the point's own seed, and a sum whose last digits depend on its order."""
    numbers = np.random.default_rng(point["seed"]).normal(size=(60, 60))
    return {"sum": float(numbers.sum()), "product": numbers @ numbers.T, "words": ("a", {"b": 1})}


def logged(point: dict[str, Any]) -> dict[str, Any]:
    """Writes down that it ran, takes its time, and gives its double."""
    with Path(point["log"]).open("a") as log:
        log.write(f"{point['x']} {os.getpid()}\n")
    time.sleep(point.get("seconds", 0.0))
    return {"double": scaled(point["x"])}


def waits_for_company(point: dict[str, Any]) -> dict[str, Any]:
    """Job 0 is not finished before another process has run a job."""
    double = logged(point)
    end = time.monotonic() + 20.0
    while point["x"] == 0 and time.monotonic() < end:
        if any(line.split()[1] != str(os.getpid()) for line in Path(point["log"]).read_text().splitlines()):
            break
        time.sleep(0.01)
    return double


def held(point: dict[str, Any]) -> dict[str, Any]:
    """A job from number 8 on is not finished before the file "go" is there."""
    double = logged(point)
    end = time.monotonic() + 10.0
    while point["x"] >= 8 and not Path(point["go"]).exists() and time.monotonic() < end:
        time.sleep(0.01)
    return double


def killed_once(point: dict[str, Any]) -> float:
    """Job 2 ends its own process the first time, as the out-of-memory killer would."""
    if point["x"] == 2 and not Path(point["marker"]).exists():
        Path(point["marker"]).touch()
        os.kill(os.getpid(), signal.SIGKILL)
    time.sleep(0.02)
    return scaled(point["x"])


def always_killed(point: dict[str, Any]) -> float:
    if point["x"] == 2:
        os.kill(os.getpid(), signal.SIGKILL)
    return scaled(point["x"])


def fails_at_three(point: dict[str, Any]) -> float:
    if point["x"] == 3:
        raise ValueError(f"no root at x = {point['x']}")
    return scaled(point["x"])


def exits(point: dict[str, Any]) -> float:
    raise SystemExit(3)


def gives_an_object(point: dict[str, Any]) -> object:
    return {"thing": object()}

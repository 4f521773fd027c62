"""Records of a specimen: what its inverter is told, what its sensors show, noise and rounding, as CSV."""

from __future__ import annotations

import io
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from benchmarks.flagship.plant import Array, Joint

EVERY, DURATION = 2e-3, 3.0
FEEDS: dict[str, tuple[Array, Array]] = {
    "run_up": (np.array([0.0, 2.5, 3.0]), np.array([0.0, 480.0, 480.0])),
    "to_and_fro": (
        np.array([0.0, 0.6, 1.0, 1.6, 2.0, 2.6, 3.0]),
        np.array([0.0, 150.0, 150.0, -100.0, -100.0, 60.0, 60.0]),
    ),
}
"""Synchronous speed of the inverter over time."""

NOISE = {"motor_torque": 0.01, "motor_angle": 1e-3, "output_angle": 4e-5}
"""Standard deviation of each column, SI, with its rounding."""
UNITS = {"feed_speed": "rad/s", "motor_torque": "N m", "motor_angle": "rad", "output_angle": "rad"}
DIGITS = {"feed_speed": 6, "motor_torque": 4, "motor_angle": 4, "output_angle": 6}
"""Decimals in the file; a tenth of the noise at most."""


def measured(joint: Joint, record: str, rng: np.random.Generator) -> dict[str, Array]:
    """Time and columns of a record."""
    feed_times, feed_speeds = FEEDS[record]
    samples = round(DURATION / EVERY) + 1
    times = EVERY * np.arange(samples)
    exact = joint.run(feed_times, feed_speeds, samples, EVERY)
    noisy = {name: values + NOISE[name] * rng.standard_normal(samples) for name, values in exact.items()}
    return {"time": times, "feed_speed": np.interp(times, feed_times, feed_speeds), **noisy}


def csv(columns: dict[str, Array]) -> str:
    """The file: a header with units, one line a sample."""
    text = io.StringIO()
    text.write(",".join(["time [s]", *(f"{name} [{UNITS[name]}]" for name in columns if name != "time")]) + "\n")
    formats = ["%.4f", *(f"%.{DIGITS[name]}f" for name in columns if name != "time")]
    np.savetxt(text, np.column_stack(list(columns.values())), fmt=formats, delimiter=",")
    return text.getvalue()


def write(joint: Joint, folder: Path, rng: np.random.Generator, records: Sequence[str] = tuple(FEEDS)) -> list[Path]:
    """Records of a specimen."""
    folder.mkdir(parents=True, exist_ok=True)
    written = []
    for record in records:
        path = folder / f"{record}.csv"
        path.write_text(csv(measured(joint, record, rng)), "utf-8", newline="\n")
        written.append(path)
    return written

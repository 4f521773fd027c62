"""Runs ROSS's side in ROSS's own environment and reads what it wrote."""

from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.rotor_speed.accuracy import frequency_errors
from benchmarks.rotor_speed.beam import FloatArray

VARIABLE = "ROSS_PYTHON"
ROOT = Path(__file__).resolve().parents[2]


def ross_python(given: Path | None) -> Path | None:
    """The interpreter given, else that of the environment variable ROSS_PYTHON, else none."""
    named = given or (Path(os.environ[VARIABLE]) if os.environ.get(VARIABLE) else None)
    if named is not None and not named.is_file():
        raise FileNotFoundError(
            f"No Python at {named}, which --ross-python or {VARIABLE} names. README.md beside this file says how to make the environment."
        )
    return None if named is None else named.absolute()  # not resolved: a link into an environment selects that environment


def measure(python: Path, folder: Path, *, quick: bool = False, repeats: int = 2) -> dict[str, Any]:
    """Run it (two to three minutes; ``quick``: half a minute) and return the content of ross.json."""
    command = [str(python), "-m", "benchmarks.rotor_speed.ross_side", "--out", str(folder.resolve()), "--repeats", str(repeats)]
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
    done = subprocess.run([*command, *(["--quick"] if quick else [])], cwd=ROOT, env=environment, capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(f"ROSS's side ended with {done.returncode}. Its last lines:\n" + "\n".join(done.stderr.splitlines()[-15:]))
    numbers: dict[str, Any] = json.loads((folder / "ross.json").read_text(encoding="utf-8"))
    return numbers


def lateral(run: dict[str, Any]) -> FloatArray:
    """Lateral frequencies of one entry of ``campbell``, (speeds, modes): without the branches that ROSS calls torsional or axial."""
    frequencies, whirl = np.array(run["frequencies"]), np.array(run["whirl"])
    return frequencies[:, ~np.any(whirl == "none", axis=0)]


def errors(run: dict[str, Any], reference: FloatArray) -> FloatArray:
    """Relative errors of the lateral frequencies, against as many of the reference."""
    found = lateral(run)
    return frequency_errors(found, reference[:, : found.shape[1]])


def wrong_whirl(run: dict[str, Any], reference: FloatArray) -> float:
    """Share of lateral branches and speeds, but for rest, at which ROSS's label is not the whirl of the reference's frequency."""
    frequencies, whirl = np.array(run["frequencies"])[1:], np.array(run["whirl"])[1:]
    kept = ~np.any(whirl == "none", axis=0)
    frequencies, whirl = frequencies[:, kept], whirl[:, kept]
    order = np.argsort(frequencies, axis=1)
    expected = np.where(reference[1:, : order.shape[1]] > 0.0, "forward", "backward")
    return float(np.mean(np.take_along_axis(whirl, order, axis=1) != expected))


def motion(folder: Path, run: dict[str, Any]) -> tuple[FloatArray, FloatArray]:
    """Times and (discs, 2, times) displacements of one entry of ``run_up``."""
    with np.load(folder / run["file"]) as stored:
        return stored["times"], stored["displacements"]

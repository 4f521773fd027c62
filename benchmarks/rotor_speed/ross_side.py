"""ROSS's side of the comparison; run by the Python of ROSS's own environment, from the root of the repository:

    ross-env/bin/python -m benchmarks.rotor_speed.ross_side --out FOLDER

Nothing of hdrive_mbs is imported.  Writes ross.json and one .npz per run-up.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import os
import platform
import sys
import time
import warnings
from collections.abc import Callable, Sequence
from importlib import metadata
from pathlib import Path
from typing import Any

for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(name, "1")  # before numpy is loaded

import numpy as np  # noqa: E402

from benchmarks.rotor_speed import rotor as data  # noqa: E402

PACKAGES = ("ross-rotordynamics", "numpy", "scipy", "numba", "pandas", "plotly")
DENSE_UP_TO = 24
"""Elements: beyond this a dense eigenvalue problem at each speed takes ROSS three times as long as its own choice."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Time and store; returns 0."""
    parser = argparse.ArgumentParser(description="Campbell diagram and prescribed run-up of Friswell's rotor 5.9.1 by ROSS.")
    parser.add_argument("--out", type=Path, required=True, help="folder for ross.json and the motions")
    parser.add_argument("--repeats", type=int, default=2, help="timed calls after the first one (default 2)")
    parser.add_argument("--quick", action="store_true", help="6 elements, 11 speeds, 2500 steps, one repeat")
    options = parser.parse_args(arguments)
    if options.repeats < 1:
        parser.error("--repeats must be at least 1")
    repeats = 1 if options.quick else options.repeats
    elements = data.ELEMENTS[:1] if options.quick else data.ELEMENTS
    speeds = np.linspace(0.0, data.HIGHEST_SPEED, 11 if options.quick else data.SPEEDS)
    options.out.mkdir(parents=True, exist_ok=True)

    with contextlib.redirect_stdout(sys.stderr), warnings.catch_warnings():  # ROSS and what it imports print
        warnings.simplefilter("ignore")
        start = time.process_time()
        import ross

        import_seconds = time.process_time() - start
        numbers = {
            "python": platform.python_version(),
            **{name: metadata.version(name) for name in PACKAGES},
            "import_seconds": import_seconds,
            "repeats": repeats,
            "speeds": speeds.tolist(),
            "campbell": campbells(ross, elements, speeds, repeats),
            "run_up": run_ups(ross, (2_500,) if options.quick else (data.RAMP_STEPS, 5_000, 2_500), repeats, options.out),
        }
    target = options.out / "ross.json"
    target.write_text(json.dumps(numbers, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    print(f"wrote {target}")
    return 0


def build(ross: Any, elements: int, damping: float = 0.0) -> Any:
    """Friswell's rotor with ROSS's default element: Timoshenko with Cowper's coefficient, rotary inertia, gyroscopic."""
    steel = ross.Material("steel", rho=data.DENSITY, E=data.YOUNGS_MODULUS, G_s=data.SHEAR_MODULUS)
    shaft = [ross.ShaftElement(data.LENGTH / elements, 0.0, data.DIAMETER, material=steel) for _ in range(elements)]
    stations = data.disc_stations(elements)
    discs = [
        ross.DiskElement(n=station, m=disc.mass, Id=disc.transverse_inertia, Ip=disc.polar_inertia)
        for station, disc in zip(stations, data.DISCS)
    ]
    bearings = [ross.BearingElement(station, kxx=data.BEARING_STIFFNESS, cxx=damping) for station in (0, elements)]
    return ross.Rotor(shaft, discs, bearings)


def campbells(ross: Any, elements: Sequence[int], speeds: np.ndarray, repeats: int) -> list[dict[str, Any]]:
    """run_campbell as it comes, with enough frequencies for six lateral ones, and in the fastest ways that ROSS offers."""
    from ross.utils import convert_6dof_to_4dof

    def default(count: int) -> Callable[[Any], Any]:
        return lambda rotor: rotor.run_campbell(speeds, frequencies=count)

    def dense(rotor: Any) -> Any:
        return [rotor.run_modal(speed, num_modes=12, sparse=False) for speed in speeds]

    ways: list[tuple[str, Callable[[Any], Any], Callable[[Any], Any], int | None]] = [
        ("run_campbell, 7 frequencies", lambda rotor: rotor, default(7), None),  # the fifth at rest is torsional
        ("run_campbell, 6 frequencies (default)", lambda rotor: rotor, default(6), None),
        ("run_campbell, lateral coordinates only (convert_6dof_to_4dof)", convert_6dof_to_4dof, default(6), None),
        ("run_modal(sparse=False) at each speed, branches not followed", lambda rotor: rotor, dense, DENSE_UP_TO),
    ]
    found = []
    for number in elements:
        for way, convert, run, limit in ways:
            if limit is not None and number > limit:
                continue
            calls, built, result = [], [], None
            for _ in range(1 + repeats):  # a new rotor each time: ROSS keeps what a rotor has been asked before
                start = time.process_time()
                rotor = convert(build(ross, number))
                middle = time.process_time()
                result = run(rotor)
                calls.append(time.process_time() - middle)
                built.append(middle - start)
            row = {
                "elements": number,
                "way": way,
                "build_seconds": built[1:],
                "first_seconds": calls[0],
                "seconds": calls[1:],
            }
            if not isinstance(result, list):
                row |= _branches(result)
            found.append(row)
            print(f"{number} elements, {way}: first {calls[0]:.2f} s, then {min(calls[1:]):.2f} s")
    return found


def _branches(result: Any) -> dict[str, Any]:
    """Frequencies and log decrements (speeds x branches), whirl as ROSS labels it; "none": torsional or axial."""
    words = {0.0: "forward", 0.5: "mixed", 1.0: "backward"}
    return {
        "frequencies": np.asarray(result.wd).tolist(),
        "log_decrements": np.asarray(result.log_dec).tolist(),
        "whirl": [[words.get(value, "none") for value in row] for row in np.asarray(result.whirl_values).tolist()],
    }


def run_ups(ross: Any, steps: Sequence[int], repeats: int, folder: Path) -> list[dict[str, Any]]:
    """run_time_response along the ramp: as it comes, without its term from the angular acceleration, and reduced."""
    ways: list[tuple[str, str, Callable[[Any], dict[str, Any]], float]] = [
        ("run_time_response", "", lambda rotor: {}, -1.0),
        ("run_time_response, without Ksdt", "_without_ksdt", lambda rotor: {"Ksdt": np.zeros((rotor.ndof, rotor.ndof))}, 0.0),
        ("run_time_response, Guyan reduction", "_guyan", lambda rotor: {"model_reduction": {"method": "guyan"}}, -1.0),
    ]
    found = []
    stations = data.disc_stations(data.RAMP_ELEMENTS)
    for number in steps:
        times = np.linspace(0.0, data.RAMP_DURATION, number + 1)
        speed = data.HIGHEST_SPEED * times / data.RAMP_DURATION
        for way, mark, options, transient_term in ways:
            calls, forces, motion = [], [], np.empty(0)
            for _ in range(1 + repeats):
                rotor = build(ross, data.RAMP_ELEMENTS, data.BEARING_DAMPING)
                start = time.process_time()
                force = rotor.unbalance_force_over_time([stations[0]], [data.UNBALANCE], [0.0], speed, times).T
                middle = time.process_time()
                motion = rotor.run_time_response(speed, force, times, **options(rotor)).yout
                calls.append(time.process_time() - middle)
                forces.append(middle - start)
            rows = [[station * rotor.number_dof + axis for axis in (0, 1)] for station in stations]
            name = f"ross_run_up_{number}{mark}.npz"
            np.savez_compressed(folder / name, times=times, displacements=np.moveaxis(motion[:, rows], 0, -1))
            found.append(
                {
                    "steps": number,
                    "way": way,
                    "transient_term": transient_term,  # of the equations that it solves: benchmarks.rotor_speed.run_up
                    "degrees_of_freedom": rotor.ndof,
                    "force_seconds": forces[1:],
                    "first_seconds": calls[0],
                    "seconds": calls[1:],
                    "file": name,
                }
            )
            print(f"{number} steps, {way}: first {calls[0]:.2f} s, then {min(calls[1:]):.3f} s")
    return found


if __name__ == "__main__":
    sys.exit(main())

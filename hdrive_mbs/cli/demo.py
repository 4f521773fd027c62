"""``hdrive-mbs demo``: the flagship line run up, looked at and diagnosed, on one page, in about a minute."""

from __future__ import annotations

import dataclasses
import os
import time
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Annotated

import numpy as np
import typer

import hdrive_mbs
from hdrive_mbs.cli.options import JsonFile
from hdrive_mbs.cli.output import print_table, write_json
from hdrive_mbs.cli.scene_source import module_of
from hdrive_mbs.cli.stages import stage_bars
from hdrive_mbs.errors import FileFormatError, HdriveError
from hdrive_mbs.writing import write_text

if TYPE_CHECKING:
    from hdrive_mbs.analysis.run_up.run_up import RunUp
    from hdrive_mbs.analysis.whirl.whirl_campbell import WhirlCampbell
    from hdrive_mbs.diagnosis.result import Diagnosis
    from hdrive_mbs.effects.effect import Effect

MODEL = "robot_joint_line.py"
MODELS = ("full", "simplified", "improved")
ROTOR, GEAR = "brake_disc", "gear"
DURATION = 3.0
"""Of the run-up [s]."""
SAMPLE = 2.5e-4
"""Of its curves [s]: 50 points a turn at the highest speed."""
ABOUT = (
    "A record of 3 s of this line comes with the package: inverter frequency, motor torque and two encoders, with noise and with"
    " numbers off by their tolerance. A plant of its own made it, with other equations, another integrator and other laws, and one"
    " effect in it that the model lacks (benchmarks/flagship in the source). The diagnosis knows neither the effect nor its place. To be"
    " quick it tries one law of each family at every place, in the torsion of the line; hdrive-mbs diagnose tries all laws."
)


def demo(
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="Folder for the page and the results.")] = Path("demo"),
    json: JsonFile = None,
) -> None:
    """Run a robot joint up, draw its Campbell diagram, compare bearing models, diagnose a record; one page for a browser."""
    from hdrive_mbs.plots.demo_page import DemoResults, demo_page
    from hdrive_mbs.scene_file import save_scene

    started = time.perf_counter()
    joint = flagship()
    out.mkdir(parents=True, exist_ok=True)
    save_scene(joint.build(), out / "scene.toml")
    seconds: dict[str, float] = {}
    cpu: dict[str, float] = {}
    runs: dict[str, RunUp] = {}
    coordinates: dict[str, int] = {}
    for model in MODELS:
        with _timed(f"run-up, {model} bearings", seconds, cpu):
            runs[model], coordinates[model] = _run(joint, model)
    with _timed("Campbell diagram", seconds, cpu):
        campbell = _campbell(joint)
    campbell.save(out / "campbell.npz")
    with _timed("diagnosis", seconds, cpu):
        diagnosis = _diagnosis(joint, out)
    with _timed("page", seconds, cpu):
        results = DemoResults(
            runs=runs,
            coordinates=coordinates,
            rotor=ROTOR,
            gear=GEAR,
            lost_motion=joint.gear().lost_motion,
            campbell=campbell,
            diagnosis=diagnosis,
            about_records=ABOUT,
            seconds=seconds,
            made=f"Made by hdrive-mbs {_version()} from {MODEL} and its bundled records.",
        )
        page = write_text(out / "demo.html", demo_page(results))
    total = time.perf_counter() - started
    document = {
        "seconds": total,
        "sections": seconds,
        "cpu_sections": cpu,
        "folder": str(out),
        "page": str(page),
        "page_bytes": page.stat().st_size,
        "run_ups": {name: {"status": run.status, "peak": run.peak_amplitude[ROTOR]} for name, run in runs.items()},
        "campbell": campbell.status,
        "diagnosis": diagnosis if isinstance(diagnosis, str) else diagnosis.verdict,
    }
    write_json(json, document)
    if json != "-":
        print_table(
            f"robot joint line: {total:.0f} s", ["section", "seconds"], [[name, round(value, 1)] for name, value in seconds.items()]
        )
        print(diagnosis if isinstance(diagnosis, str) else f"Diagnosis: {_causes(diagnosis)}")
        print(f"Page for a browser: {page}")
    if isinstance(diagnosis, str):
        raise typer.Exit(1)


def flagship() -> ModuleType:
    """The model of the joint: from the installed package, or from ``models`` of a clone.

    Raises FileFormatError where it is in neither.
    """
    package = Path(hdrive_mbs.__file__).parent
    for path in (package / "data" / MODEL, package.parent / "models" / MODEL):
        if path.is_file():
            return module_of(path)
    raise FileFormatError(f"{MODEL} is neither in {package / 'data'} nor in {package.parent / 'models'}; install the package again.")


@contextmanager
def _timed(name: str, seconds: dict[str, float], cpu: dict[str, float]) -> Iterator[None]:
    """Wall time and CPU time of a section, worker processes that have ended counted."""
    before, started = sum(os.times()[:4]), time.perf_counter()
    yield
    seconds[name], cpu[name] = time.perf_counter() - started, sum(os.times()[:4]) - before


def _run(joint: ModuleType, model: str) -> tuple[RunUp, int]:
    from hdrive_mbs.analysis.run_up.run_up import run_up
    from hdrive_mbs.analysis.whirl.bearing_models import BearingModelWarning

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", BearingModelWarning)  # the page shows by how much the simplified model is off
        scene = joint.build(model)
    return run_up(scene, DURATION, places=(ROTOR,), sample_step=SAMPLE), len(scene.network().bodies)


def _campbell(joint: ModuleType) -> WhirlCampbell:
    from hdrive_mbs.analysis.whirl.whirl_campbell import campbell

    return campbell(joint.build(arm_angle=-0.5 * np.pi), np.linspace(0.0, 500.0, 11), orders={"motor": (1.0, 2.0)})


def _diagnosis(joint: ModuleType, out: Path) -> Diagnosis | str:
    """The answer, also written to diagnosis.json; or what kept it from being found, in words."""
    try:
        from hdrive_mbs.diagnosis.diagnose import diagnose
        from hdrive_mbs.diagnosis.report_json import write_report_json
        from hdrive_mbs.records.reading import read_records

        with stage_bars() as report:
            known, records = joint.bench(), read_records(joint.bundled_records())
            found = diagnose(known, records, candidates=one_law_each(), workers=min(2, os.cpu_count() or 1), report=report)
    except HdriveError as error:
        return f"The record was not diagnosed: {error}"
    write_report_json(found, out / "diagnosis.json")
    return found


def one_law_each() -> tuple[type[Effect], ...]:
    """The library's simplest law of every family: without states where there is one, then with the fewest fields to search."""
    from hdrive_mbs.diagnosis.candidates import known_effects
    from hdrive_mbs.effects.effect import MemoryTorqueEffect, MemoryTwistEffect

    def effort(kind: type[Effect]) -> tuple[bool, int]:
        searched = [field for field in dataclasses.fields(kind) if getattr(field.metadata.get("quantity"), "typical", None)]
        return issubclass(kind, (MemoryTorqueEffect, MemoryTwistEffect)), len(searched)

    found: dict[str, type[Effect]] = {}
    for kind in (known for known in known_effects() if known.__module__.startswith("hdrive_mbs.")):
        if kind.family not in found or effort(kind) < effort(found[kind.family]):
            found[kind.family] = kind
    return tuple(found.values())


def _causes(diagnosis: Diagnosis) -> str:
    from hdrive_mbs.diagnosis import sentences

    return sentences.verdict(diagnosis)


def _version() -> str:
    from importlib import metadata

    return metadata.version("hdrive-mbs")

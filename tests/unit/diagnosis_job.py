"""A small diagnosis as a script, to be killed and resumed: FOLDER WORKERS STAGE SIGNAL [EFFECTS.py]."""

from __future__ import annotations

import importlib.util
import os
import signal
import sys
from pathlib import Path

from hdrive_mbs.diagnosis.diagnose import diagnose
from hdrive_mbs.diagnosis.result import Diagnosis
from hdrive_mbs.effects.eccentric_load import EccentricLoad
from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.effects.kinematic_error import KinematicError
from tests.unit.diagnosis_cases import bench, records

FIRST, SECOND = "looking at candidates", "a few joint steps"
"""Stages of the search."""
KINDS: tuple[type[Effect], ...] = (KinematicError, EccentricLoad)


def planted() -> tuple[KinematicError, str]:
    """What is in the records."""
    return KinematicError(amplitude=1e-4, order=2.0, phase=0.8), "gear"


def run(folder: Path, workers: int = 1, stage: str = "", number: int = 0, kinds: tuple[type[Effect], ...] = KINDS) -> Diagnosis:
    """The diagnosis; a signal ends this process as soon as a stage begins, once it has said so."""

    def report(at: str, done: int, total: int) -> None:
        if at == stage and done == 0 and total > 0:
            print("stage", flush=True)
            os.kill(os.getpid(), number)

    return diagnose(bench(), records(planted()), candidates=kinds, workers=workers, folder=folder, step=1e-3, report=report, pictures=False)


def from_file(path: Path) -> type[Effect]:
    """An effect class from a file that is not on the path of modules."""
    spec = importlib.util.spec_from_file_location("effect_of_a_user", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module
    spec.loader.exec_module(module)
    kind: type[Effect] = module.Own
    return kind


if __name__ == "__main__":
    signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's job in the background ignores it, and so do its children
    given = sys.argv[1:]
    number = getattr(signal, given[3]) if given[3] else 0
    own = tuple(from_file(Path(path)) for path in given[4:])
    found = run(Path(given[0]), int(given[1]), given[2], number, (*KINDS, *own))
    print(found.verdict, *(f"{cause.law} at {cause.at}" for cause in found.causes))

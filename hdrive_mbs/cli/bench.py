"""``hdrive-mbs bench``: the benchmarks of a checkout."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Annotated

import typer

import hdrive_mbs
from hdrive_mbs.errors import SceneError, unknown_place


def bench(
    context: typer.Context,
    name: Annotated[str, typer.Argument(metavar="NAME", help="Which one: bearings, speed, stiffness_laws, teeth, ...")],
) -> None:
    """Run a benchmark; its own options follow the name (--quick, --repeats N, --out DIR).

    The benchmarks lie beside the package in a checkout and in the source archive, not in the wheel.
    """
    root = find_root()
    modules = modules_in(root)
    if name not in modules:
        raise unknown_place("benchmark", name, modules, f"The folder {root / 'benchmarks'}")
    # a process of its own: it times, so nothing else shall be loaded, and it sets the threads of BLAS before numpy is
    paths = [str(root), *filter(None, [os.environ.get("PYTHONPATH")])]
    done = subprocess.run([sys.executable, "-m", modules[name], *context.args], env={**os.environ, "PYTHONPATH": os.pathsep.join(paths)})
    if done.returncode:
        raise typer.Exit(done.returncode)


def find_root() -> Path:
    """The folder with ``benchmarks/``: that of the package, or the current one.

    Raises SceneError when neither has it.
    """
    places = (Path(hdrive_mbs.__file__).resolve().parent.parent, Path.cwd())
    for place in places:
        if (place / "benchmarks" / "bearings" / "__main__.py").is_file():
            return place
    raise SceneError(
        "The benchmarks are not part of the installed package. Unpack the source archive "
        f"(hdrive_mbs-{hdrive_mbs.__version__}.tar.gz) or check out the repository, and run this command in its folder. "
        f"Looked in {' and '.join(str(place) for place in dict.fromkeys(places))}."
    )


def modules_in(root: Path) -> dict[str, str]:
    """Name -> module of every benchmark there."""
    found = {path.parent.name: f"benchmarks.{path.parent.name}" for path in (root / "benchmarks").glob("*/__main__.py")}
    if (root / "benchmarks" / "speed" / "train.py").is_file():
        found["speed"] = "benchmarks.speed.train"
    return dict(sorted(found.items()))

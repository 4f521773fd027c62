"""Makes the pictures of the gallery:  python docs/gallery/make.py [--into FOLDER] [NAME ...]

Every other script of this folder has a function ``make()`` that returns axes of one figure.
"""

from __future__ import annotations

import argparse
import contextlib
import functools
import importlib.util
import io
import re
import runpy
import sys
import tempfile
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1]))

from matplotlib.axes import Axes  # noqa: E402
from PIL import Image  # noqa: E402

DOTS_PER_INCH = 110


def names() -> list[str]:
    """Scripts of the gallery."""
    return sorted(path.stem for path in HERE.glob("*.py") if path.stem != "make")


def drawn(name: str) -> Axes:
    """Axes that a script makes."""
    spec = importlib.util.spec_from_file_location(f"gallery_{name}", HERE / f"{name}.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    axes = module.make()
    assert isinstance(axes, Axes)
    return axes


MARK = "-- next block --"


@functools.cache
def run(page: str) -> tuple[dict[str, Any], list[str]]:
    """What the Python code of a page of docs/tutorials/ leaves behind when it is run from top to bottom, and what each block prints."""
    text = (HERE.parent / "tutorials" / f"{page}.md").read_text("utf-8")
    code = f'print("{MARK}")\n'.join(re.findall(r"^```python\n(.*?)^```$", text, re.S | re.M))
    printed = io.StringIO()
    with tempfile.TemporaryDirectory() as folder, contextlib.chdir(folder), contextlib.redirect_stdout(printed):
        Path("page.py").write_text(code, "utf-8")
        left = runpy.run_path("page.py")
    return left, printed.getvalue().split(f"{MARK}\n")


def ran(page: str) -> dict[str, Any]:
    """What the Python code of a page of docs/tutorials/ leaves behind."""
    return run(page)[0]


def picture(axes: Axes) -> Image.Image:
    """The figure of these axes in 256 colours."""
    buffer = io.BytesIO()
    axes.figure.savefig(buffer, format="png", dpi=DOTS_PER_INCH, metadata={"Software": None})
    with Image.open(buffer) as full:
        return full.convert("RGB").quantize(256, dither=Image.Dither.NONE)


def saved(name: str, folder: Path) -> Path:
    """Picture of a script as PNG; without a date, so that the same picture gives the same file."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{name}.png"
    picture(drawn(name)).save(path, optimize=True)
    return path


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(names())}; all if not given")
    parser.add_argument("--into", type=Path, default=HERE / "pictures", metavar="FOLDER")
    given = parser.parse_args()
    for name in given.names or names():
        print(saved(name, given.into))


if __name__ == "__main__":
    main()

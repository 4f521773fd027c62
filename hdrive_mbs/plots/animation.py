"""``animate(result, path)``: one function for all moving pictures; each type's picture is in a file of its own."""

from __future__ import annotations

import functools
import os
from pathlib import Path
from typing import Any

from hdrive_mbs.errors import AnalysisError


@functools.singledispatch
def animate(result: Any, path: str | os.PathLike[str], **options: Any) -> Path:
    """Write a result in motion to a file; its ending chooses GIF, HTML or MP4 (see ``plots/recording.py``).

    A Response or RunUp is drawn as its rotor line or as its gear (``plots/response_animation.py``), a wave gear as its
    meshing teeth.  Raises AnalysisError for something that has no moving picture.
    """
    known = sorted(kind.__name__ for kind in animate.registry if kind is not object)
    raise AnalysisError(f"There is no moving picture of a {type(result).__name__}. There are some of: {', '.join(known)}.")

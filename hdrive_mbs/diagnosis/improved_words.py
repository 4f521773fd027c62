"""What is to be known of the improved scene before it is run: whose inputs it holds, and which files its effects are from."""

from __future__ import annotations

import sys
from pathlib import Path

import hdrive_mbs
from hdrive_mbs.diagnosis.readable import listed
from hdrive_mbs.diagnosis.result import Diagnosis


def improved_words(diagnosis: Diagnosis) -> tuple[str, ...]:
    """Sentences for the report and the head of the scene file; none where the scene can be run as it is."""
    found = []
    if diagnosis.inputs:
        driven = listed([f"{path} (driven by column {column!r})" for column, path in diagnosis.inputs.items()])
        found.append(
            f"The improved scene holds {driven} as the bench file has {'it' if len(diagnosis.inputs) == 1 else 'them'}, not as in a record:"
            " where that is zero, 'hdrive-mbs run improved.toml' gives zeros. Put a course in, or take that of a record in Python:"
            " improved.replacing({path: bench.inputs[column].law(times, values)})."
        )
    files = own_files(diagnosis)
    if files:
        options = " ".join(f"--effects {file}" for file in files)
        found.append(f"The improved scene has effects of your own: hdrive-mbs run improved.toml {options}")
    return tuple(found)


def own_files(diagnosis: Diagnosis) -> tuple[str, ...]:
    """Names of the files that define effects of the improved scene and are not of the library."""
    modules = [type(item.effect).__module__ for item in diagnosis.improved.effects]
    own = [name for name in dict.fromkeys(modules) if name.partition(".")[0] != hdrive_mbs.__name__]
    return tuple(Path(getattr(sys.modules.get(name), "__file__", None) or f"{name}.py").name for name in own)

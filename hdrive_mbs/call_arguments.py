"""Whether a function of the user's own takes the arguments that it is called with."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Sequence
from typing import Any

WORDS = {"time": "time", "t": "time", "speed": "speed", "w": "speed", "omega": "speed", "angle": "angle", "twist": "twist"}
"""What a name of an argument says that it is."""


def cannot_be_called(function: Callable[..., Any], ways: Sequence[Sequence[str]]) -> str:
    """What is wrong, and the way out, where a function takes the arguments of none of these ways; empty where it does or none is given."""
    if not ways:
        return ""
    try:
        signature = inspect.signature(function)
    except (TypeError, ValueError):  # one that is compiled tells nothing
        return ""
    for arguments in ways:
        try:
            signature.bind(*arguments)
        except TypeError:
            continue
        return _in_other_words(signature, ways)
    listed = " or ".join(f"({', '.join(arguments)})" for arguments in ways)
    return (
        f"takes {signature} but is called with {listed}. Give a function of these; what else it needs "
        "functools.partial or a default value holds."
    )


def _in_other_words(signature: inspect.Signature, ways: Sequence[Sequence[str]]) -> str:
    """Where the names of the arguments say something else than what they get: a function of ``time`` that would be given the speed."""
    needed = [item.name for item in signature.parameters.values() if item.default is item.empty]
    offered = {argument for arguments in ways for argument in arguments}
    for arguments in ways:
        if len(arguments) == len(needed):
            for name, given in zip(needed, arguments, strict=True):
                if WORDS.get(name.lower()) in offered - {given}:
                    called = f"takes {signature} but is called with ({', '.join(arguments)}), so {name!r} would get the {given}"
                    return f"{called}. Give one of {' or '.join('(' + ', '.join(way) + ')' for way in ways)}."
    return ""

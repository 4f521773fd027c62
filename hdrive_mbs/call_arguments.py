"""Whether a function of the user's own takes the arguments that it is called with."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Sequence
from typing import Any


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
            return ""
        except TypeError:
            continue
    listed = " or ".join(f"({', '.join(arguments)})" for arguments in ways)
    return (
        f"takes {signature} but is called with {listed}. Give a function of these; what else it needs "
        "functools.partial or a default value holds."
    )

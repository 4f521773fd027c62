"""Errors of the package.  Each names the object, the value with its unit, the limit and the way out."""

from __future__ import annotations

import difflib
from collections.abc import Iterable


class HdriveError(Exception):
    """Base of every error that this package raises on purpose."""


class ParameterError(HdriveError, ValueError):
    """A parameter value is outside what its law or part allows."""


class KeywordError(HdriveError, TypeError):
    """A part, law or effect has no such field, or its values are not given by name."""


class UnitError(HdriveError, ValueError):
    """A unit is unknown or does not fit the quantity."""


class PlaceError(HdriveError, KeyError):
    """A place, part, parameter or channel does not exist, or is of the wrong kind."""

    def __str__(self) -> str:
        return str(self.args[0]) if self.args else ""


class SceneError(HdriveError, ValueError):
    """The parts of a scene do not form a model that can be solved."""


class LawError(HdriveError, ValueError):
    """A law breaks what it claims (restoring, passive) or its lowered form differs from it."""


class FileFormatError(HdriveError, ValueError):
    """A file is truncated, foreign, or does not say what the reader needs."""


class RecordError(HdriveError, ValueError):
    """A measured record has gaps, wrong units or other faults that would change results."""


class SimulationError(HdriveError, RuntimeError):
    """A run diverged, stopped early or could not be started."""


class AnalysisError(HdriveError, RuntimeError):
    """An analysis has no defensible answer for this scene."""


class DependencyError(HdriveError, ImportError):
    """An optional package is missing; the text has the command that installs it."""


LISTED = 40
"""Names that an error lists; of more than that only those that are spelt alike, and how many there are."""


def meant(name: str, known: Iterable[str]) -> str:
    """`` Did you mean 'gear'?`` for a name that is spelt like one of the known ones, else nothing."""
    return "".join(f" Did you mean {one!r}?" for one in difflib.get_close_matches(str(name), list(known), 1, 0.7))


def unknown_place(kind: str, name: str, known: Iterable[str], owner: str = "This scene") -> PlaceError:
    """A PlaceError of the form ``No place 'gaer'. This scene has: motor, gear. Did you mean 'gear'?``"""
    names = list(known)
    if len(names) <= LISTED:
        near = meant(name, names) if len(names) > 1 else ""
        return PlaceError(f"No {kind} {name!r}. {owner} has: {', '.join(names) or 'none'}.{near}")
    alike = list(dict.fromkeys([*difflib.get_close_matches(name, names, 8, 0.5), *(one for one in names if one.startswith(f"{name}."))]))
    few = alike[:16] or names[:16]
    which = "like it" if alike else "for instance"
    return PlaceError(f"No {kind} {name!r}. {owner} has {len(names)}, {which}: {', '.join(few)}.")

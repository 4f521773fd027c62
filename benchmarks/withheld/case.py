"""One withheld case: its records and what was put in."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Column:
    """A measured channel or an input: values in ``unit``; ``single`` stores them with 32 bits."""

    name: str
    unit: str
    values: Array
    single: bool = False


@dataclass(frozen=True, kw_only=True)
class Cause:
    """Something a case can hold.

    ``kind`` is one of KINDS; ``places`` are the admissible ones in the words of the answer format.
    A cause that has no name there (kind ``unlisted``) is answered ``unknown``; its own name shows in ``put_in`` only.
    """

    name: str
    places: tuple[str, ...]
    kind: str = "effect"


@dataclass(frozen=True, kw_only=True)
class Case:
    """Records by name, and the truth in the form of ``truth.json``."""

    records: Mapping[str, Sequence[Column]]
    truth: Sequence[Mapping[str, Any]]  # one object a cause: {"effect", "at", ...sizes}
    put_in: Mapping[str, Any]  # the sizes in the plant's own symbols
    true_parameters: Mapping[str, float]  # with a wrong parameter already in them
    more: Mapping[str, Any] = field(default_factory=dict)  # detectability, finer detail, noise

    def labels(self, name: str) -> dict[str, Any]:
        """The content of ``truth.json``."""
        return {
            "case": name,
            "truth": [dict(item) for item in self.truth],
            "put_in": dict(self.put_in),
            "true_parameters": dict(self.true_parameters),
            **self.more,
        }


KINDS = ("null", "effect", "parameter", "sensor", "unlisted", "pair")

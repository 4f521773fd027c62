"""Unit, meaning and range of a number, and what is said of one that is out of it."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.errors import ParameterError


class UnusualValueWarning(UserWarning):
    """A value that is allowed and yet looks as if it were in another unit."""


@dataclass(frozen=True, kw_only=True)
class Quantity:
    """Unit, meaning and allowed range of one field.

    typical : where a search for its value begins
    usual : range outside of which a value other than 0 is taken and warned of;  hint : what it may be then
    """

    unit: str
    doc: str
    low: float | None = None
    high: float | None = None
    above: float | None = None
    sequence: bool = False
    typical: tuple[float, float] | None = None
    usual: tuple[float, float] | None = None
    hint: str = ""

    def __post_init__(self) -> None:
        if self.typical is None:
            return
        first, last = self.typical
        for end in (first, last):
            self.check(f"The typical range ({first:g}, {last:g}): {end:g}", end)
        if not first < last:
            raise ParameterError(f"The typical range ({first:g}, {last:g}) of {self.doc!r} must rise.")

    def allows(self, value: float) -> bool:
        """Whether the value is finite and in range."""
        return (
            math.isfinite(value)
            and (self.above is None or value > self.above)
            and (self.low is None or value >= self.low)
            and (self.high is None or value <= self.high)
        )

    def is_usual(self, value: float) -> bool:
        """Whether the value is one that is not warned of."""
        return self.usual is None or value == 0.0 or self.usual[0] <= value <= self.usual[1]

    def allows_all(self, values: npt.NDArray[np.float64]) -> bool:
        """Whether all values, one at least, are finite and in range and none is to be warned of, as far as that is known at a glance."""
        ends = float(np.min(values)), float(np.max(values))  # NaN comes out of both
        return self.usual is None and all(self.allows(value) for value in ends)

    def check(self, where: str, value: float, stacklevel: int = 4) -> None:
        """Raise ParameterError when the value is not finite or out of range; warn of one that is unusual.

        stacklevel : of the warning; 1 names the caller, 4 who makes an object with the field
        """
        if self.allows(value):
            if not self.is_usual(value):
                said = f"{where} = {value:g} {self.unit} is unusual ({self.doc}): {self.hint}"
                warnings.warn(said, UnusualValueWarning, stacklevel=stacklevel + 1)
            return
        unit = "" if self.unit == "1" else f" {self.unit}"
        if not math.isfinite(value):
            raise ParameterError(f"{where} = {value}{unit}: must be a finite number ({self.doc}).")
        limits = (
            (self.above is not None and value <= self.above, f"must be greater than {self.above}{unit}"),
            (self.low is not None and value < self.low, f"must be at least {self.low}{unit}"),
            (self.high is not None and value > self.high, f"must be at most {self.high}{unit}"),
        )
        for broken, limit in limits:
            if broken:
                raise ParameterError(f"{where} = {value:g}{unit}: {limit} ({self.doc}).")

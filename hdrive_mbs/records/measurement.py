"""One measured channel in SI units."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass

import numpy as np

from hdrive_mbs.errors import ParameterError
from hdrive_mbs.signals import FloatArray


@dataclass(frozen=True, kw_only=True, eq=False)
class Measurement:
    """Values of one channel at the times of its record.

    name : as in the file
    unit : SI
    values : shape (n,), read-only
    quantity : channel of the scene that it measures, like "motor.speed"; None if not said
    noise : standard deviation of white noise [unit], before rounding; None if not known
    resolution : step of rounding [unit]; None if not known
    given : unit as it was written in the file or by the caller; empty if not known
    """

    name: str
    unit: str
    values: FloatArray
    quantity: str | None = None
    noise: float | None = None
    resolution: float | None = None
    given: str = ""

    def __post_init__(self) -> None:
        values = np.array(self.values, dtype=float)
        if values.ndim != 1:
            raise ParameterError(f"Channel {self.name!r}: values of shape {values.shape} must be flat, one for each time.")
        values.flags.writeable = False
        object.__setattr__(self, "values", values)
        for what, size in (("noise", self.noise), ("resolution", self.resolution)):
            if size is not None and not (math.isfinite(size) and size >= 0.0):
                raise ParameterError(f"Channel {self.name!r}: {what} = {size:g} {self.unit} must be finite and at least 0 {self.unit}.")

    @property
    def unit_as_read(self) -> str:
        """Unit, for errors: as it was written, with what became of it."""
        shown = self.unit if self.unit != "1" else "no unit (1)"
        return shown if self.given in ("", self.unit) else f"{self.given!r}, which is read as {shown}"

    def __len__(self) -> int:
        return len(self.values)

    @property
    def floor(self) -> float | None:
        """Standard deviation of noise and rounding together [unit]: sqrt(noise^2 + resolution^2/12).

        None where neither is known.  Rounding counts as even and independent from sample to sample,
        which it is not for a signal that moves by less than one step between samples.
        """
        if self.noise is None and self.resolution is None:
            return None
        return math.hypot(self.noise or 0.0, (self.resolution or 0.0) / math.sqrt(12.0))

    def replacing(self, **changes: object) -> Measurement:
        """A copy with fields changed."""
        return dataclasses.replace(self, **changes)  # type: ignore[arg-type]

    def __repr__(self) -> str:
        finite = self.values[np.isfinite(self.values)]
        unit = "" if self.unit == "1" else f" {self.unit}"
        span = f"{finite.min():.6g} to {finite.max():.6g}{unit}" if len(finite) else "no finite value"
        to = f" -> {self.quantity}" if self.quantity else ""
        floor = "" if self.floor is None else f", floor {self.floor:.3g}{unit}"
        return f"{self.name} [{self.unit}]{to}: {len(self)} values, {span}{floor}"

"""What a column of a record measures, and how well."""

from __future__ import annotations

import math
from dataclasses import dataclass

from hdrive_mbs.errors import ParameterError


@dataclass(frozen=True, kw_only=True)
class Measured:
    """A measured column.

    channel : channel of the scene that it measures
    noise : standard deviation of its white noise, in the channel's unit
    resolution : step of its rounding, which acts as a uniform error of one step (variance step^2/12)
    coloured : standard deviation of first-order coloured noise, and what one sample keeps of the one before
    offset : standard deviation of an offset that each record draws anew; inf where nothing is known of it
    late : share of a sample by which the column is to be compared later (0.5: a value held from its sample on)

    Raises ParameterError for a channel without any noise or rounding: its misfit would have no scale.
    """

    channel: str
    noise: float = 0.0
    resolution: float = 0.0
    coloured: tuple[float, float] = (0.0, 0.0)
    offset: float = 0.0
    late: float = 0.0

    def __post_init__(self) -> None:
        sigma, kept = self.coloured
        values = (self.noise, self.resolution, sigma, self.offset)
        if any(math.isnan(v) or v < 0.0 for v in values) or not 0.0 <= kept < 1.0 or self.late not in (0.0, 0.5):
            raise ParameterError(
                f"Channel {self.channel!r}: noise, resolution, coloured noise and offset must be at least 0, a coloured sample keeps"
                f" 0 to 1 of the one before, and late is 0 or 0.5; got {self}."
            )
        if not self.white > 0.0:
            raise ParameterError(f"Channel {self.channel!r} has neither noise nor resolution: give the noise of its sensor, in its unit.")

    @property
    def white(self) -> float:
        """Standard deviation of white noise and rounding together."""
        return math.hypot(self.noise, self.resolution / math.sqrt(12.0))

    @property
    def total(self) -> float:
        """Standard deviation of all its noise, without the offset."""
        return math.hypot(self.white, self.coloured[0])

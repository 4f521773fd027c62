"""Figures of histories: numbers by name, which print with their unit."""

from __future__ import annotations


class Summary(dict[str, float]):
    """Smallest, largest, mean, rms and last value of a history.

    unit : of each of them
    """

    def __init__(self, unit: str, figures: dict[str, float]) -> None:
        super().__init__(figures)
        self.unit = unit

    def __repr__(self) -> str:
        unit = "" if self.unit in ("", "1") else f" {self.unit}"
        return ", ".join(f"{name} {value:.6g}{unit}" for name, value in self.items())


class ChannelSummaries(dict[str, Summary]):
    """The figures of each channel, printed one channel a line."""

    def __repr__(self) -> str:
        width = max(map(len, self), default=0)
        return "\n".join(f"{name:<{width}}  {figures}" for name, figures in self.items())

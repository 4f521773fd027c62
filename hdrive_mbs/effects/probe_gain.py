"""A displacement probe with a wrong gain."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from hdrive_mbs.effects.sensor_gain import SensorGain
from hdrive_mbs.expression import Value
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class ProbeGain(SensorGain):
    """A displacement reading that is off by a factor, which may change with the gap.

    seen = (1 + g + c x) x

    Source: calibration curve of an eddy-current probe to second order (API Standard 670, scale factor).  Leaves out the
    change with temperature and material.  x is the displacement from the line of the bearings, not from the probe.
    """

    curvature: float = parameter("1/m", "c, change of the gain with displacement", default=0.0, low=-1e5, high=1e5)

    acts_on: ClassVar[str] = "probe"
    family: ClassVar[str] = "probe_gain"
    signature: ClassVar[str] = "one probe off by a factor at all speeds and orders while its neighbour across fits"

    def reading(self, time: Value, value: Value) -> Value:
        return (1.0 + self.error + (self.curvature * value if self.curvature != 0.0 else 0.0)) * value

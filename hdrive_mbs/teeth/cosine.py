"""The elliptical cosine law."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Self

import numpy as np

from hdrive_mbs.errors import ParameterError
from hdrive_mbs.quantities import parameter
from hdrive_mbs.teeth.deformation import DeformationLaw, FloatArray


@dataclass(frozen=True, kw_only=True)
class CosineDeformation(DeformationLaw):
    """A cam that makes the fibre an ellipse, to first order:  w = w0 cos(U s),  U = 2 waves.

    From it follow  v = -(w0/U) sin(U s)  and  theta = (w0/r0) (U - 1/U) sin(U s), for two waves
    -(w0/2) sin 2s and (3 w0/2 r0) sin 2s.

    Source: seed I (the triple w, v, theta), M. N. Ivanov, Volnovye zubchatye peredachi (Wave gears),
    Moscow 1981.  Leaves out the difference between an ellipse and this curve, of the order w0^2/r0.
    """

    amplitude: float = parameter("m", "w0, radial displacement on the major axis", above=0.0, high=0.1)
    number_of_waves: int = parameter("1", "U, waves around the circumference", default=2, low=2, high=8)

    def check(self) -> None:
        if self.number_of_waves != int(self.number_of_waves):
            raise ParameterError(f"CosineDeformation.number_of_waves = {self.number_of_waves:g}: must be a whole number, usually 2.")
        object.__setattr__(self, "number_of_waves", int(self.number_of_waves))
        super().check()

    def radial(self, angle: FloatArray) -> FloatArray:
        return np.asarray(self.amplitude * np.cos(self.number_of_waves * np.asarray(angle, float)), float)

    def scaled(self, amplitude: float) -> Self:
        return self.replacing(amplitude=amplitude)

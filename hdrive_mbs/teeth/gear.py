"""What every wave gear offers: stages, ratio and senses, clearances, what the dynamics need."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from hdrive_mbs.errors import ParameterError
from hdrive_mbs.quantities import Described
from hdrive_mbs.teeth.amplitude_window import AmplitudeWindow, amplitude_window
from hdrive_mbs.teeth.clearance import Clearances, clearances
from hdrive_mbs.teeth.explain import explain_clearances
from hdrive_mbs.teeth.kinematics import GENERATOR, Mesh, ratio, speeds
from hdrive_mbs.teeth.stage import Stage


@dataclass(frozen=True, kw_only=True)
class WaveGear(Described):
    """A gear with a wave generator, a flexspline and one or two rigid wheels."""

    _kind = "wave gear"
    output: ClassVar[str] = ""
    """The member that drives the machine when the circular spline is held."""

    def stages(self) -> tuple[Stage, ...]:
        """Pairs of conjugated wheels, from the input on."""
        raise NotImplementedError

    @property
    def members(self) -> tuple[str, ...]:
        """Names of what can turn."""
        return tuple(dict.fromkeys((GENERATOR, *(name for mesh in self.meshes() for name in (mesh[0], mesh[2])))))

    def meshes(self) -> tuple[Mesh, ...]:
        """Members and teeth of each mesh."""
        raise NotImplementedError

    # -- kinematics ---------------------------------------------------------------------------------
    def speeds(self, *, driver: str = GENERATOR, fixed: str = "circular_spline") -> dict[str, float]:
        """Speed of every member per speed of the driver, another member held; negative turns backwards."""
        return speeds(self.meshes(), driver=driver, fixed=fixed)

    def ratio_of(self, driver: str, driven: str, fixed: str) -> float:
        """Driver speed over driven speed, negative when they turn against each other."""
        return ratio(self.speeds(driver=driver, fixed=fixed), driven)

    @property
    def ratio(self) -> float:
        """i = generator speed over output speed with the circular spline held, with its sign."""
        return self.ratio_of(GENERATOR, self.output, "circular_spline")

    # -- teeth ----------------------------------------------------------------------------------------
    def clearances(self) -> tuple[Clearances, ...]:
        """Clearances of each stage over a turn of the generator."""
        return tuple(clearances(stage) for stage in self.stages())

    @property
    def interferes(self) -> bool:
        return any(result.interferes for result in self.clearances())

    def check_interference(self) -> None:
        """Raise ParameterError with the reason if teeth enter each other."""
        if self.interferes:
            raise ParameterError(f"The teeth of this gear interfere. {self.explain()}")

    def explain(self) -> str:
        """In words, stage by stage: why the teeth do or do not go together, and what to change."""
        return " ".join(explain_clearances(result) for result in self.clearances())

    # -- into the dynamics ---------------------------------------------------------------------------
    def gains(self) -> tuple[float, ...]:
        """Turn of the output per relative turn in each stage, generator and circular spline held."""
        raise NotImplementedError

    @property
    def lost_motion(self) -> float:
        """Full width [rad] of the lost motion at the output, from the flank clearances of all stages."""
        return float(sum(abs(gain) * result.lost_motion for gain, result in zip(self.gains(), self.clearances())))

    def amplitude_window(self) -> AmplitudeWindow:
        """Range of w0 [m] around the present one in which no stage interferes, and what stops it."""
        windows = [amplitude_window(stage) for stage in self.stages()]
        low = max((window.low, window.reason_low) for window in windows)
        high = min((window.high, window.reason_high) for window in windows)
        return AmplitudeWindow(low=low[0], high=high[0], reason_low=low[1], reason_high=high[1])

    def loaded_teeth(self, windup: float, forward: bool = True) -> tuple[float, ...]:
        """Teeth in contact in each stage when each mesh has wound up by windup [rad] after its first contact."""
        return tuple(result.loaded_teeth(windup, forward) for result in self.clearances())

    def stiffness_factors(self, windup: float, forward: bool = True) -> tuple[float, ...]:
        """Secant mesh stiffness of each stage over that with all overlapping teeth carrying, at a wind-up [rad] after first contact."""
        if windup <= 0.0:
            raise ParameterError(f"windup = {windup:g} rad: must be greater than 0 rad.")
        return tuple(result.stiffness_factor(windup, forward) for result in self.clearances())

    def mesh_stiffness_factor(self, windup: float, forward: bool = True) -> float:
        """The stages' factors in series, referred to the output:  sum(g^2) / sum(g^2/f)  for stages of equal full stiffness."""
        gains = np.square(self.gains())
        return float(np.sum(gains) / np.sum(gains / np.array(self.stiffness_factors(windup, forward))))

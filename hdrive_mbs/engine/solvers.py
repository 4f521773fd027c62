"""Time integrators, as settings.  A solver of a user's own subclasses Solver and sets the engine's fields."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, ClassVar

import exudyn as exu

from hdrive_mbs.errors import ParameterError
from hdrive_mbs.quantities import Described, parameter

CONTRACTIVITY = 0.05
"""Newton's method takes a new Jacobian where an iteration gains less than this factor: a rotor that speeds up changes it."""


@dataclass(frozen=True, kw_only=True)
class Solver(Described):
    """A time integrator."""

    _kind: ClassVar[str] = "solver"
    order: ClassVar[int]
    """Order of convergence of the global error on smooth problems."""
    adaptive: ClassVar[bool] = False

    def configure(self, settings: Any, duration: float) -> Any:
        """Fill exudyn's settings; returns the exudyn solver type."""
        raise NotImplementedError

    def refined(self) -> Solver:
        """The next finer setting, for an error estimate by comparison."""
        raise NotImplementedError


@dataclass(frozen=True, kw_only=True)
class DormandPrince(Solver):
    """Adaptive explicit Runge-Kutta 5(4) of Dormand and Prince (1980): the default.

    Best for trains: nothing has to be tuned, and with symbolic laws it is the fastest on the engine.
    The relative tolerance counts against the largest coordinates, in a drive those of the motor; its
    default is set so that a small vibration of the slow side comes out too.
    """

    relative_tolerance: float = parameter("1", "relative tolerance of a step", default=1e-8, above=0.0)
    absolute_tolerance: float = parameter("1", "absolute tolerance of a step (rad, rad/s)", default=1e-10, above=0.0)
    max_step: float = parameter("s", "longest step", default=1e-2, above=0.0)
    first_step: float = parameter("s", "first step that is tried", default=1e-6, above=0.0)
    max_steps: float = parameter("1", "trial steps after which a run is given up (a law that jumps chatters)", default=5e6, above=0.0)

    order = 5
    adaptive = True

    def configure(self, settings: Any, duration: float) -> Any:
        integration = settings.timeIntegration
        integration.automaticStepSize = True
        integration.relativeTolerance = self.relative_tolerance
        integration.absoluteTolerance = self.absolute_tolerance
        integration.numberOfSteps = max(1, math.ceil(duration / self.max_step))
        integration.minimumStepSize = 1e-14
        # exudyn would try max_step first; where that overflows its error is NaN, and NaN passes as accepted
        integration.initialStepSize = min(self.first_step, self.max_step, duration)
        return exu.DynamicSolverType.DOPRI5

    def refined(self) -> DormandPrince:
        return self.replacing(
            relative_tolerance=max(self.relative_tolerance / 32.0, 1e-13),
            absolute_tolerance=max(self.absolute_tolerance / 32.0, 1e-15),
        )


@dataclass(frozen=True, kw_only=True)
class FixedStep(Solver):
    """A solver with a constant step."""

    step: float = parameter("s", "constant step", above=0.0)

    def steps(self, settings: Any, duration: float) -> None:
        if self.step > duration:
            raise ParameterError(f"{type(self).__name__}.step = {self.step:g} s is longer than the run of {duration:g} s; shorten it.")
        settings.timeIntegration.automaticStepSize = False
        settings.timeIntegration.numberOfSteps = max(1, math.ceil(duration / self.step * (1.0 - 1e-12)))

    def refined(self) -> Solver:
        return self.replacing(step=self.step / 2.0)


@dataclass(frozen=True, kw_only=True)
class RungeKutta4(FixedStep):
    """The classical explicit Runge-Kutta method of order 4 with a constant step."""

    order = 4

    def configure(self, settings: Any, duration: float) -> Any:
        self.steps(settings, duration)
        return exu.DynamicSolverType.RK44


@dataclass(frozen=True, kw_only=True)
class Implicit(FixedStep):
    """An implicit solver: no limit from stiffness, but no error control either (see estimate_error)."""

    newton_tolerance: float = parameter("1", "relative tolerance of Newton's method", default=1e-10, above=0.0)

    order = 2

    def implicit(self, settings: Any, duration: float) -> None:
        self.steps(settings, duration)
        newton = settings.timeIntegration.newton
        newton.useModifiedNewton = True
        newton.modifiedNewtonContractivity = CONTRACTIVITY
        newton.relativeTolerance = self.newton_tolerance
        newton.numericalDifferentiation.forODE2 = True


@dataclass(frozen=True, kw_only=True)
class Trapezoidal(Implicit):
    """Implicit trapezoidal rule (Newmark beta 1/4, gamma 1/2): order 2, no numerical damping."""

    def configure(self, settings: Any, duration: float) -> Any:
        self.implicit(settings, duration)
        return exu.DynamicSolverType.TrapezoidalIndex2


@dataclass(frozen=True, kw_only=True)
class GeneralizedAlpha(Implicit):
    """Generalised-alpha method of Chung and Hulbert (1993): order 2, damps the highest frequencies."""

    spectral_radius: float = parameter("1", "spectral radius at infinite frequency", default=0.9, low=0.0, high=1.0)

    def configure(self, settings: Any, duration: float) -> Any:
        self.implicit(settings, duration)
        settings.timeIntegration.generalizedAlpha.spectralRadius = self.spectral_radius
        return exu.DynamicSolverType.GeneralizedAlpha

"""The harmonic (strain-wave) drive as a torsional element with three flanges."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from hdrive_mbs.components.component import Component, Flange
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.expression import Value
from hdrive_mbs.flexsplines.law import StiffnessFunction, StiffnessLaw
from hdrive_mbs.network.connection_draft import Torque
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.quantities import option, parameter
from hdrive_mbs.teeth.gear import WaveGear


@dataclass(frozen=True, kw_only=True)
class HarmonicDrive(Component):
    """Wave generator, flexspline and circular spline joined by the nonlinear flexspline stiffness.

    With the signed ratio i = -u (output turns backwards) the ideal drive keeps
    w_fs = w_wg / i + (1 - 1/i) w_cs.  The twist in the forward sense of the output is, for a held
    circular spline, phi = phi_wg/u - phi_fs, and the torque through the mesh
    T = M(phi) + B_FS dphi/dt acts by virtual work: T/u against the wave generator, T along the
    flexspline, and (1 + 1/u) T on the circular spline, so the three reactions sum to zero.

    Source: seed F (2)-(3); u there is the absolute value of the ratio, the flexspline turns against
    the wave generator (its Fig. 2).  A circular spline to which nothing is connected is held by
    the ground; its reaction is the channel ``<name>.housing_torque``.
    """

    ratio: float = parameter("1", "u, absolute value of the ratio with the circular spline held", above=1.0)
    stiffness: StiffnessLaw | Callable[[Value], Value] = option(
        "law of the elastic torque M(twist), like hm.LinearStiffness(constant=8e3), or a function of the twist", called_with=(("twist",),)
    )
    damping: float = parameter("N m s/rad", "damping B_FS on the rate of twist", default=0.0, low=0.0)
    damping_in_gap: bool = option("whether B_FS acts inside the lost motion too (as (2)-(3) have it)", default=True)
    wave_generator_inertia: float = parameter("kg m^2", "J_WG", default=0.0, low=0.0)
    flexspline_inertia: float = parameter("kg m^2", "J_FS", default=0.0, low=0.0)
    circular_spline_inertia: float = parameter("kg m^2", "inertia of a circular spline that can turn", default=0.0, low=0.0)
    output_sense: str = option("'opposite' (flexspline against wave generator) or 'same'", default="opposite")
    teeth: WaveGear | None = option("gear geometry that ratio and sense belong to; refused if its teeth interfere", default=None)

    entry = "wave_generator"
    exit = "flexspline"

    def check(self) -> None:
        if not isinstance(self.stiffness, StiffnessLaw):
            object.__setattr__(self, "stiffness", StiffnessFunction(function=self.stiffness))
        self.law.check_restoring()
        if not self.damping_in_gap and self.damping > 0.0 and self.law.half_gap == 0.0 and self.law.is_slack():
            raise ParameterError(
                "HarmonicDrive.damping_in_gap = False: the stiffness gives no torque about zero twist but names no gap, so the damping "
                "cannot leave one out. Use a law with lost_motion, or write a StiffnessLaw with the property half_gap [rad]."
            )
        if self.output_sense not in ("opposite", "same"):
            raise ParameterError(f"HarmonicDrive.output_sense = {self.output_sense!r}: must be 'opposite' or 'same'.")
        if self.teeth is not None:
            if not isinstance(self.teeth, WaveGear):
                raise ParameterError(f"HarmonicDrive.teeth = {self.teeth!r}: must be a gear geometry, e.g. a HarmonicGear or None.")
            self._check_teeth(self.teeth)

    def _check_teeth(self, gear: WaveGear) -> None:
        if abs(gear.ratio - self.signed_ratio) > 1e-9 * self.ratio:
            raise ParameterError(
                f"HarmonicDrive.ratio = {self.ratio:g} ({self.output_sense}) does not belong to the teeth, which give {gear.ratio:g}. "
                "Build the drive with HarmonicDrive.from_gear, which takes ratio and sense from the teeth."
            )
        gear.check_interference()

    @classmethod
    def from_gear(cls, gear: WaveGear, **fields: Any) -> Self:
        """A drive with the ratio and sense of a gear's teeth; ``fields`` are the others (stiffness, damping, inertias).

        The flange ``flexspline`` is the gear's output: the flexspline, or wheel 4 of a double harmonic
        gear.  ``gear.lost_motion`` and ``gear.mesh_stiffness_factor`` go into the stiffness law,
        ``tooth_errors(gear, ...)`` gives effects.  Raises ParameterError for a gear that interferes.
        """
        sense = "opposite" if gear.ratio < 0.0 else "same"
        return cls(ratio=abs(gear.ratio), output_sense=sense, teeth=gear, **fields)

    @property
    def law(self) -> StiffnessLaw:
        """The stiffness as a law object."""
        assert isinstance(self.stiffness, StiffnessLaw)
        return self.stiffness

    @property
    def signed_ratio(self) -> float:
        """i = w_wg / w_fs with the circular spline held: -u, or +u for output_sense='same'."""
        return -self.ratio if self.output_sense == "opposite" else self.ratio

    def flanges(self) -> tuple[Flange, ...]:
        return (
            Flange(name="wave_generator", inertia=self.wave_generator_inertia),
            Flange(name="flexspline", inertia=self.flexspline_inertia),
            Flange(name="circular_spline", inertia=self.circular_spline_inertia, optional=True),
        )

    def relations(self) -> tuple[dict[str, float], ...]:
        i = self.signed_ratio
        return ({"wave_generator": 1.0 / i, "circular_spline": 1.0 - 1.0 / i, "flexspline": -1.0},)

    def build(self, name: str, draft: Draft) -> None:
        ends = {flange: draft.body(f"{name}.{flange}") for flange in ("wave_generator", "flexspline", "circular_spline")}
        (relation,) = self.relations()
        forward = np.sign(relation["wave_generator"]) * ends["wave_generator"].sense
        factors: dict[str, float] = {}
        for flange, node in ends.items():
            factors[node.name] = factors.get(node.name, 0.0) + float(forward * relation[flange] * node.sense)
        connection = draft.add_connection(
            name,
            factors,
            self._torque(),
            aliases=(f"{name}.mesh",),
            bodies={flange: node.name for flange, node in ends.items()},
            gap=2.0 * self.law.half_gap,
        )
        ring = ends["circular_spline"]

        def housing(moment: Moment) -> Value:
            """True-sense torque that the mesh puts on the circular spline and so on its housing."""
            return ring.sense * connection.build().contribution(moment)[ring.name]

        draft.add_channel(f"{name}.housing_torque", "N m", f"torque on the circular spline of {name}, true sense", housing)

    def _torque(self) -> Torque:
        law, damping, half_gap = self.law.torque, self.damping, self.law.half_gap
        if self.damping_in_gap or damping == 0.0 or half_gap == 0.0:
            return lambda moment, twist, rate: law(twist) + damping * rate
        return lambda moment, twist, rate: law(twist) + np.where(np.abs(twist) > half_gap, damping * rate, 0.0)

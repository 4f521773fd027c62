"""What is planted into the joint: one case each, with the answer that would be right."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from benchmarks.flagship.plant import ARM, DISC, Friction, Joint, Ripple, sliders


@dataclass(frozen=True)
class Planted:
    """A case.

    right : (verdict, effect, place) that names the cause
    fields : of the plant;  factors : of numbers that are off by more than their tolerance
    said : what is planted, in words
    """

    name: str
    right: tuple[str, str, str]
    said: str
    fields: Mapping[str, Any] = field(default_factory=dict)
    factors: Mapping[str, float] = field(default_factory=dict)

    def joint(self, values: Mapping[str, float]) -> Joint:
        """A specimen with these numbers and the cause in it."""
        numbers = {name: value * self.factors.get(name, 1.0) for name, value in values.items()}
        return Joint(numbers).with_(**self.fields)


CASES: tuple[Planted, ...] = (
    Planted("none", ("none", "", ""), "nothing but numbers within their tolerance"),
    Planted(
        "hysteresis",
        ("effect", "hysteresis", "gear"),
        "hysteresis of the flexspline: 12 Jenkins elements, 3 N m in all, yields spread over 0.05 to 0.45 mrad",
        {"sliders": sliders(3.0, 1.5e-4, 3.0)},
    ),
    Planted(
        "brake",
        ("effect", "friction", "brake_disc"),
        "a brake that drags: 0.05 N m on the brake disc, a quarter more at creep",
        {"friction": Friction(DISC, coulomb=0.05, drop=0.25, drop_speed=12.0, exponent=1.2, smooth_speed=0.4)},
    ),
    Planted(
        "seal",
        ("effect", "friction", "arm"),
        "friction of a seal on the arm: 0.5 N m, a quarter more at creep",
        {"friction": Friction(ARM, coulomb=0.5, drop=0.25, drop_speed=0.15, exponent=1.0, smooth_speed=0.006)},
    ),
    Planted(
        "error",
        ("effect", "kinematic_error", "gear"),
        "a kinematic error of 0.05 mrad once per turn of the wave generator, with side bands once per turn of the output",
        {"error": ((5e-5, 1.0, 0.8), (6e-6, 0.99, 2.4), (6e-6, 1.01, -0.8), (1.2e-5, 3.0, 1.9))},
    ),
    Planted(
        "ripple",
        ("effect", "torque_ripple", "motor"),
        "a torque of the motor that ripples by 0.03 N m, six times per turn, with peaked tops",
        {"ripple": Ripple(amplitude=0.03, order=6.0, phase=0.5, sharpness=0.5)},
    ),
    Planted(
        "encoder",
        ("sensor", "encoder_eccentricity", "output_encoder"),
        "an eccentric output encoder: 0.08 mrad once per turn, a quarter of it twice",
        {"encoder_error": ((8e-5, 1.0, 1.1), (2e-5, 2.0, 0.3))},
    ),
    Planted(
        "coupling",
        ("parameter", "parameter", "coupling stiffness"),
        "a coupling of half the stiffness that the data sheet gives",
        factors={"coupling_stiffness": 0.5},
    ),
)

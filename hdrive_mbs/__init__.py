"""Harmonic-drive power trains and rotors on the multibody engine Exudyn.

    import hdrive_mbs as hm

    scene = hm.Scene(name=..., parts={...}, connections=[...])
    response = hm.simulate(scene, 2.0)
    hm.plot(response)

Names are imported when first used, so ``import hdrive_mbs`` itself loads next to nothing.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

_WHERE: dict[str, tuple[str, ...]] = {
    "scene": ("Scene",),
    "scene_file": ("load_scene", "save_scene"),
    "signals": ("TimeHistory",),
    "quantities": ("parameter", "table", "option", "rpm", "mm", "degrees", "arcmin"),
    "errors": (
        "HdriveError", "ParameterError", "UnitError", "PlaceError", "SceneError", "LawError", "FileFormatError",
        "SimulationError", "AnalysisError",
    ),
    "components.component": ("Component", "Flange"),
    "components.motor": ("Motor",),
    "components.inertia": ("Inertia",),
    "components.shaft": ("Shaft",),
    "components.harmonic_drive": ("HarmonicDrive",),
    "components.load": ("Load",),
    "flexsplines.law": ("StiffnessLaw",),
    "flexsplines.piecewise_linear": ("PiecewiseLinearStiffness",),
    "motors.characteristic": ("MotorCharacteristic",),
    "motors.asynchronous": ("AsynchronousMotor",),
    "loads.law": ("LoadLaw",),
    "loads.constant": ("ConstantTorque",),
    "loads.sine": ("SineTorque",),
    "effects.effect": ("Effect", "TorqueEffect", "TwistEffect", "LawEffect"),
    "effects.coulomb_stribeck_friction": ("CoulombStribeckFriction",),
    "engine.solvers": ("Solver", "DormandPrince", "RungeKutta4", "Trapezoidal", "GeneralizedAlpha"),
    "engine.assembly": ("LoweringWarning",),
    "analysis.result": ("Result", "load"),
    "analysis.time_response": ("Response", "simulate"),
    "analysis.operating_point": ("OperatingPoint", "operating_point"),
    "analysis.modes": ("Modes", "modes"),
    "analysis.campbell": ("Campbell", "torsional_campbell"),
}  # fmt: skip
_MODULE_OF = {name: module for module, exported in _WHERE.items() for name in exported}

__all__ = ["__version__", *sorted(_MODULE_OF)]

if TYPE_CHECKING:
    from hdrive_mbs.analysis.result import Result as Result
    from hdrive_mbs.analysis.result import load as load


def __getattr__(name: str) -> Any:
    module = _MODULE_OF.get(name)
    if module is None:
        raise AttributeError(f"module 'hdrive_mbs' has no attribute {name!r}")
    value = getattr(importlib.import_module(f"hdrive_mbs.{module}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted(__all__)

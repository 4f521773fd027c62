"""Ranges of what machines are made of and how large they are: a value outside is taken, and warned of as one in another unit."""

from __future__ import annotations

from typing import Any

LENGTH: dict[str, Any] = {"usual": (1e-6, 50.0), "hint": "lengths are in m; 600 mm are 0.6, or hm.mm(600)"}
DIAMETER: dict[str, Any] = {"usual": (1e-5, 10.0), "hint": "lengths are in m; 45 mm are 0.045, or hm.mm(45)"}
YOUNGS_MODULUS: dict[str, Any] = {"usual": (1e7, float("inf")), "hint": "it is in Pa; steel has 2.1e11 Pa (210 GPa, 210,000 N/mm^2)"}
SHEAR_MODULUS: dict[str, Any] = {"usual": (1e6, float("inf")), "hint": "it is in Pa; steel has 8.1e10 Pa (81 GPa, 81,000 N/mm^2)"}
DENSITY: dict[str, Any] = {"usual": (50.0, 3e4), "hint": "it is in kg/m^3; steel has 7,850 kg/m^3 (7.85 kg/dm^3)"}

"""Fig. 11: load torque and twist phi_MR - phi_FS of the output shaft, 70 mm long and 26 mm thick."""

from __future__ import annotations

from typing import Any

import numpy as np

import hdrive_mbs as hm
from benchmarks.stiffness_laws.claim import Claim, judged
from benchmarks.stiffness_laws.laws import CONTINUOUS, laws
from benchmarks.stiffness_laws.measure import Measured, measure
from models.harmonic_drive_train import build, load_above_gap

SHEAR_MODULUS = 81e9
"""Pa, steel; the paper gives the shaft's length and diameter only."""


def output_shaft(duration: float) -> tuple[dict[str, Any], list[Claim], Measured]:
    """Two periods of the load with the continuous law, from steady running."""
    shaft = hm.Shaft.from_geometry(diameter=hm.mm(26.0), length=hm.mm(70.0), shear_modulus=SHEAR_MODULUS)
    used = build().parts["output_shaft"].stiffness  # type: ignore[attr-defined]
    load = load_above_gap()
    found = measure(laws()[CONTINUOUS], load, hm.DormandPrince(relative_tolerance=1e-6, absolute_tolerance=1e-8), duration)
    twist = -found.output_twist  # phi_MR - phi_FS of the paper: negative while the motor drives
    static = -np.asarray(load.torque(found.times, 0.0, 0.0)) / used
    numbers = {
        "stiffness_from_geometry": shaft.stiffness,
        "stiffness_used": used,
        "smallest_twist": float(np.min(twist)),
        "largest_twist": float(np.max(twist)),
        "largest_dynamic_part": float(np.max(np.abs(twist - static))),
    }
    share = numbers["largest_dynamic_part"] / float(np.max(np.abs(static)))
    claim = Claim(
        "Fig. 11",
        "twist of the output shaft, phi_MR - phi_FS, with (15)-(17)",
        f"K_wwy = G pi d^4 / 32 L = {shaft.stiffness:.4g} N m/rad; twist {1e3 * numbers['smallest_twist']:.3f} to "
        f"{1e3 * numbers['largest_twist']:.3f} mrad under 20 + 5 sin(2 pi t) N m, within {100.0 * share:.1f} % of -M_MR/K_wwy",
        "content reproduced; its load is not printed. It follows the load" + ("" if share < 0.05 else " with vibration"),
    )
    consistent = Claim(
        "Fig. 11",
        "no artificial vibration with (15)-(17)",
        f"{found.pulses} passages of the edge; largest step away from the static twist {1e6 * numbers['largest_dynamic_part']:.2f} urad",
        judged(found.pulses == 0 and share < 0.05),
    )
    return numbers, [claim, consistent], found

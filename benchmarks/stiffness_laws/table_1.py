"""Table 1, the printed (9) and (10), and the parity of the printed (11), (12) and (14)."""

from __future__ import annotations

import math
from typing import Any

import hdrive_mbs as hm
from benchmarks.stiffness_laws.claim import Claim, judged
from benchmarks.stiffness_laws.laws import LITERAL, laws
from models.harmonic_drive_train import catalogue

PRINTED = {0.0: 1.31e-3, 23.5: 2.04e-3, 98.0: 3.21e-3, 137.0: 3.56e-3}
"""Table 1: torque [N m] -> torsion angle [rad]."""


def printed_9(law: hm.PiecewiseLinearStiffness, torque: float) -> float:
    """(9) as printed, with T/K1."""
    return law.half_gap + torque / law.stiffness_1 + (torque - law.torque_1) / law.stiffness_2


def printed_10(law: hm.PiecewiseLinearStiffness, torque: float) -> float:
    """(10) as printed, with T/K1 and (T - T1)/K2."""
    return printed_9(law, torque) + (torque - law.torque_2) / law.stiffness_3


def table_1() -> tuple[dict[str, Any], list[Claim]]:
    """Each row as the paper prints it, as the corrected law gives it, and as the printed equation does."""
    law = catalogue()
    equations = {
        0.0: ("(7)", law.half_gap),
        23.5: ("(8)", law.half_gap + 23.5 / law.stiffness_1),
        98.0: ("(9)", printed_9(law, 98.0)),
        137.0: ("(10)", printed_10(law, 137.0)),
    }
    rows, claims = [], []
    for torque, table in PRINTED.items():
        equation, as_printed = equations[torque]
        corrected = float(law.twist(torque)) if torque else law.half_gap
        rows.append({"equation": equation, "torque": torque, "table": table, "corrected": corrected, "as_printed": as_printed})
        agrees, misprint = f"{corrected:.2e}" == f"{table:.2e}", f"{as_printed:.2e}" != f"{table:.2e}"
        found = f"{corrected:.2e} rad"
        if misprint:
            found += f" with T1/K1{' and (T2 - T1)/K2' if torque > law.torque_2 else ''}; as printed {as_printed:.2e} rad"
        claims.append(
            Claim(
                f"Table 1, {equation}",
                f"{table:.2e} rad at {torque:g} N m",
                found,
                judged(agrees) + (f", the printed {equation} does not" if misprint else ""),
            )
        )
    low, high = hm.arcmin(1.0), hm.arcmin(9.0)
    claims.append(
        Claim(
            "below (17)",
            "lost motion of 1 - 9 arcmin is 2.9e-4 - 26e-4 rad",
            f"{low:.2e} - {high:.2e} rad",
            judged(f"{low:.1e}" == "2.9e-04" and f"{high:.1e}" == "2.6e-03"),
        )
    )
    claims += _parity()
    return {"rows": rows}, claims


def _parity() -> list[Claim]:
    """What the equations give for negative twist, with the coefficients of (14) and unit values of a and c times their size."""
    law = laws()[LITERAL]
    assert isinstance(law, hm.JumpSecantStiffness)
    twist = 3e-3
    wanted = -float(law.torque(twist))
    printed = (law.linear * -twist + law.cubic * (-twist) ** 3) * -twist
    # torque reading of (11) and (12): a = 5 N m, c phi^2 = 5 N m at this twist, b = d = 0
    a, c = 5.0, 5.0 / twist**2
    sum_11 = 2.0 * (a + c * twist**2)
    sum_12 = (a + c * twist**2) + (a - c * twist**2)
    return [
        Claim(
            "(11), (12)",
            "describe the torque outside the gap, so for both senses",
            f"with terms a and c of 5 N m each, M(+phi) + M(-phi) = {sum_11:g} N m by (11), {sum_12:g} N m by (12), not 0",
            judged(sum_11 == 0.0 and sum_12 == 0.0, "does not hold unless a = 0, in (11) c = 0 too"),
        ),
        Claim(
            "(14)",
            "K_FS is a stiffness [N m/rad] that multiplies the twist in (2)-(3)",
            f"then the torque at -{1e3 * twist:g} mrad is {printed:+.1f} N m where {wanted:+.1f} N m restores; "
            f"its dimension too is that of a torque: as in its figures",
            judged(math.copysign(1.0, printed) == math.copysign(1.0, wanted), "does not hold; read as a torque it does"),
        ),
    ]

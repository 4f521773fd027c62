"""Verdicts in words."""

from __future__ import annotations

import numpy as np

from hdrive_mbs.teeth.clearance import Clearances


def explain_clearances(result: Clearances) -> str:
    """One or two sentences on a stage: what interferes, where, and what to change; or what is left."""
    stage, worst = result.stage, result.worst
    angle = np.degrees(result.angles[worst])
    micro = 1e6
    if not result.interferes:
        return (
            f"{stage.name}: no interference; smallest distance {micro * result.minimum:.1f} um ({result.feature[worst]}, {angle:.1f} deg "
            f"from the starting axis), at the bottom {micro * min(result.radial_tip, result.radial_root):.1f} um, "
            f"{result.teeth_in_engagement:.0f} of {stage.flexible.teeth} teeth have a common height."
        )
    if min(result.radial_tip, result.radial_root) < 0.0:
        tip = result.radial_tip < result.radial_root
        return (
            f"{stage.name}: the {'flexible tip enters the rigid' if tip else 'rigid tip enters the flexible'} root by "
            f"{-micro * min(result.radial_tip, result.radial_root):.1f} um on the engagement axis; w0 is too large for the tooth height. "
            "Reduce w0 or the addendum, or raise the clearance."
        )
    if stage.passing_clearance <= 0.0:
        return (
            f"{stage.name}: tip interference, tooth meets tooth on the starting axis with {-micro * stage.passing_clearance:.1f} um "
            f"of common height; w0 = {1e3 * stage.withdrawal:.4g} mm does not draw them apart. Raise w0 or reduce the addendum."
        )
    feature = result.feature[worst]
    depth = 1e3 * result.depth[worst]
    entering = result.depth[worst] < 0.5 * np.max(result.depth)
    kind = "tip interference on the way in and out of mesh" if entering else "flank interference near full depth"
    cure = (
        "Raise the profile angle or the backlash, or reduce the tooth height."
        if entering
        else "Bring w0 closer to module * (difference of teeth)/2, or raise the backlash or the profile angle."
    )
    return (
        f"{stage.name}: {kind}, up to {-micro * result.minimum:.2g} um ({feature}) at {angle:.1f} deg from the starting axis, where the "
        f"teeth have {depth:.3f} mm of common height. {cure}"
    )

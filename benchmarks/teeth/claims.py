"""What the paper concludes, and what was found."""

from __future__ import annotations

import numpy as np

import hdrive_mbs as hm
from benchmarks.stiffness_laws.claim import Claim, judged
from benchmarks.teeth.speed import linearised
from hdrive_mbs.teeth.clearance import clearances
from models.double_harmonic_transmission import gear


def claims() -> list[Claim]:
    """One line per conclusion."""
    return [_positions(), _zones(), _centre(), _figures(), _load(), _data()]


def _positions() -> Claim:
    largest = max(row["to_180"] for row in linearised())
    return Claim(
        where="(1)-(8), Figs 3, 5",
        says="the equations give the successive positions of the teeth",
        found=f"to first order, with r_a2 in (3) and a plus before theta in (7)-(8); {1e6 * largest:.1f} um off the exact motion at most, "
        "which is of the size of the flank clearances",
        verdict="holds in part: as printed P leaves its tooth by 0.18 mm",
    )


def _zones() -> Claim:
    found = hm.zones(gear("A"))
    apart = np.diff([zone.centre for zone in found])
    words = ", ".join(f"{np.degrees(zone.centre):.0f} deg ({zone.stage}, {np.degrees(zone.width):.0f} deg wide)" for zone in found)
    return Claim(
        where="introduction",
        says="four equidistant engagement zones, the stages offset by 90 deg",
        found=f"{words}; by common height neighbouring zones of the two stages reach into each other",
        verdict=judged(len(found) == 4 and bool(np.allclose(apart, np.pi / 2.0, atol=1e-6))),
    )


def _centre() -> Claim:
    parts = []
    holds = True
    for stage in gear("A").stages():
        motion = hm.tooth_motion(stage, np.linspace(0.0, np.pi, 3601))
        rate = motion.angular_velocity
        near = float(np.min(np.linalg.norm(motion.centre, axis=1)))
        holds &= bool(np.ptp(rate) > 0.01) and int(np.sum(np.diff(np.sign(rate)) != 0)) == 2
        parts.append(
            f"{stage.name}: {np.min(rate):+.4f} to {np.max(rate):+.4f} rad per rad of the generator, "
            f"centre {1e3 * near:.1f} mm and more from O2"
        )
    return Claim(
        where="conclusion",
        says="the tooth moves with variable angular velocity about a point of variable position",
        found="; ".join(parts)
        + "; twice in a wave the angular velocity is zero and the centre infinitely far: there the tooth only slides",
        verdict=judged(holds),
    )


def _figures() -> Claim:
    base = gear("A").stages()[0]
    assert isinstance(base.flexible, hm.StraightToothWheel)
    task = hm.DesignTask.of(base)
    same = {"height": base.flexible.height, "clearance": 0.2 * task.module, "amplitude": hm.mm(0.3)}
    gaps = {alpha: clearances(task.stage(profile_angle=hm.degrees(alpha), **same)).minimum for alpha in (20.0, 30.0)}
    words = ", ".join(f"{alpha:.0f} deg: {1e6 * gap:+.1f} um" for alpha, gap in gaps.items())
    return Claim(
        where="conclusion",
        says="Figs 3 and 5 can be used to choose profile angle, height, clearance and w0 without interference",
        found="height, root clearance and w0 can be read from P, R, M, N; profile angle, thickness and backlash are not in them: "
        f"the same P and R give a smallest distance of {words} (negative: interference)",
        verdict="holds in part: full outlines are needed for the profile angle",
    )


def _load() -> Claim:
    first = gear("A").clearances()[0]
    counts = ", ".join(f"{first.loaded_teeth(windup):.0f} at {1e3 * windup:g} mrad" for windup in (1e-4, 5e-4, 2e-3))
    return Claim(
        where="conclusion",
        says="the engagement largely depends on the load",
        found=f"teeth in contact in stage I over the wind-up of the mesh: {counts}, of {first.teeth_in_engagement:.0f} with a common "
        "height; the deformation of the fibre under load is not modelled",
        verdict="holds in part: for the number of loaded teeth",
    )


def _data() -> Claim:
    sums = min(z2 + z4 for z2 in range(101, 400) for z4 in range(101, 400) if (z2 - 100) * (z4 - 100) == 10200)
    return Claim(
        where="example",
        says="|i| = 50, m = 0.3 mm, r02 = 29.3 mm",
        found=f"|i| = 50 with differences of 2 needs z2 + z4 >= {sums}; a fibre in the middle of the rim needs 388.7 "
        "with m = 0.3 mm in both stages",
        verdict="does not hold with one unshifted module",
    )

"""Motion of a flexible tooth against the rigid wheel held still: points, velocities, instantaneous centre."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.teeth.deformation import FloatArray
from hdrive_mbs.teeth.stage import Stage


@dataclass(frozen=True, kw_only=True, eq=False)
class ToothMotion:
    """Successive positions of one flexible tooth, in the paper's frame S2 of the rigid wheel.

    angles : phi [rad] of the generator against the flexspline, from the starting axis.  Against the
        rigid wheel the generator has turned by phi z_flexible/z_rigid.
    exact : True for the rigid-body motion on a fibre of constant length, False for the paper's equations
    P, R : points on the tooth's axis on its tip and root circle, (n, 2) in m, columns x and y
    foot : the tooth's point on the neutral fibre, (n, 2) in m
    turn : turn [rad] of the tooth against its starting position, towards +x
    velocity : of the foot, (n, 2) in m per rad of phi
    angular_velocity : of the tooth, rad per rad of phi
    centre : instantaneous centre of the tooth's motion, (n, 2) in m; infinite where the tooth only slides
    M, N : tip and root point of the rigid tooth on the starting axis
    """

    stage: Stage
    exact: bool
    angles: FloatArray
    P: FloatArray
    R: FloatArray
    foot: FloatArray
    turn: FloatArray
    velocity: FloatArray
    angular_velocity: FloatArray
    centre: FloatArray
    M: FloatArray
    N: FloatArray

    def columns(self) -> dict[str, FloatArray]:
        """Equally long columns headed ``name [unit]``."""
        return {
            "angle [deg]": np.degrees(self.angles),
            "P_x [mm]": 1e3 * self.P[:, 0],
            "P_y [mm]": 1e3 * self.P[:, 1],
            "R_x [mm]": 1e3 * self.R[:, 0],
            "R_y [mm]": 1e3 * self.R[:, 1],
            "turn [rad]": self.turn,
            "angular_velocity [1]": self.angular_velocity,
            "centre_x [mm]": 1e3 * self.centre[:, 0],
            "centre_y [mm]": 1e3 * self.centre[:, 1],
        }


def steps(step: float, end: float = np.pi) -> FloatArray:
    """Angles 0, step, 2 step ... up to end [rad], the end included if it is a step."""
    return np.asarray(step * np.arange(int(np.floor(end / step + 1e-9)) + 1), float)


def rigid_tooth(stage: Stage, number: int = 0, exact: bool = True) -> tuple[FloatArray, FloatArray]:
    """M and N, on the tip and root circle of rigid tooth psi = number, counted towards -x: seed I (1)-(2), (5)-(6).

    y = r cos(2 pi psi/z) - r02,  x = -r sin(2 pi psi/z)  exact,  x = -r 2 pi psi/z  as printed.
    """
    angle = stage.rigid.pitch_angle * number
    across = np.sin(angle) if exact else angle
    points = [np.array([-r * across, r * np.cos(angle) - stage.fibre_radius]) for r in (stage.rigid.tip_radius, stage.rigid.root_radius)]
    return points[0], points[1]


def printed_point(stage: Stage, radius: float, angles: npt.ArrayLike) -> FloatArray:
    """A point on the tooth's axis by seed I (3)-(4) and (7)-(8), misprints corrected: (..., 2) in m.

    y = (r + w) cos a - r02
    x = v + (r - r02) theta + (r + w) a,   a = phi (z_f - z_r)/z_r

    with the first-order triple at s = s_start - phi.  In stage I a is -phi3 = -2 phi/z3, in stage II
    phi4 - phi2 = 2 phi/z4.
    """
    phi = np.asarray(angles, float)
    s = stage.start - phi
    fibre = stage.fibre(exact=False)
    w, v, theta = fibre.radial(s), fibre.tangential(s), fibre.rotation(s)
    a = stage.relative_turn * phi
    x = v + (radius - stage.fibre_radius) * theta + (radius + w) * a
    y = (radius + w) * np.cos(a) - stage.fibre_radius
    return np.stack((x, y), axis=-1)


def placed(stage: Stage, points: FloatArray, angles: npt.ArrayLike) -> FloatArray:
    """Points (k, 2) of the flexible tooth, (a, y) from its wheel's centre, carried along exactly: (n, k, 2) from the rigid centre.

    The tooth is a rigid body on the fibre:  (v, r0 + w) + rotation by theta of (a, y - r0), then the turn a of the flexible wheel.
    """
    phi = np.asarray(angles, float)[:, None]
    s = stage.start - phi
    fibre = stage.fibre()
    theta = fibre.rotation(s)
    across, along = points[:, 0], points[:, 1] - stage.fibre_radius
    tangential = fibre.tangential(s) + across * np.cos(theta) + along * np.sin(theta)
    radial = stage.fibre_radius + fibre.radial(s) + along * np.cos(theta) - across * np.sin(theta)
    turn = stage.relative_turn * phi
    return np.stack(
        (tangential * np.cos(turn) + radial * np.sin(turn), radial * np.cos(turn) - tangential * np.sin(turn)),
        axis=-1,
    )


def tooth_motion(stage: Stage, angles: npt.ArrayLike, exact: bool = True) -> ToothMotion:
    """Positions, velocities and instantaneous centres of a flexible tooth at the generator angles phi [rad]."""
    phi = np.atleast_1d(np.asarray(angles, float))
    s = stage.start - phi
    r0 = stage.fibre_radius
    fibre = stage.fibre(exact)
    if exact:
        radii = np.array([[0.0, stage.flexible.tip_radius], [0.0, stage.flexible.root_radius], [0.0, r0]])
        tip, root, foot = np.moveaxis(placed(stage, radii, phi) - np.array([0.0, r0]), 1, 0)
    else:
        tip, root, foot = (printed_point(stage, r, phi) for r in (stage.flexible.tip_radius, stage.flexible.root_radius, r0))
    a, rate = stage.relative_turn * phi, stage.relative_turn
    w, v = fibre.radial(s), fibre.tangential(s)
    w_rate, v_rate = -fibre.radial(s, 1), -fibre.tangential(s, 1)  # by phi: s falls as phi rises
    angular = rate - fibre.rotation_rate(s)
    if exact:
        c, d = np.cos(a), np.sin(a)
        velocity = np.stack(
            (
                (v_rate + (r0 + w) * rate) * c + (w_rate - v * rate) * d,
                (w_rate - v * rate) * c - (v_rate + (r0 + w) * rate) * d,
            ),
            axis=-1,
        )
    else:
        velocity = np.stack((v_rate + w_rate * a + (r0 + w) * rate, w_rate * np.cos(a) - (r0 + w) * np.sin(a) * rate), axis=-1)
    # turning towards +x by b': V(p) = V + b' (p_y - y, -(p_x - x)), zero at the centre
    with np.errstate(divide="ignore", invalid="ignore"):
        centre = np.stack((foot[:, 0] + velocity[:, 1] / angular, foot[:, 1] - velocity[:, 0] / angular), axis=-1)
    M, N = rigid_tooth(stage, exact=exact)
    return ToothMotion(
        stage=stage,
        exact=exact,
        angles=phi,
        P=tip,
        R=root,
        foot=foot,
        turn=a + fibre.rotation(s),
        velocity=velocity,
        angular_velocity=angular,
        centre=centre,
        M=M,
        N=N,
    )

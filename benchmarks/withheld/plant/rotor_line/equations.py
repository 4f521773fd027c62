"""The rotor bench's equations of motion and their integrator, compiled; no line is shared with the package.

Coordinates: four stations (bearing 1, rotor 1, bearing 2, rotor 2) with x, y and tilts psi (about x), theta (about y); two housings
with x, y; one hidden mass with x, y; four spins. A point at a along +z from a station has x + a theta, y - a psi. After the
velocities follow AUX inner states of effects. Unbalance and skew are taken from the Lagrangian, with their reaction on the spin;
gyroscopic moments do no work and have no term in the spin equation.

Integrator: Dormand-Prince 5(4) with its step chosen by the error, begun anew at every sample because torque and hammer jump
there. The stiff tilts of the rings hold the step near 60 microseconds; contacts shorten it where they need it.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from benchmarks.withheld.plant.compiled import compiled
from benchmarks.withheld.plant.rotor_line.laws import (
    bearing_force,
    cross_force,
    floor_force,
    misalignment_force,
    openness,
    pass_force,
    piecewise,
    ripple_torque,
    rub_force,
    wander,
    whirl_growth,
    whirl_share,
    whirl_size,
)

FloatArray = NDArray[np.float64]
STATIONS, LATERAL, COORDINATES = 4, 22, 26
HOUSING, HIDDEN, SPIN = 16, 20, 22
WHIRL, SWING, PASS, SLIP, BALL, BALL_RATE, RELAX = 0, 1, 3, 4, 8, 9, 10
AUX = 26
STATES = 2 * COORDINATES + AUX
MORE = 2 * COORDINATES
ACTIVE_PLAIN = MORE + RELAX  # without the relaxing shaft


class Machine(NamedTuple):
    """What the builder knows, as numbers: sections (3), stations (4), bearings and supports (2)."""

    length: FloatArray
    bending: FloatArray  # E I
    torsion: FloatArray  # G I_p / length
    shaft_damping: float
    mass: FloatArray
    polar: FloatArray
    transverse: FloatArray
    ring_stiffness: FloatArray
    ring_damping: FloatArray
    tilt_stiffness: float
    tilt_damping: float
    housing_mass: FloatArray
    support_stiffness: FloatArray  # (2, 2): x, y
    support_damping: FloatArray
    drag: FloatArray
    eccentricity: FloatArray
    eccentric_angle: FloatArray
    skew: FloatArray  # (Jt - Jp) tilt
    skew_angle: FloatArray
    gravity: float


class Causes(NamedTuple):
    """What the builder does not know; a row begins with the number of its law, 0 is absent."""

    bow: FloatArray  # (4, 4): x, y, theta, psi of the free shaft in its own frame
    internal: FloatArray  # law, damping [s] or loss share, time constant
    crack: FloatArray  # law, section, place/length, compliance, the other axis's compliance, angle, scale, gape
    bearing: FloatArray  # (2, 6)
    cross: FloatArray  # (2, 4)
    whirl: FloatArray  # law, bearing, force, fraction, its slope, onset speed, wander, seed, growth, coupling (law 4: power)
    passing: FloatArray  # law, ratio, slip, size, exponent, sharpness, direction, background, bearing, seed
    support: FloatArray  # (2, 4): law, low, high, part
    drift: FloatArray  # (2, 3): share, beginning, length
    friction: FloatArray  # (2, 3): contact stiffness, force, length over which the force varies
    quadratic: FloatArray  # (2,): N s^2/m^2
    floor: FloatArray  # law, support, ... as floor_force
    hidden: FloatArray  # law, support, mass, stiffness 1, 2, damping, angle of axis 1
    rub: FloatArray  # law, ... as rub_force, last the station
    misalignment: FloatArray
    ripple: FloatArray
    pull: FloatArray  # law, station, stiffness, modulation, frequency, centre x, y
    ball: FloatArray  # law, station, mass, radius, drag, share of the weight
    windage: FloatArray  # (4,): N m s^2
    seal: FloatArray  # (4,): N m


def no_causes() -> Causes:
    """All absent."""
    return Causes(
        bow=np.zeros((4, 4)), internal=np.zeros(3), crack=np.zeros(8), bearing=np.zeros((2, 6)), cross=np.zeros((2, 4)),
        whirl=np.zeros(10), passing=np.zeros(10), support=np.zeros((2, 4)), drift=np.zeros((2, 3)), friction=np.zeros((2, 3)),
        quadratic=np.zeros(2), floor=np.zeros(8), hidden=np.zeros(7), rub=np.zeros(11), misalignment=np.zeros(10),
        ripple=np.zeros(11), pull=np.zeros(7), ball=np.zeros(6), windage=np.zeros(4), seal=np.zeros(4),
    )  # fmt: skip


@compiled
def _section(k, L, EI, beta, s, v, f):
    """Add the elastic and material-damping forces of section k: f -= K (s + beta v); both planes."""
    c = EI / L**3
    i, j = 4 * k, 4 * k + 4
    for plane in range(2):
        u, t, g = (0, 3, 1.0) if plane == 0 else (1, 2, -1.0)
        a, b = s[i + u] + beta * v[i + u], g * (s[i + t] + beta * v[i + t])
        d, e = s[j + u] + beta * v[j + u], g * (s[j + t] + beta * v[j + t])
        shear = c * (12.0 * (a - d) + 6.0 * L * (b + e))
        f[i + u] -= shear
        f[j + u] += shear
        f[i + t] -= g * c * L * (6.0 * (a - d) + L * (4.0 * b + 2.0 * e))
        f[j + t] -= g * c * L * (6.0 * (a - d) + L * (2.0 * b + 4.0 * e))


@compiled
def _crack(row, length, bending, angle, s):
    """Take the rotation at the crack's hinge out of the deformation s of its section; returns the torque on the spin."""
    k = int(row[1])
    L, EI, a = length[k], bending[k], row[2] * length[k]
    i, j = 4 * k, 4 * k + 4
    # the bending moment EI w'' at a, from the four end displacements of a plane (w, w')
    m0, m1 = EI * (-6.0 / L**2 + 12.0 * a / L**3), EI * (-4.0 / L + 6.0 * a / L**2)
    m2, m3 = -m0, EI * (-2.0 / L + 6.0 * a / L**2)
    mx = m0 * s[i] + m1 * s[i + 3] + m2 * s[j] + m3 * s[j + 3]
    my = m0 * s[i + 1] - m1 * s[i + 2] + m2 * s[j + 1] - m3 * s[j + 2]
    kh = m2 * (L - a) + m3  # the moment that a unit rotation of the hinge would set free
    c, d = math.cos(angle + row[5]), math.sin(angle + row[5])
    along, across = c * mx + d * my, -d * mx + c * my
    # positive moment along the crack's direction opens it; the weight bends the shaft so that w'' > 0 with y up
    g = openness(int(row[0]), along, angle + row[5] - 0.5 * math.pi, row[6], row[7])
    r1 = row[3] * g / (1.0 + row[3] * g * kh) * along
    r2 = row[4] * g / (1.0 + row[4] * g * kh) * across
    rx, ry = c * r1 - d * r2, d * r1 + c * r2
    # the part beyond the hinge turns by r: its end moves by r (L - a)
    s[j] -= rx * (L - a)
    s[j + 3] -= rx
    s[j + 1] -= ry * (L - a)
    s[j + 2] += ry
    return r1 * across - r2 * along


@compiled
def slope(t, y, torque, hx, hy, M, C, out, s, w, f, r):
    """dy/dt at time t with the held torque and hammer; s, w, f, r are working arrays of LATERAL + 4."""
    n, p = COORDINATES, MORE
    q, v, z = y[:n], y[n:p], y[p:]
    zd = out[p:]
    for i in range(AUX):
        zd[i] = 0.0
    for i in range(LATERAL):
        s[i], w[i], f[i] = q[i], v[i], 0.0
    # --- shaft
    bowed = False
    for i in range(4):
        bx, by, bt, bp = C.bow[i, 0], C.bow[i, 1], C.bow[i, 2], C.bow[i, 3]
        if bx != 0.0 or by != 0.0 or bt != 0.0 or bp != 0.0:
            bowed = True
            cs, sn, o = math.cos(q[SPIN + i]), math.sin(q[SPIN + i]), v[SPIN + i]
            k = 4 * i
            x, yy = cs * bx - sn * by, sn * bx + cs * by
            # (psi, theta) turn like any vector of the plane
            ps, th = cs * bp - sn * bt, sn * bp + cs * bt
            s[k] -= x
            s[k + 1] -= yy
            s[k + 2] -= ps
            s[k + 3] -= th
            w[k] += o * yy
            w[k + 1] -= o * x
            w[k + 2] += o * th
            w[k + 3] -= o * ps
    cracked = 0.0
    for k in range(3):
        if C.crack[3] != 0.0 and int(C.crack[1]) == k:
            j = 4 * k + 4
            s0, s1, s2, s3 = s[j], s[j + 1], s[j + 2], s[j + 3]
            cracked = _crack(C.crack, M.length, M.bending, 0.5 * (q[SPIN + k] + q[SPIN + k + 1]), s)
            _section(k, M.length[k], M.bending[k], M.shaft_damping, s, w, f)
            s[j], s[j + 1], s[j + 2], s[j + 3] = s0, s1, s2, s3  # the next section begins at the station itself
        else:
            _section(k, M.length[k], M.bending[k], M.shaft_damping, s, w, f)
    T = out[n + SPIN : n + SPIN + 4]  # torques first, accelerations later
    for i in range(4):
        T[i] = -M.drag[i] * v[SPIN + i] - C.windage[i] * v[SPIN + i] * abs(v[SPIN + i]) - C.seal[i] * math.tanh(v[SPIN + i])
    for k in range(3):
        tw = M.torsion[k] * (q[SPIN + k + 1] - q[SPIN + k] + M.shaft_damping * (v[SPIN + k + 1] - v[SPIN + k]))
        T[k] += tw
        T[k + 1] -= tw
    if cracked != 0.0:
        T[int(C.crack[1])] += 0.5 * cracked
        T[int(C.crack[1]) + 1] += 0.5 * cracked
    if bowed:
        for i in range(4):
            k = 4 * i
            bx, by, bt, bp = C.bow[i, 0], C.bow[i, 1], C.bow[i, 2], C.bow[i, 3]
            cs, sn = math.cos(q[SPIN + i]), math.sin(q[SPIN + i])
            # -dV/dangle = -(force on the station) . d(free shape)/dangle
            T[i] -= f[k + 1] * (cs * bx - sn * by) - f[k] * (sn * bx + cs * by)
            T[i] -= f[k + 3] * (cs * bp - sn * bt) - f[k + 2] * (sn * bp + cs * bt)
    law = int(C.internal[0])
    if law > 0:
        for i in range(16):
            r[i] = 0.0
            s[i] = 0.0
        if law == 1:
            for i in range(4):
                k, o = 4 * i, v[SPIN + i]
                w[k], w[k + 1] = v[k] + o * q[k + 1], v[k + 1] - o * q[k]
                w[k + 2], w[k + 3] = v[k + 2] + o * q[k + 3], v[k + 3] - o * q[k + 2]
        else:
            for i in range(16):
                s[i] = q[i] - z[RELAX + i]
                w[i] = 0.0
            for i in range(4):
                k, o = 4 * i, v[SPIN + i]
                for m in range(0, 4, 2):
                    a, b = z[RELAX + k + m], z[RELAX + k + m + 1]
                    zd[RELAX + k + m] = s[k + m] / C.internal[2] - o * b
                    zd[RELAX + k + m + 1] = s[k + m + 1] / C.internal[2] + o * a
        for k in range(3):
            if law == 1:
                _section(k, M.length[k], M.bending[k], C.internal[1], s, w, r)
            else:
                _section(k, M.length[k], M.bending[k] * C.internal[1], 0.0, s, w, r)
        for i in range(4):
            k = 4 * i
            for m in range(4):
                f[k + m] += r[k + m]
            # the work that the whirl takes out of the turning frame comes from the spin
            for m in range(0, 4, 2):
                a, b = (q[k + m], q[k + m + 1]) if law == 1 else (z[RELAX + k + m], z[RELAX + k + m + 1])
                T[i] -= a * r[k + m + 1] - b * r[k + m]
    # --- bearings
    for b in range(2):
        k, h, st = 8 * b, HOUSING + 2 * b, 2 * b
        o = v[SPIN + st]
        ux, uy = q[k] - q[h], q[k + 1] - q[h + 1]
        fx, fy = bearing_force(C.bearing[b], M.ring_stiffness[b], M.ring_damping[b], ux, uy, v[k] - v[h], v[k + 1] - v[h + 1])
        gx, gy = cross_force(C.cross[b], o, ux, uy)
        fx += gx
        fy += gy
        if C.whirl[0] > 0.0 and int(C.whirl[1]) == b:
            W = C.whirl
            lam = whirl_share(W, o) + W[6] * wander(0.7 * t + W[7], W[7])
            if W[0] == 1.0 or W[0] == 4.0:
                zd[WHIRL] = lam * o
                size = whirl_size(W, o) * (1.0 + 0.3 * wander(1.3 * t + 2.0 * W[7], W[7]))
                fx += size * math.cos(z[WHIRL])
                fy += size * math.sin(z[WHIRL])
            else:
                a, c = z[SWING], z[SWING + 1]
                g = whirl_growth(W, o, a * a + c * c)
                zd[SWING] = g * a - lam * o * c + W[9] * (v[k] - v[h])
                zd[SWING + 1] = g * c + lam * o * a + W[9] * (v[k + 1] - v[h + 1])
                fx += W[2] * a
                fy += W[2] * c
        if C.passing[0] > 0.0 and int(C.passing[8]) == b:
            P = C.passing
            th = q[SPIN + st]
            zd[PASS] = P[1] * o * (1.0 + P[2] * wander(0.02 * th + P[9], P[9]))
            gx, gy = pass_force(P, z[PASS], th, o)
            fx += gx
            fy += gy
        f[k] += fx
        f[k + 1] += fy
        f[h] -= fx
        f[h + 1] -= fy
        f[k + 2] -= M.tilt_stiffness * q[k + 2] + M.tilt_damping * v[k + 2]
        f[k + 3] -= M.tilt_stiffness * q[k + 3] + M.tilt_damping * v[k + 3]
    # --- supports
    for b in range(2):
        h = HOUSING + 2 * b
        fade = 1.0 - C.drift[b, 0] * min(max((t - C.drift[b, 1]) / C.drift[b, 2], 0.0), 1.0) if C.drift[b, 0] != 0.0 else 1.0
        for a in range(2):
            x, vx = q[h + a], v[h + a]
            k, d = M.support_stiffness[b, a] * fade, M.support_damping[b, a]
            law = int(C.support[b, 0])
            if (law == 2 and a == 0) or ((law == 1 or law == 3) and a == 1):
                F = piecewise(law, k, C.support[b, 1], C.support[b, 2], C.support[b, 3], x) + d * vx
            else:
                F = k * x + d * vx
            if C.quadratic[b] != 0.0:
                F += C.quadratic[b] * abs(vx) * vx
            if C.friction[b, 1] != 0.0:
                i = SLIP + 2 * b + a
                top = C.friction[b, 1] * (1.0 + 0.6 * math.tanh(x / C.friction[b, 2]))
                zd[i] = C.friction[b, 0] * (vx - abs(vx) * z[i] / top)
                F += z[i]
            f[h + a] -= F
    if C.floor[0] > 0.0:
        h = HOUSING + 2 * int(C.floor[1])
        F = floor_force(C.floor, t)
        f[h] += F * math.cos(C.floor[6])
        f[h + 1] += F * math.sin(C.floor[6])
    # --- hidden mass
    if C.hidden[0] > 0.0:
        h = HOUSING + 2 * int(C.hidden[1])
        cs, sn = math.cos(C.hidden[6]), math.sin(C.hidden[6])
        x, yy = q[HIDDEN] - q[h], q[HIDDEN + 1] - q[h + 1]
        vx, vy = v[HIDDEN] - v[h], v[HIDDEN + 1] - v[h + 1]
        gx = C.hidden[3] * (cs * x + sn * yy) + C.hidden[5] * (cs * vx + sn * vy)
        gy = C.hidden[4] * (-sn * x + cs * yy) + C.hidden[5] * (-sn * vx + cs * vy)
        fx, fy = cs * gx - sn * gy, sn * gx + cs * gy
        f[h] += fx
        f[h + 1] += fy
        out[n + HIDDEN] = -fx / C.hidden[2]
        out[n + HIDDEN + 1] = -fy / C.hidden[2] - M.gravity
    else:
        out[n + HIDDEN], out[n + HIDDEN + 1] = 0.0, 0.0
    # --- drive end and rotors
    fx, fy, mp, mt = misalignment_force(C.misalignment, q[SPIN], torque, q[0], q[1])
    f[0] += fx
    f[1] += fy
    f[2] += mp
    f[3] += mt
    T[0] += torque + ripple_torque(C.ripple, q[SPIN], torque)
    f[4] += hx
    f[5] += hy
    if C.rub[0] > 0.0:
        i = int(C.rub[10])
        k = 4 * i
        fx, fy, mp = rub_force(C.rub, q[k], q[k + 1], v[k], v[k + 1], v[SPIN + i])
        f[k] += fx
        f[k + 1] += fy
        T[i] += mp
    if C.pull[0] > 0.0:
        k = 4 * int(C.pull[1])
        g = C.pull[2] * (1.0 + C.pull[3] * math.cos(C.pull[4] * t))
        f[k] += g * (q[k] - C.pull[5])
        f[k + 1] += g * (q[k + 1] - C.pull[6])
    if C.ball[0] > 0.0:
        i = int(C.ball[1])
        k = 4 * i
        cs, sn, g = math.cos(z[BALL]), math.sin(z[BALL]), z[BALL_RATE]
        ax, ay = f[k] / M.mass[i], f[k + 1] / M.mass[i]
        zd[BALL] = g
        zd[BALL_RATE] = -C.ball[4] * (g - v[SPIN + i]) + (sn * ax - cs * (ay + C.ball[5] * M.gravity)) / C.ball[3]
        mr = C.ball[2] * C.ball[3]
        f[k] += mr * (g * g * cs + zd[BALL_RATE] * sn)
        f[k + 1] += mr * (g * g * sn - zd[BALL_RATE] * cs)
    # --- accelerations
    for i in range(4):
        k, o = 4 * i, v[SPIN + i]
        m, jt, e, c = M.mass[i], M.transverse[i], M.eccentricity[i], M.skew[i]
        ce, se = math.cos(q[SPIN + i] + M.eccentric_angle[i]), math.sin(q[SPIN + i] + M.eccentric_angle[i])
        cc, sc = math.cos(q[SPIN + i] + M.skew_angle[i]), math.sin(q[SPIN + i] + M.skew_angle[i])
        gp, gt = f[k + 2] - M.polar[i] * o * v[k + 3], f[k + 3] + M.polar[i] * o * v[k + 2]
        # with c = (Jt - Jp) tilt: Jt psi'' - c cos spin'' = gp - c spin'^2 sin, and so on
        spin = (T[i] + e * (se * f[k] - ce * f[k + 1]) + c * (cc * gp + sc * gt) / jt) / (M.polar[i] - c * c / jt)
        T[i] = spin
        out[n + k] = f[k] / m + e * (o * o * ce + spin * se)
        out[n + k + 1] = f[k + 1] / m + e * (o * o * se - spin * ce) - M.gravity
        out[n + k + 2] = (gp + c * (spin * cc - o * o * sc)) / jt
        out[n + k + 3] = (gt + c * (spin * sc + o * o * cc)) / jt
    for b in range(2):
        h = HOUSING + 2 * b
        out[n + h] = f[h] / M.housing_mass[b]
        out[n + h + 1] = f[h + 1] / M.housing_mass[b] - M.gravity
    for i in range(n):
        out[i] = v[i]


# Dormand & Prince (1980), as in Hairer, Norsett, Wanner, Solving ODEs I, table II.5.2
_NODES = np.array([0.0, 1 / 5, 3 / 10, 4 / 5, 8 / 9, 1.0, 1.0])
_STAGES = np.array([
    [0, 0, 0, 0, 0, 0],
    [1 / 5, 0, 0, 0, 0, 0],
    [3 / 40, 9 / 40, 0, 0, 0, 0],
    [44 / 45, -56 / 15, 32 / 9, 0, 0, 0],
    [19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729, 0, 0],
    [9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656, 0],
    [35 / 384, 0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84],
])  # fmt: skip
_DIFFERENCE = np.array([71 / 57600, 0.0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40])


@compiled
def integrate(y, reference, hammer, rate, gain, limit, M, C, scale, active, states, torques, slopes):
    """Run the bench: reads the speed at each sample, holds the torque, and stores state and slope there. Number of steps, or -1."""
    h0 = 1.0 / rate
    k = np.zeros((7, STATES))
    z = np.zeros(STATES)
    s, w, f, r = np.zeros(LATERAL + 4), np.zeros(LATERAL + 4), np.zeros(LATERAL + 4), np.zeros(LATERAL + 4)
    step = 0.25 * h0
    steps = 0
    for i in range(reference.shape[0]):
        t, end = i * h0, (i + 1) * h0
        torque = min(max(gain * (reference[i] - y[COORDINATES + SPIN]), -limit), limit)
        hx, hy = hammer[i, 0], hammer[i, 1]
        slope(t, y, torque, hx, hy, M, C, k[0], s, w, f, r)
        for j in range(STATES):
            states[i, j] = y[j]
            slopes[i, j] = k[0, j]
        torques[i] = torque
        while end - t > 1e-12:
            left = end - t
            h = min(step, left)
            if h < left < 1.5 * h:
                h = 0.5 * left
            for stage in range(1, 7):
                for j in range(active):
                    d = 0.0
                    for m in range(stage):
                        d += _STAGES[stage, m] * k[m, j]
                    z[j] = y[j] + h * d
                slope(t + _NODES[stage] * h, z, torque, hx, hy, M, C, k[stage], s, w, f, r)
            worst = 0.0
            for j in range(active):
                d = 0.0
                for m in range(7):
                    d += _DIFFERENCE[m] * k[m, j]
                worst = max(worst, abs(h * d) / scale[j])
            if not math.isfinite(worst):
                return -1
            factor = min(4.0, max(0.2, 0.9 * (worst + 1e-12) ** -0.2))
            if worst <= 1.0 or h < 1e-8:
                t += h
                steps += 1
                for j in range(active):
                    y[j] = z[j]
                    k[0, j] = k[6, j]
                if h >= step or factor < 1.0:
                    step = h * factor
            else:
                step = h * factor
        for j in range(LATERAL):
            if not abs(y[j]) < 0.05:
                return -1
    return steps


def error_scales(tolerance: float) -> FloatArray:
    """Allowed error of a step by state, as a share of what the sensors resolve: 0.25 um, 1e-4 m/s, 2e-4 rad, 0.01 rad/s."""
    scale = np.ones(STATES)
    scale[:HIDDEN] = 2.5e-7
    tilts = [4 * i + j for i in range(4) for j in (2, 3)]
    scale[tilts] = 1e-6
    scale[HIDDEN:SPIN] = 2.5e-7
    scale[SPIN:COORDINATES] = 2e-4
    scale[COORDINATES : COORDINATES + SPIN] = 1e-4
    scale[[COORDINATES + i for i in tilts]] = 4e-4
    scale[COORDINATES + SPIN : MORE] = 0.01
    scale[MORE + SLIP : MORE + BALL] = 1.0
    scale[MORE + RELAX : MORE + RELAX + 16] = 2.5e-7
    return tolerance * scale


def accelerations(machine: Machine, causes: Causes, lateral: FloatArray, aux: FloatArray) -> FloatArray:
    """Lateral accelerations at rest and spin angle 0, for the static deflection."""
    y, out = np.zeros(STATES), np.zeros(STATES)
    y[:LATERAL] = lateral
    y[MORE:] = aux
    work: Any = [np.zeros(LATERAL + 4) for _ in range(4)]
    slope(0.0, y, 0.0, 0.0, 0.0, machine, causes, out, *work)
    return out[COORDINATES : COORDINATES + LATERAL]

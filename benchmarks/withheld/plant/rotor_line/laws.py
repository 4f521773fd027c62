"""Constitutive laws of the rotor bench's plant, compiled.

Every law takes the relative motion and its own row of parameters and returns forces in SI units. A row starts with the
number of the law; 0 is the bench as its builder knows it. The forms are chosen to differ from what a library would hold:
contacts have a film or a line-contact exponent, a crack closes by the bending moment, whirl is a limit cycle, slip wanders.
"""

from __future__ import annotations

import math

from benchmarks.withheld.plant.compiled import compiled

_POINT_FIVE_PI = 0.5 * math.pi


@compiled
def bearing_force(row, k, d, ux, uy, vx, vy):
    """Radial force on the inner ring from the displacement and velocity of the ring in its housing.

    0 linear; 1 gap with a linear contact and a thin film: row = (1, gap, film stiffness/k, film damping/d);
    2 gap with a line contact N = a p^(10/9), Hunt-Crossley damping: row = (2, gap, film stiffness/k, film damping/d, a, b);
    3 isotropic hardening k r (1 + (r/s)^2): row = (3, s); 4 the same by axis; 5 k s sinh(r/s) along the displacement.
    Leaves out the single rolling elements.
    """
    law = int(row[0])
    if law == 0:
        return -k * ux - d * vx, -k * uy - d * vy
    r = math.sqrt(ux * ux + uy * uy)
    if law <= 2:
        fx = -row[2] * k * ux - row[3] * d * vx
        fy = -row[2] * k * uy - row[3] * d * vy
        p = r - row[1]
        if p > 0.0:
            nx, ny = ux / r, uy / r
            rate = nx * vx + ny * vy
            normal = (1.0 - row[2]) * k * p + (1.0 - row[3]) * d * rate
            if law == 2:
                normal = row[4] * p ** (10.0 / 9.0) * (1.0 + row[5] * rate)
            if normal > 0.0:
                fx -= normal * nx
                fy -= normal * ny
        return fx, fy
    s = row[1]
    if law == 3:
        g = 1.0 + (r / s) ** 2
        return -k * g * ux - d * vx, -k * g * uy - d * vy
    if law == 4:
        return -k * (1.0 + (ux / s) ** 2) * ux - d * vx, -k * (1.0 + (uy / s) ** 2) * uy - d * vy
    z = min(r / s, 6.0)
    g = 1.0 + z * z / 6.0 if z < 1e-3 else math.sinh(z) / z
    return -k * g * ux - d * vx, -k * g * uy - d * vy


@compiled
def cross_force(row, speed, ux, uy):
    """Skew force of a bearing: F = s (-(1 + a) uy, (1 - a) ux), s = row[1] g(speed)/(1 + (r/row[3])^2).

    Law 1: g = 1; law 2: g = speed/1000 rad/s; law 3: g = (speed/1000)^2. row[2] = a. Leaves out the direct terms of the film.
    """
    law = int(row[0])
    if law == 0:
        return 0.0, 0.0
    g = 1.0
    if law == 2:
        g = speed * 1e-3
    elif law == 3:
        g = (speed * 1e-3) ** 2
    s = row[1] * g / (1.0 + (ux * ux + uy * uy) / (row[3] * row[3]))
    return -s * (1.0 + row[2]) * uy, s * (1.0 - row[2]) * ux


@compiled
def piecewise(law, k, low, high, part, y):
    """Spring k with a softened range: 1 softer by part above low; 2 softer within |y| < high; 3 softer between low and high."""
    if law == 1:
        return k * (y if y < low else low + part * (y - low))
    if law == 2:
        if y > high:
            return k * (part * high + (y - high))
        if y < -high:
            return k * (-part * high + (y + high))
        return k * part * y
    if y < low:
        return k * y
    if y < high:
        return k * (low + part * (y - low))
    return k * (low + part * (high - low) + (y - high))


@compiled
def rub_force(row, x, y, vx, vy, spin):
    """Normal and friction force of a rotor on its stator, and the torque on the spin.

    row = (law, gap, stator centre x, y, stiffness, damping, friction, speed scale, radius, extra).
    1 linear wall, Coulomb friction smoothed by tanh; 2 Hunt-Crossley k p^1.5 (1 + c p'), friction falling with speed
    (Stribeck, scale 20 m/s to the share extra); 3 abradable coat k p/(1 + p/extra).
    Leaves out the stator's own motion and heat.
    """
    law = int(row[0])
    if law == 0:
        return 0.0, 0.0, 0.0
    x -= row[2]
    y -= row[3]
    r = math.sqrt(x * x + y * y)
    p = r - row[1]
    if p <= 0.0:
        return 0.0, 0.0, 0.0
    nx, ny = x / r, y / r
    rate = nx * vx + ny * vy
    slide = -ny * vx + nx * vy + spin * row[8]
    mu = row[6] * math.tanh(slide / row[7])
    if law == 1:
        n = row[4] * p + row[5] * rate
    elif law == 2:
        n = row[4] * p**1.5 * (1.0 + row[5] * rate)
        mu *= row[9] + (1.0 - row[9]) * math.exp(-abs(slide) / 20.0)
    else:
        n = row[4] * p / (1.0 + p / row[9]) + row[5] * rate
    if n <= 0.0:
        return 0.0, 0.0, 0.0
    return -n * nx + mu * n * ny, -n * ny - mu * n * nx, -mu * n * row[8]


@compiled
def misalignment_force(row, angle, torque, x, y):
    """Forces and moments (Fx, Fy, Mpsi, Mtheta) of a misaligned coupling at the drive end.

    1 constant elliptic harmonics: row = (1, A1, p1, A2, p2, A3, p3, minor/major axis);
    2 flexible coupling, stiffness k (1 + e cos 2(angle - p)) in the turning frame, spring ends apart by an offset:
      row = (2, k, e, p, offset x, offset y, once-per-turn offset, its angle);
    3 toothed coupling: the harmonics of law 1 scale with share + |torque|/100 N m, with moments of row[9] metres: row[8] = share.
    Leaves out the axial force.
    """
    law = int(row[0])
    if law == 0:
        return 0.0, 0.0, 0.0, 0.0
    if law == 2:
        c, s = math.cos(angle - row[3]), math.sin(angle - row[3])
        dx = row[4] + row[6] * math.cos(angle + row[7]) - x
        dy = row[5] + row[6] * math.sin(angle + row[7]) - y
        a, b = row[1] * (1.0 + row[2]) * (c * dx + s * dy), row[1] * (1.0 - row[2]) * (-s * dx + c * dy)
        return c * a - s * b, s * a + c * b, 0.0, 0.0
    fx = row[1] * math.cos(angle + row[2]) + row[3] * math.cos(2 * angle + row[4]) + row[5] * math.cos(3 * angle + row[6])
    fy = row[1] * math.sin(angle + row[2]) + row[3] * math.sin(2 * angle + row[4]) + row[5] * math.sin(3 * angle + row[6])
    fy *= row[7]
    if law == 1:
        return fx, fy, 0.0, 0.0
    g = row[8] + abs(torque) * 0.01
    return g * fx, g * fy, -g * row[9] * fy, g * row[9] * fx


@compiled
def openness(law, moment, angle, scale, gape):
    """How far a crack is open, 0 to 1.

    0 always (an unsymmetric section); 1 by the bending moment across it, 1/2 (1 + tanh(M/scale)); 2 by the angle to the weight
    with a steepness: 1/2 (1 + tanh(scale cos)/tanh(scale)); 3 the moment clipped to a linear ramp of width scale; 4 by the angle to
    the weight with a power: (1/2 (1 + cos))^scale; 5 the share of a straight crack front that lies below a level line, gape radii
    above the middle of the section, where bending turns from pull to pressure; scale is the crack's depth in radii.
    """
    if law == 0:
        return 1.0
    if law == 1:
        return 0.5 * (1.0 + math.tanh(moment / scale))
    if law == 2:
        return 0.5 * (1.0 + math.tanh(scale * math.cos(angle)) / math.tanh(scale))
    if law == 4:
        return (0.5 * (1.0 + math.cos(angle))) ** scale
    if law == 5:
        # points of the front: (1 - scale) along the crack's direction, t half-lengths along the front, t = -1 to 1
        below = gape + (1.0 - scale) * math.cos(angle)
        half = math.sqrt(scale * (2.0 - scale)) * abs(math.sin(angle))
        return min(max(0.5 * (1.0 + below / max(half, 1e-9)), 0.0), 1.0)
    return min(max(0.5 + 0.5 * moment / scale, 0.0), 1.0)


@compiled
def ripple_torque(row, angle, torque):
    """Motor torque beside the command: sum of A_n sin(order_n angle + p_n), times share + |torque|/100 N m for law 2."""
    law = int(row[0])
    if law == 0:
        return 0.0
    t = 0.0
    for n in range(3):
        t += row[2 + 3 * n] * math.sin(row[3 + 3 * n] * angle + row[4 + 3 * n])
    if law == 2:
        t *= row[1] + abs(torque) * 0.01
    return t


@compiled
def pass_force(row, phase, spin_angle, speed):
    """Signed size and direction of a ball-pass force between ring and housing: (Fx, Fy on the ring).

    row = (law, ratio, slip, size, speed exponent, sharpness, load direction, background).
    1 defect of the outer race: von Mises pulses exp(s (cos - 1)) along the load; 2 of the inner race: pulses that turn with the
    shaft and are felt only in the loaded half; 3 a smooth wave with its second harmonic. Leaves out the ring-down of the race.
    """
    size = row[3] * (speed / 500.0) ** row[4] if speed > 0.0 else 0.0
    law = int(row[0])
    if law == 3:
        g = size * (math.cos(phase) + row[5] * math.cos(2 * phase + 1.0))
        return g * math.cos(row[6]), g * math.sin(row[6])
    pulse = size * math.exp(row[5] * (math.cos(phase) - 1.0))
    if law == 1:
        return pulse * math.cos(row[6]), pulse * math.sin(row[6])
    d = spin_angle + row[6]
    loaded = max(0.0, math.cos(d + _POINT_FIVE_PI)) ** 1.5 + row[7]
    return pulse * loaded * math.cos(d), pulse * loaded * math.sin(d)


@compiled
def whirl_share(row, speed):
    """Share of the spin at which oil whirls, but for its wander: row[3] at 500 rad/s; straight over the speed, for law 4 over its root."""
    if row[0] == 4.0:
        return row[3] + row[4] * (math.sqrt(max(speed, 0.0) * 0.002) - 1.0)
    return row[3] + row[4] * (speed * 1e-3 - 0.5)


@compiled
def whirl_size(row, speed):
    """Size of an oil whirl that sets in at row[5] without a delay: with the square of the speed and a logistic of width 0.12 row[5], or for
    law 4 with the power row[9] and h^8/(1 + h^8), h = speed/row[5]."""
    if row[0] == 4.0:
        h = (max(speed, 0.0) / row[5]) ** 8
        return row[2] * (max(speed, 0.0) * 1e-3) ** row[9] * h / (1.0 + h)
    x = (speed - row[5]) / (0.12 * row[5])
    return row[2] * (speed * 1e-3) ** 2 / (1.0 + math.exp(-min(max(x, -40.0), 40.0)))


@compiled
def whirl_growth(row, speed, square):
    """Rate [1/s] at which a limit cycle of that size squared grows: it dies slowly below its onset row[5]; its square bounds it, for law 3
    its cube."""
    bound = square * math.sqrt(square) if row[0] == 3.0 else square
    return row[8] * (min(max(speed / row[5] - 1.0, -0.02), 0.6) - bound)


@compiled
def wander(a, b):
    """A slow wander between -1 and 1 without a period, from two seeds in radians."""
    return (math.sin(a) + math.sin(1.618 * a + b) + math.sin(2.414 * a + 2.0 * b)) / 3.0


@compiled
def floor_force(row, t):
    """Force of the floor on a housing: row = (law, support, A1, w1, A2, w2, direction, phase).

    1 two fixed frequencies: A1 sin(w1 t + phase) + A2 sin(w2 t + 2 phase); 2 shocks A1 exp(-A2 s) sin(w1 s), s since the last one,
    one every w2 seconds, the first at phase seconds. Has nothing to do with the rotation.
    """
    if row[0] == 1.0:
        return row[2] * math.sin(row[3] * t + row[7]) + row[4] * math.sin(row[5] * t + 2.0 * row[7])
    if t < row[7]:
        return 0.0
    s = (t - row[7]) % row[5]
    return row[2] * math.exp(-row[4] * s) * math.sin(row[3] * s)

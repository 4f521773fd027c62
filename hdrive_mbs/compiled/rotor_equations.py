"""Accelerations of a line with rotors or matrices of mass, in a form for explicit integration.

A rotor with mass m, centre of mass (ex, ey, a), moments of inertia Jt and Jp and products J_xz + i J_yz about its
origin has, with S = m (ex + i ey), J = J_xz + i J_yz, the spin phi (true sense) and  A + i B = (phi'^2 - i phi'') exp(i phi),

    m x''   + m a theta''                                        = Q_x     + Re(S (A + i B))
    m y''   - m a psi''                                          = Q_y     + Im(S (A + i B))
    Jt psi''   - m a y''  + Jp (phi' theta' + phi'' theta)       = Q_psi   + Im(J (A + i B))
    Jt theta'' + m a x''  - Jp  phi' psi'                        = Q_theta - Re(J (A + i B))
    Jp phi''   + Jp (theta psi'' + psi' theta') + b.(x'', y'', psi'', theta'')  = Q_phi

with b = (-Im S e, Re S e, Re J e, Im J e), e = exp(i phi).  These are Lagrange's equations of the kinetic energy up to
second order in tilts and their rates, and exact in the spin; the constant masses M are common to all rotors, bearings and
heavy shafts.  Centrifugal forces are at right angles to M^-1 b and b.M^-1 b does not depend on the spin, so lateral
accelerations g without unbalance come first, then  (Jp - b.M^-1 b) phi'' = Q_phi - b.g - ...  with all b that multiplies
phi'', also Jp theta; then what phi'' adds.

Source: the exact equations (network/rigid_motion.py, Shabana 3.5), expanded; seed M (8) has their gyroscopic terms.
Left out: the axial force of a tilted unbalance, m e phi'^2 tilt (at 1000 rad/s, 8 um, 24 kg and 1e-4 rad 0.02 N); that a tilted
or eccentric rotor is not quite round about its axis, (Jxx - Jyy)/Jt, refused above 1e-4; tilts squared beside 1 (1e-6 at
1e-3 rad); and that the spin of one rotor shakes that of another through masses they share, refused above 1e-6 of Jp.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.compiled.constant_mass import ConstantMass
from hdrive_mbs.compiled.groups import groups
from hdrive_mbs.compiled.linear_forces import linear_forces
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.expression import Value
from hdrive_mbs.network.matrix_element import MatrixElement
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.network import Network, Rotor
from hdrive_mbs.network.rigid_motion import mass_at_rest
from hdrive_mbs.tracked_arrays import added_at, array_of, pattern

FloatArray = npt.NDArray[np.float64]

ROUNDNESS = 1e-4
"""Largest difference of the moments of inertia about two diameters over their mean."""
COUPLING = 1e-6
"""Largest part of the polar inertia by which spins may act on each other, or lateral masses differ in x and y."""


@dataclass(frozen=True, eq=False)
class _Spinning:
    """A rotor among the constant masses.

    cosine, sine : accelerations from the forces that Re and Im of (phi'^2 - i phi'') exp(i phi) make
    lean : accelerations from a unit moment about x
    carried : b.M^-1 b, what moving unbalance takes of the polar inertia
    """

    rotor: Rotor
    cosine: Mapping[str, float]
    sine: Mapping[str, float]
    lean: Mapping[str, float]
    carried: float


@dataclass(frozen=True, eq=False)
class _Phase:
    """Cosine and sine of a rotor's true spin angle; both 0 where it is balanced."""

    cosine: Value
    sine: Value


def coupled_accelerations(network: Network, moment: Moment) -> dict[str, Value]:
    """Forward acceleration of each coordinate [rad/s^2, m/s^2] and the rate of each state; numbers, arrays or expressions.

    Raises ParameterError for rotors that are far from round and masses that join their spins to lateral motion.
    """
    names, matrix = masses(network)
    turning = _turning(network, names, matrix)
    mass = _selected(names, matrix, [name for name in names if name not in turning])
    rotors = _spinning_rotors(network, mass)
    for part in rotors:
        matrix = added_at(matrix, np.array([names.index(part.rotor.coordinates[5])]), array_of([[-part.carried]]))
    forces = _forces(network, moment)
    rates = {state.name: forces.pop(state.name, 0.0) for state in network.states}
    found = mass.solve(forces)
    phases = [_phase(part, moment) for part in rotors]
    for part, phase in zip(rotors, phases, strict=True):
        spin = part.rotor.coordinates[5]
        forces[spin] = forces.get(spin, 0.0) - part.rotor.sense * _taken(part, phase, moment, found)
    found |= _selected(names, matrix, turning).solve(forces)
    late: dict[str, Value] = {}
    for part, phase in zip(rotors, phases, strict=True):
        spin = part.rotor.coordinates[5]
        at = names.index(spin)
        found[spin] = found[spin] + found[spin] * _tilted(part, phase, moment, matrix.item(at, at))
        _add_shaking(part, phase, moment, part.rotor.sense * found[spin], late)
    for name, value in late.items():
        found[name] = found[name] + value
    return {**{name: found[name] for name in names}, **rates}


def masses(network: Network) -> tuple[list[str], FloatArray]:
    """Names of all coordinates, and their constant masses."""
    names = [body.name for body in network.bodies]
    index = {name: k for k, name in enumerate(names)}
    matrix = network.constant_mass.copy()
    for rotor in network.rotors:
        kept = np.array([k for k, name in enumerate(rotor.coordinates) if name in index], int)
        at = np.array([index[rotor.coordinates[k]] for k in kept], int)
        matrix = added_at(matrix, at, mass_at_rest(rotor.body.balanced())[kept[:, None], kept])
    return names, matrix


def _turning(network: Network, names: Sequence[str], matrix: FloatArray) -> list[str]:
    """The spins of rotors with all that shares inertia with them."""
    spins = {rotor.coordinates[5]: rotor.name for rotor in network.rotors}
    turning: list[str] = []
    for group in groups(pattern(matrix)):
        members = [names[k] for k in group]
        mine = [spins[name] for name in members if name in spins]
        if mine:
            turning += members
            lateral = [network.bodies[k].name for k in group if network.bodies[k].lateral]
            if lateral:
                raise ParameterError(
                    f"Masses join the spin of {mine[0]!r} to {', '.join(lateral)}, which a compiled run cannot; simulate it on the engine."
                )
    return turning


def _selected(names: Sequence[str], matrix: FloatArray, kept: Sequence[str]) -> ConstantMass:
    at = np.array([names.index(name) for name in kept], int)
    return ConstantMass(kept, matrix[at[:, None], at])


def _spinning_rotors(network: Network, mass: ConstantMass) -> list[_Spinning]:
    found: list[_Spinning] = []
    pushes: list[tuple[dict[str, float], dict[str, float]]] = []
    known = set(mass.names)
    for rotor in network.rotors:
        body = rotor.body
        (xx, xy, _), (_, yy, _), _ = body.inertia
        if abs(xx - yy) + 2.0 * abs(xy) > ROUNDNESS * (xx + yy):
            raise ParameterError(
                f"Rotor {rotor.name!r} is not round: its moments of inertia about two diameters, {xx:.6g} and {yy:.6g} kg m^2 "
                f"(product {xy:.3g}), differ by more than {ROUNDNESS:g} of them. "
                "Give it less tilt or eccentricity, or simulate it on the engine."
            )
        x, y, _, psi, theta, _ = rotor.coordinates
        sx, sy, jx, jy = body.unbalance  # S = sx + i sy and J = jx + i jy
        # forces of A + i B; b has those of -i (A + i B)
        cosine = {x: sx, y: sy, psi: jy, theta: -jx}
        sine = {x: -sy, y: sx, psi: jx, theta: jy}
        cosine, sine = ({name: value for name, value in push.items() if name in known} for push in (cosine, sine))
        columns = mass.column(cosine), mass.column(sine)
        carried = 0.5 * (_dot(cosine, columns[0]) + _dot(sine, columns[1]))
        pushes.append((cosine, sine))
        found.append(_Spinning(rotor, *columns, mass.column({psi: 1.0}) if psi in known else {}, carried))
    _check_couplings(found, pushes)
    return found


def _check_couplings(found: Sequence[_Spinning], pushes: Sequence[tuple[dict[str, float], dict[str, float]]]) -> None:
    for part, (cosine, sine) in zip(found, pushes, strict=True):
        uneven = abs(_dot(cosine, part.cosine) - _dot(sine, part.sine)) + 2.0 * abs(_dot(cosine, part.sine))
        others = [other for other in found if other is not part]
        shared = sum(abs(_dot(push, column)) for other in others for push in (cosine, sine) for column in (other.cosine, other.sine))
        for size, what in ((uneven, "moves masses that differ in x and y"), (shared, "shakes the other rotors through shared masses")):
            if size > COUPLING * part.rotor.body.polar:
                raise ParameterError(
                    f"The unbalance of {part.rotor.name!r} {what}: {size:.3g} kg m^2 of its polar inertia of "
                    f"{part.rotor.body.polar:.3g} kg m^2, more than {COUPLING:g} of it. "
                    "Give it less eccentricity and tilt, or simulate it on the engine."
                )


def _dot(a: Mapping[str, float], b: Mapping[str, float]) -> float:
    return sum(value * b.get(name, 0.0) for name, value in a.items())


def _forces(network: Network, moment: Moment) -> dict[str, Value]:
    """Forces of all elements on the coordinates, and rates of states."""
    known = {body.name for body in network.bodies} | {state.name for state in network.states}
    others: dict[str, Value] = {}
    for element in network.elements:
        if isinstance(element, MatrixElement):
            continue
        for target, value in element.contribution(moment).items():
            if target in known:
                others[target] = others.get(target, 0.0) + value
    for rotor in network.rotors:
        _add_gyroscope(rotor, moment, others)
    return {name: force for name, force in linear_forces(network.matrices, moment, others).items() if name in known}


def _add_gyroscope(rotor: Rotor, moment: Moment, forces: dict[str, Value]) -> None:
    _, _, _, psi, theta, spin = rotor.coordinates
    momentum = rotor.sense * rotor.body.polar * moment.speed(spin)
    forces[psi] = forces.get(psi, 0.0) - momentum * moment.speed(theta)
    forces[theta] = forces.get(theta, 0.0) + momentum * moment.speed(psi)


def _phase(part: _Spinning, moment: Moment) -> _Phase:
    if not (part.cosine or part.sine):
        return _Phase(0.0, 0.0)
    angle = part.rotor.sense * moment.angle(part.rotor.coordinates[5])
    return _Phase(np.cos(angle), np.sin(angle))


def _taken(part: _Spinning, phase: _Phase, moment: Moment, lateral: Mapping[str, Value]) -> Value:
    """Torque that lateral accelerations take from a spin that does not speed up, true sense:  b.g + Jp (theta psi'' + psi' theta')."""
    x, y, _, psi, theta, spin = part.rotor.coordinates
    body = part.rotor.body
    sx, sy, jx, jy = body.unbalance
    gx, gy, gpsi, gtheta = (lateral.get(name, 0.0) for name in (x, y, psi, theta))
    # b.g = Re((S (gy + i gx) + J (gpsi - i gtheta)) exp(i phi))
    taken = phase.cosine * (sx * gy - sy * gx + jx * gpsi + jy * gtheta)
    taken = taken - phase.sine * (sy * gy + sx * gx + jy * gpsi - jx * gtheta)
    shaken = part.cosine.get(psi, 0.0) * phase.cosine + part.sine.get(psi, 0.0) * phase.sine
    full = gpsi + moment.speed(spin) * moment.speed(spin) * shaken
    return taken + body.polar * (moment.angle(theta) * full + moment.speed(psi) * moment.speed(theta))


def _tilted(part: _Spinning, phase: _Phase, moment: Moment, inertia: float) -> Value:
    """By what part a spin speeds up faster because tilting lets the rotor slip: the change of b.M^-1 b with theta over its inertia."""
    _, _, _, psi, theta, _ = part.rotor.coordinates
    polar, tilt = part.rotor.body.polar, moment.angle(theta)
    shaken = part.sine.get(psi, 0.0) * phase.cosine - part.cosine.get(psi, 0.0) * phase.sine
    return tilt * (2.0 * polar / inertia * shaken + polar**2 / inertia * part.lean.get(psi, 0.0) * tilt)


def _add_shaking(part: _Spinning, phase: _Phase, moment: Moment, acceleration: Value, late: dict[str, Value]) -> None:
    """Lateral accelerations from the unbalance and from a spin that speeds up while the rotor is tilted."""
    _, _, _, _, theta, spin = part.rotor.coordinates
    square = moment.speed(spin) * moment.speed(spin)
    moved = -part.rotor.body.polar * (acceleration * moment.angle(theta))
    across = square * phase.cosine + acceleration * phase.sine, square * phase.sine - acceleration * phase.cosine
    for factors, value in ((part.cosine, across[0]), (part.sine, across[1]), (part.lean, moved)):
        for name, factor in factors.items():
            late[name] = late.get(name, 0.0) + factor * value

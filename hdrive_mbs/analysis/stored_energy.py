"""Energy that elements hold and can give back: elastic, of height, and in states."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping

import numpy as np

from hdrive_mbs.analysis.drive_train.elastic_law import ElasticLaw
from hdrive_mbs.analysis.time_response import read_over
from hdrive_mbs.expression import Expression, TraceError, Value, derivative, evaluate, record, trace, variable, variables
from hdrive_mbs.network.coupling import Coupling
from hdrive_mbs.network.elements import AppliedTorque, Connection, Element
from hdrive_mbs.network.matrix_element import MatrixElement
from hdrive_mbs.network.moment import Moment, recording_moment
from hdrive_mbs.network.network import Network
from hdrive_mbs.signals import FloatArray

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(4)
PANELS = 32
"""Parts into which the way from zero to a displacement is cut, so that the corner of a contact lies in a short one."""
SPIN = "phi"


def stored_energy(network: Network, element: Element, ends: Moment) -> FloatArray | None:
    """Energy [J] at each moment, or None for an element that holds none or whose forces have no potential.

    Connections: area under the law at rest.  Matrices: q.K q / 2, the part of K that is symmetric.  Bearing laws:
    work of the forces at rest on the straight way from zero, where they are the gradient of an energy.
    """
    if isinstance(element, Connection):
        return _of_connection(network, element, ends)
    if isinstance(element, MatrixElement):
        return read_over(element.stored, ends) if element.stiffness.any() or element.damping.any() else None
    if isinstance(element, AppliedTorque):
        return None if element.stored is None else read_over(element.stored, ends)
    if isinstance(element, Coupling):
        return _of_coupling(element, ends)
    return None


def _of_connection(network: Network, connection: Connection, ends: Moment) -> FloatArray:
    """Area under the law at rest from zero twist, plus the energy that its effects hold in states."""
    law = ElasticLaw.of(network, connection.name)
    twist = read_over(connection.stretch, ends)
    fine = np.linspace(twist.min(), twist.max(), 2001)  # so that corners of the law lie in short intervals
    marks, place = np.unique(np.concatenate([[0.0], fine, twist]), return_inverse=True)
    half = 0.5 * np.diff(marks)
    points = marks[:-1, None] + half[:, None] * (1.0 + _NODES)
    area = np.concatenate([[0.0], np.cumsum(half * (law.torque(points) @ _WEIGHTS))])
    area -= area[np.searchsorted(marks, 0.0)]
    energy = area[place[-len(twist) :]]
    for claim in connection.parts:
        if claim.stored is not None:
            energy = energy + read_over(claim.stored, ends)
    return np.asarray(energy, float)


def _of_coupling(coupling: Coupling, ends: Moment) -> FloatArray | None:
    """Work of the forces at rest from zero displacement at the spin angle of the moment."""
    forces = _recorded(coupling)
    if forces is None:
        return None
    size = np.shape(ends.time)
    stretches = {key: np.broadcast_to(value, size) for key, value in coupling.along(ends.angles).items()}
    still: dict[str, Value] = {f"v:{key}": np.zeros(size) for key in stretches}
    if not _is_gradient(forces, stretches, still):
        return None
    total = np.zeros(size)
    for panel, (node, weight) in itertools.product(range(PANELS), zip(_NODES, _WEIGHTS)):
        share = (panel + 0.5 * (1.0 + node)) / PANELS
        here = still | {f"s:{key}": value if key == SPIN else share * value for key, value in stretches.items()}
        for key, force in forces.items():
            if key != SPIN:
                total = total + 0.5 * weight / PANELS * evaluate(force, here) * stretches[key]
    return np.asarray(total, float)


def _recorded(coupling: Coupling) -> dict[str, Expression] | None:
    """The forces as expressions of stretches s: and rates v:, None where time or the spin speed drives them."""
    s = {key: variable(f"s:{key}") for key in coupling.stretches}
    v = {key: variable(f"v:{key}") for key in coupling.stretches}
    found: dict[str, Value] = {}

    def total(moment: Moment) -> Value:
        found.update(coupling.forces(moment, s, v))
        return 0.0

    try:
        trace(total, recording_moment())
        recorded = {key: record(value) for key, value in found.items()}
    except TraceError:
        return None
    for key, force in recorded.items():
        driven = {"t"} if key == SPIN else {"t", f"v:{SPIN}"}
        if driven & variables(force) or any(name[:2] not in ("s:", "v:") for name in variables(force)):
            return None
    return recorded


def _is_gradient(forces: Mapping[str, Expression], stretches: Mapping[str, FloatArray], still: Mapping[str, Value]) -> bool:
    """Whether dF_i/ds_j = dF_j/ds_i at the places visited, and no force turns the spin at zero displacement."""
    pick = np.unique(np.linspace(0, len(next(iter(stretches.values()))) - 1, 50).astype(int))
    here: dict[str, Value] = {name: np.zeros(len(pick)) for name in still}
    here |= {f"s:{key}": value[pick] for key, value in stretches.items()}

    def slope(i: str, j: str) -> FloatArray:
        return np.broadcast_to(evaluate(derivative(forces[i], f"s:{j}"), here), pick.shape) if i in forces else np.zeros(pick.shape)

    size = max((float(np.max(np.abs(slope(i, j)))) for i in forces for j in stretches), default=0.0)
    apart = (float(np.max(np.abs(slope(i, j) - slope(j, i)))) for i, j in itertools.combinations(stretches, 2))
    if any(value > 1e-9 * size for value in apart):
        return False
    centred = here | {f"s:{key}": np.zeros(len(pick)) for key in stretches if key != SPIN}
    return SPIN not in forces or bool(np.all(np.abs(evaluate(forces[SPIN], centred)) <= 1e-12 * size))


def power_of(element: Element) -> Callable[[Moment], Value]:
    """Power that an element takes from the coordinates [W]."""
    own: Callable[[Moment], Value] | None = getattr(element, "power", None)
    if own is not None:
        return own

    def power(moment: Moment) -> Value:
        return -sum((force * moment.speed(name) for name, force in element.contribution(moment).items()), 0.0 * moment.time)

    return power

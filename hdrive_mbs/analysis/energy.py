"""Balance of energy and of angular momentum over a run."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from hdrive_mbs.analysis.result import Result
from hdrive_mbs.analysis.stored_energy import power_of, stored_energy
from hdrive_mbs.analysis.time_response import Response, channel_of, read_over
from hdrive_mbs.errors import AnalysisError
from hdrive_mbs.expression import Value
from hdrive_mbs.network.coupling import Gyroscope
from hdrive_mbs.network.elements import AppliedTorque, Connection, Element, StateRate
from hdrive_mbs.network.matrix_element import MatrixElement
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.network import Network
from hdrive_mbs.printed_table import PrintedTable
from hdrive_mbs.signals import FloatArray

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(4)
PER_STEP = len(_NODES)


@dataclass(frozen=True, kw_only=True, eq=False)
class EnergyBalance(Result):
    """Energy and angular momentum of all bodies against what flows in and out.

    times : s, shape (n,)
    kinetic : kinetic energy of all bodies [J]
    work : element -> energy it has taken from the bodies since the start [J]; negative where it drives
    driven : prescribed place -> work that its drive has done since the start [J]
    stored : element -> recoverable energy [J]: elastic, of height, and what effects hold in states
    dissipated : element -> energy turned into heat since the start [J]: work less growth of stored.  A bearing whose
        forces have no potential (sliding bearings) has work only; one with cross-coupled stiffness, and a shaft with
        rotating damping, can deliver energy, so theirs may be negative
    energy_residual : kinetic - initial kinetic + sum(work) - sum(driven) [J]: zero for an exact solution
    momentum : angular momentum of all bodies about the common axis, true sense [N m s]
    impulse : source -> impulse of each outer torque since the start, true sense [N m s]: torques on bodies, and
        the reactions of the ground (housings) and of prescribed places
    momentum_residual : momentum - initial momentum - sum(impulse) [N m s]
    energy_scale, momentum_scale : the largest energy and angular momentum that occur, for comparison

    Where places move across the axis (rotor lines) momentum is not balanced: bearings put forces at a distance from
    the axis, which act about it too.  Its arrays are empty there, ``impulse`` has no entries, ``momentum_scale`` is nan.
    A prescribed rotor does the work of its unbalance through the forces ``<rotor>.unbalance_...`` in ``work``.
    """

    times: FloatArray
    kinetic: FloatArray
    work: Mapping[str, FloatArray]
    driven: Mapping[str, FloatArray]
    stored: Mapping[str, FloatArray]
    dissipated: Mapping[str, FloatArray]
    energy_residual: FloatArray
    momentum: FloatArray
    impulse: Mapping[str, FloatArray]
    momentum_residual: FloatArray
    energy_scale: float
    momentum_scale: float

    @property
    def energy_error(self) -> float:
        """Largest energy residual over the largest energy."""
        return float(np.max(np.abs(self.energy_residual))) / self.energy_scale

    @property
    def momentum_error(self) -> float:
        """Largest momentum residual over the largest momentum.  Raises AnalysisError for a rotor line."""
        if not len(self.momentum):
            raise AnalysisError("Angular momentum is not balanced for rotor lines: bearings act about the axis too. Use energy_error.")
        return float(np.max(np.abs(self.momentum_residual))) / self.momentum_scale

    @property
    def total(self) -> FloatArray:
        """Kinetic plus recoverable energy [J]: constant when nothing drives, loads or damps."""
        return self.kinetic + sum(self.stored.values(), np.zeros_like(self.kinetic))

    def tables(self) -> tuple[PrintedTable, ...]:
        """What each element has done by the end of the run, and how well the balance holds."""
        names = dict.fromkeys([*self.driven, *self.work, *self.stored, *self.dissipated])
        groups = (self.driven, self.work, self.stored, self.dissipated)
        rows = tuple((name, *(float(group[name][-1]) if name in group else math.nan for group in groups)) for name in names)
        heads = ("at the end of the run", "work of its drive [J]", "taken from the bodies [J]", "stored [J]", "turned into heat [J]")
        notes = [
            f"kinetic energy {self.kinetic[0]:.6g} J at the start, {self.kinetic[-1]:.6g} J at the end",
            f"largest energy residual {self.energy_error:.3g} of the largest energy, {self.energy_scale:.6g} J",
        ]
        if len(self.momentum):
            notes.append(f"largest momentum residual {self.momentum_error:.3g} of the largest momentum, {self.momentum_scale:.6g} N m s")
        return (PrintedTable(heads=heads, rows=rows, notes=tuple(notes)),)

    def columns(self) -> dict[str, np.ndarray]:
        table = {"time [s]": self.times, "kinetic [J]": self.kinetic}
        for title, values in (("work of", self.work), ("driven by", self.driven), ("stored in", self.stored), ("heat of", self.dissipated)):
            table |= {f"{title} {name} [J]": column for name, column in values.items()}
        table["energy residual [J]"] = self.energy_residual
        if not len(self.momentum):
            return table
        table["angular momentum [N m s]"] = self.momentum
        table |= {f"impulse of {name} [N m s]": column for name, column in self.impulse.items()}
        return table | {"momentum residual [N m s]": self.momentum_residual}


def energy_balance(response: Response) -> EnergyBalance:
    """Where the energy and the angular momentum of a run come from and go to.

    Within each step of the solver the angles are interpolated by quintic Hermite polynomials (angle,
    speed and acceleration at both ends), and powers and torques are integrated with four Gauss points.
    That is of order 5, no lower than any of the solvers, so the residuals show the error of the
    solver; only in the steps in which a law jumps the quadrature has an error of its own.  The elastic
    energy of a connection is the area under its law at rest; of a bearing law the work of its forces at rest.
    Rotor lines have a balance of energy only (see EnergyBalance).

    Raises AnalysisError for a response without its scene, or recorded more coarsely than the
    solver's own steps.
    """
    if response.scene is None:
        raise AnalysisError("The response came from a file that could not hold its scene (a Python function in it); simulate it again.")
    if response.settings.get("sample_step"):
        raise AnalysisError(
            f"The response was recorded every {response.settings['sample_step']:g} s, not at every step of the solver, so an imbalance "
            "would show the gaps in the record; simulate with sample_step=0."
        )
    network = response.scene.network()
    ends, inner = _moments(network, response)
    width = np.diff(response.times)

    def integral(function: Callable[[Moment], Value]) -> FloatArray:
        """Cumulative time integral of a quantity, by Gauss quadrature in each step."""
        at = read_over(function, inner).reshape(len(width), PER_STEP)
        return np.concatenate([[0.0], np.cumsum(0.5 * width * (at @ _WEIGHTS))])

    kinetic = read_over(network.kinetic_energy, ends)
    zero = np.zeros_like(kinetic)
    working = _working(network)
    work = {element.name: integral(power_of(element)) for element in working}
    driven = {
        motion.name: integral(lambda m, n=motion.name: -_on(working, m, n) * m.speed(n))  # type: ignore[misc]
        for motion in network.motions
        if motion.name != "ground"
    }
    held = {element.name: stored_energy(network, element, ends) for element in working}
    stored = {name: energy for name, energy in held.items() if energy is not None}
    dissipated = {name: work[name] - (stored[name] - stored[name][0]) for name in stored}
    momentum, impulse, imbalance, scale = np.zeros(0), dict[str, FloatArray](), np.zeros(0), math.nan
    if not network.is_lateral:
        momentum = read_over(lambda m: sum(body.sense * body.inertia * m.speed(body.name) for body in network.bodies), ends)
        impulse = _impulses(network, integral)
        imbalance = momentum - momentum[0] - sum(impulse.values(), zero)
        scale = _largest([momentum, *impulse.values(), read_over(lambda m: _moved(network, m), ends)])
    return EnergyBalance(
        scene=response.scene,
        status=response.status,
        settings={"solver": response.settings.get("solver"), "duration": response.settings.get("duration")},
        times=response.times,
        kinetic=kinetic,
        work=work,
        driven=driven,
        stored=stored,
        dissipated=dissipated,
        energy_residual=kinetic - kinetic[0] + sum(work.values(), zero) - sum(driven.values(), zero),
        momentum=momentum,
        impulse=impulse,
        momentum_residual=imbalance,
        energy_scale=_largest([kinetic, *work.values(), *driven.values(), *stored.values()]),
        momentum_scale=scale,
    )


def _working(network: Network) -> list[Element]:
    """Elements that can do work: all but equations of states, gyroscopic moments and matrices of mass alone."""
    idle = (StateRate, Gyroscope)
    found = [element for element in network.elements if not isinstance(element, idle)]
    return [e for e in found if not isinstance(e, MatrixElement) or e.stiffness.any() or e.damping.any()]


def _largest(columns: list[FloatArray]) -> float:
    size = max(float(np.max(np.abs(column))) for column in columns)
    return size if size > 0.0 else 1.0


def _moved(network: Network, moment: Moment) -> Value:
    """Sum of the sizes of all angular momenta: the scale against which they may cancel."""
    return sum(body.inertia * np.abs(moment.speed(body.name)) for body in network.bodies)


def _on(elements: list[Element], moment: Moment, name: str) -> Value:
    """Sum of all torques on a coordinate, forward sense (also on one that is prescribed)."""
    return sum((element.contribution(moment).get(name, 0.0) for element in elements), 0.0 * moment.time)


def _impulses(network: Network, integral: Callable[[Callable[[Moment], Value]], FloatArray]) -> dict[str, FloatArray]:
    """Impulse of each outer torque, true sense.

    A connection works between bodies; what it puts on the ground or on a prescribed place comes back
    as the reaction of that place, with the opposite sign.
    """
    senses = {body.name: body.sense for body in network.bodies}
    result = {
        element.name: integral(lambda m, e=element: senses[e.coordinate] * e.value(m))  # type: ignore[misc]
        for element in network.elements
        if isinstance(element, AppliedTorque) and element.coordinate in senses
    }
    connections = [element for element in network.elements if isinstance(element, Connection)]
    for motion in network.motions:

        def reaction(moment: Moment, name: str = motion.name, sense: int = motion.sense) -> Value:
            total: Value = 0.0 * moment.time
            for connection in connections:
                total = total + connection.contribution(moment).get(name, 0.0)
            return -sense * total

        if any(motion.name in {*c.factors, *(name for term in c.terms for name in term.factors)} for c in connections):
            result[f"held at {motion.name}"] = integral(reaction)
    return result


def _moments(network: Network, response: Response) -> tuple[Moment, Moment]:
    """All moments at the ends of the steps, and at the Gauss points inside them."""
    times = response.times
    inner = _inner_times(times)
    angles: dict[str, FloatArray] = {}
    angles_inside: dict[str, FloatArray] = {}
    speeds: dict[str, FloatArray] = {}
    speeds_inside: dict[str, FloatArray] = {}
    states: dict[str, FloatArray] = {}
    states_inside: dict[str, FloatArray] = {}
    for body in network.bodies:
        q, w, a = (body.sense * response.values[channel_of(body, kind)] for kind in ("angle", "speed", "acceleration"))
        angles[body.name], speeds[body.name] = q, w
        angles_inside[body.name], speeds_inside[body.name] = _quintic(times, q, w, a)
    for state in network.states:
        states[state.name] = response.values[state.name]
        states_inside[state.name] = response[state.name].at(inner)
    return (
        network.moment(times, angles, speeds, states),
        network.moment(inner, angles_inside, speeds_inside, states_inside),
    )


def _inner_times(times: FloatArray) -> FloatArray:
    return (times[:-1, None] + 0.5 * np.diff(times)[:, None] * (1.0 + _NODES)).ravel()


def _quintic(times: FloatArray, q: FloatArray, w: FloatArray, a: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Quintic Hermite polynomial through q, w, a at both ends of each step, and its slope, at the Gauss points.

    q(s) = q0 + h w0 s + h^2 a0 s^2/2 + c3 s^3 + c4 s^4 + c5 s^5,  s = 0..1,  with c3, c4, c5 from q, w, a at s = 1.
    """
    h = np.diff(times)
    s = 0.5 * (1.0 + _NODES)[None, :]
    dq = np.diff(q) - h * w[:-1] - 0.5 * h**2 * a[:-1]
    dw = h * np.diff(w) - h**2 * a[:-1]
    da = h**2 * np.diff(a)
    c3 = (10.0 * dq - 4.0 * dw + 0.5 * da)[:, None]
    c4 = (-15.0 * dq + 7.0 * dw - da)[:, None]
    c5 = (6.0 * dq - 3.0 * dw + 0.5 * da)[:, None]
    q0, w0, a0, h = q[:-1, None], w[:-1, None], a[:-1, None], h[:, None]
    value = q0 + s * (h * w0 + s * (0.5 * h**2 * a0 + s * (c3 + s * (c4 + s * c5))))
    slope = w0 + s * h * a0 + s**2 * (3.0 * c3 + s * (4.0 * c4 + s * 5.0 * c5)) / h
    return value.ravel(), slope.ravel()

"""Statics of a scene with some places held: how a torque at one place is carried by the connections.

The force method: connection torques follow from equilibrium, twists from the inverse laws, and the
angle from the unit-load theorem.  Lost motion, where no stiffness exists, needs no special case.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.linalg import null_space
from scipy.optimize import root

from hdrive_mbs.analysis.drive_train.elastic_law import ElasticLaw, elastic_laws
from hdrive_mbs.errors import AnalysisError, unknown_place
from hdrive_mbs.network.network import Network
from hdrive_mbs.scene import Scene

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True)
class StaticLine:
    """What carries a torque from the place ``loaded`` to the places that are held.

    laws : of the connections that carry some of it
    unit : torque of each of them for 1 N m at the loaded place, shape (c,)
    redundant : self-equilibrated torques, shape (c, r); r = 0 where equilibrium alone decides
    """

    loaded: str
    laws: tuple[ElasticLaw, ...]
    unit: FloatArray
    redundant: FloatArray

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the connections that carry torque."""
        return tuple(law.connection.name for law in self.laws)

    @property
    def states(self) -> tuple[str, ...]:
        """States that the laws look at (hysteresis)."""
        return tuple(dict.fromkeys(state for law in self.laws for state in law.states))

    def torques(self, torque: FloatArray) -> FloatArray:
        """Torque of each connection [N m], shape (n, c), for n torques at the loaded place."""
        carried = torque[:, None] * self.unit
        if not self.redundant.shape[1]:
            return carried
        share = np.zeros(self.redundant.shape[1])
        for k, row in enumerate(carried):
            share = self._shared(row, share)
            carried[k] = row + self.redundant @ share
        return carried

    def twists(self, carried: FloatArray) -> FloatArray:
        """Twist of each connection [rad], shape (n, c)."""
        return np.column_stack([law.twist(column) for law, column in zip(self.laws, carried.T, strict=True)])

    def stiffnesses(self, twists: FloatArray, carried: FloatArray) -> FloatArray:
        """Tangent stiffness of each connection on the side of growing torque [N m/rad], shape (n, c)."""
        side = np.where(np.signbit(carried), -1.0, 1.0)
        return np.column_stack([law.stiffness(x, s) for law, x, s in zip(self.laws, twists.T, side.T, strict=True)])

    def compliances(self, stiffness: FloatArray) -> FloatArray:
        """Part of each connection in the compliance at the loaded place [rad/(N m)], shape (n, c).

        c_i = (dT_i/dT)^2 / k_i;  their sum is the compliance there.
        """
        flexibility = np.divide(1.0, stiffness, out=np.full_like(stiffness, np.inf), where=stiffness > 0.0)
        result = np.empty_like(flexibility)
        N = self.redundant
        for k, c in enumerate(flexibility):
            flow = self.unit
            if N.shape[1]:
                flow = flow - N @ np.linalg.solve(N.T @ (c[:, None] * N), N.T @ (c * self.unit))
            result[k] = np.where(flow == 0.0, 0.0, flow**2 * c)
        return result

    def _shared(self, carried: FloatArray, start: FloatArray) -> FloatArray:
        """Redundant torques at which the twists fit together."""
        N = self.redundant
        size = max(float(np.max(np.abs(carried))), 1e-12)

        def misfit(share: FloatArray) -> FloatArray:
            return np.asarray(N.T @ self.twists((carried + N @ share)[None, :])[0], float)

        found = root(misfit, start, method="hybr", options={"xtol": 1e-12})
        scale = float(np.max(np.abs(self.twists((carried + N @ found.x)[None, :])), initial=1e-12))
        if float(np.max(np.abs(misfit(found.x)))) > 1e-7 * scale:
            raise AnalysisError(
                f"The connections {', '.join(self.names)} form a closed loop whose share of {size:g} N m could not be found "
                "(lost motion inside the loop leaves it open). Measure the twist of one connection with at=... instead."
            )
        return np.asarray(found.x, float)


def static_line(scene: Scene, held: str, loaded: str) -> StaticLine:
    """The connections between a held place and a loaded one.

    All prescribed places and the ground are held too.  Torques that act on bodies (motor, load,
    friction) take no part.  Raises PlaceError for an unknown place, AnalysisError where nothing
    carries a torque between the two.
    """
    network = scene.network()
    node = {place: _node(network, place) for place in (held, loaded)}
    fixed = {motion.name for motion in network.motions} | {node[held]}
    if node[loaded] in fixed:
        raise AnalysisError(f"{loaded!r} is held itself, so nothing twists; load another place than {held!r}.")
    free = [body.name for body in network.bodies if body.name not in fixed]
    laws = list(elastic_laws(network).values())
    matrix = np.array([[law.connection.factors.get(name, 0.0) for law in laws] for name in free])
    # equilibrium of each free body:  sum_c f_ic T_c = -T at the loaded one (a load resists forward)
    right = np.array([-1.0 if name == node[loaded] else 0.0 for name in free])
    if not laws or not np.allclose(matrix @ (unit := np.linalg.lstsq(matrix, right, rcond=None)[0]), right, atol=1e-9):
        raise AnalysisError(f"{loaded!r} turns freely while {held!r} is held: no connection carries a torque between them.")
    spare = null_space(matrix, rcond=1e-10)
    used = (np.abs(unit) > 1e-12) | (np.abs(spare) > 1e-12).any(axis=1)
    carrying = tuple(law for law, is_used in zip(laws, used, strict=True) if is_used)
    return StaticLine(loaded, carrying, unit[used], spare[used])


def _node(network: Network, place: str) -> str:
    if place not in network.places:
        raise unknown_place("place", place, network.places)
    return network.places[place]

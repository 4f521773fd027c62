"""First-order states that follow lateral motion, where a turning line does not move across its axis."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import numpy.typing as npt
from scipy.optimize import root

from hdrive_mbs.errors import AnalysisError
from hdrive_mbs.network.network import Network
from hdrive_mbs.network.stretch_rate import StretchRate

FloatArray = npt.NDArray[np.float64]


class FollowingStates:
    """The states of a network whose equations are over stretches (see StretchRate), and where they come to rest."""

    def __init__(self, network: Network) -> None:
        self._network = network
        self._equations = [element for element in network.elements if isinstance(element, StretchRate)]

    def __bool__(self) -> bool:
        return bool(self._equations)

    def at_rest(self, angles: Mapping[str, float], speeds: Mapping[str, float], states: Mapping[str, float]) -> dict[str, float]:
        """Their values where no rate is left, with coordinates, speeds and all other states given.

        Raises AnalysisError where there are none.
        """
        names = [equation.state for equation in self._equations]

        def rates(values: FloatArray) -> FloatArray:
            moment = self._network.moment(np.float64(0.0), angles, speeds, {**states, **dict(zip(names, values, strict=True))})
            return np.array([float(np.asarray(equation.rate(moment))) for equation in self._equations])

        found = root(rates, np.zeros(len(names)), tol=1e-14)
        scale = float(np.max(np.abs(rates(np.zeros(len(names))))))
        if float(np.max(np.abs(rates(found.x)))) > 1e-9 * scale:
            raise AnalysisError(
                f"States that follow the whirl do not come to rest where the line turns steadily: {', '.join(names)}. Look at their law."
            )
        return dict(zip(names, found.x.tolist(), strict=True))

"""Whether every law gives a number where a run begins; asked once all have been read, so that other faults are named before."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from hdrive_mbs.errors import HdriveError, LawError
from hdrive_mbs.expression import Value
from hdrive_mbs.network.elements import Element
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.network import Network


def check_laws_at_start(network: Network, starts: Mapping[str, Mapping[str, float]]) -> None:
    """Raise LawError for a law whose torque or rate is no finite number at t = 0; the run would be said to diverge.

    starts : forward angles, speeds and states, see ``initial_values``
    """
    angles, speeds, states = ({name: np.float64(value) for name, value in starts[kind].items()} for kind in ("angles", "speeds", "states"))
    moment = network.moment(np.float64(0.0), angles, speeds, states)
    with np.errstate(all="ignore"):
        for element in network.elements:
            for target, value in _contribution(element, moment).items():
                if not np.isfinite(np.asarray(value, float)).all():
                    at = ", ".join(
                        f"{name} = {float(values[target]):.6g} {unit}"
                        for name, values, unit in (("angle", moment.angles, "rad"), ("speed", moment.speeds, "rad/s"))
                        if target in values and not _lateral(network, target)
                    )
                    raise LawError(
                        f"{element.name} gives {float(np.asarray(value, float).ravel()[0])} on {target} at t = 0{f' ({at})' if at else ''}:"
                        " no finite number. Correct the law there, like np.sign(w) or np.tanh(w/small) in place of w/abs(w)."
                    )


def _contribution(element: Element, moment: Moment) -> dict[str, Value]:
    try:
        return element.contribution(moment)
    except HdriveError:
        raise
    except Exception as error:
        raise LawError(f"{element.name}: the law fails at the start ({type(error).__name__}: {error}). Correct the function.") from error


def _lateral(network: Network, name: str) -> bool:
    return any(body.lateral for body in network.bodies if body.name == name)

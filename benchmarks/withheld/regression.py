"""Baseline: sparse regression on the equations of motion, without any simulation.

Angles are smoothed and differentiated, the nominal equations of the drive bench are written down at each sample, and
what they leave is regressed on a library of terms.  Three equations can be written from what is measured:

    load:    output torque - load torque          = J a + b w                  (a, w of the load)
    motor:   motor torque - output torque/u       = (J + J_wg) a + b w + c d2/dt2 (motor torque, output torque)
    twist:   motor angle/u - load angle           = torsion of the springs in line under the output torque

In each, the nominal terms are fitted together with the library by least squares, terms are added one by one while the
Bayesian information criterion falls (Schwarz 1978; forward selection instead of the thresholds of Brunton et al. 2016),
and the term whose first entry gains most over all three equations is the answer.  Parametric causes, lags and sensors
other than eccentric ones have no term: they cannot be seen.  Nor can lost motion: that of the gear is a nominal term.
"""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt
from scipy.signal import savgol_filter

from benchmarks.withheld.answer import answer_of
from benchmarks.withheld.finding import Claimed, Finding
from benchmarks.withheld.methods import Solved, records_of
from benchmarks.withheld.names import Label, names_of
from hdrive_mbs.records.record import Record
from models.drive_bench import FLEXSPLINE_INERTIA, NOMINAL, RATIO, TORQUE_1, TORQUE_2

FloatArray = npt.NDArray[np.float64]

WINDOW, DEGREE, EVERY = 31, 3, 10
"""Samples and degree of the local polynomial (Savitzky, Golay 1964), and samples from one that is used to the next: so far
apart that their errors are nearly independent."""
GAIN, SHARE = 10.0, 0.005
"""Fall of the criterion from which a term counts ("very strong", Kass and Raftery 1995), and share of what the equation leaves
that it has to explain as well: the equations themselves are only nearly true (on the four nulls of an open set the largest share
was 0.0033)."""
LOADED = 3.0
"""Output torque above which the twist is looked at [N m]: below, the gear is inside its lost motion."""
SIZE_MOTOR, SIZE_LOAD = 1.0, 0.01
"""Speeds over which the sign of a speed is rounded [rad/s]."""
MOST = 3
"""Terms that an equation may take."""


@dataclass(frozen=True, kw_only=True)
class Equation:
    """left side = nominal terms + library; terms of the library by label, each one or two columns."""

    left: FloatArray
    nominal: FloatArray
    library: Mapping[Label, FloatArray]


def regression(bench: str, folder: Path) -> Solved:
    """The answer of the regression.  Raises ValueError for another bench than the drive."""
    if bench != "drive":
        raise ValueError("the regression is written for the drive bench.")
    start = time.monotonic()
    parts = [equations(record) for record in records_of(folder)]
    gains: dict[Label, float] = {}
    for number in range(3):
        for label, gain in chosen(joined([part[number] for part in parts])).items():
            gains[label] = gains.get(label, 0.0) + gain
    names = names_of(bench)
    if not gains:
        finding = Finding(verdict="none", ranking={("none", ""): 1.0}, seconds=time.monotonic() - start)
        return Solved(answer=answer_of(folder.name, finding, names))
    best = max(gains, key=lambda label: gains[label])
    weights = {label: float(np.exp(max(0.5 * (gain - gains[best]), -50.0))) for label, gain in gains.items()}
    finding = Finding(
        verdict="effect",
        claimed=(Claimed(label=best),),
        ranking={label: weight / sum(weights.values()) for label, weight in weights.items()},
        seconds=time.monotonic() - start,
    )
    return Solved(answer=answer_of(folder.name, finding, names), raw={"gains": {" at ".join(label): gain for label, gain in gains.items()}})


def joined(parts: list[Equation]) -> Equation:
    """The same equation over all records, each with an offset of its own."""
    offsets = np.concatenate([np.eye(len(parts))[[k] * len(part.left)] for k, part in enumerate(parts)])
    return Equation(
        left=np.concatenate([part.left for part in parts]),
        nominal=np.column_stack([np.concatenate([part.nominal for part in parts]), offsets]),
        library={label: np.concatenate([part.library[label] for part in parts]) for label in parts[0].library},
    )


def chosen(equation: Equation) -> dict[Label, float]:
    """Terms that forward selection takes, with the fall of the criterion at the entry of each."""
    base, taken, number = equation.nominal, {}, len(equation.left)
    before = criterion(equation.left, base)
    for _ in range(MOST):
        tried = {label: criterion(equation.left, np.column_stack([base, columns])) for label, columns in equation.library.items()}
        best = min((label for label in tried if label not in taken), key=lambda label: tried[label])
        if before - tried[best] < max(GAIN, -number * np.log(1.0 - SHARE)):
            break
        taken[best], before = before - tried[best], tried[best]
        base = np.column_stack([base, equation.library[best]])
    return taken


def criterion(left: FloatArray, columns: FloatArray) -> float:
    """Bayesian information criterion n log(rest/n) + k log n of a least-squares fit."""
    scale = np.sqrt(np.mean(columns**2, axis=0)) + 1e-300
    weights = np.linalg.lstsq(columns / scale, left, rcond=None)[0]
    rest = left - (columns / scale) @ weights
    return float(len(left) * np.log(np.mean(rest**2)) + columns.shape[1] * np.log(len(left)))


def equations(record: Record) -> tuple[Equation, Equation, Equation]:
    """Load, motor and twist of one record."""
    step = record.times[1] - record.times[0]

    def smooth(name: str, derivative: int = 0) -> FloatArray:
        values = np.asarray(record.channels[name].values, float)
        found = savgol_filter(values, WINDOW, DEGREE, deriv=derivative, delta=step)
        return np.asarray(found[WINDOW:-WINDOW:EVERY])

    motor, load, torque = (smooth(name) for name in ("motor_angle", "load_angle", "output_torque"))
    brake, drive = smooth("load_torque"), smooth("motor_torque")
    motor_speed, motor_acceleration = smooth("motor_angle", 1), smooth("motor_angle", 2)
    load_speed, load_acceleration = smooth("load_angle", 1), smooth("load_angle", 2)
    input_torque = (torque + FLEXSPLINE_INERTIA * load_acceleration) / RATIO
    return (
        Equation(
            left=torque - brake,
            nominal=np.column_stack([load_acceleration, load_speed]),
            library={
                ("friction", "load"): column(np.tanh(load_speed / SIZE_LOAD)),
                ("quadratic_drag", "load"): column(load_speed * np.abs(load_speed)),
                ("eccentric_load", "load"): waves(load),
            },
        ),
        Equation(
            left=drive - input_torque,
            nominal=np.column_stack([motor_acceleration, motor_speed, smooth("output_torque", 2), smooth("motor_torque", 2)]),
            library={
                ("friction", "motor"): column(np.tanh(motor_speed / SIZE_MOTOR)),
                ("mesh_friction", "gear"): column(np.abs(torque) * np.tanh(motor_speed / SIZE_MOTOR)),
                ("quadratic_drag", "motor"): column(motor_speed * np.abs(motor_speed)),
                ("torque_ripple", "motor"): np.column_stack([waves(order * motor) for order in (1, 6, 12, 24)]),
                ("motor_curve", "motor"): column(drive),
            },
        ),
        only(
            np.abs(torque) > LOADED,
            Equation(
                left=motor / RATIO - load,
                nominal=torsion(torque, smooth("output_torque", 1), drive - NOMINAL["motor_inertia"] * motor_acceleration),
                library={
                    ("kinematic_error", "gear"): np.column_stack([waves(order * motor) for order in (1, 2, 4)]),
                    ("hysteresis", "gear"): column(np.tanh(smooth("output_torque", 1) / 10.0)),
                    ("stiffness_asymmetry", "gear"): column(np.maximum(torque, 0.0)),
                    ("encoder_eccentricity", "load_encoder"): waves(load),
                    ("encoder_eccentricity", "motor_encoder"): waves(motor),
                },
            ),
        ),
    )


def only(where: npt.NDArray[np.bool_], equation: Equation) -> Equation:
    """The equation at some samples."""
    library = {label: columns[where] for label, columns in equation.library.items()}
    return Equation(left=equation.left[where], nominal=equation.nominal[where], library=library)


def torsion(torque: FloatArray, rate: FloatArray, input_torque: FloatArray) -> FloatArray:
    """Nominal terms of the twist: the three slopes of the spring, its lost motion and damping and the input shaft."""
    size = np.abs(torque)
    slopes = [
        np.sign(torque) * np.clip(size - low, 0.0, high - low) for low, high in ((0.0, TORQUE_1), (TORQUE_1, TORQUE_2), (TORQUE_2, np.inf))
    ]
    return np.column_stack([*slopes, np.sign(torque), rate, input_torque / RATIO])


def column(values: FloatArray) -> FloatArray:
    """One column."""
    return values[:, None]


def waves(angle: FloatArray) -> FloatArray:
    """Cosine and sine of an angle."""
    return np.column_stack([np.cos(angle), np.sin(angle)])

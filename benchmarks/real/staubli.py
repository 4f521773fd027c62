"""The wrist and the other axes of a Staubli TX40: which need dry friction, and is the coupling of axes 5 and 6 found?

The file has angles and currents of the motors.  Motor 6 turns with q5 + q6 of the joints, as its shaft runs through joint 5:

    q = N^-1 q_motor,  tau = N^T i,  N = diag(32, 32, 45, -48, 45, 32) with N_65 = 32

(the authors' identification.py).  The current counts as torque there, 1 N m/A, so all torques here are those of that
convention too and compare with the authors' results; the true gain of the drives is not in the data.  The angles are in
rad of the motor: axes 2 and 3 start at 50.265/32 = -(-70.685)/45 = pi/2.  (The note beside the files says degrees.)

Each axis follows its measured angle by a controller of ours, and the torque that this takes is compared with the measured one.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cache

import numpy as np
import numpy.typing as npt

import hdrive_mbs as hm
from benchmarks.real.data import REAL
from benchmarks.real.floor import Floor, basis_of, floor
from benchmarks.real.held_out import measured
from benchmarks.real.own_effects import CouplingFriction, JointFriction
from benchmarks.real.preparing import low_pass, rates
from hdrive_mbs.diagnosis.bench import Bench, Input, Uncertain
from hdrive_mbs.records.measurement import Measurement
from hdrive_mbs.records.record import Record

FloatArray = npt.NDArray[np.float64]

SAMPLE_TIME, CORNER, THIN = 2e-4, 15.0, 150
"""Sample time of the files [s], corner of the filter [Hz], samples from one that is kept to the next."""
RATIOS = np.diag([32.0, 32.0, 45.0, -48.0, 45.0, 32.0])
RATIOS[5, 4] = 32.0
"""Angles of the motors over those of the joints."""
AXES = (1, 2, 3, 4, 5, 6)
SEEN, HELD_OUT = "first 5.4 s", "last 2.1 s"
SPLIT, END = 5.4, 7.5
"""Time [s] that ends what fits may see, and that ends the trajectory (the authors cut there too)."""
GRAVITY = 9.81
UPPER_ARM, FOREARM, FOREARM_INERTIA, ELBOW = 2.173702, 0.593324, 0.127811, 0.225
"""Of the authors' rigid-body model: first moments of what hangs on axes 2 and 3 [kg m], inertia of the forearm [kg m^2], length of the
upper arm [m].  What one axis does to the other, and gravity, is known to the nominal model from these."""
TURNED, HALF_TURNED = 1.276673, 0.489071
"""Inertia of the arm about axis 1 with the upper arm level [kg m^2], and what it loses when that stands up."""
INERTIAS = {1: 1.0, 2: 1.07, 3: 0.079, 4: 0.0317, 5: 0.0471, 6: 0.0127}
"""Nominal inertias of the axes about themselves [kg m^2] of the same source; for axis 1 the middle of its poses, for axis 6 ours."""
VISCOUS = {1: 8.0, 2: 5.5, 3: 2.0, 4: 1.1, 5: 1.9, 6: 0.67}
"""Nominal viscous drags [N m s/rad], of the same source."""
BANDWIDTH = 150.0
"""Of the controllers that make the axes follow [rad/s]."""
STEP = 1e-3
"""Of the integration [s]."""
LAWS: tuple[type[hm.Effect], ...] = (
    JointFriction,
    hm.CoulombStribeckFriction,
    hm.QuadraticDrag,
    hm.EccentricLoad,
    hm.FlexibleInertia,
    hm.IwanHysteresis,
    hm.SensorGain,
    hm.SensorOffset,
    hm.SensorDelay,
)
"""What is tried on one axis."""
WRIST_LAWS: tuple[type[hm.Effect], ...] = (*LAWS, hm.ViscousDrag, hm.SeriesCompliance, CouplingFriction)
"""What is tried on axes 5 and 6 together."""
PUBLISHED = {1: 7.231751, 2: 8.253, 3: 6.289599, 4: 2.515549, 5: 3.018672}
COUPLED = {"coulomb": 2.108124, "coefficient": 0.60856}
"""The authors' Coulomb friction of each joint [N m], and friction of the coupling of 5 and 6 [N m, N m s/rad]; of joint 6 itself they
find none.  Weighted least squares with all couplings of the rigid-body model."""


@cache
def motion() -> tuple[FloatArray, FloatArray]:
    """Angles [rad] and torques [N m] of the joints, filtered and thinned, shape (6, n)."""
    folder = REAL / "staubli_tx40"
    angles, currents = (np.loadtxt(folder / f"{name}_data.csv", delimiter=",", skiprows=1).T for name in ("pos_read", "curr"))
    joints = np.asarray(np.linalg.solve(RATIOS, angles), dtype=np.float64)
    torques: FloatArray = RATIOS.T @ currents

    def ready(rows: FloatArray) -> FloatArray:
        return np.array([low_pass(row, SAMPLE_TIME, CORNER)[::THIN] for row in rows])

    return ready(joints), ready(torques)


def scene(*axes: int) -> hm.Scene:
    """Axes, each under a controller that makes it follow; 5 and 6 joined at the wrist, where no torque acts.

    Axis 6 counts backwards beside axis 5, so the wrist turns with q5 + q6.
    """
    still = hm.AngleTable(times=(0.0, 1.0, 2.0), angles=(0.0, 0.0, 0.0))
    parts: dict[str, hm.Component] = {}
    for axis in axes:
        inertia = INERTIAS[axis]
        control = hm.ServoMotor(
            torque_limit=1e4,
            proportional_gain=1.4 * BANDWIDTH * inertia,
            integral_gain=BANDWIDTH**2 * inertia,
            reference=still,
        )
        parts[f"axis_{axis}"] = hm.Motor(inertia=inertia, viscous=VISCOUS[axis], characteristic=control)
        parts[f"torque_{axis}"] = hm.Sensor(quantity=f"axis_{axis}.torque")
    if axes == (5, 6):
        parts["wrist"] = hm.Shaft(stiffness=1e-6)
        return hm.Scene(name="Staubli TX40, axes 5 and 6", parts=parts, connections=[("axis_5", "wrist", "axis_6")])
    return hm.Scene(name=f"Staubli TX40, axis {axes[0]}", parts=parts, connections=[])


def other_axes() -> FloatArray:
    """Torque [N m] that gravity and the other axes take of each axis, shape (6, n): a double pendulum in the plane of the arm."""
    angles, _ = motion()
    speeds, accelerations = (np.array(rows) for rows in zip(*(rates(row, THIN * SAMPLE_TIME) for row in angles), strict=True))
    (_, q2, q3, *_), (_, v2, v3, *_), (_, a2, a3, *_) = angles, speeds, accelerations
    crossed = ELBOW * FOREARM
    found = np.zeros_like(angles)
    pose = TURNED - HALF_TURNED * np.cos(q2) ** 2 + 2.0 * crossed * np.sin(q2) * np.sin(q2 + q3)
    found[0] = np.gradient((pose - INERTIAS[1]) * speeds[0], THIN * SAMPLE_TIME)
    elbow = crossed * (np.cos(q3) * (2.0 * a2 + a3) - np.sin(q3) * (2.0 * v2 * v3 + v3**2))
    found[1] = elbow + FOREARM_INERTIA * (a2 + a3) - GRAVITY * (UPPER_ARM * np.sin(q2) + FOREARM * np.sin(q2 + q3))
    found[2] = crossed * (np.cos(q3) * a2 + np.sin(q3) * v2**2) + FOREARM_INERTIA * (a2 + a3) - GRAVITY * FOREARM * np.sin(q2 + q3)
    return found


def signs(axes: Sequence[int]) -> dict[int, float]:
    """-1 for axis 6 beside axis 5."""
    return {axis: -1.0 if axis == 6 and len(axes) == 2 else 1.0 for axis in axes}


def record(name: str, *axes: int) -> Record:
    """Part of the file by its name: angles from its beginning [rad] and torques of axes, less what other axes and gravity take."""
    angles, torques = motion()
    times = THIN * SAMPLE_TIME * np.arange(angles.shape[1])
    part = times < SPLIT if name == SEEN else (times >= SPLIT) & (times < END)
    known = other_axes()
    channels = {}
    for axis, sign in signs(axes).items():
        turned = sign * angles[axis - 1][part]
        for column, unit, values in (
            (f"angle_{axis}", "rad", turned - turned[0]),
            (f"torque_{axis}", "N m", sign * (torques - known)[axis - 1][part]),
        ):
            channels[column] = Measurement(name=column, unit=unit, values=values)
    return Record(name=name, times=times[part] - times[part][0], channels=channels)


@cache
def floors(*axes: int) -> dict[str, Floor]:
    """Of the torques, from what any smooth function of the motion of these axes leaves."""
    angles, torques = motion()
    end = int(SPLIT / (THIN * SAMPLE_TIME))
    known = other_axes()
    moved = {axis: (angles[axis - 1], *rates(angles[axis - 1], THIN * SAMPLE_TIME)) for axis in axes}
    found = {}
    for axis in axes:
        others = [row for other in axes if other != axis for row in moved[other][1:]]
        others += [moved[5][1] + moved[6][1]] if len(axes) == 2 else []
        basis = basis_of(*moved[axis], *others)
        found[f"torque_{axis}"] = floor([((torques - known)[axis - 1][:end], basis[:end])])
    return found


def start_speeds(name: str, *axes: int) -> dict[str, float]:
    """Speeds at the beginning of a part [rad/s]."""
    angles, _ = motion()
    at = 0 if name == SEEN else math.ceil(SPLIT / (THIN * SAMPLE_TIME))
    return {f"axis_{axis}": sign * float(rates(angles[axis - 1], THIN * SAMPLE_TIME)[0][at]) for axis, sign in signs(axes).items()}


def bench(*axes: int) -> Bench:
    """Axes as their data sheets have them: rigid, viscous drag."""
    inertias = {f"inertia_{axis}": Uncertain(paths=(f"axis_{axis}.inertia",), sigma=0.3) for axis in axes}
    drags = {f"viscous_{axis}": Uncertain(paths=(f"axis_{axis}.viscous",), sigma=0.5) for axis in axes}
    found = floors(*axes)
    return Bench(
        scene=scene(*axes),
        knowledge=inertias | drags,
        measured={f"torque_{axis}": measured(f"torque_{axis}", found[f"torque_{axis}"]) for axis in axes},
        inputs={
            f"angle_{axis}": Input(path=f"axis_{axis}.characteristic.reference", law=lambda t, v: hm.AngleTable(times=t, angles=v))
            for axis in axes
        },
    )

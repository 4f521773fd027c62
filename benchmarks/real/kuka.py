"""Axis 1 of a KUKA KR300: motor, gear, link, with a gear that the nominal model takes as rigid.

The motor follows its measured angle by a controller of ours, far faster than the motion; the torque that this takes is
compared with the measured one, and the angle of the link with its own encoder.  Nothing drifts over
10 s, as it would with the measured torque as input, and the rotor stays a free body on which friction can act.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cache

import numpy as np
import numpy.typing as npt
from scipy.io import loadmat

import hdrive_mbs as hm
from benchmarks.real.data import REAL
from benchmarks.real.floor import Floor, basis_of, floor
from benchmarks.real.held_out import measured
from benchmarks.real.preparing import low_pass, rates
from benchmarks.real.rounds import Round
from hdrive_mbs.diagnosis.bench import Bench, Input, Uncertain
from hdrive_mbs.diagnosis.candidates import candidates
from hdrive_mbs.diagnosis.fit import fit
from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.prepared import factors_of
from hdrive_mbs.diagnosis.search import fit_nominal
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.records.measurement import Measurement
from hdrive_mbs.records.record import Record

FloatArray = npt.NDArray[np.float64]

SEEN, HELD_OUT = ("A", "B"), "C"
"""C is the authors' own validation run: no fit sees it, no verdict knows it."""
AXIS = 0
CORNER, SAMPLE_TIME, THIN = 10.0, 4e-3, 10
"""Corner of the filter [Hz], sample time of the file [s], and samples from one that is kept to the next."""

RATIO, MOTOR_INERTIA = 256.85714286, 0.00923
"""Of the authors' parameter file (u, J_mr)."""
LINK_INERTIA = 1500.0
"""Order of magnitude for an arm of this class that is half stretched: 350 kg of arm and wrist at 2 m; the fit corrects it."""
VISCOUS = 2050.35 / RATIO**2
"""The authors' f_vis of the axis, referred to the motor [N m s/rad]."""
RIGID, RIGID_DAMPING = 1e8, 2e5
"""Stiffness and damping of the gear that stand for a rigid one [N m/rad, N m s/rad]: 2000 N m twist it by 20 urad, less than the floor
of the twist; half of critical damping between motor and link."""
GAIN, INTEGRAL_GAIN = 25.0, 8e3
"""Of the controller that makes the motor follow: 450 rad/s with the 0.04 kg m^2 of motor and link together, so the motor is
never more than the torque over INTEGRAL_GAIN away, 1e-3 rad or 4 urad of the link."""
STEP = 5e-4
"""Of the integration [s]."""
STIFFNESS = 4.5778e6
"""The authors' c_rad of the axis [N m/rad]: what the search does not know and is compared with."""
LAWS: tuple[type[hm.Effect], ...] = (
    hm.SeriesCompliance,
    hm.CoulombStribeckFriction,
    hm.ViscousDrag,
    hm.MeshFriction,
    hm.BoucWenHysteresis,
    hm.IwanHysteresis,
    hm.LostMotion,
    hm.KinematicError,
    hm.EccentricLoad,
    hm.FlexibleInertia,
    hm.SensorGain,
    hm.SensorOffset,
    hm.SensorDelay,
    hm.EncoderEccentricity,
)
"""What is tried: everything that geared axes are known for, and the faults of sensors."""


def scene() -> hm.Scene:
    """The axis with a rigid gear, at rest until a record drives it."""
    still = hm.AngleTable(times=(0.0, 1.0, 2.0), angles=(0.0, 0.0, 0.0))
    control = hm.ServoMotor(torque_limit=200.0, proportional_gain=GAIN, integral_gain=INTEGRAL_GAIN, reference=still)
    return hm.Scene(
        name="KUKA KR300, axis 1",
        parts={
            "motor": hm.Motor(inertia=MOTOR_INERTIA, viscous=VISCOUS, characteristic=control),
            "gear": hm.HarmonicDrive(
                ratio=RATIO, output_sense="same", stiffness=hm.CubicStiffness(linear=RIGID, cubic=0.0), damping=RIGID_DAMPING
            ),
            "link": hm.Load(inertia=LINK_INERTIA, torque=hm.ConstantTorque(value=0.0)),
            "torque_reading": hm.Sensor(quantity="motor.torque"),
            "link_encoder": hm.Sensor(quantity="link.angle"),
        },
        connections=[("motor", "gear", "link")],
    )


@cache
def columns() -> dict[str, dict[str, FloatArray]]:
    """Filtered columns of each run: angle of the motor [rad, of its shaft], its torque, angle of the link, torque from other axes."""
    found = {}
    for run in (*SEEN, HELD_OUT):
        name = f"2020-10-21 10s FF {run} 08ms"
        file = loadmat(REAL / "kuka_kr300" / "data" / "recorded_trajectories" / name / "data.mat", squeeze_me=True, struct_as_record=False)
        recorded = file["rec"]

        def ready(values: FloatArray) -> FloatArray:
            return low_pass(np.asarray(values, float), SAMPLE_TIME, CORNER)[::THIN]

        motor, link = (np.radians(getattr(recorded, f"act_pos_{side}_deg")[AXIS]) for side in ("mot", "se"))
        found[run] = {
            "motor_angle": ready((motor - motor[0]) * RATIO),
            "motor_torque": ready(recorded.act_torque_abs_nm[AXIS]),
            "link_angle": ready(link - link[0]),
            # of the authors' rigid-body model: what the other axes do to this one
            "other_axes": ready(file["tau_a_all"][AXIS] + file["tau_c_all"][AXIS]),
        }
    return found


UNITS = {"motor_angle": "rad", "motor_torque": "N m", "link_angle": "rad", "other_axes": "N m"}


def records(runs: Sequence[str] = SEEN) -> list[Record]:
    """Runs by name."""
    made = []
    for run in runs:
        values = columns()[run]
        times = np.asarray(THIN * SAMPLE_TIME * np.arange(len(values["link_angle"])), dtype=np.float64)
        channels = {name: Measurement(name=name, unit=UNITS[name], values=item) for name, item in values.items()}
        made.append(Record(name=run, times=times, channels=channels))
    return made


@cache
def floors() -> dict[str, Floor]:
    """Of torque and twist (so of the link's angle, as the motor's is given), from what any smooth function of motion and load leaves."""
    torque, twist = [], []
    for values in (columns()[run] for run in SEEN):
        angle = values["motor_angle"] / RATIO
        speed, acceleration = rates(angle, THIN * SAMPLE_TIME)
        torque.append((values["motor_torque"], basis_of(angle, speed, acceleration, values["other_axes"])))
        twist.append((values["link_angle"] - angle, basis_of(angle, speed, acceleration, values["motor_torque"])))
    return {"motor_torque": floor(torque), "link_angle": floor(twist)}


def bench() -> Bench:
    """The axis as its data sheet has it: inertia of the link from its size, drag and gear rigid."""
    knowledge = {"link_inertia": ("link.inertia", 0.5), "motor_inertia": ("motor.inertia", 0.05), "viscous": ("motor.viscous", 0.3)}
    found = floors()
    return Bench(
        scene=scene(),
        knowledge={name: Uncertain(paths=(path,), sigma=sigma) for name, (path, sigma) in knowledge.items()},
        measured={
            "motor_torque": measured("torque_reading", found["motor_torque"]),
            # the zeros of two encoders say nothing
            "link_angle": measured("link_encoder", found["link_angle"], offset=math.inf),
        },
        inputs={
            "motor_angle": Input(path="motor.characteristic.reference", law=lambda t, v: hm.AngleTable(times=t, angles=v)),
            "other_axes": Input(path="link.torque", law=lambda t, v: hm.TableTorque(times=t, torques=v)),
        },
    )


def lateness() -> dict[str, dict[str, float]]:
    """How late the link's encoder is against the motor's, of each axis and run: least squares of their difference over speed alone.

    Gear elasticity would differ from axis to axis and follow the torque; a late sensor has one time for all axes.
    """
    found = {}
    for run in (*SEEN, HELD_OUT):
        name = f"2020-10-21 10s FF {run} 08ms"
        file = loadmat(REAL / "kuka_kr300" / "data" / "recorded_trajectories" / name / "data.mat", squeeze_me=True, struct_as_record=False)
        for axis in range(3):
            motor, link = (
                low_pass(np.radians(getattr(file["rec"], f"act_pos_{side}_deg")[axis]), SAMPLE_TIME, CORNER) for side in ("mot", "se")
            )
            difference = (motor - link) - (motor - link).mean()
            speed, _ = rates(motor, SAMPLE_TIME)
            late = float(difference @ speed / (speed @ speed))
            found[f"axis {axis + 1}, run {run}"] = {
                "late": late,
                "difference": float(difference.std()),
                "left": float((difference - late * speed).std()),
            }
    return found


def compliance(last: Round) -> dict[str, float]:
    """The compliance of the gear asked for directly, beside all that was accepted: value, interval [rad/(N m)], gain in log likelihood.

    The authors' stiffness is 1/STIFFNESS; on the link's side the torque that accelerates it goes through the gear.
    """
    simulator = Simulator([trial for record in records() for trial in last.bench.trials(record)], STEP)
    factors = factors_of(last.bench)
    null = fit_nominal(simulator, factors)
    (candidate,) = candidates(last.bench.scene, [hm.SeriesCompliance])
    hypothesis = Hypothesis(factors, (candidate.starts[0],))
    # from none at all upwards: a nested model must not end above the one it contains
    starts = [np.append(null.z, share) for share in (0.0, 0.03, 0.1, 0.3, 1.0)]
    fitted = min((fit(simulator, hypothesis, start, steps=30) for start in starts), key=lambda item: item.cost)
    last_factor = float(hypothesis.values(np.ones(hypothesis.size))[f"{candidate.starts[0].name}.compliance"])
    curvature = fitted.curvature + np.diag(hypothesis.precisions)
    spread = last_factor * float(np.sqrt(np.linalg.inv(curvature)[-1, -1]))
    value = last_factor * float(fitted.z[-1])
    return {
        "value": value,
        "low": max(value - 1.96 * spread, 0.0),
        "high": value + 1.96 * spread,
        "authors": 1.0 / STIFFNESS,
        "gain": null.cost - fitted.cost,
    }

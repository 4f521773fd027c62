"""A Bently Nevada RK-4 rotor kit with two discs: unbalance from a run-up, and in which plane?

The files hold no time signals but what an order tracker made of them: the vector R of the vibration once per turn over
speed, and at two speeds for known unbalances with the baseline taken off.  They are turned back into what the probe would
show, A cos(spin + phase), with as many samples as make fits easy and noise that grows with their number, so a vector counts
as one vector and not as a hundred samples.

Scene: shaft of 10 mm over 560 mm between bearings, discs of 0.8 kg at nodes 8 and 20 of 24 elements between nodes 2 and 26.
The shaft's own mass sits at the discs with the share that is right for the first bending mode, and a probe at nodes 6 and 22
reads the disc beside it times the ratio of that mode there, sin(pi 4/24)/sin(pi 6/24); the second critical speed is four
times as high.  Orientation: of each pair the Y probe leads by 83 degrees, so Y lies a quarter turn before X in the sense
of rotation and takes the place of x in the scene, X that of y.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
import numpy.typing as npt

import hdrive_mbs as hm
from benchmarks.real.data import REAL
from benchmarks.real.own_effects import DiscWeight
from hdrive_mbs.diagnosis.bench import Bench, Uncertain, even_step, held_out
from hdrive_mbs.diagnosis.measured import Measured
from hdrive_mbs.diagnosis.trial import Trial
from hdrive_mbs.records.measurement import Measurement
from hdrive_mbs.records.record import Record

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]

FOLDER = REAL / "rk4_rotor"
SPAN, DIAMETER, DISC_MASS, DISC_DIAMETER, DISC_WIDTH = 0.56, 0.010, 0.8, 0.076, 0.025
DISC_POSITIONS = (0.14, 0.42)
STEEL, STEEL_SHEAR, STEEL_DENSITY = 2.06e11, 8.0e10, 7850.0
SHAFT_MASS = STEEL_DENSITY * math.pi * DIAMETER**2 / 4.0 * SPAN
SHARE = 0.5
"""Of the shaft's mass at each disc: half its modal mass m/2 over sin(pi/4)^2, which is m/2."""
PROBE_OVER_DISC = math.sin(math.pi * 4.0 / 24.0) / math.sin(math.pi * 6.0 / 24.0)
BEARING_STIFFNESS, BEARING_DAMPING = 1e6, 50.0
"""The authors' guess ("typical", uncalibrated)."""
DAMPING = 10.0
"""At each disc [N s/m]: three per cent of critical, between the authors' 4 % and the 2 % of a fitted resonance."""
RUN_UP_RATE = 18.4
"""Of the run-up [rad/s^2], which the file does not say.  After a passage the response beats with the phase (w - w_c)^2/(2 a): maxima at
1770, 1837, 1889, 1926, 1968 rpm with w_c = 1656 rpm lie 21 100 rpm^2 apart in (w - w_c)^2, so a = 231/(4 pi) rad/s^2."""
LEAD = 2.0
"""Time at constant speed before a record begins [s]: what the start shook dies out, exp(-2 * 0.02 * 173) = 1e-3."""
STEP = 2.5e-4
INCHES = 25.4e-6
"""Of a mil in m."""
GRAM_MILLIMETRES = 1e-6
"""In kg m."""
PROBES = {"probe_1x": "disc_1.y", "probe_1y": "disc_1.x", "probe_2x": "disc_2.y", "probe_2y": "disc_2.x"}
LAWS: tuple[type[hm.Effect], ...] = (
    DiscWeight,
    hm.ShaftBow,
    hm.ProbeRunout,
    hm.ProbeGain,
)
"""What makes vibration once per turn, or changes its size: the plausible ones of a kit whose weights were just screwed in."""


def scene() -> hm.Scene:
    """The kit without unbalance, turning at 1000 rpm until a record says otherwise."""
    law = hm.LinearBearing.isotropic(radial=BEARING_STIFFNESS, damping=BEARING_DAMPING, axial=BEARING_STIFFNESS)
    bearing = hm.Bearing(law=law, mass=0.05, polar_inertia=1e-4, transverse_inertia=1e-4)
    polar = DISC_MASS * DISC_DIAMETER**2 / 8.0
    disc = hm.Rotor(
        mass=DISC_MASS + SHARE * SHAFT_MASS,
        polar_inertia=polar,
        transverse_inertia=polar / 2.0 + DISC_MASS * DISC_WIDTH**2 / 12.0,
    )
    drag = hm.Bearing(law=hm.LinearBearing.isotropic(radial=0.0, damping=DAMPING))
    return hm.rotor_line(
        "RK-4 rotor kit",
        stations={
            "bearing_1": (0.0, bearing),
            "disc_1": (DISC_POSITIONS[0], disc),
            "disc_2": (DISC_POSITIONS[1], disc),
            "bearing_2": (SPAN, bearing),
        },
        shaft=DIAMETER,
        material=hm.ShaftMaterial(youngs_modulus=STEEL, shear_modulus=STEEL_SHEAR),
        attached={
            "drive": ("bearing_1", hm.DriveTorque(characteristic=hm.IdealSpeedMotor(motion=hm.ConstantSpeed(value=105.0)))),
            "drag_1": ("disc_1", drag),
            "drag_2": ("disc_2", drag),
        },
        parts={name: hm.Sensor(quantity=quantity, gain=PROBE_OVER_DISC) for name, quantity in PROBES.items()},
    )


@dataclass(frozen=True, kw_only=True, eq=False)
class OrderBench(Bench):
    """Each record is a run at the speed that goes with its name; what comes before LEAD is not compared."""

    motions: Mapping[str, hm.SpeedProfile]

    def trials(self, record: Record) -> tuple[Trial, ...]:
        motion = self.motions[record.name]
        driven = self.scene.replacing({"drive.characteristic": hm.IdealSpeedMotor(motion=motion)})
        columns = {name: np.where(record.times < LEAD, np.nan, values) for name, values in self.columns_of(record).items()}
        there = np.zeros(len(record), bool)
        begin = int(np.argmax(record.times >= LEAD))
        there[begin:] = held_out(len(record) - begin, record.name)
        places = ("bearing_1", "disc_1", "disc_2", "bearing_2")
        return (
            Trial(
                name=record.name,
                scene=driven,
                every=even_step(record),
                columns=columns,
                measured={name: self.measured[name] for name in columns},
                held_out=there,
                speeds=dict.fromkeys(places, float(motion.speed(0.0))),
            ),
        )


def bench(motions: Mapping[str, hm.SpeedProfile], noise: Mapping[str, float]) -> OrderBench:
    """The kit with what is uncertain of it: bearings guessed, damping between 2 and 4 %, steel within a per cent.

    The file of the rig calls itself uncalibrated, and where a probe looks decides how much of the mode it reads: the gain of
    each plane is known to a factor of 1.6 or so.
    """
    bearings = ("bearing_1", "bearing_2")
    gains = {f"gain_{k}": tuple(f"probe_{k}{d}.gain" for d in "xy" if f"probe_{k}{d}" in noise) for k in (1, 2)}
    return OrderBench(
        scene=scene(),
        knowledge={
            "bearing_stiffness": Uncertain(paths=tuple(f"{b}.law.stiffness_{d}" for b in bearings for d in ("xx", "yy")), sigma=0.7),
            "damping": Uncertain(paths=tuple(f"drag_{k}.law.damping_{d}" for k in (1, 2) for d in ("xx", "yy")), sigma=0.5),
            "youngs_modulus": Uncertain(paths=tuple(f"section_{k}.youngs_modulus" for k in (1, 2, 3)), sigma=0.01),
            **{name: Uncertain(paths=paths, sigma=0.5) for name, paths in gains.items() if paths},
        },
        measured={name: Measured(channel=name, noise=value) for name, value in noise.items()},
        motions=motions,
    )


def shown(times: FloatArray, motion: hm.SpeedProfile, vectors: ComplexArray) -> FloatArray:
    """What a probe shows: A cos(spin + phase) of a vector A exp(i phase) at each time; before LEAD zeros."""
    angle = np.asarray(motion.angle(times), float)
    return np.where(times < LEAD, 0.0, (vectors * np.exp(1j * angle)).real)


@cache
def run_up() -> tuple[FloatArray, ComplexArray]:
    """Speeds [rad/s] and vectors [m] of the run-up."""
    rows = np.genfromtxt(FOLDER / "runup_bode_1037_2003rpm.csv", delimiter=",", skip_header=1)
    return rows[:, 0] * math.pi / 30.0, 1e-6 * rows[:, 1] * np.exp(1j * np.radians(rows[:, 2]))


@cache
def dwells() -> dict[tuple[str, str], tuple[complex, complex, FloatArray, ComplexArray]]:
    """(condition, speed) -> unbalances of the discs [kg m], speeds [rad/s] and vectors [m] of its repetitions, (n, 4) as in PROBES."""
    with (FOLDER / "response_records_subset.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))

    def number(row: dict[str, str], name: str) -> complex:
        return complex(float(row[f"{name}_re"]), float(row[f"{name}_im"]))

    found = {}
    for key in dict.fromkeys((row["condition"], row["speed_id"]) for row in rows):
        own = [row for row in rows if (row["condition"], row["speed_id"]) == key]
        first, second = (GRAM_MILLIMETRES * number(own[0], name) for name in ("U1", "U2"))
        vectors = np.array([[INCHES * number(row, name.replace("probe_", "p")) for name in PROBES] for row in own])
        found[key] = (first, second, np.array([float(row["rpm"]) for row in own]) * math.pi / 30.0, vectors)
    return found


def influence(speed: str, without: str = "") -> tuple[ComplexArray, FloatArray, ComplexArray]:
    """Response per unbalance of each disc, measured: R = H_1 U_1 + H_2 U_2 over all conditions at a speed but one.

    Returns H (2, probes) [m/(kg m)], the standard deviation of real and imaginary parts that is left by probe [m], and the
    inverse of U^H U, (2, 2), with which the variance of H goes.
    """
    own = {name: item for (name, at), item in dwells().items() if at == speed and name != without}
    unbalances = np.array([item[:2] for item in own.values()])
    responses = np.array([item[3].mean(axis=0) for item in own.values()])
    found = np.linalg.lstsq(unbalances, responses, rcond=None)[0]
    left = (np.abs(responses - unbalances @ found) ** 2).sum(axis=0) / (2.0 * (len(own) - 2))
    return found, np.sqrt(left), np.linalg.inv(unbalances.conj().T @ unbalances)


def reproducibility() -> FloatArray:
    """Standard deviation of real and imaginary part from one mounting of weights to the next, by probe [m].

    Ten times what repeating a dwell without stopping shows: the rig is stopped, weights are screwed in, the baseline is
    taken off.  What repeats of the same dwell share is no noise of theirs, so this is the scale on which a model can be judged.
    """
    return np.asarray(np.sqrt(np.mean([influence(speed)[1] ** 2 for speed in ("N1", "N2")], axis=0)))


PER_TURN, TURNS = 8, 9
"""Samples in a turn and turns of a dwell."""


def dwell_case(condition: str) -> tuple[OrderBench, list[Record]]:
    """Bench and records of a condition at the two speeds, means of the repetitions."""
    motions: dict[str, hm.SpeedProfile] = {}
    made = []
    samples = PER_TURN * TURNS
    for name in ("N1", "N2"):
        if (condition, name) not in dwells():
            continue
        _, _, speeds, vectors = dwells()[condition, name]
        speed = float(speeds.mean())
        motion = hm.ConstantSpeed(value=speed)
        every = 2.0 * math.pi / speed / PER_TURN
        times = np.asarray(every * np.arange(math.ceil(LEAD / every) + samples), dtype=np.float64)
        channels = {
            column: Measurement(name=column, unit="m", values=shown(times, motion, np.full(len(times), vectors[:, k].mean())))
            for k, column in enumerate(PROBES)
        }
        motions[name] = motion
        made.append(Record(name=name, times=times, channels=channels))
    # n samples of a vector with this noise tell it as well as one vector with that of its parts: s^2 = sigma^2 n/2
    noise = {column: float(sigma) * math.sqrt(samples / 2.0) for column, sigma in zip(PROBES, reproducibility(), strict=True)}
    return bench(motions, noise), made


RUN_UP_SAMPLES, SEEN = 160.0, 0.8
"""Of the run-up [1/s]; the share of its time that a diagnosis sees, up to 1810 rpm, past the critical speed."""


def run_up_seen() -> float:
    """Time up to which the run-up is diagnosed [s]; what comes after is to be foretold."""
    speeds, _ = run_up()
    return LEAD + SEEN * float(speeds[-1] - speeds[0]) / RUN_UP_RATE


def run_up_case() -> tuple[OrderBench, list[Record]]:
    """Bench and record of the run-up, read by one probe; which one the file does not say."""
    speeds, vectors = run_up()
    duration = (speeds[-1] - speeds[0]) / RUN_UP_RATE
    motion = hm.SpeedTable(times=(0.0, LEAD, LEAD + duration), speeds=(speeds[0], speeds[0], speeds[-1]))
    times = np.arange(0.0, LEAD + duration, 1.0 / RUN_UP_SAMPLES)
    now = np.asarray(motion.speed(times), float)
    along = np.interp(now, speeds, vectors.real) + 1j * np.interp(now, speeds, vectors.imag)
    column = "probe_2y"
    channel = Measurement(name=column, unit="m", values=shown(times, motion, along))
    # third differences of neighbouring rows have 20 times the variance of their noise
    rough = np.diff(vectors, 3)
    sigma = float(np.median(np.abs(np.concatenate([rough.real, rough.imag])))) / 0.6745 / math.sqrt(20.0)
    compared = int((times >= LEAD).sum())
    noise = {column: sigma * math.sqrt(compared / 2.0 / len(speeds))}
    return bench({"run_up": motion}, noise), [Record(name="run_up", times=times, channels={column: channel})]


SHARED = ("A019", "A020", "A008", "A010", "A002")


def planes() -> dict[str, dict[str, Any]]:
    """How well the share of disc 2 in an unbalance is known if all the rest is: misfit over the share, size and phase adapted.

    The influence of each plane is measured, from all other conditions; its own variance counts too.
    """
    shares = np.linspace(-1.0, 2.0, 301)
    found: dict[str, dict[str, Any]] = {}
    for name in SHARED:
        there = [speed for speed in ("N1", "N2") if (name, speed) in dwells()]
        response = np.concatenate([dwells()[name, speed][3].mean(axis=0) for speed in there])
        others = [influence(speed, without=name) for speed in there]
        put = dwells()[name, there[0]][:2]
        misfit, sizes = [], []
        for share in shares:
            weights = np.array([1.0 - share, share])
            shape = np.concatenate([weights @ own for own, _, _ in others])
            lever = [1.0 + abs(sum(put)) ** 2 * float((weights @ inverse @ weights).real) for _, _, inverse in others]
            variance = np.concatenate([sigma**2 * more for (_, sigma, _), more in zip(others, lever, strict=True)])
            size = (shape.conj() / variance) @ response / ((np.abs(shape) ** 2 / variance).sum())
            misfit.append(float((np.abs(response - size * shape) ** 2 / (2.0 * variance) + np.log(variance)).sum()))
            sizes.append(abs(size))
        least = np.array(misfit) - min(misfit)
        alike = shares[least < 2.0]
        best = int(np.argmin(misfit))
        found[name] = {
            "share": shares,
            "misfit": least,
            "true_share": float((put[1] / sum(put)).real),
            "alike": [float(alike.min()), float(alike.max())],
            "best": float(shares[best]),
            "total": float(sizes[best]),
            "true_total": abs(sum(put)),
            "words": f"{abs(put[0]) / GRAM_MILLIMETRES:.0f} + {abs(put[1]) / GRAM_MILLIMETRES:.0f} g mm",
        }
    return found

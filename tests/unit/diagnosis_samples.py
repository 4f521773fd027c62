"""Answers made by hand, one of each kind, to try reports and pictures on; their numbers mean nothing."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable

import numpy as np

import hdrive_mbs as hm
from hdrive_mbs.diagnosis.result import (
    Cause,
    Diagnosis,
    DomainBin,
    Driven,
    Estimate,
    Gap,
    LatentForce,
    Loop,
    Misfit,
    OrderMap,
    Place,
    Separation,
    Trace,
)
from models import drive_bench

NAN = float("nan")
COLUMNS = {"motor_angle": ("rad", 1.1e-4), "load_angle": ("rad", 1.6e-6), "output_torque": ("N m", 0.41)}
RECORDS = ("staircase", "load_cycle", "sweep")


def misfit(value: float) -> Misfit:
    return Misfit(value=value, low=0.93 * value, high=1.09 * value)


def gap(record: str, column: str, nominal: float, refit: float, effect: float) -> Gap:
    unit, noise = COLUMNS.get(column, ("", 1.0))
    return Gap(record=record, column=column, unit=unit, noise=noise, nominal=misfit(nominal), refit=misfit(refit), effect=misfit(effect))


def trace(record: str, column: str, size: float, left: float, seed: int) -> Trace:
    """A speed that goes up and down, with a misfit that lives where it turns slowly."""
    rng = np.random.default_rng(seed)
    unit, noise = COLUMNS[column]
    times = np.linspace(0.0, 9.0, 1800)
    speed = 150.0 * np.sin(2.0 * math.pi * times / 4.5)
    torque = 30.0 * np.sin(2.0 * math.pi * times / 1.5 + 0.3)
    truth = 400.0 * noise * np.sin(2.0 * math.pi * times / 4.5 + 0.2)
    error = noise * np.tanh(speed / 20.0)
    measured = truth + noise * rng.standard_normal(len(times))
    return Trace(
        record=record,
        column=column,
        unit=unit,
        noise=noise,
        times=times,
        measured=measured,
        nominal=truth - 4.0 * size * error + 30.0 * noise * np.sin(times),
        refit=truth - size * error,
        effect=truth - left * error,
        held_out=(np.arange(len(times)) * 12 // len(times)) % 4 == 1,
        speed=speed,
        torque=torque,
        angle=np.cumsum(speed) * (times[1] - times[0]),
    )


def force(record: str) -> LatentForce:
    times = np.linspace(0.0, 9.0, 1800)
    speed = 150.0 * np.sin(2.0 * math.pi * times / 4.5) / 100.0
    rng = np.random.default_rng(7)
    return LatentForce(
        at="load",
        unit="N m",
        times=times,
        force=-6.0 * np.tanh(speed / 0.1) - 0.4 * speed + 0.3 * rng.standard_normal(len(times)),
        speed=speed,
        angle=np.cumsum(speed) * (times[1] - times[0]),
        twist=1e-3 * np.sin(2.0 * math.pi * times / 1.5),
        record=record,
        torque=30.0 * np.sin(2.0 * math.pi * times / 1.5),
        spread=np.full(len(times), 0.35),
    )


def loop(record: str) -> Loop:
    turn = np.linspace(0.0, 4.0 * math.pi, 600)
    twist = 1.2e-3 * np.sin(turn)
    centre = 3.2e4 * twist
    open_loop = np.array([twist, centre + 4.0 * np.cos(turn)])
    noisy = open_loop + np.array([[1e-6], [0.4]]) * np.random.default_rng(3).standard_normal((2, 600))
    return Loop(record=record, at="gear", measured=noisy, refit=np.array([twist, centre + 0.3 * np.cos(turn)]), effect=open_loop)


def order_map(record: str) -> OrderMap:
    speeds, orders = np.linspace(20.0, 300.0, 40), np.linspace(0.0, 8.0, 161)
    ground = 2e-6 * (1.0 + np.random.default_rng(5).random((40, 161)))
    lines = sum(size * np.exp(-(((orders - order) / 0.06) ** 2)) for order, size in ((1.0, 2e-5), (2.0, 2e-4), (4.0, 6e-5)))
    resonance = 1.0 + 3.0 * np.exp(-(((speeds - 170.0) / 15.0) ** 2))
    return OrderMap(
        record=record,
        column="motor_angle",
        unit="rad",
        reference="motor",
        speeds=speeds,
        orders=orders,
        before=ground + np.outer(resonance, lines),
        after=ground,
    )


def domain(excess: float) -> tuple[DomainBin, ...]:
    edges = np.linspace(0.0, 160.0, 9)
    shape = np.array([12.0, 5.0, 2.0, 1.0, 0.5, 0.3, 0.1, -0.02])
    found = [
        DomainBin(over="speed", unit="rad/s", low=float(a), high=float(b), excess=excess * float(s), after=0.02, samples=2000)
        for a, b, s in zip(edges[:-1], edges[1:], shape)
    ]
    found += [
        DomainBin(over="direction", unit="rad/s", low=low, high=high, excess=excess * size, after=0.03, samples=8000)
        for low, high, size in ((-160.0, -3.2, 2.6), (-3.2, 3.2, 9.0), (3.2, 160.0, 2.4))
    ]
    found += [
        DomainBin(over="order", unit="1", low=k - 0.5, high=k + 0.5, excess=excess * size, after=NAN, samples=1000)
        for k, size in ((1.0, 0.5), (2.0, 9.0), (3.0, 0.1), (4.0, 2.0))
    ]
    return tuple(found)


def parameters() -> tuple[Estimate, ...]:
    found = []
    for k, (name, value) in enumerate(drive_bench.NOMINAL.items()):
        path = drive_bench.PATHS[name][0]
        free = drive_bench.build().parameters()[path]
        sigma = drive_bench.KNOWLEDGE[name]
        now = value * (1.0 + sigma * (2.4, -1.3, 0.2, 0.6)[k % 4])
        spread = math.exp(0.3 * sigma)
        found.append(
            Estimate(
                name=name,
                unit=free.unit,
                doc=free.quantity.doc,
                value=now,
                low=now / spread,
                high=now * spread,
                nominal=value,
                tolerance=sigma,
                identifiable=k % 3 != 1,
            )
        )
    return tuple(found)


def cause(effect: str, at: str, probability: float, log_odds: float, *, law: str = "", kind: str = "force", **more: object) -> Cause:
    left = 1.02 if log_odds > 50.0 else 26.0
    return Cause(
        effect=effect,
        at=at,
        kind=kind,
        law=law,
        probability=probability,
        log_odds=log_odds,
        fit=left,
        held_out=1.02 * left,
        **more,  # type: ignore[arg-type]
    )


FRICTION = cause(
    "friction",
    "load",
    0.93,
    812.4,
    law="CoulombStribeckFriction",
    signature="a step in the residual wherever the body turns round, larger at low speed",
    parameters=(
        Estimate(name="friction.coulomb", unit="N m", doc="torque while sliding", value=6.03, low=5.91, high=6.15),
        Estimate(
            name="friction.stiction", unit="N m", doc="torque at which it breaks away", value=7.2, low=3.0, high=14.0, identifiable=False
        ),
        Estimate(name="friction.stribeck_speed", unit="rad/s", doc="speed at which it has fallen", value=0.021, low=0.017, high=0.027),
    ),
)
HYSTERESIS = cause("hysteresis", "gear", 0.04, 808.9, law="BoucWenHysteresis", kind="hidden state")
NONE = cause("none", "", 1e-4, 0.0)
OTHERS = tuple(
    cause(name, at, p, odds, law=law)
    for name, at, p, odds, law in (
        ("kinematic_error", "gear", 0.002, 44.0, "KinematicError"),
        ("lost_motion", "gear", 0.0004, 31.0, "LostMotion"),
        ("friction", "wave_generator", 0.0, 12.0, "LuGreFriction"),
        ("series_compliance", "output_shaft", 0.0, -3.0, "SeriesCompliance"),
        ("sensor_gain", "torque_sensor", 0.0, -4.1, "SensorGain"),
    )
)


def gaps(nominal: float, refit: float, effect: float) -> tuple[Gap, ...]:
    every = [gap("", "", nominal, refit, effect)]
    for k, record in enumerate(RECORDS):
        for j, column in enumerate(COLUMNS):
            worse = 1.0 + 0.4 * ((k + 2 * j) % 3)
            every.append(gap(record, column, nominal * worse, 1.0 + (refit - 1.0) * worse, effect))
    return tuple(every)


def effect() -> Diagnosis:
    """One effect, found."""
    scene = drive_bench.build()
    found = hm.CoulombStribeckFriction(coulomb=6.03, smoothing_speed=0.01)
    return Diagnosis(
        scene=scene,
        improved=scene.with_effect(found, at="load", name="friction"),
        records=RECORDS,
        verdict="effect",
        causes=(FRICTION,),
        indistinguishable=(),
        ranking=(FRICTION, HYSTERESIS, *OTHERS[:2], NONE, *OTHERS[2:]),
        where=(
            Place(at="load", probability=0.91, gain=5200.0, share=0.994),
            Place(at="output_shaft", probability=0.08, gain=5100.0, share=0.97, tied=("gear",)),
            Place(at="motor", probability=0.01, gain=300.0, share=0.2),
        ),
        gaps=gaps(34.2, 5.1, 1.02),
        parameters=parameters(),
        domain=domain(2.0),
        traces=tuple(trace(record, column, 5.0, 0.02, k) for k, record in enumerate(RECORDS[:2]) for column in COLUMNS),
        notes=("Winner and runner-up were run on Exudyn: largest difference 0.02 noise units.",),
        seconds=41.3,
        versions={"hdrive-mbs": "0.1.0", "exudyn": "1.13.6"},
        forces=(force("staircase"),),
        loops=(loop("load_cycle"),),
        order_maps=(order_map("sweep"),),
    )


def none() -> Diagnosis:
    """Nothing found."""
    return dataclasses.replace(
        effect(),
        improved=drive_bench.build(),
        verdict="none",
        causes=(),
        ranking=(dataclasses.replace(NONE, probability=0.97), *OTHERS),
        where=(),
        gaps=gaps(3.1, 1.01, 1.01),
        domain=(),
        forces=(),
        loops=(),
        order_maps=(),
    )


def parameter() -> Diagnosis:
    """A parameter that is off."""
    own = dataclasses.replace(parameters()[12], value=2.34, low=2.31, high=2.38)
    found = cause("parameter", "load inertia", 0.88, 120.0, kind="parameter", parameters=(own,))
    ranking = (found, *OTHERS, NONE)
    return dataclasses.replace(none(), verdict="parameter", causes=(found,), ranking=ranking, gaps=gaps(12.0, 3.0, 1.01))


def sensor() -> Diagnosis:
    """A sensor that is off."""
    gain = Estimate(name="sensor_gain.gain", unit="1", doc="reading over true value", value=1.043, low=1.041, high=1.045)
    found = cause("sensor_gain", "torque_sensor", 0.99, 640.0, law="SensorGain", kind="sensor", parameters=(gain,))
    return dataclasses.replace(
        effect(), verdict="sensor", causes=(found,), ranking=(found, *OTHERS[:4], NONE), forces=(), loops=(), order_maps=()
    )


def unknown() -> Diagnosis:
    """A gap that nothing explains."""
    item = dataclasses.replace(NONE, effect="unknown", probability=0.9)
    return dataclasses.replace(
        effect(), improved=drive_bench.build(), verdict="unknown", causes=(), ranking=(item, *OTHERS), gaps=gaps(40.0, 22.0, 22.0)
    )


def two() -> Diagnosis:
    """Two effects at once."""
    second = cause(
        "kinematic_error",
        "gear",
        0.81,
        300.0,
        law="KinematicError",
        kind="kinematic",
        parameters=(
            Estimate(name="kinematic_error.amplitude", unit="rad", doc="amplitude, 0-peak", value=8.1e-5, low=7.9e-5, high=8.4e-5),
            Estimate(name="kinematic_error.phase", unit="rad", doc="phase", value=0.4, low=0.3, high=0.5),
        ),
    )
    return dataclasses.replace(effect(), causes=(FRICTION, second), ranking=(FRICTION, second, *OTHERS[1:], NONE))


def tied() -> Diagnosis:
    """An effect that the records cannot tell from two others."""
    return dataclasses.replace(
        effect(),
        causes=(dataclasses.replace(FRICTION, probability=0.48),),
        indistinguishable=(("hysteresis", "gear"), ("friction", "output_shaft")),
        next_records=(
            Separation(record="slow reversals", first=("friction", "load"), second=("hysteresis", "gear"), detectability=410.0),
            Separation(record="sweep", first=("friction", "load"), second=("hysteresis", "gear"), detectability=11.0),
        ),
    )


def without_numbers() -> Diagnosis:
    """Intervals, misfits and probabilities that could not be computed."""
    lost = Misfit(value=5.0, low=NAN, high=NAN)
    gap_without = dataclasses.replace(gap("", "", 5.0, 2.0, 1.0), nominal=lost, refit=Misfit(value=NAN, low=NAN, high=NAN))
    vague = dataclasses.replace(FRICTION.parameters[0], low=-math.inf, high=math.inf)
    found = dataclasses.replace(FRICTION, probability=NAN, log_odds=math.inf, parameters=(vague,))
    return dataclasses.replace(effect(), causes=(found,), ranking=(found, NONE), gaps=(gap_without, *gaps(5.0, 2.0, 1.0)[1:]))


def without_pictures() -> Diagnosis:
    """Nothing but the answer, and its scene for a record."""
    driven = Driven(record="run 1", scene=effect().improved, duration=1.5, initial={"load.speed": 0.5})
    return dataclasses.replace(
        effect(),
        driven=(driven,),
        where=(),
        gaps=(),
        parameters=(),
        domain=(),
        traces=(),
        notes=(),
        forces=(),
        loops=(),
        order_maps=(),
        versions={},
    )


SAMPLES: dict[str, Callable[[], Diagnosis]] = {
    "none": none,
    "effect": effect,
    "parameter": parameter,
    "sensor": sensor,
    "unknown": unknown,
    "two": two,
    "tied": tied,
    "without_numbers": without_numbers,
    "without_pictures": without_pictures,
}

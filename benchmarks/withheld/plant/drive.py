"""The drive bench: motor, input shaft, harmonic drive, output shaft, load, speed controller.

A plant of its own: equations, integrator (Dormand-Prince with error control, exact sliders) and
constitutive laws share nothing with the package under test.  ``drive_train`` holds the motion and the
sensors, ``drive_causes`` what can be put in.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from benchmarks.withheld.case import Array, Case, Cause
from benchmarks.withheld.plant.drive_causes import Put, friction, gear, others, parameters, sensor_faults, unlisted
from benchmarks.withheld.plant.drive_causes.finer_detail import with_finer_detail
from benchmarks.withheld.plant.drive_train.excitation import RECORDS
from benchmarks.withheld.plant.drive_train.nominal import NOMINAL, UNCERTAINTY, drawn
from benchmarks.withheld.plant.drive_train.sensors import measured
from benchmarks.withheld.plant.drive_train.specimen import Specimen, specimen
from benchmarks.withheld.plant.drive_train.whitening import detectability, in_noise

_PUT: dict[str, Put] = {cause.name: put for part in (friction, gear, others, sensor_faults, unlisted) for cause, put in part.CAUSES}
CAUSES: tuple[Cause, ...] = (
    *(cause for part in (friction, gear, others) for cause, _ in part.CAUSES),
    *parameters.CAUSES,
    *(cause for part in (sensor_faults, unlisted) for cause, _ in part.CAUSES),
)

Site = tuple[str, str]
BARELY = 25.0  # detectability below which a cause is drawn again: it could not be told from noise and tolerance
DRAWS = 12


def may_pair(first: Site, second: Site) -> bool:
    """Two dry frictions on either end of the stiff input shaft are nearly one; all else may sit together."""
    return {first[0], second[0]} != {"friction_motor", "friction_wave_generator"}


def make_case(causes: Sequence[Site], rng: np.random.Generator, *, noise: str = "stated") -> Case:
    """Draw a specimen with these causes, simulate and measure its records.

    Parameters, detail and noise have random streams of their own, so they do not depend on the cause.
    """
    of_parameters, of_sizes, of_detail, of_noise = rng.spawn(4)
    values = drawn(of_parameters)
    detail = of_detail.bit_generator.seed_seq  # the same detail with and without a cause
    plain, detail_sizes = with_finer_detail(np.random.default_rng(detail), specimen(values))
    without = _signals(plain)
    jacobian = _jacobian(values) if causes else []
    for _ in range(DRAWS):
        seeds = {site: int(of_sizes.integers(2**63)) for site in causes}
        made = _put_in(values, causes, seeds, detail)
        channels = {record: made.channels(record) for record in RECORDS}
        alone = [_signals(_put_in(values, [site], seeds, detail)) for site in causes] if len(causes) == 2 else []
        found = _visible(_joined(channels), without, alone, jacobian)
        if not causes or min(found["each"] or [found["after_parameters"]]) >= BARELY:
            break
    else:
        raise ArithmeticError(f"No visible size of {causes} in {DRAWS} draws; widen its range.")
    memories = (
        {name: float(of_noise.uniform(0.5, 0.95)) for name in ("motor_torque", "load_angle", "output_torque")}
        if noise == "coloured"
        else {}
    )
    return Case(
        records={record: measured(record, channels[record], of_noise, memories=memories) for record in RECORDS},
        truth=_told(made, values),
        put_in=made.put_in,
        true_parameters=dict(made.values),
        more={"detectability": found, "finer_detail": detail_sizes, "noise": {"kind": noise, "memories": memories}},
    )


def _put_in(values: Mapping[str, float], causes: Sequence[Site], seeds: Mapping[Site, int], detail: np.random.SeedSequence) -> Specimen:
    """The specimen with its causes; the sizes of a cause come from its own seed, whatever others there are."""
    streams = {site: np.random.default_rng(seeds[site]) for site in causes}
    changed, wrong = dict(values), {}
    for site in causes:
        if site in parameters.SYMBOLS:
            wrong |= parameters.factors(streams[site], site)
    for name, factor in wrong.items():
        changed[name] *= factor
    made = specimen(changed)
    for site in causes:
        if site in parameters.SYMBOLS:
            made = made.told(*site, "parameter_factors", wrong)
        else:
            made = _PUT[site[0]](streams[site], site[1], made, 1.0)
    return with_finer_detail(np.random.default_rng(detail), made)[0]


def _told(made: Specimen, values: Mapping[str, float]) -> list[dict[str, Any]]:
    """The truth, with the ratio to nominal for wrong parameters."""
    found = []
    for item in made.truth:
        told = dict(item)
        symbols = parameters.SYMBOLS.get((told["effect"], told["at"]))
        if symbols:
            told["true_over_nominal"] = {name: made.values[name] / NOMINAL[name] for name in symbols}
        found.append(told)
    return found


def _signals(made: Specimen) -> Array:
    """All channels of all records in noise units."""
    return _joined({record: made.channels(record) for record in RECORDS})


def _joined(channels: Mapping[str, Mapping[str, Array]]) -> Array:
    return np.concatenate([in_noise(channels[record]) for record in RECORDS])


def _jacobian(values: Mapping[str, float]) -> list[Array]:
    """Change of all signals for one standard deviation of each uncertain parameter, by differences."""
    base, step = _signals(specimen(values)), 0.2
    return [(_signals(specimen({**values, name: values[name] * np.exp(step * size)})) - base) / step for name, size in UNCERTAINTY.items()]


def _visible(signals: Array, without: Array, alone: Sequence[Array], jacobian: Sequence[Array]) -> dict[str, Any]:
    """Detectability of all that was put in: raw, with the parameters free within their tolerance, and of each of two beside the other."""
    raw, after = detectability(signals - without, jacobian)
    each = [detectability(signals - other, [*jacobian, other - without])[1] for other in reversed(alone)]
    return {"raw": raw, "after_parameters": after, "each": each}

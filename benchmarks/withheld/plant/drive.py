"""The drive bench: motor, input shaft, harmonic drive, output shaft, load, speed controller.

A plant of its own: equations, integrator (Dormand-Prince with error control, exact sliders) and
constitutive laws share nothing with the package under test.  ``drive_train`` holds the motion and the
sensors, ``drive_causes`` what can be put in.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import Any

import numpy as np

from benchmarks.withheld.case import Case, Cause
from benchmarks.withheld.draws import log_uniform
from benchmarks.withheld.plant.drive_causes import Put, friction, gear, later_unlisted, others, parameters, sensor_faults, unlisted
from benchmarks.withheld.plant.drive_causes.finer_detail import with_finer_detail
from benchmarks.withheld.plant.drive_train.excitation import RECORDS
from benchmarks.withheld.plant.drive_train.nominal import NOMINAL, UNCERTAINTY, drawn
from benchmarks.withheld.plant.drive_train.sensors import measured
from benchmarks.withheld.plant.drive_train.specimen import Specimen, specimen
from benchmarks.withheld.plant.drive_visibility import Yardstick, signals

_EFFECTS, _REST = (friction, gear, others), (sensor_faults, unlisted, later_unlisted)
_PUT: dict[str, Put] = {cause.name: put for part in (*_EFFECTS, *_REST) for cause, put in part.CAUSES}
CAUSES: tuple[Cause, ...] = (
    *(cause for part in _EFFECTS for cause, _ in part.CAUSES),
    *parameters.CAUSES,
    *(cause for part in _REST for cause, _ in part.CAUSES),
)

Site = tuple[str, str]
FAINT = 0.25  # share of single causes that are scaled down to a detectability of FAINT_RANGE
FAINT_RANGE = (300.0, 1e6)  # 0.14 % of the noise to five times it
BARELY = 25.0  # a cause below this is drawn again: nobody could tell it from noise and tolerance
# a wider gap within the tolerance of the nominal one is no effect; lags of microseconds would be stiff
NEVER_FAINT = {"lost_motion", "actuator_lag", "brake_lag"}
TRIES = 12


def may_pair(first: Site, second: Site) -> bool:
    """Two dry frictions on either end of the stiff input shaft are nearly one; all else may sit together."""
    return {first[0], second[0]} != {"friction_motor", "friction_wave_generator"}


def make_case(causes: Sequence[Site], rng: np.random.Generator, *, noise: str = "stated") -> Case:
    """Draw a specimen with these causes, simulate and measure its records.

    Parameters, detail and noise have random streams of their own, so they do not depend on the causes.
    """
    of_parameters, of_detail, of_sizes, of_noise = rng.spawn(4)
    maker = _Maker(drawn(of_parameters), int(of_detail.integers(2**63)))
    made, found = maker.visible(causes, of_sizes) if causes else (maker.made([], {}), {"linear": 0.0})
    memories = {}
    if noise == "coloured":
        memories = {name: float(of_noise.uniform(0.5, 0.95)) for name in ("motor_torque", "load_angle", "output_torque")}
    return Case(
        records={record: measured(record, made.channels(record), of_noise, memories=memories) for record in RECORDS},
        truth=made.truth,
        put_in=made.put_in,
        true_parameters=dict(made.values),
        more={"detectability": found, "finer_detail": maker.detail_sizes, "noise": {"kind": noise, "memories": memories}},
    )


class _Maker:
    """Puts causes into one specimen with its finer detail."""

    def __init__(self, values: Mapping[str, float], detail_seed: int) -> None:
        self.values = dict(values)
        self._detail_seed = detail_seed
        self.detail_sizes = with_finer_detail(np.random.default_rng(detail_seed), specimen(values))[1]

    def made(self, causes: Sequence[Site], seeds: Mapping[Site, int], strength: float = 1.0) -> Specimen:
        """The specimen with its causes; the sizes of a cause come from its own seed, whatever others there are."""
        streams = {site: np.random.default_rng(seeds[site]) for site in causes}
        wrong = {site: parameters.factors(streams[site], site) for site in causes if site in parameters.SYMBOLS}
        values = dict(self.values)
        for name, factor in (pair for factors in wrong.values() for pair in factors.items()):
            values[name] *= factor
        found = specimen(values)
        for site in causes:
            if site in wrong:
                ratios = {name: values[name] / NOMINAL[name] for name in wrong[site]}
                found = found.told(*site, "parameter_factors", wrong[site], true_over_nominal=ratios)
            else:
                found = _PUT[site[0]](streams[site], site[1], found, strength)
        return with_finer_detail(np.random.default_rng(self._detail_seed), found)[0]

    def visible(self, causes: Sequence[Site], rng: np.random.Generator) -> tuple[Specimen, dict[str, Any]]:
        """A draw of the sizes that can be seen, and its detectability."""
        if causes[0] in parameters.SYMBOLS:  # the records fix every parameter far better than the data sheet: what is left is the prior
            made = self.made(causes, _seeds(causes, rng))
            moved = {
                name: float(np.log(made.values[name] / self.values[name])) / UNCERTAINTY[name] for name in made.put_in["parameter_factors"]
            }
            return made, {"linear": sum(deviations**2 for deviations in moved.values())}
        yardstick = _yardstick(tuple(self.values.items()))
        for _ in range(TRIES):
            seeds = _seeds(causes, rng)
            if len(causes) == 2:
                made, found = self._two(causes, seeds, yardstick)
                least = min(found["each"])
            else:
                target = log_uniform(rng, *FAINT_RANGE) if rng.random() < FAINT and causes[0][0] not in NEVER_FAINT else None
                made, found = self._one(causes, seeds, yardstick, target)
                least = found["linear"]
            if least >= BARELY:
                return made, found
        raise ArithmeticError(
            f"No visible size of {', '.join(f'{name} at {at}' for name, at in causes)} in {TRIES} draws; widen its range."
        )

    def _one(
        self, causes: Sequence[Site], seeds: Mapping[Site, int], yardstick: Yardstick, target: float | None
    ) -> tuple[Specimen, dict[str, Any]]:
        """One cause, scaled to within 1.5 of the target if there is one."""
        strength = 1.0
        for _ in range(8):
            made = self.made(causes, seeds, strength)
            seen = yardstick.linear(signals(made))
            if target is None or target / 1.5 <= seen <= target * 1.5:
                break
            strength *= float(np.clip(np.sqrt(target / max(seen, 1e-3)), 1e-4, 30.0))
        return made, {"linear": seen, "strength": strength}

    def _two(self, causes: Sequence[Site], seeds: Mapping[Site, int], yardstick: Yardstick) -> tuple[Specimen, dict[str, Any]]:
        """Two causes, and the detectability of each beside the other."""
        made = self.made(causes, seeds)
        both = signals(made)
        alone = [signals(self.made([site], seeds)) for site in causes]
        each = [yardstick.linear(both - other + yardstick.plain, other - yardstick.plain) for other in reversed(alone)]
        return made, {"linear": yardstick.linear(both), "each": each}


@lru_cache(maxsize=1)
def _yardstick(values: tuple[tuple[str, float], ...]) -> Yardstick:
    """That of a specimen, kept until another one is asked for: it takes most of the time of a case."""
    return Yardstick(dict(values))


def _seeds(causes: Sequence[Site], rng: np.random.Generator) -> dict[Site, int]:
    return {site: int(rng.integers(2**63)) for site in causes}

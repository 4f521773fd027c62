"""What a diagnosis says: verdict, cause, place, gap before and after, and what it cannot tell."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from hdrive_mbs.diagnosis.elsewhere import NOWHERE as NOWHERE
from hdrive_mbs.diagnosis.elsewhere import elsewhere, part_of, wave_generators
from hdrive_mbs.scene import Scene

if TYPE_CHECKING:
    from hdrive_mbs.diagnosis.fit import Fitted

FloatArray = npt.NDArray[np.float64]

VERDICTS: Mapping[str, str] = {
    "none": "no gap beyond noise and parameter tolerance",
    "effect": "an effect is missing from the model",
    "parameter": "a parameter is off by more than its tolerance",
    "sensor": "a sensor is off",
    "unknown": "a gap that nothing in the library explains",
}
"""Verdict -> in words."""


def _nothing() -> FloatArray:
    return np.empty(0)


@dataclass(frozen=True, kw_only=True)
class Estimate:
    """An identified parameter.

    name : path in the improved scene;  unit, doc : of its field
    value, low, high : with its 95 % interval;  nominal, tolerance : value and relative standard deviation it had before,
    nan for the parameters of an effect;  identifiable : whether the records say more of it than was known before
    at_end : whether the fit stopped at an end of what it may take, which the records may want it to pass: a law that is not quite the right
        one, or a fit in a hollow
    """

    name: str
    unit: str
    doc: str
    value: float
    low: float
    high: float
    nominal: float = float("nan")
    tolerance: float = float("nan")
    identifiable: bool = True
    at_end: bool = False


@dataclass(frozen=True, kw_only=True)
class Cause:
    """A cause that was tried, or is claimed.

    effect, at : family and place; ("parameter", group name) for parameters;  kind : of the effect, or "parameter"
    law : class of the law that did best;  signature : what an engineer would see, in words
    probability : calibrated;  log_odds : evidence over that of the refitted nominal model, of the
        samples that the fit saw, and log-likelihood over that of the others
    fit, held_out : mean square of the whitened residuals, 1 for noise alone
    """

    effect: str
    at: str
    kind: str
    law: str
    probability: float
    log_odds: float
    fit: float
    held_out: float
    signature: str = ""
    parameters: tuple[Estimate, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Place:
    """A place where an unknown force or error would explain residuals.

    at : name in the scene;  probability : among all places;  gain : log likelihood against none
    share : of the energy of the gap that a signal there can explain (0 to 1);  tied : places that the records cannot tell from it
    parameter : nominal parameter of the place that explains the gap better, if it is off, than a signal there; empty if a signal does
    sensor : whether the place is one that reads: the signal is an error of it
    """

    at: str
    probability: float
    gain: float
    share: float
    tied: tuple[str, ...] = ()
    parameter: str = ""
    sensor: bool = False


@dataclass(frozen=True, kw_only=True)
class Misfit:
    """Root mean square of a misfit, with its 95 % interval from a block bootstrap."""

    value: float
    low: float
    high: float


@dataclass(frozen=True, kw_only=True)
class Gap:
    """Root mean square of what the fit did not see, in standard deviations of the noise and in the channel's unit.

    record, column : where; empty for all together
    nominal : with the data sheet's values;  refit : with refitted parameters;  effect : with the claimed cause besides
    floor : of the noise, 1 in these units;  noise : standard deviation in the channel's unit, which turns them into it
    """

    record: str
    column: str
    unit: str
    noise: float
    nominal: Misfit
    refit: Misfit
    effect: Misfit
    floor: float = 1.0


@dataclass(frozen=True, kw_only=True, eq=False)
class DomainBin:
    """Part of the operating range with the misfit of the refitted nominal model there.

    over : "speed", "torque", "direction", "order", "frequency" or "time";  low, high : its ends, in unit
    of : place whose speed, torque, direction or order it is; empty for frequency and time
    excess : mean square minus 1;  samples : number;  after : excess with the claimed cause
    """

    over: str
    unit: str
    low: float
    high: float
    excess: float
    after: float
    samples: int
    of: str = ""


@dataclass(frozen=True, kw_only=True, eq=False)
class Trace:
    """One column of one record, thinned for pictures.

    times : s;  measured, nominal, refit, effect : in the column's unit, offsets taken out;  held_out : where no fit looked
    speed, torque, angle : operating point at these times [rad/s, N m, rad], for pictures of the residual over it; empty if not known
    """

    record: str
    column: str
    unit: str
    noise: float
    times: FloatArray
    measured: FloatArray
    nominal: FloatArray
    refit: FloatArray
    effect: FloatArray
    held_out: npt.NDArray[np.bool_]
    speed: FloatArray = field(default_factory=_nothing)
    torque: FloatArray = field(default_factory=_nothing)
    angle: FloatArray = field(default_factory=_nothing)


@dataclass(frozen=True, kw_only=True, eq=False)
class LatentForce:
    """What an unknown force at a place must have been, so that the refitted nominal model follows a record; or the error of a sensor.

    at, way : place and direction;  record : its name;  unit : of the force, N m or N, or of the sensor's reading
    times : s;  force : its smoothed estimate
    angle, speed : of the place [rad, rad/s]; of a connection how far its ends are turned against each other, of a force across an axis
        those of the shaft
    torque : through a connection in the model [N m];  twist : of a connection [rad] where angle is that of a body
    spread : standard deviation of the estimate;  each empty or nan where there is none
    """

    at: str
    unit: str
    times: FloatArray
    force: FloatArray
    speed: FloatArray
    angle: FloatArray
    way: str = ""
    record: str = ""
    torque: FloatArray = field(default_factory=_nothing)
    twist: FloatArray = field(default_factory=_nothing)
    spread: FloatArray = field(default_factory=_nothing)


@dataclass(frozen=True, kw_only=True, eq=False)
class Loop:
    """Torque against twist of a connection during a record, thinned for pictures.

    each of measured, refit, effect : shape (2, n): twist [rad] and torque [N m]; (2, 0) where there is none
    measured : from the record, directly or by the latent force;  refit, effect : of the models
    """

    record: str
    at: str
    measured: FloatArray
    refit: FloatArray
    effect: FloatArray


@dataclass(frozen=True, kw_only=True, eq=False)
class OrderMap:
    """Amplitudes, 0-peak, of a residual over speed and order of a shaft.

    speeds : rad/s, shape (p,);  orders : periods per revolution of the reference, shape (m,)
    before, after : refitted nominal model, and with the claimed cause, shape (p, m), in the column's unit
    """

    record: str
    column: str
    unit: str
    reference: str
    speeds: FloatArray
    orders: FloatArray
    before: FloatArray
    after: FloatArray


@dataclass(frozen=True, kw_only=True, eq=False)
class Separation:
    """How well two causes can be told apart by a record from a menu.

    detectability : least squared distance of their signatures in noise units, parameters adapted (below 25: not distinguishable)
    """

    record: str
    first: tuple[str, str]
    second: tuple[str, str]
    detectability: float


@dataclass(frozen=True, kw_only=True, eq=False)
class Driven:
    """The improved scene as one record drives it: ``hm.simulate(item.scene, item.duration, initial=item.initial)``.

    duration : of the record [s];  initial : values at its start by channel, SI, zeros left out

    A spin that the diagnosis took from a measured angle is left to the scene's own drive.
    """

    record: str
    scene: Scene
    duration: float
    initial: Mapping[str, float]


@dataclass(frozen=True, kw_only=True, eq=False)
class Diagnosis:
    """The answer.

    verdict : one of VERDICTS;  causes : what is claimed: one, two, or none
    indistinguishable : (effect, place) that these records cannot tell from the claim
    ranking : everything that was fitted, most probable first, "none" included
    where : places by latent-force localisation;  gaps : all together first, then by record and column
    parameters : nominal parameters after the fit;  improved : the scene with the cause, its inputs as in the bench
    driven : the improved scene with the inputs of each record
    fits : (effect, place) -> fit, of what is claimed, what cannot be told from it and the best other causes, for ``next_records``
    next_records : for a group that cannot be told apart, records that would separate it, best first
    warnings : what a reader has to know before he believes the verdict (a column that was not compared, a scene that nothing drives)
    notes : what else he has to know (fits that did not converge, verification on the engine, ...)
    inputs : columns that drive the scene, and the field each of them was put into
    files : record -> its source and sha256, of records that were read from files
    settings : step of the last fits and steps_of_search by record [s], slowed_in_search (vibrations, see ``pace_of``), every (samples of
        which a search compares one), candidates (classes and places), searched and held_out (records)
    forces, loops, order_maps : for pictures: at the located place, most telling record first
    """

    scene: Scene
    improved: Scene
    records: tuple[str, ...]
    verdict: str
    causes: tuple[Cause, ...]
    indistinguishable: tuple[tuple[str, str], ...]
    ranking: tuple[Cause, ...]
    where: tuple[Place, ...]
    gaps: tuple[Gap, ...]
    parameters: tuple[Estimate, ...]
    domain: tuple[DomainBin, ...] = ()
    traces: tuple[Trace, ...] = ()
    next_records: tuple[Separation, ...] = ()
    notes: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()
    inputs: Mapping[str, str] = field(default_factory=dict)
    driven: tuple[Driven, ...] = ()
    fits: Mapping[tuple[str, str], Fitted] = field(default_factory=dict)
    files: Mapping[str, Mapping[str, str]] = field(default_factory=dict)
    settings: Mapping[str, Any] = field(default_factory=dict)
    seconds: float = 0.0
    versions: Mapping[str, str] = field(default_factory=dict)
    forces: tuple[LatentForce, ...] = ()
    loops: tuple[Loop, ...] = ()
    order_maps: tuple[OrderMap, ...] = ()

    def __str__(self) -> str:
        """The report in plain text."""
        from hdrive_mbs.diagnosis.report_text import report_text

        return report_text(self)

    @property
    def gap(self) -> Gap:
        """All records and columns together."""
        return self.gaps[0]

    @property
    def elsewhere(self) -> Place | None:
        """Where the gap lies though nothing that is claimed sits there; None where the claim is not contradicted by its place.

        Only of a claim that leaves more than noise: see ``hdrive_mbs/diagnosis/elsewhere.py``.
        """
        if not self.gaps:
            return None
        at = {part_of(cause.at) for cause in self.causes}
        return elsewhere(self.where, at, self.gap.effect.value / self.gap.floor, wave_generators(self.scene.network(), at))

    @property
    def closed(self) -> float:
        """Share of the gap's energy above the noise that the claim closes, held out: 1 - (e^2 - f^2)/(n^2 - f^2).

        nan where the nominal model is not above the noise: then there is nothing to close.
        """
        return _closed(self.gap, self.gap.effect)

    @property
    def closed_by_refit(self) -> float:
        """The same for refitted parameters alone."""
        return _closed(self.gap, self.gap.refit)


def _closed(gap: Gap, after: Misfit) -> float:
    before = gap.nominal.value**2 - gap.floor**2
    left = max(after.value**2 - gap.floor**2, 0.0)
    return 1.0 - left / before if before > 0.0 else float("nan")

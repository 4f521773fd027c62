"""Where the gap sits: which place's unknown force, or which sensor's error, explains the residuals best."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
from scipy.special import log_ndtr

from hdrive_mbs.diagnosis.fit import Fitted
from hdrive_mbs.diagnosis.locate.latent_force import LatentForce, latent_force, most_probable
from hdrive_mbs.diagnosis.locate.likelihood import Directions, Explained, Likelihood, directions
from hdrive_mbs.diagnosis.locate.motion import KnownForce, Motion, motion_of
from hdrive_mbs.diagnosis.locate.response import Response, response
from hdrive_mbs.diagnosis.locate.spectra import joined, residuals, spectra
from hdrive_mbs.diagnosis.result import Place
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.unknowns import Factor
from hdrive_mbs.errors import LawError, ParameterError, SimulationError, unknown_place

FloatArray = npt.NDArray[np.float64]

NOWHERE = "nowhere"
"""Stands for no force at all, among the places."""
LOOSE = 10.0
"""Times its prior standard deviation that a parameter of a place may be off."""
BLOCKS = 12
"""Stretches of a record that are taken as independent when two places are compared."""
CLOSE, ALIKE = 3.0, 0.8
"""Log odds below which two places may be tied, and the share of what one explains that the other must explain too."""
SERIOUS, CLOSER, TIMES = 6, 4, 2
"""Places whose parameters are fitted anew, and those that are linearised anew about the motion with their force, how often."""
CLEAR = 20.0
"""Gain above which that is worth its time."""


@dataclass(frozen=True, eq=False)
class _About:
    """What the model was linearised about, and the residuals there."""

    motions: Sequence[Motion]
    responses: Sequence[Response]
    likelihood: Likelihood

    def place(self, at: str) -> list[Directions | None]:
        """Directions of a place in each trial."""
        return [directions(item.of[at]) if at in item.of else None for item in self.responses]


@dataclass(frozen=True, eq=False)
class _Tried:
    """A place with what its force explains.

    gain : log likelihood against nowhere, or what loosening a parameter of the place gains, if that is more (``loose``)
    """

    at: str
    about: _About
    found: Explained
    gain: float
    loose: bool = False


class Localiser:
    """A refitted nominal model beside its records, linearised for forces at all places.

    null : of search.fit_nominal, or any fitted hypothesis whose gap is to be placed
    """

    def __init__(self, simulator: Simulator, null: Fitted) -> None:
        self._simulator, self._null = simulator, null
        motions = [motion_of(simulator, k, null.hypothesis, null.z) for k in range(len(simulator.trials))]
        self._spectra, precision = spectra(simulator, null, motions)
        responses = [response(motion, item) for motion, item in zip(motions, self._spectra, strict=True)]
        at = np.concatenate([null.z, np.zeros(len(precision) - len(null.z))])
        self._about = _About(motions, responses, Likelihood(self._spectra, at, precision))
        self._nowhere = self._about.likelihood.of(None, np.zeros(len(precision)), rounds=3)
        self._tried = self._all()

    @property
    def names(self) -> tuple[str, ...]:
        """All places."""
        return tuple(dict.fromkeys(name for item in self._about.responses for name in item.of))

    def _all(self) -> list[_Tried]:
        loose = self._loosened()
        tried = [self._try(self._about, name, self._nowhere.z, rounds=1) for name in self.names]
        tried.sort(key=lambda item: -item.gain)
        for k, item in enumerate(tried[:SERIOUS]):
            tried[k] = self._try(self._about, item.at, item.found.z, rounds=2)
        tried.sort(key=lambda item: -item.gain)
        for k, item in enumerate(tried[:CLOSER]):
            if item.gain > CLEAR:
                tried[k] = self._closer(item)
        tried = [replace(item, gain=loose[item.at], loose=True) if loose.get(item.at, -math.inf) > item.gain else item for item in tried]
        return sorted(tried, key=lambda item: -item.gain)

    def _try(self, about: _About, at: str, z: FloatArray, rounds: int) -> _Tried:
        found = about.likelihood.of(about.place(at), z, rounds)
        return _Tried(at, about, found, found.log_likelihood - self._nowhere.log_likelihood)

    def _closer(self, item: _Tried) -> _Tried:
        """Linearised anew about the motion with the force that was found, if that makes the place more likely."""
        for _ in range(TIMES):
            about = self._about_force(item)
            again = None if about is None else self._try(about, item.at, item.found.z, rounds=2)
            if again is None or again.gain <= item.gain:
                break
            item = again
        return item

    def _about_force(self, item: _Tried) -> _About | None:
        """With the force of a place put into the model, and its parameters; None where that cannot be run.

        The residuals r of that run are taken to those without the force, r + H F, and to the old parameters.
        """
        hypothesis, given = self._null.hypothesis, item.about
        z = hypothesis.clipped(self._null.z + item.found.z[: hypothesis.size])
        motions, responses, made = [], [], []
        for k, old in enumerate(self._spectra):
            known, forces = given.responses[k].sources.get(item.at), []
            force = np.zeros((*old.values.shape[:2], 0))
            if known is not None:
                left = given.likelihood.residuals(k, item.found.z)
                force = most_probable(given.responses[k].of[item.at], left, item.found.fits[k].strength)
                times = old.trial.times
                for way, factors in enumerate(known.along.values()):
                    course = joined(force[..., way], old.window, len(times))
                    forces.append(KnownForce(f"force {way}", factors, times, course))
            try:
                motion = motion_of(self._simulator, k, hypothesis, z, forces)
            except (SimulationError, ParameterError, LawError):
                return None
            there = response(motion, old)
            fresh = residuals(motion, old)
            if forces:
                fresh = fresh + (there.of[item.at] @ force[..., None])[..., 0]
            values = old.values.copy()
            moved = np.concatenate([[0.0], item.found.z])
            moved[1 : 1 + hypothesis.size] = z - self._null.z
            moved[1 + hypothesis.size :] = 0.0
            values[..., 0] = fresh - old.values @ moved
            motions.append(motion)
            responses.append(there)
            made.append(replace(old, values=values))
        return _About(motions, responses, Likelihood(made, given.likelihood.at, given.likelihood.precision))

    def _loosened(self) -> dict[str, float]:
        """Place -> gain of letting the one of its parameters loose that gains most."""
        found: dict[str, float] = {}
        for k, unknown in enumerate(self._null.hypothesis.unknowns[: self._null.hypothesis.nominal_size]):
            assert isinstance(unknown, Factor)
            if unknown.wide == 1.0:
                gain = self._about.likelihood.loosened(self._nowhere, k, LOOSE)
                for owner in {path.split(".")[0] for path in unknown.nominal}:
                    found[owner] = max(gain, found.get(owner, -math.inf))
        return found

    def places(self) -> tuple[Place, ...]:
        """All places and NOWHERE, most probable first; before the records speak, NOWHERE is as probable as all others together."""
        best = self._tried[0]
        odds = {NOWHERE: self._less(best, None) + math.log(len(self._tried))} | {item.at: self._less(best, item) for item in self._tried}
        top = max(0.0, *(value for value in odds.values()))
        weights = {name: math.exp(value - top) for name, value in odds.items()}
        total = sum(weights.values())
        close = [item for item in self._tried if odds[item.at] > -CLOSE]
        tied = {item.at: tuple(other.at for other in close if other is not item and self._alike(item, other)) for item in close}
        made = [Place(at=NOWHERE, probability=weights[NOWHERE] / total, gain=0.0, share=0.0)]
        for item in self._tried:
            share = self._share(item)
            made.append(
                Place(at=item.at, probability=weights[item.at] / total, gain=item.gain, share=share, tied=tied.get(item.at, ()))
            )
        return tuple(sorted(made, key=lambda place: (-place.probability, -place.gain)))

    def _less(self, best: _Tried, other: _Tried | None) -> float:
        """Log odds of another place, or of none, against the best: never more certain than blocks of the records agree.

        With the differences d of the log likelihoods by block, z = sum(d)/sqrt(n var(d)) is about normal where neither is right
        (Vuong, Econometrica 57, 1989); the log odds are those of the tails, or the plain difference where that is smaller.
        """
        if other is best:
            return 0.0
        gain = best.gain - (0.0 if other is None else other.gain)
        if gain <= 0.0 or best.loose or other is None or other.loose:
            return -gain
        pairs = zip(best.found.fits, other.found.fits, strict=True)
        differences = np.concatenate([_blocks(a.by_window - b.by_window) for a, b in pairs])
        error = math.sqrt(len(differences) * float(np.var(differences, ddof=1)))
        z = gain / error if error > 0.0 else math.inf
        return -min(gain, float(log_ndtr(z) - log_ndtr(-z)))

    def _alike(self, one: _Tried, other: _Tried) -> bool:
        """Whether a place explains nearly all of what another explains, weighted like the likelihood."""
        if one.loose or other.loose:
            return one.loose and other.loose
        mines, yourses = one.about.place(one.at), one.about.place(other.at)
        total = shared = 0.0
        for k, fit in enumerate(one.found.fits):
            mine, yours = mines[k], yourses[k]
            if mine is None or fit.kept is None:
                continue
            moved = np.concatenate([[1.0], one.found.z])
            part = (mine.along * (fit.kept * (one.about.likelihood.seen(mine, k) @ moved))[..., None, :]).sum(axis=-1)
            weight = np.repeat(1.0 / fit.scale, self._spectra[k].widths, axis=1)[..., None]
            total += float(np.sum(weight * np.abs(part) ** 2))
            if yours is not None:
                shared += float(np.sum(weight * np.abs(np.sum(yours.along.conj() * part[..., None], axis=2)) ** 2))
        return total > 0.0 and shared > ALIKE * total

    def _share(self, item: _Tried) -> float:
        """Share of the gap's energy that a force explains."""
        noise = float(self._about.likelihood.numbers)
        before = self._nowhere.left - noise
        if item.loose or before <= 0.0:
            return 0.0
        return float(np.clip((self._nowhere.left - item.found.left) / max(before, 1e-9), 0.0, 1.0))

    def force(self, at: str) -> tuple[LatentForce, ...]:
        """The most probable course of the force, or of the sensor's error, at a place in each trial where it shows."""
        for item in self._tried:
            if item.at == at:
                break
        else:
            raise unknown_place("place", at, self.names, "This localisation")
        made = []
        for k, fit in enumerate(item.found.fits):
            if fit.kept is not None:
                left = item.about.likelihood.residuals(k, item.found.z)
                made += latent_force(item.about.motions[k], self._spectra[k], item.about.responses[k], at, left, fit.strength)
        return tuple(made)


def _blocks(values: FloatArray) -> FloatArray:
    return np.array([part.sum() for part in np.array_split(values, min(BLOCKS, len(values)))])


def locate(simulator: Simulator, null: Fitted) -> tuple[Place, ...]:
    """Places of a gap, most probable first; NOWHERE among them stands for no force at all.

    Raises AnalysisError or SimulationError where the fitted model cannot be run.
    """
    return Localiser(simulator, null).places()

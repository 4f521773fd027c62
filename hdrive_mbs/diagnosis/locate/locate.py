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
from hdrive_mbs.diagnosis.locate.spectra import Spectra, joined, spectra
from hdrive_mbs.diagnosis.result import Place
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.unknowns import Factor
from hdrive_mbs.errors import AnalysisError, LawError, ParameterError, SimulationError, unknown_place

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
CONTENDS = 0.6
"""Share of the best gain from which on a place is compared more closely."""
LONGEST = 3.0
"""Standard deviations that a parameter may move at a time."""
UNCLEAR = 3.0
"""Mean square that even the best place leaves, above which a linear model is not trusted."""


@dataclass(frozen=True, eq=False)
class _About:
    """What the model was linearised about, and the residuals there."""

    motions: Sequence[Motion]
    spectra: Sequence[Spectra]
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
        self._simulator, self._hypothesis = simulator, null.hypothesis
        about = self._linearised(null.z, [()] * len(simulator.trials))
        if about is None:
            raise AnalysisError("The fitted model cannot be run through the records at the full sample rate; use a shorter step.")
        self._about = about
        self._nowhere = about.likelihood.of(None, np.zeros(len(about.likelihood.at)), rounds=3)
        self._tried = self._all()

    def _linearised(self, z: FloatArray, forces: Sequence[Sequence[KnownForce]]) -> _About | None:
        """About the motion at these parameters with these forces; None where it cannot be run."""
        try:
            motions = [motion_of(self._simulator, k, self._hypothesis, z, forces[k]) for k in range(len(self._simulator.trials))]
        except (SimulationError, ParameterError, LawError):
            return None
        made = spectra(self._simulator, self._hypothesis, z, motions, forces)
        responses = [response(motion, item) for motion, item in zip(motions, made, strict=True)]
        offsets = made[0].values.shape[-1] - 1 - len(z)
        at = np.concatenate([z, np.zeros(offsets)])
        return _About(motions, made, responses, Likelihood(made, at, np.concatenate([self._hypothesis.precisions, np.ones(offsets)])))

    @property
    def names(self) -> tuple[str, ...]:
        """All places."""
        return tuple(dict.fromkeys(name for item in self._about.responses for name in item.of))

    def _all(self) -> list[_Tried]:
        loose = self._loosened()
        tried = [self._quick(name) for name in self.names]
        tried.sort(key=lambda item: -item.gain)
        for k, item in enumerate(tried[:SERIOUS]):
            tried[k] = self._try(self._about, item.at, self._nowhere.z, rounds=2)
        tried.sort(key=lambda item: -item.gain)
        tried = self._closer(tried)
        tried = [replace(item, gain=loose[item.at], loose=True) if loose.get(item.at, -math.inf) > item.gain else item for item in tried]
        return sorted(tried, key=lambda item: -item.gain)

    def _try(self, about: _About, at: str, z: FloatArray, rounds: int) -> _Tried:
        found = about.likelihood.of(about.place(at), z, rounds)
        return _Tried(at, about, found, found.log_likelihood - self._nowhere.log_likelihood)

    def _quick(self, at: str) -> _Tried:
        found = self._about.likelihood.quickly(self._about.place(at), self._nowhere.z, self._nowhere)
        return _Tried(at, self._about, found, found.log_likelihood - self._nowhere.log_likelihood)

    def _closer(self, tried: list[_Tried]) -> list[_Tried]:
        """Where several places come close and none of them explains the residuals, each of them linearised anew.

        That is about the motion with the force found there, and with its parameters.

        A place that the force does not sit at may explain the residuals of a linear model, but that force then makes
        another motion than the measured one; at the right place the likelihood grows from step to step.
        """
        contenders = [k for k, item in enumerate(tried[:CLOSER]) if item.gain > max(0.0, CONTENDS * tried[0].gain)]
        if len(contenders) < 2 or tried[0].found.left < UNCLEAR * self._about.likelihood.numbers:
            return tried
        now, best = {k: tried[k] for k in contenders}, dict[int, _Tried]()
        for _ in range(TIMES):
            for k, item in list(now.items()):
                about = self._about_force(item)
                if about is None:
                    del now[k]
                    continue
                now[k] = self._try(about, item.at, np.zeros(len(item.found.z)), rounds=2)
                if k not in best or now[k].gain > best[k].gain:
                    best[k] = now[k]
            top = max((item.gain for item in best.values()), default=0.0)
            now = {k: item for k, item in now.items() if best[k].gain > CONTENDS * top}
            if len(now) < 2:
                break
        if not best:
            return tried
        # the others are taken to lose as much as the best of these has lost
        lost = min(1.0, max(item.gain for item in best.values()) / tried[0].gain)
        made = [best.get(k, replace(item, gain=item.gain * lost) if item.gain > 0.0 else item) for k, item in enumerate(tried)]
        return sorted(made, key=lambda item: -item.gain)

    def _about_force(self, item: _Tried) -> _About | None:
        """With the force of a place put into the model, and its parameters; None where that cannot be run.

        What the force does, H F, is added to the residuals of that run, so that they miss it like those before.
        """
        about, size = item.about, self._hypothesis.size
        moved = item.found.z.copy()
        moved[:size] = np.clip(moved[:size], -LONGEST, LONGEST)
        moved[:size] = self._hypothesis.clipped(about.likelihood.at[:size] + moved[:size]) - about.likelihood.at[:size]
        spectra_of, known = [], []
        for k, old in enumerate(about.spectra):
            source, forces = about.responses[k].sources.get(item.at), []
            force = np.zeros((*old.values.shape[:2], 0))
            if source is not None and source.along:
                left = about.likelihood.residuals(k, moved)
                force = most_probable(about.responses[k].of[item.at], left, item.found.fits[k].strength)
                times = old.trial.times
                for way, factors in enumerate(source.along.values()):
                    forces.append(KnownForce(f"force {way}", factors, times, joined(force[..., way], old.window, len(times))))
            spectra_of.append(force)
            known.append(forces)
        there = self._linearised(about.likelihood.at[:size] + moved[:size], known)
        if there is None:
            return None
        for k, force in enumerate(spectra_of):
            if force.shape[2]:
                there.spectra[k].values[..., 0] += (there.responses[k].of[item.at] @ force[..., None])[..., 0]
        return replace(there, likelihood=Likelihood(there.spectra, there.likelihood.at, there.likelihood.precision))

    def _loosened(self) -> dict[str, float]:
        """Place -> gain of letting the one of its parameters loose that gains most, any of all parameters being as probable.

        Of 15 right parameters one lies beyond 3 standard deviations every 25th time.
        """
        found: dict[str, float] = {}
        many = math.log(max(self._hypothesis.nominal_size, 1))
        for k, unknown in enumerate(self._hypothesis.unknowns[: self._hypothesis.nominal_size]):
            assert isinstance(unknown, Factor)
            if unknown.wide == 1.0:
                gain = self._about.likelihood.loosened(self._nowhere, k, LOOSE) - many
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
            made.append(Place(at=item.at, probability=weights[item.at] / total, gain=item.gain, share=share, tied=tied.get(item.at, ())))
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
            weight = np.repeat(1.0 / fit.scale, one.about.spectra[k].widths, axis=1)[..., None]
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
                made += latent_force(item.about.motions[k], item.about.spectra[k], item.about.responses[k], at, left, fit.strength)
        return tuple(made)


def _blocks(values: FloatArray) -> FloatArray:
    return np.array([part.sum() for part in np.array_split(values, min(BLOCKS, len(values)))])


def locate(simulator: Simulator, null: Fitted) -> tuple[Place, ...]:
    """Places of a gap, most probable first; NOWHERE among them stands for no force at all.

    Raises AnalysisError or SimulationError where the fitted model cannot be run.
    """
    return Localiser(simulator, null).places()

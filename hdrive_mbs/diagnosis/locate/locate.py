"""Where the gap sits: which place's unknown force, or which sensor's error, explains the residuals best."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import numpy.typing as npt
from scipy.special import log_ndtr

from hdrive_mbs.diagnosis.fit import Fitted
from hdrive_mbs.diagnosis.locate.about import About, linearised
from hdrive_mbs.diagnosis.locate.latent_force import LatentForce, TurnedForce, by_direction, latent_force, most_probable
from hdrive_mbs.diagnosis.locate.likelihood import Explained, Likelihood, directions
from hdrive_mbs.diagnosis.locate.loosened import loosened
from hdrive_mbs.diagnosis.locate.motion import KnownForce
from hdrive_mbs.diagnosis.locate.response import KEPT
from hdrive_mbs.diagnosis.locate.spectra import joined
from hdrive_mbs.diagnosis.result import NOWHERE, Place
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.turning import reference_shaft
from hdrive_mbs.errors import AnalysisError, unknown_place

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]

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
SETTLE, FAR = 2, 0.3
"""How often parameters are fitted anew before places are compared, while one moves by more standard deviations than this."""
DOUBTED = 0.3
"""Share of the probability that stays as it is where the best place is not to be relied on."""
QUIET, LEAVES = 1.3, 0.4
"""Mean square that a place may leave in any case, and share of the logarithm of the gap that it may leave, to be relied on."""
GAINS = 0.07
"""Share of the log likelihood of a drive's gap that the best place gains at least, to be relied on.  In our own open cases and a new
user's records the places that gained 0.06 and less were wrong, and the right ones gained 0.09 to 0.57, as some wrong ones did too."""
NOTHING = (
    "Not reliable here: the best single place gains {:.1g} % of what an explanation of the whole gap would; the gap may be too slow to"
    " be placed, like a steady torque, or change the motion too much for a linear model."
)
UNCLEAR = 3.0
"""Mean square that even the best place leaves, above which a linear model is not trusted."""


@dataclass(frozen=True, eq=False)
class _Tried:
    """A source at a place with what its force explains.

    gain : log likelihood against nowhere, or what loosening a parameter of the place gains, if that is more
    loose : that parameter; empty if a force gains more
    """

    name: str
    at: str
    about: About
    found: Explained
    gain: float
    loose: str = ""


class Localiser:
    """A refitted nominal model beside its records, linearised for forces at all places.

    null : of search.fit_nominal, or any fitted hypothesis whose gap is to be placed
    """

    def __init__(self, simulator: Simulator, null: Fitted) -> None:
        self._simulator, self._hypothesis = simulator, null.hypothesis
        about = linearised(simulator, null.hypothesis, null.z)
        if about is None:
            raise AnalysisError("The fitted model cannot be run through the records at the full sample rate; use a shorter step.")
        self._about = about
        self._nowhere = about.likelihood.of(None, np.zeros(len(about.likelihood.at)), rounds=3)
        if about.turning:
            self._settle(null.z)
        self._tried = self._all(about)

    def _settle(self, z: FloatArray) -> None:
        """Linearised anew where the parameters go without a force, as long as they go far.

        A least-squares fit bends the parameters to whatever is missing from the model; stretches that fit badly count less here.
        """
        for _ in range(SETTLE):
            moved = self._nowhere.z[: len(z)]
            if np.max(np.abs(moved), initial=0.0) < FAR:
                return
            z = self._hypothesis.clipped(z + np.clip(moved, -LONGEST, LONGEST))
            about = linearised(self._simulator, self._hypothesis, z)
            if about is None:
                return
            found = about.likelihood.of(None, np.zeros(len(about.likelihood.at)), rounds=3)
            if found.log_likelihood <= self._nowhere.log_likelihood:
                return
            self._about, self._nowhere = about, found

    @property
    def names(self) -> tuple[str, ...]:
        """All sources."""
        return tuple(dict.fromkeys(name for item in self._about.responses for name in item.of))

    def _all(self, first: About) -> list[_Tried]:
        """All places, best first;  first : about the motion that the localisation began with."""
        loose = loosened(self._about, self._hypothesis, self._nowhere)
        tried = self._tried_about(self._about, self._nowhere)
        if self._about.turning:
            # without a force parameters may have gone where they stand in for it: begin also where they were
            tried += self._tried_about(first, first.likelihood.of(None, np.zeros(len(first.likelihood.at)), rounds=0))
            tried = _one_a_place(tried)
            first.forget()
        tried = self._closer(tried)
        for k, item in enumerate(tried):
            gain, parameter = loose.get(item.at, (-math.inf, ""))
            if gain > item.gain:
                tried[k] = replace(item, gain=gain, loose=parameter)
        return sorted(tried, key=lambda item: -item.gain)

    def _tried_about(self, about: About, nowhere: Explained) -> list[_Tried]:
        """All places about one motion, the best of them with parameters of their own that begin at those of nowhere."""
        looked: list[_Tried] = []
        for some in (self.names[first : first + KEPT] for first in range(0, len(self.names), KEPT)):
            about.fetch(some)
            looked += [self._quick(about, nowhere, name) for name in some]
        tried = _one_a_place(looked)
        for k, item in enumerate(tried[:SERIOUS]):
            tried[k] = self._try(about, item.name, nowhere.z, rounds=2)
        return sorted(tried, key=lambda item: -item.gain)

    def _try(self, about: About, name: str, z: FloatArray, rounds: int) -> _Tried:
        found = about.likelihood.of(about.place(name), z, rounds)
        return _Tried(name, about.at(name), about, found, found.log_likelihood - self._nowhere.log_likelihood)

    def _quick(self, about: About, nowhere: Explained, name: str) -> _Tried:
        found = about.likelihood.quickly(about.place(name), nowhere.z, nowhere)
        return _Tried(name, about.at(name), about, found, found.log_likelihood - self._nowhere.log_likelihood)

    def _closer(self, tried: list[_Tried]) -> list[_Tried]:
        """Where several places come close and none of them explains the residuals, each of them linearised anew.

        That is about the motion with the force found there, and with its parameters.

        A place that the force does not sit at may explain the residuals of a linear model, but that force then makes
        another motion than the measured one; at the right place the likelihood grows from step to step.
        """
        contenders = [k for k, item in enumerate(tried[:CLOSER]) if item.gain > max(0.0, CONTENDS * tried[0].gain)]
        if len(contenders) < 2 or tried[0].found.left < UNCLEAR * self._about.likelihood.numbers:
            return tried
        self._about.forget()  # models linearised anew need the memory more
        now, best = {k: tried[k] for k in contenders}, dict[int, _Tried]()
        for time in range(TIMES):
            for k in list(now):
                now |= self._closest(k, now.pop(k), best, is_last=time == TIMES - 1)
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

    def _closest(self, k: int, item: _Tried, best: dict[int, _Tried], is_last: bool) -> dict[int, _Tried]:
        """What a place goes on from, none where it cannot be run; ``best`` takes it if it is better.

        Nothing goes on from the last: what a model linearised anew holds (75 MB of either bench) is let go.
        """
        again = self._again(item)
        if again is None:
            return {}
        if k not in best or again.gain > best[k].gain:
            best[k] = again
        return {k: best[k] if is_last else again}

    def _again(self, item: _Tried) -> _Tried | None:
        """A place about the motion with its force; None where that cannot be run."""
        about = self._about_force(item)
        if about is None:
            return None
        found = self._try(about, item.name, np.zeros(len(item.found.z)), rounds=2)
        return replace(found, about=about.narrowed(item.name))

    def _about_force(self, item: _Tried) -> About | None:
        """With the force of a place put into the model, and its parameters; None where that cannot be run.

        What the force does, H F, is added to the residuals of that run, so that they miss it like those before.
        """
        about, size = item.about, self._hypothesis.size
        moved = item.found.z.copy()
        moved[:size] = np.clip(moved[:size], -LONGEST, LONGEST)
        moved[:size] = self._hypothesis.clipped(about.likelihood.at[:size] + moved[:size]) - about.likelihood.at[:size]
        spectra_of, known = [], []
        for k, old in enumerate(about.spectra):
            name = about.shown(item.name, k)
            source, forces = about.responses[k].sources.get(name), []
            force = np.zeros((*old.values.shape[:2], 0))
            if source is not None and source.along:
                left = about.likelihood.residuals(k, moved)
                force = most_probable(about.responses[k].of[name], left, item.found.fits[k].strength)
                times, own = old.trial.times, by_direction(source, force)
                for way, factors in enumerate(source.along.values()):
                    forces.append(KnownForce(f"force {way}", factors, times, joined(own[..., way], old.window, len(times))))
            spectra_of.append(force)
            known.append(forces)
        z = about.likelihood.at[:size] + moved[:size]
        like, at = (about, item.at) if about.turning else (None, None)
        there = linearised(self._simulator, self._hypothesis, z, known, like=like, at=at)
        if there is None:
            return None
        for k, force in enumerate(spectra_of):
            if force.shape[2]:
                there.spectra[k].values[..., 0] += (there.responses[k].of[there.shown(item.name, k)] @ force[..., None])[..., 0]
        before = there.likelihood
        return replace(there, likelihood=Likelihood(there.spectra, before.at, before.precision))

    @cached_property
    def _odds(self) -> dict[str, float]:
        """Log odds of each place and of NOWHERE against the best place."""
        best = self._tried[0]
        return {NOWHERE: self._less(best, None) + math.log(len(self._tried))} | {item.at: self._less(best, item) for item in self._tried}

    def places(self) -> tuple[Place, ...]:
        """All places and NOWHERE, most probable first; before the records speak, NOWHERE is as probable as all others together.

        Where there is a doubt, most of the probability is spread over all places alike.
        """
        odds = self._odds
        top = max(odds.values())
        weights = {name: math.exp(value - top) for name, value in odds.items()}
        total = sum(weights.values())
        kept = DOUBTED if self.doubt else 1.0
        chances = {name: kept * weight / total + (1.0 - kept) / len(weights) for name, weight in weights.items()}
        close = [item for item in self._tried if odds[item.at] > -CLOSE]
        tied = {item.at: tuple(other.at for other in close if other is not item and self._alike(item, other)) for item in close}
        made = [Place(at=NOWHERE, probability=chances[NOWHERE], gain=0.0, share=0.0)]
        for item in self._tried:
            chance, others = chances[item.at], tied.get(item.at, ())
            place = Place(at=item.at, probability=chance, gain=item.gain, share=self._share(item), tied=others, parameter=item.loose)
            made.append(replace(place, sensor=item.about.source(item.name).is_sensor))
        return tuple(sorted(made, key=lambda place: (-place.probability, -place.gain)))

    @property
    def left(self) -> float:
        """Mean square that the best place leaves, 1 being noise; that of nowhere where this is best."""
        best = self._tried[0].found if self._odds[NOWHERE] <= 0.0 else self._nowhere
        return best.left / self._about.likelihood.numbers

    @property
    def doubt(self) -> str:
        """Why the best place is not to be relied on; empty where it is.

        A force at the right place takes most of the misfit away, on a logarithmic scale: what it leaves comes from motions
        that the linear model does not follow.  One at a wrong place takes less, and so does one of two causes.  Nowhere is
        not to be relied on where the model without a force leaves more than noise: what changes too slowly for the windows, like
        a steady torque, shows in so few bins that no force pays.  This is asked of rotors alone, whose places lie close together;
        of drives only whether the best place gains anything to speak of.
        """
        before, left = self._nowhere.left / self._about.likelihood.numbers, self.left
        if left < QUIET:
            return ""
        if not self._about.turning:
            share = self._tried[0].gain / self._nowhere.above_noise
            return "" if share > GAINS or before < QUIET else NOTHING.format(max(100.0 * share, 0.0))
        if self._odds[NOWHERE] > 0.0:
            return (
                f"No place was found, yet the nominal model leaves a mean square of {left:.3g} (noise: 1): the gap may be too slow to be"
                " placed, like a steady torque or a parameter."
            )
        if self._tried[0].loose or math.log(left) < LEAVES * math.log(before):
            return ""
        return (
            f"Not reliable here: the best single place leaves a mean square of {left:.3g} of {before:.3g} (noise: 1); the gap may have"
            " more than one cause, or change the motion too much for a linear model."
        )

    @property
    def trusted(self) -> bool:
        """Whether the best place may be relied on."""
        return not self.doubt

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
            return bool(one.loose and other.loose)
        total = shared = 0.0
        for k, fit in enumerate(one.found.fits):
            mine, yours = self._about.transfer(one.name, k), self._about.transfer(other.name, k)
            acting = one.about.transfer(one.name, k)
            if mine is None or acting is None or fit.kept is None:
                continue
            force = most_probable(acting, one.about.likelihood.residuals(k, one.found.z), fit.strength)
            part = (mine @ force[..., None])[..., 0]
            weight = np.repeat(1.0 / fit.scale, self._about.spectra[k].widths, axis=1)[..., None]
            total += float(np.sum(weight * np.abs(part) ** 2))
            if yours is not None:
                along = directions(yours).along
                shared += float(np.sum(weight * np.abs(np.sum(along.conj() * part[..., None], axis=2)) ** 2))
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
            if item.at == at or item.name == at:
                break
        else:
            raise unknown_place("place", at, [item.at for item in self._tried], "This localisation")
        made = []
        for k, fit in enumerate(item.found.fits):
            if fit.kept is not None:
                about, left, shown = item.about, item.about.likelihood.residuals(k, item.found.z), item.about.shown(item.name, k)
                made += latent_force(about.motions[k], about.spectra[k], about.responses[k], shown, left, fit.strength)
        return tuple(made)

    def turned(self, at: str) -> tuple[TurnedForce, ...]:
        """The most probable force across the axis at a place over the angle of the shaft, of each trial where it shows in x and y."""
        found: dict[str, dict[str, FloatArray]] = {}
        for force in self.force(at):
            found.setdefault(force.record, {})[force.way] = force.force
        angles = {motion.trial.name: reference_shaft(motion)[1] for motion in self._about.motions}
        return tuple(TurnedForce(angles[record], ways["x"] + 1j * ways["y"]) for record, ways in found.items() if {"x", "y"} <= ways.keys())


def _one_a_place(tried: Sequence[_Tried]) -> list[_Tried]:
    """The best source of each place, best first."""
    found: dict[str, _Tried] = {}
    for item in sorted(tried, key=lambda item: -item.gain):
        found.setdefault(item.at, item)
    return list(found.values())


def _blocks(values: FloatArray) -> FloatArray:
    return np.array([part.sum() for part in np.array_split(values, min(BLOCKS, len(values)))])


def locate(simulator: Simulator, null: Fitted) -> tuple[Place, ...]:
    """Places of a gap, most probable first; NOWHERE among them stands for no force at all.

    Raises AnalysisError or SimulationError where the fitted model cannot be run.
    """
    return Localiser(simulator, null).places()

"""A model linearised about a motion, for forces at all places."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from hdrive_mbs.diagnosis.hypothesis import Hypothesis
from hdrive_mbs.diagnosis.locate.likelihood import Directions, Likelihood, directions
from hdrive_mbs.diagnosis.locate.line import Line, line
from hdrive_mbs.diagnosis.locate.motion import KnownForce, Motion, motion_of
from hdrive_mbs.diagnosis.locate.response import Response, response
from hdrive_mbs.diagnosis.locate.sources import TURNING, Source
from hdrive_mbs.diagnosis.locate.spectra import Spectra, spectra
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.errors import LawError, ParameterError, SimulationError
from hdrive_mbs.freed_memory import give_back

FloatArray = npt.NDArray[np.float64]
ComplexArray = npt.NDArray[np.complex128]


@dataclass(frozen=True, eq=False)
class About:
    """What the model was linearised about, and the residuals there.

    responses : of all places, by trial
    """

    motions: Sequence[Motion]
    lines: Sequence[Line]
    spectra: Sequence[Spectra]
    likelihood: Likelihood
    responses: Sequence[Response]

    @property
    def turning(self) -> bool:
        """Whether it is a line with lateral motion."""
        return any(motion.network.is_lateral for motion in self.motions)

    def transfer(self, name: str, k: int) -> ComplexArray | None:
        """Of a source in trial k: where the spin alone is watched, that of a torque at its place; None where it does not show."""
        return self.responses[k].of.get(self.shown(name, k))

    def fetch(self, names: Sequence[str]) -> None:
        """Work out the transfers of several sources together, in all trials; see ``OfSources.fetch``."""
        for k, item in enumerate(self.responses):
            item.of.fetch(list(dict.fromkeys(self.shown(name, k) for name in names)))

    def forget(self) -> None:
        """Let go what can be worked out again: transfers of sources, residuals and products of slopes; 50 MB of the rotor bench."""
        self.likelihood.forget()
        for item in self.responses:
            item.of.forget()

    def narrowed(self, name: str) -> About:
        """What is asked of a model of which one source is left, in about half of the memory."""
        responses = [replace(item, of=item.of.narrowed(self.shown(name, k))) for k, item in enumerate(self.responses)]
        bare = tuple(replace(item, whitening=np.empty((0, 0, 0, 0), complex)) for item in self.spectra)
        likelihood = Likelihood(bare, self.likelihood.at, self.likelihood.precision)
        return replace(self, spectra=bare, likelihood=likelihood, responses=responses)

    def shown(self, name: str, k: int) -> str:
        """The source that shows a place in trial k."""
        return name if name in self.responses[k].of else f"{self.at(name)}, {TURNING}"

    def place(self, name: str) -> list[Directions | None]:
        """Directions of a source in each trial."""
        found = [self.transfer(name, k) for k in range(len(self.responses))]
        return [None if item is None else directions(item) for item in found]

    def at(self, name: str) -> str:
        """The place of a source."""
        return self.source(name).at

    def source(self, name: str) -> Source:
        """The source of a name."""
        return next(item.sources[name] for item in self.responses if name in item.sources)


def linearised(
    simulator: Simulator,
    hypothesis: Hypothesis,
    z: FloatArray,
    forces: Sequence[Sequence[KnownForce]] | None = None,
    *,
    like: About | None = None,
    at: str | None = None,
) -> About | None:
    """About the motion at these parameters with these forces; None where it cannot be run.

    forces : of each trial, none if not given
    like : has the slopes of the parameters and observers already;  at : for the sources of this place alone
    """
    acting = forces if forces is not None else [()] * len(simulator.trials)
    try:
        motions = [motion_of(simulator, k, hypothesis, z, acting[k]) for k in range(len(simulator.trials))]
    except (SimulationError, ParameterError, LawError):
        return None
    watching = [item.observer for item in like.lines] if like else [None] * len(motions)
    lines = [line(motion, at, item) for motion, item in zip(motions, watching, strict=True)]
    slopes = [item.slopes for item in like.spectra] if like else None
    made = spectra(simulator, hypothesis, z, motions, lines, acting, slopes)
    offsets = made[0].values.shape[-1] - 1 - len(z)
    point = np.concatenate([z, np.zeros(offsets)])
    likelihood = Likelihood(made, point, np.concatenate([hypothesis.precisions, np.ones(offsets)]))
    responses = tuple(response(*item) for item in zip(motions, lines, made, strict=True))
    give_back()  # what was in use on the way
    return About(motions, lines, made, likelihood, responses)

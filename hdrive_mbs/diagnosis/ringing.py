"""Free vibration with which a record begins.

What a line did before its record goes on in it as free vibration, which no run from a start of its own knows, however long: a run-up
that is cut out behind a critical speed rings for seconds.  It is a sum of decaying vibrations at the line's own frequencies,

    r(t) = sum_k exp(-d_k t) (1, d_k t, (d_k t)^2) (cos, sin)(w_k t) c_k,    s_k = -d_k +- i w_k,

with the time t from the record's begin, in each column with sizes c_k of its own that nothing is known of.  The powers of t stand for
frequencies that change a little with the speed, or are a little off: without them a fit from 1 % beside a modulus ended in a hollow.
The roots s_k are those of the very parameters and effects of a run, and the sizes are what fits its residuals best: they are
eliminated, so that a fit knows nothing of them (variable projection).  In a record of a few decay times they leave little of a
vibration that goes on at just such a frequency.

Source: free vibration, e.g. Meirovitch, Fundamentals of Vibrations, 7.11; Golub, Pereyra, SIAM J. Numer. Anal. 10 (1973) 413.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from hdrive_mbs.analysis.whirl.mode_shifts import lateral_roots
from hdrive_mbs.errors import HdriveError
from hdrive_mbs.scene import Scene

if TYPE_CHECKING:
    from hdrive_mbs.diagnosis.trial import Trial

FloatArray = npt.NDArray[np.float64]
Roots = tuple[complex, ...]

LOWEST = 8
"""Roots that are taken, those of the lowest frequencies: what is higher dies out quickly."""
POWERS = 3
"""Of the time, from 0 on."""
SEEN = 0.5
"""Share of the Nyquist frequency up to which a root counts."""
SAME = 1e-6
"""Singular value, over the largest one, below which a course is one of the others."""


@dataclass(frozen=True)
class Ringing:
    """Decaying vibrations of a rotor line from some sample of a trial on.

    speed : of its reference shaft there [rad/s];  first : number of the sample
    """

    speed: float
    first: int

    def roots(self, scene: Scene, every: float) -> Roots:
        """Roots s [rad/s] of a line with positive imaginary parts, by frequency; none where they cannot be had.

        every : sample time [s]
        """
        try:
            found = lateral_roots(scene, self.speed)
        except HdriveError:
            return ()
        return tuple(complex(root) for root in found if root.real < 0.0 and root.imag < SEEN * np.pi / every)[:LOWEST]

    def courses(self, roots: Roots, samples: int, every: float) -> FloatArray:
        """Courses of unknown size, each of length 1, shape (samples, courses)."""
        t = every * np.arange(samples - self.first)
        whole = np.zeros((samples, len(roots) * POWERS * 2))
        for k, root in enumerate(roots):
            decaying = np.exp(np.maximum(root.real * t, -700.0))
            waves = decaying[:, None] * np.stack((np.cos(root.imag * t), np.sin(root.imag * t)), axis=-1)
            for power in range(POWERS):
                at = 2 * (k * POWERS + power)
                whole[self.first :, at : at + 2] = waves * ((-root.real * t) ** power)[:, None]
        size = np.linalg.norm(whole, axis=0)
        return np.asarray(whole[:, size > 0.0] / size[size > 0.0])

    def part_of(self, left: FloatArray, scene: Scene, every: float) -> FloatArray:
        """What of a course, shape (samples,), is such vibration of a line, by least squares over what is finite of it."""
        courses, there = self.courses(self.roots(scene, every), len(left), every), np.isfinite(left)
        sizes = np.linalg.lstsq(courses[there], left[there], rcond=SAME)[0]
        return np.asarray(courses @ sizes)


def ringing_words(trials: Sequence[Trial]) -> tuple[str, ...]:
    """Which records begin in rotation and what is taken out of them for it, in words."""
    found = []
    for trial in trials:
        roots = () if trial.ringing is None else trial.ringing.roots(trial.scene, trial.every)
        if roots:
            rates = ", ".join(f"{root.imag:.4g}" for root in roots)
            found.append(
                f"Record {trial.name!r} begins in rotation: free vibration of unknown size at the frequencies of the line (nominally"
                f" {rates} rad/s), which goes on from before it, is taken out of each column. Bench.run_in asked for it."
            )
    return tuple(found)

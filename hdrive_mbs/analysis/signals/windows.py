"""Windows of the Fourier analysis, and what a pure sine looks like through them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.errors import unknown_place

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Window:
    """A sum of cosines  w(k) = sum_m (-1)^m a_m cos(2 pi m k / n), periodic in n samples.

    The coherent gain is a_0: dividing by it lets a sine of amplitude A show A.
    """

    name: str
    coefficients: tuple[float, ...]

    def values(self, count: int) -> FloatArray:
        """The window at k = 0 .. count - 1."""
        turn = 2.0 * np.pi * np.arange(count) / count
        return np.asarray(sum((-1) ** m * a * np.cos(m * turn) for m, a in enumerate(self.coefficients)), float)

    def response(self, offset: float) -> float:
        """Height that a sine of amplitude 1 shows at a line ``offset`` lines beside it (many samples).

        W(x) = [a_0 sinc(x) + sum_m a_m/2 (sinc(x - m) + sinc(x + m))] / a_0, the transform of w.
        """
        first, *others = self.coefficients
        total = first * np.sinc(offset)
        for m, a in enumerate(others, start=1):
            total += 0.5 * a * (np.sinc(offset - m) + np.sinc(offset + m))
        return float(abs(total) / first)

    def between_lines(self, left: float, centre: float, right: float) -> tuple[float, float]:
        """Position (in lines from the centre) and amplitude of the sine behind a local maximum.

        The ratio of the larger neighbour to the maximum fixes the position: W(1 - x)/W(x), which
        rises with x in 0 .. 1/2, by bisection.
        """
        side, neighbour = (1.0, right) if right >= left else (-1.0, left)
        wanted = neighbour / centre if centre > 0.0 else 0.0
        low, high = 0.0, 0.5
        for _ in range(60):
            middle = 0.5 * (low + high)
            if self.response(1.0 - middle) < wanted * self.response(middle):
                low = middle
            else:
                high = middle
        return side * high, centre / self.response(high)


WINDOWS = {
    window.name: window
    for window in (
        Window(name="rectangular", coefficients=(1.0,)),
        Window(name="hann", coefficients=(0.5, 0.5)),
        Window(name="hamming", coefficients=(0.54, 0.46)),
        Window(name="blackman", coefficients=(0.42, 0.5, 0.08)),
        # D'Antona and Ferrero, Digital Signal Processing for Measurement Systems (2006), p. 70
        Window(name="flat_top", coefficients=(0.21557895, 0.41663158, 0.277263158, 0.083578947, 0.006947368)),
    )
}
"""Known windows by name."""


def window_named(name: str) -> Window:
    """The window of that name.  Raises PlaceError for an unknown one."""
    if name not in WINDOWS:
        raise unknown_place("window", name, WINDOWS, "The spectrum")
    return WINDOWS[name]


def line_amplitudes(samples: FloatArray, window: Window) -> tuple[FloatArray, FloatArray]:
    """Amplitude (0-peak) and phase [rad, of a cosine] of each line; line 0 holds the size of the mean.

    The mean is taken off before the window is applied, so that it does not leak into line 1.
    """
    count = len(samples)
    mean = float(np.mean(samples))
    transform = np.fft.rfft((samples - mean) * window.values(count)) / (count * window.coefficients[0])
    amplitude = 2.0 * np.abs(transform)
    if count % 2 == 0:
        amplitude[-1] *= 0.5
    amplitude[0] = abs(mean)
    return amplitude, np.angle(transform)


def local_maxima(amplitude: FloatArray, window: Window, count: int, above: float) -> list[tuple[float, float]]:
    """(position in lines, amplitude) of the largest maxima, largest first; line 0 is left out.

    above : smallest amplitude that counts, as a share of the largest
    Within the main lobe of a larger maximum there is no second one.
    """
    inner = amplitude[1:-1]
    lines = 1 + np.nonzero((inner >= amplitude[2:]) & (inner > np.where(np.arange(1, len(inner) + 1) == 1, 0.0, amplitude[:-2])))[0]
    floor = above * float(np.max(amplitude[1:], initial=0.0))
    width = len(window.coefficients)
    found: list[int] = []
    for line in sorted(lines.tolist(), key=lambda k: -float(amplitude[k])):
        if len(found) == count or amplitude[line] < floor or amplitude[line] == 0.0:
            break
        if all(abs(line - other) > width for other in found):
            found.append(line)
    result: list[tuple[float, float]] = []
    for line in found:
        left = float(amplitude[line - 1]) if line > 1 else 0.0
        offset, height = window.between_lines(left, float(amplitude[line]), float(amplitude[line + 1]))
        result.append((line + offset, height))
    return result

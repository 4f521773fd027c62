"""What a table of modes says of motions that do not oscillate."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt


def decay_note(rates: npt.NDArray[np.float64]) -> tuple[str, ...]:
    """A line with the rates of decay [1/s], or none."""
    return (f"non-oscillating motions decay with {', '.join(f'{rate:.4g}' for rate in rates)} 1/s",) if len(rates) else ()

"""Colours and lines of the kinds of modes of a rotor line."""

from __future__ import annotations

from typing import Any

from hdrive_mbs.plots.look import COLOURS

WHIRL_LOOK: dict[str, dict[str, Any]] = {
    "forward": {"color": COLOURS[0], "linestyle": "-"},
    "backward": {"color": COLOURS[1], "linestyle": (0, (6, 2))},
    "mixed": {"color": COLOURS[4], "linestyle": (0, (7, 1.5, 1.5, 1.5))},
    "torsional": {"color": COLOURS[2], "linestyle": "-."},
    "axial": {"color": COLOURS[3], "linestyle": (0, (1, 1.2))},
}
"""One look a kind; told apart in grey by the dashes."""

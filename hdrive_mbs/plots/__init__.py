"""Pictures of results: ``plot(result)`` and ``save_figure``.  The only importer of matplotlib."""

from __future__ import annotations

from hdrive_mbs.plots import (
    campbell,
    energy,
    modes,
    reduction,
    response,
    spectrum,
    teeth_clearance,
    teeth_design,
    teeth_positions,
    teeth_section,
    torsion,
)
from hdrive_mbs.plots.dispatch import plot
from hdrive_mbs.plots.look import house_look
from hdrive_mbs.plots.saving import save_figure
from hdrive_mbs.plots.teeth_animation import animate

__all__ = [
    "animate",
    "campbell",
    "energy",
    "house_look",
    "modes",
    "plot",
    "reduction",
    "response",
    "save_figure",
    "spectrum",
    "teeth_clearance",
    "teeth_design",
    "teeth_positions",
    "teeth_section",
    "torsion",
]

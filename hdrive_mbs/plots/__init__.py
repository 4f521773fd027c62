"""Pictures of results: ``plot(result)``, ``animate(result, path)`` and ``save_figure``.  The only importer of matplotlib."""

from __future__ import annotations

from hdrive_mbs.plots import (
    campbell,
    critical_map,
    deflection_line,
    diagnosis,
    energy,
    modes,
    orbit,
    order_tracking,
    reduction,
    response,
    response_animation,
    run_up,
    spectrum,
    teeth_animation,
    teeth_clearance,
    teeth_design,
    teeth_positions,
    teeth_section,
    torsion,
    unbalance_response,
    waterfall,
    whirl_campbell,
    whirl_modes,
)
from hdrive_mbs.plots.animation import animate
from hdrive_mbs.plots.dispatch import plot
from hdrive_mbs.plots.look import house_look
from hdrive_mbs.plots.saving import save_figure

__all__ = [
    "animate",
    "campbell",
    "critical_map",
    "deflection_line",
    "diagnosis",
    "energy",
    "house_look",
    "modes",
    "orbit",
    "order_tracking",
    "plot",
    "reduction",
    "response",
    "response_animation",
    "run_up",
    "save_figure",
    "spectrum",
    "teeth_animation",
    "teeth_clearance",
    "teeth_design",
    "teeth_positions",
    "teeth_section",
    "torsion",
    "unbalance_response",
    "waterfall",
    "whirl_campbell",
    "whirl_modes",
]

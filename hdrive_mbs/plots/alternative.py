"""Words for those who do not see a figure, read off the figure itself: its panels and what its legends name."""

from __future__ import annotations

import re
from typing import Any

from matplotlib.axes import Axes

_UNIT = re.compile(r"\[[^\]]*\]")


def drawn_words(axes: Axes) -> str:
    """What the whole figure of some axes shows, in one or two sentences; empty where neither axes nor legends have names.

    "Panels: torque over twist; speed over time. Shown: measured, nominal."
    """
    figure: Any = axes.figure.figure
    panels: list[str] = []
    shown: list[str] = []
    for panel in figure.axes:
        up, title = _plain(panel.get_ylabel()), _plain(panel.get_title() or panel.get_title("left"))
        sharing = (panel, *panel.get_shared_x_axes().get_siblings(panel))
        along = next((text for one in sharing if (text := _plain(one.get_xlabel()))), "")
        words = f"{up} over {along}" if up and along else up or along
        panels += [f"{title}: {words}" if title and words else title or words]
        shown += _entries(panel.get_legend())
    for legend in figure.legends:
        shown += _entries(legend)
    said = [("Panels" if len(set(panels)) > 1 else "Drawn", "; ".join(dict.fromkeys(filter(None, panels))))]
    said.append(("Shown", ", ".join(dict.fromkeys(shown))))
    return " ".join(f"{head}: {text}." for head, text in said if text)


def _entries(legend: Any) -> list[str]:
    return [] if legend is None else [word for text in legend.get_texts() if (word := _plain(text.get_text()))]


def _plain(text: str) -> str:
    """In one line, without units."""
    return " ".join(_UNIT.sub(" ", text.replace("\u2009", " ")).split())

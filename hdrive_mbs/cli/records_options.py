"""Options of the commands that read measured records, and what they say to the reader."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any

import typer

from hdrive_mbs.errors import FileFormatError

BenchFile = Annotated[
    Path, typer.Argument(metavar="SCENE", help="A .py file with bench() -> Bench, or with build() -> Scene, or a scene file.")
]
OwnEffects = Annotated[
    list[Path] | None, typer.Option("--effects", metavar="FILE.py", help="A file of your own whose Effect classes are tried too.")
]
Only = Annotated[
    list[str] | None,
    typer.Option("--only", metavar="EFFECT", help="Try this effect or family alone, like MeshFriction or friction (several times)."),
]
Channels = Annotated[
    list[str] | None,
    typer.Option("--channel", metavar="COLUMN=PLACE.QUANTITY", help="What a column measures, e.g. n_mot=motor.speed (several times)."),
]
Units = Annotated[
    list[str] | None, typer.Option("--unit", metavar="COLUMN=UNIT", help="Unit of a column where the file says none (several times).")
]
TimeColumn = Annotated[str | None, typer.Option("--time", metavar="COLUMN", help="Column with the time, or a rate like '5 kHz'.")]
HeldOut = Annotated[
    list[str] | None,
    typer.Option("--held-out", metavar="RECORD", help="A record that no fit sees, for the gap (several times); else a quarter of each."),
]
Every = Annotated[
    int | None,
    typer.Option(metavar="N", min=1, help="Of so many samples the search compares one (4); 1 for records that are sparse already."),
]
SearchSeconds = Annotated[
    float | None,
    typer.Option(
        metavar="S", help="Look for no more after so many seconds, where what was found leaves something; an answer follows later."
    ),
]
Repairs = Annotated[
    list[str] | None, typer.Option("--repair", metavar="FAULT=HOW", help="Repair records, e.g. gaps=interpolate (several times).")
]


def reading_of(channel: Sequence[str] | None, unit: Sequence[str] | None, time: str | None, repair: Sequence[str] | None) -> dict[str, Any]:
    """What ``read_records`` is told besides the files.  Raises FileFormatError for a text that is not NAME=VALUE."""
    repairs: dict[str, Any] = dict(_pairs("--repair", repair))
    if "longest" in repairs:
        if not repairs["longest"].isdecimal():
            raise FileFormatError(f"--repair longest={repairs['longest']}: write a number of samples, like longest=20.")
        repairs["longest"] = int(repairs["longest"])
    return {
        "channels": _pairs("--channel", channel) or None,
        "units": _pairs("--unit", unit),
        "time": time,
        "repair": repairs or None,
    }


def _pairs(option: str, texts: Sequence[str] | None) -> dict[str, str]:
    """``NAME=VALUE`` -> a mapping."""
    found = {}
    for text in texts or ():
        name, sign, value = (part.strip() for part in text.partition("="))
        if not (name and sign and value):
            raise FileFormatError(f"{option} {text!r}: write NAME=VALUE.")
        found[name] = value
    return found

"""Errors and notes of the library in the words of the command line: its options in place of arguments in Python."""

from __future__ import annotations

import re
import shlex
from collections.abc import Callable

from hdrive_mbs.records.repair import WAYS

_REPAIRS = "|".join(WAYS)
_PAIR = re.compile(r"""(['"])(?P<name>.*?)\1:\s*(?:(['"])(?P<value>.*?)\3|\.\.\.)""")
_RULES: tuple[tuple[re.Pattern[str], Callable[[re.Match[str]], str]], ...] = (
    (re.compile(r"read_records?\(path, (.*?)\)(?=[.,;\s]|$)"), lambda found: found.group(1)),
    (re.compile(r"(?:hdrive_mbs\.|hm\.)?repaired\(record, ([^()]*)\)"), lambda found: found.group(1).replace(", ", " ")),
    (re.compile(r"\bunits=\{(.*?)\}"), lambda found: _options("--unit", found.group(1), "UNIT")),
    (re.compile(r"\bchannels=\{(.*?)\}"), lambda found: _options("--channel", found.group(1), "PLACE.QUANTITY")),
    (re.compile(rf"\b({_REPAIRS})='(\w+)'"), lambda found: f"--repair {found.group(1)}={found.group(2)}"),
    (re.compile(r"\blongest=(\d+)"), lambda found: f"--repair longest={found.group(1)}"),
    (
        re.compile(r"""\bleave_out=\[(['"])(.*?)\1, \.\.\.\]"""),
        lambda found: f"hdrive-mbs from-ross FILE --leave-out {shlex.quote(found.group(2))} ... --out SCENE.toml",
    ),
    (re.compile(r"\btime='\.\.\.'"), lambda found: "--time COLUMN"),
    (re.compile(r"\btime='([^']+)'"), lambda found: f"--time {shlex.quote(found.group(1))}"),
    (re.compile(r"\btime=2e-4 \(s\)"), lambda found: "--time '5 kHz'"),
    (
        re.compile(r"\(?\b(record\.(?:between|without|replacing)\([^()]*\)|channels=\[\.\.\.\])(?:(?<=\))\)(?=[,.;]))?"),
        lambda found: f"(in Python: {found.group(1)})",
    ),
)
"""What a text says, and what it is on the command line."""


def on_command_line(text: str) -> str:
    """``give it with units={'time': 's'}`` -> ``give it with --unit time=s``; what has no option is said to be Python."""
    for pattern, said in _RULES:
        text = pattern.sub(said, text)
    return text


def _options(option: str, pairs: str, stands_for: str) -> str:
    found = [f"{match['name']}={_value(match['value'], stands_for)}" for match in _PAIR.finditer(pairs)]
    more = " ..." if pairs.rstrip().endswith(", ...") else ""
    return " ".join(f"{option} {shlex.quote(text)}" for text in found) + more if found else f"{option} COLUMN={stands_for}"


def _value(given: str | None, stands_for: str) -> str:
    return stands_for if given in (None, "...") else str(given)

"""The docstrings of this package, which are plain text, as reStructuredText.

They have paragraphs; lines ``name : meaning`` for parameters and fields; and indented lines, which are equations or
examples and are shown as they stand.  Nothing else is markup: a star is a star.
"""

from __future__ import annotations

import re
from typing import Any

from sphinx.application import Sphinx

NAMED = re.compile(r"^(?P<names>[A-Za-z_*][\w*]*(?:, [A-Za-z_][\w]*)*)(?P<unit> \[[^\]]*\])?\s+: (?P<text>.*)$")
MARKUP = re.compile(r"([\\*|_`<>])")
CODE = re.compile(r"(``?)(?=\S)([^`\n]+?)(?<=\S)\1")


def escaped(text: str) -> str:
    """Text whose only markup is code between backticks."""
    out, last = [], 0
    for found in CODE.finditer(text):
        out += [MARKUP.sub(r"\\\1", text[last : found.start()]), f"``{found[2]}``"]
        last = found.end()
        if last < len(text) and text[last].isalnum():
            out.append("\\ ")
    return "".join([*out, MARKUP.sub(r"\\\1", text[last:])])


def _indent(line: str) -> int:
    return len(line) - len(line.lstrip())


def markup(lines: list[str]) -> list[str]:
    """The same text for docutils."""
    out: list[str] = []
    k = 0
    while k < len(lines):
        line = lines[k]
        if not line.strip():
            out.append("")
            k += 1
        elif NAMED.match(line.strip()):
            k = _names(lines, k, out)
        elif line[0] == " ":
            k = _block(lines, k, out)
        else:
            k = _paragraph(lines, k, out)
    return out


def _paragraph(lines: list[str], k: int, out: list[str]) -> int:
    words = []
    while k < len(lines) and lines[k].strip() and lines[k][0] != " " and not NAMED.match(lines[k]):
        words.append(lines[k].strip())
        k += 1
    text = escaped(" ".join(words))
    if text.endswith("::"):
        text = text[:-1]
    if re.match(r"[-+•] |[\w#]+[.)] |\.\. ", text):  # would begin a list or a directive
        text = f"\\ {text}"
    out += ["", text, ""]
    return k


def _block(lines: list[str], k: int, out: list[str]) -> int:
    """Indented lines as they stand."""
    out += ["", ".. code-block:: text", ""]
    while k < len(lines) and (not lines[k].strip() or (lines[k][0] == " " and not NAMED.match(lines[k].strip()))):
        out.append(f"   {lines[k]}")
        k += 1
    out += [""]
    return k


def _names(lines: list[str], k: int, out: list[str]) -> int:
    """Lines ``name : meaning``, each with those that continue it further in."""
    out.append("")
    while k < len(lines) and (found := NAMED.match(lines[k].strip())):
        words, depth = [found["text"]], _indent(lines[k])
        k += 1
        while k < len(lines) and lines[k].strip() and _indent(lines[k]) > depth and not NAMED.match(lines[k].strip()):
            words.append(lines[k].strip())
            k += 1
        names = ", ".join(f"``{name}``" for name in found["names"].split(", "))
        out += [f"{names}{escaped(found['unit'] or '')}", f"   {escaped(' '.join(words))}"]
    out.append("")
    return k


def _plain(app: Sphinx, what: str, name: str, thing: Any, options: Any, lines: list[str]) -> None:
    lines[:] = markup(lines)


def setup(app: Sphinx) -> dict[str, bool]:
    app.connect("autodoc-process-docstring", _plain)
    return {"parallel_read_safe": True, "parallel_write_safe": True}

"""Pages for a browser: text, tables and pictures in a single file that needs nothing else."""

from __future__ import annotations

import base64
import io
from collections.abc import Callable, Iterable, Iterator
from html import escape
from typing import Any

from matplotlib.axes import Axes

from hdrive_mbs.diagnosis.report_rows import Table
from hdrive_mbs.plots.alternative import drawn_words

STYLE = """
body { font: 16px/1.45 system-ui, sans-serif; color: #1a1a1a; background: #fff; overflow-wrap: anywhere; }
body { max-width: 46rem; margin: 0 auto; padding: 1rem; }
h1 { font-size: 1.35rem; line-height: 1.25; } h2 { font-size: 1.1rem; margin: 2rem 0 .5rem; }
h3 { font-size: 1rem; margin: 1.2rem 0 .3rem; }
.verdict { border-left: .4rem solid #0072B2; background: #f1f6fa; padding: .7rem 1rem; margin: 1rem 0; }
.verdict p { margin: .2rem 0; } .verdict p:first-child { font-size: 1.15rem; font-weight: 600; }
.none { border-color: #009E73; background: #eef8f4; } .unknown { border-color: #D55E00; background: #fdf3ec; }
.table { overflow-x: auto; margin: .6rem 0; } table { border-collapse: collapse; font-size: .85rem; }
table { overflow-wrap: normal; }
.table { background: linear-gradient(to right, #fff 30%, #fff0), linear-gradient(to left, #fff 30%, #fff0) 100% 0,
  linear-gradient(to right, #0003, #0000), linear-gradient(to left, #0003, #0000) 100% 0; background-repeat: no-repeat;
  background-size: 2rem 100%, 2rem 100%, .8rem 100%, .8rem 100%; background-attachment: local, local, scroll, scroll; }
caption { text-align: left; padding: .2rem 0; color: #444; }
th, td { padding: .2rem .6rem .2rem 0; text-align: left; vertical-align: top; border-bottom: 1px solid #ddd; }
.number { text-align: right; white-space: nowrap; }
figure { margin: 1rem 0; } img { display: block; max-width: 100%; height: auto; } figcaption { font-size: .85rem; color: #444; }
summary { cursor: pointer; padding: .4rem 0; } footer { margin-top: 2rem; font-size: .85rem; color: #444; }
"""
DOTS = 200
"""Of a picture of many points, per inch."""


def page(title: str, body: str) -> str:
    """The whole file.  Its policy forbids a browser to fetch anything."""
    head = (
        '<meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">'
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; style-src 'unsafe-inline'\">"
        f"<title>{escape(title)}</title><style>{STYLE}</style>"
    )
    return f'<!DOCTYPE html>\n<html lang="en">\n<head>{head}</head>\n<body>\n<h1>{escape(title)}</h1>\n{body}\n</body>\n</html>\n'


def bullets(title: str, lines: Iterable[str]) -> Iterator[str]:
    """A heading and a list; nothing for no lines."""
    items = [f"<li>{escape(line)}</li>" for line in lines]
    if items:
        yield f"<h2>{escape(title)}</h2><ul>{''.join(items)}</ul>"


def paragraphs(texts: Iterable[str]) -> list[str]:
    """Each text as a paragraph."""
    return [f"<p>{escape(text)}</p>" for text in texts]


def table_of(table: Table, caption: str) -> Iterator[str]:
    """A table that scrolls by itself where the screen is narrow; nothing for no rows."""
    if not table.rows:
        return

    def cells(tag: str, row: tuple[str, ...]) -> str:
        numbers = [' class="number"' if k >= table.words else "" for k in range(len(row))]
        scope = ' scope="col"' if tag == "th" else ""
        return "".join(f"<{tag}{scope}{number}>{escape(text)}</{tag}>" for number, text in zip(numbers, row, strict=True))

    rows = "".join(f"<tr>{cells('td', row)}</tr>" for row in table.rows)
    head = f"<thead><tr>{cells('th', table.heads)}</tr></thead>"
    yield f'<div class="table"><table><caption>{escape(caption)}</caption>{head}<tbody>{rows}</tbody></table></div>'


def figure(axes: Axes, alternative: str, caption: str, *, points: bool = False) -> str:
    """The whole figure of some axes, with a text for those who do not see it.

    alternative : what it says; what is drawn in it is added, see ``drawn_words``
    points : whether it has so many points that a picture of dots is smaller than one of lines
    """
    drawn: Any = axes.figure.figure
    kind, mime = ("png", "image/png") if points else ("svg", "image/svg+xml")
    buffer = io.BytesIO()
    save: Callable[..., None] = drawn.savefig
    save(buffer, format=kind, dpi=DOTS, metadata={"Software": None} if points else {"Date": None})
    width, height = (round(96.0 * size) for size in drawn.get_size_inches())
    data = base64.b64encode(buffer.getvalue()).decode("ascii")
    words = f"{alternative} {drawn_words(axes)}".strip()
    picture = f'<img alt="{escape(words, quote=True)}" width="{width}" height="{height}" src="data:{mime};base64,{data}">'
    return f"<figure>{picture}<figcaption>{escape(caption)}</figcaption></figure>"

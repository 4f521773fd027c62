"""A page as a browser lays it out at some width: headless Chromium, where there is one."""

from __future__ import annotations

import html
import json
import re
import shutil
import subprocess
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome")
BROWSER = next((found for name in NAMES if (found := shutil.which(name))), None)
needs_browser = pytest.mark.skipif(BROWSER is None, reason=f"no browser is installed: {', '.join(NAMES)}")
PHONE, DESKTOP = 390, 1280
"""CSS pixels."""

# The page stands in a frame of the asked width, since no browser window is as narrow as a phone; "wide" is what sticks out of it.
_PROBE = """<!DOCTYPE html><meta charset="utf-8"><pre id="told"></pre>
<iframe id="frame" style="width:{width}px;height:900px;border:0" srcdoc="{page}"></iframe>
<script>
document.getElementById("frame").onload = event => {{
  const inner = event.target.contentDocument, view = inner.scrollingElement, wide = [];
  for (const item of inner.querySelectorAll("body *")) {{
    const box = item.getBoundingClientRect();
    if (box.width && box.right > view.clientWidth + 1 && !item.closest(".table")) wide.push(item.tagName + " " + box.right);
  }}
  const pictures = [...inner.images].map(
    item => ({{alternative: item.alt, drawn: item.complete && item.naturalWidth > 0, width: item.getBoundingClientRect().width}}));
  const tables = [...inner.querySelectorAll(".table")].map(item => item.getBoundingClientRect().width);
  document.getElementById("told").textContent =
    JSON.stringify({{width: view.clientWidth, scroll: view.scrollWidth, wide: wide, pictures: pictures, tables: tables}});
}};
</script>"""


@dataclass(frozen=True)
class Layout:
    """width : of the page without its scroll bar;  scroll : of what is on it;  wide : what sticks out, apart from tables that scroll
    pictures : of each its alternative text, whether it was drawn, and its width;  tables : width of each
    """

    width: float
    scroll: float
    wide: list[str]
    pictures: list[dict[str, Any]]
    tables: list[float]

    def check(self) -> None:
        """Nothing sticks out, and each picture is drawn, as wide as the page at most, and has words."""
        assert self.scroll <= self.width
        assert self.wide == []
        assert self.pictures
        for picture in self.pictures:
            assert picture["drawn"], picture["alternative"]
            assert 0.5 * min(self.width, 640.0) < picture["width"] <= self.width
            assert len(picture["alternative"].split()) >= 5
        assert all(width <= self.width for width in self.tables)


def layout(page: str, width: int, folder: Path) -> Layout:
    """The text of a page, laid out at a width."""
    assert BROWSER is not None
    probe = folder / f"probe_{width}.html"
    probe.write_text(_PROBE.format(width=width, page=html.escape(page, quote=True)), encoding="utf-8")
    command = [
        BROWSER,
        "--headless",
        "--no-sandbox",
        "--disable-gpu",
        f"--user-data-dir={folder / 'profile'}",
        "--virtual-time-budget=20000",
    ]
    done = subprocess.run([*command, "--dump-dom", probe.as_uri()], capture_output=True, text=True, timeout=120, check=False)
    told = re.search(r'<pre id="told">(\{.*?)</pre>', done.stdout, re.DOTALL)
    assert told is not None, done.stderr[-500:]
    return Layout(**json.loads(html.unescape(told[1])))

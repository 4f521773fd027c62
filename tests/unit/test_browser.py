"""The check of a page's layout sees what it is there to see."""

from __future__ import annotations

from pathlib import Path

import pytest

from hdrive_mbs.plots.page import page
from tests.browser import DESKTOP, PHONE, layout, needs_browser

DOT = "data:image/gif;base64,R0lGODlhAQABAIAAAAAAAP///yH5BAEAAAAALAAAAAABAAEAAAIBRAA7"
GOOD = f'<img src="{DOT}" style="width:300px" alt="torque over twist of the gear">'


@needs_browser
@pytest.mark.parametrize("width", [PHONE, DESKTOP])
def test_a_page_in_our_style_fits_although_a_table_and_a_word_are_wide(width: int, tmp_path: Path) -> None:
    row = "".join(f"<td>{k * 1000003}</td>" for k in range(60))
    found = layout(page("Long", f'{GOOD}<p>{"x" * 900}</p><div class="table"><table><tr>{row}</tr></table></div>'), width, tmp_path)
    assert found.width == pytest.approx(width, abs=20)
    if width == PHONE:
        found.check()
    assert found.tables[0] < found.width


@needs_browser
@pytest.mark.parametrize(
    "body",
    [
        f'{GOOD}<div style="width:900px">wide</div>',
        f'<img src="{DOT}" style="width:300px" alt="">',
        '<img src="data:image/png;base64,broken" style="width:300px" alt="torque over twist of the gear">',
        f'<img src="{DOT}" style="width:20px" alt="torque over twist of the gear">',
        f'<img src="{DOT}" style="width:800px;max-width:none" alt="torque over twist of the gear">',
        "<p>no picture</p>",
    ],
)
def test_what_does_not_fit_is_seen(body: str, tmp_path: Path) -> None:
    with pytest.raises(AssertionError):
        layout(page("Bad", body), PHONE, tmp_path).check()

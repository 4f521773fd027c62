"""A tutorial prints what it quotes, and the pictures of the gallery that it leaves behind are the committed ones: one run for both."""

from __future__ import annotations

import re
import warnings
from pathlib import Path

import pytest

from docs.gallery.make import names, run
from hdrive_mbs.engine.assembly import LoweringWarning
from tests.examples.quotations import missing
from tests.examples.test_documents import TUTORIALS, blocks, skip_without_extras
from tests.examples.test_gallery import check_picture, of_tutorial

PICTURES = {path.stem: [name for name in names() if of_tutorial(name) == path.stem] for path in TUTORIALS}


@pytest.mark.parametrize("path", TUTORIALS, ids=lambda path: path.name)
def test_a_tutorial_prints_what_it_quotes_and_makes_its_pictures(path: Path) -> None:
    """A block of text that follows a block of code is what that code prints; a line ``...`` stands for lines left out."""
    text = path.read_text("utf-8")
    skip_without_extras(text)
    pieces = re.findall(r"^```python\n(.*?)^```\n(?:\n```text\n(.*?)^```$)?", text, re.S | re.M)
    assert [code for code, _ in pieces] == blocks(path)
    quoted = [quote for _, quote in pieces]
    assert len(re.findall(r"^```text$", text, re.M)) == sum(map(bool, quoted)) >= 2, "text is quoted that follows no code"
    with warnings.catch_warnings():
        warnings.simplefilter("error", LoweringWarning)
        _, printed = run(path.stem)
    assert len(printed) == len(quoted)
    for quote, output in zip(quoted, printed, strict=True):
        if quote:
            assert not missing(quote, output), output
    for name in PICTURES[path.stem]:
        check_picture(name)


def test_a_quotation_with_another_word_or_number_is_noticed() -> None:
    printed = "An effect is missing: mesh friction at gear.\n\n  loss  0.15027 (0.14995 to 0.15059)  mu\ngap 1.019\n"
    assert not missing("...\n loss 0.1503 (0.1500 to 0.1506) ...\n...\n", printed)
    assert not missing("An effect is missing: mesh friction at gear.\n...\ngap 1.02\n", printed)
    for wrong in ("...\ngap 1.05\n", "...\ngap of 1.02\n", "...\nmesh friction at motor.\n...\n", "gap 1.02\n", "...\nloss 0.15 ...\n"):
        assert missing(wrong, printed), wrong

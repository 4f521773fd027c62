"""A tutorial prints what it quotes, and the pictures of the gallery that it leaves behind are the committed ones: one run for both."""

from __future__ import annotations

import json
import os
import pickle
import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests.examples.quotations import missing
from tests.examples.test_documents import ROOT, TUTORIALS, blocks, skip_without_extras
from tests.examples.test_gallery import NAMES, check_picture, of_tutorial
from tests.patience import PATIENCE


@pytest.mark.slow
@pytest.mark.parametrize("path", TUTORIALS, ids=lambda path: path.name)
def test_a_tutorial_prints_what_it_quotes_and_makes_its_pictures(path: Path, tmp_path: Path) -> None:
    """A block of text that follows a block of code is what that code prints; a line ``...`` stands for lines left out."""
    text = path.read_text("utf-8")
    skip_without_extras(text)
    pieces = re.findall(r"^```python\n(.*?)^```\n(?:\n```text\n(.*?)^```$)?", text, re.S | re.M)
    assert [code for code, _ in pieces] == blocks(path)
    quoted = [quote for _, quote in pieces]
    assert len(re.findall(r"^```text$", text, re.M)) == sum(map(bool, quoted)) >= 2, "text is quoted that follows no code"
    names = [name for name in NAMES if of_tutorial(name) == path.stem]
    command = [sys.executable, "-m", "tests.examples.tutorial_process", path.stem, tmp_path, *names]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=PATIENCE)
    assert done.returncode == 0, done.stderr
    assert "LoweringWarning" not in done.stderr
    printed = json.loads((tmp_path / "printed.json").read_text("utf-8"))
    assert len(printed) == len(quoted)
    for quote, output in zip(quoted, printed, strict=True):
        if quote:
            assert not missing(quote, output), output
    for name in names:
        check_picture(name, pickle.loads((tmp_path / f"{name}.pickle").read_bytes()))


def test_a_quotation_with_another_word_or_number_is_noticed() -> None:
    printed = "An effect is missing: mesh friction at gear.\n\n  loss  0.15027 (0.14995 to 0.15059)  mu\ngap 1.019\n"
    assert not missing("...\n loss 0.1503 (0.1500 to 0.1506) ...\n...\n", printed)
    assert not missing("An effect is missing: mesh friction at gear.\n...\ngap 1.02\n", printed)
    for wrong in ("...\ngap 1.05\n", "...\ngap of 1.02\n", "...\nmesh friction at motor.\n...\n", "gap 1.02\n", "...\nloss 0.15 ...\n"):
        assert missing(wrong, printed), wrong

"""Every Python example of README and docs runs as it is printed, and a tutorial prints what it quotes."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

import hdrive_mbs as hm
from tests.patience import PATIENCE

ROOT = Path(__file__).parents[2]
FOLDERS = ("", "analyses", "tutorials", "gallery", "api")
DOCUMENTS = [ROOT / "README.md", *(path for folder in FOLDERS for path in sorted((ROOT / "docs" / folder).glob("*.md")))]
TUTORIALS = [path for path in DOCUMENTS if path.parent.name == "tutorials" and path.stem != "index"]


def blocks(path: Path) -> list[str]:
    return re.findall(r"^```python\n(.*?)^```$", path.read_text("utf-8"), re.S | re.M)


EXAMPLES = [
    pytest.param(code, id=f"{path.name}-{number}")
    for path in DOCUMENTS
    if path not in TUTORIALS
    for number, code in enumerate(blocks(path), start=1)
]
NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
MARK = "-- next block --"


@pytest.mark.parametrize("code", EXAMPLES)
def test_example_runs_as_printed(code: str, tmp_path: Path) -> None:
    run(code, tmp_path)


def run(code: str, tmp_path: Path) -> str:
    """What an example prints."""
    for module in ("h5py", "pyarrow", "asammdf"):
        if re.search(rf"^import {module}\b", code, re.MULTILINE):
            pytest.importorskip(module, reason='needs the extra: pip install -e ".[records]"')
    script = tmp_path / "example.py"
    script.write_text(code, "utf-8")
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run([sys.executable, script], cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=PATIENCE)
    assert done.returncode == 0, done.stderr
    assert "LoweringWarning" not in done.stderr
    return done.stdout


@pytest.mark.parametrize("path", TUTORIALS, ids=lambda path: path.name)
def test_a_tutorial_runs_from_top_to_bottom_and_prints_what_it_quotes(path: Path, tmp_path: Path) -> None:
    """A block of text that follows a block of code is what that code prints; a line ``...`` stands for lines left out."""
    text = path.read_text("utf-8")
    pieces = re.findall(r"^```python\n(.*?)^```\n(?:\n```text\n(.*?)^```$)?", text, re.S | re.M)
    assert [code for code, _ in pieces] == blocks(path)
    quoted = [quote for _, quote in pieces]
    assert len(re.findall(r"^```text$", text, re.M)) == sum(map(bool, quoted)) >= 2, "text is quoted that follows no code"
    printed = run(f'print("{MARK}")\n'.join(code for code, _ in pieces), tmp_path).split(f"{MARK}\n")
    assert len(printed) == len(quoted)
    for quote, output in zip(quoted, printed, strict=True):
        if quote:
            assert not missing(quote, output), output


def missing(quote: str, printed: str) -> str:
    """The first line of a quotation that was not printed at its place; empty if all were."""
    left = [line for line in printed.splitlines() if line.strip()]
    anywhere = False
    for line in quote.splitlines():
        if line.strip() == "...":
            anywhere = True
            continue
        places = range(len(left)) if anywhere else range(min(1, len(left)))
        place = next((k for k in places if alike(line, left[k])), None)
        if place is None:
            return line
        del left[: place + 1]
        anywhere = False
    return "" if anywhere or not left else f"end, before {left[0]}"


def alike(quoted: str, printed: str) -> bool:
    """The same words, and numbers to one in the last digit quoted or 0.2 %: another machine rounds and steps otherwise.

    Whether fields are wider or narrower does not matter; a quotation that ends with ... is compared up to there.
    """
    quoted, printed = (" ".join(line.split()) for line in (quoted, printed))
    cut = quoted.endswith(" ...")
    words, before = ([part.strip() for part in NUMBER.split(line)] for line in (quoted.removesuffix(" ..."), printed))
    numbers, found = NUMBER.findall(quoted), NUMBER.findall(printed)
    if cut and len(before) >= len(words):
        end = before[len(words) - 1][: len(words[-1])]
        before, found = [*before[: len(words) - 1], end], found[: len(numbers)]
    return words == before and all(close(*pair) for pair in zip(numbers, found, strict=True))


def close(quoted: str, printed: str) -> bool:
    mantissa, _, exponent = quoted.partition("e")
    digit = 10.0 ** (int(exponent or 0) - len(mantissa.partition(".")[2]))
    return abs(float(printed) - float(quoted)) <= max(1.01 * digit * ("." in mantissa or bool(exponent)), 2e-3 * abs(float(quoted)))


def test_a_quotation_with_another_word_or_number_is_noticed() -> None:
    printed = "An effect is missing: mesh friction at gear.\n\n  loss  0.15027 (0.14995 to 0.15059)  mu\ngap 1.019\n"
    assert not missing("...\n loss 0.1503 (0.1500 to 0.1506) ...\n...\n", printed)
    assert not missing("An effect is missing: mesh friction at gear.\n...\ngap 1.02\n", printed)
    for wrong in ("...\ngap 1.05\n", "...\ngap of 1.02\n", "...\nmesh friction at motor.\n...\n", "gap 1.02\n", "...\nloss 0.15 ...\n"):
        assert missing(wrong, printed), wrong


def test_readme_begins_with_the_two_commands() -> None:
    blocks = re.findall(r"^```bash\n(.*?)^```$", (ROOT / "README.md").read_text("utf-8"), re.S | re.M)
    assert len(blocks) >= 2
    assert all(len(block.strip().splitlines()) == 1 for block in blocks[:2])
    assert "hdrive-mbs demo" in blocks[0]
    assert "pytest" in blocks[1]


def test_every_relative_link_of_the_documents_exists() -> None:
    for path in DOCUMENTS:
        for target in re.findall(r"\]\((?!https?:|#)([^)#]+)", path.read_text("utf-8")):
            assert (path.parent / target).exists(), f"{path.name} links to {target}"


def test_every_picture_of_the_documents_is_one_of_the_gallery() -> None:
    """Whose scripts are run by test_gallery.py."""
    pictures = {path: re.findall(r"!\[([^\]]*)\]\(([^)]+)\)", path.read_text("utf-8")) for path in DOCUMENTS}
    for path, found in pictures.items():
        for text, target in found:
            assert (path.parent / target).resolve().parent == ROOT / "docs" / "gallery" / "pictures", f"{path.name} shows {target}"
            assert len(text) > 20, f"{path.name}: {target} lacks words for those who do not see it"
    assert pictures[ROOT / "README.md"]


def test_every_page_of_an_analysis_has_its_equation_and_its_limits() -> None:
    """In every part that begins with a call of its own: the page, and each section of it."""
    for path in sorted((ROOT / "docs" / "analyses").glob("*.md")):
        if path.stem == "index":
            continue
        for part in path.read_text("utf-8").split("\n## "):
            title = part.splitlines()[0]
            for word in ("\n**Equation", "$$", "\n**Leaves out", "\n```python\n"):
                assert word in part, f"{path.name}, {title}: no {word.strip()}"


def test_every_function_of_analysis_teeth_diagnosis_and_records_is_named_on_a_page() -> None:
    """Of the guide: the API reference has every name anyway."""
    modules = ("analysis.", "teeth.", "diagnosis.", "records.")
    functions = [name for module, names in hm._WHERE.items() if module.startswith(modules) for name in names if name.islower()]
    assert len(functions) > 40
    pages = [path for path in (ROOT / "docs").rglob("*.md") if not {"_build", "collected", "api"} & set(path.parts)]
    text = "\n".join(path.read_text("utf-8") for path in pages)
    assert not [name for name in functions if not re.search(rf"(?:hm\.|`){name}\b", text)]

"""Every Python example of README and docs runs as it is printed; tutorials are run by test_tutorials.py."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

import hdrive_mbs as hm
from tests.examples.warm_process import WarmProcess
from tests.patience import PATIENCE

ROOT = Path(__file__).parents[2]
FOLDERS = ("", "analyses", "tutorials", "gallery", "api")
DOCUMENTS = [ROOT / "README.md", *(path for folder in FOLDERS for path in sorted((ROOT / "docs" / folder).glob("*.md")))]
TUTORIALS = [path for path in DOCUMENTS if path.parent.name == "tutorials" and path.stem != "index"]


def blocks(path: Path) -> list[str]:
    return re.findall(r"^```python\n(.*?)^```$", path.read_text("utf-8"), re.S | re.M)


EXAMPLES = [
    pytest.param(code, id=f"{path.name}-{number}", marks=() if path.name == "README.md" else pytest.mark.slow)
    for path in DOCUMENTS
    if path not in TUTORIALS
    for number, code in enumerate(blocks(path), start=1)
]


def skip_without_extras(code: str) -> None:
    for module in ("h5py", "pyarrow", "asammdf"):
        if re.search(rf"^import {module}\b", code, re.MULTILINE):
            pytest.importorskip(module, reason='needs the extra: pip install -e ".[records]"')


@pytest.fixture(scope="module")
def warm() -> Iterator[WarmProcess]:
    with WarmProcess.start() as process:
        yield process


@pytest.mark.parametrize("code", EXAMPLES)
def test_example_runs_as_printed(code: str, tmp_path: Path, warm: WarmProcess) -> None:
    skip_without_extras(code)
    script = tmp_path / "example.py"
    script.write_text(code, "utf-8")
    done = warm.run(script, PATIENCE)
    assert done.returncode == 0, done.stderr
    assert "LoweringWarning" not in done.stderr


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
    """Whose scripts are run by test_gallery.py and test_tutorials.py."""
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


def test_ci_runs_the_slow_tests_that_the_second_command_leaves_out() -> None:
    steps = (ROOT / ".ci" / "run").read_text("utf-8").splitlines()
    assert ".venv/bin/python -m pytest -n auto -m slow" in steps

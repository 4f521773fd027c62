"""The documentation site: what it shows exists, is true of the code, and was made by the scripts that it names."""

from __future__ import annotations

import ast
import importlib.util
import re
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import pytest

import hdrive_mbs as hm

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
PAGES = [page for page in sorted(DOCS.rglob("*.md")) if not {"_build", "collected"} & set(page.relative_to(DOCS).parts)]
NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")


def module(path: Path) -> ModuleType:
    spec = importlib.util.spec_from_file_location(path.stem, path)
    assert spec is not None
    assert spec.loader is not None
    loaded = importlib.util.module_from_spec(spec)
    sys.modules[path.stem] = loaded  # dataclasses look their module up
    spec.loader.exec_module(loaded)
    return loaded


@pytest.mark.slow
def test_the_site_builds_without_a_warning(tmp_path: Path) -> None:
    pytest.importorskip("sphinx", reason='needs the extra: pip install -e ".[docs]"')
    pytest.importorskip("myst_parser", reason='needs the extra: pip install -e ".[docs]"')
    pytest.importorskip("furo", reason='needs the extra: pip install -e ".[docs]"')
    command = [sys.executable, "-m", "sphinx", "-W", "--keep-going", "-q", "-b", "html", "-d", tmp_path / "trees", DOCS, tmp_path / "html"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=400)
    assert done.returncode == 0, done.stderr
    front = (tmp_path / "html" / "index.html").read_text("utf-8")
    # nothing is fetched when a page is opened
    for page in ("index.html", "analyses/run_up.html", "api/effects.html"):
        text = (tmp_path / "html" / page).read_text("utf-8")
        assert not re.findall(r'(?:src|href)="(?:https?:)?//[^"]*\.(?:js|css|woff2?)', text), page
    assert "<math" in (tmp_path / "html" / "analyses" / "run_up.html").read_text("utf-8")
    assert "Verification" in front
    effects = (tmp_path / "html" / "api" / "effects.html").read_text("utf-8")
    assert 'id="hdrive_mbs.LuGreFriction"' in effects
    assert "bristle stiffness" in effects  # fields stand there with their meaning


def test_every_exported_name_is_on_one_page_of_the_reference() -> None:
    exported = module(DOCS / "tools" / "exported.py") if importlib.util.find_spec("sphinx") else None
    if exported is None:
        pytest.skip('needs the extra: pip install -e ".[docs]"')
    listed = [name for group in exported.GROUPS for name in exported.members(group)]
    assert sorted(listed) == sorted(set(hm.__all__) - {"__version__"})
    for group in exported.GROUPS:
        assert f".. exported:: {group}\n" in (DOCS / "api" / f"{group}.rst").read_text("utf-8")


def test_docstrings_become_markup_without_losing_a_word() -> None:
    pytest.importorskip("sphinx", reason='needs the extra: pip install -e ".[docs]"')
    markup = module(DOCS / "tools" / "docstrings.py").markup
    text = "Force a * b_c of ``law``.\n\nspeeds, count : of the *shaft* [rad/s]\n    and more\n\n    F = k x_1\n\nRaises LawError."
    shown = "\n".join(markup(text.splitlines()))
    assert "a \\* b\\_c of ``law``." in shown
    assert "``speeds``, ``count``\n   of the \\*shaft\\* [rad/s] and more" in shown
    assert ".. code-block:: text\n\n       F = k x_1" in shown
    assert "Raises LawError." in shown


def numbers_apart(line: str) -> tuple[str, list[float]]:
    return NUMBER.sub("#", line), [float(word) for word in NUMBER.findall(line)]


def test_the_verification_page_is_what_its_script_gives() -> None:
    made = module(DOCS / "make_verification.py").page().splitlines()
    kept = (DOCS / "verification.md").read_text("utf-8").splitlines()
    assert len(made) == len(kept)
    for new, old in zip(made, kept, strict=True):
        (words, found), (before, were) = numbers_apart(new), numbers_apart(old)
        assert words == before
        # seven digits are printed; eigenvalues of a few hundred coordinates differ by 1e-10 between machines and one, seen, by 2e-8
        # between the lowest and the newest numpy and scipy allowed: deviations from print of that size change in their digits
        assert found == pytest.approx(were, rel=3e-7, abs=3e-8), old


def test_every_printed_value_is_met_or_its_row_says_why() -> None:
    page = (DOCS / "verification.md").read_text("utf-8")
    assert "not met" not in page
    rows = [line for line in page.splitlines() if line.count("|") == 7 and re.search(r"\d", line)]
    assert len(rows) > 50
    for row in rows:
        *_, deviation, rounding, said = (cell.strip() for cell in row.strip("|").split("|"))
        assert said == "met" or abs(float(deviation)) < 1e-4, row
        assert (said == "met") == (abs(float(deviation)) <= float(rounding) * 1.05), row  # both are printed with two digits


def literals(path: Path) -> set[float]:
    """Sizes of the numbers that a source file writes out, those in texts too."""
    written = [node.value for node in ast.walk(ast.parse(path.read_text("utf-8"))) if isinstance(node, ast.Constant)]
    numbers = [float(value) for value in written if isinstance(value, (int, float))]
    return {
        abs(number) for number in (*numbers, *(float(value) for value in written if isinstance(value, str) and NUMBER.fullmatch(value)))
    }


def test_every_printed_value_of_the_verification_page_is_asserted_by_the_test_it_names() -> None:
    """So that a number mended in one of them is mended in both."""
    parts = (DOCS / "verification.md").read_text("utf-8").split("\n### ")[1:]
    checked = 0
    for part in parts:
        (name,) = re.findall(r"^Test: `(tests/verification/\w+\.py)`", part, re.M)
        known = literals(ROOT / name)
        for row in part.splitlines():
            if row.count("|") == 7 and re.search(r"\d", row):
                published = row.split("|")[2].strip()
                assert abs(float(published)) in known, f"{part.splitlines()[0]}: {published} is not in {name}"
                checked += 1
    assert checked > 50


def test_what_was_found_of_the_claims_stands_in_the_committed_results() -> None:
    results = "".join((ROOT / "benchmarks" / name / "results.md").read_text("utf-8") for name in ("stiffness_laws", "bearings", "teeth"))
    known = {word.lstrip("+-") for word in NUMBER.findall(results)}
    checked = 0
    for row in (DOCS / "claims.md").read_text("utf-8").splitlines():
        cells = row.replace("\\|", "/").strip("|").split("|")
        if not row.startswith("| ") or len(cells) != 3 or cells[1].strip() == "found" or "tests/" in cells[1]:
            continue
        for number in NUMBER.findall(re.sub(r"[A-Za-z_]+\d+|\(\d+\)", "", cells[1])):
            assert number.lstrip("+-") in known, f"{number} in: {row}"
            checked += 1
    assert checked > 80


def test_every_page_is_reached_from_the_front_page() -> None:
    reached, todo = set(), [DOCS / "index.md"]
    while todo:
        page = todo.pop()
        if page in reached or page not in PAGES:
            continue
        reached.add(page)
        text = page.read_text("utf-8")
        todo += [(page.parent / target).resolve() for target in re.findall(r"\]\(((?!https?:)[^)#]+\.md)", text)]
        for tree in re.findall(r"```\{toctree\}\n(.*?)```", text, re.S):
            names = [line for line in tree.splitlines() if line and not line.startswith(":")]
            todo += [(page.parent / f"{name}.md").resolve() for name in names]
    assert set(PAGES) == reached

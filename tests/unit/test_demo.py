"""``hdrive-mbs demo``: its page, and its diagnosis of the bundled record against the label that the package does not hold."""

from __future__ import annotations

import json
import re
import shutil
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest

import hdrive_mbs
from hdrive_mbs.cli import demo as command
from hdrive_mbs.errors import DependencyError, FileFormatError
from tests.browser import DESKTOP, PHONE, layout, needs_browser

ROOT = Path(__file__).parents[2]
LABEL = json.loads((ROOT / "benchmarks" / "flagship" / "bundled_label.json").read_text("utf-8"))


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder of one demo, with its JSON in document.json."""
    folder = tmp_path_factory.mktemp("demo")
    command.demo(out=folder, json=str(folder / "document.json"))
    return folder


@pytest.fixture(scope="module")
def document(made: Path) -> dict[str, Any]:
    found: dict[str, Any] = json.loads((made / "document.json").read_text("utf-8"))
    return found


@pytest.fixture(scope="module")
def answer(made: Path) -> dict[str, Any]:
    found: dict[str, Any] = json.loads((made / "diagnosis.json").read_text("utf-8"))
    return found


class Page(HTMLParser):
    """Headings, pictures and addresses of a page."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.headings: list[str] = []
        self.pictures: list[dict[str, str]] = []
        self.addresses: list[str] = []
        self._inside = ""
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = {name: value or "" for name, value in attrs}
        self.addresses += [given[name] for name in ("src", "href", "srcset", "data", "action") if name in given]
        if tag == "img":
            self.pictures.append(given)
        self._inside = tag

    def handle_endtag(self, tag: str) -> None:
        self._inside = ""

    def handle_data(self, data: str) -> None:
        if self._inside in ("h1", "h2"):
            self.headings.append(data)


@pytest.mark.slow
@needs_browser
@pytest.mark.parametrize("width", [PHONE, DESKTOP])
def test_page_fits_a_phone_and_a_desktop(made: Path, width: int, tmp_path: Path) -> None:
    found = layout((made / "demo.html").read_text("utf-8"), width, tmp_path)
    found.check()
    assert len(found.pictures) >= 10


@pytest.mark.slow
def test_page_has_every_section_and_fetches_nothing(made: Path, document: dict[str, Any]) -> None:
    text = (made / "demo.html").read_text("utf-8")
    page = Page(text)
    assert [re.split(r"[:,]", heading)[0] for heading in page.headings] == [
        "A robot joint as one line",
        "Run-up",
        "Campbell diagram",
        "Full against simplified bearings",
        "Diagnosis of a record",
    ]
    assert page.addresses
    assert all(address.startswith("data:image/") for address in page.addresses)
    assert not re.search(r"@import|url\(|<script|<link", text)
    assert document["page_bytes"] == (made / "demo.html").stat().st_size < 6e6


@pytest.mark.slow
def test_every_picture_says_in_words_what_it_shows_and_fits_a_phone(made: Path) -> None:
    pictures = Page((made / "demo.html").read_text("utf-8")).pictures
    assert len(pictures) >= 4 + 4  # run-up twice, Campbell, bearings; gap, a column, places, ranking
    for picture in pictures:
        assert len(picture["alt"]) > 40
        assert int(picture["width"]) <= 600  # two thirds of it is a phone's width
    assert len({picture["alt"] for picture in pictures}) == len(pictures)


@pytest.mark.slow
def test_all_run_ups_and_the_campbell_diagram_are_complete(document: dict[str, Any]) -> None:
    assert set(document["run_ups"]) == {"full", "simplified", "improved"}
    assert all(run["status"].startswith("complete") for run in document["run_ups"].values())
    assert document["campbell"].startswith("complete")
    full, improved = (document["run_ups"][name]["peak"] for name in ("full", "improved"))
    assert improved == pytest.approx(full, rel=2e-3)  # what condensed bearings are for
    assert set(document["sections"]) == set(document["cpu_sections"])


@pytest.mark.slow
def test_diagnosis_finds_effect_and_place_in_the_bundled_record(answer: dict[str, Any], document: dict[str, Any]) -> None:
    assert answer["verdict"] == document["diagnosis"] == LABEL["verdict"]
    assert [(cause["effect"], cause["at"]) for cause in answer["causes"]] == [(LABEL["effect"], LABEL["place"])]


@pytest.mark.slow
def test_the_cause_closes_the_gap_on_stretches_that_no_fit_saw(answer: dict[str, Any]) -> None:
    (gap,) = [gap for gap in answer["gaps"] if not gap["record"] and not gap["column"]]
    assert gap["refit"]["value"] > 1.2  # the effect shows most at the start, which the fits see
    # noise alone gives 1 +- 1/sqrt(2 n) = 1.02 for n = 3 columns of 375 held-out samples; law and line are not the plant's
    assert gap["effect"]["value"] < 1.1


def test_what_keeps_the_diagnosis_from_running_is_said(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    def missing(*arguments: object, **named: object) -> None:
        raise DependencyError("Compiled runs need llvmlite")

    monkeypatch.setattr("hdrive_mbs.diagnosis.diagnose.diagnose", missing)
    assert command._diagnosis(command.flagship(), tmp_path) == "The record was not diagnosed: Compiled runs need llvmlite"


def test_an_installed_package_brings_its_own_model(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    package = tmp_path / "site" / "hdrive_mbs"
    (package / "data").mkdir(parents=True)
    monkeypatch.setattr(hdrive_mbs, "__file__", str(package / "__init__.py"))
    with pytest.raises(FileFormatError, match="install the package again"):
        command.flagship()
    shutil.copy(ROOT / "models" / "robot_joint_line.py", package / "data")
    assert str(command.flagship().__file__).startswith(str(package))
    assert command.flagship().bundled_records().parent == package / "data"


def test_quick_library_has_one_law_of_each_family() -> None:
    from hdrive_mbs.diagnosis.candidates import known_effects

    chosen = command.one_law_each()
    library = [kind for kind in known_effects() if kind.__module__.startswith("hdrive_mbs.")]  # other tests define laws of their own
    assert sorted(kind.family for kind in chosen) == sorted({kind.family for kind in library})
    assert "CoulombStribeckFriction" in {kind.__name__ for kind in chosen}  # no states, as Dahl and LuGre have

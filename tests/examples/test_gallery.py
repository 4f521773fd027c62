"""Every script of the gallery makes its picture, with named axes, and the gallery shows every picture with words for it."""

from __future__ import annotations

import functools
import importlib.util
import io
import re
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from matplotlib.image import imread

ROOT = Path(__file__).parents[2]
GALLERY = ROOT / "docs" / "gallery"
PICTURE = re.compile(r"!\[([^\]]*)\]\(pictures/([a-z_]+)\.png\)")


@functools.cache
def make() -> ModuleType:
    spec = importlib.util.spec_from_file_location("gallery_make", GALLERY / "make.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


NAMES = sorted(path.stem for path in GALLERY.glob("*.py") if path.stem != "make")


def blank(picture: np.ndarray) -> bool:
    return bool(np.ptp(picture[..., :3]) < 0.5)


@pytest.mark.parametrize("name", NAMES)
def test_a_script_makes_a_picture_with_named_axes(name: str) -> None:
    figure = make().drawn(name).figure
    figure.savefig(buffer := io.BytesIO(), format="png", dpi=50)
    buffer.seek(0)
    assert not blank(imread(buffer))
    shown = [ax for ax in figure.axes if ax.axison]
    assert shown
    below = [ax for ax in shown if ax.get_xlabel()]
    assert below, "no horizontal axis has a name"
    for ax in shown:
        shares = ax.get_shared_x_axes().get_siblings(ax)
        assert any(one.get_xlabel() for one in shares) or not ax.xaxis.get_visible() or not ax.get_xticklabels(), ax
        assert ax.get_ylabel() or ax.get_yticklabels()


def test_the_gallery_shows_every_script_and_says_what_is_seen() -> None:
    page = (GALLERY / "index.md").read_text("utf-8")
    shown = {name: words for words, name in PICTURE.findall(page)}
    assert sorted(shown) == NAMES
    for name, words in shown.items():
        assert len(words) > 40, name
        assert f"({name}.py)" in page


@pytest.mark.parametrize("name", NAMES)
def test_the_committed_picture_is_small_and_not_blank(name: str) -> None:
    path = GALLERY / "pictures" / f"{name}.png"
    assert path.stat().st_size < 150_000
    assert not blank(imread(path))


def test_there_is_no_picture_without_a_script() -> None:
    assert sorted(path.stem for path in (GALLERY / "pictures").iterdir()) == NAMES

"""Every script of the gallery makes the committed picture, with named axes, and the gallery shows every picture with words for it."""

from __future__ import annotations

import functools
import importlib.util
import re
from pathlib import Path
from types import ModuleType

import matplotlib
import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.image import imread
from matplotlib.text import Text
from PIL import Image
from scipy.ndimage import maximum_filter, minimum_filter

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


REACH, SHADE, FORGIVEN = 4, 80, 100
"""Pixels, steps of 255 in a colour, and points.  Of pictures of the gallery (110 dots per inch, half a million points) these points
are unexplained: none after a shift by a pixel either way, at most 30 without antialiasing of words or of curves, at most 90 in another
typeface (serif); 109 and more without one of the curves, 1300 to 2000 where one is 10 % higher, 80 to 1300 with an axis 2 % longer."""


SET_ALIKE = (3, 11, 2)
"""Matplotlib from which on words stand where they stand in the committed pictures.  All else equal, nine of the pictures differ with
3.9.0, and three with 3.11.0, which are a pixel lower."""


def unexplained(one: Image.Image, other: Image.Image) -> int:
    """Points of either picture whose colour the other has nowhere within REACH, to SHADE."""
    pictures = [np.asarray(picture.convert("RGB")) for picture in (one, other)]
    assert pictures[0].shape == pictures[1].shape
    around = (2 * REACH + 1, 2 * REACH + 1, 1)
    count = 0
    for here, there in (pictures, pictures[::-1]):
        low, high = (extreme(there, size=around, mode="nearest").astype(float) for extreme in (minimum_filter, maximum_filter))
        colours = here.astype(float)
        count += int(np.any((colours < low - SHADE) | (colours > high + SHADE), axis=2).sum())
    return count


def blank(picture: np.ndarray) -> bool:
    return bool(np.ptp(picture[..., :3]) < 0.5)


def of_tutorial(name: str) -> str:
    """The tutorial whose run a script draws; empty where it makes its own."""
    found = re.search(r'\bran\("([a-z_]+)"\)', (GALLERY / f"{name}.py").read_text("utf-8"))
    return found.group(1) if found else ""


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name in NAMES if not of_tutorial(name)])
def test_a_script_makes_the_committed_picture_with_named_axes(name: str) -> None:
    """Those of tutorials: test_tutorials.py."""
    check_picture(name, make().drawn(name).figure)


def check_picture(name: str, figure: Figure) -> None:
    shown = [ax for ax in figure.axes if ax.axison]
    assert shown
    below = [ax for ax in shown if ax.get_xlabel()]
    assert below, "no horizontal axis has a name"
    for ax in shown:
        shares = ax.get_shared_x_axes().get_siblings(ax)
        assert any(one.get_xlabel() for one in shares) or not ax.xaxis.get_visible() or not ax.get_xticklabels(), ax
        assert ax.get_ylabel() or ax.get_yticklabels()
    if matplotlib.__version_info__[:3] < SET_ALIKE:
        pytest.skip("the committed pictures are compared from matplotlib {}.{}.{} on: earlier ones set words otherwise".format(*SET_ALIKE))
    with Image.open(GALLERY / "pictures" / f"{name}.png") as committed:
        off = unexplained(make().picture(figure.axes[0]), committed)
    assert off < FORGIVEN, f"{off} points differ: look at what 'python docs/gallery/make.py {name}' makes, and commit it"


def test_the_comparison_of_pictures_forgives_another_typeface_and_no_other_curve() -> None:
    x = np.linspace(0.0, 10.0, 400)

    def drawn(height: float = 1.0, second: bool = True, typeface: str = "DejaVu Sans", smooth: bool = True) -> Image.Image:
        figure = Figure(figsize=(7.2, 4.2), layout="constrained")
        ax = figure.subplots()
        ax.plot(x, height * np.sin(x), label="first", antialiased=smooth)
        ax.plot(x, np.cos(x), label="second", antialiased=smooth, visible=second)
        ax.set(xlabel="time [s]", ylabel="torque [N m]", ylim=(-1.5, 1.5))
        ax.legend()
        for words in figure.findobj(Text):
            words.set_fontfamily(typeface)
        return make().picture(ax)

    committed = drawn()
    assert unexplained(drawn(typeface="DejaVu Serif"), committed) < FORGIVEN
    assert unexplained(drawn(smooth=False), committed) < FORGIVEN
    assert unexplained(drawn(height=1.1), committed) > 2 * FORGIVEN
    assert unexplained(drawn(second=False), committed) > 2 * FORGIVEN


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

"""A gap that comes and goes is told from noise of another size, another colour, and of a coarse encoder."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from benchmarks.withheld import evenness
from hdrive_mbs.diagnosis.simulator import Segment
from hdrive_mbs.diagnosis.unevenness import EVEN, SAMPLES, STRETCHES, patch_words, patches, unevenness
from hdrive_mbs.diagnosis.verdict import CLEAN, NONE, UNKNOWN, judge

RATE, NUMBER = 1000.0, 40 * SAMPLES


def case(left: np.ndarray, used: np.ndarray | None = None) -> tuple[Any, Any]:
    """A simulator of one trial with one column, and a fit that leaves this of it."""
    trial = SimpleNamespace(name="sweep", times=np.arange(len(left)) / RATE)
    segment = Segment(0, "load_angle", slice(0, len(left)))
    used = np.ones(len(left), bool) if used is None else used
    return SimpleNamespace(trials=(trial,), segments=(segment,), used=used, every=1), SimpleNamespace(residuals=left)


def noise(seed: int = 3) -> np.ndarray:
    return np.random.default_rng(seed).standard_normal(NUMBER)


def bump(start: int, stop: int, size: float) -> np.ndarray:
    """A swing of twelve samples a period from one sample to another, 0-peak."""
    at = np.arange(NUMBER)
    return np.where((at >= start) & (at < stop), size * np.sin(2.0 * np.pi * at / 12.0), 0.0)


@pytest.mark.parametrize("seed", range(5))
def test_noise_has_none_whatever_its_size(seed: int) -> None:
    for scale in (0.5, 1.0, 3.0):
        assert patches(*case(scale * noise(seed))) == ()


def test_noise_that_grows_for_a_while_has_none() -> None:
    grown = noise()
    grown[10 * SAMPLES : 14 * SAMPLES] *= 2.0
    assert patches(*case(grown)) == ()


def test_neighbours_that_hang_together_at_the_same_size_have_none() -> None:
    """As in the steps of an encoder that hardly turns: each value twice in one part of the record."""
    stepped = noise()
    part = slice(10 * SAMPLES, 14 * SAMPLES)
    stepped[part] = np.repeat(stepped[part][::2], 2)
    assert patches(*case(stepped)) == ()


def test_what_lasts_has_none() -> None:
    assert patches(*case(noise() + bump(0, NUMBER, 1.0))) == ()


def test_what_acts_for_a_while_is_found_where_it_acts_and_as_large_as_it_is() -> None:
    swing = bump(12 * SAMPLES, 15 * SAMPLES, 1.5)
    simulator, fitted = case(noise() + swing)
    [patch] = patches(simulator, fitted)
    assert (patch.record, patch.column) == ("sweep", "load_angle")
    assert patch.start == pytest.approx(12 * SAMPLES / RATE)
    assert patch.end == pytest.approx((15 * SAMPLES - 1) / RATE)
    assert patch.samples == 3 * SAMPLES
    # of neighbours that are a twelfth of a period apart the product is cos(30 deg) of the square
    assert patch.excess == pytest.approx(np.cos(np.pi / 6.0) * np.sum(swing**2), rel=0.1)
    assert unevenness(simulator, [patch]) == pytest.approx(patch.excess / NUMBER)
    [told] = patch_words(simulator, [patch], "the refitted nominal model")
    assert "load_angle of 'sweep', 12.3 s to 15.4 s" in told
    assert f"{unevenness(simulator, [patch]):.2g} of its mean square" in told


def test_samples_that_do_not_count_do_not_hide_it_nor_make_one() -> None:
    used = np.ones(NUMBER, bool)
    used[::3] = False
    used[30 * SAMPLES :] = False
    left = noise() + bump(12 * SAMPLES, 15 * SAMPLES, 3.0)
    left[~used] = np.nan
    [patch] = patches(*case(left, used))
    assert 12 * SAMPLES / RATE <= patch.start < patch.end <= 15 * SAMPLES / RATE
    assert patch.samples < 3 * SAMPLES


def test_short_columns_are_not_looked_at() -> None:
    left = noise()[: 60 * STRETCHES] + bump(300, 500, 5.0)[: 60 * STRETCHES]
    assert patches(*case(left)) == ()


def test_of_many_stretches_no_note_tells_nor_of_next_to_nothing() -> None:
    simulator, fitted = case(noise() + bump(12 * SAMPLES, 15 * SAMPLES, 1.5))
    [patch] = patches(simulator, fitted)
    assert patch_words(simulator, [replace(patch, samples=NUMBER // 3)], "it") == ()
    assert patch_words(simulator, [replace(patch, excess=0.9 * EVEN * NUMBER)], "it") == ()
    short = replace(patch, samples=SAMPLES)
    assert " more. " not in patch_words(simulator, [short] * 3, "it")[0]
    assert ", and 2 more. " in patch_words(simulator, [short] * 5, "it")[0]


def test_a_gap_that_comes_and_goes_is_no_noise_however_small() -> None:
    small = 1.0 + 0.5 * (CLEAN - 1.0)
    kept, lost = judge(small, [], uneven=0.9 * EVEN), judge(small, [], uneven=1.1 * EVEN)
    assert (kept.kind, lost.kind) == ("none", "unknown")
    assert max(kept.probabilities, key=kept.probabilities.__getitem__) == NONE
    assert max(lost.probabilities, key=lost.probabilities.__getitem__) == UNKNOWN
    assert judge(1.1 * CLEAN, []).kind == "unknown"


def test_the_command_tells_each_case_of_a_folder_or_those_that_are_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
    monkeypatch.setattr(evenness, "row", lambda bench, folder: (folder.name, bench, "1.0000", "0.00000", ""))
    out = tmp_path / "told.md"
    assert evenness.main(["--bench", "drive", str(tmp_path), "--out", str(out)]) == 0
    text = out.read_text("utf-8")
    assert f"up to {EVEN} is called noise" in text
    assert [line.split("|")[1].strip() for line in text.splitlines() if line.startswith("| ")] == ["case", "a", "b"]
    assert evenness.main(["--bench", "rotor", str(tmp_path), "b", "--out", str(out)]) == 0
    assert "| a " not in out.read_text("utf-8")

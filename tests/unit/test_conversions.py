"""Numbers, lists and arrays of other units."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import hdrive_mbs as hm

SI = [(hm.rpm, 30.0, math.pi), (hm.mm, 1000.0, 1.0), (hm.degrees, 180.0, math.pi), (hm.arcmin, 10800.0, math.pi)]


@pytest.mark.parametrize(("convert", "given", "wanted"), SI)
def test_numbers_stay_numbers_and_many_become_an_array(convert: Callable[[Any], Any], given: float, wanted: float) -> None:
    alone = convert(given)
    assert isinstance(alone, float)
    assert alone == pytest.approx(wanted, rel=1e-15)
    for many in ([0.0, given], (0.0, given), np.array([0.0, given])):
        found = convert(many)
        assert isinstance(found, np.ndarray)
        np.testing.assert_allclose(found, [0.0, wanted], rtol=1e-15)
    assert convert(int(given)) == alone


@pytest.mark.parametrize("convert", [convert for convert, _, _ in SI])
def test_text_is_no_number(convert: Callable[[Any], Any]) -> None:
    with pytest.raises(TypeError):
        convert("3")

"""Values that are allowed and look as if they were in another unit: taken, and warned of where they were written."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from pathlib import Path

import pytest

import hdrive_mbs as hm

STEEL = {"youngs_modulus": 2.1e11, "shear_modulus": 8.1e10, "density": 7850.0}


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (
            lambda: hm.ShaftMaterial(**(STEEL | {"youngs_modulus": 210000.0})),
            "youngs_modulus = 210000 Pa is unusual .* steel has 2.1e11",
        ),
        (lambda: hm.ShaftMaterial(**(STEEL | {"shear_modulus": 81.0})), "shear_modulus = 81 Pa is unusual"),
        (lambda: hm.ShaftMaterial(**(STEEL | {"density": 7.85})), "density = 7.85 kg/m.3 is unusual"),
        (lambda: hm.ShaftSection(length=0.3, diameter=45.0, **STEEL), "diameter = 45 m is unusual .* hm.mm.45."),
        (lambda: hm.ShaftSection(length=300.0, diameter=0.045, **STEEL), "length = 300 m is unusual .* hm.mm.600."),
        (lambda: hm.Rotor.disc(diameter=200.0, thickness=0.02, density=7850.0), "Rotor.disc diameter = 200 m is unusual"),
        (lambda: hm.Rotor.disc(diameter=0.2, thickness=0.02, density=7.85), "Rotor.disc density = 7.85 kg/m.3 is unusual"),
    ],
)
def test_a_value_in_another_unit_is_warned_of_where_it_is_written(make: Callable[[], object], message: str) -> None:
    with pytest.warns(hm.UnusualValueWarning, match=message) as told:
        made = make()
    assert made is not None
    assert Path(told[0].filename).name == Path(__file__).name


def test_usual_values_massless_shafts_and_stiff_ones_are_not_warned_of() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        hm.ShaftSection(length=0.3, diameter=0.045, **STEEL)
        hm.ShaftSection(length=0.3, diameter=0.045, **(STEEL | {"density": 0.0}))
        hm.ShaftSection(length=1e-3, diameter=2e-4, **(STEEL | {"youngs_modulus": 1e16, "shear_modulus": 1e16}))
        hm.Rotor.disc(diameter=0.2, thickness=0.02, density=7850.0)

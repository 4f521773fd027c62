"""Values of a law from one place as the start at another, on both sides of a gear."""

from __future__ import annotations

import pytest

import hdrive_mbs as hm
from hdrive_mbs.diagnosis.carried import carried, turns
from models import drive_bench, rotor_bench

NETWORK = drive_bench.bench().scene.network()


@pytest.mark.parametrize(
    ("at", "speed"),
    [
        ("motor", 1.0),
        ("input_shaft", 1.0),
        ("wave_generator", 1.0),
        ("gear", 1.0 / drive_bench.RATIO),  # a torsion spring of its flexspline
        ("gear.flexspline", 1.0 / drive_bench.RATIO),
        ("output_shaft", 1.0 / drive_bench.RATIO),
        ("load", 1.0 / drive_bench.RATIO),
        ("load_encoder", None),
    ],
)
def test_a_place_turns_as_what_it_belongs_to(at: str, speed: float | None) -> None:
    assert turns(NETWORK, at) == (None if speed is None else pytest.approx(speed))


def test_across_a_gear_only_times_go_along() -> None:
    found = hm.Creep(compliance=2.3e-3, relaxation_time=9e-3)
    own = hm.Creep(compliance=1e-7, relaxation_time=0.05)
    assert carried(found, own, NETWORK, "input_shaft", "output_shaft") == hm.Creep(compliance=1e-7, relaxation_time=9e-3)
    assert carried(found, own, NETWORK, "gear", "output_shaft") == found  # both behind the gear


def test_sizes_and_speeds_begin_as_at_the_place_itself_behind_a_gear() -> None:
    found = hm.CoulombStribeckFriction(coulomb=0.02, stribeck_speed=10.0)
    own = hm.CoulombStribeckFriction(coulomb=0.5, stribeck_speed=0.1)
    assert carried(found, own, NETWORK, "motor", "wave_generator") == found
    assert carried(found, own, NETWORK, "motor", "load") == own


def test_stations_of_a_rotor_line_take_all() -> None:
    network = rotor_bench.bench().scene.network()
    found, own = hm.QuadraticDrag(coefficient=3e-7), hm.QuadraticDrag(coefficient=1e-9)
    assert carried(found, own, network, "rotor_1", "rotor_2") == found

"""Rotor lines built from absolute positions: sections, names, steps, and what is refused."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest

import hdrive_mbs as hm
from models.two_rotor_line import POSITIONS, build
from tests.unit.rotor_pieces import DISC, STEEL, E, G, bearing, eigenvalues, frequencies, steady

MATERIAL = hm.ShaftMaterial(youngs_modulus=E, shear_modulus=G)
HEAVY = MATERIAL.replacing(density=STEEL)
RING = bearing(1e6, mass=0.3)


def made(**changes: Any) -> hm.Scene:
    """Bearings at 0 and 0.6 m, a disc at 0.25 m."""
    stations: dict[str, Any] = {"b": (0.6, RING), "a": (0.0, RING), "d": (0.25, DISC)}
    return hm.rotor_line("line", **({"stations": stations, "shaft": 0.03, "material": MATERIAL} | changes))


# -- what comes out ---------------------------------------------------------------------------------------


def test_sections_run_from_station_to_station_whatever_the_order_they_are_given_in() -> None:
    scene = made()
    assert scene.connections == (("a", "section_1", "d", "section_2", "b"),)
    sections = {name: part for name, part in scene.parts.items() if isinstance(part, hm.ShaftSection)}
    assert {name: part.length for name, part in sections.items()} == pytest.approx({"section_1": 0.25, "section_2": 0.35})
    assert all(part.diameter == 0.03 and part.elements == 1.0 for part in sections.values())
    positions = scene.network().positions
    assert [positions[name] for name in "adb"] == pytest.approx([0.0, 0.25, 0.6])


def test_the_line_of_the_paper_comes_out_as_it_is_written_by_hand() -> None:
    by_hand = build()
    stations = {name: (z, by_hand.parts[name]) for name, z in POSITIONS.items()}
    scene = hm.rotor_line(
        "two rotor line",
        stations=stations,
        shaft=0.022,
        material=MATERIAL.replacing(damping=1e-5),
        attached={"drive": ("drive_disc", by_hand.parts["drive"])},
    )
    assert dict(scene.parts) == dict(by_hand.parts)
    at_speed = [eigenvalues(steady(line, 400.0)) for line in (scene, by_hand)]
    np.testing.assert_allclose(np.sort_complex(at_speed[0]), np.sort_complex(at_speed[1]), rtol=1e-9, atol=1e-6)


def test_a_shaft_may_begin_anywhere_and_positions_count_from_its_beginning() -> None:
    moved = made(stations={"a": (-1.0, RING), "d": (-0.75, DISC), "b": (-0.4, RING)})
    assert [moved.network().positions[name] for name in "adb"] == pytest.approx([0.0, 0.25, 0.6])


def test_elements_are_no_longer_than_asked_for() -> None:
    scene = made(material=HEAVY, largest_element=0.1)
    assert [scene.parts[f"section_{k}"].elements for k in (1, 2)] == [3.0, 4.0]  # type: ignore[attr-defined]
    # exactly divisible stays so in spite of rounding; a massless shaft is exact with one
    exact = made(material=HEAVY, largest_element=0.05)
    assert [exact.parts[f"section_{k}"].elements for k in (1, 2)] == [5.0, 7.0]  # type: ignore[attr-defined]
    with pytest.raises(hm.ParameterError, match=r"largest_element = 0\.01 m: a massless shaft.*density"):
        made(largest_element=0.01)


def test_a_stepped_shaft_is_cut_at_its_steps() -> None:
    steps = [(-0.1, 0.25, 0.03), (0.25, 0.4, 0.05, 0.02), (0.4, 0.7, 0.02)]
    scene = made(material=HEAVY, shaft=steps)
    assert scene.connections == (("section_1", "a", "section_2", "d", "section_3", "section_4", "b", "section_5"),)
    found = [(p.length, p.diameter, p.bore) for p in (scene.parts[f"section_{k}"] for k in range(1, 6)) if isinstance(p, hm.ShaftSection)]
    wanted = [(0.1, 0.03, 0.0), (0.25, 0.03, 0.0), (0.15, 0.05, 0.02), (0.2, 0.02, 0.0), (0.1, 0.02, 0.0)]
    np.testing.assert_allclose(found, wanted)
    positions = scene.network().positions
    assert [positions[name] for name in "adb"] == pytest.approx([0.1, 0.35, 0.7])
    assert positions["section_5.b"] == pytest.approx(0.8)
    # all the mass is there: of the steps, the disc and two rings
    system = steady(scene)
    x = np.array([float(name.endswith(".x")) for name in system.names])
    volumes = [length * (d**2 - bore**2) * math.pi / 4.0 for length, d, bore in wanted]
    assert x @ system.mass @ x == pytest.approx(8.6 + STEEL * sum(volumes), rel=1e-12)


def test_steps_of_one_diameter_change_nothing() -> None:
    whole = steady(made(material=HEAVY, largest_element=0.05))
    cut = steady(made(material=HEAVY, largest_element=0.05, shaft=[(0.0, 0.45, 0.03), (0.45, 0.6, 0.03)]))
    lateral = [[name for name in system.names if name.endswith((".x", ".theta"))] for system in (whole, cut)]
    assert len(lateral[0]) == len(lateral[1])
    np.testing.assert_allclose(frequencies(cut, lateral[1]), frequencies(whole, lateral[0]), rtol=1e-9)


def test_a_rigid_piece_makes_one_body_of_its_neighbours() -> None:
    scene = made(rigid=[("b", "d")])
    assert scene.parts["section_2"] == hm.RigidSection(length=0.35)
    assert scene.network().places["b"] == "d"
    assert scene.network().rotors[0].body.mass == pytest.approx(8.3)


def test_attached_parts_sit_at_a_station_and_others_join_by_connections() -> None:
    extra: Mapping[str, hm.Component] = {
        "gravity": hm.Gravity(),
        "motor": hm.Motor(inertia=0.01, characteristic=lambda w: 1.0 - w),
        "coupling": hm.Shaft(stiffness=1e3),
    }
    scene = made(attached={"second": ("d", DISC)}, parts=extra, connections=[("motor", "coupling", "a")], notes="with a motor")
    network = scene.network()
    assert scene.notes == "with a motor"
    assert network.places["second"] == network.places["d"]
    assert network.rotors[0].body.mass == pytest.approx(16.0)
    assert network.gravity[1] < 0.0
    assert "motor" in {body.name for body in network.bodies}


def test_a_single_disc_on_a_bare_shaft_is_a_line_too() -> None:
    scene = hm.rotor_line("one", stations={"d": (0.2, DISC)}, shaft=[(0.0, 0.5, 0.03)], material=HEAVY, attached={"held": ("d", RING)})
    assert scene.connections[0] == ("section_1", "d", "section_2")
    assert len(scene.network().bodies) == 18


def test_stations_too_close_for_an_elastic_section_may_have_a_rigid_one() -> None:
    stations = {"a": (0.0, RING), "d": (0.24999, DISC), "e": (0.25, DISC), "b": (0.6, RING)}
    scene = made(stations=stations, rigid=[("d", "e")])
    assert isinstance(scene.parts["section_2"], hm.RigidSection)
    doubled = DISC.replacing(mass=2.0 * DISC.mass, polar_inertia=2.0 * DISC.polar_inertia, transverse_inertia=2.0 * DISC.transverse_inertia)
    one_body = made(stations={"a": (0.0, RING), "d": (0.25, doubled), "b": (0.6, RING)})
    split, joined = (hm.whirl_modes(line, 200.0, count=4).frequencies for line in (scene, one_body))
    # the discs are 10 um from where the doubled one is, of 0.25 m
    np.testing.assert_allclose(split, joined, rtol=1e-3)


# -- what is refused -----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("kind", "message", "changes"),
    [
        (
            hm.SceneError,
            r"Station 'b' at z = 0\.6 m lies outside the shaft, which runs from 0 m to 0\.5 m\. Move it, or let the shaft reach that far",
            {"shaft": [(0.0, 0.5, 0.03)]},
        ),
        (hm.SceneError, r"Station 'a' at z = 0 m lies outside the shaft, which runs from 0\.1 m", {"shaft": [(0.1, 0.6, 0.03)]}),
        (
            hm.SceneError,
            r"Stations 'd' and 'e' are both at z = 0\.25 m, so the section between them has no length.*attached=\{'e': \('d', part\)\}",
            {"stations": {"a": (0.0, RING), "d": (0.25, DISC), "e": (0.25, DISC)}},
        ),
        (hm.SceneError, r"are both at z = 0\.25 m", {"stations": {"a": (0.0, RING), "d": (0.25, DISC), "e": (0.25 + 1e-12, DISC)}}),
        (
            hm.SceneError,
            r"The section from 'd' to 'e' is 1e-05 m long, less than 0\.0005 of the shaft of 0\.25 m.*rigid=\[\('d', 'e'\)\], or attach",
            {"stations": {"a": (0.0, RING), "d": (0.24999, DISC), "e": (0.25, DISC)}},
        ),
        (
            hm.SceneError,
            r"The section from a step at z = 0\.24999 m to 'd' is 1e-05 m long.*Move the step to the station",
            {"material": HEAVY, "shaft": [(0.0, 0.24999, 0.03), (0.24999, 0.6, 0.02)]},
        ),
        (hm.ParameterError, r"z of station 'a' = nan m: must be a finite number", {"stations": {"a": (math.nan, RING), "d": (0.2, DISC)}}),
        (hm.ParameterError, r"z of station 'a' = inf m: must be a finite number", {"stations": {"a": (math.inf, RING), "d": (0.2, DISC)}}),
        (hm.ParameterError, r"z of station 'a' = '0 m': must be a number, in m", {"stations": {"a": ("0 m", RING), "d": (0.2, DISC)}}),
        (hm.ParameterError, r"stations\['a'\] = .*: must be \(z, part\)", {"stations": {"a": RING, "d": (0.2, DISC)}}),
        (hm.ParameterError, r"stations\['a'\] = .*: must be \(z, part\)", {"stations": {"a": (0.0, MATERIAL), "d": (0.2, DISC)}}),
        (hm.SceneError, r"rotor_line has no stations", {"stations": {}}),
        (hm.SceneError, r"but there is only one; give steps", {"stations": {"d": (0.2, DISC)}}),
        (hm.ParameterError, r"shaft \(its diameter\) = 0 m: must be greater than 0\.0 m", {"shaft": 0.0}),
        (hm.ParameterError, r"shaft \(its diameter\) = '30 mm': must be a number", {"shaft": "30 mm"}),
        (hm.SceneError, r"The shaft has no steps", {"shaft": []}),
        (hm.ParameterError, r"step 1 of the shaft = \(0\.3, 0\.6\): must be \(z_from, z_to, diameter\)", {"shaft": [(0.3, 0.6)]}),
        (hm.SceneError, r"Step 1 of the shaft runs backwards: from z = 0\.6 m to 0 m", {"shaft": [(0.6, 0.0, 0.03)]}),
        (hm.SceneError, r"Step 2 of the shaft has no length: from z = 0\.3 m to 0\.3 m", {"shaft": [(0.0, 0.3, 0.03), (0.3, 0.3, 0.02)]}),
        (
            hm.SceneError,
            r"There is a gap between step 1 of the shaft, which ends at z = 0\.3 m, and step 2, which begins at 0\.4 m",
            {"shaft": [(0.0, 0.3, 0.03), (0.4, 0.6, 0.02)]},
        ),
        (hm.SceneError, r"There is an overlap between step 1", {"shaft": [(0.0, 0.3, 0.03), (0.2, 0.6, 0.02)]}),
        (hm.ParameterError, r"step 1 of the shaft, diameter = -0\.03 m: must be greater than 0\.0 m", {"shaft": [(0.0, 0.6, -0.03)]}),
        (hm.ParameterError, r"step 1 of the shaft: bore = 0\.03 m must be less than the diameter", {"shaft": [(0.0, 0.6, 0.03, 0.03)]}),
        (hm.ParameterError, r"step 1 of the shaft, z_to = nan m", {"shaft": [(0.0, math.nan, 0.03)]}),
        (
            hm.SceneError,
            r"The massless shaft has a step or an end at z = 0\.4 m where no station is, so nothing there has mass",
            {"shaft": [(0.0, 0.4, 0.03), (0.4, 0.6, 0.02)]},
        ),
        (hm.SceneError, r"The massless shaft has a step or an end at z = 0\.7 m", {"shaft": [(0.0, 0.7, 0.03)]}),
        (hm.ParameterError, r"largest_element = 0 m: must be greater than 0\.0 m", {"material": HEAVY, "largest_element": 0.0}),
        (hm.SceneError, r"rigid: 'a' and 'b' are not neighbours\. From the lowest z: a, d, b", {"rigid": [("a", "b")]}),
        (hm.PlaceError, r"No station 'c'\. This line has: a, d, b", {"rigid": [("a", "c")]}),
        (hm.SceneError, r"must be pairs of stations", {"rigid": ["ab", ("a", "d")]}),
        (
            hm.SceneError,
            r"rigid: the shaft has a step between 'd' and 'b'",
            {"material": HEAVY, "rigid": [("d", "b")], "shaft": [(0.0, 0.4, 0.03), (0.4, 0.6, 0.02)]},
        ),
        (hm.PlaceError, r"No station 'c'\. This line has", {"attached": {"e": ("c", DISC)}}),
        (hm.ParameterError, r"attached\['e'\] = .*: must be \(station, part\)", {"attached": {"e": DISC}}),
        (hm.SceneError, r"The name 'd' is given twice", {"parts": {"d": DISC}}),
        (hm.SceneError, r"The station name 'section_1' is taken", {"stations": {"section_1": (0.0, RING), "d": (0.2, DISC)}}),
        (hm.ParameterError, r"ShaftMaterial\.youngs_modulus = -1 Pa", {"material": lambda: MATERIAL.replacing(youngs_modulus=-1.0)}),
    ],
)  # fmt: skip
def test_what_does_not_fit_is_refused_with_the_place_and_the_way_out(kind: type[Exception], message: str, changes: dict[str, Any]) -> None:
    with pytest.raises(kind, match=message):
        made(**{key: value() if callable(value) else value for key, value in changes.items()})


def test_a_bearing_without_ring_mass_needs_a_shaft_with_mass() -> None:
    bare = bearing(1e6)
    stations = {"a": (0.0, bare), "d": (0.25, DISC), "b": (0.6, bare)}
    with pytest.raises(hm.SceneError, match=r"'a\.x' has no inertia \(0 kg\).*give the shaft a density"):
        made(stations=stations).network()
    assert made(stations=stations, material=HEAVY).network().bodies

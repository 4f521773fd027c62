"""Probes that look at a shaft from any side, against what sensors along x and y read."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.errors import ParameterError, PlaceError, SceneError
from hdrive_mbs.network.probed import Probed
from models import rotor_bench, two_rotor_line
from tests.unit.rotor_scenes import holding, jeffcott
from tests.unit.test_locate_rotors import SPEED, TIMES, localiser, trial

STEP = hm.RungeKutta4(step=1e-4)
RIGHT, LEFT = math.pi / 4.0, 3.0 * math.pi / 4.0


def watched(**parts: hm.Component) -> hm.Scene:
    return jeffcott(holding(200.0, 1.0), parts=parts)


def run(scene: hm.Scene) -> hm.Response:
    return hm.simulate(scene, 0.1, solver=STEP, initial_speed=200.0)


def pair() -> dict[str, hm.Component]:
    return {"right": hm.Probe(at="disc", angle=RIGHT), "left": hm.Probe(at="disc", angle=LEFT)}


def test_a_pair_at_45_degrees_reads_x_and_y_turned() -> None:
    response = run(watched(**pair()))
    x, y = response["disc.x"].values, response["disc.y"].values
    largest = float(np.max(np.hypot(x, y)))
    assert np.ptp(x) > 0.1 * largest < np.inf
    root = math.sqrt(0.5)
    # a sum of two numbers, each rounded once or twice
    np.testing.assert_allclose(response["right"].values, root * (x + y), rtol=0.0, atol=1e-15 * largest)
    np.testing.assert_allclose(response["left"].values, root * (y - x), rtol=0.0, atol=1e-15 * largest)
    speed = root * (response["disc.x_rate"].values + response["disc.y_rate"].values)
    np.testing.assert_allclose(response["right.displacement_rate"].values, speed, rtol=0.0, atol=1e-15 * float(np.max(np.abs(speed))))
    assert response["right"].unit == response["right.displacement"].unit == "m"


def test_gain_offset_steps_and_unit_are_those_of_a_sensor() -> None:
    gap = {"gain": -7.87e3, "offset": -10.0, "resolution": 1e-3, "unit": "V"}
    response = run(watched(along=hm.Probe(at="disc", angle=0.0, **gap), plain=hm.Sensor(quantity="disc.x", **gap)))
    np.testing.assert_array_equal(response["along"].values, response["plain"].values)
    assert response["along"].unit == "V"
    assert len(np.unique(response["along"].values)) > 3


@pytest.mark.parametrize(("angle", "direction"), [(0.0, "x"), (0.5 * math.pi, "y")])
@pytest.mark.parametrize(
    "effect", [hm.ProbeRunout(once=2e-6, once_phase=0.3, twice=1e-6, thrice=5e-7), hm.ProbeGain(error=0.1, curvature=50.0)]
)
def test_along_x_and_y_effects_are_those_of_a_sensor(effect: hm.Effect, angle: float, direction: str) -> None:
    read = []
    for probe in (hm.Probe(at="disc", angle=angle), hm.Sensor(quantity=f"disc.{direction}")):
        response = run(watched(probe=probe).with_effect(effect, at="disc" if isinstance(effect, hm.ProbeRunout) else "probe"))
        read.append(response["probe"].values)
    np.testing.assert_allclose(read[0], read[1], rtol=0.0, atol=1e-15 * float(np.max(np.abs(read[1]))))


def test_a_spot_of_the_surface_passes_a_probe_when_the_shaft_has_turned_to_it() -> None:
    # a round surface off the axis by e at angle p moves like its centre: e cos(f + p - a) along a
    scene = watched(**pair()).with_effect(hm.ProbeRunout(once=3e-6, once_phase=0.7), at="disc")
    response = run(scene)
    f = response["disc.angle"].values
    assert f[-1] > 6.0 * math.pi
    for name, angle in (("right", RIGHT), ("left", LEFT)):
        surface = response[name].values - response[f"{name}.true"].values
        np.testing.assert_allclose(surface, 3e-6 * np.cos(f + 0.7 - angle), rtol=0.0, atol=1e-15)


def test_cross_talk_of_a_turned_probe_is_a_small_turn() -> None:
    turn = 0.02
    moved = run(watched(probe=hm.Probe(at="disc", angle=LEFT + turn)))["probe"].values
    scene = watched(probe=hm.Probe(at="disc", angle=LEFT)).with_effect(hm.ProbeCrossTalk(share=math.sin(turn)), at="probe")
    talked = run(scene)["probe"].values
    # of second order: 1 - cos of the turn
    assert np.max(np.abs(talked - moved)) < 0.5 * turn**2 * 1.001 * np.max(np.abs(moved))
    assert np.max(np.abs(talked - run(watched(probe=hm.Probe(at="disc", angle=LEFT)))["probe"].values)) > 0.5 * turn * np.max(np.abs(moved))


def test_effects_find_probes_and_their_surfaces() -> None:
    network = watched(**pair(), encoder=hm.Sensor(quantity="disc.angle"), copy=hm.Sensor(quantity="right", gain=2.0)).network()
    assert hm.ProbeGain.places(network) == ("right", "left", "copy")
    assert hm.ProbeRunout.places(network) == ("disc",)
    assert hm.SensorGain.places(network) == ("right", "left", "encoder", "copy")
    assert network.probed("copy") == network.probed("right") == Probed("disc", RIGHT)
    assert network.probed("encoder") is network.probed("disc.angle") is None


def test_a_probe_where_nothing_moves_across_is_refused() -> None:
    with pytest.raises(
        PlaceError, match=r"'eye' reads 'disk\.x', which this scene does not have\. 'disk' has to be a place of a rotor line"
    ):
        watched(eye=hm.Probe(at="disk", angle=0.0)).network()
    with pytest.raises(ParameterError, match=r"Probe\.gain = 0 reads nothing of 'disc'; give the reading per quantity"):
        hm.Probe(at="disc", angle=0.0, gain=0.0)
    with pytest.raises(ParameterError, match=r"Probe lacks what has no default: .*angle"):
        hm.Probe(at="disc")
    with pytest.raises(ParameterError, match=r"Probe\.angle = 45 rad: must .* 6\.28"):
        hm.Probe(at="disc", angle=45)


def test_a_scene_with_probes_is_saved_and_read(tmp_path: object) -> None:
    scene = watched(**pair())
    path = f"{tmp_path}/line.toml"
    hm.save_scene(scene, path)
    again = hm.load_scene(path)
    assert again.parts["left"] == scene.parts["left"]


def test_a_surface_that_is_not_round_is_placed_at_turned_probes() -> None:
    plain = trial()
    turned = {"probe_r1_x": hm.Probe(at="rotor_1", angle=RIGHT), "probe_r1_y": hm.Probe(at="rotor_1", angle=LEFT)}
    scene = hm.Scene(
        name=plain.scene.name,
        parts={**plain.scene.parts, **turned},
        connections=plain.scene.connections,
        effects=plain.scene.effects,
    )
    errors = {"r1_x": 2e-6 * np.cos(3.0 * SPEED * TIMES), "r1_y": 2e-6 * np.sin(3.0 * SPEED * TIMES)}
    best = localiser(errors=errors, bare=dataclasses.replace(plain, scene=scene)).places()[0]
    assert best.at == "rotor_1.sensors"
    assert best.probability > 0.9
    assert rotor_bench.PROBES[:2] == ("r1_x", "r1_y")


def test_a_probe_cannot_read_itself() -> None:
    with pytest.raises((SceneError, PlaceError)):
        watched(eye=hm.Probe(at="eye", angle=0.0)).network()


@pytest.mark.parametrize("bearing", ["full", "improved"])
def test_a_probe_on_the_housing_reads_the_ring_less_the_housing(bearing: str) -> None:
    line = two_rotor_line.build(bearing)
    scene = hm.Scene(
        name="watched",
        parts={**line.parts, "eye": hm.Probe(at="bearing_a", angle=LEFT, relative=True), "plain": hm.Probe(at="bearing_a", angle=LEFT)},
        connections=line.connections,
    )
    response = hm.simulate(scene, 0.02, initial_speed=100.0)
    ring, housing = (
        math.sqrt(0.5) * (response[f"{place}.y"].values - response[f"{place}.x"].values) for place in ("bearing_a", "bearing_a.housing")
    )
    assert np.ptp(housing) > 0.05 * np.ptp(ring) > 0.0
    largest = float(np.max(np.abs(ring)))
    np.testing.assert_allclose(response["plain"].values, ring, rtol=0.0, atol=1e-13 * largest)
    np.testing.assert_allclose(response["eye"].values, ring - housing, rtol=0.0, atol=1e-13 * largest)


def test_effects_of_a_probe_on_the_housing_are_seen_through_it() -> None:
    line = two_rotor_line.build("full")
    eye = hm.Probe(at="bearing_a", angle=LEFT, relative=True)
    scene = hm.Scene(name="watched", parts={**line.parts, "eye": eye}, connections=line.connections)
    assert hm.ProbeRunout.places(scene.network()) == ("bearing_a",)
    faulty = scene.with_effect(hm.ProbeRunout(once=1e-6), at="bearing_a").with_effect(hm.ProbeCrossTalk(share=0.1), at="eye")
    seen = hm.simulate(faulty, 0.02, initial_speed=100.0)
    spin, x, y = (seen[f"bearing_a.{name}"].values for name in ("angle", "across_x", "across_y"))
    wanted = math.sqrt(0.5) * ((y - x) - 0.1 * (x + y)) + 1e-6 * np.cos(spin - LEFT)
    np.testing.assert_allclose(seen["eye"].values, wanted, rtol=0.0, atol=1e-13 * float(np.max(np.abs(wanted))))


def test_a_ring_that_is_left_out_has_no_surface() -> None:
    line = two_rotor_line.build("improved")
    eye = hm.Probe(at="bearing_a", angle=LEFT, relative=True)
    network = hm.Scene(name="watched", parts={**line.parts, "eye": eye}, connections=line.connections).network()
    assert hm.ProbeRunout.places(network) == hm.ProbeGain.places(network) == ()
    assert hm.SensorGain.places(network) == ("eye",)


def test_a_relative_probe_needs_a_housing_that_moves() -> None:
    with pytest.raises(PlaceError, match=r"'eye' reads 'disc\.across_x'.* 'disc' has to be a bearing with a housing, full or improved"):
        watched(eye=hm.Probe(at="disc", angle=0.0, relative=True)).network()


def test_an_orbit_of_a_pair_is_turned_by_the_angle_of_the_first() -> None:
    response = run(watched(**pair()))
    plain, turned = hm.orbit(response, "disc"), hm.orbit(response, ("right", "left"))
    np.testing.assert_allclose(turned.x + 1j * turned.y, (plain.x + 1j * plain.y) * np.exp(-1j * RIGHT), rtol=0.0, atol=1e-15)

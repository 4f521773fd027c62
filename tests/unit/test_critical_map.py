"""Critical speed maps: closed forms of one disc, and the speeds at which the turning line really whirls with its spin."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.analysis.whirl.critical_map import CriticalSpeedMap
from hdrive_mbs.analysis.whirl.line_matrices import LineMatrices
from hdrive_mbs.analysis.whirl.rotor_point import rotor_point
from hdrive_mbs.errors import AnalysisError, ParameterError, PlaceError
from models.two_rotor_line import build

M, JP, JT, K_TILT = 2.5, 0.02, 0.03, 4e4
STIFFNESS = np.geomspace(1e4, 1e8, 9)
CLOSED = 1e-10
"""One eigenvalue problem of two coordinates, the stiffness a straight line between its ends of 1e4 and 1e8 N/m."""


def disc(law: Any = None, *, polar: float = JP, transverse: float = JT) -> hm.Scene:
    bearing = law or hm.LinearBearing.isotropic(radial=1.0, damping=30.0, axial=1e6, tilt=K_TILT, tilt_damping=0.1)
    parts: dict[str, Any] = {
        "rotor": hm.Rotor(mass=M, polar_inertia=polar, transverse_inertia=transverse),
        "bearing": hm.Bearing(law=bearing, housing=hm.Housing.isotropic(mass=9.0, stiffness=1e3, damping=1.0)),
    }
    return hm.Scene(name="disc", parts=parts, connections=[("rotor", "bearing")])


def branch(result: CriticalSpeedMap, whirl: str) -> np.ndarray:
    return result.speeds[:, [k for k, name in enumerate(result.whirl) if name == whirl]]


@pytest.mark.parametrize("order", [1.0, 2.0, 0.5])
def test_a_disc_has_the_critical_speeds_of_the_closed_form(order: float) -> None:
    # bouncing: n W = sqrt(k/m); tilting forward and backward: kt = (n W)^2 (Jt -+ Jp/n)
    result = hm.critical_speed_map(disc(), STIFFNESS, order=order)
    bounce = np.sqrt(STIFFNESS / M) / order
    for whirl, sign in (("forward", -1.0), ("backward", 1.0)):
        inertia = JT + sign * JP / order
        expected = [bounce] if inertia <= 0.0 else [bounce, np.full(len(bounce), math.sqrt(K_TILT / inertia) / order)]
        np.testing.assert_allclose(branch(result, whirl), np.sort(np.column_stack(expected), axis=1), rtol=CLOSED)
    assert result.status == "complete"
    assert result.settings["replaced"] == ("bearing",)


def test_a_thin_disc_has_no_forward_critical_speed_in_tilt() -> None:
    result = hm.critical_speed_map(disc(polar=0.02, transverse=0.012), [1e6])
    assert branch(result, "forward")[0] == pytest.approx([math.sqrt(1e6 / M)], rel=CLOSED)
    assert branch(result, "backward").shape == (1, 2)


def test_a_bearing_without_tilt_stiffness_leaves_the_bouncing_alone() -> None:
    result = hm.critical_speed_map(disc(hm.LinearBearing.isotropic(radial=1.0, damping=0.0, axial=1e6)), [1e6])
    assert result.speeds[0] == pytest.approx([math.sqrt(1e6 / M)] * 2, rel=CLOSED)


def whirls_with_the_spin(scene: hm.Scene, speed: float, order: float = 1.0) -> float:
    """Relative distance of an eigenvalue of the undamped line, turning at that speed, from i n W."""
    lines = LineMatrices(scene.network())
    point = rotor_point(scene, speed, lines=lines)
    system = lines.at(point.angles, point.speeds, point.states)
    kept = [k for k, name in enumerate(system.names) if name.rpartition(".")[2] in ("x", "y", "psi", "theta")]
    m, d, k = (matrix[np.ix_(kept, kept)] for matrix in (system.mass, system.damping, system.stiffness))
    gyroscopic = 0.5 * (d - d.T)
    n = len(kept)
    whole = np.block([[np.zeros((n, n)), np.eye(n)], [-np.linalg.solve(m, k), -np.linalg.solve(m, gyroscopic)]])
    values = np.linalg.eigvals(whole)
    return float(np.min(np.abs(values - 1j * order * speed)) / (order * speed))


def test_at_each_critical_speed_a_natural_frequency_of_the_turning_line_is_the_speed() -> None:
    """The direct method against the crossing in the Campbell diagram, by its definition."""
    foundation = [f"bearing_{name}.housing.stiffness_{key}" for name in "ab" for key in "xy"]
    for stiffness in (1e6, 6e6, 1e8):
        scene = build(foundation_stiffness=stiffness)
        result = hm.critical_speed_map(scene, [stiffness], paths=foundation, count=3)
        assert result.whirl == ("forward",) * 3 + ("backward",) * 3
        # eigenvalues of the first-order system carry 1e-16 of the largest, 1e5 1/s: 1e-9 of a speed of 100 rad/s and more
        assert all(whirls_with_the_spin(scene, float(speed)) < 1e-7 for speed in result.speeds[0])


def test_the_campbell_diagram_of_the_undamped_line_has_the_same_critical_speeds() -> None:
    scene = build()
    undamped = [path for path in scene.parameters() if "damping" in path]
    scene = scene.replacing(dict.fromkeys(undamped, 0.0))
    foundation = [f"bearing_{name}.housing.stiffness_{key}" for name in "ab" for key in "xy"]
    mapped = hm.critical_speed_map(scene, [6e6], paths=foundation)
    diagram = hm.campbell(scene, np.linspace(0.0, 1000.0, 41))
    for whirl in ("forward", "backward"):
        found = [speed for speed, kind in zip(diagram.critical_speeds, diagram.critical_whirl, strict=True) if kind == whirl]
        expected = [speed for speed in branch(mapped, whirl)[0] if speed < 1000.0]
        # rounding of a first-order system with eigenvalues up to 1e5 1/s
        assert found == pytest.approx(expected, rel=1e-6)
        assert len(found) > 1


def test_unlike_planes_give_mixed_whirl_with_the_same_critical_speeds_as_the_turning_line() -> None:
    paths = ["bearing_a.housing.stiffness_x", "bearing_b.housing.stiffness_x"]
    scene = build()
    result = hm.critical_speed_map(scene, [3e6, 4e6], paths=paths, count=3)
    assert result.whirl == ("mixed",) * 6
    assert np.all((result.forward_share > 0.0) & (result.forward_share < 1.0))
    soft = scene.replacing(dict.fromkeys(paths, 3e6))
    assert all(whirls_with_the_spin(soft, float(speed)) < 1e-7 for speed in result.speeds[0])


def test_the_map_is_the_same_whether_all_lines_are_built_or_three() -> None:
    scene = build()
    many = hm.critical_speed_map(scene, np.geomspace(1e5, 1e9, 9))
    single = np.array([hm.critical_speed_map(scene, [value]).speeds[0] for value in many.stiffness[[0, 3, 8]]])
    # the stiffness of the softest support is the difference of numbers 1e4 times as large
    np.testing.assert_allclose(many.speeds[[0, 3, 8]], single, rtol=1e-9)


def test_critical_speeds_rise_with_the_stiffness_of_the_supports() -> None:
    # the eigenvalues of K grow with K (Rayleigh, Courant and Fischer)
    result = hm.critical_speed_map(build(), np.geomspace(1e5, 1e10, 21))
    assert np.all(np.diff(result.speeds, axis=0) > -1e-9 * result.speeds[:-1])


def test_a_bearing_whose_stiffness_grows_with_speed_meets_the_branch_of_a_disc_at_the_closed_form() -> None:
    # k = a W^p meets m W^2 at W = (a/m)^(1/(2 - p)); both are straight lines in logarithms
    a, p = 3e3, 0.8
    result = hm.critical_speed_map(disc(hm.LinearBearing.isotropic(radial=1.0, damping=0.0, axial=1e6)), STIFFNESS)
    speeds = np.geomspace(10.0, 1e4, 5)
    found = result.crossings(speeds, a * speeds**p)
    expected = (a / M) ** (1.0 / (2.0 - p))
    assert {crossing.whirl for crossing in found} == {"forward", "backward"}, "a disc that does not tilt whirls alike both ways"
    assert [crossing.speed for crossing in found] == pytest.approx([expected] * 2, rel=1e-9)
    assert [crossing.stiffness for crossing in found] == pytest.approx([M * expected**2] * 2, rel=1e-9)


def test_unbalance_has_its_peak_at_the_critical_speed_of_forward_whirl() -> None:
    scene = build()
    foundation = [f"bearing_{name}.housing.stiffness_{key}" for name in "ab" for key in "xy"]
    critical = branch(hm.critical_speed_map(scene, [6e6], paths=foundation), "forward")[0, 0]
    peak = next(p for p in hm.unbalance_response(scene, np.linspace(300.0, 450.0, 31)).peaks if p.place == "rotor_1")
    # damping moves the peak by about zeta^2 = (1/(2 Q))^2 = 5e-5, damping in few places by some times that
    assert peak.speed == pytest.approx(critical, rel=5e-4)


def test_other_nonlinear_bearings_count_as_at_rest_and_the_status_says_so() -> None:
    scene = build(cubic=1e12)
    result = hm.critical_speed_map(scene, [1e7], parts=["bearing_a"])
    assert result.status == "complete; forces at bearing_b are not linear: taken as they are at rest"
    # no weight: at rest the cubic part has no slope
    linear = hm.critical_speed_map(build(), [1e7], parts=["bearing_a"])
    np.testing.assert_allclose(result.speeds, linear.speeds, rtol=1e-9)


def test_what_has_no_undamped_critical_speeds_is_refused() -> None:
    whirling = hm.LinearBearing.from_matrices(
        stiffness=np.array([[1e6, 2e5, 0, 0, 0, 0], [-2e5, 1e6, 0, 0, 0, 0], [0, 0, 1e6, 0, 0, 0], *np.zeros((3, 6))]),
        damping=np.diag([500.0, 500.0, 0.0, 0.0, 0.0, 0.0]),
    )
    scene = disc(whirling)
    with pytest.raises(AnalysisError, match="is not symmetric"):
        hm.critical_speed_map(scene, [1e6], paths=["bearing.housing.stiffness_x"])
    assert hm.critical_speed_map(scene, [1e6]).speeds[0] == pytest.approx([math.sqrt(1e6 / M)] * 2, rel=CLOSED)
    loose = hm.Scene(
        name="loose",
        parts={
            **disc().parts,
            "shaft": hm.ShaftSection(length=0.2, diameter=0.02, youngs_modulus=2e11, shear_modulus=8e10, density=7800.0),
        },
        connections=[("rotor", "bearing", "shaft")],
    )
    free = loose.replacing({"bearing.law": hm.LinearBearing.isotropic(radial=1.0, damping=0.0, axial=1e6)})
    with pytest.raises(AnalysisError, match="nothing holds 'loose' against some lateral motion"):
        hm.critical_speed_map(free, [1e6])


@pytest.mark.parametrize(
    ("stiffness", "options", "message"),
    [
        ([1e6, 1e5], {}, "ascending order"),
        ([0.0, 1e5], {}, "above 0 N/m"),
        ([1e6], {"count": 0}, "count = 0: at least 1"),
        ([1e6], {"order": -1.0}, "order = -1: must be greater than 0"),
        ([1e6], {"parts": ["bearing"], "paths": ["bearing.mass"]}, "parts or paths, not both"),
    ],
)
def test_wrong_arguments_are_refused(stiffness: list[float], options: dict[str, Any], message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        hm.critical_speed_map(disc(), stiffness, **options)


def test_unknown_bearings_are_named() -> None:
    with pytest.raises(PlaceError, match=r"No Bearing part 'bearng'. This scene has: bearing"):
        hm.critical_speed_map(disc(), [1e6], parts=["bearng"])


def test_a_map_is_saved_and_written_as_a_table(tmp_path: Any) -> None:
    result = hm.critical_speed_map(disc(), STIFFNESS)
    result.save(tmp_path / "map.npz")
    np.testing.assert_array_equal(CriticalSpeedMap.load(tmp_path / "map.npz").speeds, result.speeds)
    lines = result.to_csv(tmp_path / "map.csv").read_text().splitlines()
    assert lines[0].startswith("support stiffness [N/m],1 forward critical speed [rad/s]")
    assert len(lines) == 1 + len(STIFFNESS)

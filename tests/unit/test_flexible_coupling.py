"""A flexible coupling: springs in series, equal and opposite forces, both ends on one body."""

from __future__ import annotations

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.analysis.whirl.line_matrices import LineMatrices

MASS, STIFFNESS = 3.0, 2e5


def line(**coupling: float) -> hm.Scene:
    rotor = hm.Rotor(mass=MASS, polar_inertia=0.02, transverse_inertia=0.012)
    return hm.Scene(
        name="two discs",
        parts={
            "left": rotor,
            "coupling": hm.FlexibleCoupling(torsional_stiffness=500.0, radial_stiffness=STIFFNESS, **coupling),
            "right": rotor,
        },
        connections=[("left", "coupling", "right")],
    )


def stiffness_at_rest(scene: hm.Scene) -> tuple[list[str], np.ndarray, np.ndarray]:
    network = scene.network()
    rest = {body.name: 0.0 for body in network.bodies}
    system = LineMatrices(network).at(rest, rest)
    return list(system.names), system.stiffness, system.mass


def test_two_free_discs_swing_against_each_other_by_half_their_mass() -> None:
    names, stiffness, mass = stiffness_at_rest(line())
    at = [names.index("left.x"), names.index("right.x")]
    squares = np.linalg.eigvals(np.linalg.solve(mass[np.ix_(at, at)], stiffness[np.ix_(at, at)]))
    # one rigid motion, and w^2 = k (1/m + 1/m)
    np.testing.assert_allclose(sorted(squares), [0.0, 2.0 * STIFFNESS / MASS], atol=1e-6)


def test_the_hubs_share_the_mass_of_the_coupling() -> None:
    names, _, mass = stiffness_at_rest(line(mass=1.0, polar_inertia=0.004, transverse_inertia=0.002))
    assert mass[names.index("left.y"), names.index("left.y")] == pytest.approx(MASS + 0.5)
    assert mass[names.index("right"), names.index("right")] == pytest.approx(0.02 + 0.002)
    assert mass[names.index("right.psi"), names.index("right.psi")] == pytest.approx(0.012 + 0.001)


def test_each_direction_has_its_own_spring() -> None:
    names, stiffness, _ = stiffness_at_rest(line(axial_stiffness=7e4, tilt_stiffness=90.0))
    for coordinate, value in (("left.x", STIFFNESS), ("left.z", 7e4), ("left.psi", 90.0), ("left.theta", 90.0), ("left", 500.0)):
        k = names.index(coordinate)
        other = names.index(coordinate.replace("left", "right"))
        assert stiffness[k, k] == pytest.approx(value)
        assert stiffness[k, other] == pytest.approx(-value)


def test_a_coupling_with_both_ends_on_one_body_is_refused() -> None:
    parts = {
        "disc": hm.Rotor(mass=1.0, polar_inertia=0.02, transverse_inertia=0.012),
        "coupling": hm.FlexibleCoupling(torsional_stiffness=1.0),
    }
    scene = hm.Scene(name="loop", parts=parts, connections=[("disc", "coupling.a"), ("disc", "coupling.b")])
    with pytest.raises(hm.SceneError, match=r"Both ends of 'coupling' are joined to 'disc'"):
        scene.network()

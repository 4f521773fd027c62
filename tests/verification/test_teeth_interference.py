"""Clearances and interference against shapely, against each other, and against the limit for many teeth."""

from __future__ import annotations

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.errors import ParameterError
from hdrive_mbs.teeth.clearance import beside, clearances
from hdrive_mbs.teeth.limits import entry_angle, least_backlash, least_profile_angle, offset, rack_gap
from hdrive_mbs.teeth.polygons import signed_gap
from hdrive_mbs.teeth.section import flexible_teeth, rigid_teeth
from models.double_harmonic_transmission import gear

shapely = pytest.importorskip("shapely")

M = hm.mm(0.3)


def random_stages(count: int, seed: int) -> list[hm.Stage]:
    """Stages of both kinds, of which about half interfere."""
    rng = np.random.default_rng(seed)
    found: list[hm.Stage] = []
    while len(found) < count:
        flexible = 2 * int(rng.integers(60, 150))
        rigid = flexible + 2 * int(rng.choice([-1, 1]))
        out = rigid > flexible
        size = M * rng.uniform(0.85, 1.1)
        laws = (
            hm.CosineDeformation(amplitude=size),
            hm.TwoRollerDeformation(amplitude=size),
            hm.FourForceDeformation(amplitude=size, force_angle=hm.degrees(rng.uniform(15.0, 35.0))),
        )
        reference = M * flexible / 2.0
        try:
            found.append(
                hm.Stage.standard(
                    flexible_teeth=flexible,
                    rigid_teeth=rigid,
                    module=M,
                    profile_angle=hm.degrees(rng.uniform(18.0, 38.0)),
                    addendum=M * rng.uniform(0.55, 0.9),
                    clearance=M * rng.uniform(0.1, 0.35),
                    backlash=M * rng.uniform(0.0, 0.15),
                    fibre_radius=reference - (1 if out else -1) * 3.0 * M,
                    deformation=laws[int(rng.integers(3))],
                )
            )
        except ParameterError:
            continue
    return found


def test_distances_and_overlaps_are_those_of_shapely() -> None:
    rng = np.random.default_rng(4)
    apart = overlapping = 0
    for stage in random_stages(40, seed=1):
        moving = beside(stage, rng.uniform(0.0, 2.0 * np.pi, 40)).reshape(-1, 7, 2)
        fixed = stage.rigid.outline()
        gap = signed_gap(moving, fixed)
        ours = shapely.polygons(1e3 * moving)
        tooth = shapely.Polygon(1e3 * fixed)
        assert shapely.is_valid(ours).all()
        area = shapely.area(shapely.intersection(ours, tooth))
        distance = shapely.distance(ours, tooth)
        free = distance > 0.0
        np.testing.assert_allclose(1e3 * gap.distance[free], distance[free], rtol=0.0, atol=1e-12)
        # an intersection of less than 1e-12 mm^2 is rounding of two outlines that touch
        assert (gap.overlap == (area > 0.0))[(area > 1e-12) | (area == 0.0)].all()
        # depth: the corner of either tooth that lies deepest in the other one
        for k in np.flatnonzero(area > 1e-9)[:5]:
            depths = [0.0]
            for a, b in ((ours[k], tooth), (tooth, ours[k])):
                corners = shapely.points(shapely.get_coordinates(a))
                inside = corners[shapely.within(corners, b)]
                depths += shapely.distance(inside, b.exterior).tolist()
            assert 1e3 * gap.distance[k] == pytest.approx(-max(depths), abs=1e-12)
        apart += int(np.sum(free))
        overlapping += int(np.sum(area > 1e-9))
    assert apart > 2000
    assert overlapping > 70


def test_the_whole_rigid_wheel_meets_no_tooth_that_the_two_neighbours_do_not_meet() -> None:
    # all teeth at once, in shapely only, against the verdict from one tooth and two neighbours
    verdicts = []
    for stage in random_stages(14, seed=2):
        wheel = rigid_teeth(stage, np.arange(stage.rigid.teeth, dtype=float))
        tree = shapely.STRtree(shapely.polygons(1e3 * wheel))
        crossing, nearest = False, np.inf
        for phase in np.arange(8) / 8.0 * stage.flexible.pitch_angle:
            teeth = flexible_teeth(stage, 0.37 + phase, np.arange(stage.flexible.teeth, dtype=float))
            ours = shapely.polygons(1e3 * teeth)
            first, second = tree.query(ours, predicate="intersects")
            crossing |= bool(np.any(shapely.area(shapely.intersection(ours[first], tree.geometries[second])) > 1e-9))
            nearest = min(nearest, float(np.min(shapely.distance(ours, tree.geometries[tree.nearest(ours)]))))
        result = hm.clearances(stage)
        verdicts.append(crossing)
        if crossing:
            assert result.interferes
        elif result.interferes:
            # 8 phases leave gaps of 360/(8 z) degrees, at least 60 teeth a half turn: what they miss is shallower than this
            assert result.minimum > -2.0 * 1.1 * M * stage.flexible.pitch_angle / 16.0
        else:
            assert nearest >= 1e3 * result.minimum - 1e-9
    assert 3 < sum(verdicts) < 11


def test_a_sweep_and_the_full_outlines_give_one_verdict() -> None:
    rng = np.random.default_rng(7)
    limits = np.array([[20.0, 38.0], [1.3, 2.0], [0.1, 0.35], [0.85, 1.08]]).T
    same = {True: 0, False: 0}
    between = 2.0 * M * np.radians(0.15) / 2.0  # radial motion in half a step of the sweep: how much it may miss where corners clip
    for one, back in ((gear("A").stages()[0], 0.01), (gear("A").stages()[1], 0.04)):
        task = hm.DesignTask.of(one, least_tip_thickness=0.0)
        assert 1e3 * task.backlash == pytest.approx(back, abs=1e-9)
        alpha, height, clearance, size = (rng.uniform(*limits, (40, 4)) * [np.pi / 180.0, task.module, task.module, task.module]).T
        points = task.evaluate(alpha, height, clearance, size)
        for k in range(40):
            try:
                stage = task.stage(profile_angle=alpha[k], height=height[k], clearance=clearance[k], amplitude=size[k])
            except ParameterError:
                assert not points.admissible[k]
                continue
            full = hm.clearances(stage)
            if min(abs(full.minimum), abs(points.flank_gap[k])) < between:
                continue
            assert full.interferes != points.admissible[k], (k, points.verdict[k], full.minimum)
            same[bool(full.interferes)] += 1
            if not full.interferes:
                # separating axes give the distance or, corner to corner, less
                assert points.flank_gap[k] <= full.flank_clearance + between
    assert min(same.values()) > 10


def test_the_lost_motion_is_the_turn_between_contacts_on_both_sides() -> None:
    stage = gear("A").stages()[0]
    result = hm.clearances(stage)
    phi = result.angles[np.abs(result.angles - np.pi / 2.0) < 0.8]
    fixed = stage.rigid.outline()
    for side, turn in ((1, float(np.min(result.ahead))), (0, -float(np.min(result.behind)))):
        for part, touching in ((0.99, False), (1.01, True)):
            c, s = np.cos(part * turn), np.sin(part * turn)
            points = beside(stage, phi)[:, side]
            turned = np.stack((points[..., 0] * c + points[..., 1] * s, points[..., 1] * c - points[..., 0] * s), axis=-1)
            assert bool(np.any(signed_gap(turned, fixed).overlap)) is touching
    # by hand: 10 um of backlash on a radius of 30.6 mm, less what w0 is too small by (see the contraction)
    assert result.lost_motion == pytest.approx(10e-6 / 30.6e-3, rel=0.1)


@pytest.mark.parametrize("index", [0, 1])
def test_the_lost_motion_is_that_of_a_flexspline_that_slides_around_its_generator(index: int) -> None:
    # all teeth against all teeth, each moved by the turn along the deformed fibre, which lost_motion leaves out
    stage = gear("A").stages()[index]
    fibre, outline, number = stage.fibre(), stage.flexible.outline(), np.arange(stage.flexible.teeth)
    tree = shapely.STRtree(shapely.polygons(1e6 * rigid_teeth(stage, np.arange(stage.rigid.teeth, dtype=float))))

    def touches(turn: float) -> bool:
        for phi in np.arange(8) / 8.0 * stage.flexible.pitch_angle:
            s = stage.start + number * stage.flexible.pitch_angle - phi + turn
            theta, up = fibre.rotation(s)[:, None], outline[:, 1] - stage.fibre_radius
            x = fibre.tangential(s)[:, None] + outline[:, 0] * np.cos(theta) + up * np.sin(theta)
            y = stage.fibre_radius + fibre.radial(s)[:, None] + up * np.cos(theta) - outline[:, 0] * np.sin(theta)
            angle = (number * stage.flexible.pitch_angle + stage.relative_turn * phi + turn)[:, None]
            points = np.stack((x * np.cos(angle) + y * np.sin(angle), y * np.cos(angle) - x * np.sin(angle)), axis=-1)
            if len(tree.query(shapely.polygons(1e6 * points), predicate="intersects")[0]):
                return True
        return False

    total = 0.0
    for side in (1.0, -1.0):
        free, met = 0.0, 1e-3
        while met - free > 1e-7:
            middle = 0.5 * (free + met)
            free, met = (free, middle) if touches(side * middle) else (middle, met)
        total += free
    # (w0/r)(1 + 2 tan alpha): sideways dv/ds = w0, radially dw/ds up to 2 w0 across the flank
    along = 0.3 / 29.3 * (1.0 + 2.0 * np.tan(np.radians(30.0)))
    assert hm.clearances(stage).lost_motion == pytest.approx(total, rel=along)


@pytest.mark.parametrize("name", ["A", "C"])
def test_the_smallest_distance_is_reported_for_the_first_of_the_places_that_are_alike(name: str) -> None:
    for stage in gear(name).stages():
        result = hm.clearances(stage)
        assert result.angles[result.worst] < np.pi / 2.0
        assert result.gap[result.worst] == pytest.approx(result.minimum, abs=2e-13)


def test_more_backlash_is_more_clearance_and_more_lost_motion() -> None:
    def stage(backlash: float) -> hm.Stage:
        return hm.Stage.standard(
            flexible_teeth=202, rigid_teeth=204, module=M, profile_angle=0.52, addendum=0.8 * M, clearance=0.2 * M,
            backlash=backlash, fibre_radius=hm.mm(29.3), deformation=hm.CosineDeformation(amplitude=M),
        )  # fmt: skip

    small, large = (hm.clearances(stage(hm.mm(b))) for b in (0.01, 0.02))
    # half of it is on each side, across a flank of angle alpha: cos(alpha)
    assert large.minimum - small.minimum == pytest.approx(5e-6 * np.cos(0.52), rel=0.02)
    assert large.lost_motion - small.lost_motion == pytest.approx(10e-6 / 30.6e-3, rel=0.02)


# -- the limit for many teeth --------------------------------------------------------------------------------


def many(teeth: int, *, alpha: float, height: float, amplitude: float, backlash: float) -> hm.Stage:
    """A rack in the limit: the module stays, the number of teeth grows, the fibre lies two modules below the reference circle."""
    task = hm.DesignTask(
        flexible_teeth=teeth,
        rigid_teeth=teeth + 2,
        module=M,
        fibre_radius=M * teeth / 2.0 - 2.0 * M,
        deformation=hm.CosineDeformation(amplitude=amplitude),
        backlash=backlash,
    )
    return task.stage(profile_angle=alpha, height=height, clearance=0.2 * M, amplitude=amplitude)


def numeric_least_angle(teeth: int, height: float, amplitude: float, backlash: float) -> float:
    """Smallest profile angle without interference, by bisection to 1e-4 rad."""
    low, high = np.radians(5.0), np.radians(33.0)
    while high - low > 1e-4:
        middle = 0.5 * (low + high)
        stage = many(teeth, alpha=middle, height=height, amplitude=amplitude, backlash=backlash)
        low, high = (middle, high) if clearances(stage, 360).interferes else (low, middle)
    return high


@pytest.mark.parametrize(("ratio", "addendum", "back"), [(1.0, 0.6, 0.03), (0.97, 0.7, 0.06), (0.9, 0.5, 0.1)])
def test_the_least_profile_angle_tends_to_the_closed_form_as_the_teeth_grow_in_number(ratio: float, addendum: float, back: float) -> None:
    amplitude = ratio * M
    height = 2.0 * addendum * M + 0.2 * M
    depth = 2.0 * addendum * M + amplitude - M
    limit = least_profile_angle(amplitude, M, depth, back * M)
    off = np.array([numeric_least_angle(z, height, amplitude, back * M) - limit for z in (300, 600, 1200, 2400)])
    # curvature and tilt are of the order 1/z; what is left at z -> infinity is the resolution of the bisection and of the
    # angles, 1/32 degree: 2 w0/(2 * 32) deg of radial motion over a lever of about 0.7 M
    order_line = np.polyfit(1.0 / np.array([300, 600, 1200, 2400]), off, 1)
    assert abs(order_line[1]) < 1e-4 + 2.0 * np.radians(1.0) / 64.0 / 0.7
    np.testing.assert_allclose(off, np.polyval(order_line, 1.0 / np.array([300, 600, 1200, 2400])), rtol=0.0, atol=1e-3)
    assert abs(off[0]) > 4.0 * abs(off[-1])


def test_the_classical_limit_is_the_closed_form_at_the_entry() -> None:
    depth = 1.6 * M
    b = entry_angle(M, depth)
    wanted = np.arctan((b - np.sin(2.0 * b) / 2.0) / (1.0 - np.cos(2.0 * b)))
    assert least_profile_angle(M, M, depth) == pytest.approx(wanted, rel=1e-9)
    assert np.degrees(wanted) == pytest.approx(23.8, abs=0.1)  # addendum 0.8 m and w0 = m
    # at that angle the flank is touched at the entry and nowhere before
    gaps = rack_gap(np.linspace(1e-3, b, 400), wanted, M, M)
    assert np.min(gaps) >= -1e-18
    assert np.argmin(gaps[200:]) == 199


def test_least_backlash_and_least_angle_are_each_other_s_inverse() -> None:
    for amplitude in (0.9 * M, 1.0 * M):
        depth = amplitude + 0.3 * M
        for back in (0.02 * M, 0.08 * M):
            angle = least_profile_angle(amplitude, M, depth, back)
            assert least_backlash(angle, amplitude, M, depth) == pytest.approx(back, rel=1e-6)


def test_too_large_a_w0_wedges_the_teeth_and_is_said_so() -> None:
    with pytest.raises(ParameterError, match=r"w0 = 0.33 mm is above 0.3 mm .* wedge"):
        least_profile_angle(1.1 * M, M, 1.2 * M)
    assert least_backlash(0.5, 1.1 * M, M, 1.2 * M) > 2.0 * 0.1 * M * np.tan(0.5) * 0.99
    with pytest.raises(ParameterError, match="or the teeth never part"):
        entry_angle(M, 2.1 * M)
    assert offset(0.0, M, M) == 0.0


def test_many_teeth_have_the_gap_of_the_rack() -> None:
    amplitude, back, alpha = 0.95 * M, 0.05 * M, 0.45
    off = []
    for z in (600, 1200, 2400):
        stage = many(z, alpha=alpha, height=1.4 * M, amplitude=amplitude, backlash=back)
        result = hm.clearances(stage)
        b = np.abs(result.angles - np.pi / 2.0)
        near = b < 0.6  # flank beside flank, so the distance is that of the flanks
        off.append(np.max(np.abs(result.gap[near] - rack_gap(b[near], alpha, amplitude, M, back))))
    np.testing.assert_allclose(np.log2(np.array(off[:-1]) / off[1:]), 1.0, atol=0.2)

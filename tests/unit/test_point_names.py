"""Names of points: each at the nearest place where it covers nothing, in every picture that has critical speeds or peaks."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.text import Annotation, Text

import hdrive_mbs as hm
from hdrive_mbs.plots.point_names import FAR, NEAR, ROOM, name_point
from models import harmonic_drive_train, robot_joint_line, rotor_bench, two_rotor_line
from tests.unit.picture_checks import assert_names_cover_nothing, assert_nothing_is_cut_off, drawn, figure_of


def panel() -> Axes:
    """7 by 5 inches for 0..70 and 0..50: a tenth of an inch, 7.2 points, each unit."""
    ax = Figure(figsize=(7.0, 5.0)).add_axes((0.0, 0.0, 1.0, 1.0))
    ax.set(xlim=(0.0, 70.0), ylim=(0.0, 50.0))
    ax.set_axis_off()
    return ax


def gap(ax: Axes, number: int = 0) -> float:
    """Distance [points] of a name from its point."""
    name = ax.texts[number]
    assert isinstance(name, Annotation)
    box = Text.get_window_extent(name, drawn(ax))
    x, y = ax.transData.transform(name.xy)
    return math.hypot(max(box.x0 - x, x - box.x1, 0.0), max(box.y0 - y, y - box.y1, 0.0)) * 72.0 / figure_of(ax).dpi


def is_joined(ax: Axes, number: int = 0) -> bool:
    drawn(ax)
    name = ax.texts[number]
    assert isinstance(name, Annotation)
    assert name.arrow_patch is not None
    return name.arrow_patch.get_visible()


# -- the place ---------------------------------------------------------------------------------------


def test_a_name_stands_beside_its_mark() -> None:
    ax = panel()
    ax.plot([30.0], [20.0], "o", markersize=6.0, markeredgewidth=1.0)
    name_point(ax, "12.34", 30.0, 20.0)
    assert_names_cover_nothing(ax)
    # half the mark, the room around the name, and what whole points round up
    assert 3.5 < gap(ax) < 3.5 + ROOM + 2.0
    assert not is_joined(ax)


def test_a_name_that_must_go_further_is_joined_to_its_point() -> None:
    ax = panel()
    for x in np.arange(25.0, 36.0):  # a fence of 72 points around it, with gaps too narrow for a name
        ax.axvline(x)
    name_point(ax, "12.34", 30.0, 20.0)
    assert_names_cover_nothing(ax)
    assert NEAR < 36.0 < gap(ax) < 36.0 + ROOM + 2.0
    assert is_joined(ax)


def test_names_of_points_close_together_go_to_different_places() -> None:
    ax = panel()
    for x in (30.0, 30.5, 31.0, 31.5):
        ax.plot([x], [20.0], "o")
        name_point(ax, f"{x:.2f}", x, 20.0)
    assert_names_cover_nothing(ax)
    assert all(name.get_visible() for name in ax.texts)


def test_a_name_moves_with_the_limits_and_stays_inside() -> None:
    ax = panel()
    ax.plot([0.0, 70.0], [0.0, 50.0])
    name_point(ax, "corner", 70.0, 50.0)
    for limits in ((0.0, 70.0), (0.0, 700.0)):
        ax.set_xlim(*limits)
        assert_names_cover_nothing(ax)
        assert_nothing_is_cut_off(ax)
    ax.set_xlim(0.0, 60.0)
    drawn(ax)
    assert not ax.texts[0].get_visible(), "its point is not in the picture"


def test_a_name_without_a_place_nearby_is_left_out() -> None:
    ax = panel()
    x = np.linspace(0.0, 70.0, 200)
    reach = 1.2 * FAR / 7.2
    near = x[np.abs(x - 30.0) < reach]
    for at in near:
        ax.axvline(at)
    name_point(ax, "12.34", 30.0, 20.0)
    drawn(ax)
    assert not ax.texts[0].get_visible()


def test_a_curve_with_gaps_and_far_outside_the_picture_is_no_trouble() -> None:
    ax = panel()
    ax.plot([0.0, 30.0, np.nan, 30.0, 70.0], [20.0, 20.0, np.nan, 1e9, 20.0])
    name_point(ax, "12.34", 29.0, 20.0)
    assert_names_cover_nothing(ax)


def test_a_removed_name_takes_no_place() -> None:
    ax = panel()
    for text in ("first", "second"):
        name_point(ax, text, 30.0, 20.0)
    near = gap(ax, 0)
    ax.texts[0].remove()
    assert gap(ax, 0) == pytest.approx(near, abs=1.0)


# -- the pictures ------------------------------------------------------------------------------------


def joint() -> hm.Scene:
    return robot_joint_line.build("improved", arm_angle=-0.5 * math.pi)


@functools.cache
def run_up() -> hm.RunUp:
    return hm.run_up(robot_joint_line.build("improved"), 3.0)


def critical_map() -> Axes:
    result = hm.critical_speed_map(two_rotor_line.build(), np.geomspace(1e5, 1e9, 17), count=3)
    return hm.plot(result, curves={"bearing_a": ([50.0, 5000.0], [1e6, 1e8]), "bearing_b": ([50.0, 5000.0], [1.2e6, 1.1e8])})


PICTURES: dict[str, Callable[[], Axes]] = {
    "Campbell": lambda: hm.plot(hm.campbell(two_rotor_line.build(), np.linspace(0.0, 1000.0, 26))),
    "Campbell with two orders": lambda: hm.plot(hm.campbell(two_rotor_line.build(), np.linspace(0.0, 1200.0, 25), orders=(1, 2))),
    "Campbell of a joint": lambda: hm.plot(hm.campbell(joint(), np.linspace(0.0, 500.0, 26)), highest=1200.0),
    "torsional Campbell": lambda: hm.plot(
        hm.torsional_campbell(
            harmonic_drive_train.build(), np.linspace(5.0, 160.0, 32), orders={"gear.wave_generator": (1.0, 2.0, 4.0)}, torque=20.0
        )
    ),
    "run-up": lambda: hm.plot(run_up()),
    "run-up, logarithmic": lambda: hm.plot(run_up(), logarithmic=True),
    "Bode": lambda: hm.plot(hm.unbalance_response(rotor_bench.build("run_up"), np.linspace(300.0, 1000.0, 15))),
    "polar": lambda: hm.plot(hm.unbalance_response(two_rotor_line.build(), np.linspace(20.0, 1000.0, 81)), view="polar"),
    "critical speed map": critical_map,
}


@pytest.mark.slow
@pytest.mark.parametrize("name", PICTURES)
def test_no_name_lies_on_a_curve_a_critical_speed_or_another_name(name: str) -> None:
    ax = PICTURES[name]()
    assert_names_cover_nothing(ax)
    assert_nothing_is_cut_off(ax)
    assert all(text.get_visible() for one in figure_of(ax).axes for text in one.texts), "none is left out here"

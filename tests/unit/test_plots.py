"""Pictures: what every one of them must say, and that none hides its own data."""

from __future__ import annotations

import functools
import itertools
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import matplotlib
import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import hdrive_mbs as hm
from hdrive_mbs.plots.look import COLOURS, LINES
from hdrive_mbs.plots.thinning import thinned
from models.harmonic_drive_train import build
from tests.unit.picture_checks import assert_nothing_is_cut_off, drawn, figure_of


@functools.cache
def response() -> hm.Response:
    return hm.simulate(build().with_effect(hm.KinematicError(amplitude=1e-4, order=2.0), at="gear.mesh"), 0.6)


def campbell() -> hm.Result:
    return hm.torsional_campbell(build(), np.linspace(5.0, 160.0, 8), orders={"gear.wave_generator": (1.0, 2.0, 4.0)}, torque=20.0)


def loop() -> hm.Result:
    scene = build().with_effect(hm.BoucWenHysteresis(torque_limit=5.0, yield_twist=2e-4), at="gear")
    return hm.torsion(scene, cycles=1, points=101)


RESULTS: dict[str, Callable[[], hm.Result]] = {
    "response": response,
    "start-up": lambda: hm.start_up(build(), 0.3),
    "torsion of the gear": lambda: hm.torsion(build()),
    "torsion of the line": lambda: hm.torsion(build(), between=("motor", "load")),
    "torsion loop": loop,
    "spectrum": lambda: hm.spectrum(response(), "gear.torque", start=0.3),
    "order spectrum": lambda: hm.order_spectrum(response(), "gear.torque", start=0.3),
    "modes": lambda: hm.modes(build()),
    "campbell": campbell,
    "energy": lambda: hm.energy_balance(response()),
    "reduction": lambda: hm.reduce(build(), torque=20.0),
}

made = functools.cache(lambda name: RESULTS[name]())

DRAWS_AMPLITUDES = {"spectrum", "order spectrum", "modes", "reduction"}


def texts(ax: Axes) -> list[str]:
    """Axis labels of the axes and of their second scales, on the whole figure."""
    every = [*figure_of(ax).axes, *(child for one in figure_of(ax).axes for child in one.child_axes)]
    return [label for one in every for label in (one.get_xlabel(), one.get_ylabel()) if label]


# -- every picture ----------------------------------------------------------------------------------


@pytest.mark.parametrize("name", RESULTS)
def test_every_axis_names_its_quantity_and_unit(name: str) -> None:
    ax = hm.plot(made(name))
    assert ax.get_ylabel().endswith("]")
    bottom = figure_of(ax).axes[-1]
    categories = name == "modes"  # its horizontal axis carries the names of the bodies
    assert categories or bottom.get_xlabel().endswith("]")
    for label in texts(ax):
        quantity, _, unit = label.partition("[")
        assert len(quantity.strip()) > 2, label
        assert unit.endswith("]"), label


@pytest.mark.parametrize("name", sorted(DRAWS_AMPLITUDES))
def test_every_amplitude_says_that_it_is_0_peak(name: str) -> None:
    assert "0-peak" in hm.plot(made(name)).get_ylabel()


@pytest.mark.parametrize("name", RESULTS)
def test_nothing_is_cut_off_at_the_edge_of_the_picture(name: str) -> None:
    assert_nothing_is_cut_off(hm.plot(made(name)))


@pytest.mark.parametrize("name", RESULTS)
def test_no_legend_lies_over_the_data(name: str) -> None:
    ax = hm.plot(made(name))
    renderer = drawn(ax)
    for one in figure_of(ax).axes:
        legend = one.get_legend()
        if legend is not None:
            assert not legend.get_window_extent(renderer).overlaps(one.bbox.shrunk(0.99, 0.99))
    for legend in figure_of(ax).legends:
        assert not any(legend.get_window_extent(renderer).overlaps(one.bbox) for one in figure_of(ax).axes)


@pytest.mark.parametrize("name", RESULTS)
def test_lines_of_one_panel_differ_in_colour_and_in_dashes(name: str) -> None:
    for one in figure_of(hm.plot(made(name))).axes:
        named = [line for line in one.get_lines() if not str(line.get_label()).startswith("_") and len(line.get_xdata()) > 2]
        for first, second in itertools.combinations(named, 2):
            assert first.get_color() != second.get_color()
            assert first._unscaled_dash_pattern != second._unscaled_dash_pattern


@pytest.mark.parametrize("name", RESULTS)
def test_axes_of_the_caller_are_drawn_on(name: str) -> None:
    ax = Figure().add_subplot()
    options = {"channels": ["gear.torque", "load.torque"]} if name in ("response", "start-up") else {}
    assert hm.plot(made(name), ax=ax, **options) is ax
    assert ax.get_ylabel().endswith("]")
    assert len(figure_of(ax).axes) == 1


# -- files ------------------------------------------------------------------------------------------


def test_a_figure_is_written_as_png_and_svg_the_same_each_time(tmp_path: Path) -> None:
    png, svg = hm.save_figure(hm.plot(made("torsion of the gear")), tmp_path / "new" / "torsion")
    assert png.read_bytes().startswith(b"\x89PNG")
    assert "<svg" in svg.read_text()[:600]
    again = hm.save_figure(figure_of(hm.plot(made("torsion of the gear"))), tmp_path / "again.png")
    assert again[1].name == "again.svg"
    assert again[1].read_bytes() == svg.read_bytes()
    assert sorted(path.name for path in (tmp_path / "new").iterdir()) == ["torsion.png", "torsion.svg"]


def test_a_folder_that_cannot_be_written_leaves_nothing_behind(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("not a folder")
    with pytest.raises(hm.FileFormatError, match="Choose a folder that can be written to"):
        hm.save_figure(hm.plot(made("torsion of the gear")), tmp_path / "file" / "torsion")
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


# -- manners ----------------------------------------------------------------------------------------


def test_plotting_leaves_the_users_own_settings_alone(tmp_path: Path) -> None:
    before = dict(matplotlib.rcParams)
    hm.save_figure(hm.plot(made("response")), tmp_path / "response")
    assert dict(matplotlib.rcParams) == before


def test_no_display_and_no_pyplot_are_needed_and_importing_the_package_imports_no_matplotlib() -> None:
    program = (
        "import sys, numpy as np, hdrive_mbs as hm\n"
        "assert 'matplotlib' not in sys.modules\n"
        "t = np.linspace(0.0, 1.0, 101)\n"
        "hm.plot(hm.spectrum(hm.TimeHistory('signal', 'N m', t, np.sin(60.0 * t))))\n"
        "assert 'matplotlib' in sys.modules and 'matplotlib.pyplot' not in sys.modules\n"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, env={"PATH": "/usr/bin", "MPLBACKEND": "TkAgg"})
    assert done.returncode == 0, done.stderr


def test_something_without_a_picture_is_refused_with_what_there_is() -> None:
    with pytest.raises(hm.AnalysisError, match=r"no picture of a Scene.*Response.*TorsionCurve"):
        hm.plot(build())


# -- single pictures --------------------------------------------------------------------------------


def test_the_automatic_choice_stacks_speeds_and_torques_by_size() -> None:
    axes = figure_of(hm.plot(response())).axes
    labels = [[text.get_text() for text in one.get_legend().get_texts()] for one in axes]
    assert labels == [["motor speed"], ["load speed"], ["gear torque", "load torque"], ["motor torque"]]


def test_named_channels_are_drawn_as_named_and_bad_ones_are_refused() -> None:
    axes = figure_of(hm.plot(response(), channels=["gear.twist", "motor.speed", "load.angle"], start=0.1, end=0.2)).axes
    assert [one.get_ylabel().split(" ")[0] for one in axes] == ["angle", "speed"]
    assert axes[0].get_xlim() == pytest.approx((0.1, 0.2), abs=1e-3)
    with pytest.raises(hm.PlaceError, match=r"No channel 'gear\.speeed'"):
        hm.plot(response(), channels=["gear.speeed"])
    with pytest.raises(hm.ParameterError, match="One Axes shows one unit"):
        hm.plot(response(), ax=Figure().add_subplot(), channels=["gear.twist", "motor.speed"])
    with pytest.raises(hm.ParameterError, match="fewer than 2 samples"):
        hm.plot(response(), start=5.0)


def test_the_torsion_curve_shows_its_corners_and_lost_motion() -> None:
    ax = hm.plot(made("torsion of the gear"))
    written = " ".join(text.get_text() for text in ax.texts).replace("\u2009", " ")
    assert "23.5 N m\n2.04 mrad" in written
    assert "98 N m\n3.21 mrad" in written
    assert "9 arcmin" in ax.get_legend().get_texts()[0].get_text().replace("\u2009", " ")


def test_the_campbell_picture_marks_every_crossing_inside_it() -> None:
    result = campbell()
    assert isinstance(result, hm.Campbell)
    ax = hm.plot(result)
    marks = sorted(float(line.get_xdata()[0]) for line in ax.get_lines() if line.get_marker() == "o" and len(line.get_xdata()) == 1)
    # 2x and 4x of the wave generator meet the first mode below 160 rad/s; 1x does so above
    assert marks == pytest.approx(result.critical_speeds.tolist())
    assert len(marks) == 2
    written = " ".join(text.get_text() for text in ax.texts)
    for order in ("1 x", "2 x", "4 x"):
        assert f"{order} gear wave generator" in written


def test_shapes_on_one_axis_are_divided_by_the_speed_ratio() -> None:
    result = made("modes")
    ratio = {body.name: body.ratio for body in build().network().bodies}
    first = hm.plot(result)
    points = next(line for line in first.get_lines() if line.get_linestyle() == "None")
    expected = result.shapes[:, 0] / np.array([ratio[name] for name in result.bodies])
    np.testing.assert_allclose(points.get_ydata(), expected / expected[np.argmax(np.abs(expected))])
    true = hm.plot(result, one_axis=False)
    points = next(line for line in true.get_lines() if line.get_linestyle() == "None")
    np.testing.assert_allclose(points.get_ydata(), result.shapes[:, 0])


def test_bodies_stand_in_the_order_of_the_line_whatever_their_order_in_the_scene() -> None:
    parts = {"c": hm.Inertia(inertia=1.0), "s": hm.Shaft(stiffness=1e3), "a": hm.Inertia(inertia=2.0)}
    parts |= {"t": hm.Shaft(stiffness=2e3), "b": hm.Inertia(inertia=3.0)}
    scene = hm.Scene(name="line", parts=parts, connections=[("a", "s", "b", "t", "c")])
    ax = hm.plot(hm.modes(scene))
    names = sorted((tick, label.get_text()) for tick, label in zip(ax.get_xticks(), ax.get_xticklabels(), strict=True))
    assert [name for _, name in names] == ["a", "b", "c"]


def test_the_largest_peaks_of_a_spectrum_are_named() -> None:
    ax = hm.plot(made("order spectrum"))
    assert any(text.get_text().startswith("2\n") or text.get_text().startswith("2.0") for text in ax.texts)
    logarithmic = hm.plot(made("spectrum"), logarithmic=True)
    assert logarithmic.get_yscale() == "log"


def test_thinning_keeps_the_ends_and_every_extreme() -> None:
    x = np.linspace(0.0, 1.0, 100_000)
    y = np.sin(300.0 * x)
    y[54_321] = 7.0
    few_x, few_y = thinned(x, y, columns=500)
    assert len(few_x) <= 1002
    assert np.all(np.diff(few_x) > 0.0)
    assert few_y.max() == 7.0
    assert few_y.min() == y.min()
    assert (few_x[0], few_x[-1]) == (0.0, 1.0)


def test_the_colours_keep_apart_in_grey_by_their_dashes() -> None:
    assert len({str(line) for line in LINES}) == len(LINES) == len(set(COLOURS)) == len(COLOURS)


def test_the_title_of_a_single_mode_takes_as_many_lines_as_it_needs() -> None:
    motor = hm.Motor(inertia=1e-4, characteristic=lambda w: 1.0 - w / 350.0)
    parts = {"motor": motor, "shaft": hm.Shaft(stiffness=1e4), "arm": hm.Load(inertia=1.0, torque=hm.ConstantTorque(value=0.02))}
    scene = hm.Scene(name="elbow of the second robot", parts=parts, connections=[("motor", "shaft", "arm")])
    picture = hm.plot(hm.modes(scene))
    assert_nothing_is_cut_off(picture)
    title = figure_of(picture)._suptitle  # type: ignore[attr-defined]
    assert title.get_text().replace("\n", " ") == "elbow of the second robot: undamped modes at 343\u2009rad/s of the motor"

"""``hdrive-mbs campbell`` and ``modes`` of rotor lines: what they write, and their errors; pictures of the results."""

from __future__ import annotations

import functools
import json
import math
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from typer.testing import CliRunner

import hdrive_mbs as hm
from hdrive_mbs.cli.main import app
from hdrive_mbs.cli.speeds import parse_orders, parse_speeds
from hdrive_mbs.errors import AnalysisError, HdriveError, ParameterError
from models.two_rotor_line import build
from tests.unit.test_whirl_campbell import internally_damped
from tests.verification.scenes import chain
from tests.verification.whirl_scenes import jeffcott, overhung_disc, two_discs

LINE = str(Path(__file__).parents[2] / "models" / "two_rotor_line.py")
OVERHUNG = (
    "import hdrive_mbs as hm\n"
    "def build(diameter=0.02):\n"
    "    shaft = hm.ShaftSection(length=0.4, diameter=diameter, youngs_modulus=2.1e11, shear_modulus=8.1e10)\n"
    "    parts = {'shaft': shaft, 'disc': hm.Rotor(mass=5.0, polar_inertia=0.04, transverse_inertia=0.02)}\n"
    "    return hm.Scene(name='overhung', parts=parts, connections=[('ground', 'shaft', 'disc')])\n"
)


def call(*arguments: str) -> str:
    done = CliRunner().invoke(app, list(arguments), catch_exceptions=False)
    assert done.exit_code == 0, done.output
    return done.output


@pytest.fixture
def scene(tmp_path: Path) -> str:
    path = tmp_path / "overhung.py"
    path.write_text(OVERHUNG)
    return str(path)


def test_json_has_exactly_the_agreed_form_and_the_numbers_of_the_api(scene: str, tmp_path: Path) -> None:
    call("campbell", scene, "--speeds", "0:400:21", "--orders", "1,2", "--count", "4", "--json", str(tmp_path / "c.json"))
    written = json.loads((tmp_path / "c.json").read_text())
    result = hm.campbell(overhung_disc(), np.linspace(0.0, 400.0, 21), (1, 2), count=4)
    assert set(written) == {"status", "speeds", "stable", "branches", "critical_speeds", "thresholds", "origin"}
    assert written["speeds"] == pytest.approx(np.linspace(0.0, 400.0, 21).tolist())
    assert len(written["branches"]) == 4
    for k, branch in enumerate(written["branches"]):
        assert set(branch) == {"whirl", "frequency", "damping_ratio"}
        assert branch["whirl"] == result.whirl[k]
        assert branch["whirl"] in ("forward", "backward", "torsional", "axial", "mixed")
        assert branch["frequency"] == pytest.approx(result.frequencies[:, k].tolist(), rel=1e-12)
        assert len(branch["damping_ratio"]) == 21
    assert [critical["speed"] for critical in written["critical_speeds"]] == pytest.approx(result.critical_speeds.tolist(), rel=1e-12)
    assert {critical["order"] for critical in written["critical_speeds"]} == {1.0, 2.0}
    for critical, damping, note, branch in zip(
        written["critical_speeds"], result.critical_damping_ratios, result.critical_notes, result.critical_branches, strict=True
    ):
        assert set(critical) == {"order", "of", "branch", "whirl", "speed", "damping_ratio", "note"}
        assert (critical["damping_ratio"], critical["note"], critical["branch"]) == (pytest.approx(damping, rel=1e-9), note, branch)


def test_json_of_an_unstable_line_says_so(tmp_path: Path) -> None:
    hm.save_scene(internally_damped(), tmp_path / "damped.toml")
    call("campbell", str(tmp_path / "damped.toml"), "--speeds", "0:1600:9", "--count", "4", "--json", str(tmp_path / "c.json"))
    written = json.loads((tmp_path / "c.json").read_text())
    result = hm.campbell(internally_damped(), np.linspace(0.0, 1600.0, 9), count=4)
    assert written["status"] == result.status
    assert "unstable above" in written["status"]
    assert written["stable"] == result.stable.tolist()
    assert written["stable"][0] is True
    assert written["stable"][-1] is False
    assert [(item["speed"], item["note"]) for item in written["thresholds"]] == [
        (pytest.approx(speed, rel=1e-9), note) for speed, note in zip(result.threshold_speeds, result.threshold_notes, strict=True)
    ]
    assert written["thresholds"]


def test_what_does_not_exist_is_null(tmp_path: Path) -> None:
    path = tmp_path / "table.py"
    path.write_text(
        "import hdrive_mbs as hm\n"
        "def build():\n"
        "    law = hm.TableBearing(speeds=(0.0, 200.0), stiffness_xx=(9e4, 9e4), stiffness_yy=(9e4, 9e4),\n"
        "        damping_xx=(0.0, 2400.0), damping_yy=(0.0, 2400.0))\n"
        "    rotor = hm.Rotor(mass=4.0, polar_inertia=0.02, transverse_inertia=0.015)\n"
        "    return hm.Scene(name='table', parts={'rotor': rotor, 'b': hm.Bearing(law=law)}, connections=[('rotor', 'b')])\n"
    )
    output = call("campbell", str(path), "--speeds", "0:200:11", "--count", "2", "--json", "-")
    branches = json.loads(output)["branches"]
    assert branches[0]["frequency"][0] == pytest.approx(150.0)
    assert branches[0]["frequency"][-1] is None
    assert branches[0]["damping_ratio"][-1] is None


def test_tables_and_pictures_are_written_and_the_critical_speeds_printed(tmp_path: Path) -> None:
    out = tmp_path / "out"
    printed = call("campbell", LINE, "--speeds", "0:1000:21", "--out", str(out))
    for name in ("campbell.png", "campbell.svg", "campbell.csv", "campbell.npz", "critical_speeds.csv"):
        assert (out / name).stat().st_size > 300, name
    table = (out / "critical_speeds.csv").read_text().splitlines()
    assert table[0].startswith(
        "critical speed [rad/s],order,of,frequency [rad/s],mode,whirl,damping ratio [1],amplification 1/(2 zeta) [1],note"
    )
    # first synchronous critical speeds of the independent model, see test_whirl_campbell
    assert [float(row.split(",")[0]) for row in table[1:3]] == pytest.approx([360.87000492, 370.61954093], rel=1e-8)
    assert "370.62" in printed
    assert "backward" in printed
    header = (out / "campbell.csv").read_text().splitlines()[0]
    assert header.startswith("speed [rad/s],mode 1 backward damped frequency [rad/s],mode 1 damping ratio [1],mode 1 log decrement [1]")


def test_set_reaches_the_scene(scene: str, tmp_path: Path) -> None:
    for settings in (("--set", "diameter=0.03"), ("--set", "shaft.diameter=30 mm")):
        call("campbell", scene, "--speeds", "0:100:3", "--count", "2", *settings, "--json", str(tmp_path / "c.json"))
        thick = json.loads((tmp_path / "c.json").read_text())["branches"][0]["frequency"][0]
        thin = hm.whirl_modes(overhung_disc()).frequencies[0]
        # massless shaft: stiffness goes with d^4
        assert thick == pytest.approx(thin * (0.03 / 0.02) ** 2, rel=1e-9)


def test_modes_of_a_rotor_line_are_its_whirl_modes(scene: str, tmp_path: Path) -> None:
    printed = call("modes", scene, "--speed", "100", "--count", "3", "--out", str(tmp_path / "m"), "--json", str(tmp_path / "m.json"))
    written = json.loads((tmp_path / "m.json").read_text())
    assert [mode["whirl"] for mode in written["modes"]][:2] == ["backward", "forward"]
    # closed form, see test_published_rotors
    assert [mode["frequency"] for mode in written["modes"]][:2] == pytest.approx([115.4136, 126.4118], abs=6e-5)
    assert set(written["modes"][0]) == {"whirl", "frequency", "natural", "damping_ratio", "log_decrement"}
    assert "115.414" in printed
    for name in ("modes.png", "modes.svg", "modes.csv", "modes.npz"):
        assert (tmp_path / "m" / name).stat().st_size > 200, name


@pytest.mark.parametrize(
    ("text", "speeds"),
    [
        ("0:1000:101", np.linspace(0.0, 1000.0, 101)),
        ("0:12000:5 rpm", np.linspace(0.0, 12000.0, 5) * math.pi / 30.0),
        ("0 rpm:6000 rpm:3", np.linspace(0.0, 6000.0, 3) * math.pi / 30.0),
        ("-50:50:3", np.array([-50.0, 0.0, 50.0])),
        ("100, 200,400", np.array([100.0, 200.0, 400.0])),
        ("600 rpm,1200 rpm", np.array([600.0, 1200.0]) * math.pi / 30.0),
    ],
)
def test_speeds_can_be_written_as_a_range_a_list_and_with_units(text: str, speeds: np.ndarray) -> None:
    np.testing.assert_allclose(parse_speeds("--speeds", text), speeds, rtol=1e-12)


def test_orders_can_be_written_for_the_reference_shaft_and_for_places() -> None:
    assert parse_orders("--orders", "1,2.5") == (1.0, 2.5)
    assert parse_orders("--orders", "rotor_1=1,2; gear=4") == {"rotor_1": (1.0, 2.0), "gear": (4.0,)}


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--speeds", "1000:0:101"), "0 rad/s is not above 1000 rad/s"),
        (("--speeds", "0:1000"), "write FIRST:LAST:COUNT"),
        (("--speeds", "0:1000:1"), "write at least 2"),
        (("--speeds", "0:fast:11"), "write FIRST:LAST:COUNT"),
        (("--speeds", "0:1000:11 Hz"), "differ by 2 pi"),
        (("--speeds", "0:1000:11 mm"), "does not fit"),
        (("--speeds", "200,100"), "must increase, but 100 rad/s follows 200 rad/s"),
        (("--orders", "one"), "write numbers with commas"),
        (("--orders", "0"), "each must be a number greater than 0"),
        (("--orders", "disk=1"), "No place 'disk'"),
        (("--count", "0"), "count = 0"),
    ],
)
def test_a_bad_option_is_refused_in_one_line(scene: str, arguments: tuple[str, ...], message: str) -> None:
    with pytest.raises(HdriveError, match=message) as caught:
        CliRunner().invoke(app, ["campbell", scene, *arguments], catch_exceptions=False)
    assert "\n" not in str(caught.value)


# -- pictures ---------------------------------------------------------------------------------------------


@functools.cache
def diagram() -> hm.WhirlCampbell:
    return hm.campbell(build(), np.linspace(0.0, 1200.0, 25), orders=(1, 2))


def figure_of(ax: Axes) -> Figure:
    figure = ax.figure.figure
    assert isinstance(figure, Figure)
    return figure


def axis_labels(ax: Axes) -> list[str]:
    every = [*figure_of(ax).axes, *(child for one in figure_of(ax).axes for child in one.child_axes)]
    return [label for one in every for label in (one.get_xlabel(), one.get_ylabel()) if label]


PICTURES: dict[str, Any] = {
    "diagram": diagram,
    "unstable": lambda: hm.campbell(internally_damped(), np.linspace(0.0, 1600.0, 9), count=4),
    "unstable everywhere": lambda: hm.campbell(jeffcott(1e4), [0.0, 100.0], count=3),
    "undamped": lambda: hm.campbell(two_discs(kx=1e6), np.linspace(0.0, 600.0, 7)),
    "modes": lambda: hm.whirl_modes(build(), 300.0),
    "modes of a train": lambda: hm.whirl_modes(chain([0.5, 1.5, 0.25], [200.0, 900.0])),
}


@pytest.mark.parametrize("name", PICTURES)
def test_every_picture_names_its_axes_with_units_and_is_not_cut_off(name: str) -> None:
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    ax = hm.plot(PICTURES[name]())
    labels = axis_labels(ax)
    assert labels
    for label in labels:
        quantity, _, unit = label.partition("[")
        assert len(quantity.strip()) > 2
        assert unit.endswith("]"), label
    if "modes" in name:
        assert "0-peak" in ax.get_ylabel()
    canvas = FigureCanvasAgg(figure_of(ax))
    canvas.draw()
    width, height = canvas.get_width_height()
    for one in figure_of(ax).axes:
        for text in (one.title, one._left_title, one.xaxis.label, one.yaxis.label):  # type: ignore[attr-defined]
            if text.get_text().strip():
                box = text.get_window_extent(canvas.get_renderer())
                assert box.x0 > -2.0, text.get_text()
                assert box.x1 < width + 2.0, text.get_text()
                assert box.y0 > -2.0, text.get_text()
                assert box.y1 < height + 2.0, text.get_text()


def test_titles_of_panels_do_not_run_into_each_other() -> None:
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    figure = figure_of(hm.plot(hm.whirl_modes(build(), 400.0)))
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    boxes = [one._left_title.get_window_extent(canvas.get_renderer()) for one in figure.axes]  # type: ignore[attr-defined]
    for left, right in pairwise(boxes):
        assert left.x1 < right.x0 or abs(left.y0 - right.y0) > 20.0


def test_the_diagram_has_each_branch_below_its_top_the_orders_and_the_criticals() -> None:
    result = diagram()
    ax = hm.plot(result)
    curves = [line for line in ax.lines if len(line.get_xdata()) == len(result.speeds)]
    top = ax.get_ylim()[1]
    drawn = [np.asarray(line.get_ydata(), float) for line in curves]
    for k in range(len(result.whirl)):
        if np.nanmin(result.frequencies[:, k]) < top:
            assert any(np.allclose(values, result.frequencies[:, k]) for values in drawn)
    for slope in result.order_slopes:
        assert any(np.allclose(values, slope * result.speeds) for values in drawn)
    rings = {(float(line.get_xdata()[0]), float(line.get_ydata()[0])) for line in ax.lines if len(line.get_xdata()) == 1}
    expected = {
        (float(speed), result.order_slopes[order] * float(speed))
        for speed, order in zip(result.critical_speeds, result.critical_orders, strict=True)
        if result.order_slopes[order] * speed <= top
    }
    assert rings == expected
    words = {text.get_text() for text in figure_of(ax).legends[0].get_texts()}
    assert {"forward", "backward", "torsional", "critical speed [rad/s]", "hardly excited"} <= words


def test_speeds_at_which_a_motion_grows_are_shaded_from_the_threshold_on() -> None:
    result = PICTURES["unstable"]()
    ax = hm.plot(result)
    spans = [patch.get_extents() for patch in ax.patches]
    edges = [ax.transData.inverted().transform((box.x0, box.y0))[0] for box in spans]
    assert min(edges) == pytest.approx(result.threshold_speeds[0], rel=1e-6)


def test_a_diagram_and_a_shape_can_be_drawn_on_given_axes() -> None:
    ax = Figure().add_subplot()
    assert hm.plot(diagram(), ax=ax, highest=500.0) is ax
    assert ax.get_ylim() == (0.0, 500.0)
    other = Figure().add_subplot()
    assert hm.plot(hm.whirl_modes(overhung_disc(), 50.0), ax=other, mode=2) is other
    with pytest.raises(AnalysisError, match="mode = 9: this result has the modes 1 to"):
        hm.plot(hm.whirl_modes(overhung_disc(), 50.0, count=3), ax=Figure().add_subplot(), mode=9)


def test_speeds_that_cannot_be_read_name_the_option() -> None:
    with pytest.raises(ParameterError, match="--speeds 'nan:1:3'"):
        parse_speeds("--speeds", "nan:1:3")

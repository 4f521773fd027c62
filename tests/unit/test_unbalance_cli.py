"""``hdrive-mbs unbalance`` and the pictures of unbalance response, critical speed map and static deflection."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import hdrive_mbs as hm
from hdrive_mbs.cli.main import app
from hdrive_mbs.errors import ParameterError, PlaceError
from models.two_rotor_line import build
from tests.patience import PATIENCE

LINE = str(Path(__file__).parents[2] / "models" / "two_rotor_line.py")


def call(*arguments: str) -> str:
    done = CliRunner().invoke(app, ["unbalance", LINE, *arguments], catch_exceptions=False)
    assert done.exit_code == 0, done.output
    return done.output


def test_json_equals_the_api(tmp_path: Path) -> None:
    call("--speeds", "100:1000:31", "--places", "rotor_1, rotor_2", "--set", "variant=damped_bearings", "--json", str(tmp_path / "u.json"))
    written = json.loads((tmp_path / "u.json").read_text())
    result = hm.unbalance_response(build(variant="damped_bearings"), np.linspace(100.0, 1000.0, 31))
    assert written["speeds"] == pytest.approx(result.speeds.tolist())
    assert list(written["places"]) == ["rotor_1", "rotor_2"]
    for place, values in written["places"].items():
        one = result[place]
        for key in ("major", "minor", "inclination", "forward", "backward"):
            assert values[key] == pytest.approx(getattr(one, key).tolist(), rel=1e-12), key
        assert values["x"]["amplitude"] == pytest.approx(np.abs(one.x).tolist(), rel=1e-12)
        assert values["y"]["phase_lag"] == pytest.approx(one.phase_lag_y.tolist(), rel=1e-12)
    assert written["bearing_forces"]["bearing_a"]["major"] == pytest.approx(result.force("bearing_a").major.tolist(), rel=1e-12)
    expected = [peak for peak in result.peaks if peak.place in ("rotor_1", "rotor_2")]
    assert [(peak["place"], peak["speed"]) for peak in written["peaks"]] == [(peak.place, pytest.approx(peak.speed)) for peak in expected]
    assert written["status"] == result.status == "complete"
    assert written["frequency_ratio"] == 1.0


def test_out_writes_result_table_and_a_picture_of_each_view(tmp_path: Path) -> None:
    output = call("--speeds", "300:450:31", "--out", str(tmp_path), "--set", "rotor_2.eccentricity=10 um")
    assert "peaks of the unbalance response" in output
    assert "rotor_1" in output
    result = hm.load(tmp_path / "unbalance.npz")
    assert result.settings["speeds"] == "300 .. 450 rad/s, 31 points"
    assert (tmp_path / "unbalance.csv").read_text().startswith("speed [rad/s],")
    for view in ("bode", "polar", "orbits", "forces"):
        for kind in ("png", "svg"):
            assert (tmp_path / f"unbalance_{view}.{kind}").stat().st_size > 5000


def test_a_trial_mass_is_given_with_its_angle(tmp_path: Path) -> None:
    call("--speeds", "300:400:3", "--extra", "rotor_2=2e-5@0.5", "--extra", "drive_disc=1e-6", "--json", str(tmp_path / "u.json"))
    written = json.loads((tmp_path / "u.json").read_text())
    result = hm.unbalance_response(build(), [300.0, 350.0, 400.0], extra={"rotor_2": (2e-5, 0.5), "drive_disc": (1e-6, 0.0)})
    assert written["places"]["rotor_2"]["major"] == pytest.approx(result["rotor_2"].major.tolist(), rel=1e-12)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--speeds", "1000:0:11"], "0 rad/s is not above 1000 rad/s"),
        (["--speeds", "0-1000"], "write FIRST:LAST:COUNT in rad/s"),
        (["--speeds", "0:1000"], "write FIRST:LAST:COUNT in rad/s"),
        (["--speeds", "0:1000:1"], "write at least 2"),
        (["--speeds", "0:1000:11:7"], "write FIRST:LAST:COUNT in rad/s"),
        (["--extra", "rotor_2:1e-5"], "write PLACE=KG_M@RAD"),
    ],
)
def test_wrong_options_are_refused_in_one_line(arguments: list[str], message: str) -> None:
    with pytest.raises(ParameterError, match=message) as caught:
        call(*arguments)
    assert "\n" not in str(caught.value)


def test_speeds_may_be_given_in_rpm_as_for_campbell(tmp_path: Path) -> None:
    call("--speeds", "3000:6000:4 rpm", "--json", str(tmp_path / "u.json"))
    written = json.loads((tmp_path / "u.json").read_text())
    assert written["speeds"] == pytest.approx([rpm * np.pi / 30.0 for rpm in (3000.0, 4000.0, 5000.0, 6000.0)])


def test_an_unknown_place_is_named() -> None:
    with pytest.raises(PlaceError, match="No place 'rotor_3'"):
        call("--speeds", "300:400:3", "--places", "rotor_3")


def test_a_foreseen_error_ends_with_exit_code_2_and_one_line() -> None:
    code = "import sys; from hdrive_mbs.cli.main import main; main()"
    arguments = [sys.executable, "-c", code, "unbalance", LINE, "--speeds", "9:1:3"]
    done = subprocess.run(arguments, capture_output=True, text=True, timeout=PATIENCE)
    assert done.returncode == 2
    assert done.stderr.startswith("error: --speeds '9:1:3'")
    assert "Traceback" not in done.stderr


# -- pictures ----------------------------------------------------------------------------------------
def test_bode_shows_amplitudes_0_peak_and_lags_of_what_was_calculated() -> None:
    result = hm.unbalance_response(build(), np.linspace(0.0, 1000.0, 101))
    smooth = result.refined()
    upper = hm.plot(result, places=["rotor_1"])
    # 1.3 mm at 370 rad/s
    assert upper.get_ylabel() == "major semi-axis, 0-peak [mm]"
    factor = 1e3
    curve = next(line for line in upper.lines if line.get_label() == "rotor 1")
    np.testing.assert_allclose(curve.get_ydata(), factor * smooth["rotor_1"].major)
    assert set(result.speeds) < set(np.asarray(curve.get_xdata()).tolist())
    # the ring of the peak is on the curve
    assert np.max(curve.get_ydata()) == pytest.approx(factor * max(p.amplitude for p in result.peaks if p.place == "rotor_1"), rel=1e-6)
    lower = upper.figure.axes[1]
    assert lower.get_ylabel() == "lag of x [degrees]"
    shown = np.asarray(lower.lines[0].get_ydata(), float)
    assert np.isnan(shown[0]), "at rest there is no phase"
    np.testing.assert_allclose(shown[1:], np.degrees(smooth["rotor_1"].phase_lag_x[1:]))


def test_polar_and_orbits_and_forces_show_what_was_calculated() -> None:
    result = hm.unbalance_response(build(), np.linspace(0.0, 1000.0, 101))
    polar = hm.plot(result, view="polar", places=["rotor_2"])
    assert "Re x, 0-peak [µm]" in polar.get_xlabel()
    smooth = result.refined()
    np.testing.assert_allclose(polar.lines[0].get_ydata(), 1e6 * smooth["rotor_2"].x.imag)
    z = np.asarray(polar.lines[0].get_xydata()) @ [1.0, 1j]
    piece = np.diff(z)[np.abs(np.diff(z)) > 0.01 * np.abs(z).max()]
    assert np.max(np.abs(np.angle(piece[1:] / piece[:-1]))) < np.radians(10.0), "10 rad/s between the speeds asked for made a polygon"
    orbits = hm.plot(result, view="orbits", places=["rotor_2"], speeds=[201.0, 396.0])
    panels = orbits.figure.axes
    assert [panel.get_title(loc="left") for panel in panels] == ["200 rad/s", "400 rad/s"]
    x, y = (np.asarray(data, float) for data in panels[0].lines[0].get_data())
    assert np.hypot(x, y).max() == pytest.approx(1e6 * result["rotor_2"].major[20], rel=1e-3)
    forces = hm.plot(result, view="forces", logarithmic=True)
    assert forces.get_ylabel() == "force on the housing, major semi-axis, 0-peak [N]"
    assert forces.get_yscale() == "log"
    np.testing.assert_allclose(forces.lines[1].get_ydata(), smooth.force("bearing_b").major)
    at_peaks = hm.plot(result, view="orbits", places=["rotor_1"]).figure.axes[0]
    assert at_peaks.get_title(loc="left") == "370.6 rad/s", "the peak itself, not the nearest of the speeds asked for"
    with pytest.raises(ParameterError, match="view = 'nyquist': must be one of bode, polar, orbits, forces"):
        hm.plot(result, view="nyquist")
    with pytest.raises(PlaceError, match="No place 'rotor_3'"):
        hm.plot(result, places=["rotor_3"])


def test_a_critical_speed_map_has_logarithmic_scales_and_marks_where_a_bearing_meets_it(tmp_path: Path) -> None:
    result = hm.critical_speed_map(build(), np.geomspace(1e5, 1e9, 17), count=2)
    curve = ([50.0, 5000.0], [1e6, 1e8])
    ax = hm.plot(result, curves={"bearing_a": curve})
    assert (ax.get_xscale(), ax.get_yscale()) == ("log", "log")
    assert ax.get_ylabel() == "undamped critical speed [rad/s]"
    marks = [float(np.asarray(line.get_ydata())[0]) for line in ax.lines if line.get_marker() == "o"]
    assert marks == [crossing.speed for crossing in result.crossings(*curve)]
    assert len(marks) > 1
    for path in hm.save_figure(ax, tmp_path / "map"):
        assert path.stat().st_size > 5000


def test_a_static_deflection_is_drawn_through_its_places(tmp_path: Path) -> None:
    scene = build()
    scene = hm.Scene(name="heavy", parts={**scene.parts, "gravity": hm.Gravity()}, connections=scene.connections)
    result = hm.static_deflection(scene)
    ax = hm.plot(result)
    curve = next(line for line in ax.lines if line.get_label() == "y of the shaft")
    z, y = (np.asarray(data, float) for data in curve.get_data())
    for place in ("drive_disc", "bearing_a", "rotor_1", "bearing_b", "rotor_2"):
        # cubics through values and slopes of the places; 400 points of straight lines between
        assert np.interp(result[place]["z"], z, y) == pytest.approx(1e6 * result[place]["y"], abs=0.01)
    texts = [text.get_text() for text in ax.texts]
    assert any(text.startswith("bearing a") and f"{result.bearing_load('bearing_a')[1]:.4g} N" in text for text in texts)
    for path in hm.save_figure(ax, tmp_path / "static"):
        assert path.stat().st_size > 5000


def test_speeds_without_a_peak_are_said_to_have_none() -> None:
    assert "no peak of the unbalance response from 10 to 30 rad/s" in " ".join(call("--speeds", "10:30:5").split())

"""What a user sees of an object: one screen, not all its numbers; and what help() says about its fields."""

from __future__ import annotations

import inspect
import json
import pickle
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import hdrive_mbs as hm
from hdrive_mbs.cli.main import app
from models.harmonic_drive_train import build
from models.jeffcott import build as jeffcott
from models.two_rotor_line import build as rotor_line


def results() -> list[hm.Result]:
    response = hm.simulate(build(), 0.05)
    return [
        response,
        hm.start_up(build(), 0.05),
        hm.modes(build(), torque=50.0),
        hm.torsion(build()),
        hm.torsional_campbell(build(), np.linspace(5.0, 160.0, 5), torque=50.0),
        hm.energy_balance(response),
        hm.spectrum(response, "gear.torque"),
        hm.reduce(build()),
    ]


def test_a_result_is_shown_in_one_line_and_printed_with_its_figures() -> None:
    for result in results():
        head = f"{type(result).__name__} of 'harmonic drive train': {result.status}"
        assert repr(result) == f"{head} (print it to see its figures)"
        assert str(result).splitlines()[0] == head


def line_results() -> list[hm.Result]:
    line = rotor_line()
    run = hm.run_up(line, 0.4, sample_step=1e-3)
    return [
        hm.campbell(line, np.linspace(0.0, 1000.0, 5)),
        hm.static_deflection(line),
        hm.critical_speed_map(line, np.geomspace(1e6, 1e9, 30)),
        hm.orbit(run, "rotor_1", start=0.1),
        hm.order_tracking(run, "rotor_1"),
        hm.waterfall(run, "rotor_1", start=0.2),
        hm.spectrogram(run, "rotor_1"),
        hm.order_spectrum(hm.simulate(build(), 0.3), "gear.torque", against="motor"),
    ]


def test_every_result_prints_tables_whose_figures_have_units() -> None:
    # heads of what has no unit, or names it in its row
    bare = {"mode", "whirl", "order", "note", "of", "damping ratio", "log decrement", "value", "min", "max", "mean", "final"}
    for result in [*results(), *line_results()]:
        assert result.tables(), type(result).__name__
        for table in result.tables():
            assert all(len(row) == len(table.heads) for row in table.rows)
            for k, head in enumerate(table.heads):
                numbers = any(isinstance(row[k], float) for row in table.rows)
                assert not numbers or "[" in head or "order of" in head or head in bare, (type(result).__name__, head)
        assert len(str(result).splitlines()) < 70


def test_printed_figures_are_those_of_the_result() -> None:
    line, train = rotor_line(), build()
    found = hm.campbell(line, np.linspace(0.0, 1000.0, 5))
    criticals = found.tables()[1]
    assert criticals.title == "critical speeds"
    assert [row[0] for row in criticals.rows] == found.critical_speeds.tolist()
    assert [row[4] for row in criticals.rows] == list(found.critical_whirl)
    torsional = hm.torsional_campbell(train, np.linspace(5.0, 160.0, 5), torque=50.0)
    assert torsional.tables()[1].rows == ((float(torsional.critical_speeds[0]), "2 x motor", "1"),)
    curve = hm.torsion(train)
    assert f"lost motion {curve.lost_motion:.6g} rad" in str(curve)
    for row in (0, -1):
        assert curve.tables()[0].rows[row][:2] == (float(curve.torque[row]), float(curve.angle[row]))
    assert f"21 of {len(curve.torque)} rows" in str(curve)
    reduction = hm.reduce(train)
    assert [row[2] for row in reduction.tables()[1].rows] == pytest.approx([100.0 * share for share in reduction.shares.values()])
    balance = hm.energy_balance(hm.simulate(train, 0.05))
    gear = next(row for row in balance.tables()[0].rows if row[0] == "gear")
    assert gear[2] == balance.work["gear"][-1]
    spectrum = hm.spectrum(hm.simulate(train, 0.3), "gear.torque")
    assert spectrum.tables()[0].rows[0][0] == spectrum.peaks()[0].frequency


@dataclass(frozen=True, kw_only=True, eq=False)
class Own(hm.Result):
    many: np.ndarray
    few: float


def test_a_result_without_tables_prints_every_field_in_short_lines() -> None:
    result = Own(scene=build(), status="complete", settings={}, many=np.linspace(-1.0, 2.0, 100), few=0.25)
    assert str(result).splitlines() == ["Own of 'harmonic drive train': complete", "  many  100 values, -1 to 2", "  few   0.25"]


def test_a_printed_response_has_a_line_with_units_for_each_speed_torque_and_twist() -> None:
    response = hm.simulate(build(), 0.05, estimate_error=True)
    text = str(response)
    summary = response["gear.torque"].summary()
    figures = [f"{summary[name]:.6g}" for name in ("min", "max", "mean", "final")]
    assert ["gear.torque", "[N", "m]", *figures] in [line.split() for line in text.splitlines()]
    assert "% of the largest value" in text.splitlines()[-1]
    assert not any(word in text for word in ("lowering", "slopes", "docs"))


def test_a_printed_start_up_has_its_figures_with_units() -> None:
    start = hm.start_up(build(), 0.05)
    lines = [line.split() for line in str(start).splitlines()]
    assert ["final", "speed", "of", "motor", "[rad/s]", f"{start.final_speed:.6g}"] in lines
    assert any(line[:2] == ["gear", f"{start.peak_torque['gear']:.6g}"] for line in lines)


def test_a_printed_run_up_says_its_peaks_in_micrometres_and_their_error_in_percent() -> None:
    run = hm.run_up(jeffcott(), 0.2, estimate_error=True, accuracy=1e-2)
    lines = str(run).splitlines()
    assert "peak of C, 0-peak [um]" in lines[1]
    assert lines[1].endswith("estimated error of the peak of C [%]")
    (row,) = [line.split() for line in lines if line.startswith("disc")]
    assert row[1] == f"{1e6 * run.peak_amplitude['disc']:.6g}"
    assert row[-1] == f"{100.0 * run.peak_error['disc']:.6g}"


def test_printed_modes_and_peaks_are_the_tables_of_the_command_line() -> None:
    line = rotor_line()
    for result, arguments in (
        (hm.modes(build()), ("modes", "models/harmonic_drive_train.py")),
        (hm.whirl_modes(line, 300.0), ("modes", "models/two_rotor_line.py", "--speed", "300")),
        (hm.unbalance_response(line, np.linspace(200.0, 400.0, 21)), ("unbalance", "models/two_rotor_line.py", "--speeds", "200:400:21")),
    ):
        done = CliRunner().invoke(app, arguments)
        assert done.exit_code == 0, done.output
        drawn = [[word for word in line.split() if word not in "│┃"] for line in done.output.splitlines()]
        first = result.tables()[0].rows[0]
        numbers = [f"{item:.6g}" for item in first if isinstance(item, float)]
        assert any(all(number in words for number in numbers) for words in drawn), done.output
        assert any(all(number in row.split() for number in numbers) for row in str(result).splitlines())


def test_a_printed_history_shows_span_and_range() -> None:
    history = hm.TimeHistory("a", "N m", np.array([0.0, 1.0, 2.0]), np.array([5.0, -1.0, 0.5]))
    assert repr(history) == "TimeHistory 'a' [N m]: 3 values from 0 s to 2 s, -1 to 5 N m"


def test_every_figure_of_a_summary_is_printed_with_its_unit() -> None:
    history = hm.TimeHistory("a", "N m", np.array([0.0, 1.0, 2.0]), np.array([4.0, 4.0, -2.0]))
    # mean: (4 + 1)/2, rms: sqrt((16 + 10)/2), by trapezoids
    assert repr(history.summary()) == "min -2 N m, max 4 N m, mean 2.5 N m, rms 3.60555 N m, final -2 N m"
    assert str(hm.TimeHistory("a", "1", history.times, history.values).summary()).startswith("min -2, max 4,")
    response = hm.simulate(build(), 0.05)
    lines = str(response.summary()).splitlines()
    assert [line.split()[0] for line in lines] == list(response.channels)
    for line, unit in zip(lines, response.units.values(), strict=True):
        assert line.count(f" {unit}, ") == 4
        assert line.endswith(f" {unit}")


def test_a_summary_is_a_dict_of_numbers_still() -> None:
    response = hm.simulate(build(), 0.05)
    summary = response.summary()
    assert json.loads(json.dumps(summary)) == summary
    copied = pickle.loads(pickle.dumps(summary))
    assert (copied, repr(copied)) == (summary, repr(summary))
    assert summary["gear.torque"]["max"] == response["gear.torque"].values.max()


def test_help_lists_the_fields_with_unit_meaning_range_and_default() -> None:
    text = inspect.getdoc(hm.Motor) or ""
    assert "inertia [kg m^2] : rotor inertia J_s, above 0" in text
    assert "viscous [N m s/rad] : viscous drag on the absolute speed, at least 0, default 0" in text
    assert "characteristic : torque law" in text


def test_help_of_a_subclass_lists_inherited_fields_once() -> None:
    @dataclass(frozen=True, kw_only=True)
    class WornMotor(hm.Motor):
        """A motor with play."""

        play: float = hm.parameter("rad", "play of the bearing", default=0.01, low=0.0)

    text = inspect.getdoc(WornMotor) or ""
    assert text.startswith("A motor with play.\n\nFields")
    assert text.count("Fields") == 1
    assert "play [rad] : play of the bearing, at least 0, default 0.01" in text
    assert text.count("    inertia [kg m^2]") == 1


SCENE = """
import hdrive_mbs as hm
from own_drag import OwnDrag
from models.harmonic_drive_train import build
from models.jeffcott import build as jeffcott
from models.two_rotor_line import build as rotor_line
"""
DRAG = '''
from dataclasses import dataclass
from typing import ClassVar
import hdrive_mbs as hm


@dataclass(frozen=True, kw_only=True)
class OwnDrag(hm.TorqueEffect):
    """tau = -a w."""

    scale: float = hm.parameter("N m s/rad", "a", low=0.0)
    dissipative: ClassVar[bool] = True
    signature: ClassVar[str] = "drag in proportion to speed"

    def torque(self, time, angle, speed):
        return -self.scale * speed
'''


def test_a_scene_may_import_an_effect_that_lies_beside_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.path", list(__import__("sys").path))
    (tmp_path / "scene.py").write_text(SCENE)
    (tmp_path / "own_drag.py").write_text(DRAG)
    scene = str(tmp_path / "scene.py")
    done = CliRunner().invoke(app, ["modes", scene, "--effect", "OwnDrag@motor:scale=1e-3"], catch_exceptions=False)
    assert done.exit_code == 0
    wrong = CliRunner().invoke(app, ["modes", scene, "--effect", "OwnDrag@motor:signature=x"])
    assert str(wrong.exception) == "No field 'signature'. OwnDrag has: scale."


def test_a_scene_file_with_an_unknown_class_says_how_to_make_it_known(tmp_path: Path) -> None:
    path = hm.save_scene(build(), tmp_path / "a.toml")
    path.write_text(path.read_text().replace('type = "Motor"', 'type = "MyMotor"'))
    with pytest.raises(hm.PlaceError, match=r"No type 'MyMotor'.*import its module first, or use load_scene\(path, types="):
        hm.load_scene(path)


def test_a_number_in_place_of_teeth_is_refused() -> None:
    with pytest.raises(hm.ParameterError, match=r"HarmonicDrive\.teeth = 3\.0: must be a gear geometry"):
        build().replacing({"gear.teeth": 3.0})


def test_a_printed_rotor_line_is_a_table_for_each_kind_of_part_with_all_that_is_not_a_default() -> None:
    line = rotor_line()
    text = str(line)
    rows = text.splitlines()
    assert len(text) < 3000
    assert all(len(row) < 125 for row in rows)
    # what all sections have in common stands once, what differs in a column
    assert sum("diameter 0.022 m" in row for row in rows) == 1
    head = next(k for k, row in enumerate(rows) if row.split() == ["length", "[m]"])
    assert [row.split() for row in rows[head + 1 : head + 5]] == [
        [f"section_{k}", length] for k, length in zip("1234", ("0.06", "0.25", "0.25", "0.07"))
    ]
    assert "bore" not in text, "a default"
    # every number that is no default can be read from it
    for item in line.parameters().values():
        name, _, path = item.path.partition(".")
        owner, field = line.parts[name], path
        while "." in field:
            inner, _, field = field.partition(".")
            owner = getattr(owner, inner)
        default = type(owner).__dataclass_fields__[field].default
        if item.value != default:
            assert path in text, item.path
            assert f"{item.value:.6g}" in text, item.path

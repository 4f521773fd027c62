"""Errors of the library name options on the command line, not arguments in Python."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from hdrive_mbs.cli.main import main
from hdrive_mbs.cli.records_options import reading_of
from hdrive_mbs.cli.wording import on_command_line
from hdrive_mbs.errors import FileFormatError


@pytest.mark.parametrize(
    ("python", "words"),
    [
        ("the time 'time' has no unit; give it with units={'time': 's'}.", "the time 'time' has no unit; give it with --unit time=s."),
        ("Give it with units={'a': '...', 'my b': '...'}, '1'", "Give it with --unit a=UNIT --unit 'my b=UNIT', '1'"),
        ("Give it with units={'a': '...', ...}, '1'", "Give it with --unit a=UNIT ..., '1'"),
        ("Correct the unit when reading: units={'arm_angle': ...}.", "Correct the unit when reading: --unit arm_angle=UNIT."),
        (
            "gaps='interpolate' fills short ones, record.between(start, end) takes a part",
            "--repair gaps=interpolate fills short ones, (in Python: record.between(start, end)) takes a part",
        ),
        ("use repaired(record, order='sort', duplicates='first').", "use --repair order=sort --repair duplicates=first."),
        ("gaps='keep', or longest=40.", "--repair gaps=keep, or --repair longest=40."),
        (
            "e.g. read_record(path, channels={'my column': 'motor.speed'}).",
            "e.g. --channel 'my column=motor.speed'.",
        ),
        ("Leave it out (record.without('x')), or record longer.", "Leave it out (in Python: record.without('x')), or record longer."),
        ("Name it with time='...', or give the step, time=2e-4 (s); a", "Name it with --time COLUMN, or give the step, --time '5 kHz'; a"),
        ("No place 'gaer'. This scene has: motor, gear.", "No place 'gaer'. This scene has: motor, gear."),
    ],
)
def test_arguments_become_options(python: str, words: str) -> None:
    assert on_command_line(python) == words


def test_an_error_of_the_reader_names_the_option(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "a.csv").write_text("time,angle [rad]\n" + "".join(f"{0.001 * k:.3f},{k}\n" for k in range(80)))
    (tmp_path / "scene.py").write_text("from models.drive_bench import build\n")
    monkeypatch.setattr(sys, "argv", ["hdrive-mbs", "diagnose", str(tmp_path / "scene.py"), "--records", str(tmp_path / "a.csv")])
    with pytest.raises(SystemExit):
        main()
    said = capsys.readouterr().err
    assert "--unit time=s" in said
    assert "units=" not in said


def test_the_longest_run_that_is_bridged_can_be_given_on_the_command_line() -> None:
    assert reading_of(None, None, None, ["gaps=interpolate", "longest=40"])["repair"] == {"gaps": "interpolate", "longest": 40}
    with pytest.raises(FileFormatError, match="longest=ten: write a number of samples"):
        reading_of(None, None, None, ["longest=ten"])

"""What was done to the records of a diagnosis, and what was found in them, stands in its answer."""

from __future__ import annotations

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.diagnosis import verify
from hdrive_mbs.diagnosis.diagnose import diagnose
from hdrive_mbs.diagnosis.record_words import record_words
from hdrive_mbs.effects.sensor_gain import SensorGain
from hdrive_mbs.records.measurement import Measurement
from hdrive_mbs.records.record import Record
from hdrive_mbs.records.repair import repaired as repaired_record
from tests.unit.diagnosis_cases import bench, quiet, records


def with_hole(record: Record) -> Record:
    values = record.channels["load_angle"].values.copy()
    values[300:310] = np.nan
    channels = {**record.channels, "load_angle": Measurement(name="load_angle", unit="rad", values=values)}
    return record.replacing(channels=channels)


def test_repairs_are_warnings_and_findings_notes() -> None:
    repaired = repaired_record(with_hole(quiet()[0]), not_finite="interpolate")
    constant = Measurement(name="spare", unit="V", values=np.full(len(repaired), 1.5))
    changed, left = record_words([repaired.replacing(channels={**repaired.channels, "spare": constant})])
    [text] = changed
    assert text.startswith("Record 'staircase', repaired: not_finite load_angle")
    assert "10" in text
    assert any(item.startswith("Record 'staircase', reported: constant spare") for item in left)


def test_the_report_of_a_diagnosis_says_what_was_filled() -> None:
    repaired = repaired_record(with_hole(quiet()[0]), not_finite="interpolate")
    found = diagnose(bench(), (repaired, quiet()[1]), candidates=SensorGain, pictures=False)
    assert any("repaired: not_finite load_angle" in item for item in found.warnings)
    assert "repaired: not_finite" in " ".join(str(found).split())


@pytest.mark.parametrize("difference", [0.1, 7.0])
def test_winner_and_runner_up_are_held_against_the_engine(difference: float, monkeypatch: pytest.MonkeyPatch) -> None:
    asked = []

    def compared(simulator: object, fitted: object) -> float:
        asked.append(fitted)
        return difference

    monkeypatch.setattr(verify, "engine_difference", compared)
    cause = SensorGain(error=0.01), "load_encoder"
    found = diagnose(bench(), records(cause), candidates=SensorGain, pictures=False)
    assert len({id(item) for item in asked}) == 2
    said = [text for text in (*found.warnings, *found.notes) if "Search and multibody engine" in text]
    assert len(said) == 2
    assert "sensor_gain at load_encoder" in said[0].replace("SensorGain", "sensor_gain")
    assert all(("DIFFER" in text) == (difference > 1.0) for text in said)
    assert (said[0] in found.warnings) == (difference > 1.0)


def test_what_the_engine_cannot_run_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(simulator: object, fitted: object) -> float:
        raise hm.SimulationError("no")

    monkeypatch.setattr(verify, "engine_difference", refused)
    found = diagnose(bench(), quiet(), candidates=SensorGain, pictures=False)
    assert sum(text.startswith("Not verified on the engine") for text in found.notes) == 2

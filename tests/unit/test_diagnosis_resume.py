"""A diagnosis that is interrupted goes on where it was; its worker processes end with it."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from functools import partial
from multiprocessing import active_children
from pathlib import Path

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.compiled import threads
from hdrive_mbs.diagnosis import gather
from hdrive_mbs.diagnosis.digest import digest
from hdrive_mbs.diagnosis.hypothesis import Added, Hypothesis
from hdrive_mbs.diagnosis.journal import Journal
from hdrive_mbs.diagnosis.locate.latent_force import LatentForce, TurnedForce
from hdrive_mbs.diagnosis.located import Located
from hdrive_mbs.diagnosis.packing import packed, unpacked
from hdrive_mbs.diagnosis.prepared import factors_of
from hdrive_mbs.diagnosis.refusals import refuse, refused_words
from hdrive_mbs.diagnosis.result import Diagnosis, Place
from hdrive_mbs.diagnosis.screening import Look, Screen
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.team import Team
from hdrive_mbs.diagnosis.trial import Trial
from hdrive_mbs.diagnosis.unknowns import Factor
from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.effects.viscous_drag import ViscousDrag
from tests.patience import PATIENCE
from tests.unit import diagnosis_job as job
from tests.unit.diagnosis_cases import bench, quiet, records

HERE = Path(__file__).parent

OWN = """
from dataclasses import dataclass
from typing import ClassVar
import numpy as np
from hdrive_mbs.effects.effect import TorqueEffect
from hdrive_mbs.quantities import parameter

@dataclass(frozen=True, kw_only=True)
class Own(TorqueEffect):
    '''A drag that grows with the square root of the speed.'''
    family: ClassVar[str] = "own_drag"
    size: float = parameter("N m", "drag at 1 rad/s", low=0.0, typical=(1e-3, 10.0))

    def torque(self, time, angle, speed):
        return -self.size * np.tanh(speed) * np.sqrt(1.0 + np.abs(speed))
"""


def started(folder: Path, *arguments: str) -> subprocess.Popen[str]:
    """The small diagnosis as a process of its own, in a group of its own."""
    given = [str(folder), *arguments]
    return subprocess.Popen(
        [sys.executable, str(HERE / "diagnosis_job.py"), *given],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        cwd=folder,
        env={**os.environ, "OPENBLAS_NUM_THREADS": "1", "PYTHONPATH": str(HERE.parents[1])},
        start_new_session=True,
    )


def left_in_group(group: int) -> list[int]:
    """Processes of a group that still run (zombies do not)."""
    found = []
    for entry in Path("/proc").glob("[0-9]*"):
        try:
            fields = (entry / "stat").read_text().rpartition(")")[2].split()
        except OSError:
            continue
        if int(fields[2]) == group and fields[0] != "Z":
            found.append(int(entry.name))
    return found


def gone(group: int, patience: float = 15.0) -> bool:
    """Whether a group has no processes left, after a while."""
    end = time.monotonic() + patience
    while time.monotonic() < end:
        if not left_in_group(group):
            return True
        time.sleep(0.1)
    return False


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Diagnosis]:
    """The folder of the small diagnosis without an interruption, and its answer."""
    folder = tmp_path_factory.mktemp("whole")
    return folder, job.run(folder)


@pytest.fixture
def whole(finished: tuple[Path, Diagnosis]) -> Diagnosis:
    return finished[1]


@pytest.fixture
def copied(finished: tuple[Path, Diagnosis], tmp_path: Path) -> Path:
    """A copy of that folder."""
    return Path(shutil.copytree(finished[0], tmp_path / "copied"))


class Counter:
    """Counts looks while they are made."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.looks = 0
        look = Screen.look

        def counted(screen: Screen, hypotheses: tuple[Hypothesis, ...]) -> Look | None:
            self.looks += 1
            return look(screen, hypotheses)

        monkeypatch.setattr(Screen, "look", counted)


def same(one: Diagnosis, other: Diagnosis) -> bool:
    """To the last digit; by their text, because from Python 3.13 on two dataclasses that hold the same nan are not equal."""
    parts = ("verdict", "causes", "ranking", "indistinguishable", "gaps", "parameters")
    return all(repr(getattr(one, part)) == repr(getattr(other, part)) for part in parts)


def test_a_killed_diagnosis_goes_on_from_its_folder_and_gives_the_same_answer(
    tmp_path: Path, whole: Diagnosis, monkeypatch: pytest.MonkeyPatch
) -> None:
    process = started(tmp_path, "1", job.SECOND, "SIGKILL")
    out, err = process.communicate(timeout=PATIENCE)
    assert process.returncode == -signal.SIGKILL, err
    assert "stage" in out
    counter = Counter(monkeypatch)
    resumed = job.run(tmp_path)
    assert counter.looks == 0  # all had been made before the signal
    assert any("were taken from" in note for note in resumed.notes)
    assert same(resumed, whole)


def test_a_finished_diagnosis_is_read_from_its_folder(copied: Path, whole: Diagnosis, monkeypatch: pytest.MonkeyPatch) -> None:
    assert not any("were taken from" in note for note in whole.notes)
    monkeypatch.setattr("hdrive_mbs.diagnosis.search.fit", None)  # would raise if it were called
    counter = Counter(monkeypatch)
    assert same(job.run(copied), whole)
    assert counter.looks == 0


def test_other_inputs_begin_anew_and_say_so(tmp_path: Path, whole: Diagnosis) -> None:
    top = tmp_path / "work"
    first = Journal(top, {"records": records(seed=1), "bench": bench()})
    again = Journal(top, {"records": records(seed=1), "bench": bench()})
    other = Journal(top, {"records": records(seed=2), "bench": bench()})
    assert first.folder == again.folder != other.folder
    assert first.notes == again.notes == ()
    assert other.notes == (f"{top} holds work on other inputs (records differ): this diagnosis was begun anew.",)


def test_a_damaged_answer_is_worked_out_again(copied: Path, whole: Diagnosis) -> None:
    answers = sorted(copied.glob("*/*.npz"))
    answers[0].write_bytes(answers[0].read_bytes()[:100])
    answers[1].write_bytes(b"no archive")
    assert same(job.run(copied), whole)


def test_an_answer_comes_back_from_its_file_to_the_last_bit(tmp_path: Path) -> None:
    factor = Factor("motor.inertia", "J", {"motor.inertia": 1.2e-3}, 0.03)
    hypothesis = Hypothesis((factor,), (Added(ViscousDrag(coefficient=0.1 + 0.2), "load", "viscous_drag"),), {"J": 10.0})
    look = Look(hypothesis, np.array([0.1, np.pi]), float("inf"), np.array([1e-300, np.nan]), hypothesis)
    journal = Journal(tmp_path, {})
    journal.write("key", look)
    answer = journal.read("key", (hypothesis,))
    assert answer is not None
    found = answer[0]
    assert isinstance(found, Look)
    assert found.hypothesis.added[0].effect == hypothesis.added[0].effect
    assert (found.hypothesis.factors, found.hypothesis.loose, found.cost) == (hypothesis.factors, hypothesis.loose, look.cost)
    assert np.array_equal(found.z, look.z)
    assert np.array_equal(found.residuals, look.residuals, equal_nan=True)
    journal.write("nothing", None)
    assert journal.read("nothing", hypothesis) == (None,)
    assert journal.read("never asked", hypothesis) is None


def test_where_a_gap_lies_comes_back_from_its_file_with_classes_that_a_call_names(tmp_path: Path) -> None:
    line = np.linspace(0.0, 1.0, 3)
    force = LatentForce(
        at="load", way="turn", record="a", unit="N m", times=line, force=line, angle=line, speed=line, torque=np.full(3, np.nan)
    )
    places = (Place(at="load", probability=0.9, gain=40.0, share=0.7, tied=("gear",)),)
    place = Located(places=places, doubt="", forces=(force,), turned=(TurnedForce(line, line + 1j * line),))
    hypothesis = Hypothesis((), (Added(ViscousDrag(coefficient=0.3), "load", "viscous_drag"),))
    journal = Journal(tmp_path, {})
    journal.write("key", (hypothesis, place))
    answer = journal.read("key", partial(print, hypothesis, known=None))
    assert answer is not None
    (kept, found) = answer[0]
    assert kept.added[0].effect == hypothesis.added[0].effect
    assert (found.places, found.doubt) == (place.places, "")
    assert found.forces[0].at == "load"
    for name in ("times", "force", "angle", "speed", "torque"):
        assert np.array_equal(getattr(found.forces[0], name), getattr(force, name), equal_nan=True)
    assert np.array_equal(found.turned[0].force, place.turned[0].force)


def test_a_file_of_answers_brings_no_class_of_its_own(tmp_path: Path) -> None:
    factor = Factor("motor.inertia", "J", {"motor.inertia": 1.2e-3}, 0.03)
    effect = Hypothesis((factor,), (Added(ViscousDrag(coefficient=0.3), "load", "viscous_drag"),))
    journal = Journal(tmp_path, {})
    journal.write("key", effect)
    assert journal.read("key", effect) is not None
    assert journal.read("key", Hypothesis((factor,))) is None  # nobody asked for a ViscousDrag


def test_content_counts_for_a_digest_and_not_how_it_came_about() -> None:
    one, other = records(seed=1), records(seed=1)
    assert digest(one, bench()) == digest(other, bench())
    assert digest(one) != digest(records(seed=3))
    assert digest(bench()) != digest(bench(columns=("motor_angle",)))
    assert digest((1.0,)) != digest((np.nextafter(1.0, 2.0),))
    assert digest({"a": 1}, {"b": 2}) != digest({"a": 1, "b": 2})


@pytest.mark.slow
def test_two_processes_give_the_answer_of_one_and_read_an_effect_from_its_file(tmp_path: Path, whole: Diagnosis) -> None:
    file = tmp_path / "my_effect.py"
    file.write_text(OWN)
    kinds = (*job.KINDS, job.from_file(file))
    try:
        two, one = job.run(tmp_path / "two", 2, kinds=kinds), job.run(tmp_path / "one", 1, kinds=kinds)
        assert same(one, two)
        assert [(cause.effect, cause.at) for cause in two.causes] == [(cause.effect, cause.at) for cause in whole.causes]
    finally:
        del sys.modules["effect_of_a_user"]


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="reads the table of processes of Linux")
@pytest.mark.parametrize("number", ["SIGINT", "SIGKILL"])
def test_no_process_is_left_when_a_diagnosis_is_interrupted(tmp_path: Path, number: str) -> None:
    process = started(tmp_path, "2", job.SECOND, number)
    out, err = process.communicate(timeout=PATIENCE)
    assert "stage" in out, err
    assert process.returncode != 0
    assert gone(process.pid), left_in_group(process.pid)


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="reads the table of processes of Linux")
def test_ctrl_c_ends_all_processes_and_keeps_what_is_done(tmp_path: Path, whole: Diagnosis) -> None:
    """A terminal sends the signal to the whole group."""
    process = started(tmp_path, "2", "", "")
    end = time.monotonic() + 60.0
    while len(list(tmp_path.glob("*/*.npz"))) < 4 and time.monotonic() < end:
        time.sleep(0.05)
    os.killpg(process.pid, signal.SIGINT)
    out, err = process.communicate(timeout=60)
    assert "KeyboardInterrupt" in err
    assert out == ""
    assert "diagnosis worker" not in err.lower()
    assert gone(process.pid), left_in_group(process.pid)
    assert same(job.run(tmp_path), whole)


def die(shared: object, item: int) -> int:
    if item == 1:
        os.kill(os.getpid(), signal.SIGKILL)
    return item


def die_once(marker: Path, item: int) -> int:
    if item == 1 and not marker.exists():
        marker.write_text("dead")
        os.kill(os.getpid(), signal.SIGKILL)
    return 10 * item


def fail(shared: object, item: int) -> int:
    raise hm.ParameterError(f"item {item} is wrong")


def double(shared: int, item: int) -> int:
    return shared * item


@pytest.fixture
def team() -> Iterator[Team]:
    with Team(2) as made:
        yield made


def test_a_worker_that_dies_is_named_with_the_way_out(team: Team) -> None:
    with pytest.raises(hm.AnalysisError, match=r"died \(signal SIGKILL\) at work on int; if memory was short, use fewer workers"):
        team.map(die, None, [0, 1, 2])


def test_the_item_of_a_worker_that_dies_once_is_done_by_another_and_said(team: Team, tmp_path: Path) -> None:
    assert team.map(die_once, tmp_path / "marker", [0, 1, 2, 3]) == [0, 10, 20, 30]
    [said] = team.lost
    assert "died (signal SIGKILL) at work on int" in said
    assert said.endswith("Another one took over.")
    assert team.map(double, 2, [1, 2, 3]) == [2, 4, 6]


def test_an_error_in_a_worker_comes_back_as_it_is_with_its_lines(team: Team) -> None:
    with pytest.raises(hm.ParameterError, match="is wrong") as caught:
        team.map(fail, None, [0, 1])
    assert any("in fail" in note for note in caught.value.__notes__)


def test_answers_come_in_the_order_of_the_questions_and_a_team_goes_on(team: Team) -> None:
    told: list[tuple[int, int]] = []
    assert team.map(double, 2, list(range(9)), lambda done, total: told.append((done, total))) == [2 * k for k in range(9)]
    assert told == [(k, 9) for k in range(10)]
    assert team.map(double, 3, [1, 2]) == [3, 6]


def test_a_team_that_was_dismissed_holds_no_process_and_works_again(team: Team) -> None:
    before = set(active_children())
    assert team.map(double, 2, [1, 2]) == [2, 4]
    assert len(set(active_children()) - before) == 2
    team.dismiss()
    assert not set(active_children()) - before
    assert team.map(double, 3, [1, 2]) == [3, 6]


def test_an_effect_that_no_process_could_read_is_refused_with_the_way_out() -> None:
    class Local(ViscousDrag):
        """Inside a function."""

    with pytest.raises(hm.ParameterError, match=r"inside a function .* at the top of a file, or use workers=1"):
        packed(Local)
    kind: type[Effect] = unpacked(packed(ViscousDrag))
    assert kind is ViscousDrag


def refusing(shared: int, item: int) -> int:
    refuse(f"law {item}", ZeroDivisionError(f"{shared}"))
    return item


def test_what_laws_raised_in_processes_is_told(team: Team) -> None:
    assert team.map(refusing, 7, [1, 2, 3]) == [1, 2, 3]
    assert team.refused == {f"law {number}": "ZeroDivisionError: 7" for number in (1, 2, 3)}
    [said] = refused_words(team.refused | {"law 4": "LawError: it is the fourth"})
    assert "law 1 (ZeroDivisionError: 7)" in said
    assert "and 1 more" in said
    assert refused_words({}) == ()


@pytest.mark.parametrize("workers", [1, 2])
def test_what_laws_raised_is_told_again_where_a_diagnosis_goes_on(tmp_path: Path, workers: int) -> None:
    for _ in range(2):
        with Team(workers, Journal(tmp_path, {})) as team:
            assert team.map(refusing, 7, [1, 2]) == [1, 2]
        assert set(team.refused) == {"law 1", "law 2"}


def test_what_laws_raised_before_a_team_is_not_told_of_it() -> None:
    refuse("an old law", ZeroDivisionError("long ago"))
    with Team(1) as alone:
        assert alone.map(refusing, 7, [1]) == [1]
    assert alone.refused == {"law 1": "ZeroDivisionError: 7"}


def test_a_script_without_its_main_line_is_told_so(tmp_path: Path) -> None:
    script = tmp_path / "script.py"
    script.write_text("from hdrive_mbs.diagnosis.team import Team\nwith Team(2) as team:\n    team.map(max, 1, [1, 2])\n")
    done = subprocess.run([sys.executable, str(script)], capture_output=True, text=True, timeout=PATIENCE)
    assert "needs the line if __name__ == '__main__'" in done.stderr


def test_a_folder_that_is_a_file_is_refused(tmp_path: Path) -> None:
    (tmp_path / "work").write_text("")
    with pytest.raises(hm.FileFormatError, match="is a file; folder= must be a folder"):
        Journal(tmp_path / "work", {})


def test_inputs_that_made_a_folder_are_said_in_it(tmp_path: Path) -> None:
    journal = Journal(tmp_path, {"records": quiet()})
    assert set(json.loads((journal.folder / "inputs.json").read_text())) == {"records", "program"}


def test_what_simulators_keep_of_runs_is_not_in_the_name_of_an_answer(tmp_path: Path) -> None:
    """The first fit and the place of a rotor's gap are found from two simulators together."""
    simulators = tuple(Simulator(diagnosis_trials(), 1e-3, every) for every in (4, 1))
    journal = Journal(tmp_path, {"inputs": 1})
    before = journal.identity(simulators)
    nominal = Hypothesis(factors=factors_of(bench()))
    assert simulators[0].residuals(nominal, [np.zeros(nominal.size)])[0] is not None
    assert journal.identity(simulators) == before
    assert journal.identity(simulators[::-1]) != before


def diagnosis_trials() -> list[Trial]:
    known = bench()
    return [trial for record in quiet() for trial in known.trials(record)]


@pytest.mark.parametrize("workers", [1, 2])
def test_the_place_that_is_looked_for_beside_the_search_is_taken_from_the_journal(tmp_path: Path, workers: int) -> None:
    fine = Simulator(diagnosis_trials(), 1e-3)
    found = []
    for _ in range(2):
        journal = Journal(tmp_path, {"inputs": 1})
        with Team(workers, journal) as team:
            found.append(team.answer(team.begin(gather._placed, fine, factors_of(bench()))))
    assert journal.taken == 1
    place, again = found
    assert place.places == again.places
    assert place.doubt == again.doubt


def wait_for(path: Path, item: float) -> float:
    """The item, once there is such a file."""
    until = time.monotonic() + PATIENCE
    while not path.exists():
        assert time.monotonic() < until
        time.sleep(0.01)
    return item


def test_what_is_begun_goes_on_beside_other_work(team: Team, tmp_path: Path) -> None:
    later = team.begin(wait_for, tmp_path / "ready", 7.0)
    assert team.map(double, 2, list(range(5))) == [0, 2, 4, 6, 8]  # by the other process, while this one waits
    assert later.state == "begun"
    (tmp_path / "ready").write_text("")
    assert team.answer(later) == team.answer(later) == 7.0
    assert team.map(double, 3, [1, 2, 3]) == [3, 6, 9]
    assert not team.lost


def test_an_answer_that_comes_in_during_other_work_is_kept(team: Team) -> None:
    later = team.begin(double, 2, 4)
    for _ in range(100):
        team.map(double, 2, [1, 2])
        if later.state == "good":
            break
    assert later.state == "good"
    assert team.answer(later) == 8


def test_nobody_begins_before_it_is_asked_for_where_no_process_would_be_left(team: Team, tmp_path: Path) -> None:
    first, second = team.begin(wait_for, tmp_path / "ready", 1.0), team.begin(double, 2, 3)
    assert (first.state, second.state) == ("begun", "waiting")
    assert team.answer(second) == 6
    (tmp_path / "ready").write_text("")
    assert team.answer(first) == 1.0
    with Team(1) as alone:
        assert alone.begin(double, 2, 3).state == "waiting"


def test_work_for_later_is_done_here_if_its_process_dies(team: Team, tmp_path: Path) -> None:
    later = team.begin(die_once, tmp_path / "marker", 1)
    assert team.answer(later) == 10
    [said] = team.lost
    assert "died (signal SIGKILL) at work on int" in said
    assert said.endswith("This process takes over when it is needed.")
    assert team.map(double, 2, [1, 2, 3]) == [2, 4, 6]


def fail_or_wait(shared: Path, item: int) -> int:
    if item == 0:
        raise hm.ParameterError("item 0 is wrong")
    return int(wait_for(shared, item))


@pytest.mark.slow
def test_after_an_error_a_team_goes_on_and_nobody_gets_an_answer_to_an_older_question(team: Team, tmp_path: Path) -> None:
    assert team.map(double, 2, [1, 2]) == [2, 4]  # both processes are there
    for _ in range(3):
        with pytest.raises(hm.ParameterError, match="item 0 is wrong"):
            team.map(fail_or_wait, tmp_path / "never", [0, 1, 1])
        assert team.map(double, 3, [1, 2, 3]) == [3, 6, 9]
    later = team.begin(double, 2, 5)
    assert team.answer(later) == 10


def test_work_for_later_of_a_script_without_its_main_line_is_told_so(tmp_path: Path) -> None:
    script = tmp_path / "script.py"
    script.write_text("from hdrive_mbs.diagnosis.team import Team\nwith Team(2) as team:\n    team.answer(team.begin(max, 1, 2))\n")
    done = subprocess.run([sys.executable, str(script)], capture_output=True, text=True, timeout=PATIENCE)
    assert done.returncode != 0
    assert "needs the line if __name__ == '__main__'" in done.stderr


def test_what_later_work_reads_is_let_go_when_its_answer_is_there(team: Team) -> None:
    later = team.begin(double, 2, 5)
    assert later.file is not None
    assert later.file.exists()
    assert team.answer(later) == 10
    assert not later.file.exists()


def test_an_error_in_work_for_later_is_raised_when_it_is_asked_for(team: Team) -> None:
    later = team.begin(fail, None, 1)
    assert team.map(double, 2, [1, 2]) == [2, 4]
    for _ in range(2):
        with pytest.raises(hm.ParameterError, match="is wrong"):
            team.answer(later)


def test_work_for_later_of_a_team_that_was_dismissed_is_done_when_it_is_asked_for(team: Team) -> None:
    later = team.begin(double, 2, 21)
    team.dismiss()
    assert team.answer(later) == 42


def threads_in_the_end(shared: Path, item: str) -> int:
    """Threads that runs may take, once all others are done: of item "last" when they have written their files."""
    if item != "last":
        (shared / item).write_text("")
        return 0
    until = time.monotonic() + PATIENCE
    while threads.at_hand() < 2 and time.monotonic() < until:
        time.sleep(0.01)
    return threads.at_hand()


def test_who_is_left_alone_at_work_may_take_the_threads_of_the_others(team: Team, tmp_path: Path) -> None:
    assert team.map(threads_in_the_end, tmp_path, ["last", "a", "b"])[0] == 2
    assert team.map(threads_in_the_end, tmp_path, ["last"]) == [2]
    assert threads.at_hand() == 1
    later = team.begin(wait_for, tmp_path / "ready", 1.0)
    assert team.map(number_of_threads, None, [0]) == [1]  # a core is taken
    assert team.map(double, 2, [1, 2, 3]) == [2, 4, 6]
    assert team._threads.value == 1  # of the process that waits, and of this one
    (tmp_path / "ready").write_text("")
    team.answer(later)


def number_of_threads(shared: None, item: int) -> int:
    return threads.at_hand()

"""``hdrive-mbs diagnose``: why a simulation and measured records disagree."""

from __future__ import annotations

import contextlib
import hashlib
import json as json_text
import os
import re
import shutil
import sys
from collections.abc import Collection, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from hdrive_mbs.cli.options import JsonFile
from hdrive_mbs.cli.output import write_json
from hdrive_mbs.cli.python_file import imported, lines_named, own_types
from hdrive_mbs.cli.records_options import (
    BenchFile,
    Channels,
    Every,
    HeldOut,
    Only,
    OwnEffects,
    Repairs,
    SearchSeconds,
    TimeColumn,
    Units,
    reading_of,
)
from hdrive_mbs.cli.scene_source import load_file
from hdrive_mbs.cli.stages import stage_bars
from hdrive_mbs.errors import FileFormatError, HdriveError, SceneError, unknown_place
from hdrive_mbs.scene import Scene
from hdrive_mbs.scene_file import save_scene
from hdrive_mbs.writing import write_text

if TYPE_CHECKING:
    from hdrive_mbs.diagnosis.bench import Bench
    from hdrive_mbs.diagnosis.result import Diagnosis
    from hdrive_mbs.effects.effect import Effect
    from hdrive_mbs.records.collection import Records

WORK, JOB, INPUTS = "work", "job.json", "inputs.json"
"""Folder in --out that holds what is done while it is not finished, and files in it that only say of what."""


def diagnose(
    scene: BenchFile,
    records: Annotated[
        list[Path], typer.Option("--records", metavar="DIR_OR_FILES", help="A folder or files of measured records; several may follow.")
    ],
    more: Annotated[list[Path] | None, typer.Argument(metavar="[RECORD]...", help="More records: what follows --records.")] = None,
    effects: OwnEffects = None,
    only: Only = None,
    channel: Channels = None,
    unit: Units = None,
    time: TimeColumn = None,
    repair: Repairs = None,
    held_out: HeldOut = None,
    every: Every = None,
    workers: Annotated[int | None, typer.Option(help="Processes on this machine; 2 where it has two cores.")] = None,
    search_seconds: SearchSeconds = None,
    resume: Annotated[bool, typer.Option("--resume", help="Go on with an interrupted diagnosis in --out.")] = False,
    out: Annotated[Path | None, typer.Option("--out", metavar="DIR", help="Folder for report, pictures and the improved scene.")] = None,
    json: JsonFile = None,
) -> None:
    """Say where the gap between simulation and records lies, which effect causes it, and how far it shrinks once that is added."""
    chosen = open_bench(scene, effects or ())
    kinds = tried(effects or (), only or ())  # once the bench's file is read, whose own effects count too
    reading = reading_of(channel, unit, time, repair)
    paths = [*records, *(more or ())]
    measured = measured_in(paths, reading, chosen)
    name = chosen.name if isinstance(chosen, Scene) else chosen.scene.name
    folder = out or Path("results") / re.sub(r"\W+", "_", f"diagnosis {name}")
    job = _job(scene, measured, effects or (), only or (), reading=dict(reading), held_out=sorted(held_out or ()), every=every)
    work = _begin(folder / WORK, job, resume)
    from hdrive_mbs.diagnosis.diagnose import diagnose as run

    try:
        with stage_bars() as report:
            cores = workers or min(2, os.cpu_count() or 1)
            result = run(
                chosen,
                measured,
                candidates=kinds,
                workers=cores,
                folder=work,
                every=every,
                held_out=held_out or (),
                search_seconds=search_seconds,
                report=report,
            )
    except KeyboardInterrupt:
        print(f"interrupted; what is done is kept in {work}. The same command with --resume goes on.", file=sys.stderr)
        raise typer.Exit(130) from None
    except HdriveError:
        _leave(work)
        raise
    write_answer(result, folder)
    shutil.rmtree(work, ignore_errors=True)  # the answer is written: what is left of the work harms nobody
    if json is not None:
        from hdrive_mbs.diagnosis.report_json import report_document

        write_json(json, report_document(result))
    if json != "-":
        print(result, end="")
        print(f"\nReport with pictures: {folder / 'diagnosis.html'}")


def open_bench(path: Path, own: Sequence[Path] = ()) -> Bench | Scene:
    """What the file gives: its bench(), or else its build(), or the scene of a scene file.

    own : .py files with classes that a scene file names

    Raises FileFormatError or SceneError for a file that gives neither.
    """
    if path.suffix.lower() in (".toml", ".json"):
        return load_file(path, [kind for file in own for kind in own_types(file)])
    module = imported(path, "a .py file with bench() -> Bench or build() -> Scene, or a .toml or .json scene")
    from hdrive_mbs.diagnosis.bench import Bench

    for name, kind in (("bench", Bench), ("build", Scene)):
        function = getattr(module, name, None)
        if function is None:
            continue
        with lines_named(path):
            made = function()
        if not isinstance(made, kind):
            raise SceneError(f"{path}: {name}() returned a {type(made).__name__}, not a {kind.__name__}.")
        return made
    raise SceneError(f"{path} has neither a function bench() that returns a Bench nor build() that returns a Scene.")


def tried(files: Sequence[Path], only: Sequence[str] = ()) -> list[type[Effect]] | None:
    """The library, the effects of these files, which may hold laws and parts too, and what has been imported; None for all that is known.

    only : classes or families that are tried, all if empty;  raises PlaceError for one that there is not
    """
    if not files and not only:
        return None
    from hdrive_mbs.diagnosis.candidates import known_effects
    from hdrive_mbs.effects.effect import Effect

    own = [kind for path in files for kind in own_types(path) if issubclass(kind, Effect)]
    known = [*own, *(kind for kind in known_effects() if kind not in own)]
    names = dict.fromkeys(text for kind in known for text in (kind.__name__, kind.family))
    for name in only:
        if name not in names:
            raise unknown_place("effect", name, names, "The library, with your own files,")
    return [kind for kind in known if not only or kind.__name__ in only or kind.family in only]


def write_answer(result: Diagnosis, folder: Path, *, stays: bool = True) -> None:
    """Text, JSON, improved scene, summary picture and page into a folder; the answer itself first.

    stays : whether they stay there, so that files of one's own can be named from there
    """
    from hdrive_mbs.diagnosis.report_json import write_report_json
    from hdrive_mbs.diagnosis.report_text import write_report

    write_report_json(result, folder / "diagnosis.json")
    write_report(result, folder / "diagnosis.txt")
    write_improved(result, folder, stays=stays)
    from hdrive_mbs.plots import plot, save_figure
    from hdrive_mbs.plots.report_html import write_report_html

    save_figure(plot(result), folder / "diagnosis")
    write_report_html(result, folder / "diagnosis.html")


def write_improved(result: Diagnosis, folder: Path, *, stays: bool = True) -> None:
    """The improved scene, and in a folder beside it the same with the inputs of each record, none of an earlier diagnosis left.

    A scene that holds Python functions is said not to be written.
    """
    from hdrive_mbs.diagnosis.improved_words import FOLDER, HEAD, driven_words, file_names, improved_words

    for old in (folder / FOLDER).glob("*.toml"):
        with old.open(encoding="utf-8") as file:
            ours = file.readline().startswith(f"# {HEAD}")
        if ours:
            old.unlink()
    here, beside = (folder, folder / FOLDER) if stays else (None, None)
    scenes = [(result.improved, folder / "improved.toml", improved_words(result, here))]
    names = file_names(result.driven)
    scenes += [
        (item.scene, folder / FOLDER / name, driven_words(item, name, beside)) for item, name in zip(result.driven, names, strict=True)
    ]
    for scene, path, head in scenes:
        try:
            save_scene(scene, path, head=head)
        except FileFormatError as error:
            print(f"{path} was not written: {error}", file=sys.stderr)


def measured_in(paths: Sequence[Path], reading: Mapping[str, Any], bench: Bench | Scene) -> Records:
    """Records of a folder and files together; besides what is mapped, the columns that the bench has a name for."""
    from hdrive_mbs.records.collection import Records
    from hdrive_mbs.records.reading import read_records

    for path in paths:
        if not path.exists():
            raise FileFormatError(f"{path}: no such file or folder. Give measured records with --records.")
    mapped = set((reading["channels"] or {}).values())
    also = () if isinstance(bench, Scene) else tuple(_unmapped(bench, mapped))
    files = [path for path in paths if not path.is_dir()]
    found = [read_records(path, **reading, also=also) for path in paths if path.is_dir()]
    if files:
        found.append(read_records(files, **reading, also=also))
    return Records(records=tuple(record for records in found for record in records))


def _unmapped(bench: Bench, mapped: Collection[str]) -> Iterator[str]:
    """Columns that the bench has a name for and that nothing is mapped to."""
    for name in (*bench.measured, *bench.inputs):
        if name not in mapped and (name not in bench.measured or bench.measured[name].channel not in mapped):
            yield name


def _job(scene: Path, records: Records, effects: Sequence[Path], only: Sequence[str], **options: Any) -> dict[str, Any]:
    """What is diagnosed, so that only the same is gone on with.

    options : that choose or read records, as plain data
    """
    files = {"scene": scene, **{f"effects {path.name}": path for path in effects}}
    return {
        "files": {name: hashlib.sha256(path.read_bytes()).hexdigest() for name, path in files.items()},
        "records": {record.name: record.sha256 for record in records},
        "only": sorted(only),
        **options,
    }


def _begin(work: Path, job: Mapping[str, Any], resume: bool) -> Path:
    """The folder of unfinished work, empty or holding the same job.

    Raises FileFormatError where it holds another job, or the same one that is not to be gone on with.
    """
    file = work / JOB
    if file.is_file():
        if not resume:
            raise FileFormatError(
                f"{work} holds a diagnosis that was not finished: go on with --resume, delete that folder, or choose another --out."
            )
        try:
            same = json_text.loads(file.read_text("utf-8")) == job
        except ValueError:
            same = False
        if not same:
            raise FileFormatError(
                f"{work} holds a diagnosis of another scene, other records, effects or options (or they have changed since):"
                " delete that folder, or choose another --out."
            )
        return work
    write_text(file, json_text.dumps(job, indent=2) + "\n")
    return work


def _leave(work: Path) -> None:
    """Take the folder away where no answer of a fit is in it, and the one it is in where nothing else is."""
    if not any(item.is_file() and item.name not in (JOB, INPUTS) for item in work.rglob("*")):
        shutil.rmtree(work)
        with contextlib.suppress(OSError):  # it holds something
            work.parent.rmdir()

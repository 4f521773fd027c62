"""``hdrive-mbs diagnose-all``: the diagnosis of many cases, on processes or a cluster."""

from __future__ import annotations

import re
import shutil
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from hdrive_mbs.cli.case_diagnosis import CaseDiagnosis, GivenFile, cases_in, content_hash
from hdrive_mbs.cli.diagnose import WORK, open_bench, tried
from hdrive_mbs.cli.options import ExportFiles, JsonFile
from hdrive_mbs.cli.output import print_table, write_exports, write_json
from hdrive_mbs.cli.records_options import (
    BenchFile,
    Channels,
    Every,
    Only,
    OwnEffects,
    Repairs,
    SearchSeconds,
    TimeColumn,
    Units,
    reading_of,
)
from hdrive_mbs.cli.sweep import cell, tell_failures
from hdrive_mbs.scene import Scene
from hdrive_mbs.writing import write_bytes, write_text

if TYPE_CHECKING:
    from hdrive_mbs.campaign.campaign import Campaign

NOTE = "README"
"""File in the folder of unfinished work; a worker that sees the folder keeps its fits there."""


def diagnose_all(
    scene: BenchFile,
    records: Annotated[
        list[Path],
        typer.Option(
            "--records", metavar="DIR", help="A folder of records, which is one case, or a folder of such folders; several may follow."
        ),
    ],
    more: Annotated[list[Path] | None, typer.Argument(metavar="[DIR]...", help="More cases: what follows --records.")] = None,
    effects: OwnEffects = None,
    only: Only = None,
    channel: Channels = None,
    unit: Units = None,
    time: TimeColumn = None,
    repair: Repairs = None,
    every: Every = None,
    workers: Annotated[int | None, typer.Option(help="Cases side by side, a process each; as many as the machine has cores.")] = None,
    search_seconds: SearchSeconds = None,
    scheduler: Annotated[
        str | None, typer.Option(metavar="ADDRESS", help="Use the dask cluster of this scheduler, like tcp://host:8786.")
    ] = None,
    retries: Annotated[int, typer.Option(help="How often a case is begun again whose worker was lost.")] = 2,
    out: Annotated[Path | None, typer.Option("--out", metavar="DIR", help="Folder with a folder for each case, and the table.")] = None,
    export: ExportFiles = None,
    json: JsonFile = None,
) -> None:
    """Diagnose every case with one bench; a case that fails does not stop the others, and the same command goes on."""
    from hdrive_mbs.campaign.sweeping import sweep
    from hdrive_mbs.diagnosis.digest import program
    from hdrive_mbs.records.reading import record_files

    opened = open_bench(scene, effects or ())
    tried(effects or (), only or ())  # says now what would fail in every case
    reading = reading_of(channel, unit, time, repair)
    cases = cases_in([*records, *(more or ())])
    folder = out or Path("results") / re.sub(r"\W+", "_", f"diagnoses {scene.stem}")
    work = folder.resolve() / WORK
    task = CaseDiagnosis(
        bench=opened if isinstance(opened, Scene) and scene.suffix.lower() != ".py" else GivenFile.of(scene),
        effects=tuple(GivenFile.of(path) for path in effects or ()),
        only=tuple(only or ()),
        reading=reading,
        program=program(),
        work=str(work),
        every=every,
        search_seconds=search_seconds,
    )
    points = [{"case": name, "records": str(path), "sha256": content_hash(record_files(path))} for name, path in cases.items()]
    write_text(work / NOTE, "Fits of cases that are not finished; taken away when all are.\n")

    def arrived(point: Mapping[str, Any], values: Mapping[str, Any]) -> None:
        write_case(folder / str(point["case"]), values)
        shutil.rmtree(work / str(point["case"]), ignore_errors=True)

    result = sweep(task, points, executor=scheduler or "processes", workers=workers, folder=folder, retries=retries, arrived=arrived)
    table = result.to_csv(folder / "diagnoses.csv")
    write_exports(result, export)
    write_json(json, document(result))
    if json != "-":
        _print(result, table)
    tell_failures(result.failures, folder, of=lambda point: f"{point['case']} ({point['records']})")
    if not bool(result.done.all()):
        raise typer.Exit(1 if result.failures and "stopped" not in result.status else 130)
    shutil.rmtree(work, ignore_errors=True)


def write_case(folder: Path, values: Mapping[str, Any]) -> None:
    """The files of a case's report, each whole or not at all."""
    for name, content in values["report"].items():
        data = content.tobytes()
        if not (folder / name).is_file() or (folder / name).read_bytes() != data:
            write_bytes(folder / name, data)


def document(result: Campaign) -> dict[str, Any]:
    """What --json writes."""
    return {
        "status": result.status,
        "cases": len(result),
        "done": int(result.done.sum()),
        "reused": result.reused,
        "columns": result.columns(),
        "failures": [dict(failure) for failure in result.failures],
        "origin": result.made_from(),
    }


def _print(result: Campaign, table: Path) -> None:
    columns = result.columns()
    heads = [name for name in ("case", "verdict", "effect", "at", "probability", "gap closed", "job") if name in columns]
    rows = [[cell(columns[name][k]) for name in heads] for k in range(len(result))]
    print_table(f"diagnoses: {result.status}", heads, rows)
    reused = f", {result.reused} of them found finished" if result.reused else ""
    print(f"{int(result.done.sum())} of {len(result)} cases done{reused}. Table: {table}; a report in the folder of each case beside it.")

"""Every command line that README and docs print is one that the programs take; the quick ones are run."""

from __future__ import annotations

import argparse
import importlib
import inspect
import re
import shlex
from pathlib import Path
from typing import Any

import pytest
import typer
from typer.testing import CliRunner

from hdrive_mbs.cli.diagnose import open_bench, tried
from hdrive_mbs.cli.main import app
from hdrive_mbs.cli.scene_source import open_scene
from hdrive_mbs.cli.speeds import parse_speeds
from hdrive_mbs.cli.sweep import parse_values

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", *(path for path in sorted((ROOT / "docs").rglob("*.md")) if not {"_build", "collected"} & set(path.parts))]
PAGES += sorted((ROOT / "benchmarks").rglob("README.md"))
OURS = re.compile(r"(?:\.venv/bin/)?(?:hdrive-mbs|python3? (?:-m benchmarks\.|docs/))")
QUICK = ("effects", "modes", "torsion", "campbell", "unbalance", "run")
"""Commands that take some seconds with the models of the README; those that run up, sweep, animate or diagnose take longer,
and the pictures of the teeth are made by tests/unit/test_teeth_cli.py."""


def printed_in(path: Path) -> list[str]:
    """Lines of blocks, and spans of code in the text, that begin with one of our programs."""
    text = path.read_text("utf-8")
    fence = re.compile(r"^```(\w*)\n(.*?)^```$", re.S | re.M)
    lines = []
    for language, block in fence.findall(text):
        if language in ("", "sh", "bash", "text"):
            lines += [part.strip() for line in block.replace("\\\n", " ").splitlines() for part in line.split("&&")]
    lines += [" ".join(span.split()) for span in re.findall(r"`([^`]+)`", fence.sub("", text))]
    # words in brackets are a pattern for several commands
    return [line for line in lines if OURS.match(line) and "[" not in line]


COMMANDS = [pytest.param(line, id=f"{path.relative_to(ROOT)}: {line}") for path in PAGES for line in dict.fromkeys(printed_in(path))]


class ParsedError(Exception):
    """The arguments of a benchmark were taken; it does not run."""


@pytest.mark.parametrize("line", COMMANDS)
def test_a_printed_command_is_taken(line: str, monkeypatch: pytest.MonkeyPatch) -> None:
    words = shlex.split(line, comments=True)
    files = [word for word in words if word.startswith(("models/", "docs/", "hdrive_mbs/"))]
    assert all((ROOT / name).exists() for name in files), files
    monkeypatch.chdir(ROOT)
    if words[0].endswith("hdrive-mbs"):
        check_ours(words[1:])
    elif words[1] == "-m":
        check_benchmark(words[2], words[3:], monkeypatch)


def check_ours(words: list[str]) -> None:
    group: Any = typer.main.get_command(app)
    with group.make_context("hdrive-mbs", list(words)) as context:
        name, *rest = words
        command = group.get_command(context, name)
        assert command is not None, f"there is no command {name!r}"
        if not rest:
            return  # named, not called
        given = command.make_context(name, list(rest), parent=context).params
    if not isinstance(given.get("scene"), Path) or not given["scene"].exists():
        return
    if name.startswith("diagnose"):
        open_bench(given["scene"])
        tried((), given.get("only") or ())
        return
    scene = open_scene(given["scene"], given.get("set_") or (), given.get("effect") or ())
    for text in given.get("vary") or ():
        assert parse_values(scene, text)[1]
    if given.get("speeds"):
        assert len(parse_speeds("--speeds", given["speeds"]))


def check_benchmark(module: str, words: list[str], monkeypatch: pytest.MonkeyPatch) -> None:
    spec = importlib.util.find_spec(module)
    assert spec is not None, f"there is no module {module}"
    package = importlib.util.find_spec(f"{module}.__main__") if spec.submodule_search_locations else spec
    assert package is not None, f"{module} is no program"
    main = importlib.import_module(package.name).main
    if not words:
        return  # named, not called
    assert inspect.signature(main).parameters, f"{module} takes no arguments"
    taken = argparse.ArgumentParser.parse_args

    def parsed(self: argparse.ArgumentParser, *arguments: Any, **options: Any) -> None:
        taken(self, *arguments, **options)
        raise ParsedError

    monkeypatch.setattr(argparse.ArgumentParser, "parse_args", parsed)
    with pytest.raises(ParsedError):
        main(words)


def test_commands_are_found_in_blocks_and_in_the_text() -> None:
    found = {path.name: printed_in(path) for path in PAGES if path.parent in (ROOT, ROOT / "docs")}
    assert len(found["README.md"]) > 12
    assert any(line.startswith("hdrive-mbs sweep SCENE.py") and "--workers 2" in line for line in found["sweeps.md"])
    assert any(line.startswith("hdrive-mbs run scene.toml") for line in found["extending.md"])


@pytest.mark.parametrize("line", ["hdrive-mbs rum models/jeffcott.py", "hdrive-mbs modes models/jeffcott.py --load 3"])
def test_a_command_or_an_option_that_there_is_not_is_noticed(line: str) -> None:
    with pytest.raises(Exception, match=r"rum|--load"):
        check_ours(shlex.split(line)[1:])


@pytest.mark.parametrize("line", [line for line in printed_in(ROOT / "README.md") if line.split()[1] in QUICK and len(line.split()) > 1])
def test_a_quick_command_of_the_readme_runs(line: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    words = shlex.split(line)[1:]
    (tmp_path / "models").symlink_to(ROOT / "models")
    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(app, words, catch_exceptions=False)
    assert done.exit_code == 0, done.output
    for option in ("--json", "--out"):
        if option in words:
            assert Path(words[words.index(option) + 1]).exists(), f"{option} was not written"

"""``hdrive-mbs``: the commands."""

from __future__ import annotations

import sys
from typing import Annotated

import typer

from hdrive_mbs import __version__
from hdrive_mbs.cli import (
    animate,
    bench,
    campbell,
    demo,
    diagnose,
    diagnose_all,
    effects,
    from_ross,
    modes,
    run,
    run_up,
    sweep,
    teeth,
    torsion,
    unbalance,
)
from hdrive_mbs.cli.wording import on_command_line
from hdrive_mbs.errors import HdriveError

app = typer.Typer(
    name="hdrive-mbs",
    help="Harmonic-drive power trains and rotors on the multibody engine Exudyn.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)


def _version(value: bool) -> None:
    if value:
        print(f"hdrive-mbs {__version__}")
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version.")] = False,
) -> None:
    """Harmonic-drive power trains and rotors on the multibody engine Exudyn."""


for command in (run.run, modes.modes, torsion.torsion, effects.effects, teeth.teeth, demo.demo):
    app.command()(command)
app.command(context_settings={"allow_extra_args": True, "ignore_unknown_options": True})(bench.bench)
app.command()(unbalance.unbalance)
app.command()(campbell.campbell)
app.command()(run_up.run_up)
app.command()(animate.animate)
app.command()(from_ross.from_ross)
app.command()(sweep.sweep)
app.command()(diagnose.diagnose)
app.command()(diagnose_all.diagnose_all)


def main() -> None:
    """Run a command; an error that we foresaw is one line on stderr and exit code 2."""
    try:
        app()
    except HdriveError as error:
        print(f"error: {on_command_line(str(error))}", file=sys.stderr)
        sys.exit(2)


if __name__ == "__main__":
    main()

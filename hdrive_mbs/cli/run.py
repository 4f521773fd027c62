"""``hdrive-mbs run``: simulate a scene."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Annotated

import typer

from hdrive_mbs.cli.options import EffectFiles, Effects, ExportFiles, JsonFile, OutFolder, ScenePath, Settings
from hdrive_mbs.cli.output import print_tables, write_exports, write_json
from hdrive_mbs.cli.scene_source import open_scene
from hdrive_mbs.engine import solvers
from hdrive_mbs.engine.solvers import Solver
from hdrive_mbs.errors import FileFormatError, ParameterError
from hdrive_mbs.units import to_si


def run(
    scene: ScenePath,
    set_: Settings = None,
    effect: Effects = None,
    effects: EffectFiles = None,
    duration: Annotated[float, typer.Option(help="Simulated time [s].")] = 1.0,
    initial_speed: Annotated[float, typer.Option(help="Motor speed at t = 0 [rad/s].")] = 0.0,
    initial: Annotated[
        list[str] | None,
        typer.Option(metavar="CHANNEL=VALUE", help="Value at t = 0 (several times), e.g. load.angle=0.1 or 'load.speed=3 rpm'."),
    ] = None,
    solver: Annotated[str, typer.Option(help="automatic, dormand-prince, runge-kutta-4, trapezoidal or generalized-alpha.")] = "automatic",
    tolerance: Annotated[float, typer.Option(help="Relative tolerance of dormand-prince.")] = 1e-8,
    step: Annotated[float, typer.Option(help="Step of the other solvers [s].")] = 1e-4,
    estimate_error: Annotated[bool, typer.Option("--estimate-error", help="Run again finer and state the error.")] = False,
    plot: Annotated[list[str] | None, typer.Option(help="Channels to draw (several times); a choice is made if not given.")] = None,
    csv: Annotated[bool, typer.Option("--csv", help="Write the histories as CSV too.")] = False,
    out: OutFolder = None,
    export: ExportFiles = None,
    json: JsonFile = None,
) -> None:
    """Simulate a scene on Exudyn; write the result, a picture and summary figures."""
    from hdrive_mbs.analysis.time_response import simulate
    from hdrive_mbs.plots import plot as draw
    from hdrive_mbs.plots import save_figure

    chosen = open_scene(scene, set_ or (), effect or (), effects or ())
    taken = _solver(solver, tolerance, step, chosen.network().is_lateral)
    response = simulate(
        chosen, duration, solver=taken, initial_speed=initial_speed, initial=_initial(initial or ()), estimate_error=estimate_error
    )
    folder = out or Path("results") / re.sub(r"\W+", "_", chosen.name)
    result = response.save(folder / "response.npz")
    pictures = save_figure(draw(response, channels=plot or None), folder / "response")
    table = response.to_csv(folder / "response.csv") if csv else None
    summary = response.summary()
    write_exports(response, export)
    write_json(
        json,
        {
            "scene": chosen.name,
            "status": response.status,
            "duration": float(response.times[-1]),
            "steps": response.steps,
            "rejected_steps": response.rejected,
            "seconds": response.seconds,
            "solver": response.settings["solver"],
            "lowering": dict(response.lowering),
            "estimated_error": dict(response.error),
            "channels": {name: {"unit": response.units[name], **figures} for name, figures in summary.items()},
            "result": str(result),
            "csv": None if table is None else str(table),
            "pictures": [str(path) for path in pictures],
            "origin": response.made_from(),
        },
    )
    if json != "-":
        print_tables(chosen.name, response.status, response.tables())
        print(f"{response.steps} steps, {response.seconds:.3f} s CPU. Result: {result}. Picture: {pictures[0]}.")
    if not response.status.startswith("complete"):
        raise typer.Exit(130)


def _initial(texts: Sequence[str]) -> dict[str, float]:
    """``load.angle=0.1`` or ``load.speed=3 rpm`` -> SI values by channel; a bare number is SI."""
    found = {}
    for text in texts:
        name, sign, value = (part.strip() for part in text.partition("="))
        if not sign or not name:
            raise FileFormatError(f"--initial {text!r}: write CHANNEL=VALUE, like load.angle=0.1.")
        try:
            found[name] = float(value)
        except ValueError:
            unit = {"angle": "rad", "speed": "rad/s"}.get(name.rpartition(".")[2])
            if unit is None:
                raise FileFormatError(f"--initial {text!r}: {value!r} is no number (in SI units).") from None
            found[name] = to_si(value, unit, name)
    return found


def _solver(name: str, tolerance: float, step: float, is_rotor_line: bool) -> Solver | None:
    if name == "automatic":
        if is_rotor_line:
            return None
        name = "dormand-prince"
    makers: dict[str, Callable[[], Solver]] = {
        "dormand-prince": lambda: solvers.DormandPrince(relative_tolerance=tolerance, absolute_tolerance=tolerance * 1e-2),
        "runge-kutta-4": lambda: solvers.RungeKutta4(step=step),
        "trapezoidal": lambda: solvers.Trapezoidal(step=step),
        "generalized-alpha": lambda: solvers.GeneralizedAlpha(step=step),
    }
    if name not in makers:
        raise ParameterError(f"--solver {name!r}: must be one of automatic, {', '.join(makers)}.")
    return makers[name]()

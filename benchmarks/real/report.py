"""results.md from the numbers of the studies."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from benchmarks.writing import facts, table

ORDER = ("kuka", "staubli", "rk4")


def earlier(folder: Path) -> dict[str, Any]:
    """Numbers of studies that ran before; none where there is no file."""
    path = folder / "results.json"
    return dict(json.loads(path.read_text(encoding="utf-8"))) if path.is_file() else {}


def report(numbers: Mapping[str, Any]) -> str:
    """All studies there are."""
    writers = {"kuka": _kuka, "staubli": _staubli, "rk4": _rk4}
    parts = ["# Diagnosis of real measurements", "What is measured, how and on which scale: README.md beside this file."]
    parts += [writers[name](numbers[name]) for name in ORDER if name in numbers]
    return "\n\n".join(parts)


def _said(item: Mapping[str, Any]) -> str:
    """A round in words."""
    if not item["causes"]:
        return "no cause that it would claim" if item["verdict"] == "unknown" else "no gap beyond the floor"
    return " and ".join(f"{cause['effect']} at {cause['at']}" for cause in item["causes"])


def _values(item: Mapping[str, Any]) -> str:
    found = [
        f"{name} {p['value']:.3g} ({p['low']:.3g} to {p['high']:.3g}) {p['unit']}".rstrip(" 1")
        for cause in item["causes"]
        for name, p in cause["parameters"].items()
    ]
    return "; ".join(found)


def _rounds(rows: list[tuple[str, Mapping[str, Any]]]) -> str:
    """One line for each round."""
    lines = []
    for name, item in rows:
        odds = item["causes"][0]["log_odds"] if item["causes"] else None
        best = next((row for row in item["ranking"] if row[2]), None)
        behind = f"best: {best[0]} at {best[1]}, {best[3]:.0f}" if odds is None and best else ""
        lines.append(
            (
                name,
                _said(item),
                behind if odds is None else f"{odds:.0f}",
                "yes" if item["accepted"] else "no",
                _values(item),
                ", ".join(f"{effect} at {at}" for effect, at in item["tied"]) if item["tied"] else "",
                f"{item['gap']['nominal'][0]:.2f} / {item['gap']['refit'][0]:.2f} / {item['gap']['effect'][0]:.2f}",
            )
        )
    head = (
        "round",
        "it says",
        "log odds",
        "accepted",
        "identified (95 % interval)",
        "cannot be told apart",
        "held-out stretches, noise units",
    )
    return table(head, lines)


def _unseen(found: Mapping[str, Mapping[str, float]], floor: Mapping[str, float], units: Mapping[str, tuple[str, float]]) -> str:
    head = ("model", *(f"{column} [{units[column][0]}]" for column in floor))
    rows = [(name, *(f"{units[column][1] * item[column]:.3g}" for column in floor)) for name, item in found.items()]
    rows.append(("floor", *(f"{units[column][1] * value:.3g}" for column, value in floor.items())))
    return table(head, rows)


def _kuka(n: Mapping[str, Any]) -> str:
    asked = n["compliance"]
    late = table(
        ("axis and run", "encoders differ [urad rms]", "late by [ms]", "then left [urad rms]"),
        [(name, f"{1e6 * v['difference']:.0f}", f"{1e3 * v['late']:.2f}", f"{1e6 * v['left']:.0f}") for name, v in n["late"].items()],
    )
    return "\n\n".join(
        [
            "## kuka_kr300: axis 1, rigid gear",
            _rounds([(str(k), item) for k, item in enumerate(n["rounds"], start=1)]),
            "Held-out stretches: nominal / refitted / with the claim.  Run C, which no fit and no verdict saw, rms of what is left:",
            _unseen(n["unseen"], n["floor"], {"motor_torque": ("N m", 1.0), "link_angle": ("urad", 1e6)}),
            "![run C](kuka.png)",
            "The difference of the two encoders, which looks like gear torsion, is proportional to speed with one time for all axes:",
            late,
            f"Gear compliance asked for directly, beside what was accepted: {asked['value']:.2g} ({asked['low']:.2g} to "
            f"{asked['high']:.2g}) rad/(N m), gain in log likelihood {asked['gain']:.1f}; "
            f"the authors' parameter file has {asked['authors']:.2g} rad/(N m).",
            f"{n['seconds']:.0f} s. {facts(n['machine'])}",
        ]
    )


def _staubli(n: Mapping[str, Any]) -> str:
    rows = [(f"axis {name}, {k}", item) for name, own in n["axes"].items() for k, item in enumerate(own["rounds"], start=1)]
    parts = ["## staubli_tx40: Coulomb friction of each axis, coupling of 5 and 6", _rounds(rows)]
    compared = []
    for name, own in n["axes"].items():
        for item in own["rounds"]:
            for cause in item["causes"] if item["accepted"] else ():
                published = n["coupled"] if cause["at"] == "wrist" else {"coulomb": n["published"].get(cause["at"][-1])}
                for key, reference in published.items():
                    if key in cause["parameters"] and reference is not None:
                        p = cause["parameters"][key]
                        found = f"{p['value']:.3g} ({p['low']:.3g} to {p['high']:.3g})"
                        compared.append((f"axis {name}: {key} at {cause['at']}", found, f"{reference:.3g}"))
    parts += ["Against the authors' identification (all couplings of the rigid-body model, whole trajectory):"]
    parts += [table(("quantity", "found (95 % interval)", "published"), compared)]
    parts += ["The last 2.1 s, which no fit and no verdict saw, rms of what is left:"]
    for own in n["axes"].values():
        parts += [_unseen(own["unseen"], own["floor"], dict.fromkeys(own["floor"], ("N m", 1.0)))]
    parts += ["![axes 5 and 6](staubli_wrist.png)", f"{n['seconds']:.0f} s. {facts(n['machine'])}"]
    return "\n\n".join(parts)


def _rk4(n: Mapping[str, Any]) -> str:
    names = [name for name in n if isinstance(n[name], dict) and "rounds" in n[name]]
    rows = [(f"{name}, {k}", item) for name in names for k, item in enumerate(n[name]["rounds"], start=1)]
    put = [(name, *(f"{1e6 * n[name]['put_in'][disc]:.0f}" for disc in ("disc_1", "disc_2"))) for name in names if "put_in" in n[name]]
    shares = [
        (
            name,
            item["words"],
            f"{1e6 * item['total']:.1f}",
            f"{item['true_share']:.2f}",
            f"{item['alike'][0]:.2f} to {item['alike'][1]:.2f}",
        )
        for name, item in n["planes"].items()
    ]
    return "\n\n".join(
        [
            "## rk4_rotor: unbalance, and in which plane",
            _rounds(rows),
            "The end of the run-up, above 1810 rpm, which no fit and no verdict saw, rms of what is left of the probe:",
            _unseen(n["run_up"]["unseen"], n["run_up"]["floor"], dict.fromkeys(n["run_up"]["floor"], ("um", 1e6))),
            "Put in [g mm]:",
            table(("condition", "disc 1", "disc 2"), put),
            "With measured influence vectors (all other conditions) in place of a model:",
            table(("condition", "put in", "total found [g mm]", "share of disc 2", "shares that cannot be told apart"), shares),
            "![shares](rk4_planes.png)",
            f"{n['seconds']:.0f} s. {facts(n['machine'])}",
        ]
    )

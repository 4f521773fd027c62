"""The results of the benchmark as text."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from benchmarks.stiffness_laws.claim import Claim
from benchmarks.writing import facts, table


def report(numbers: Mapping[str, Any], claims: Sequence[Claim]) -> str:
    """Markdown: claims, sweep, accuracy, linearised motion, windows."""
    shapely, each = numbers["shapely"], numbers["shapely_design"]
    first = next(iter(numbers["sweeps"].values()))
    parts = [
        "# Teeth of the double harmonic transmission",
        "Sets A and C of models/double_harmonic_transmission.py. CPU seconds, one process.",
        facts(numbers["machine"]),
        "## Claims of the paper",
        table(("where", "the paper", "found", "verdict"), [(c.where, c.says, c.found, c.verdict) for c in claims]),
        "## Design sweep",
        f"Random designs over the search box, one call; median of {numbers['repeats']}.",
        table(
            ("set", "designs", "seconds (fastest, slowest)", "designs/s", "admissible"),
            [
                (
                    name,
                    r["designs"],
                    f"{r['seconds']:.2f} ({r['fastest']:.2f}, {r['slowest']:.2f})",
                    f"{r['per_second']:.0f}",
                    r["admissible"],
                )
                for name, r in numbers["sweeps"].items()
            ],
        ),
        "Verdicts against full outlines at half a degree, refined 32 times where corners may clip:",
        table(
            (
                "set",
                "designs",
                "cannot be built",
                "same verdict",
                "other verdict",
                "deepest overlap missed [um]",
                "distance too large by [um]",
            ),
            [
                (
                    name,
                    r["designs"],
                    r["cannot_be_built"],
                    r["same"],
                    r["different"],
                    f"{1e6 * r['deepest_missed']:.2f}",
                    f"{1e6 * r['gap_too_large_by']:.2f}",
                )
                for name, r in numbers["accuracy"].items()
            ],
        ),
        "## Against shapely",
        f"The same {shapely['positions']} pairs of outlines: {shapely['ours']:.3f} s with our arrays, {shapely['shapely']:.3f} s with "
        f"shapely (distance and intersection); largest difference of a distance {shapely['largest_difference']:.1e} m. A design at the 61 "
        f"angles of the sweep takes shapely {1e3 * each['seconds_per_design']:.2f} ms (placing the teeth included), the sweep "
        f"{1e3 / first['per_second']:.2f} ms.",
        "## The paper's equations, corrected, against the exact motion",
        table(
            ("set", "stage", "up to 90 deg [um]", "up to 180 deg [um]"),
            [(r["set"], r["stage"], f"{1e6 * r['to_90']:.2f}", f"{1e6 * r['to_180']:.2f}") for r in numbers["linearised"]],
        ),
        "## The sets",
        "\n".join(
            f"- {name}: i = {r['ratio']:.6g}, lost motion {1e3 * r['lost_motion_rad']:.3f} mrad. {r['words']}"
            for name, r in numbers["gears"].items()
        ),
    ]
    if numbers["windows"]:
        parts.append("## Windows")
        parts += [f"{name}\n\n```\n{window['words']}\n```" for name, window in numbers["windows"].items()]
    return "\n\n".join(parts)

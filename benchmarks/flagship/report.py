"""The answers as a table."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from benchmarks.writing import facts, table


def report(numbers: Mapping[str, Any]) -> str:
    """results.md"""
    rows = []
    for case in numbers["cases"]:
        if "error" in case:
            rows.append([case["case"], case["planted"], f"stopped: {case['error']}", "nothing", "", ""])
            continue
        said = " and ".join(f"{cause['effect']} at {cause['place']} ({cause['law']})" for cause in case["causes"])
        right = [word for word in ("verdict", "effect", "place") if case[f"{word}_right"]]
        gap = case["gap"]
        rows.append(
            [
                case["case"],
                case["planted"],
                f"{case['verdict']}: {said}" if said else case["verdict"],
                "all" if len(right) == 3 else ", ".join(right) or "nothing",
                " / ".join(f"{gap[name]['value']:.3g}" for name in ("nominal", "refitted", "with_cause")),
                f"{case['cpu_s']:.0f}",
            ]
        )
    whole = sum(all(case.get(f"{word}_right") for word in ("verdict", "effect", "place")) for case in numbers["cases"])
    tried = "one law of each family tried, as in the demo" if numbers["laws"] == "one" else "all laws of the library tried"
    head = ("case", "planted", "answer", "right", "gap", "CPU [s]")
    return "\n".join(
        [
            "# Planted effects in the robot joint line, diagnosed",
            "",
            f"{whole} of {len(numbers['cases'])} right in verdict, effect and place. Gap: root mean square on the held-out quarter of the"
            " record, in standard deviations of the noise, of the nominal, the refitted and the final model.",
            "",
            table(head, rows),
            "",
            f"Seed {numbers['seed']}; record: {', '.join(numbers['records'])}; {tried}; one process a case."
            " The machine was shared with other work: CPU seconds, which that makes longer too.",
            "",
            facts(numbers["machine"]),
        ]
    )

"""Makes docs/verification.md:  python docs/make_verification.py [FILE]

Every published case is run again with the scenes of tests/verification; what is too slow for that is read from the
results that the benchmarks left in benchmarks/*/results.json.
"""

from __future__ import annotations

import json
import math
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

import hdrive_mbs as hm  # noqa: E402
from benchmarks.rotor_speed import beam  # noqa: E402
from models.double_harmonic_transmission import gear  # noqa: E402
from models.harmonic_drive_train import build as folega  # noqa: E402
from tests.verification.scenes import chain  # noqa: E402
from tests.verification.whirl_scenes import FULL_SPEED, disc, overhung_closed_form, overhung_disc, overhung_machine, pinned, two_discs  # noqa: E402


@dataclass(frozen=True, kw_only=True)
class Value:
    """A published number, as it is printed, beside ours."""

    what: str
    published: str
    ours: float
    note: str = ""

    @property
    def deviation(self) -> float:
        return self.ours / float(self.published) - 1.0

    @property
    def rounding(self) -> float:
        """Half of the last printed digit, relative."""
        mantissa, _, exponent = self.published.lower().partition("e")
        decimals = len(mantissa.partition(".")[2])
        return 0.5 * 10.0 ** (int(exponent or 0) - decimals) / abs(float(self.published))

    @property
    def met(self) -> bool:
        return abs(self.deviation) <= self.rounding * (1.0 + 1e-9)

    def row(self) -> str:
        deviation = "0" if abs(self.deviation) < 1e-9 else f"{self.deviation:+.1e}"
        said = "met" if self.met else self.note or "**not met**"
        return f"| {self.what} | {self.published} | {self.ours:.7g} | {deviation} | {self.rounding:.1e} | {said} |"


@dataclass(frozen=True, kw_only=True)
class Case:
    """One published example."""

    title: str
    text: str
    unit: str
    values: tuple[Value, ...]
    test: str

    def lines(self) -> Iterator[str]:
        yield from (
            f"### {self.title}",
            "",
            self.text,
            "",
            f"| value [{self.unit}] | published | ours | relative deviation | half of the last digit | |",
        )
        yield "|---|---|---|---|---|---|"
        yield from (value.row() for value in self.values)
        yield from ("", f"Test: `tests/verification/{self.test}`.", "")


def lateral(modes: hm.WhirlModes) -> np.ndarray:
    return np.sort(modes.frequencies[[word not in ("torsional", "axial") for word in modes.whirl]])


def numbered(published: Sequence[str], ours: Sequence[float], word: str = "frequency", note: str = "") -> tuple[Value, ...]:
    return tuple(Value(what=f"{word} {k}", published=p, ours=float(o), note=note) for k, (p, o) in enumerate(zip(published, ours), start=1))


BOOK = "Friswell, Penny, Garvey, Lees, *Dynamics of Rotating Machines*, Cambridge 2010"
DIGIT = "cut off, not rounded, in the book"


def consistent(discs: Sequence[tuple[int, hm.Rotor]], springs: Sequence[int], kx: float, ky: float) -> np.ndarray:
    """Frequencies [rad/s] at 4000 rpm of the book's shaft with six elements whose polar inertia is consistent, as the book has it.

    discs, springs : stations.  Assembled from the elements of benchmarks/rotor_speed, which nothing of hdrive_mbs went into.
    """
    mass, polar, x, y = (np.zeros((14, 14)) for _ in range(4))
    for first in range(0, 12, 2):
        for whole, part in zip((mass, polar, x, y), (*(parts := beam._element(0.25)), parts[2])):
            whole[first : first + 4, first : first + 4] += part
    for station, part in discs:
        mass[2 * station, 2 * station] += part.mass
        mass[2 * station + 1, 2 * station + 1] += part.transverse_inertia
        polar[2 * station + 1, 2 * station + 1] += part.polar_inertia
    for station in springs:
        x[2 * station, 2 * station] += kx
        y[2 * station, 2 * station] += ky
    zero = np.zeros_like(mass)
    both = np.linalg.inv(np.block([[mass, zero], [zero, mass]]))
    turning = FULL_SPEED * np.block([[zero, polar], [-polar, zero]])
    state = np.block([[np.zeros((28, 28)), np.eye(28)], [-both @ np.block([[x, zero], [zero, y]]), -both @ turning]])
    found = np.linalg.eigvals(state).imag
    return np.sort(found[found > 1.0])


def lumped(published: Sequence[str], ours: Sequence[float], same_elements: Sequence[float]) -> tuple[Value, ...]:
    """Values with what the same elements give where their polar inertia is not put to the stations."""
    notes = [f"{value:.6g} with consistent polar inertia" for value in same_elements]
    return tuple(
        Value(what=f"frequency {k}", published=p, ours=float(o), note=note)
        for k, (p, o, note) in enumerate(zip(published, ours, notes), start=1)
    )


def friswell() -> Iterator[Case]:
    masses = []
    for diameter, printed in ((0.28, ("32.5897", "0.17809", "0.32956")), (0.35, ("51.5253", "0.42358", "0.80508"))):
        part = disc(diameter)
        names = ("mass [kg]", "transverse inertia [kg m²]", "polar inertia [kg m²]")
        numbers = (part.mass, part.transverse_inertia, part.polar_inertia)
        masses += [Value(what=f"{1e3 * diameter:.0f} mm: {n}", published=p, ours=o, note=DIGIT) for n, p, o in zip(names, printed, numbers)]
    yield Case(
        title="Discs of example 5.9.1",
        text="Steel discs of 70 mm, bored to the shaft, from `Rotor.disc`.",
        unit="see row",
        values=tuple(masses),
        test="test_published_rotors.py",
    )
    pair = ((2, disc(0.28)), (4, disc(0.35))), (0, 6)
    same = {"unit": "rad/s", "test": "test_published_rotors.py"}
    rest, speed = ["86.66", "274.31", "716.78"], ["85.39", "87.80", "251.78", "294.71", "600.18"]
    yield Case(
        title="Example 5.9.1 at rest",
        text="Two discs on a shaft of 1.5 m, isotropic bearings of 1 MN/m, six Timoshenko elements; each frequency comes twice.",
        values=numbered(rest, lateral(hm.whirl_modes(two_discs(kx=1e6), 0.0, count=20))[:6:2], note=DIGIT),
        **same,
    )
    yield Case(
        title="Example 5.9.1 at 4000 rpm",
        text="The same rotor with its gyroscopic moments.",
        values=lumped(speed, lateral(hm.whirl_modes(two_discs(kx=1e6), FULL_SPEED, count=20)), consistent(*pair, 1e6, 1e6)),
        **same,
    )
    yield Case(
        title="Example 5.9.2 at 4000 rpm",
        text="Anisotropic bearings: 1 and 0.8 MN/m.",
        values=lumped(
            ["82.33", "86.86", "239.64", "287.25", "583.49"],
            lateral(hm.whirl_modes(two_discs(kx=1e6, ky=0.8e6), FULL_SPEED, count=20)),
            consistent(*pair, 1e6, 0.8e6),
        ),
        **same,
    )
    damped = lateral(hm.whirl_modes(two_discs(kx=1e6, damping=3e3), count=20))[:6:2] / (2.0 * math.pi)
    yield Case(
        title="Example 5.9.5 at rest",
        text="Bearings with 3 kN s/m; damped frequencies, each twice.",
        unit="Hz",
        values=numbered(["13.89", "46.54", "103.22"], damped, note=DIGIT),
        test="test_published_rotors.py",
    )
    overhung = np.delete(lateral(hm.whirl_modes(overhung_machine(), FULL_SPEED, count=20))[:6], 3)
    whole = np.delete(consistent(((6, disc(0.35)),), (0, 4), 1e7, 1e7)[:6], 3)
    yield Case(
        title="Example 5.9.9 at 4000 rpm",
        text="Overhung disc. The book leaves out the second forward frequency; an exact Timoshenko beam by transfer matrices has it "
        "(same test).",
        values=lumped(["76.19", "103.91", "565.99", "647.75", "1174.2"], overhung, whole),
        **same,
    )
    torsion = hm.modes(chain([3.5e-3] * 3 + [0.15, 0.05], [12e3, 12e3, 14e3, 10e3])).undamped / (2.0 * math.pi)
    yield Case(
        title="Torsional chain of five discs",
        text="3 x 3.5e-3, 0.15 and 0.05 kg m² with 12, 12, 14 and 10 kN m/rad.",
        unit="Hz",
        values=numbered(["81.21", "141.21", "378.95", "536.36"], torsion),
        test="test_published_torsion.py",
    )


def others() -> Iterator[Case]:
    found = hm.modes(chain([0.05, 0.02, 0.03, 0.2], [5e3, 2e3, 1e4], [2.0, 1.0, 3.0]))
    values = numbered(["164.1095", "605.3692", "711.7557"], found.undamped, "undamped frequency")
    values += numbered(["164.0049", "602.7842", "703.8490"], found.damped, "damped frequency")
    yield Case(
        title="Damped torsional chain of OpenTorsion",
        text="Example of the open-source package OpenTorsion: 0.05, 0.02, 0.03, 0.2 kg m², 5, 2, 10 kN m/rad, 2, 1, 3 N m s/rad.",
        unit="rad/s",
        values=values,
        test="test_published_torsion.py",
    )
    hertz = []
    for speed, printed in ((0.0, ["122.7475", "490.9899", "1104.7273"]), (1e4, ["119.7548", "125.815", "479.0191", "503.2598"])):
        modes = hm.whirl_modes(pinned(1e14), speed, count=12)
        whirling = modes.frequencies[[word in ("backward", "forward") for word in modes.whirl]] / (2.0 * math.pi)
        for k, text in enumerate(printed):
            name = f"at {speed:g} rad/s, frequency {k + 1}"
            hertz.append(
                Value(
                    what=name,
                    published=text,
                    ours=float(whirling[2 * k if speed == 0.0 else k]),
                    note="polar inertia of the shaft at its stations"
                    if speed
                    else "the bearings give way: 1.7e-8 times the number squared",
                )
            )
    yield Case(
        title="Spinning pinned shaft",
        text="0.9 m x 50 mm of steel, bearings of 1e14 N/m, 96 Euler-Bernoulli elements without rotary inertia; published closed form.",
        unit="Hz",
        values=tuple(hertz),
        test="test_published_rotors.py",
    )
    modes = hm.whirl_modes(overhung_disc(), 100.0)
    senses = {"forward": 1.0, "backward": -1.0}
    signed = sorted(senses[word] * w for word, w in zip(modes.whirl, modes.frequencies) if word in senses)
    assert np.allclose(signed, overhung_closed_form(100.0), rtol=1e-9)
    yield Case(
        title="Overhung gyroscopic disc",
        text="Massless cantilever with a disc (5 kg, 0.02 and 0.04 kg m²) at 100 rad/s; negative: backward whirl.",
        unit="rad/s",
        values=numbered(["-845.1467", "-115.4136", "126.4118", "1034.1485"], signed),
        test="test_published_rotors.py",
    )


def papers() -> Iterator[Case]:
    law = folega().parts["gear"].stiffness
    torques = {"0": "1.31e-03", "23.5": "2.04e-03", "98": "3.21e-03", "137": "3.56e-03"}
    values = [
        Value(what=f"twist at {t} N m", published=p, ours=law.half_gap if t == "0" else float(law.twist(float(t))))
        for t, p in torques.items()
    ]
    yield Case(
        title="Table 1 of Folega et al. 2014",
        text="HDUC 32-100, equations (7)-(10) with the misprints in (9) and (10) corrected; as printed: 5.54e-03 and 7.72e-03 rad.",
        unit="rad",
        values=tuple(values),
        test="test_table_1.py",
    )
    width = (hm.arcmin(1.0), hm.arcmin(9.0))
    yield Case(
        title="Lost motion of Folega et al. 2014",
        text="1 to 9 minutes of arc, below (17).",
        unit="rad",
        values=numbered(("2.9e-4", "26e-4"), width, "lost motion"),
        test="test_misprints.py",
    )
    a = gear("A")
    zones = hm.zones(a)
    turned = tuple(float(np.degrees(zone.centre)) for zone in zones[1:])
    yield Case(
        title="Double harmonic transmission of Ianici 2017",
        text="Set A of `models/double_harmonic_transmission.py`: ratio of the example, four equidistant zones of engagement (first at 0°).",
        unit="see row",
        values=(Value(what="size of the ratio", published="50", ours=abs(a.ratio)), *numbered(("90", "180", "270"), turned, "zone [deg]")),
        test="test_teeth_paper.py",
    )


def kept(name: str) -> Any:
    return json.loads((ROOT / "benchmarks" / name / "results.json").read_text("utf-8"))


def independent() -> Iterator[str]:
    """Rows from committed results: what is checked against programs and not against print."""
    yield from ("| what | against | largest relative difference | from |", "|---|---|---|---|")
    for line, found in kept("bearings")["scipy"].items():
        yield (
            f"| run-up of {line} through its critical speeds: peak, its speed | the same equations written apart, scipy "
            f"| {found['amplitude']:.1e}, {found['speed']:.1e} | [bearings](../benchmarks/bearings/results.md) |"
        )
    rotor = kept("rotor_speed")
    for ours in rotor["campbell"]:
        yield (
            f"| Campbell diagram, {ours['elements']} elements: lowest, sixth lateral frequency | converged beam "
            f"| {ours['errors'][0]:.1e}, {ours['errors'][5]:.1e} | [rotor speed](../benchmarks/rotor_speed/results.md) |"
        )
    for ours in rotor["ross"]["campbell"][:1]:
        yield (
            f"| the same of ROSS {rotor['ross']['ross-rotordynamics']}, {ours['elements']} elements | converged beam "
            f"| {ours['errors'][0]:.1e}, {ours['errors'][5]:.1e} | [rotor speed](../benchmarks/rotor_speed/results.md) |"
        )


def page() -> str:
    """The whole page."""
    groups = {f"From the book: {BOOK}": [*friswell()], "Other published numbers": [*others()], "From the papers": [*papers()]}
    values = [value for cases in groups.values() for case in cases for value in case.values]
    rest = [value for value in values if not value.met]
    worst = max(rest, key=lambda value: abs(value.deviation))
    lines = [
        "# Verification",
        "",
        "Published cases, each with the printed value, ours, and the deviation. Made by `python docs/make_verification.py`, which runs",
        "every case again; a test compares this page with what it gives. What is not in print is held against independent programs, at",
        "the end.",
        "",
        f"{len(values)} printed values. {len(values) - len(rest)} are met within half of their last digit. The largest relative",
        f"deviation of the other {len(rest)} is {abs(worst.deviation):.1e} ({worst.published} printed, {worst.ours:.6g} here), and",
        "their rows say why. This",
        "package puts the polar inertia of a shaft element at its ends ([Rotors on bearings](rotors.md)), where the book spreads it along",
        "the element: with six elements that shows in the last digits of the higher frequencies of a turning shaft. The column then gives",
        "what the same six elements make of it when the polar inertia is spread, in a program that shares nothing with this one: the",
        "digits of the book.",
        "",
    ]
    for title, cases in groups.items():
        lines += [f"## {title}", ""]
        for case in cases:
            lines += case.lines()
    lines += [
        "## Not in print: against independent programs",
        "",
        "The engine's run-ups, its Campbell diagrams and its conservation of energy have no published numbers. They are compared with",
        "programs that share no code with this package. Numbers from the last run of the benchmarks:",
        "",
        *independent(),
        "",
        "Further, run with every test: the Sommerfeld effect with its threshold of capture against an integration with scipy",
        "(`test_sommerfeld.py`), balances of energy and momentum (`test_conservation.py`, `test_rotor_conservation.py`), observed",
        "orders of the solvers (`test_solver_order.py`), Exudyn's own linearisation against ours (`test_published_rotors.py`), the",
        "plant of the bench records against the package (`test_measured_bench.py`, `test_measured_rotor_bench.py`), and tooth",
        "clearances against a polygon library ([teeth](../benchmarks/teeth/results.md)).",
        "",
        "What the three papers behind the models *say*, as far as it is more than a number, is judged in [Claims](claims.md).",
    ]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    target = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "docs" / "verification.md"
    target.write_text(page(), "utf-8")
    print(target)

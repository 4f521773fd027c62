"""What parts of rotor lines and scenes of them refuse: value, unit, limit and the way out."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

import hdrive_mbs as hm
from hdrive_mbs.errors import LawError
from hdrive_mbs.expression import Value
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment
from tests.unit.rotor_pieces import (
    DISC,
    STEEL,
    FloatArray,
    line,
    section,
)

# -- stations, names, positions ------------------------------------------------------------------------


RING = {"mass": 0.3, "polar_inertia": 3e-4, "transverse_inertia": 2e-4}
LAW = hm.LinearBearing.isotropic(radial=1e6, damping=0.0)


@pytest.mark.parametrize(
    ("message", "make"),
    [
        (r"ShaftSection\.length = 0 m: must be greater than 0\.0 m", lambda: section(0.0)),
        (r"ShaftSection\.length = -0\.1 m", lambda: section(-0.1)),
        (r"ShaftSection\.length = nan m: must be a finite number", lambda: section(math.nan)),
        (r"RigidSection\.length = 0 m: must be greater than 0\.0 m", lambda: hm.RigidSection(length=0.0)),
        (r"ShaftSection\.diameter = 0 m", lambda: section(0.1, diameter=0.0)),
        (r"ShaftSection\.bore = 0\.03 m: must be less than the diameter of 0\.03 m", lambda: section(0.1, bore=0.03)),
        (r"ShaftSection\.elements = 2\.5: must be a whole number", lambda: section(0.1, density=STEEL, elements=2.5)),
        (r"ShaftSection\.elements = 2 of a massless section: .* give a density", lambda: section(0.1, elements=2.0)),
        (r"Rotor\.mass = 0 kg: must be greater than 0\.0 kg", lambda: DISC.replacing(mass=0.0)),
        (r"Rotor\.mass = -1 kg", lambda: DISC.replacing(mass=-1.0)),
        (r"Rotor\.polar_inertia = 0 kg m\^2", lambda: DISC.replacing(polar_inertia=0.0)),
        (r"Rotor\.transverse_inertia = -1 kg m\^2", lambda: DISC.replacing(transverse_inertia=-1.0)),
        (
            r"Rotor\.polar_inertia = 0\.0206 kg m\^2 is more than twice transverse_inertia = 0\.01 kg m\^2.*Were the two exchanged\?",
            lambda: DISC.replacing(polar_inertia=0.0206, transverse_inertia=0.01),
        ),
        (r"Rotor\.eccentricity = -1e-05 m: must be at least 0\.0 m", lambda: DISC.replacing(eccentricity=-1e-5)),
        (r"Rotor\.disc diameter = 0: must be greater than 0", lambda: hm.Rotor.disc(diameter=0.0, thickness=0.1, density=STEEL)),
        (
            r"Rotor\.disc eccentricity = 20 m: must be at most the radius of the disc, 0\.05 m\..* 20e-6 m",
            lambda: hm.Rotor.disc(diameter=0.1, thickness=0.1, density=STEEL, eccentricity=20.0),
        ),
        (r"Rotor\.disc thickness = nan", lambda: hm.Rotor.disc(diameter=0.1, thickness=math.nan, density=STEEL)),
        (
            r"Rotor\.disc bore = 0\.2 m: .*less than the diameter of 0\.1 m",
            lambda: hm.Rotor.disc(diameter=0.1, bore=0.2, thickness=0.1, density=STEEL),
        ),
        (r"Bearing\.mass = -0\.3 kg: must be at least 0\.0 kg", lambda: hm.Bearing(law=LAW, mass=-0.3)),
        (r"Bearing\.polar_inertia = 0\.001 kg m\^2 is more than twice transverse_inertia", lambda: hm.Bearing(law=LAW, polar_inertia=1e-3)),
        (r"Bearing\.law = 1000000\.0: must be a bearing law", lambda: hm.Bearing(law=1e6)),
        (r"Bearing\.housing = 2\.5: must be a Housing", lambda: hm.Bearing(law=LAW, housing=2.5)),
        (r"Housing\.mass = 0 kg: must be greater than 0\.0 kg", lambda: hm.Housing.isotropic(mass=0.0, stiffness=1e6)),
        (
            r"Housing\.power = 4: must be an odd whole number",
            lambda: hm.Housing.isotropic(mass=1.0, stiffness=1e6, power_stiffness=1.0, power=4.0),
        ),
    ],
)  # fmt: skip
def test_a_part_that_cannot_be_is_refused_with_value_unit_and_limit(message: str, make: Any) -> None:
    with pytest.raises(hm.ParameterError, match=message):
        make()


@pytest.mark.parametrize(
    ("kind", "message", "parts", "chains"),
    [
        (
            hm.SceneError,
            r"'a\.x' has no inertia \(0 kg\).*Give the ring .* mass and moments of inertia, put a Rotor there, or give the shaft a density",
            {"a": hm.Bearing(law=LAW), "s": section(0.1), "d": DISC},
            [("a", "s", "d")],
        ),
        (
            hm.SceneError,
            r"'a\.psi' has no inertia \(0 kg m\^2\)",
            {"a": hm.Bearing(law=LAW, mass=0.3), "s": section(0.1), "d": DISC},
            [("a", "s", "d")],
        ),
        (
            hm.SceneError,
            r"'a' has no inertia \(0 kg m\^2\)",
            {"a": hm.Bearing(law=LAW, mass=0.3, transverse_inertia=1e-3), "s": section(0.1), "d": DISC},
            [("a", "s", "d")],
        ),
        (hm.SceneError, r"Loose end: nothing is connected to 's\.b' \(ShaftSection\)", {"s": section(0.1), "d": DISC}, [("d", "s")]),
        (
            hm.ParameterError,
            r"'s': both ends are held by the ground, so the section does nothing; remove it",
            {"s": section(0.1), "d": DISC, "b": hm.Bearing(law=LAW)},
            [("ground", "s", "ground"), ("b", "d")],
        ),
        (
            hm.SceneError,
            r"'s\.a' and 's\.b' lie 0\.1 m apart by this connection and 0 m by another",
            {"s": section(0.1), "d": DISC},
            [("d", "s", "d")],
        ),
        (
            hm.SceneError,
            r"lie 0\.1 m apart by this connection and 0\.2 m by another one, so the shaft does not close.*correct the lengths",
            {"s": section(0.1), "t": section(0.2), "d": DISC, "e": DISC},
            [("d", "s", "e"), ("d", "t", "e")],
        ),
        (
            hm.SceneError,
            r"so the shaft does not close",
            {"r": hm.RigidSection(length=0.1), "d": DISC, "e": DISC},
            [("d", "r", "e"), ("d", "e")],
        ),
        (
            hm.SceneError,
            r"more than one Gravity part",
            {"d": DISC, "g": hm.Gravity(), "h": hm.Gravity(), "b": hm.Bearing(law=LAW)},
            [("b", "d")],
        ),
    ],
)
def test_a_line_that_cannot_be_solved_is_refused_with_the_way_out(
    kind: type[Exception], message: str, parts: dict[str, hm.Component], chains: list[tuple[str, ...]]
) -> None:
    with pytest.raises(kind, match=message):
        hm.Scene(name="bad", parts=parts, connections=chains).network()


def test_a_bearing_law_of_ones_own_cannot_hide_a_hold_on_the_spin() -> None:
    class Sticky(hm.BearingLaw):
        def stiffness_matrix(self) -> FloatArray:
            return np.eye(6)

    with pytest.raises(LawError, match=r"'b': the matrices of Sticky have entries for phi; .*forces\(\)"):
        line("bad", {"d": DISC, "b": hm.Bearing(law=Sticky())}, ("b", "d")).network()


@dataclass(frozen=True, kw_only=True)
class Seal(hm.Component):
    """A part of a user's own: force along x and y that depends on both rates, and says that it damps."""

    place: str = hm.option("where it sits")
    factor: float = hm.parameter("N s^3/m^3", "F = factor |v|^2 v")

    def build(self, name: str, draft: Draft) -> None:
        station = draft.station(self.place, asked_by=repr(name))

        def forces(moment: Moment, s: Mapping[str, Value], v: Mapping[str, Value]) -> Mapping[str, Value]:
            size = self.factor * (v["x"] ** 2 + v["y"] ** 2)
            return {"x": size * v["x"], "y": size * v["y"]}

        draft.add_coupling(f"{name}.force", {key: station.stretch(key) for key in "xy"}, forces, dissipative=True)


def test_a_coupling_that_says_it_damps_must_damp() -> None:
    def scene(factor: float) -> hm.Scene:
        return hm.Scene(name="sealed", parts={"d": DISC, "seal": Seal(place="d", factor=factor)}, connections=[])

    start = {"d.x_rate": 0.3, "d.y_rate": 0.4}
    response = hm.simulate(scene(100.0), 0.1, solver=hm.DormandPrince(), initial=start)
    # m v' = -f v^3:  v = v0/sqrt(1 + 2 f v0^2 t/m)
    wanted = 0.3 / np.sqrt(1.0 + 2.0 * 100.0 * 0.25 * response.times / 8.0)
    np.testing.assert_allclose(response.values["d.x_rate"], wanted, rtol=1e-7)
    with pytest.raises(LawError, match=r"'seal\.force' claims to be dissipative but turns -.* W into heat"):
        scene(-100.0).network()


def test_parts_that_only_turn_have_no_lateral_place() -> None:
    class Spring(hm.Component):
        def flanges(self) -> tuple[hm.Flange, ...]:
            return (hm.Flange(name=""),)

        def build(self, name: str, draft: Any) -> None:
            draft.station(name, "A spring")

    with pytest.raises(hm.PlaceError, match=r"A spring needs a place with lateral motion, but 'spring' only turns\. Such places: none"):
        line("bad", {"spring": Spring(), "i": hm.Inertia(inertia=1.0)}, ("spring", "i")).network()

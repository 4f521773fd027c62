"""Rotors saved by ROSS: the same whirl as ROSS finds, and everything that does not map is named."""

from __future__ import annotations

import copy
import json
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import hdrive_mbs as hm
from hdrive_mbs.errors import FileFormatError, HdriveError

DATA = Path(__file__).parents[1] / "data"
"""The rotor and ROSS's own values, made by make_ross_rotor.py there with ROSS 2.3.0."""


@pytest.fixture(scope="module")
def scene() -> hm.Scene:
    return hm.load_ross(DATA / "ross_rotor.toml")


@pytest.fixture
def document() -> dict[str, Any]:
    return copy.deepcopy(json.loads((DATA / "ross_rotor.json").read_text()))


def points() -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = json.loads((DATA / "ross_rotor_values.json").read_text())["points"]
    return found


def written(folder: Path, document: dict[str, Any]) -> Path:
    path = folder / "rotor.json"
    path.write_text(json.dumps(document))
    return path


# -- the same rotor -------------------------------------------------------------------------------------


def test_at_rest_lateral_and_axial_modes_are_those_of_ross(scene: hm.Scene) -> None:
    """The same beam elements: what is left is rounding of the eigenvalues (1e-9) and of ROSS's own."""
    (point,) = [one for one in points() if one["speed"] == 0.0]
    ours = hm.whirl_modes(scene, 0.0, count=len(point["modes"]))
    compared = 0
    for k, theirs in enumerate(point["modes"]):
        if ours.whirl[k] == "torsional":
            continue
        compared += 1
        assert ours.frequencies[k] == pytest.approx(theirs["frequency"], rel=1e-8)
        assert ours.damping_ratios[k] == pytest.approx(theirs["damping_ratio"], rel=1e-6, abs=1e-9)
        assert theirs["whirl"].lower() == {"axial": "none"}.get(ours.whirl[k], ours.whirl[k])
    assert compared == 7


@pytest.mark.parametrize("point", points(), ids=lambda point: f"{point['speed']:g} rad/s")
def test_at_speed_modes_are_those_of_ross_but_for_the_lumped_polar_inertia_of_the_shaft(scene: hm.Scene, point: dict[str, Any]) -> None:
    """Here the polar inertia of an element sits at its ends, in ROSS it is consistent.

    Both converge: with elements of a half and a quarter of the length the largest difference of a lateral mode at
    400 rad/s was measured to fall from 1.5e-5 to 3.7e-6 and 9.4e-7, that of the torsional one from 1.4e-4 to 3.4e-5 and
    8.5e-6.  For torsion of a bare shaft it would be (w L sqrt(rho/G))^2/12 = 2.4e-4 (lumped and consistent mass lie
    half of it below and above).
    """
    ours = hm.whirl_modes(scene, point["speed"], count=len(point["modes"]))
    for k, theirs in enumerate(point["modes"]):
        bare_shaft = (theirs["frequency"] * 0.15) ** 2 * 7810.0 / 80e9 / 12.0
        tolerance = bare_shaft if ours.whirl[k] == "torsional" else 2e-5
        assert ours.frequencies[k] == pytest.approx(theirs["frequency"], rel=tolerance), ours.whirl[k]
        assert ours.damping_ratios[k] == pytest.approx(theirs["damping_ratio"], rel=3e-4, abs=1e-9), ours.whirl[k]


def test_toml_and_json_give_the_same_scene_and_it_survives_our_own_file(scene: hm.Scene, tmp_path: Path) -> None:
    assert hm.load_ross(DATA / "ross_rotor.json", name=scene.name) == scene
    assert hm.load_scene(hm.save_scene(scene, tmp_path / "line.toml")) == scene
    assert "saved by ROSS 2.3.0" in scene.notes


def test_each_element_has_its_place(scene: hm.Scene) -> None:
    parts = dict(scene.parts)
    assert set(parts) == {"disk_0", "large_disc", "drive_end", "seal_2", "free_end", *(f"section_{k}" for k in range(1, 6))}
    assert list(scene.connections[0])[:3] == ["drive_end", "section_1", "disk_0"]
    sections = [parts[f"section_{k}"] for k in range(1, 6)]
    # from node 0 to the disc at 2, the seal at 5, the step at 6, the disc at 8, the end at 10
    assert [(part.length, part.elements) for part in sections] == [  # type: ignore[attr-defined]
        (pytest.approx(0.2), 2),
        (pytest.approx(0.3), 3),
        (pytest.approx(0.1), 1),
        (pytest.approx(0.3), 2),
        (pytest.approx(0.3), 2),
    ]
    housing = parts["drive_end"].housing  # type: ignore[attr-defined]
    assert (housing.mass, housing.stiffness_x, housing.damping_y) == (2.0, 3e7, 200.0)
    law = parts["free_end"].law  # type: ignore[attr-defined]
    assert law.speeds == (0.0, 200.0, 400.0)
    assert law.stiffness_yx == (0.0, -3e5, -5e5)


# -- what does not map ---------------------------------------------------------------------------------------


def test_everything_that_does_not_map_is_named_at_once_and_can_be_left_out(document: dict[str, Any], tmp_path: Path) -> None:
    document["ShaftElement_Shaft Element 3"] |= {"alpha": 0.5, "axial_force": 100.0}
    document["ShaftElement_Shaft Element 7"] |= {"odr": 0.06, "gyroscopic": False}
    document["BearingElement_Free end"]["mxx"] = [1.5, 1.5, 1.5]
    document["GearElement_Gear 1"] = {"n": 4, "m": 3.0}
    document["MagneticBearingElement_AMB"] = {"n": 4, "g0": 1e-3}
    path = written(tmp_path, document)
    with pytest.raises(FileFormatError) as caught:
        hm.load_ross(path)
    told = str(caught.value)
    assert "7 of this rotor do not map" in told
    for words in (
        "Shaft Element 3.alpha: 0.5 1/s: damping in proportion to mass",
        "Shaft Element 3.axial_force: 100 N",
        "Shaft Element 7.taper: a cone from 0.05 to 0.06 m",
        "Shaft Element 7.gyroscopic",
        "Free end.mxx: added mass of 1.5 kg",
        "Gear 1: a GearElement",
        "AMB: a MagneticBearingElement",
    ):
        assert words in told
    rest = hm.load_ross(path, leave_out=["Shaft Element *", "Free end.mxx", "Gear 1", "AMB"])
    assert "Left out: Gear 1: a GearElement." in rest.notes
    assert rest.parts["section_4"].diameter == 0.05  # type: ignore[attr-defined]
    assert any(part.diameter == pytest.approx(0.055) for part in rest.parts.values() if isinstance(part, hm.ShaftSection))


def test_a_linked_bearing_without_a_mass_or_a_foundation_is_named(document: dict[str, Any], tmp_path: Path) -> None:
    without_mass = {key: value for key, value in document.items() if not key.startswith("PointMass")}
    with pytest.raises(FileFormatError, match="Drive end: it is linked to node 11, and there is no point mass there"):
        hm.load_ross(written(tmp_path, without_mass))
    without_base = {key: value for key, value in document.items() if key != "BearingElement_Foundation"}
    with pytest.raises(FileFormatError, match=r"Drive end: .*no bearing from there to the ground"):
        hm.load_ross(written(tmp_path, without_base))
    document["BearingElement_Foundation"]["kxy"] = [1e5]
    with pytest.raises(FileFormatError, match=r"Foundation\.kxy: a foundation that couples x and y"):
        hm.load_ross(written(tmp_path, document))


def test_a_point_mass_on_the_shaft_goes_to_the_bearing_there(document: dict[str, Any], tmp_path: Path) -> None:
    document["PointMass_ring"] = {"n": 10, "m": 0.7, "mx": 0.7, "my": 0.7, "mz": 0.7, "tag": "ring"}
    assert hm.load_ross(written(tmp_path, document)).parts["free_end"].mass == 0.7  # type: ignore[attr-defined]
    document["PointMass_ring"] |= {"n": 4}
    with pytest.raises(FileFormatError, match="ring: a point mass at node 4, where no bearing is"):
        hm.load_ross(written(tmp_path, document))


@pytest.mark.parametrize(
    ("key", "field", "value", "words"),
    [
        ("DiskElement_Disk 0", "m", "8", r"Disk 0: m = '8': must be a finite number"),
        ("DiskElement_Disk 0", "m", -8.0, r"Disk 0: Rotor\.mass = -8 kg"),
        ("DiskElement_Disk 0", "n", 40, "Disk 0 is at node 40, but the shaft ends at node 10"),
        ("DiskElement_Disk 0", "n", True, "must be the number of a node"),
        ("ShaftElement_Shaft Element 4", "n", 3, "lie over each other at node 3"),
        ("ShaftElement_Shaft Element 9", "n", 12, "The shaft has a gap"),
        ("ShaftElement_Shaft Element 4", "material", "steel", "must be a table with rho, E and G_s"),
        ("BearingElement_Free end", "kxx", [1.0], "kxx has 1 values for 3 frequencies"),
        ("BearingElement_Free end", "frequency", [0.0, 200.0, 100.0], "Free end: .*speeds"),
    ],
)
def test_a_bad_entry_is_named(document: dict[str, Any], tmp_path: Path, key: str, field: str, value: Any, words: str) -> None:
    document[key][field] = value
    with pytest.raises(FileFormatError, match=words):
        hm.load_ross(written(tmp_path, document))


def test_other_files_are_refused(tmp_path: Path) -> None:
    with pytest.raises(FileFormatError, match="No such file"):
        hm.load_ross(tmp_path / "none.toml")
    damaged = tmp_path / "damaged.toml"
    damaged.write_bytes((DATA / "ross_rotor.toml").read_bytes()[:700])
    with pytest.raises(FileFormatError, match=r"cannot be parsed|does not map|is missing|must be"):
        hm.load_ross(damaged)
    other = tmp_path / "other.toml"
    other.write_text('format = "hdrive-mbs scene 1"\n')
    with pytest.raises(FileFormatError, match="no rotor saved by ROSS"):
        hm.load_ross(other)


VALUES = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(),
    st.floats(),
    st.text(max_size=5),
    st.lists(st.floats(), max_size=3),
    st.builds(lambda: {"a": {"b": []}}),  # a new one each time: it may be put into itself
)


@settings(max_examples=80, deadline=None)
@given(data=st.data())
def test_whatever_stands_in_a_file_gives_a_scene_or_an_error_of_ours(data: st.DataObject, tmp_path_factory: pytest.TempPathFactory) -> None:
    document = json.loads((DATA / "ross_rotor.json").read_text())
    for _ in range(data.draw(st.integers(1, 3))):
        key = data.draw(st.sampled_from(sorted(document)))
        if isinstance(document[key], dict) and document[key]:
            document[key][data.draw(st.sampled_from(sorted(document[key])))] = data.draw(VALUES)
        else:
            document[key] = data.draw(VALUES)
    path = tmp_path_factory.getbasetemp() / "fuzzed.json"
    path.write_text(json.dumps(document))
    told, scene = "", None
    try:
        scene = hm.load_ross(path)
    except HdriveError as error:
        told = str(error)
    assert scene is not None or str(path) in told

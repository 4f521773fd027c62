"""Static deflection of a rotor line and the loads of its bearings."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from hdrive_mbs.analysis.result import Result
from hdrive_mbs.analysis.unbalance.speed_line import check_lateral, free_to_turn
from hdrive_mbs.analysis.whirl.rotor_point import rotor_point
from hdrive_mbs.errors import ParameterError, unknown_place
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.network.network import Network
from hdrive_mbs.printed_table import PrintedTable
from hdrive_mbs.scene import Scene

FloatArray = npt.NDArray[np.float64]

UNBALANCED = 1e-6
"""Share of the weight up to which bearing loads and weight count as equal."""


@dataclass(frozen=True, kw_only=True, eq=False)
class StaticDeflection(Result):
    """Deflection line and bearing loads at steady rotation, without vibration.

    speed : of the reference shaft [rad/s]
    places : p names, along the line
    positions : z of the places [m], shape (p,)
    x, y : deflection [m];  psi, theta : tilts about x and y [rad] (zero for a housing), shape (p,)
    bearings : b names
    load_x, load_y : force of each bearing on its housing [N], shape (b,)
    weight_x, weight_y : weight of what turns: rotors, shafts and rings, without housings [N]
    """

    speed: float
    places: tuple[str, ...]
    positions: FloatArray
    x: FloatArray
    y: FloatArray
    psi: FloatArray
    theta: FloatArray
    bearings: tuple[str, ...]
    load_x: FloatArray
    load_y: FloatArray
    weight_x: float
    weight_y: float

    def __getitem__(self, place: str) -> dict[str, float]:
        """x, y [m], psi, theta [rad] and position z [m] of a place."""
        if place not in self.places:
            raise unknown_place("place", place, self.places, "This deflection")
        k = self.places.index(place)
        return {key: float(getattr(self, key)[k]) for key in ("x", "y", "psi", "theta")} | {"z": float(self.positions[k])}

    def bearing_load(self, bearing: str) -> tuple[float, float]:
        """Force of a bearing on its housing in x and y [N]: what ``law.linearised(load=...)`` takes."""
        if bearing not in self.bearings:
            raise unknown_place("bearing", bearing, self.bearings, "This deflection")
        k = self.bearings.index(bearing)
        return float(self.load_x[k]), float(self.load_y[k])

    def tables(self) -> tuple[PrintedTable, ...]:
        """Every place, and the load of every bearing on its housing."""
        places = {name: list(values) for name, values in self.columns().items()}
        rows = tuple(tuple(item if isinstance(item, str) else float(item) for item in row) for row in zip(*places.values(), strict=True))
        loads = tuple(zip(self.bearings, map(float, self.load_x), map(float, self.load_y), strict=True))
        weight = f"weight of what turns: {self.weight_x:.6g} N in x, {self.weight_y:.6g} N in y"
        return (
            PrintedTable(title=f"deflection at {self.speed:g} rad/s", heads=tuple(places), rows=rows),
            PrintedTable(title="bearing loads", heads=("bearing", "on its housing in x [N]", "in y [N]"), rows=loads, notes=(weight,)),
        )

    def columns(self) -> dict[str, np.ndarray]:
        return {
            "place": np.array(self.places),
            "z [m]": self.positions,
            "x [m]": self.x,
            "y [m]": self.y,
            "psi [rad]": self.psi,
            "theta [rad]": self.theta,
        }


def static_deflection(scene: Scene, speed: float = 0.0) -> StaticDeflection:
    """Where a line runs under its weight and the static forces of its bearings, at a speed of the reference shaft [rad/s].

    Solves for zero force on every lateral coordinate with balanced rotors.  Raises AnalysisError where the line only
    turns or nothing holds it, and says in ``status`` where bearings do not carry the whole weight.
    """
    if not np.isfinite(speed):
        raise ParameterError(f"speed = {speed} rad/s: must be a finite number.")
    check_lateral(scene, "A static deflection")
    free = free_to_turn(scene)
    network = free.network()
    point = rotor_point(free, float(speed))
    moment = network.moment(np.float64(0.0), point.angles, point.speeds, point.states)
    places, bearings = lateral_places(network), force_places(network)
    values = _values(network, moment)
    moved = {key: np.array([values.get(f"{place}.{key}", 0.0) for place in places]) for key in ("x", "y", "psi", "theta")}
    loads = {key: np.array([values[f"{bearing}.force_{key}"] for bearing in bearings]) for key in "xy"}
    weight = {key: _weight(network, moment, key) for key in "xy"}
    return StaticDeflection(
        scene=scene,
        status="; ".join(["complete", *(_carried(loads, weight) if _tells_all(network) else [])]),
        settings={"speed": float(speed)},
        speed=float(speed),
        places=places,
        positions=np.array([place_position(network, place) for place in places]),
        x=moved["x"],
        y=moved["y"],
        psi=moved["psi"],
        theta=moved["theta"],
        bearings=bearings,
        load_x=loads["x"],
        load_y=loads["y"],
        weight_x=weight["x"],
        weight_y=weight["y"],
    )


def lateral_places(network: Network) -> tuple[str, ...]:
    """Places and housings that have x and y, along the line; those that coordinates are named after first among equals."""
    names = {channel.name for channel in network.channels if channel.unit == "m"}
    found = [name[:-2] for name in names if name.endswith(".x") and f"{name[:-2]}.y" in names]
    nodes = set(network.places.values())
    return tuple(sorted(found, key=lambda place: (place_position(network, place), place not in nodes, place)))


def place_position(network: Network, place: str) -> float:
    """z of a place, or of the bearing that a housing belongs to [m]; 0 where it has none."""
    return float(network.positions.get(place.removesuffix(".housing"), 0.0))


def force_places(network: Network) -> tuple[str, ...]:
    """Bearings that tell the force on their housing."""
    names = [channel.name for channel in network.channels]
    return tuple(name.removesuffix(".force_x") for name in names if name.endswith(".force_x") and f"{name[:-1]}y" in names)


def _values(network: Network, moment: Moment) -> dict[str, float]:
    wanted = (".x", ".y", ".psi", ".theta", ".force_x", ".force_y")
    return {channel.name: float(np.asarray(channel.read(moment))) for channel in network.channels if channel.name.endswith(wanted)}


def _weight(network: Network, moment: Moment, key: str) -> float:
    """Weight of what turns in one direction [N]: the work of all weights when every station moves by 1 m and no housing does.

    A housing counted by the displacement across its bearing stays where it is when that grows by 1 m too.
    """
    moving = (f".{key}", f".across_{key}")
    total = 0.0
    for element in network.elements:
        if element.name.endswith(".weight"):
            for name, force in element.contribution(moment).items():
                if name.endswith(moving) and not name.endswith(f".housing.{key}"):
                    total += float(np.asarray(force))
    return total


def _tells_all(network: Network) -> bool:
    """Whether loads and weights can be told apart: not where rings are condensed with housings or have no force of their own."""
    return all(place in force_places(network) for place in network.positions if place not in network.places) and not any(
        element.falling is not None for element in network.matrices
    )


def _carried(loads: Mapping[str, FloatArray], weight: Mapping[str, float]) -> list[str]:
    """A note where the sum of the bearing loads is not the weight."""
    size = max(float(np.hypot(weight["x"], weight["y"])), *(float(np.max(np.abs(load), initial=0.0)) for load in loads.values()))
    missing = {key: weight[key] - float(loads[key].sum()) for key in "xy"}
    if max(map(abs, missing.values())) <= UNBALANCED * size:
        return []
    return [
        f"bearings carry {loads['x'].sum():.4g} N in x and {loads['y'].sum():.4g} N in y of a weight of {weight['x']:.4g} and "
        f"{weight['y']:.4g} N: something else carries the rest (a shaft held by the ground, a force of your own)"
    ]

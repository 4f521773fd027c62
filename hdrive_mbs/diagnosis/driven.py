"""The scene of an answer with the inputs of each record in it, and the values it starts from: ready for ``simulate``."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from hdrive_mbs.diagnosis.fit import Fitted
from hdrive_mbs.diagnosis.result import Driven
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.network.network import Network
from hdrive_mbs.scene import Scene


def driven_scenes(simulator: Simulator, fitted: Fitted, records: Sequence[str]) -> tuple[Driven, ...]:
    """One for each scene that the trials run; views of one record share theirs.

    records : their names, after which trials are named
    """
    seen: list[tuple[Scene, str]] = []
    found: list[Driven] = []
    for number, trial in enumerate(simulator.trials):
        name = next((known for known in sorted(records, key=len, reverse=True) if trial.name.startswith(known)), trial.name)
        if any(name == other and scene is trial.scene for scene, other in seen):
            continue
        name = trial.name if any(name == item.record for item in found) else name
        seen.append((trial.scene, name))
        scene = fitted.hypothesis.scene(trial.scene, fitted.z)
        duration = (trial.samples - 1) * trial.every
        found.append(Driven(record=name, scene=scene, duration=duration, initial=start_of(simulator, number, fitted)))
    return tuple(found)


def start_of(simulator: Simulator, number: int, fitted: Fitted) -> dict[str, float]:
    """Where a trial starts with these values, as ``simulate(initial=...)`` takes it."""
    trial = simulator.trials[number]
    network = fitted.hypothesis.scene(trial.scene, fitted.z).network()
    return channels_at_start(network, simulator.start_of(number, fitted.hypothesis, fitted.z), trial.speeds)


def channels_at_start(network: Network, angles: Mapping[str, float], speeds: Mapping[str, float]) -> dict[str, float]:
    """Forward angles and speeds of bodies as values of channels, in their true sense; zeros are left out.

    angles, speeds : rad, m, rad/s, m/s, by name of the body
    """
    found = {}
    for body in network.bodies:
        endings = ("", "_rate") if body.lateral else (".angle", ".speed")
        for ending, values in zip(endings, (angles, speeds), strict=True):
            if values.get(body.name, 0.0) != 0.0:
                found[f"{body.name}{ending}"] = float(values[body.name] if body.lateral else body.sense * values[body.name])
    return found

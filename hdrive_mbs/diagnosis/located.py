"""Where the gap lies: what a localisation found, kept without its linear models, which take about a gigabyte on a rotor line."""

from __future__ import annotations

from dataclasses import dataclass

from hdrive_mbs.diagnosis.fit import Fitted
from hdrive_mbs.diagnosis.locate import LatentForce, Localiser
from hdrive_mbs.diagnosis.locate.latent_force import TurnedForce
from hdrive_mbs.diagnosis.result import NOWHERE, Place
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.errors import HdriveError
from hdrive_mbs.freed_memory import give_back


@dataclass(frozen=True, kw_only=True, eq=False)
class Located:
    """Places, most probable first, and the course of the force at the first of them, over time and over the turns of the shaft.

    doubt : why the first place is not to be relied on; empty where it is
    forces, turned : none where no place is the likeliest answer
    """

    places: tuple[Place, ...]
    doubt: str
    forces: tuple[LatentForce, ...]
    turned: tuple[TurnedForce, ...]


def located(fine: Simulator, about: Fitted) -> Located:
    """Places of the gap, looked for from a fitted model on records that are not held out whole.

    On a rotor line that is the model as given: the localisation refits on its own there, and a missing cause bends the fitted one most.

    Without places, and with the reason as doubt, where they cannot be looked for.
    """
    found = _located(fine, about)
    give_back()
    return found


def _located(fine: Simulator, about: Fitted) -> Located:
    try:
        seen = [trial for trial in fine.trials if not trial.held_out.all()]
        localiser = Localiser(fine if len(seen) == len(fine.trials) else Simulator(seen, fine.step), about)
        places = localiser.places()
        found = bool(places) and places[0].at != NOWHERE
        return Located(
            places=places,
            doubt=localiser.doubt,
            forces=localiser.force(places[0].at) if found else (),
            turned=localiser.turned(places[0].at) if found else (),
        )
    except HdriveError as error:
        return Located(places=(), doubt=f"not looked for: {error}", forces=(), turned=())


def bends(fine: Simulator) -> bool:
    """Whether records are of a rotor line."""
    return any(trial.scene.network().is_lateral for trial in fine.trials)

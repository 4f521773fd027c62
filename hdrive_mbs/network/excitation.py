"""Forces that shake a line: of time and spin alone, like unbalance."""

from __future__ import annotations

from dataclasses import dataclass

from hdrive_mbs.network.coupling import Coupling


@dataclass(frozen=True)
class Excitation(Coupling):
    """A Coupling whose forces have no place in a state of steady rotation.

    Static deflection and linearised matrices leave it out, as they count rotors as balanced; a run in time has it.
    """

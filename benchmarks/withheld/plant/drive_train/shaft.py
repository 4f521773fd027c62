"""Output shafts that no library lists: one that relaxes, one whose clamp slips."""

from __future__ import annotations

from typing import NamedTuple

from benchmarks.withheld.plant.compiled import compiled


class OddShaft(NamedTuple):
    """A Maxwell branch beside the shaft (dq/dt = k_v rate - q/tau), a clamp that creeps above its slip torque."""

    branch_stiffness: float = 0.0  # N m/rad, k_v
    branch_time: float = 1.0  # s, tau
    slip_torque: float = 0.0  # N m; 0: never slips
    slip_damping: float = 1.0  # N m s/rad


@compiled
def slip_rate(torque, s):
    """Rate of the slipped twist under an elastic torque."""
    if s.slip_torque == 0.0:
        return 0.0
    if torque > s.slip_torque:
        return (torque - s.slip_torque) / s.slip_damping
    if torque < -s.slip_torque:
        return (torque + s.slip_torque) / s.slip_damping
    return 0.0

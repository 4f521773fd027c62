"""What the pictures of an answer are drawn from."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from hdrive_mbs.diagnosis.domain import domain_map
from hdrive_mbs.diagnosis.fit import Fitted
from hdrive_mbs.diagnosis.gather import Evidence
from hdrive_mbs.diagnosis.loops import loops
from hdrive_mbs.diagnosis.order_maps import order_maps
from hdrive_mbs.diagnosis.pictured import pictured
from hdrive_mbs.diagnosis.traces import traces


def pictures_of(evidence: Evidence, best: Fitted, places: Sequence[str]) -> dict[str, Any]:
    """Fields of a Diagnosis: histories, located forces, loops and maps.

    best : what is answered;  places : of what is claimed, none where nothing is
    """
    fine, null, located = evidence.fine, evidence.null, evidence.place
    after = best if places else None
    return {
        "traces": traces(fine, evidence.nominal, null, best),
        "domain": domain_map(fine, null, best),
        "forces": tuple(pictured(force) for force in located.forces),
        "loops": loops(fine, null, after, places, located.forces),
        "order_maps": order_maps(fine, null, after),
    }

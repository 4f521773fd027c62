"""Whether the best single causes explain all together, asked before the search for a single one goes on.

Of two causes each alone leaves something, and a search for one that leaves nothing would look at every law and place from other grounds
in vain.  Pairs of wrong causes have hardly been seen to come as near as that where it is asked, beside a gap above ``search.FAR``: of 136
cases of our own rotor sets 9 to 17, opened, whose fits are kept, two causes were there in each of the ten whose pair left less than
``enough`` (tests/unit/test_verdict_constants.py); what was seen below ``CLEAR`` stands there.
"""

from __future__ import annotations

import numpy as np

from hdrive_mbs.diagnosis.choosing import enough
from hdrive_mbs.diagnosis.fit import Fitted
from hdrive_mbs.diagnosis.joined import joined, settles
from hdrive_mbs.diagnosis.search import Search
from hdrive_mbs.diagnosis.second_cause import LEFT, wants_second
from hdrive_mbs.diagnosis.simulator import Simulator
from hdrive_mbs.diagnosis.tasks import Found
from hdrive_mbs.diagnosis.team import Team


class Together:
    """The best single cause of a search put together with others, as far as one of these pairs explains all.

    null : the nominal model, refitted, to which the causes are added
    """

    def __init__(self, team: Team, simulator: Simulator, null: Fitted) -> None:
        self._team, self._simulator, self._null = team, simulator, null
        self._first: Fitted | None = None
        self._pairs: tuple[Found, ...] = ()

    def explain(self, single: Search) -> bool:
        """Whether a pair settles it where no single cause does; the pairs are kept then."""
        labels = single.labels
        if not labels or not wants_second(self._null, labels[0], int(np.count_nonzero(self._simulator.fit))):
            return False
        pairs = joined(self._team, self._simulator, labels[0], labels[1:])
        if not any(settles(pair, labels[0], enough(self._null, LEFT)) for pair in pairs):
            return False
        self._first, self._pairs = labels[0].fitted, tuple(pairs)
        return True

    def with_first(self, first: Found | None) -> tuple[Found, ...]:
        """The pairs that explain all, if this is the cause that they have in common; none otherwise."""
        return self._pairs if first is not None and first.fitted is self._first else ()

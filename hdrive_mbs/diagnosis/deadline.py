"""Until when a search looks for more, and what it leaves out then."""

from __future__ import annotations

import math
import time

from hdrive_mbs.errors import ParameterError


class Deadline:
    """Some seconds from now, or never.

    left_out : what was not looked for because they were over, in the order in which it would have been

    What is begun is finished, and what every answer needs is done after it too: the first search, the best cause at its other places
    and the last fits.

    Raises ParameterError for a time that is not above 0.
    """

    def __init__(self, seconds: float | None = None) -> None:
        if seconds is not None and not seconds > 0.0:
            raise ParameterError(
                f"search_seconds = {seconds:g} s: must be above 0; without it, the search looks for as long as it finds more."
            )
        self.seconds = seconds
        self._end = math.inf if seconds is None else time.monotonic() + seconds
        self.left_out: list[str] = []

    def passed(self, what: str) -> bool:
        """Whether it is over; if so, ``what`` is left out."""
        over = time.monotonic() > self._end
        if over and what not in self.left_out:
            self.left_out.append(what)
        return over

    def said(self) -> tuple[str, ...]:
        """A note on what was left out, if anything was."""
        if not self.left_out:
            return ()
        return (
            f"The search stopped after {self.seconds:g} s, as asked, where it had found something to look for: not done were"
            f" {', '.join(self.left_out)}. With more time the cause may be another one, or one of two.",
        )

"""A probe that sees some of the motion across its axis."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

from hdrive_mbs.effects.effect import Effect
from hdrive_mbs.errors import PlaceError
from hdrive_mbs.expression import Value
from hdrive_mbs.network.draft import Draft
from hdrive_mbs.network.moment import Moment
from hdrive_mbs.quantities import parameter


@dataclass(frozen=True, kw_only=True)
class ProbeCrossTalk(Effect):
    """A displacement reading with a share of the displacement across it.

    seen = x + c y of the probe in x,  y + c x of the probe in y

    A ``Probe`` at an angle of its own counts as one in x, with y a quarter turn on.  A probe that is turned by a small
    angle a from x towards y has c = sin(a) in x, and -sin(a) in y.

    Source: geometry in first order; cross sensitivity of eddy-current probes (API Standard 670).  Leaves out the part
    that grows with the square of the displacement on a surface of small diameter.
    """

    share: float = parameter("1", "c, share of the displacement across", low=-1.0, high=1.0, typical=(-0.2, 0.2))

    acts_on: ClassVar[str] = "probe"
    kind: ClassVar[str] = "sensor"
    family: ClassVar[str] = "probe_cross_talk"
    signature: ClassVar[str] = "one probe that sees the resonances of the other direction too"

    def apply(self, draft: Draft, place: str, name: str) -> None:
        sensor = draft.sensor(place, type(self).__name__)
        quantity = draft.root_quantity(sensor)
        looks = draft.probed(quantity)
        if looks is None:
            raise PlaceError(
                f"ProbeCrossTalk needs a sensor that reads the displacement of a place in x or y, or a Probe, but {place!r} reads"
                f" {quantity!r}."
            )
        x, y = (draft.read_channel(channel, asked_by=repr(name)) for channel in looks.channels)
        cosine, sine = math.cos(looks.direction), math.sin(looks.direction)
        if quantity == looks.channels[1]:
            sine = -1.0  # x, and not -x, which is what lies a quarter turn on
        draft.keep_true_reading(sensor)
        before = sensor.seen

        def seen(moment: Moment) -> Value:
            return before(moment) + self.share * (cosine * y(moment) - sine * x(moment))

        sensor.seen = seen

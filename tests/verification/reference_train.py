"""The power train of seed F in plain scipy: an independent model to check the package against.

Derived from (1)-(4) of Folega et al. 2014.  Angles count forward, that is each in the sense in
which its body turns when the motor turns positively; with the ratio u as an absolute value the
output really turns backwards, but (1)-(4) do not show it.  With

    T_in = K_wwe (q1 - q2) + B_wwe (w1 - w2)
    T    = M(q2/u - q3) + B_FS (w2/u - w3)
    T_out = K_wwy (q3 - q4) + B_wwy (w3 - w4)

    (J_s  + w1 J_wwe) w1' = M_s(w1) - T_in
    (J_WG + w2 J_wwe) w2' = T_in - T/u
    (J_FS + w3 J_wwy) w3' = T - T_out
    (J_MR + w4 J_wwy) w4' = T_out - M_MR

Differences from the print: M_s(n) stands in (1) alone, because (5) put into it counts J_s twice;
J_wwe is the shaft alone, because with the wave generator in it (2) would count J_WG twice; J_MR is
the inertia on the output axis; K_FS (phi_WG/u - phi_FS) is the elastic torque M.

The right side is cut at every kink and jump of its laws (see reference_laws) and the integration
stops at each, so the order of the integrator holds throughout.  It imports nothing from the package.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from tests.verification.reference_laws import Drive, Pieces

BODIES = ("motor", "gear.wave_generator", "gear.flexspline", "load")


@dataclass(frozen=True)
class ReferenceTrain:
    """Data and right side of the four-inertia train; the numbers are those of notes on seed F."""

    flexspline: Pieces
    motor: Drive
    load: Drive
    damping_in_gap: bool = True
    gap: float = 0.0
    ratio: float = 100.0
    J_s: float = 1.5e-3
    J_wwe: float = 1e-5
    J_WG: float = 1.69e-4
    J_FS: float = 4e-4
    J_wwy: float = 2.465e-5
    J_MR: float = 0.5
    shares: tuple[float, float, float, float] = (0.5, 0.5, 0.5, 0.5)
    K_wwe: float = 1e4
    K_wwy: float = 5.1913e4
    B_wwe: float = 0.05
    B_FS: float = 20.0
    B_wwy: float = 5.0

    @property
    def inertias(self) -> tuple[float, float, float, float]:
        a, b, c, d = self.shares
        return self.J_s + a * self.J_wwe, self.J_WG + b * self.J_wwe, self.J_FS + c * self.J_wwy, self.J_MR + d * self.J_wwy

    @property
    def edges(self) -> tuple[tuple[float, ...], ...]:
        """Edges of all pieces: twist of the flexspline, then the motor's and the load's variables."""
        twist = set(self.flexspline.edges)
        if not self.damping_in_gap:
            twist |= {-0.5 * self.gap, 0.5 * self.gap}
        return (tuple(sorted(twist)), *self.motor.edges, *self.load.edges)

    def variables(self, t: float, y: Sequence[float]) -> tuple[float, ...]:
        """What the edges are edges of."""
        z, count = y[8:], len(self.motor.start)
        return (
            y[1] / self.ratio - y[2],
            *self.motor.variables(t, y[0], y[4], z[:count]),
            *self.load.variables(t, y[3], y[7], z[count:]),
        )

    def regions(self, t: float, y: Sequence[float]) -> list[int]:
        """Piece that holds for each variable."""
        return [bisect_right(edges, x) for edges, x in zip(self.edges, self.variables(t, y), strict=True)]

    def bound_mesh(self, region: int) -> Callable[[float, float], float]:
        """Torque through the mesh as a smooth function of twist and rate, in one region of the twist."""
        edges = self.edges[0]
        low = edges[region - 1] if region > 0 else -np.inf
        high = edges[region] if region < len(edges) else np.inf
        inside = 0.5 * (max(low, -1.0) + min(high, 1.0))  # any twist in the region picks its piece
        elastic = self.flexspline.functions[bisect_right(self.flexspline.edges, inside)]
        damping = self.B_FS if self.damping_in_gap or abs(inside) > 0.5 * self.gap else 0.0
        return lambda twist, rate: elastic(twist) + damping * rate

    def bound(self, regions: Sequence[int]) -> Callable[[float, np.ndarray], list[float]]:
        """The smooth right side that holds in the given regions."""
        u, (j1, j2, j3, j4) = self.ratio, self.inertias
        motor, load, mesh = self.motor, self.load, self.bound_mesh(regions[0])
        m_states, m_edges = len(motor.start), len(motor.edges)
        of_motor, of_load = regions[1 : 1 + m_edges], regions[1 + m_edges :]

        def right(t: float, y: np.ndarray) -> list[float]:
            q1, q2, q3, q4, w1, w2, w3, w4, *z = y.tolist()
            if motor.motion is not None:
                q1, w1, a1 = motor.motion(t, of_motor)
            t_in = self.K_wwe * (q1 - q2) + self.B_wwe * (w1 - w2)
            t_mesh = mesh(q2 / u - q3, w2 / u - w3)
            t_out = self.K_wwy * (q3 - q4) + self.B_wwy * (w3 - w4)
            if motor.motion is None:
                a1 = (motor.torque(t, q1, w1, z[:m_states], of_motor) - t_in) / j1
            resisting = load.torque(t, q4, w4, z[m_states:], of_load)
            return [
                w1, w2, w3, w4, a1, (t_in - t_mesh / u) / j2, (t_mesh - t_out) / j3, (t_out - resisting) / j4,
                *motor.rates(t, q1, w1, z[:m_states], of_motor), *load.rates(t, q4, w4, z[m_states:], of_load),
            ]  # fmt: skip

        return right

    def right_side(self, t: float, y: Sequence[float]) -> list[float]:
        """The right side wherever y is."""
        return self.bound(self.regions(t, y))(t, np.asarray(y, float))

    def mesh_torque(self, twist: float, rate: float) -> float:
        """Torque through the mesh."""
        return self.bound_mesh(bisect_right(self.edges[0], twist))(twist, rate)

    def start(self, speed: float = 0.0) -> list[float]:
        """Unstrained, every body at its ideal speed, states as their laws say."""
        u = self.ratio
        return [0.0] * 4 + [speed, speed, speed / u, speed / u] + [*self.motor.start, *self.load.start]


@dataclass(frozen=True)
class Reference:
    """Histories of the reference at the asked times, and every passage from one piece to another."""

    times: np.ndarray
    angles: dict[str, np.ndarray]
    speeds: dict[str, np.ndarray]
    torque: np.ndarray
    states: np.ndarray
    passages: list[tuple[float, int, int, int]] = field(default_factory=list)
    """(time, which variable, region left, region entered)"""


AWAY = 1e-11
"""s: at 1e-4 rad/s 1e-15 rad, far above the rounding of an angle (2e-19 rad) and far below every tolerance here."""


def integrate(
    train: ReferenceTrain,
    times: np.ndarray,
    *,
    start: Sequence[float] | None = None,
    method: str = "DOP853",
    relative: float = 1e-12,
    absolute: float = 1e-14,
    max_step: float = 1e-3,
    most_passages: int | None = None,
) -> Reference:
    """Integrate from t = 0 and give the state at ``times`` (increasing, first one 0).

    most_passages : end at this passage from one piece to another; the later times are left out

    Each call of scipy covers one combination of pieces and ends at the next edge.  scipy looks for
    a passage only in the ends of a step; where its dense output left the piece and came back within
    one step, the call is repeated with shorter steps.
    """
    t, end = 0.0, float(times[-1])
    y = np.asarray(train.start() if start is None else start, float)
    regions = train.regions(t, y)
    out = np.empty((len(times), len(y)))
    out[0] = y
    done, passages = 1, []
    while t < end:
        events, meaning = _events(train, regions)
        wanted = times[done:]
        longest = max_step
        while True:
            solution = solve_ivp(
                train.bound(regions), (t, end), y, method=method, rtol=relative, atol=absolute, max_step=longest,
                events=events or None, dense_output=True,
            )  # fmt: skip
            assert solution.success, solution.message
            if not events or _stays_inside(train, regions, solution, 100.0 * relative):
                break
            longest *= 0.1
            assert longest > 1e-10, f"no step near t = {t:g} s stays in its piece {regions}"
        reached = float(solution.t[-1])
        count = int(np.searchsorted(wanted, reached, side="right"))
        if count:
            out[done : done + count] = solution.sol(wanted[:count]).T
            done += count
        t, y = reached, solution.y[:, -1]
        if solution.status == 1:
            fired = next(k for k, found in enumerate(solution.t_events) if len(found) and found[-1] == reached)
            which, before, after = meaning[fired]
            regions = [after if k == which else region for k, region in enumerate(regions)]
            passages.append((t, which, before, after))
            if len(passages) == most_passages:
                break
            # rounding may leave the state on the near side of the edge, where it would pass back at once, for ever:
            # go a little way into the new piece before looking for its edges
            away = min(t + AWAY, end)
            if away > t:
                y = solve_ivp(train.bound(regions), (t, away), y, method=method, rtol=relative, atol=absolute).y[:, -1]
                t = away
    times, out = times[:done], out[:done]
    if train.motor.motion is not None:
        moved = np.array([train.motor.motion(t, train.regions(t, out[k])[1:]) for k, t in enumerate(times.tolist())])
        out[:, 0], out[:, 4] = moved[:, 0], moved[:, 1]
    twist, rate = out[:, 1] / train.ratio - out[:, 2], out[:, 5] / train.ratio - out[:, 6]
    return Reference(
        times=times,
        angles={name: out[:, k] for k, name in enumerate(BODIES)},
        speeds={name: out[:, 4 + k] for k, name in enumerate(BODIES)},
        torque=np.array([train.mesh_torque(float(x), float(v)) for x, v in zip(twist, rate, strict=True)]),
        states=out[:, 8:],
        passages=passages,
    )


def _events(train: ReferenceTrain, regions: Sequence[int]) -> tuple[list[Callable[..., float]], list[tuple[int, int, int]]]:
    """Terminal events at the edges around the present regions, and which passage each stands for."""
    events: list[Callable[..., float]] = []
    meaning = []
    for which, (edges, region) in enumerate(zip(train.edges, regions, strict=True)):
        for edge_index, after, direction in ((region - 1, region - 1, -1.0), (region, region + 1, 1.0)):
            if not 0 <= edge_index < len(edges):
                continue

            def event(t: float, y: np.ndarray, which: int = which, edge: float = edges[edge_index]) -> float:
                return train.variables(t, y.tolist())[which] - edge

            event.terminal = True  # type: ignore[attr-defined]
            event.direction = direction  # type: ignore[attr-defined]
            events.append(event)
            meaning.append((which, region, after))
    return events, meaning


def _stays_inside(train: ReferenceTrain, regions: Sequence[int], solution: Any, share: float) -> bool:
    """Whether no variable left its piece by more than ``share`` of it, in the steps and at three points within each."""
    steps = solution.t
    inner = [steps[:-1] + part * np.diff(steps) for part in (0.25, 0.5, 0.75)]
    times = np.sort(np.concatenate([steps, *inner]))
    for t, y in zip(times.tolist(), solution.sol(times).T, strict=True):
        for edges, region, x in zip(train.edges, regions, train.variables(t, y.tolist()), strict=True):
            low = edges[region - 1] if region > 0 else -np.inf
            high = edges[region] if region < len(edges) else np.inf
            slack = share * max(1e-3, abs(x))
            if not low - slack <= x <= high + slack:
                return False
    return True

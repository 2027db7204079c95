"""A path of its own for each map: where no (u,v) for all of them stays connected, each leaves the line by a little.

The paths are elastic bands over a few waypoints. At random, waypoint by waypoint and map by map, they are pushed to
where the gaps close, by simulated annealing (Kirkpatrick, Gelatt & Vecchi 1983), and then drawn as tight as they stay.
"""

from __future__ import annotations

from collections.abc import Generator

import numpy as np

from .connectedness import Connectedness
from .curve import Keys, smooth_keys
from .deciding import decide_frames
from .morph import Morph
from .report import family

WAYPOINTS = 9
"""Between the ends."""

SAMPLES = 10
"""Times looked at from waypoint to waypoint, before those that a denser look adds."""

PUSHES = 1600
"""Moves tried to close the gaps, for the first half of which they may widen again by chance."""

PULLS = 120
"""Moves tried to draw it tight."""

CLOSING = 0.9
"""Share of the work that closing the gaps takes, for the progress."""

DIRECTIONS = np.array([[1, 1], [1, 0], [0, 1]])
"""Of moves: in u and v, or in one of them."""

MOST_WORK = 750_000
"""Shapes decided, times their pairs of maps: a few seconds."""

FIRST_PUSH, LAST_PUSH = 0.4, 0.02
"""Standard deviation of the moves in u and v, at first and at last."""

WARMTH = 2e-4
"""How much worse a move may make a band at first, on average."""

BROKEN = 0.03
"""What it costs to be in pieces at all, beside the gap, which is relative to the shape's diameter."""

STIFFNESS = 0.001
"""What it costs if every map goes off by 1 on average."""


def band_steps(morph: Morph, path: Keys, frames: int, tolerance: float) -> Generator[float, None, Keys]:
    """How far each map is to be from a path at each time, so that the shape is in pieces as little as can be; in steps.

    Parameters
    ----------
    morph : Morph
    path : Keys
        Of (u,v), values (K, 2).
    frames : int
        Of the animation.
    tolerance : float
        Relative to the enclosing diameter.

    Returns
    -------
    Keys
        With values (K, 2, N), for `morph.spread`: how much further each map is in u, and in v. Zero at both ends.
    """
    knots = np.linspace(0, 1, WAYPOINTS + 2)
    if frames > len(knots):
        knots = np.round(knots * (frames - 1)) / (frames - 1)
    band = _Band(morph, path, knots, tolerance)
    yield from band.find_steps(np.arange(1, 2 * (frames - 1)) / (2 * (frames - 1)))
    return smooth_keys(knots, band.offsets)


class _Band:
    """The search for the bands of all maps."""

    def __init__(self, morph: Morph, path: Keys, knots: np.ndarray, tolerance: float) -> None:
        self.morph, self.path, self.knots, self.tolerance = morph, path, knots, tolerance
        self.random = np.random.default_rng(1)
        self.work = self.pushes = 0
        self.offsets = np.zeros((len(knots), 2, morph.count))

    def find_steps(self, dense: np.ndarray) -> Generator[float, None, None]:
        """Go by a few times at first, then also by those of many that they missed; draw tight what is closed."""
        sparse = np.arange(1, SAMPLES * (WAYPOINTS + 1)) / (SAMPLES * (WAYPOINTS + 1))
        self.look_at(min(sparse, dense, key=len))
        while True:
            yield from self.close_steps()
            if self.costs.any():
                return
            seen = self.times
            self.look_at(dense)
            missed = dense[self.costs > 0]
            if len(missed) == 0:
                break
            self.look_at(np.unique(np.concatenate([seen, missed])))
        yield from self.tighten_steps()

    def is_spent(self) -> bool:
        """Whether enough was tried."""
        return self.pushes >= PUSHES or self.work * self.morph.count * (self.morph.count - 1) // 2 >= MOST_WORK

    @property
    def cost(self) -> float:
        """What the band costs."""
        return float(self.costs.mean()) + _stiffness(self.offsets)

    def look_at(self, times: np.ndarray) -> None:
        """Go by other times (F,) from now on."""
        self.times, self.costs = times, self.broken(self.offsets, times)

    def broken(self, offsets: np.ndarray, times: np.ndarray) -> np.ndarray:
        """What the shape at each time (F,) costs by being in pieces."""
        off = smooth_keys(self.knots, offsets).at(times).reshape(len(times), 2 * self.morph.count)
        places = np.column_stack([self.path.at(times), np.zeros(len(times)), off])
        state, gap, _ = decide_frames(*family(self.morph, places), self.tolerance, True)
        self.work += len(times)
        gap = np.where(np.isnan(gap[:, 1]), 1.0, gap[:, 1])
        return np.where(state == Connectedness.CONNECTED, 0.0, gap + BROKEN)

    def close_steps(self) -> Generator[float, None, None]:
        """Move waypoints until nothing is in pieces, or enough was tried; the best band of all on the way."""
        best = self.cost, self.offsets, self.costs
        while self.costs.any() and not self.is_spent():
            done = self.pushes / PUSHES
            self.pushes += 1
            # One map moves, at a waypoint near a gap, in u and v or one of them.
            gaping = self.random.choice(self.times[self.costs > 0])
            nearby = np.interp(gaping, self.knots, np.arange(len(self.knots))) + self.random.normal()
            waypoint = int(np.clip(round(nearby), 1, WAYPOINTS))
            push = FIRST_PUSH * (LAST_PUSH / FIRST_PUSH) ** done * self.random.normal(size=2)
            moved = self.offsets.copy()
            moved[waypoint, :, self.random.integers(self.morph.count)] += push * DIRECTIONS[self.random.integers(3)]
            self.move(waypoint, moved, WARMTH * max(0.0, 1 - 2 * done) * self.random.exponential())
            yield CLOSING * done
            if self.cost < best[0]:
                best = self.cost, self.offsets, self.costs
        if self.costs.any():
            _, self.offsets, self.costs = best

    def tighten_steps(self) -> Generator[float, None, None]:
        """Draw waypoints towards the middle of their neighbors, where nothing breaks by it."""
        for pull in range(PULLS):
            waypoint = 1 + pull % WAYPOINTS
            middle = (self.offsets[waypoint - 1] + self.offsets[waypoint + 1]) / 2
            chosen = self.random.random(self.morph.count) < 0.5
            moved = self.offsets.copy()
            moved[waypoint] += self.random.random() * chosen * (middle - moved[waypoint])
            if not self.broken(moved, self.times[self.bent(waypoint)]).any():
                self.offsets = moved
            yield CLOSING + (1 - CLOSING) * pull / PULLS

    def bent(self, waypoint: int) -> np.ndarray:
        """Which times a waypoint has a say in: it bends the curve as far as the second next on either side."""
        start, end = self.knots[max(waypoint - 2, 0)], self.knots[min(waypoint + 2, len(self.knots) - 1)]
        return (self.times > start) & (self.times < end)

    def move(self, waypoint: int, moved: np.ndarray, luck: float) -> None:
        """Take another band, different at one waypoint, if it is better, or worse by less than `luck`."""
        bent = self.bent(waypoint)
        bound = self.costs[bent].sum() / len(bent) + luck + _stiffness(self.offsets) - _stiffness(moved)
        # The stiffness is known at once, and may tell enough.
        if bound <= 0:
            return
        costs = self.broken(moved, self.times[bent])
        if costs.sum() / len(bent) < bound:
            self.offsets, self.costs = moved, self.costs.copy()
            self.costs[bent] = costs


def _stiffness(offsets: np.ndarray) -> float:
    """What it costs to be stretched: the elastic energy of all maps' bands."""
    return STIFFNESS * (len(offsets) - 1) * float((np.diff(offsets, axis=0) ** 2).sum()) / offsets.shape[2]

"""Is this attractor in one piece? The certified test, and the paper's two algorithms beside it.

`connectedness` is the one to use: what it calls disconnected is, and what it calls connected is at the tolerance.
`index_buffer` (Burch & Hart 1997, Fig. 2) and `object_based` (Fig. 1, after Barnsley 1988) are kept as the paper has
them, for comparison; they look at whole attractors, whatever is hidden.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import IntEnum

import numpy as np

from . import states
from .affine import compose
from .deciding import decide_frames
from .ifs import IFS, Contractivity
from .kernels import njit


class Connectedness(IntEnum):
    """State of an attractor; also the values of a locus."""

    CONNECTED = states.CONNECTED
    DISCONNECTED = states.DISCONNECTED
    UNDECIDED = states.UNDECIDED
    NO_ATTRACTOR = states.NO_ATTRACTOR


@dataclass(frozen=True, eq=False)
class Verdict:
    """What an algorithm found out about one attractor.

    Attributes
    ----------
    state : Connectedness
    gap : (float, float)
        Bracket of the gap relative to the enclosing diameter: the longest edge of the minimum spanning tree over the
        distances of the attractorlets, 0 for a connected attractor. The high end is infinite where the algorithm knows
        none; both are NaN without an attractor.
    components : (N,) of int
        For each map the lowest map whose attractorlet is known to be in one component with its own; -1 for those that
        are hidden.
    """

    state: Connectedness
    gap: tuple[float, float]
    components: np.ndarray


def connectedness(ifs: IFS, tolerance: float = 1 / 300) -> Verdict:
    """Decide with certainty whether an attractor is in one piece, or what is drawn of it where maps are hidden.

    Attractorlets are compared by their enclosing discs and polygons, refined only where these meet; and an attractor
    whose maps cover areas enough is connected wherever they lie (the area certificate, see `overlap`).

    Parameters
    ----------
    ifs : IFS
        In space, one with hidden maps is connected if the whole attractor is and what is drawn of it.
    tolerance : float
        Relative to the enclosing diameter; a gap below it may count as none.

    Returns
    -------
    Verdict
        CONNECTED: at the tolerance. DISCONNECTED: certain, whatever the tolerance. UNDECIDED: the budget of the
        search ran out, which happens to heavily overlapping, flat maps. NO_ATTRACTOR: certain.
    """
    linear = np.ascontiguousarray(ifs.linear).reshape(ifs.count, -1)
    translation = ifs.translation[None].copy()
    state, gap, labels = decide_frames(linear[None], translation, ifs.allowed[None], float(tolerance), True)
    return Verdict(Connectedness(state[0]), (float(gap[0, 0]), float(gap[0, 1])), labels[0])


def index_buffer(
    ifs: IFS,
    resolution: int = 300,
    iterations: int | None = None,
    phases: tuple[tuple[float, float], ...] = ((0.0, 0.0),),
    early_exit: bool = True,
    seed: int = 1,
) -> Verdict:
    """Decide by pixels that several attractorlets share (Burch & Hart 1997, Fig. 2).

    Parameters
    ----------
    ifs : IFS
        Its weights choose the maps of the chaos game, as the paper suggests; they are equal in its examples.
    resolution : int
        Pixels along the longer side of the attractor's bounding box.
    iterations : int, optional
        Points plotted; 10 for each pixel of the square by default.
    phases : ((float, float), ...)
        Shifts of the window in pixels, taken modulo 1; the edges found with any of them count.
    early_exit : bool
        Stop when one component is left. The paper plots all points and sums the powers of the adjacency matrix, with
        the same verdict: all entries of that sum are positive if and only if there is one component.
    seed : int
        Of the chaos game.

    Returns
    -------
    Verdict
        CONNECTED: at the size of a pixel. DISCONNECTED: no shared pixels were found, which proves nothing.
    """
    if ifs.contractivity != Contractivity.CONTRACTIVE:
        return _without_attractor(ifs)
    labels = np.arange(ifs.count)
    left, bottom, right, top = replace(ifs, opacity=None).bounds
    pixel = max(right - left, top - bottom) / resolution
    if pixel == 0:
        return Verdict(Connectedness.CONNECTED, (0.0, 0.0), np.zeros(ifs.count, dtype=int))
    for phase in phases:
        _plot_index_buffer(
            np.ascontiguousarray(ifs.maps).reshape(-1, 6),
            np.cumsum(ifs.weights),
            ifs.fixed_points[0].copy(),
            np.array([left - phase[0] % 1 * pixel, bottom - phase[1] % 1 * pixel]),
            pixel,
            np.zeros((resolution + 2, resolution + 2), dtype=np.int16),
            int(iterations or 10 * resolution**2),
            early_exit,
            2 * seed + 1,  # a xorshift generator never leaves zero
            labels,
        )
    if labels.any():
        return Verdict(Connectedness.DISCONNECTED, (0.0, np.inf), labels)
    return Verdict(Connectedness.CONNECTED, (0.0, np.sqrt(2) * pixel / (2 * ifs.enclosing_disc[1])), labels)


def object_based(ifs: IFS, iterations: int = 6, points: int = 20_000) -> Verdict:
    """Look for an attractorlet that is alone (Burch & Hart 1997, Fig. 1; Barnsley 1988).

    Two pairs of attractorlets with a gap between the pairs escape this test: none of the four is alone.

    Parameters
    ----------
    ifs : IFS
    iterations : int
        Refinements of the attractor; the points number N to this power.
    points : int
        No refinement beyond this many, since all their distances are compared.

    Returns
    -------
    Verdict
        DISCONNECTED: certain. CONNECTED: no attractorlet was found alone.
    """
    if ifs.contractivity != Contractivity.CONTRACTIVE:
        return _without_attractor(ifs)
    center, radius = ifs.enclosing_disc
    largest = ifs.norms.max()
    words = np.concatenate([np.eye(2), np.zeros((2, 1))], axis=1)[None]
    for iteration in range(1, iterations + 1):
        if len(words) * ifs.count > points:
            break
        sets = compose(ifs.maps[:, None], words[None])
        plotted = sets[..., :2] @ center + sets[..., 2]
        nearest = _nearest(np.ascontiguousarray(plotted))
        room = 2 * largest**iteration * radius
        if nearest.max() > room:
            alone = nearest > room
            labels = np.where(alone, np.arange(ifs.count), np.argmin(alone))
            gap = ((nearest.max() - room) / (2 * radius), np.inf)
            return Verdict(Connectedness.DISCONNECTED, gap, labels)
        words = sets.reshape(-1, 2, 3)
    return Verdict(Connectedness.CONNECTED, (0.0, np.inf), np.zeros(ifs.count, dtype=int))


def _without_attractor(ifs: IFS) -> Verdict:
    known = ifs.contractivity == Contractivity.NO_ATTRACTOR
    state = Connectedness.NO_ATTRACTOR if known else Connectedness.UNDECIDED
    return Verdict(state, (np.nan, np.nan), np.arange(ifs.count))


@njit(nogil=True, cache=True)
def _plot_index_buffer(maps, cumulative, point, corner, pixel, buffer, iterations, early_exit, seed, labels):
    """The chaos game of Fig. 2: each pixel holds the last map that reached it; two maps at a pixel join an edge."""
    count = maps.shape[0]
    x, y = point
    random = np.uint64(seed)
    components = 0
    for i in range(count):
        components += labels[i] == i
    for _ in range(iterations):
        random ^= random << np.uint64(13)
        random ^= random >> np.uint64(7)
        random ^= random << np.uint64(17)
        draw = (random >> np.uint64(11)) * 2.0**-53
        i = 0
        while i < count - 1 and draw >= cumulative[i]:
            i += 1
        a, b, e, c, d, f = maps[i]
        x, y = a * x + b * y + e, c * x + d * y + f
        column, row = int((x - corner[0]) / pixel), int((y - corner[1]) / pixel)
        before = buffer[row, column] - 1
        if before >= 0 and labels[before] != labels[i]:
            low, high = min(labels[before], labels[i]), max(labels[before], labels[i])
            for k in range(count):
                if labels[k] == high:
                    labels[k] = low
            components -= 1
            if early_exit and components == 1:
                return
        buffer[row, column] = i + 1


@njit(nogil=True, cache=True)
def _nearest(sets):
    """For each of the point sets (N, M, 2) the distance to the nearest of the others (N,) (Fig. 1, Eq. 4)."""
    count, points = sets.shape[0], sets.shape[1]
    squared = np.full(count, np.inf)
    for i in range(count):
        for j in range(i + 1, count):
            for p in range(points):
                for q in range(points):
                    dx, dy = sets[i, p, 0] - sets[j, q, 0], sets[i, p, 1] - sets[j, q, 1]
                    apart = dx * dx + dy * dy
                    squared[i] = min(squared[i], apart)
                    squared[j] = min(squared[j], apart)
    return np.sqrt(squared)

"""A path through the (u,v) plane from the initial to the final shape, as keys for an animation.

The path is planned on the connectedness locus (Burch & Hart 1997, Section 6) and keyed with as few keys as keep it
there. Where no connected path exists, or only a far longer one, it takes the way of least swell instead. Each map may
also get a path of its own. Whatever the plan, every frame of the keyed curve is checked at the end, and swell is added
where one fails.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Generator
from dataclasses import dataclass

import numpy as np

from . import parallel
from .band import band_steps
from .connectedness import Connectedness
from .curve import Keys, smooth_keys
from .deciding import are_connected
from .locus import Locus, compute_locus_steps, nodes
from .morph import Morph, spread
from .report import PathReport, check_frames_steps, family
from .route import STEPS, cheapest_route, clearance
from .swelling import envelope, least_swell_field_steps, least_swell_steps
from .tolerated import tolerated_at_ends, tolerated_gaps

METHODS = ("planned", "per map", "straight", "straight unswollen")
"""Through the locus; a path for each map; straight with least swell; straight without swell, the paper's Figure 5."""

LOCUS_RESOLUTION = {2: 256, 3: 31}
SWELL_RESOLUTION = {2: 97, 3: 16}
"""Nodes along u of the locus and of the field of least swell, where the caller brings no locus, by dimensions."""

FAR_LONGER = 4.0
"""A connected path more than this many times as long as the straight line is given up for swell."""

EDGE_AVERSION = 4.0
"""What it costs to pass right beside a node outside, against 1 in the open."""

SWELL_AVERSION = 40.0
"""What swell 1 costs, against 1 for none."""

REPLANS = 60
"""How often the route is planned anew round edges whose interior points fail."""

SAMPLES_PER_NODE = 8
"""How densely edges and segments are tested at least, per node's spacing."""

SAMPLES_PER_FRAME = 4
"""How densely the curve is tested at least, per frame."""

SWELL_ATTEMPTS = 10
"""How often the swell curve is raised where a frame fails."""

SWELL_KEYS = 24
"""Most keys of a swell curve before those that single frames need."""


@dataclass(frozen=True, eq=False)
class Path:
    """A keyed path; ``morph.at(*path.at(t))`` is the IFS at the time t.

    Attributes
    ----------
    keys : Keys
        Of (u,v), values (K, 2).
    swell_keys : Keys
        Of the swell, values (S,).
    offset_keys : Keys or None
        How much further than that each map is in u, and in v, values (K, 2, N); None where all maps go together.
    report : PathReport
    """

    keys: Keys
    swell_keys: Keys
    offset_keys: Keys | None
    report: PathReport

    def at(self, t: float) -> tuple[float | np.ndarray, float | np.ndarray, float]:
        """u, v and swell at the time t in [0, 1]; u and v are (N,) where maps have paths of their own."""
        place = self.sample(np.array([float(t)]))[0]
        u, v, swell = place[:3].tolist()
        if self.offset_keys is None:
            return u, v, swell
        return *spread(place, self.offset_keys.value.shape[2])[:2], swell

    def sample(self, t: np.ndarray) -> np.ndarray:
        """Places (F, 3) or (F, 3 + 2N), see `morph.spread`, at the times t (F,) in [0, 1]."""
        return _sample(self.keys, self.swell_keys, self.offset_keys, np.asarray(t, dtype=float))


def plan_path(
    morph: Morph,
    locus: Locus | None = None,
    frames: int = 240,
    tolerance: float = 1 / 300,
    method: str = "planned",
    threads: int | None = None,
    progress: Callable[[float], bool | None] | None = None,
) -> Path:
    """Plan a path from (0,0) to (1,1) on which the shape stays in one piece.

    Parameters
    ----------
    morph : Morph
    locus : Locus, optional
        Computed at 256 nodes a side, 31 in space, if not given; its own tolerance should be the same.
    frames : int
        Of the animation; keys lie on whole frames, and each frame is checked.
    tolerance : float
        Relative to the enclosing diameter.
    method : str
        One of `METHODS`.
    threads : int, optional
        None for all processors; the path does not depend on it.
    progress : callable, optional
        Told the share done; returning False cancels with `parallel.Cancelled`.

    Raises
    ------
    IFSError
        If an end has no attractor.
    ValueError
        If the method is unknown, there are fewer than 2 frames, or the locus does not hold (0,0) and (1,1).
    """
    return parallel.finish(plan_path_steps(morph, locus, frames, tolerance, method, threads), progress)


def plan_path_steps(
    morph: Morph,
    locus: Locus | None = None,
    frames: int = 240,
    tolerance: float = 1 / 300,
    method: str = "planned",
    threads: int | None = None,
) -> Generator[float, None, Path]:
    """`plan_path` in steps of about 50 milliseconds, each yielding the share done."""
    if method not in METHODS:
        raise ValueError(f"There is no path method “{method}”; choose one of {', '.join(METHODS)}.")
    if frames < 2:
        raise ValueError(f"A path over {frames} frames cannot be keyed; it needs 2 or more.")
    morph.initial.require_attractor()
    morph.final.require_attractor()
    line = keys = _straight_keys(np.array([[0.0, 0.0], [1.0, 1.0]]), frames)
    at_ends = tolerated_at_ends(morph.shapes, tolerance)
    offset_keys, reason = None, ""
    if method == "planned":
        if locus is None:
            locus = yield from parallel.part(
                compute_locus_steps(morph, LOCUS_RESOLUTION[morph.DIMENSION], tolerance, threads=threads, gap=False),
                0.0,
                0.4,
            )
        points = yield from parallel.part(_route_inside_steps(morph, locus, tolerance, frames), 0.4, 0.5)
        if points is None or _length(points) > FAR_LONGER * np.sqrt(2):
            reason = (
                "No connected path was found in (u,v), so the maps swell."
                if points is None
                else "The connected path in (u,v) is far longer than the straight line, so the maps swell instead."
            )
            u, v = nodes(SWELL_RESOLUTION[morph.DIMENSION])
            tolerated = tolerated_gaps(at_ends, u)
            searching = least_swell_field_steps(morph, u, v, tolerance, 16, threads, tolerated)
            field = yield from parallel.part(searching, 0.5, 0.7)
            points = _route_of_least_swell(u, v, field)
        keys = _rounded(morph, _straight_keys(points, frames), frames, tolerance)
    if method == "per map":
        found = yield from parallel.part(band_steps(morph, keys, frames, tolerance), 0.0, 0.7)
        if found.value.any():
            offset_keys = found
            furthest = np.hypot(*np.moveaxis(found.value, 1, 0)).max()
            reason = f"Each map goes along a path of its own, up to {furthest:.2f} beside the straight line in (u,v)."
    times = np.arange(frames) / (frames - 1)
    tolerated, swell_keys = tolerated_gaps(at_ends, times), _no_swell()
    if method != "straight unswollen":
        swell_keys = yield from parallel.part(
            _swell_steps(morph, keys, offset_keys, tolerance, tolerated, threads), 0.7, 0.9
        )
    places, diagonal = _sample(keys, swell_keys, offset_keys, times), _sample(line, _no_swell(), None, times)
    elsewhere = not np.array_equal(places, diagonal)
    end = 0.95 if elsewhere else 1.0
    checked = straight = yield from parallel.part(check_frames_steps(morph, diagonal, tolerance, threads), 0.9, end)
    if elsewhere:
        checked = yield from parallel.part(check_frames_steps(morph, places, tolerance, threads), 0.95, 1.0)
    report = PathReport(checked, straight, tolerated, method, reason, morph.flips, morph.turned_over)
    return Path(keys, swell_keys, offset_keys, report)


def _sample(keys: Keys, swell_keys: Keys, offset_keys: Keys | None, times: np.ndarray) -> np.ndarray:
    places = np.column_stack([keys.at(times), np.clip(swell_keys.at(times), 0.0, 1.0)])
    if offset_keys is None:
        return places
    return np.column_stack([places, offset_keys.at(times).reshape(len(times), -1)])


def _length(points: np.ndarray) -> float:
    return float(np.hypot(*np.diff(points, axis=0).T).sum())


def _straight_keys(points: np.ndarray, frames: int) -> Keys:
    """Keys at points (K, 2) on whole frames, at a steady speed, joined by straight lines."""
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
    frame = np.round(along / along[-1] * (frames - 1))
    # Whole frames only where there are enough of them to keep the keys apart.
    time = frame / (frames - 1) if (np.diff(frame) > 0).all() else along / along[-1]
    third = np.diff(points, axis=0) / 3
    left, right = points.copy(), points.copy()
    left[1:] -= third
    right[:-1] += third
    return Keys(time, points, left, right)


def _no_swell() -> Keys:
    zero = np.zeros(2)
    return Keys(np.array([0.0, 1.0]), zero, zero, zero)


def _route_inside_steps(
    morph: Morph, locus: Locus, tolerance: float, frames: int
) -> Generator[float, None, np.ndarray | None]:
    """Points (K, 2) of a connected path with few corners, or None; in steps."""
    node = locus.u[1] - locus.u[0]
    ends = [locus.node(0.0, 0.0), locus.node(1.0, 1.0)]
    for (row, column), end in zip(ends, (0.0, 1.0), strict=True):
        if (locus.u[column], locus.v[row]) != (end, end):
            raise ValueError(f"The locus has no node at ({end:g},{end:g}); compute one whose domain holds it.")
    inside = locus.state == Connectedness.CONNECTED
    with np.errstate(divide="ignore"):
        cost = np.where(inside, 1 + EDGE_AVERSION / np.maximum(clearance(inside), 1), np.inf)
    closed = np.zeros((*inside.shape, 8), dtype=np.bool_)
    start, goal = (row * len(locus.u) + column for row, column in ends)
    if not inside.flat[start] or not inside.flat[goal]:
        return None
    for attempt in range(REPLANS):
        yield attempt / REPLANS
        route = cheapest_route(cost, closed, start, goal)
        if len(route) == 0:
            return None
        rows, columns = np.divmod(route, len(locus.u))
        points = np.column_stack([locus.u[columns], locus.v[rows]])
        # The locus has slivers far thinner than its nodes are apart; a frame must not fall into one.
        spacing = min(node / SAMPLES_PER_NODE, _length(points) / (SAMPLES_PER_FRAME * (frames - 1)))
        failing = _failing_edges(morph, points, tolerance, math.ceil(math.sqrt(2) * node / spacing))
        if len(failing) == 0:
            return (yield from _simplified_steps(morph, points, tolerance, spacing))
        for edge in failing:
            step = np.array([rows[edge + 1] - rows[edge], columns[edge + 1] - columns[edge]])
            k = int(np.flatnonzero((step == STEPS).all(axis=1))[0])
            closed[rows[edge], columns[edge], k] = True
            closed[rows[edge + 1], columns[edge + 1], 7 - k] = True
    return None


def _failing_edges(morph: Morph, points: np.ndarray, tolerance: float, samples: int) -> np.ndarray:
    """Indices of the edges between successive points (K, 2) that are not connected at one of the points within."""
    shares = (np.arange(1, samples) / samples)[:, None, None]
    between = (1 - shares) * points[:-1] + shares * points[1:]
    held = _connected(morph, between.reshape(-1, 2), tolerance).reshape(samples - 1, -1)
    return np.flatnonzero(~held.all(axis=0))


def _connected(morph: Morph, uv: np.ndarray, tolerance: float) -> np.ndarray:
    """Whether the shape is connected at each of uv (F, 2), without swell."""
    return are_connected(*family(morph, np.column_stack([uv, np.zeros(len(uv))])), tolerance)


def _simplified_steps(
    morph: Morph, points: np.ndarray, tolerance: float, spacing: float
) -> Generator[float, None, np.ndarray]:
    """Fewer points (K, 2): from each the furthest that a connected segment reaches, found by halving; in steps."""

    def reaches(start: int, end: int) -> bool:
        steps = max(2, math.ceil(float(np.hypot(*(points[end] - points[start]))) / spacing))
        shares = (np.arange(1, steps) / steps)[:, None]
        uv = (1 - shares) * points[start] + shares * points[end]
        # A sparse look first: most segments that fail do so at once.
        return bool(_connected(morph, uv[::16], tolerance).all() and _connected(morph, uv, tolerance).all())

    kept = [0]
    while kept[-1] < len(points) - 1:
        low, high = kept[-1] + 1, len(points) - 1
        if reaches(kept[-1], high):
            low = high
        while high - low > 1:
            yield 1.0
            middle = (low + high) // 2
            if reaches(kept[-1], middle):
                low = middle
            else:
                high = middle
        kept.append(low)
    return points[kept]


def _route_of_least_swell(u: np.ndarray, v: np.ndarray, field: np.ndarray) -> np.ndarray:
    """Points (K, 2) of the route over the nodes that costs the least swell; the diagonal if all others are closed."""
    start, goal = (int(np.searchsorted(v, end) * len(u) + np.searchsorted(u, end)) for end in (0.0, 1.0))
    cost = 1 + SWELL_AVERSION * field
    route = cheapest_route(cost, np.zeros((*field.shape, 8), dtype=np.bool_), start, goal)
    if len(route) == 0:
        return np.array([[0.0, 0.0], [1.0, 1.0]])
    rows, columns = np.divmod(route, len(u))
    return _few_corners(np.column_stack([u[columns], v[rows]]), 1.5 * (u[1] - u[0]))


def _few_corners(points: np.ndarray, reach: float) -> np.ndarray:
    """Drop points (K, 2) within `reach` of the line through those kept (Douglas & Peucker 1973)."""
    along = points[-1] - points[0]
    offset = points - points[0]
    away = np.abs(offset[:, 0] * along[1] - offset[:, 1] * along[0]) / max(float(np.hypot(*along)), 1e-12)
    furthest = int(np.argmax(away))
    if away[furthest] <= reach:
        return points[[0, -1]]
    before, after = _few_corners(points[: furthest + 1], reach), _few_corners(points[furthest:], reach)
    return np.concatenate([before[:-1], after])


def _rounded(morph: Morph, keys: Keys, frames: int, tolerance: float) -> Keys:
    """Round the corners that can be: handles along the common direction, kept where the shape stays connected."""
    time, points = keys.time, keys.value
    for k in range(1, len(time) - 1):
        before, after = time[k] - time[k - 1], time[k + 1] - time[k]
        velocity = (points[k + 1] - points[k - 1]) / (time[k + 1] - time[k - 1])
        left, right = keys.handle_left.copy(), keys.handle_right.copy()
        left[k], right[k] = points[k] - velocity * before / 3, points[k] + velocity * after / 3
        bent = Keys(time, points, left, right)
        samples = int(SAMPLES_PER_FRAME * max(16.0, (before + after) * (frames - 1))) + 1
        uv = bent.at(np.linspace(time[k - 1], time[k + 1], samples))
        if (np.abs(uv - np.clip(uv, -1, 2)) < 1e-9).all() and _connected(morph, uv, tolerance).all():
            keys = bent
    return keys


def _swell_steps(
    morph: Morph,
    keys: Keys,
    offset_keys: Keys | None,
    tolerance: float,
    tolerated: np.ndarray,
    threads: int | None,
) -> Generator[float, None, Keys]:
    """Keys of the least smooth swell that holds every frame (F,) together, zero at both ends."""
    frames = len(tolerated)
    times = np.arange(frames) / (frames - 1)
    places = _sample(keys, _no_swell(), offset_keys, times)
    needed = yield from parallel.part(least_swell_steps(morph, places, tolerance, 0.0, threads, tolerated), 0.0, 0.5)
    needed = _zero_at_ends(needed)
    for attempt in range(SWELL_ATTEMPTS):
        if not needed.any():
            return _no_swell()
        frame, swell = envelope(needed, max(2, (frames - 1) // SWELL_KEYS))
        swell_keys = smooth_keys(frame / (frames - 1), swell)
        # More swell than the least can fail; there the next that works is asked for.
        above = np.clip(swell_keys.at(times), 0.0, 1.0)
        share = 0.5 + 0.5 * attempt / SWELL_ATTEMPTS
        steps = least_swell_steps(morph, places, tolerance, above, threads, tolerated)
        raised = yield from parallel.part(steps, share, share + 0.5 / SWELL_ATTEMPTS)
        raised = _zero_at_ends(raised)
        failing = raised > above + 1e-12
        failing[[0, -1]] = False
        if not failing.any():
            return swell_keys
        needed = np.where(failing, raised, needed)
    return swell_keys


def _zero_at_ends(needed: np.ndarray) -> np.ndarray:
    """Swell of each frame, none at the two ends, where the shapes are the user's own, and none where none helps."""
    needed = np.where(needed <= 1, needed, 0.0)
    needed[[0, -1]] = 0.0
    return needed

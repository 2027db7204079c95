"""How much a morph must swell on the straight way, in one kernel for thousands of candidates.

Maps of an end are rows of a *table*, one for each word and symmetry; a candidate names a row of each end for each of
its maps. The kernel repeats what `Morph` computes by polar decomposition.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from .. import parallel
from ..affine import determinant, polar, singular_values
from ..decision import CONNECTED, decide_drift, empty_desk
from ..kernels import njit
from ..morph import SINGULAR, SWOLLEN, TIE

LEVELS = np.array([0.0, 1, 2, 3, 4, 6, 8, 11, 14, 18, 24, 32, 48, 64]) / 64
"""Swells that are tried."""

NEVER = 2.0
"""Stands for the swell where none of them helps."""

WORST, MEAN = 1.0, 6.0
"""Weights of the greatest and the mean swell in a score."""

TURNING, FLIP = 0.05, 0.2
"""What it costs if every map makes half a turn, and if a map of the size of the whole shape flips."""

KEEP = 0.04
"""What it costs if a shape between is e times as large, or as small, as one would expect from the ends."""

THINNEST = 0.02
"""Shapes thinner than this share of their length count as if they were as thick."""

USUAL = 100
"""Pairs of pieces looked at for a pair of maps, beyond which a shape counts as several in the work."""

GAPE = 8
"""Shapes that one counts for whose gap is measured."""

CHUNK = 4

CHECKS = 2
"""Times a frame at which what was found is checked."""


@dataclass(frozen=True, eq=False)
class Table:
    """Maps of one end that a candidate can choose from.

    Attributes
    ----------
    angle : (E, 2)
        Polar angle if the map is taken as one that preserves orientation, and as one that reflects.
    stretch : (E, 2, 3)
        Stretch likewise: xx, xy, yy.
    translation : (E, 2)
    reflects : (E,) int64
        0 or 1, and 2 for a singular map, which is as the other end is.
    """

    angle: np.ndarray
    stretch: np.ndarray
    translation: np.ndarray
    reflects: np.ndarray

    @classmethod
    def of(cls, maps: np.ndarray) -> Table:
        """The table of maps (E, 2, 3)."""
        linear = np.ascontiguousarray(maps[:, :, :2])
        angle, stretch = np.empty((len(maps), 2)), np.empty((len(maps), 2, 3))
        for reflects in (0, 1):
            angle[:, reflects], _, found = polar(linear, np.full(len(maps), bool(reflects)))
            stretch[:, reflects] = found.reshape(-1, 4)[:, [0, 1, 3]]
        values = singular_values(linear)
        singular = values[:, 1] <= SINGULAR * values[:, 0]
        reflects = np.where(singular, 2, (determinant(linear) < 0).astype(np.int64))
        return cls(angle, stretch, np.ascontiguousarray(maps[:, :, 2]), reflects)

    @property
    def columns(self) -> tuple[np.ndarray, ...]:
        """As the kernels take it."""
        return self.angle, self.stretch, self.translation, self.reflects


def golden_samples(count: int) -> np.ndarray:
    """Times within (0, 1) that lie evenly, however many of them are taken from the start."""
    golden = (math.sqrt(5) - 1) / 2
    return np.remainder(0.5 + golden * np.arange(count), 1.0)


def score(
    initial: Table,
    final: Table,
    rows: np.ndarray,
    winding: np.ndarray,
    samples: np.ndarray,
    tolerance: float,
    tolerated: np.ndarray,
    bound: float = np.inf,
    extra: float = 0.0,
    threads: int | None = None,
) -> tuple[np.ndarray, np.ndarray, int]:
    """Scores (C,) of candidates, the lower the better.

    ``WORST * greatest + MEAN * mean`` swell, and what turning, flips and shapes out of size cost.

    Parameters
    ----------
    initial, final : Table
    rows : (C, 2, N) int64
        Rows of the two tables.
    winding : (C, N) int64
    samples : (S,)
        Times at which the straight line is looked at.
    tolerance : float
    tolerated : (S,)
        Gaps let pass at these times, see `tolerated`; those up to the tolerance always are.
    bound : float
        A candidate is given up when its score is sure to be above; infinity is its score then.
    extra : float
        Added to every score.

    Returns
    -------
    scores : (C,)
    swells : (C, S)
        Of each sample; NaN where a candidate was given up before.
    work : int
        Shapes decided, each counted as often as it was hard, for a budget that does not depend on the machine.
    """
    chunks = range(0, len(rows), CHUNK)

    def part(start: int) -> tuple[np.ndarray, np.ndarray, int]:
        chosen = slice(start, start + CHUNK)
        return _score(
            *initial.columns,
            *final.columns,
            rows[chosen],
            winding[chosen],
            samples,
            tolerance,
            tolerated,
            bound,
            extra,
        )

    found = parallel.run(part, chunks, threads)
    scores, swells = (np.concatenate([each[k] for each in found]) for k in (0, 1))
    return scores, swells, sum(each[2] for each in found)


@njit(nogil=True, cache=True)
def _score(
    first_angle,
    first_stretch,
    first_translation,
    first_reflects,
    last_angle,
    last_stretch,
    last_translation,
    last_reflects,
    rows,
    winding,
    samples,
    tolerance,
    tolerated,
    bound,
    extra,
):
    count, maps = rows.shape[0], rows.shape[2]
    scores = np.empty(count)
    swells = np.full((count, samples.shape[0]), np.nan)
    start, turn, sign = np.empty(maps), np.empty(maps), np.empty((maps, 2))
    ends = np.empty((maps, 2, 3))
    linear, translation = np.empty((maps, 4)), np.empty((maps, 2))
    desk, drift, along = empty_desk(maps), np.zeros((maps, 2)), np.zeros(1)
    first = np.int64(0)
    state, gap, labels = np.empty(1, np.uint8), np.empty((1, 2)), np.empty((1, maps), np.int64)
    work, usual = 0, USUAL * maps * (maps - 1) // 2 + 1
    for candidate in range(count):
        for k in range(maps):
            i, j = rows[candidate, 0, k], rows[candidate, 1, k]
            one, other = first_reflects[i], last_reflects[j]
            if one == 2:
                one = 0 if other == 2 else other
            if other == 2:
                other = one
            start[k] = first_angle[i, one]
            turning = (last_angle[j, other] - start[k] + math.pi) % (2 * math.pi) - math.pi
            if abs(turning) >= math.pi - TIE:
                turning = abs(turning)
            turn[k] = turning + 2 * math.pi * winding[candidate, k]
            ends[k, 0], ends[k, 1] = first_stretch[i, one], last_stretch[j, other]
            sign[k, 0], sign[k, 1] = 1 - 2 * one, 1 - 2 * other
        worst, total = 0.0, extra
        for k in range(maps):
            total += TURNING * abs(turn[k]) / math.pi / maps
            if sign[k, 0] != sign[k, 1]:
                total += FLIP * math.sqrt(_area(ends[k, 0]) + _area(ends[k, 1]))
        total += KEEP * _distortion(start, turn, sign, ends, first_translation, last_translation, rows[candidate])
        for sample in range(samples.shape[0]):
            at, gapes = samples[sample], tolerated[sample] > tolerance
            for k in range(maps):
                i, j = rows[candidate, 0, k], rows[candidate, 1, k]
                translation[k] = (1 - at) * first_translation[i] + at * last_translation[j]
            # The most swell that keeps the score within the bound.
            most = LEVELS.shape[0]
            while most >= 0:
                swell = LEVELS[most] if most < LEVELS.shape[0] else NEVER
                if total + MEAN * swell / samples.shape[0] + WORST * max(worst, swell) <= bound:
                    break
                most -= 1
            # None; then the most; then by bisection, as if more were always better. Verified where it matters.
            low, high, level = 0, most + 1, 0
            while low < high and level < LEVELS.shape[0]:
                _linear_parts(start, turn, sign, ends, at, LEVELS[level], linear)
                decide_drift(desk, linear, translation, drift, along, tolerance, gapes, first, state, gap, labels)
                work += max(1, desk.tree.used[1] // usual) * (GAPE if gapes else 1)
                if state[0] == CONNECTED or gap[0, 1] <= tolerated[sample]:
                    high = level
                else:
                    low = level + 1
                level = min(most, LEVELS.shape[0] - 1) if low == 1 and high == most + 1 else (low + high) // 2
            if low > most:
                total = np.inf
                break
            swell = LEVELS[low] if low < LEVELS.shape[0] else NEVER
            swells[candidate, sample] = swell
            worst = max(worst, swell)
            total += MEAN * swell / samples.shape[0]
        scores[candidate] = total + WORST * worst
    return scores, swells, work


@njit(nogil=True, cache=True)
def _distortion(start, turn, sign, ends, first_translation, last_translation, rows):
    """How far the size of shapes between is off the line between the ends', as a logarithm."""
    maps = start.shape[0]
    linear, translation = np.empty((maps, 4)), np.empty((maps, 2))
    size = np.empty(5)
    for k in range(5):
        at = k / 4
        for i in range(maps):
            translation[i] = (1 - at) * first_translation[rows[0, i]] + at * last_translation[rows[1, i]]
        _linear_parts(start, turn, sign, ends, at, 0.0, linear)
        size[k] = _log_size(linear, translation)
    furthest = 0.0
    for k in range(1, 4):
        furthest = max(furthest, abs(size[k] - (1 - k / 4) * size[0] - k / 4 * size[4]))
    return furthest


@njit(nogil=True, cache=True)
def _log_size(linear, translation):
    """Logarithm of the root of the area of the ellipse that the measure by areas spreads over."""
    areas = np.abs(linear[:, 0] * linear[:, 3] - linear[:, 1] * linear[:, 2])
    least = max(0.01 * areas.sum(), 1e-12)
    # Mean and spread are fixed points of one application of the maps.
    matrix, right = np.eye(2), np.zeros(2)
    spread, beside = np.eye(3), np.zeros(3)
    total = 0.0
    for area in areas:
        total += max(area, least)
    for i in range(linear.shape[0]):
        weight = max(areas[i], least) / total
        a, b, c, d = linear[i]
        matrix -= weight * np.array([[a, b], [c, d]])
        right += weight * translation[i]
        square = np.array([[a * a, 2 * a * b, b * b], [a * c, a * d + b * c, b * d], [c * c, 2 * c * d, d * d]])
        spread -= weight * square
    if abs(np.linalg.det(matrix)) < SINGULAR or abs(np.linalg.det(spread)) < SINGULAR:
        return 0.0
    x, y = np.linalg.solve(matrix, right)
    for i in range(linear.shape[0]):
        weight = max(areas[i], least) / total
        p = linear[i, 0] * x + linear[i, 1] * y + translation[i, 0] - x
        q = linear[i, 2] * x + linear[i, 3] * y + translation[i, 1] - y
        beside += weight * np.array([p * p, p * q, q * q])
    xx, xy, yy = np.linalg.solve(spread, beside)
    length = abs(xx) + abs(yy)
    area = max(xx * yy - xy * xy, (THINNEST * length) ** 2)
    return 0.25 * math.log(max(area, 1e-300))


@njit(nogil=True, cache=True)
def _area(stretch):
    return abs(stretch[0] * stretch[2] - stretch[1] * stretch[1])


@njit(nogil=True, cache=True)
def _linear_parts(start, turn, sign, ends, u, swell, linear):
    """Write the linear parts (N, 4) at u and swell, as `Morph.linear` has them."""
    for k in range(start.shape[0]):
        xx = (1 - u) * ends[k, 0, 0] + u * ends[k, 1, 0]
        xy = (1 - u) * ends[k, 0, 1] + u * ends[k, 1, 1]
        yy = (1 - u) * ends[k, 0, 2] + u * ends[k, 1, 2]
        if swell > 0:
            mean, p = (xx + yy) / 2, (xx - yy) / 2
            radius = math.sqrt(p * p + xy * xy)
            high, low = mean + radius, mean - radius
            high += swell * max(0.0, SWOLLEN - high)
            low += swell * max(0.0, SWOLLEN - low)
            slope = (high - low) / 2 / radius if radius > 0 else 0.0
            xx, xy, yy = (high + low) / 2 + slope * p, slope * xy, (high + low) / 2 - slope * p
        flip = sign[k, 0] if sign[k, 0] == sign[k, 1] else sign[k, 0] * math.cos(math.pi * u)
        angle = start[k] + u * turn[k]
        cos, sin = math.cos(angle), math.sin(angle)
        linear[k, 0], linear[k, 1] = cos * xx - sin * flip * xy, cos * xy - sin * flip * yy
        linear[k, 2], linear[k, 3] = sin * xx + cos * flip * xy, sin * xy + cos * flip * yy

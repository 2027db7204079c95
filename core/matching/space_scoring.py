"""How much a morph in space must swell on the straight way, for many candidates at once (see `scoring`).

Here it is the morph itself that is asked, not a kernel that repeats it: to decide a shape in space takes far longer.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .. import parallel
from ..affine import determinant
from ..deciding import decide_frames
from ..space.ifs import SpaceIFS
from ..space.morph import SpaceMorph
from ..states import CONNECTED, UNDECIDED
from .scoring import FLIP, KEEP, LEVELS, MEAN, NEVER, THINNEST, TURNING, WORST

CHUNK = 8
"""Candidates looked at together."""

CHECKS = 1 / 3
"""Times a frame at which what was found is checked."""

EFFORT, UNDECIDED_EFFORT = 20, 80
"""How many times the work of a shape of the plane one in space is, and one that stays undecided."""

TRIED = np.append(LEVELS, NEVER)
"""Swells by their places."""

LOOKED_AT = np.linspace(0, 1, 5)
"""Times at which the sizes of shapes are compared with the ends'."""


@dataclass(frozen=True, eq=False)
class Table:
    """Maps (E, 3, 4) of one end that a candidate can choose from."""

    maps: np.ndarray

    @classmethod
    def of(cls, maps: np.ndarray) -> Table:
        """The table of maps (E, 3, 4)."""
        return cls(maps)


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
    """Scores (C,) of candidates, their swells (C, S), and the work that it took; as `scoring.score`."""

    def part(start: int) -> tuple[np.ndarray, np.ndarray, int]:
        chosen = rows[start : start + CHUNK]
        ends = [SpaceIFS(table.maps[chosen[:, end].ravel()]) for end, table in enumerate((initial, final))]
        morph = SpaceMorph(*ends, winding=winding[start : start + CHUNK].ravel())
        return _score(morph, len(chosen), samples, tolerance, tolerated, bound, extra)

    found = parallel.run(part, range(0, len(rows), CHUNK), threads)
    scores, swells = (np.concatenate([each[k] for each in found]) for k in (0, 1))
    return scores, swells, sum(each[2] for each in found)


def _score(
    morph: SpaceMorph,
    count: int,
    samples: np.ndarray,
    tolerance: float,
    tolerated: np.ndarray,
    bound: float,
    extra: float,
) -> tuple[np.ndarray, np.ndarray, int]:
    """Score `count` candidates, whose maps are those of one morph, one candidate's after the other's."""
    total, worst = extra + _cost_beside_swell(morph, count), np.zeros(count)
    swells = np.full((count, len(samples)), np.nan)
    work = 0
    # One time after the other, where that can spare the rest.
    step = 1 if np.isfinite(bound) else max(1, len(samples))
    for first in range(0, len(samples), step):
        times = slice(first, first + step)
        # The most swell that keeps the score within the bound.
        reached = total[:, None] + MEAN * TRIED / len(samples) + WORST * np.maximum(worst[:, None], TRIED)
        most = np.count_nonzero(reached <= bound, axis=1) - 1
        most_open = np.where(np.isfinite(total), most, -1)
        least, cost = _least(morph, samples[times], most_open, tolerance, tolerated[times])
        work += cost
        total[(least > most[:, None]).any(axis=1)] = np.inf
        kept = np.isfinite(total)
        swells[kept, times] = TRIED[least[kept]]
        worst[kept] = np.maximum(worst[kept], swells[kept, times].max(axis=1))
        total[kept] += MEAN * swells[kept, times].sum(axis=1) / len(samples)
    return total + WORST * worst, swells, work


def _least(
    morph: SpaceMorph, times: np.ndarray, most: np.ndarray, tolerance: float, tolerated: np.ndarray
) -> tuple[np.ndarray, int]:
    """The least of `TRIED` (C, S) that helps, one more than `most` (C,) where none up to it does; and the work."""
    count, levels = len(most), len(LEVELS)
    translation = morph.translation(times[:, None]).reshape(len(times), count, -1, 3)
    # None; then the most; then by bisection, as if more were always better.
    most = np.broadcast_to(most, (len(times), count))
    tolerated = np.broadcast_to(tolerated[:, None], most.shape)
    with_gap = bool((tolerated > tolerance).any())
    low, high, level = np.zeros_like(most), most + 1, np.zeros_like(most)
    work = 0
    while (still := (low < high) & (level < levels)).any():
        swell = np.repeat(LEVELS[np.minimum(level, levels - 1)], morph.count // count, axis=1)
        linear = morph.linear(times[:, None], swell).reshape(*translation.shape[:3], 9)
        chosen = linear[still]
        allowed = np.ones((len(chosen), chosen.shape[1] + 1, chosen.shape[1]), dtype=bool)
        state, gap, _ = decide_frames(chosen, translation[still], allowed, tolerance, with_gap)
        work += int(np.where(state == UNDECIDED, UNDECIDED_EFFORT, EFFORT).sum())
        whole = np.zeros_like(still)
        whole[still] = (state == CONNECTED) | (gap[:, 1] <= tolerated[still])
        high = np.where(whole, level, high)
        low = np.where(still & ~whole, level + 1, low)
        second = (low == 1) & (high == most + 1)
        level = np.where(still, np.where(second, np.minimum(most, levels - 1), (low + high) // 2), level)
    return low.T, work


def _cost_beside_swell(morph: SpaceMorph, count: int) -> np.ndarray:
    """What turning, flips and shapes out of size cost each candidate (C,)."""
    flips = np.isin(np.arange(morph.count), morph.flips)
    sizes = sum(np.cbrt(np.abs(determinant(ifs.linear))) for ifs in (morph.initial, morph.final))
    turning = np.abs(morph.turning).reshape(count, -1).mean(axis=1) / np.pi
    size = np.stack([_log_sizes(morph, at, count) for at in LOOKED_AT])
    expected = (1 - LOOKED_AT[:, None]) * size[0] + LOOKED_AT[:, None] * size[-1]
    distortion = np.abs(size - expected).max(axis=0)
    return TURNING * turning + FLIP * (flips * sizes).reshape(count, -1).sum(axis=1) + KEEP * distortion


def _log_sizes(morph: SpaceMorph, at: float, count: int) -> np.ndarray:
    """Logarithms (C,) of the cube roots of the volumes of the ellipsoids that the measures by volumes spread over."""
    linear = morph.linear(at).reshape(count, -1, 3, 3)
    translation = morph.translation(at).reshape(count, -1, 3)
    volumes = np.abs(determinant(linear))
    weights = np.maximum(volumes, np.maximum(0.01 * volumes.sum(axis=1, keepdims=True), 1e-12))
    weights = weights / weights.sum(axis=1, keepdims=True)
    # Mean and spread are fixed points of one application of the maps.
    mean = np.linalg.solve(
        np.eye(3) - np.einsum("cn,cnij->cij", weights, linear),
        np.einsum("cn,cni->ci", weights, translation)[..., None],
    )[..., 0]
    beside = np.einsum("cnij,cj->cni", linear, mean) + translation - mean[:, None]
    square = np.einsum("cn,cnij,cnkl->cikjl", weights, linear, linear).reshape(count, 9, 9)
    right = np.einsum("cn,cni,cnj->cij", weights, beside, beside).reshape(count, 9, 1)
    spread = np.linalg.solve(np.eye(9) - square, right).reshape(count, 3, 3)
    lengths = np.sqrt(np.abs(np.linalg.eigvalsh(spread)))
    lengths = np.maximum(lengths, np.maximum(THINNEST * lengths.max(axis=1, keepdims=True), 1e-100))
    return np.log(lengths).mean(axis=1)

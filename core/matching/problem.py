"""What the search works on: the words and symmetries of both ends, and candidates that pair them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import total_ordering

import numpy as np

from ..affine import compose, rotation, transform
from ..ifs import IFS
from ..joining import Word, word_map
from ..tolerated import tolerated_at_ends, tolerated_gaps
from . import scoring, space_scoring
from .assignment import assign
from .pairs import Pair
from .scoring import MEAN, WORST, golden_samples

SAMPLES = 12
"""Times looked at for every candidate."""

CLUTTER = 0.03
"""What it costs to list one pair more than needed."""


@dataclass(frozen=True, eq=False)
class End:
    """One end of a problem.

    Attributes
    ----------
    ifs : IFS
    symmetries : (G, 2, 3), or (G, 3, 4)
        Of its attractor, the identity first.
    words : list of Word
        Each at least once in every candidate.
    """

    ifs: IFS
    symmetries: np.ndarray
    words: list[Word]

    def maps(self) -> np.ndarray:
        """All words through all symmetries (W * G, 2, 3), or (W * G, 3, 4)."""
        maps = np.array([word_map(self.ifs, word) for word in self.words])
        return compose(maps[:, None], self.symmetries[None]).reshape(-1, *self.symmetries.shape[1:])


@dataclass(frozen=True)
class Lock:
    """A pair that is to be kept: rows of both words, and what is fixed about it besides."""

    words: tuple[int, int]
    symmetries: tuple[int | None, int | None] = (None, None)
    winding: int | None = None


@total_ordering
@dataclass(frozen=True, eq=False)
class Candidate:
    """A pairing, ordered by score.

    Attributes
    ----------
    score : float
    rows : (2, N) int64
        Of the tables of the two ends: word times number of symmetries, plus the symmetry. Locked pairs come first.
    winding : (N,) int64
    swells : (S,)
        At the times looked at.
    cost_beside_swell : float
        What is in the score for turning, flips, sizes and further pairs.
    """

    score: float
    rows: np.ndarray
    winding: np.ndarray
    swells: np.ndarray
    cost_beside_swell: float

    @property
    def spotless(self) -> bool:
        """Whether no sample needs swell."""
        return not self.swells.any()

    def __lt__(self, other: Candidate) -> bool:
        return self.score < other.score


class Problem:
    """The words, symmetries and locks of a search, and its count of work.

    Attributes
    ----------
    least : int
        Pairs that are needed.
    locked : int
        Pairs that stay; every candidate begins with them.
    work : int
        Shapes decided so far, each counted by its pairs of maps.
    """

    def __init__(
        self, initial: End, final: End, tolerance: float, locks: tuple[Lock, ...] = (), threads: int | None = None
    ) -> None:
        self.ends = (initial, final)
        self.tolerance, self.threads, self.locks = tolerance, threads, locks
        self.at_ends = tolerated_at_ends((initial.ifs, final.ifs), tolerance)
        self.maps = [end.maps() for end in self.ends]
        self.scoring = scoring if initial.ifs.DIMENSION == 2 else space_scoring
        self.tables = [self.scoring.Table.of(maps) for maps in self.maps]
        self.sizes = [len(end.symmetries) for end in self.ends]
        self.word_counts = [len(end.words) for end in self.ends]
        self.locked = len(locks)
        self.least = self.locked + max(len(self.free_words(end)) for end in (0, 1))
        self.work = 0
        self.samples = golden_samples(SAMPLES)

    def words(self, rows: np.ndarray, end: int) -> np.ndarray:
        """Words (N,) of one end of a candidate's rows."""
        return rows[end] // self.sizes[end]

    def tolerated(self, samples: np.ndarray) -> np.ndarray:
        """Gaps (S,) that are let pass at some times."""
        return tolerated_gaps(self.at_ends, samples)

    def free_words(self, end: int) -> list[int]:
        """Words of one end that no lock holds: the others are in the locked pairs and, if it can be, in no more."""
        held = {lock.words[end] for lock in self.locks}
        return [word for word in range(self.word_counts[end]) if word not in held]

    def open_words(self, end: int) -> list[int]:
        """Words for pairs beyond the locked ones: those that are free, or all where the other end needs partners."""
        return self.free_words(end) or list(range(self.word_counts[end]))

    def may_turn(self, end: int, pair: int) -> bool:
        """Whether the symmetry of a pair is open."""
        return pair >= self.locked or self.locks[pair].symmetries[end] is None

    def may_wind(self, pair: int) -> bool:
        """Whether the winding of a pair is open."""
        return pair >= self.locked or self.locks[pair].winding is None

    def evaluate(self, starts: list[tuple[np.ndarray, np.ndarray]]) -> list[Candidate]:
        """Candidates of rows and windings, all of as many pairs."""
        return self._scored(starts, np.inf, np.arange(len(self.samples)))

    def best_of(self, batch: list[tuple[np.ndarray, np.ndarray]], best: Candidate) -> Candidate:
        """The best of a batch, or `best` if none is better."""
        # Those that are no better show it soonest where the best one swells most.
        order = np.argsort(-best.swells, kind="stable")
        groups: dict[int, list] = {}
        for rows, winding in batch:
            groups.setdefault(rows.shape[1], []).append((rows, winding))
        for group in groups.values():
            best = min([best, *self._scored(group, best.score - 1e-9, order)])
        return best

    def _scored(self, batch: list, bound: float, order: np.ndarray) -> list[Candidate]:
        rows = np.array([rows for rows, _ in batch])
        winding = np.array([winding for _, winding in batch])
        count = rows.shape[2]
        extra = CLUTTER * (count - self.least)
        samples = self.samples[order]
        scores, found, work = self._score(rows, winding, samples, bound, extra)
        self.work += work
        swells = np.empty_like(found)
        swells[:, order] = found
        beside = scores - WORST * swells.max(axis=1) - MEAN * swells.mean(axis=1)
        # Those given up have an infinite score.
        return [
            Candidate(float(scores[k]), rows[k], winding[k], swells[k], float(beside[k])) for k in range(len(batch))
        ]

    def look_at(self, times: np.ndarray) -> None:
        """Add samples."""
        self.samples = np.concatenate([self.samples, times])

    def swells(self, candidate: Candidate, times: np.ndarray) -> np.ndarray:
        """Swell (S,) that a candidate needs at times (S,) of the straight line."""
        rows, winding = candidate.rows[None], candidate.winding[None]
        _, swells, _ = self._score(rows, winding, times, np.inf, 0.0)
        return swells[0]

    def _score(
        self, rows: np.ndarray, winding: np.ndarray, samples: np.ndarray, bound: float, extra: float
    ) -> tuple[np.ndarray, np.ndarray, int]:
        """Scores and swells as `scoring.score` gives them, and the work."""
        count = rows.shape[2]
        scores, swells, work = self.scoring.score(
            *self.tables, rows, winding, samples, self.tolerance, self.tolerated(samples), bound, extra, self.threads
        )
        return scores, swells, work * count * (count - 1) // 2

    def _beside(self, rows: np.ndarray, winding: np.ndarray) -> np.ndarray:
        """What candidates (C,) cost beside swell."""
        none = np.empty(0)
        return self.scoring.score(*self.tables, rows, winding, none, self.tolerance, none, np.inf, 0.0, self.threads)[0]

    def pairs(self, candidate: Candidate) -> tuple[Pair, ...]:
        """A candidate as pairs of words and symmetries."""
        return self.pairs_of(candidate.rows, candidate.winding)

    def pairs_of(self, rows: np.ndarray, winding: np.ndarray) -> tuple[Pair, ...]:
        """Rows (2, N) and winding (N,) as pairs of words and symmetries."""
        found = []
        for k in range(rows.shape[1]):
            parts = []
            for end in (0, 1):
                word, symmetry = divmod(int(rows[end, k]), self.sizes[end])
                matrix = self.ends[end].symmetries[symmetry]
                parts.append((self.ends[end].words[word], tuple(tuple(row) for row in matrix.tolist())))
            found.append(Pair(parts[0][0], parts[1][0], parts[0][1], parts[1][1], int(winding[k])))
        return tuple(found)

    def starts(self) -> list[tuple[np.ndarray, np.ndarray]]:
        """Rows and windings to start from: the given order, and the assignments of least motion."""
        given = [self._filled(end) for end in (0, 1)]
        turned = [self._assigned(*given, turn) for turn in _turns(self.ends[0].ifs.DIMENSION)]
        found = [self._complete(given[0], final) for final in (given[1], *turned)]
        different = {tuple(rows.ravel()): (rows, winding) for rows, winding in found}
        return list(different.values())

    def first(self) -> tuple[tuple[Pair, ...], float]:
        """The pairs of the first start, and what they cost beside swell."""
        rows, winding = self.starts()[0]
        return self.pairs_of(rows, winding), float(self._beside(rows[None], winding[None])[0])

    def shuffled(self, random: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
        """Rows and winding in an order of chance, through symmetries of chance."""
        first, last = (random.permutation(self._filled(end)) for end in (0, 1))
        first += random.integers(self.sizes[0], size=len(first))
        last += random.integers(self.sizes[1], size=len(last))
        return self._complete(first, last)

    def _filled(self, end: int) -> np.ndarray:
        """Rows of the open words of one end, in turn until there are enough."""
        words = self.open_words(end)
        return (
            np.array([words[k % len(words)] for k in range(self.least - self.locked)], dtype=np.int64) * self.sizes[end]
        )

    def _complete(self, first: np.ndarray, last: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Rows and winding of a candidate: the locked pairs, then those of the rows given."""
        locked = [
            [lock.words[end] * self.sizes[end] + (lock.symmetries[end] or 0) for lock in self.locks] for end in (0, 1)
        ]
        rows = np.array([[*locked[0], *first], [*locked[1], *last]], dtype=np.int64)
        winding = np.zeros(rows.shape[1], dtype=np.int64)
        winding[: self.locked] = [lock.winding or 0 for lock in self.locks]
        return rows, winding

    def _assigned(self, first: np.ndarray, last: np.ndarray, turn: np.ndarray) -> np.ndarray:
        """The final rows in the order of least motion, through the symmetry nearest, if the final shape were turned.

        Pieces are compared by the images of a frame, in units of the enclosing discs or balls.
        """
        dimension = len(turn)
        images = []
        for end, maps in zip(self.ends, self.maps, strict=True):
            center, radius = end.ifs.enclosing_disc
            frame = center + radius / 2 * np.eye(dimension + 1, dimension, -1)
            images.append((transform(maps[:, None], frame) - center) / (radius or 1.0))
        start = images[0][first]
        gauged = (images[1] @ turn.T).reshape(-1, self.sizes[1], dimension + 1, dimension)
        apart = ((start[:, None, None] - gauged[last // self.sizes[1]]) ** 2).sum(axis=(-1, -2))
        to = assign(apart.min(axis=2))
        return last[to] + apart.argmin(axis=2)[np.arange(len(to)), to]


def _turns(dimension: int) -> np.ndarray:
    """Ways (T, D, D) to turn a shape before its pieces are assigned: by quarters, in space by halves about the axes."""
    if dimension == 2:
        return rotation(np.pi / 2 * np.arange(4))
    return np.array([np.diag(signs) for signs in ((1, 1, 1), (-1, -1, 1), (-1, 1, -1), (1, -1, -1))])

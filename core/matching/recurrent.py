"""The search between shapes one of which is recurrent or hides maps: candidates are scored by the morphs they make.

What may follow what depends on the pairs, and with it the maps that a morph has (see `joining`). So each candidate's
morph is made, and decided as it will be drawn.
"""

from __future__ import annotations

import numpy as np

from .. import parallel
from ..deciding import are_connected
from ..morph import Morph
from ..report import family
from .pairs import morph_of_pairs
from .problem import End, Lock, Problem
from .scoring import LEVELS, MEAN, NEVER, WORST

EFFORT = 6
"""Work that one pair of maps counts for, beside that of plain shapes."""


class RecurrentProblem(Problem):
    """The words and locks of a search between two shapes, whatever may follow what and whatever is hidden."""

    def _score(
        self, rows: np.ndarray, winding: np.ndarray, samples: np.ndarray, bound: float, extra: float
    ) -> tuple[np.ndarray, np.ndarray, int]:
        beside = self._beside(rows, winding) + extra

        def of_candidate(k: int) -> tuple[float, np.ndarray, int]:
            pairs = self.pairs_of(rows[k], winding[k])
            morph = morph_of_pairs(*(end.ifs for end in self.ends), pairs)
            swells, decided = _least_swells(morph, samples, self.tolerance, self.tolerated(samples), bound - beside[k])
            cost = beside[k] + WORST * swells.max() + MEAN * swells.mean()
            return np.nan_to_num(cost, nan=np.inf), swells, decided * EFFORT * morph.count * (morph.count - 1) // 2

        found = parallel.run(of_candidate, range(len(rows)), self.threads)
        scores, swells = (np.array([each[k] for each in found]) for k in (0, 1))
        return scores, swells, sum(each[2] for each in found)


def problem_of(
    initial: End, final: End, tolerance: float, locks: tuple[Lock, ...] = (), threads: int | None = None
) -> Problem:
    """The problem of two ends, of the kind that they need."""
    # In space nothing is recurrent, and the search goes by whole attractors.
    plain = initial.ifs.DIMENSION == 3 or all(end.ifs.allowed.all() for end in (initial, final))
    kind = Problem if plain else RecurrentProblem
    return kind(initial, final, tolerance, locks, threads)


def _least_swells(
    morph: Morph, samples: np.ndarray, tolerance: float, tolerated: np.ndarray, room: float
) -> tuple[np.ndarray, int]:
    """Swells (S,) that a morph needs on the straight line, NaN from where they cost more than `room`; shapes decided.

    By the same steps as in the kernel of `scoring`.
    """
    swells, decided = np.full(len(samples), np.nan), 0
    levels = np.append(LEVELS, NEVER)
    for place, at in enumerate(samples):
        known = swells[:place]
        costs = MEAN * (known.sum() + levels) / len(samples) + WORST * np.maximum(known.max(initial=0.0), levels)
        most = np.count_nonzero(costs <= room) - 1
        linear, translation, allowed = family(morph, np.column_stack([np.full((len(LEVELS), 2), at), LEVELS]))
        low, high, level = 0, most + 1, 0
        while low < high and level < len(LEVELS):
            here = slice(level, level + 1)
            decided += 1
            if are_connected(linear[here], translation[here], allowed[here], tolerance, tolerated[place])[0]:
                high = level
            else:
                low = level + 1
            level = min(most, len(LEVELS) - 1) if low == 1 and high == most + 1 else (low + high) // 2
        if low > most:
            break
        swells[place] = levels[low]
    return swells, decided

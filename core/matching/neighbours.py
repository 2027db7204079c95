"""The moves of the search: the candidates that differ by one decision."""

from __future__ import annotations

import numpy as np

from .problem import Candidate, Problem

MOST_TURNS = 3
"""Whole turns of a map beyond the shorter way, at most."""

Rows = tuple[np.ndarray, np.ndarray]
"""Rows (2, N) and winding (N,) of a candidate not yet scored."""


def neighbours(problem: Problem, candidate: Candidate) -> list[Rows]:
    """All candidates one move away.

    Two pairs exchange partners; a map goes through another symmetry, or turns once more or less; a word listed twice
    gives way to another; a pair that is not needed goes.
    """
    rows, winding, count = candidate.rows, candidate.winding, candidate.rows.shape[1]
    locked = problem.locked
    found = []
    for p in range(locked, count):
        others = [q for q in range(p + 1, count) if (rows[:, p] != rows[:, q]).all()]
        found += [(_with(rows, 1, [p, q], rows[1, [q, p]]), winding) for q in others]
    for end in (0, 1):
        size = problem.sizes[end]
        words = problem.words(rows, end)
        counts = np.bincount(words, minlength=problem.word_counts[end])
        for p in range(count):
            if problem.may_turn(end, p):
                others = words[p] * size + np.arange(size)
                found += [(_with(rows, end, [p], row), winding) for row in others if row != rows[end, p]]
            if p >= locked and counts[words[p]] > 1:
                others = [word for word in problem.open_words(end) if word != words[p]]
                found += [(_with(rows, end, [p], word * size), winding) for word in others]
    for p in range(count):
        if problem.may_wind(p):
            for turn in (-1, 1):
                if abs(winding[p] + turn) <= MOST_TURNS:
                    wound = winding.copy()
                    wound[p] += turn
                    found.append((rows, wound))
    if count > problem.least:
        listed = [np.bincount(problem.words(rows, end))[problem.words(rows, end)] for end in (0, 1)]
        spare = np.flatnonzero((listed[0] > 1) & (listed[1] > 1))
        found += [(np.delete(rows, p, axis=1), np.delete(winding, p)) for p in spare[spare >= locked]]
    return found


def additions(problem: Problem, candidate: Candidate) -> list[Rows]:
    """The candidate with one pair more, of any two free words, through any symmetry of the end that has more."""
    rows, winding = candidate.rows, candidate.winding
    free = int(np.argmax(problem.sizes))
    found = []
    for one in problem.free_words(0):
        for other in problem.free_words(1):
            for symmetry in range(problem.sizes[free]):
                pair = [one * problem.sizes[0], other * problem.sizes[1]]
                pair[free] += symmetry
                column = np.array(pair)[:, None]
                found.append((np.concatenate([rows, column], axis=1), np.append(winding, 0)))
    return found


def _with(rows: np.ndarray, end: int, places: list[int], values: np.ndarray) -> np.ndarray:
    changed = rows.copy()
    changed[end, places] = values
    return changed

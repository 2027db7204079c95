"""The search for a good pairing: from several starts, step by step to better neighbours.

It is looked for which word becomes which, through which symmetry of each end, with how many turns, and which words
are listed twice.
"""

from __future__ import annotations

from collections.abc import Generator

import numpy as np

from .neighbours import additions, neighbours
from .problem import Candidate, Problem

GOOD = 0.05
"""Without swell, a score that needs no further search: little turning, and no pairs beyond those needed."""

BATCH = 24
"""Neighbours scored at once; the best of them is taken if it is better."""

STARTS = 12
"""Starts climbed from: the assigned ones first, then shuffled ones."""

GROWN = (3, STARTS - 1)
"""Starts after which pairs are added to the best candidates yet."""

MOST_ADDED = 4
"""Pairs added at most beyond those needed."""

ADDITIONS = 240
"""Pairs tried when one is to be added."""


def good(candidate: Candidate) -> bool:
    """Whether a candidate is good enough to look for no other."""
    return candidate.score < GOOD and candidate.spotless


def search_steps(
    problem: Problem, budget: int, start: Candidate | None = None
) -> Generator[float, None, list[Candidate]]:
    """Search until a candidate is good, all is tried, or the budget spent; in steps, each yielding the share spent.

    Parameters
    ----------
    problem : Problem
    budget : int
        Of work as `Problem.work` counts it. The same budget gives the same candidates on every machine.
    start : Candidate, optional
        To go on from, before all else.

    Returns
    -------
    list of Candidate
        The best one, and if it lists more pairs than needed, also the best of those that do not.
    """
    random = np.random.default_rng(1)
    begun, end = problem.work, problem.work + budget
    known = [] if start is None else problem.evaluate([(start.rows, start.winding)])
    starts = known + sorted(problem.evaluate(problem.starts()))
    tops = sorted(starts)

    def until() -> int:
        """A third of the budget that is left, for one start."""
        return problem.work + (end - problem.work) // 3

    for k in range(STARTS):
        if good(tops[0]) or problem.work >= end:
            break
        yield (problem.work - begun) / budget
        start = starts[k] if k < len(starts) else problem.evaluate([problem.shuffled(random)])[0]
        tops.append((yield from climb_steps(problem, start, random, until(), (begun, budget))))
        if k in GROWN and not good(min(tops)):
            for top in sorted(tops)[:2]:
                tops.append((yield from grow_steps(problem, top, random, until(), (begun, budget))))
        tops.sort()
    lean = [top for top in tops if top.rows.shape[1] == problem.least]
    return tops[:1] if lean[0] is tops[0] else [tops[0], lean[0]]


def climb_steps(
    problem: Problem, start: Candidate, random: np.random.Generator, until: int, spent: tuple[int, int]
) -> Generator[float, None, Candidate]:
    """A candidate better than all its neighbours, unless the work is spent before; in steps."""
    best = start
    while True:
        near = neighbours(problem, best)
        order = random.permutation(len(near))
        for first in range(0, len(near), BATCH):
            if problem.work >= until:
                return best
            yield min(1.0, (problem.work - spent[0]) / spent[1])
            found = problem.best_of([near[k] for k in order[first : first + BATCH]], best)
            if found.score < best.score:
                best = found
                # The other moves start from where it led.
                break
        else:
            return best


def grow_steps(
    problem: Problem, start: Candidate, random: np.random.Generator, until: int, spent: tuple[int, int]
) -> Generator[float, None, Candidate]:
    """A better candidate by listing further pairs, each the one that helps most, and climbing on; in steps."""
    best = start
    for _ in range(MOST_ADDED):
        more = additions(problem, best)
        chosen = random.permutation(len(more))[:ADDITIONS]
        found = best
        for first in range(0, len(chosen), BATCH):
            if problem.work >= until:
                return found
            yield min(1.0, (problem.work - spent[0]) / spent[1])
            found = problem.best_of([more[k] for k in chosen[first : first + BATCH]], found)
        if not found.score < best.score:
            break
        best = yield from climb_steps(problem, found, random, until, spent)
        if good(best):
            break
    return best

"""Which pieces of each shape to pair: its maps, or some of them split, as orientation and number ask."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..affine import determinant, singular_values
from ..joining import Word, word_map
from ..morph import SINGULAR
from .constraints import locks_of
from .expansion import is_closed, split_all, split_to
from .pairs import Pair
from .problem import End, Problem
from .recurrent import problem_of

MOST_PROBLEMS = 4

MOST_WORDS = 64
"""Pieces of one end at most, where all its maps reflect and are all split for that."""


def problems(
    ends: Sequence[End], settled: Sequence[bool], locked: Sequence[Pair], tolerance: float, threads: int | None
) -> list[Problem]:
    """The searches to make, one after the other until one finds something good.

    Parameters
    ----------
    ends : (End, End)
        With the words to use as long as nothing speaks for others.
    settled : (bool, bool)
        Ends whose words are not to change.
    locked, tolerance, threads
        See `matcher.match`.
    """
    options: list[list[list[Word]]] = [[end.words] for end in ends]
    larger = max(len(end.words) for end in ends)
    for k in (0, 1):
        if settled[k]:
            continue
        ifs = ends[k].ifs
        every = split_all(ifs)
        if _has_to_be_split(ends[k], ends[1 - k]) and len(every) <= MOST_WORDS and is_closed(ifs, every):
            options[k].insert(0, every)
        for words in (split_to(ifs, larger), split_to(ifs, 2 * ifs.count - 1)):
            if words not in options[k]:
                options[k].append(words)
    # First what comes first at both ends; then the fewest.
    lists = [(first, last) for first in options[0] for last in options[1]]
    lists[1:] = sorted(lists[1:], key=lambda words: max(map(len, words)))
    found = []
    for words in lists[:MOST_PROBLEMS]:
        both = [End(end.ifs, end.symmetries, chosen) for end, chosen in zip(ends, words, strict=True)]
        found.append(problem_of(*both, tolerance, locks_of(locked, both), threads))
    return found


def _has_to_be_split(end: End, other: End) -> bool:
    """Whether all maps of an end reflect, not so the other end's, and no end has a mirroring to mend that.

    Parts of a map that reflects, within a shape whose maps all do, do not.
    """
    mirrored = any((determinant(each.symmetries[:, :, :-1]) < 0).any() for each in (end, other))
    return not mirrored and _reflecting(end) == {True} and _reflecting(other) != {True}


def _reflecting(end: End) -> set[bool]:
    """Whether the maps of an end reflect; flat ones are as the others need."""
    linear = np.array([word_map(end.ifs, word)[:, :-1] for word in end.words])
    values = singular_values(linear)
    flat = values[:, 1] <= SINGULAR * values[:, 0]
    return set((determinant(linear) < 0)[~flat].tolist())

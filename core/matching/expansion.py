"""Splitting and doubling: other lists of maps for the same attractor.

A map w_i may give way to its parts ``w_i o w_k`` for all k, and a map may be listed twice: neither changes the
attractor. A *word* (i, k, ...) names the composition ``w_i o w_k o ...``.
"""

from __future__ import annotations

import numpy as np

from ..affine import singular_values
from ..ifs import IFS
from ..joining import Word, word_map


def word_weight(ifs: IFS, word: Word) -> float:
    """The share of the measure that a word's piece holds."""
    return float(np.prod(ifs.weights[list(word)]))


def parts(ifs: IFS, word: Word) -> list[Word]:
    """The words that a word is split into: one for each letter that may follow its last one."""
    following = np.flatnonzero(ifs.follows[word[-1]]) if word else range(ifs.count)
    return [(*word, int(letter)) for letter in following]


def is_cover(ifs: IFS, words: list[Word]) -> bool:
    """Whether the words are all maps of a system, some of them split, some listed twice."""
    different = set(words)
    prefixes = {word[:length] for word in different for length in range(len(word))} | {()}
    return different | prefixes == {()}.union(*(parts(ifs, prefix) for prefix in prefixes)) and not prefixes & different


def uncovered(ifs: IFS, words: list[Word]) -> list[Word]:
    """Words that are missing among some, the fewest that have all of the rest."""
    different = set(words)
    prefixes = {word[:length] for word in different for length in range(len(word))} | {()}
    return sorted(set().union(*(parts(ifs, prefix) for prefix in prefixes)) - different - prefixes)


def is_closed(ifs: IFS, words: list[Word]) -> bool:
    """Whether each word may follow some word, as always in a plain IFS; else the words make up no recurrent IFS."""
    return bool(ifs.follows[np.ix_([word[-1] for word in words], [word[0] for word in words])].any(axis=0).all())


def split_to(ifs: IFS, count: int) -> list[Word]:
    """Words by splitting the largest piece again and again, while no more than `count` come of it."""
    words = [(i,) for i in range(ifs.count)]
    while True:
        # A word that only one letter may follow gains nothing.
        splits = [len(parts(ifs, word)) > 1 for word in words]
        norms = [singular_values(word_map(ifs, word)[:, :-1])[0] for word in words]
        sizes = [norm if split else 0.0 for norm, split in zip(norms, splits, strict=True)]
        # Sizes that differ by rounding alone are equal, and the first of them goes.
        largest = int(np.argmax(np.array(sizes) > max(sizes) * (1 - 1e-9)))
        split = parts(ifs, words[largest])
        longer = [*words[:largest], *split, *words[largest + 1 :]]
        if len(split) == 1 or len(longer) > count or not is_closed(ifs, longer):
            return words
        words = longer


def split_all(ifs: IFS) -> list[Word]:
    """The words of two letters: every map split."""
    return [word for i in range(ifs.count) for word in parts(ifs, (i,))]

"""Two recurrent IFSs written over one graph, so that a morph between them is continuous at its ends.

Between two shapes that allow different transitions a morph needs those of both. But to allow at once what an end
forbids would make the shape jump. So a letter that others may follow at one end than at the other becomes several, one
for each set of followers, and where an end forbids these, it has a *detour* there: a word that it allows from the one
to the others. A detour from i to k takes the attractorlet of k to a part of that of i: it adds nothing to the shape.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .affine import compose, transform
from .ifs import IFS

Word = tuple[int, ...]


def word_map(ifs: IFS, word: Word) -> np.ndarray:
    """The composition (2, 3), or (3, 4), of the maps that a word names, the last one applied first."""
    composed = ifs.maps[word[0]]
    for letter in word[1:]:
        composed = compose(composed, ifs.maps[letter])
    return composed


@dataclass(frozen=True)
class Part:
    """What a map is at both ends when only some maps follow it.

    Attributes
    ----------
    followers : (N,) bool
        The maps whose attractorlets it is applied to; follower k stands for all parts of map k.
    words : (tuple, tuple)
        At each end, the word to apply, the last letter first: (i,) the map itself, (i, j, ...) a detour, and nothing
        where there is none. Then the part grows from a point.
    """

    followers: np.ndarray
    words: tuple[Word, Word]


def over_one_graph(initial: IFS, final: IFS) -> tuple[IFS, IFS, np.ndarray]:
    """Both ends of a morph with the same transitions allowed, and their attractors and measures as they were.

    Parameters
    ----------
    initial, final : IFS
        With the same number N of maps.

    Returns
    -------
    initial, final : IFS
        As given if the same transitions are allowed at both. Else with M >= N maps: the first N are the given ones, or
        parts of them, the others are further parts. A detour has the weight 0.
    part_of : (M,) int
        The given map that each is a part of.
    """
    graphs = initial.follows, final.follows
    count = initial.count
    if np.array_equal(*graphs):
        return initial, final, np.arange(count)
    found = [_parts(i, graphs, (initial.linear, final.linear)) for i in range(count)]
    parts = [each[0] for each in found] + [part for each in found for part in each[1:]]
    part_of = np.append(np.arange(count), np.repeat(np.arange(count), [len(each) - 1 for each in found]))
    return _end(initial, 0, parts, part_of), _end(final, 1, parts, part_of), part_of


def _parts(i: int, graphs: tuple[np.ndarray, np.ndarray], linear: tuple[np.ndarray, np.ndarray]) -> list[Part]:
    """The parts of map i: what both ends allow, then what only the initial one does, then what only the final one."""
    rows = graphs[0][i], graphs[1][i]
    parts = [Part(rows[0] & rows[1], ((i,), (i,)))] if (rows[0] & rows[1]).any() else []
    for end in (0, 1):
        reflects = bool(np.linalg.det(linear[end][i]) < 0)
        only_here = rows[end] & ~rows[1 - end]
        for word, followers in _detours(i, only_here, graphs[1 - end], linear[1 - end], reflects):
            parts.append(Part(followers, ((i,), word) if end == 0 else (word, (i,))))
    return parts


def _detours(
    i: int, wanted: np.ndarray, follows: np.ndarray, linear: np.ndarray, reflects: bool
) -> list[tuple[Word, np.ndarray]]:
    """Words from i to all wanted letters (N,), and which of these may follow each; as few words as can be.

    Those first that reflect or not as they should; of these what most letters may follow, then the shortest, then the
    one of the largest area.
    """
    determinants = np.linalg.det(linear)
    # By what decides how they go on: their last letter, and whether they reflect.
    start = i, bool(determinants[i] < 0)
    words, newest = {start: (i,)}, {start: abs(determinants[i])}
    while newest:
        reached: dict[tuple[int, bool], tuple[float, Word]] = {}
        for (j, turned), area in newest.items():
            for k in np.flatnonzero(follows[j]).tolist():
                state, further = (k, turned != bool(determinants[k] < 0)), area * abs(determinants[k])
                if state not in words and (state not in reached or further > reached[state][0]):
                    reached[state] = further, (*words[j, turned], k)
        newest = {state: area for state, (area, _) in sorted(reached.items(), key=lambda each: -each[1][0])}
        words.update({state: reached[state][1] for state in newest})
    found, left = [], wanted.copy()
    while left.any():
        gains = {state: np.count_nonzero(follows[state[0]] & left) for state in words}
        # Words are in the order of their lengths, and of the areas.
        best = max(gains, key=lambda state: (gains[state] > 0, state[1] == reflects, gains[state]))
        if gains[best] == 0:
            found.append(((), left))
            break
        found.append((words[best], follows[best[0]] & left))
        left = left & ~follows[best[0]]
    return found


def _end(ifs: IFS, end: int, parts: list[Part], part_of: np.ndarray) -> IFS:
    """An IFS made of parts (M,) of its maps, with the same attractor and measure."""
    words = [part.words[end] for part in parts]
    maps = [word_map(ifs, word) if word else _point(ifs, i) for word, i in zip(words, part_of.tolist(), strict=True)]
    whole = np.array([len(word) == 1 for word in words])
    given = np.ones((ifs.count, ifs.count)) if ifs.transitions is None else ifs.transitions
    transitions = given[np.ix_(part_of, part_of)]
    transitions[:, ~whole] = 1.0
    transitions *= np.array([part.followers for part in parts])[:, part_of].T
    return IFS(np.array(maps), ifs.weights[part_of] * whole, ifs.name, transitions, ifs.opacity[part_of])


def _point(ifs: IFS, i: int) -> np.ndarray:
    """The map (2, 3) that takes everything to a point of attractorlet i; raises IFSError without an attractor."""
    ifs.require_attractor()
    word = [i]
    while (following := int(np.argmax(ifs.follows[word[-1]]))) not in word:
        word.append(following)
    cycle = word_map(ifs, word[word.index(following) :])
    point = np.linalg.solve(np.eye(2) - cycle[:, :2], cycle[:, 2])
    # Once more through the cycle it is the same.
    return np.column_stack([np.zeros((2, 2)), transform(word_map(ifs, word), point)])

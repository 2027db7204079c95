"""Two recurrent IFSs written over one graph, so that a morph between them is continuous at its ends.

Between two shapes that allow different transitions a morph needs those of both. But to allow at once what an end
forbids would make the shape jump. So a map that other maps follow at one end than at the other becomes several, one
for each set of followers, and what an end forbids is done there by a *detour*: a path through its graph that it
allows. A detour from i to j takes the attractorlet of j to a part of that of i, which adds nothing to the attractor.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .affine import compose
from .ifs import IFS

Path = tuple[int, ...]


@dataclass(frozen=True)
class Part:
    """What a map is at both ends when only some maps follow it.

    Attributes
    ----------
    followers : (N,) bool
        The maps whose attractorlets it is applied to; follower k stands for all parts of map k.
    paths : (tuple, tuple)
        At each end, the letters of the word to apply, outermost first: (i,) the map itself, (i, j, ...) a detour, and
        nothing where there is none. Then the part grows from a point.
    """

    followers: np.ndarray
    paths: tuple[Path, Path]


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
        for path, followers in _detours(i, only_here, graphs[1 - end], linear[1 - end], reflects):
            parts.append(Part(followers, ((i,), path) if end == 0 else (path, (i,))))
    return parts


def _detours(
    i: int, wanted: np.ndarray, follows: np.ndarray, linear: np.ndarray, reflects: bool
) -> list[tuple[Path, np.ndarray]]:
    """Paths through a graph from i to all wanted letters (N,), and which of them each leads to; as few as can be.

    Those first whose word reflects or not as it should; of these what leads to the most letters, then the shortest,
    then the one whose word has the largest area.
    """
    determinants = np.linalg.det(linear)
    # Paths by what decides where they can go on: their last letter, and whether they reflect.
    start = i, bool(determinants[i] < 0)
    paths, newest = {start: (i,)}, {start: abs(determinants[i])}
    while newest:
        reached: dict[tuple[int, bool], tuple[float, Path]] = {}
        for (j, turned), area in newest.items():
            for k in np.flatnonzero(follows[j]).tolist():
                state, further = (k, turned != bool(determinants[k] < 0)), area * abs(determinants[k])
                if state not in paths and (state not in reached or further > reached[state][0]):
                    reached[state] = further, (*paths[j, turned], k)
        newest = {state: area for state, (area, _) in sorted(reached.items(), key=lambda each: -each[1][0])}
        paths.update({state: reached[state][1] for state in newest})
    found, left = [], wanted.copy()
    while left.any():
        gains = {state: np.count_nonzero(follows[state[0]] & left) for state in paths}
        # Paths are in the order of their lengths, and of the areas.
        best = max(gains, key=lambda state: (gains[state] > 0, state[1] == reflects, gains[state]))
        if gains[best] == 0:
            found.append(((), left))
            break
        found.append((paths[best], follows[best[0]] & left))
        left = left & ~follows[best[0]]
    return found


def _end(ifs: IFS, end: int, parts: list[Part], part_of: np.ndarray) -> IFS:
    """An IFS made of parts (M,) of its maps, with the same attractor and measure."""
    paths = [part.paths[end] for part in parts]
    maps = [_word(ifs, path) if path else _point(ifs, i) for path, i in zip(paths, part_of.tolist(), strict=True)]
    whole = np.array([len(path) == 1 for path in paths])
    given = np.ones((ifs.count, ifs.count)) if ifs.transitions is None else ifs.transitions
    transitions = given[np.ix_(part_of, part_of)]
    transitions[:, ~whole] = 1.0
    transitions *= np.array([part.followers for part in parts])[:, part_of].T
    return IFS(np.array(maps), ifs.weights[part_of] * whole, ifs.name, transitions)


def _word(ifs: IFS, path: Path) -> np.ndarray:
    """The composition (2, 3) of the maps along a path."""
    composed = ifs.maps[path[0]]
    for letter in path[1:]:
        composed = compose(composed, ifs.maps[letter])
    return composed


def _point(ifs: IFS, i: int) -> np.ndarray:
    """The map (2, 3) that takes everything to a point of attractorlet i; raises IFSError without an attractor."""
    ifs.require_attractor()
    path = [i]
    while (following := int(np.argmax(ifs.follows[path[-1]]))) not in path:
        path.append(following)
    loop = path.index(following)
    cycle = _word(ifs, tuple(path[loop:]))
    point = np.linalg.solve(np.eye(2) - cycle[:, :2], cycle[:, 2])
    if loop > 0:
        point = compose(_word(ifs, tuple(path[:loop])), np.column_stack([np.zeros((2, 2)), point]))[:, 2]
    return np.column_stack([np.zeros((2, 2)), point])

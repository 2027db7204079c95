"""Slow and plain ways to know an attractor, which share no code with the source and check it."""

from itertools import combinations

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components, minimum_spanning_tree
from scipy.spatial import cKDTree


def children(words, maps):
    """Return every word (M, 2, 3) with every letter behind it (M * N, 2, 3)."""
    linear = words[:, None, :, :2] @ maps[None, :, :, :2]
    translation = words[:, None, :, :2] @ maps[None, :, :, 2:] + words[:, None, :, 2:]
    return np.concatenate([linear, translation], axis=-1).reshape(-1, 2, 3)


def norms(words):
    """Return the spectral norms (M,) of the linear parts L, roots of the larger eigenvalues of L^T L."""
    squares = (words[:, :, :2] ** 2).sum(axis=(1, 2))
    determinants = words[:, 0, 0] * words[:, 1, 1] - words[:, 0, 1] * words[:, 1, 0]
    return np.sqrt((squares + np.sqrt(np.maximum(squares**2 - 4 * determinants**2, 0))) / 2)


def cover(maps, limit, most=np.inf):
    """Return words (M, 2, 3) of norm at most `limit` that cover the attractor, and their first letters (M,).

    None if there would be more than `most` of them.
    """
    words, letters = np.asarray(maps, dtype=float), np.arange(len(maps))
    found, count = [], 0
    while len(words):
        short = norms(words) <= limit
        found.append((words[short], letters[short]))
        count += np.count_nonzero(short)
        letters = np.repeat(letters[~short], len(maps))
        if count + len(letters) > most:
            return None
        words = children(words[~short], maps)
    return tuple(np.concatenate(parts) for parts in zip(*found, strict=True))


def allowed_points(ifs, most=6000):
    """Return points (M, 2) by allowed words, one for each piece of the attractor, and the spacing.

    Every point of the attractor is within the spacing of one of these, and every one of these of the attractor. The
    spacing is about the finest that takes no more than `most` points.
    """
    transitions = np.ones((ifs.count, ifs.count)) if ifs.transitions is None else ifs.transitions
    start = fixed_point(ifs.maps[0])
    words, last, fine = ifs.maps, np.arange(ifs.count), None
    while True:
        sizes = norms(words)
        if (sizes < 1).all():
            # As in `dense`.
            reach = (np.linalg.norm(at(words, start) - start, axis=1) / (1 - sizes)).max()
            fine = at(words, start), sizes.max() * reach
        split = sizes > 0.7 * sizes.max()
        inner, outer = np.nonzero(transitions[:, last[split]])
        if fine is not None and (np.count_nonzero(~split) + len(inner) > most or sizes.max() < 1e-9):
            return fine
        longer = children(words[split], ifs.maps).reshape(-1, ifs.count, 2, 3)[outer, inner]
        words, last = np.concatenate([words[~split], longer]), np.concatenate([last[~split], inner])


def groups_within(points, apart):
    """Return how many groups of points there are, any two next to each other in a group no further apart than this."""
    pairs = cKDTree(points).query_pairs(apart, output_type="ndarray")
    links = coo_matrix((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), (len(points), len(points)))
    return connected_components(links, directed=False)[0]


def recurrent_in_pieces(ifs, tolerance, most=6000):
    """Whether there is for certain a gap wider than the tolerance anywhere in the attractor of a recurrent IFS."""
    points, spacing = allowed_points(ifs, most)
    diameter = np.hypot(*np.ptp(points, axis=0)) + 2 * spacing
    return groups_within(points, tolerance * diameter + 2 * spacing) > 1


def hausdorff(first, second):
    """Return the Hausdorff distance of two sets of points (M, 2)."""
    return max(cKDTree(first).query(second)[0].max(), cKDTree(second).query(first)[0].max())


def at(maps, points):
    """Return maps (..., 2, 3) applied to points (..., 2)."""
    return np.einsum("...ij,...j->...i", maps[..., :2], points) + maps[..., 2]


def fixed_point(word):
    """Return the fixed point (2,) of a map (2, 3)."""
    return np.linalg.solve(np.eye(2) - word[:, :2], word[:, 2])


def dense(maps, most=6000):
    """Return points (M, 2) on the attractor, their attractorlets (M,), and the spacing.

    Every point of the attractor is within the spacing of one of these in its own attractorlet. The spacing is the
    finest, by halving, that takes no more than `most` points.
    """
    maps = np.asarray(maps, dtype=float)
    start = fixed_point(maps[0])
    limit = 1 / 2
    while (found := cover(maps, limit, 40_000)) is None:
        limit = (1 + limit) / 2
    words, letters = found
    # One prefix of every address has this norm or less, so no point is farther from the start than this.
    reach = (np.linalg.norm(at(words, start) - start, axis=1) / (1 - norms(words))).max()
    while (finer := cover(maps, limit / 2, most)) is not None:
        words, letters = finer
        limit /= 2
        if limit < 1e-12:
            break
    return at(words, start), letters, limit * reach


def linkage(points, groups, count):
    """Return the longest edge of the minimum spanning tree over the distances of groups of points, by a KD-tree."""
    trees = [cKDTree(points[groups == i]) for i in range(count)]
    between = np.zeros((count, count))
    for i, j in combinations(range(count), 2):
        # One more, and taken off again: a distance of zero, or close to it, would read as no edge at all.
        between[i, j] = 1 + trees[i].query(trees[j].data)[0].min()
    return minimum_spanning_tree(between).data.max() - 1 if count > 1 else 0.0


def in_pieces(maps, tolerance, most=6000):
    """Whether there is for certain a gap wider than the tolerance, relative to the diameter of the points."""
    points, letters, spacing = dense(maps, most)
    diameter = np.hypot(*np.ptp(points, axis=0))
    return linkage(points, letters, len(maps)) - 2 * spacing > tolerance * diameter


def chaos_game(ifs, count, seed=0):
    """Return points (count, 2) of the attractor by the chaos game, in many short runs side by side."""
    random = np.random.default_rng(seed)
    points = np.tile(fixed_point(ifs.maps[0]), (count, 1))
    for _ in range(40):
        points = at(ifs.maps[random.integers(ifs.count, size=count)], points)
    return points


def largest_spectral_radius(linear, letters=6):
    """Return the largest spectral radius of a word of up to `letters` letters, to the power 1 / its length."""
    words, best = np.eye(2)[None], 0.0
    for length in range(1, letters + 1):
        words = (words[:, None] @ linear[None]).reshape(-1, 2, 2)
        best = max(best, np.abs(np.linalg.eigvals(words)).max() ** (1 / length))
    return best

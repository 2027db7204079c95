"""Slow and plain ways to know an attractor in space, which share no code with the source and check it."""

import numpy as np
from scipy.sparse.csgraph import minimum_spanning_tree
from scipy.spatial import cKDTree

from core.space.ifs import SpaceIFS

CORNERS = np.array([[0, 0, 0], [1, 0, 0], [1 / 2, 3**0.5 / 2, 0], [1 / 2, 3**0.5 / 6, (2 / 3) ** 0.5]])
"""Of a tetrahedron with edges of length 1."""


def similarities(scale, points):
    """Return the IFS of maps that shrink space towards points."""
    linear = np.tile(scale * np.eye(3), (len(points), 1, 1))
    return SpaceIFS(np.concatenate([linear, (1 - scale) * np.asarray(points, dtype=float)[:, :, None]], axis=-1))


def tetrahedron(scale):
    """Return Sierpinski's tetrahedron with maps of another scale; it touches itself at one half."""
    return similarities(scale, CORNERS)


def random_ifs(seed, count=3, low=0.1, high=0.75, similar=0.0):
    """Return an IFS of maps that turn and shear, the less the more similar."""
    random = np.random.default_rng(seed)
    linear = random.normal(size=(count, 3, 3))
    linear = (1 - similar) * linear + similar * np.linalg.qr(linear)[0]
    linear *= (random.uniform(low, high, count) / np.linalg.norm(linear, 2, axis=(1, 2)))[:, None, None]
    return SpaceIFS(np.concatenate([linear, random.normal(size=(count, 3, 1))], axis=-1))


def in_space(ifs):
    """Return an IFS of the plane as one in space: on the floor, each map as high as it is long."""
    maps = np.zeros((ifs.count, 3, 4))
    maps[:, :2, :2], maps[:, :2, 3] = ifs.linear, ifs.translation
    maps[:, 2, 2] = np.sqrt(np.abs(np.linalg.det(ifs.linear)))
    return SpaceIFS(maps, ifs.weights)


def dense(maps, most=20_000):
    """Return points (M, 3) on the attractor, their attractorlets (M,), and how far from them it can have others."""
    start = np.linalg.solve(np.eye(3) - maps[0, :, :3], maps[0, :, 3])
    words, letters, found = maps, np.arange(len(maps)), None
    limit = 1.0
    while True:
        limit *= 0.7
        kept, kept_letters = [], []
        words, letters = maps, np.arange(len(maps))
        while len(words):
            short = np.linalg.norm(words[:, :, :3], 2, axis=(1, 2)) <= limit
            kept.append(words[short])
            kept_letters.append(letters[short])
            words, letters = words[~short], letters[~short]
            if sum(map(len, kept)) + len(words) * len(maps) > most:
                break
            linear = words[:, None, :, :3] @ maps[None, :, :, :3]
            translation = words[:, None, :, :3] @ maps[None, :, :, 3:] + words[:, None, :, 3:]
            words = np.concatenate([linear, translation], axis=-1).reshape(-1, 3, 4)
            letters = np.repeat(letters, len(maps))
        if len(words):
            return found
        words, letters = np.concatenate(kept), np.concatenate(kept_letters)
        norms = np.linalg.norm(words[:, :, :3], 2, axis=(1, 2))
        points = words[:, :, :3] @ start + words[:, :, 3]
        # The attractor is no farther from the start than this.
        reach = (np.linalg.norm(points - start, axis=1) / (1 - norms)).max()
        found = points, letters, limit * reach


def longest_edge(points, letters, count):
    """Return the longest edge of the minimum spanning tree over the distances of groups of points."""
    trees = [cKDTree(points[letters == i]) for i in range(count)]
    between = np.zeros((count, count))
    for i in range(count):
        for j in range(i + 1, count):
            between[i, j] = 1 + trees[i].query(trees[j].data)[0].min()
    return minimum_spanning_tree(between).data.max() - 1


def in_pieces(maps, tolerance, most=20_000):
    """Whether there is for certain a gap wider than the tolerance, relative to the diameter of the points."""
    points, letters, spacing = dense(maps, most)
    diameter = np.linalg.norm(np.ptp(points, axis=0))
    return longest_edge(points, letters, len(maps)) - 2 * spacing > tolerance * diameter

"""Random IFSs, and their words as the kernels hold them."""

import numpy as np

from core.ifs import IFS
from core.tree import children, empty_tree, plant


def random_ifs(seed, count=3, low=0.1, high=0.75):
    random = np.random.default_rng(seed)
    linear = random.normal(size=(count, 2, 2))
    linear *= (random.uniform(low, high, count) / np.linalg.norm(linear, 2, axis=(1, 2)))[:, None, None]
    return IFS(np.concatenate([linear, random.normal(size=(count, 2, 1))], axis=-1))


def unit_maps(ifs):
    """Rows of the linear parts, and the translations that put the enclosing disc at the origin with radius 1."""
    center, radius = ifs.enclosing_disc
    linear = np.ascontiguousarray(ifs.linear).reshape(-1, 4)
    return linear, (ifs.translation + ifs.linear @ center - center) / radius


def grown(linear, unit, words, drift=None):
    """Return a tree that holds some words, given by their letters, and the places of these."""
    tree = empty_tree(1000)
    plant(tree, linear, np.ascontiguousarray(unit), np.zeros_like(unit) if drift is None else drift)
    follows = np.ones((len(linear), len(linear)), dtype=bool)
    places = []
    for first, *others in words:
        place = first
        for letter in others:
            place = children(tree, follows, place)[0] + letter
        places.append(place)
    return tree, places

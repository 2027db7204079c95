"""Slow and plain pictures, which share no code with the renderers and check them."""

import random

import numpy as np
from scipy.spatial import cKDTree

from tests.core.reference import at, children, fixed_point, norms


def shifted(window, size):
    """Return a window moved by an odd part of a pixel, so that no border of a shape falls on one of a pixel."""
    pixel = (np.array(window[2:]) - window[:2]) / size
    shift = pixel * [0.3141, 0.2718]
    return (*(np.array(window[:2]) + shift).tolist(), *(np.array(window[2:]) + shift).tolist())


def to_pixels(points, size, window):
    """Return points (P, 2) of the plane in pixels."""
    return (points - window[:2]) * (size / (np.array(window[2:]) - window[:2]))


def subdivision(ifs, size, window, fineness, first=None):
    """Return points (P, 2) of the attractor in pixels, one in each piece of a diameter below `fineness` pixels.

    Takes all words, a letter at a time, and leaves out those outside the window. Each point is the image of the fixed
    point of the first map. Only those of one attractorlet if its number is given.
    """
    scale = size / (np.array(window[2:]) - window[:2])
    center, radius = ifs.enclosing_disc
    seed = fixed_point(ifs.maps[0])
    words = ifs.maps if first is None else ifs.maps[first : first + 1]
    found = []
    while len(words):
        reach = norms(words) * radius * scale.max()
        middle = to_pixels(at(words, center), size, window)
        shown = ((middle + reach[:, None] >= 0) & (middle - reach[:, None] <= size)).all(axis=1)
        done = 2 * reach <= fineness
        found.append(to_pixels(at(words[shown & done], seed), size, window))
        words = children(words[shown & ~done], ifs.maps)
    return np.concatenate(found)


def pixels(points, size):
    """Return booleans (H, W): which pixels hold one of the points (P, 2) in pixels."""
    picture = np.zeros((size[1], size[0]), bool)
    places = np.floor(points).astype(int)
    places = places[((places >= 0) & (places < size)).all(axis=1)]
    picture[places[:, 1], places[:, 0]] = True
    return picture


def coverage(picture, reference):
    """Return the share of the pixels of the reference that the picture has."""
    return np.count_nonzero(picture & reference) / np.count_nonzero(reference)


def farthest(picture, points):
    """Return how far a set pixel is from the nearest point, in pixels; at least, where in the pixel is not known."""
    rows, columns = np.nonzero(picture)
    distances, _ = cKDTree(points).query(np.stack([columns, rows], axis=1) + 0.5)
    return distances.max(initial=0) - 0.5**0.5


def chaos_game(ifs, count, seed=1):
    """Return points (count, 2) of the chaos game, as one writes it down first."""
    chance = random.Random(seed)
    maps = [tuple(entries) for entries in ifs.maps.reshape(-1, 6).tolist()]
    x, y = fixed_point(ifs.maps[0]).tolist()
    points = []
    for a, b, e, c, d, f in chance.choices(maps, ifs.weights.tolist(), k=count):
        x, y = a * x + b * y + e, c * x + d * y + f
        points.append((x, y))
    return np.array(points)

"""Sets of points: that they lie on the attractor, reach as far as it does, leave no gap and hold all its mass."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.spatial import cKDTree

from core.grammar import free_grammar
from core.pieces import INSET, SIZES_PER_OCTAVE, hull_points, measures, outlines
from core.shapes import SHAPES
from core.words import unit_maps
from tests.core.reference import dense

MEASURED = np.zeros(0)
NAMES = ["gasket", "terdragon", "Lévy curve", "Barnsley fern", "Barnsley tree", "maple leaf"]
SMALLEST, LARGEST, CELL, RATIO = 0.5, 16.0, 0.5, 8.0


def unit(name):
    """Return the maps of a shape in the coordinates of its disc, and dense points of it there with their spacing."""
    maps, center, radius = unit_maps(SHAPES[name], 1e-9)
    points, _, spacing = dense(SHAPES[name].maps, most=30_000)
    return maps, (points - center) / radius, spacing / radius


def members(sets, k):
    """Return the points (P, 2) of set k."""
    part = slice(sets.start[k], sets.start[k + 1])
    return np.stack([sets.x[part], sets.y[part]], axis=1)


@pytest.mark.parametrize("name", NAMES)
def test_outlines_lie_on_the_attractor_and_miss_none_of_it(name):
    maps, points, spacing = unit(name)
    sets = outlines(maps, MEASURED, free_grammar(np.ones(len(maps))), CELL, SMALLEST, LARGEST, RATIO)
    for k in range(len(sets.start) - 1):
        # In units of the disc, which set k takes to be of so many pixels.
        pixel = 2 / (SMALLEST * 2 ** (k / SIZES_PER_OCTAVE))
        outline = members(sets, k)
        distances, _ = cKDTree(points).query(outline)
        assert distances.max() <= spacing + 2 * INSET
        gaps, _ = cKDTree(outline).query(points)
        # No farther than a cell's diagonal, and as much for each of the sets that a set is made of, which add up to 2.
        assert gaps.max() <= (2 * np.sqrt(2) * CELL + 1.2 * SMALLEST) * pixel


@pytest.mark.parametrize("name", NAMES)
def test_outlines_reach_as_far_as_the_attractor(name):
    maps, points, spacing = unit(name)
    sets = outlines(maps, MEASURED, free_grammar(np.ones(len(maps))), CELL, SMALLEST, LARGEST, RATIO)
    outline = members(sets, len(sets.start) - 2)
    pixel = 2 / LARGEST
    for angle in np.linspace(0, 2 * np.pi, 12, endpoint=False):
        direction = np.array([np.cos(angle), np.sin(angle)])
        assert abs((points @ direction).max() - (outline @ direction).max()) <= spacing + 0.15 * pixel


@pytest.mark.parametrize("name", NAMES)
def test_hull_points_reach_as_far_as_the_attractor(name):
    maps, points, spacing = unit(name)
    hull = hull_points(maps, free_grammar(np.ones(len(maps))), points[:1])[0, :, :2]
    assert cKDTree(points).query(hull)[0].max() <= spacing
    for k in range(8):
        direction = np.array([np.cos(k * np.pi / 4), np.sin(k * np.pi / 4)])
        assert (hull @ direction).max() >= (points @ direction).max() - spacing - 0.03


@pytest.mark.parametrize("name", NAMES)
def test_measures_have_the_mass_and_the_center_of_the_attractor(name):
    ifs = SHAPES[name]
    maps, _, _ = unit_maps(ifs, 1e-9)
    sets = measures(maps, MEASURED, free_grammar(ifs.weights), 0.25, 0.25, LARGEST, RATIO)
    # The moments of the invariant measure: m = sum of p_i w_i(m), by iteration.
    center = np.zeros(2)
    for _ in range(2000):
        center = ifs.weights @ (maps.reshape(-1, 2, 3) @ [*center, 1.0])
    for k, (begin, end) in enumerate(pairwise(sets.start)):
        masses = sets.masses[begin:end]
        assert masses.sum() == pytest.approx(1, abs=1e-9)
        assert masses @ members(sets, k) == pytest.approx(center, abs=1e-6)


def test_measures_hold_one_point_a_cell():
    maps, _, _ = unit_maps(SHAPES["maple leaf"], 1e-9)
    sets = measures(maps, MEASURED, free_grammar(SHAPES["maple leaf"].weights), 0.25, 0.25, LARGEST, RATIO)
    points = members(sets, len(sets.start) - 2)
    cells = np.floor((points + 1) / 2 * (LARGEST / 0.25)).astype(int)
    assert len(np.unique(cells, axis=0)) == len(points)


def test_a_word_gets_the_set_that_is_nearest_in_size():
    maps, _, _ = unit_maps(SHAPES["gasket"], 1e-9)
    sets = outlines(maps, MEASURED, free_grammar(np.ones(len(maps))), CELL, SMALLEST, LARGEST, RATIO)
    words = np.zeros((6, 10))
    words[:, 6] = [0.0, 0.5, 0.59, 0.6, 4.0, 1000.0]
    assert sets.nearest(words).tolist() == [0, 0, 0, 1, 6, len(sets.start) - 2]

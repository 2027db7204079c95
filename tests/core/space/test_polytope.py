"""The outer polytope holds the attractor, and pieces that it parts are apart."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from core.space.overlap import surely_apart
from core.space.polytope import DIRECTIONS, MIDDLE, corner, shrink_polytope
from core.space.tree import View, empty_tree, plant

from .reference import dense, random_ifs

SEEDS = st.integers(0, 10**6)
VECTORS = np.array([(x, y, z) for x in (-1, 0, 1) for y in (-1, 0, 1) for z in (-1, 0, 1)], dtype=float)


def polytope_of(ifs):
    """Return the reaches about the centre of the enclosing ball."""
    center, radius = ifs.enclosing_ball
    linear = np.ascontiguousarray(ifs.linear).reshape(-1, 9)
    reaches = np.empty(DIRECTIONS)
    shift = ifs.translation + ifs.linear @ center - center
    shrink_polytope(linear, shift, radius, 1e-12 * radius, 1e-3 * radius, reaches)
    return reaches


@settings(max_examples=12)
@given(SEEDS)
def test_no_point_of_the_attractor_is_beyond(seed):
    ifs = random_ifs(seed, 3)
    points, _, _ = dense(ifs.maps, 2000)
    reaches, points = polytope_of(ifs), points - ifs.enclosing_ball[0]
    for k in range(DIRECTIONS):
        if k != MIDDLE:
            assert (points @ VECTORS[k]).max() <= reaches[k] + 1e-9


@settings(max_examples=12)
@given(SEEDS)
def test_a_corner_lies_as_far_as_anything_can(seed):
    random = np.random.default_rng(seed)
    reaches = np.linalg.norm(VECTORS, axis=1) * random.uniform(0.9, 1.0)
    # Points within what the reaches allow.
    points = random.normal(size=(4000, 3))
    points *= random.uniform(0, 1.2, (4000, 1)) / np.linalg.norm(points, axis=1, keepdims=True)
    points = points[(points @ VECTORS.T <= reaches + 1e-12).all(axis=1)]
    for direction in random.normal(size=(20, 3)):
        assert (points @ direction).max() <= direction @ np.array(corner(reaches, *direction)) + 1e-9


def test_it_is_close_to_a_thin_attractor():
    ifs = random_ifs(0, 3)
    flat = ifs.maps.copy()
    flat[:, 2] *= 0.01
    low, high = np.array(type(ifs)(flat).bounds).reshape(2, 3)
    reaches, center = polytope_of(type(ifs)(flat)), type(ifs)(flat).enclosing_ball[0]
    assert reaches[MIDDLE + 1] == pytest.approx(high[2] - center[2], abs=0.02)
    assert reaches[MIDDLE - 1] == pytest.approx(center[2] - low[2], abs=0.02)


@settings(max_examples=12)
@given(SEEDS)
def test_pieces_said_to_be_apart_are(seed):
    ifs = random_ifs(seed, 4, 0.2, 0.6)
    center, radius = ifs.enclosing_ball
    tree = empty_tree(100)
    plant(
        tree, np.ascontiguousarray(ifs.linear).reshape(-1, 9), np.ascontiguousarray(ifs.translation), np.zeros((4, 3))
    )
    view = View(*center, 0.0, radius, 1e-12 * radius)
    points, letters, _ = dense(ifs.maps, 3000)
    for i in range(4):
        for j in range(i):
            if surely_apart(tree, view, i, j, polytope_of(ifs), 6):
                assert cKDTree(points[letters == i]).query(points[letters == j])[0].min() > 0

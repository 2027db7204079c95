"""Symmetries: all of them, and nothing else; through them the attractor stays the same."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from core.affine import compose, determinant, invert, rotation
from core.ifs import IFS
from core.matching.symmetry import symmetries
from core.shapes import SHAPES
from tests.core.reference import at, dense

KNOWN = {
    "gasket": (3, 3),
    "turned gasket": (1, 0),
    "gasket relative": (1, 1),
    "pentigasket": (5, 5),
    "hexagasket": (6, 6),
    "square": (4, 4),
    "Koch curve": (1, 1),
    "Koch snowflake": (6, 6),
    "Lévy curve": (1, 1),
    "Heighway dragon": (1, 0),
    "twindragon": (2, 0),
    "terdragon": (2, 0),
    "Gosper flowsnake": (6, 0),
    "Rauzy fractal": (2, 0),
    "Barnsley tree": (1, 1),
    "Barnsley fern": (1, 0),
}
"""Turns, the identity among them, and mirrorings."""


@pytest.mark.parametrize("name", KNOWN)
def test_turns_and_mirrorings_are_counted(name):
    found = symmetries(SHAPES[name])
    reflects = determinant(found[:, :, :2]) < 0
    assert (np.count_nonzero(~reflects), np.count_nonzero(reflects)) == KNOWN[name]
    assert np.array_equal(found[0], [[1, 0, 0], [0, 1, 0]])


@pytest.mark.parametrize("name", SHAPES)
def test_a_symmetry_keeps_the_attractor(name):
    points, _, spacing = dense(SHAPES[name].maps)
    tree = cKDTree(points)
    for symmetry in symmetries(SHAPES[name]):
        assert tree.query(at(symmetry, points))[0].max() <= 2 * spacing
        assert np.allclose(symmetry[:, :2] @ symmetry[:, :2].T, np.eye(2), atol=1e-12)


@given(st.floats(0, 6), st.floats(0.2, 5), st.floats(-20, 20), st.booleans(), st.sampled_from(["gasket", "terdragon"]))
def test_they_follow_a_shape_that_is_moved(angle, scale, away, reflects, name):
    frame = np.concatenate([scale * rotation(angle, reflects), [[away], [-away]]], axis=1)
    moved = IFS(compose(compose(frame, SHAPES[name].maps), invert(frame)))
    back = compose(compose(invert(frame), symmetries(moved)), frame)
    expected = symmetries(SHAPES[name])
    assert len(back) == len(expected)
    for symmetry in back:
        assert np.abs(expected - symmetry).max(axis=(1, 2)).min() < 1e-6


@pytest.mark.parametrize(
    "maps",
    [
        [[[0.5, 0, 0], [0, 0.5, 0]]],
        [[[0.5, 0, 1], [0, 0.5, 1]]] * 3,
        [[[0, 0, 0], [0, 0, 0]], [[0, 0, 1], [0, 0, 1]]],
        [[[0.5, 0, 0], [0, 0, 0]], [[0.5, 0, 1], [0, 0, 0]]],
    ],
    ids=["one map", "one map three times", "two points", "a line"],
)
def test_degenerate_shapes_have_at_least_the_identity(maps):
    found = symmetries(IFS(maps))
    assert np.array_equal(found[0], [[1, 0, 0], [0, 1, 0]])
    assert np.isfinite(found).all()


def test_a_shape_that_is_nearly_symmetric_is_not():
    maps = SHAPES["square"].maps.copy()
    maps[0, 0, 2] += 1e-3
    assert len(symmetries(IFS(maps))) == 1

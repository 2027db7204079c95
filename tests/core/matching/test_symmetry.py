"""Symmetries: all of them, and nothing else; through them the attractor stays the same."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from core.affine import compose, determinant, invert, rotation
from core.ifs import IFS
from core.matching.symmetry import symmetries
from core.shapes import SHAPES
from core.space.ifs import SpaceIFS
from core.space.lifting import lift
from core.space.shapes import SPACE_SHAPES
from tests.core.reference import dense
from tests.core.space.reference import dense as dense_in_space

ALL = SHAPES | SPACE_SHAPES

KNOWN = {
    "Sierpinski tetrahedron": (12, 12),
    "turned tetrahedron": (12, 12),
    "pyramid": (4, 4),
    "cross in space": (24, 24),
    "fern in space": (1, 1),
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
    found = symmetries(ALL[name])
    reflects = determinant(found[:, :, :-1]) < 0
    assert (np.count_nonzero(~reflects), np.count_nonzero(reflects)) == KNOWN[name]
    assert np.array_equal(found[0], np.eye(*found.shape[1:]))


@pytest.mark.parametrize("name", KNOWN)
def test_single_precision_is_enough(name):
    rough = symmetries(type(ALL[name])(ALL[name].maps.astype(np.float32)))
    exact = symmetries(ALL[name])
    assert len(rough) == len(exact)
    assert np.abs(rough[:, None] - exact[None]).max(axis=(2, 3)).min(axis=1).max() < 1e-5


@pytest.mark.parametrize("name", ALL)
def test_a_symmetry_keeps_the_attractor(name):
    points, _, spacing = (dense if name in SHAPES else dense_in_space)(ALL[name].maps)
    tree = cKDTree(points)
    for symmetry in symmetries(ALL[name]):
        orthogonal = symmetry[:, :-1]
        assert tree.query(points @ orthogonal.T + symmetry[:, -1])[0].max() <= 2 * spacing
        assert np.allclose(orthogonal @ orthogonal.T, np.eye(len(orthogonal)), atol=1e-12)


@pytest.mark.parametrize("name", ["Sierpinski tetrahedron", "pyramid", "cross in space"])
def test_symmetries_in_space_are_a_group(name):
    found = symmetries(ALL[name])
    for one in found:
        for other in found[::5]:
            assert np.abs(found - compose(one, other)).max(axis=(1, 2)).min() < 1e-9


@pytest.mark.parametrize("name", ["gasket", "terdragon", "Barnsley fern"])
def test_on_the_floor_there_is_one_mirroring_more(name):
    assert len(symmetries(lift(SHAPES[name]))) == 2 * len(symmetries(SHAPES[name]))


@settings(max_examples=8)
@given(st.integers(0, 10**6), st.floats(0.2, 5), st.sampled_from(["pyramid", "Sierpinski tetrahedron"]))
def test_they_follow_a_shape_that_is_moved_in_space(seed, scale, name):
    random = np.random.default_rng(seed)
    frame = np.column_stack([scale * np.linalg.qr(random.normal(size=(3, 3)))[0], random.normal(size=3)])
    moved = SpaceIFS(compose(compose(frame, SPACE_SHAPES[name].maps), invert(frame)))
    back = compose(compose(invert(frame), symmetries(moved)), frame)
    expected = symmetries(SPACE_SHAPES[name])
    assert len(back) == len(expected)
    for symmetry in back:
        assert np.abs(expected - symmetry).max(axis=(1, 2)).min() < 1e-6


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


def test_a_line_in_space_is_left_alone():
    maps = [[[0.5, 0, 0, x], [0, 0.5, 0, x], [0, 0, 0.5, x]] for x in (0, 1)]
    assert len(symmetries(SpaceIFS(maps))) == 1


def test_a_shape_in_space_that_is_nearly_symmetric_is_not():
    maps = SPACE_SHAPES["cross in space"].maps.copy()
    maps[0, :, 3] += 1e-3, 2e-3, 4e-3
    assert len(symmetries(SpaceIFS(maps))) == 1

import numpy as np
import pytest

from core.cloud import point_cloud
from core.ifs import IFS, IFSError
from core.morph import Morph
from core.shapes import SHAPES
from core.space.lifting import lift, morph_between
from core.space.morph import SpaceMorph

from .reference import tetrahedron

MIRRORED = IFS(SHAPES["gasket"].maps * np.array([[[1, -1, 1]], [[1, 1, 1]], [[1, 1, 1]]]), name="mirrored")


@pytest.mark.parametrize("name", ["gasket", "Koch snowflake", "Barnsley fern", "Lévy curve"])
def test_a_lifted_shape_is_flat_and_the_same(name):
    lifted = lift(SHAPES[name])
    points = point_cloud(lifted, 2000)
    assert (points.position[:, 2] == 0).all()
    assert points.position[:, :2] == pytest.approx(point_cloud(SHAPES[name], 2000).position, abs=1e-4)
    assert (np.linalg.det(lifted.linear) >= 0).all()
    assert lifted.norms == pytest.approx(SHAPES[name].norms)


def test_a_lifted_shape_hides_what_the_shape_does():
    assert lift(IFS(SHAPES["gasket"].maps, opacity=[0, 1, 0.5])).opacity.tolist() == [0, 1, 0.5]


def test_a_flip_turns_over_through_space():
    morph = morph_between(MIRRORED, SHAPES["gasket"], flip="turned")
    assert isinstance(morph, SpaceMorph)
    assert morph.flips == ()
    assert np.abs(morph.turning) == pytest.approx([np.pi, 0, 0])
    assert morph.axis[0, 2] == pytest.approx(0, abs=1e-12)
    for u in np.linspace(0, 1, 11):
        # Never flat, and of one size all the way.
        assert np.linalg.svd(morph.linear(u)[0], compute_uv=False) == pytest.approx([0.5, 0.5, 0.5])
    heights = [np.ptp(point_cloud(morph.at(u, u), 3000).position[:, 2]) for u in (0, 0.5, 1)]
    assert heights[0] == pytest.approx(0, abs=1e-6)
    assert heights[2] == pytest.approx(0, abs=1e-6)
    assert heights[1] > 0.3


def test_only_what_flips_leaves_the_plane():
    assert type(morph_between(MIRRORED, SHAPES["gasket"])) is Morph
    assert type(morph_between(SHAPES["turned gasket"], SHAPES["gasket"], flip="turned")) is Morph


def test_a_shape_of_the_plane_becomes_one_of_space():
    four = IFS(np.concatenate([SHAPES["gasket"].maps, SHAPES["gasket"].maps[:1]]))
    morph = morph_between(four, tetrahedron(0.5))
    assert morph.at(0, 0).maps[:, :2, [0, 1, 3]] == pytest.approx(four.maps)
    assert morph.at(1, 1).maps == pytest.approx(tetrahedron(0.5).maps)


def test_an_unknown_flip_is_named():
    with pytest.raises(IFSError, match="no flip “thrown”"):
        morph_between(MIRRORED, MIRRORED, flip="thrown")

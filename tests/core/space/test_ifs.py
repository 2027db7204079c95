import numpy as np
import pytest

from core.ifs import IFSError
from core.space.ifs import SpaceIFS

from .reference import CORNERS, dense, random_ifs, similarities, tetrahedron


def test_weights_are_the_volumes():
    maps = np.concatenate([tetrahedron(0.5).maps[:1], tetrahedron(0.25).maps[1:]])
    ifs = SpaceIFS(maps)
    assert ifs.weights == pytest.approx(np.array([8, 1, 1, 1]) / 11)
    assert ifs.norms == pytest.approx([0.5, 0.25, 0.25, 0.25])
    assert ifs.fixed_points == pytest.approx(CORNERS)
    assert (ifs.count, ifs.linear.shape, ifs.translation.shape) == (4, (4, 3, 3), (4, 3))


def test_maps_of_the_plane_are_refused():
    with pytest.raises(IFSError, match=r"shape \(3, 2, 3\)"):
        SpaceIFS(np.zeros((3, 2, 3)))


def test_transitions_are_refused():
    with pytest.raises(IFSError, match="no transitions"):
        SpaceIFS(tetrahedron(0.5).maps, transitions=np.ones((4, 4)))


def test_without_an_attractor_the_map_is_named():
    maps = tetrahedron(0.5).maps.copy()
    maps[2, :, :3] *= 2.5
    with pytest.raises(IFSError, match="map 3 does not contract"):
        SpaceIFS(maps).require_attractor()


@pytest.mark.parametrize("seed", range(8))
def test_bounds_hold_the_attractor_and_are_close(seed):
    ifs = random_ifs(seed, count=2 + seed % 3)
    points, _, spacing = dense(ifs.maps)
    least, most = np.split(np.array(ifs.bounds), 2)
    assert (least <= points.min(axis=0)).all()
    assert (points.max(axis=0) <= most).all()
    assert (points.min(axis=0) - least < spacing + 1e-3).all()
    assert (most - points.max(axis=0) < spacing + 1e-3).all()


def test_bounds_of_flat_sides_are_close_too():
    cube = similarities(1 / 2, [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)])
    assert cube.bounds == pytest.approx((0, 0, 0, 1, 1, 1), abs=1e-3)

"""Points in space: where the plane's are for shapes on the floor, and on the attractor for all others."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from core.cloud import point_cloud
from core.shapes import SHAPES
from core.space.ifs import SpaceIFS
from core.space.morph import SpaceMorph

from .reference import dense, in_space, random_ifs, tetrahedron


@pytest.mark.parametrize("name", ["gasket", "terdragon", "Barnsley fern"])
@pytest.mark.parametrize("count", [0, 1, 37, 5000])
def test_points_of_a_shape_on_the_floor_are_those_of_the_plane(name, count):
    plane, space = point_cloud(SHAPES[name], count), point_cloud(in_space(SHAPES[name]), count)
    assert space.position.shape == (count, 3)
    assert (space.position[:, 2] == 0).all()
    assert np.abs(space.position[:, :2] - plane.position).max(initial=0) < 1e-4
    assert (space.attractorlet == plane.attractorlet).all()


@pytest.mark.parametrize("seed", range(5))
def test_points_lie_on_the_attractor_and_all_over_it(seed):
    ifs = random_ifs(seed, 4, 0.4, 0.7, 0.9)
    points = point_cloud(ifs, 20_000)
    expected, letters, spacing = dense(ifs.maps)
    tree = cKDTree(expected)
    assert tree.query(points.position)[0].max() <= spacing + 1e-5
    own = [points.position[points.attractorlet == k] for k in range(4)]
    for k in range(4):
        away = cKDTree(own[k]).query(expected[letters == k])[0]
        assert np.quantile(away, 0.9) < 0.1 * ifs.enclosing_ball[1]


def test_addresses_stay_while_the_maps_move():
    morph = SpaceMorph(tetrahedron(0.5), SpaceIFS(tetrahedron(0.4).maps))
    weights = morph.weights_at(0.5)
    before, after = (point_cloud(morph.at(u, u), 3000, weights) for u in (0.5, 0.501))
    assert (before.attractorlet == after.attractorlet).all()
    assert np.abs(before.position - after.position).max() < 0.002


def test_threads_do_not_change_a_byte():
    ifs = random_ifs(7, 5)
    one, two = (point_cloud(ifs, 500_000, threads=threads) for threads in (1, 2))
    for name in ("position", "attractorlet", "radius"):
        assert getattr(one, name).tobytes() == getattr(two, name).tobytes()


def test_points_are_placed_with_their_radii():
    ifs = tetrahedron(0.5)
    plain, placed = point_cloud(ifs, 1000), point_cloud(ifs, 1000, placing=(1.0, 2.0, 3.0, 4.0))
    assert placed.position == pytest.approx((plain.position - (1, 2, 3)) / 4, abs=1e-6)
    assert placed.radius == pytest.approx(plain.radius / 4)
    assert 0 < plain.radius.min() <= plain.radius.max() < 0.2

"""Points with fixed addresses, against addresses decoded one by one in exact fractions."""

from fractions import Fraction
from math import ceil

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from core.cloud import FEW, RADIUS_RANGE, point_cloud
from core.ifs import IFS, IFSError
from core.morph import Morph
from core.shapes import SHAPES
from tests.core.reference import at, dense, fixed_point

ALMOST_ALL = IFS([[[0.5, 0, 0], [0, 0.5, 0]], [[0.5, 0, 0.5], [0, 0.5, 0]]], weights=[1 - 1e-9, 1e-9])


def decoded(k, count, weights, most):
    """Return the letters of point k of the shortest word with `most` points or less, its first point and how many."""
    weights = [Fraction(float(weight)) for weight in weights]
    total = sum(weights)
    low, high, letters = Fraction(0), Fraction(count), []
    number = k + Fraction(1, 2)
    first, last = 0, count
    while not letters or last - first > most:
        left = low
        for i, weight in enumerate(weights):
            right = left + (high - low) * weight / total if i + 1 < len(weights) else high
            if left <= number < right:
                low, high = left, right
                letters.append(i)
                break
            left = right
        first, last = ceil(low - Fraction(1, 2)), ceil(high - Fraction(1, 2))
    return letters, first, last - first


@pytest.mark.parametrize("count", [1, 2, 37, 1000])
@pytest.mark.parametrize("name", ["gasket", "Barnsley fern", "spiral"])
def test_points_are_at_their_addresses(name, count):
    ifs = SHAPES[name]
    points = point_cloud(ifs, count)
    seed = fixed_point(ifs.maps[np.argmax(ifs.weights)])
    astray = 0
    sampled = range(0, count, 1 + count // 50)
    for k in sampled:
        letters, first, members = decoded(k, count, ifs.weights, FEW)
        place = seed
        for i in reversed(letters + decoded(k - first, members, ifs.weights, 1)[0]):
            place = at(ifs.maps[i], place)
        astray += np.abs(points.position[k] - place).max() > 1e-5
        assert points.attractorlet[k] == letters[0]
    # A border between two parts can be so near to a number that rounding decides on the last letter.
    assert astray <= 0.05 * len(sampled)


@pytest.mark.parametrize("ifs", [*SHAPES.values(), ALMOST_ALL], ids=lambda ifs: ifs.name or "almost all")
def test_points_lie_on_the_attractor(ifs):
    points = point_cloud(ifs, 3000)
    exact, _, spacing = dense(ifs.maps, most=20_000)
    distances, _ = cKDTree(exact).query(points.position)
    assert distances.max() <= spacing + 1e-5
    assert points.position.shape == (3000, 2)
    assert points.position.dtype == np.float32


@pytest.mark.parametrize("name", ["gasket", "Barnsley fern", "maple leaf"])
def test_attractorlets_get_points_by_their_weights(name):
    ifs = SHAPES[name]
    shares = np.bincount(point_cloud(ifs, 100_000).attractorlet, minlength=ifs.count)
    assert shares == pytest.approx(100_000 * ifs.weights, abs=1)


def test_points_spread_like_the_chaos_game():
    ifs = SHAPES["Barnsley fern"]
    moments = point_cloud(ifs, 200_000).position.astype(float)
    mean = np.zeros(2)
    for _ in range(500):
        mean = ifs.weights @ at(ifs.maps, mean)
    assert moments.mean(axis=0) == pytest.approx(mean, abs=0.01)


def test_points_move_along_with_the_maps():
    """A word of norm s takes a change of the maps by d to a change of its points by d / (1 - s) at most."""
    morph = Morph(SHAPES["turned gasket"], SHAPES["gasket"])
    weights = np.ones(3)
    step = 1e-4
    for t in (0.0, 0.3, 0.7):
        here, there = morph.at(t, t), morph.at(t + step, t + step)
        moved = np.abs(at(there.maps[:, None], CORNERS) - at(here.maps[:, None], CORNERS)).sum(axis=-1).max()
        before, after = (point_cloud(ifs, 20_000, weights) for ifs in (here, there))
        assert np.array_equal(before.attractorlet, after.attractorlet)
        farthest = np.linalg.norm(after.position - before.position, axis=1).max()
        assert 0 < farthest <= moved / (1 - 0.5) + 1e-5


CORNERS = np.array([[-0.2, -0.2], [1.2, -0.2], [-0.2, 1.2], [1.2, 1.2]])


def test_addresses_are_of_the_given_weights_and_not_of_the_maps():
    fern, leaf = SHAPES["Barnsley fern"], SHAPES["maple leaf"]
    weights = [0.1, 0.2, 0.3, 0.4]
    letters = [point_cloud(ifs, 1000, weights).attractorlet for ifs in (fern, leaf)]
    assert np.array_equal(*letters)
    assert np.array_equal(letters[0], np.repeat(range(4), [100, 200, 300, 400]))


def test_weights_need_not_add_up_to_one():
    gasket = SHAPES["gasket"]
    assert np.array_equal(point_cloud(gasket, 99, [1, 2, 3]).position, point_cloud(gasket, 99, [10, 20, 30]).position)


def test_a_map_without_weight_gets_no_points():
    assert set(point_cloud(SHAPES["gasket"], 1000, [0, 1, 1]).attractorlet) == {1, 2}


def test_bytes_do_not_depend_on_threads():
    clouds = [point_cloud(SHAPES["Barnsley fern"], 150_000, threads=threads) for threads in (1, 2, 3, 5)]
    assert (
        len({cloud.position.tobytes() + cloud.radius.tobytes() + cloud.attractorlet.tobytes() for cloud in clouds}) == 1
    )


@pytest.mark.parametrize("ifs", [*SHAPES.values()], ids=lambda ifs: ifs.name)
def test_radii_are_of_the_size_of_pieces(ifs):
    points = point_cloud(ifs, 5000)
    typical = ifs.enclosing_disc[1] / 5000**0.5
    assert np.all(points.radius >= 0.999 * RADIUS_RANGE[0] * typical)
    assert np.all(points.radius <= 1.001 * RADIUS_RANGE[1] * typical)


def test_sparse_places_have_larger_points():
    gasket = IFS(SHAPES["gasket"].maps, [0.7, 0.2, 0.1])
    points = point_cloud(gasket, 10_000)
    sizes = [np.median(points.radius[points.attractorlet == i]) for i in range(3)]
    assert sizes[0] < sizes[1] < sizes[2]


def test_flat_maps_have_points_of_some_size():
    flat = IFS([[[0.5, 0, 0], [0, 0, 0]], [[0.5, 0, 0.5], [0, 0, 0]]])
    assert np.all(point_cloud(flat, 100).radius > 0)


def test_one_map_puts_all_points_in_one_place():
    points = point_cloud(IFS([[[0.5, 0, 1], [0, 0.5, 2]]]), 1000)
    assert np.allclose(points.position, [2, 4])


def test_no_points():
    assert len(point_cloud(SHAPES["gasket"], 0).position) == 0


@given(st.integers(0, 2**32 - 1), st.integers(1, 6), st.integers(1, 400))
def test_any_maps_and_weights(seed, maps, count):
    random = np.random.default_rng(seed)
    linear = random.uniform(-1, 1, (maps, 2, 2))
    linear *= (random.uniform(0.1, 0.9, maps) / np.linalg.norm(linear, 2, axis=(1, 2)))[:, None, None]
    ifs = IFS(np.concatenate([linear, random.uniform(-1, 1, (maps, 2, 1))], axis=2))
    weights = random.uniform(0, 1, maps) ** 4 + 1e-6
    points = point_cloud(ifs, count, weights)
    center, radius = ifs.enclosing_disc
    assert np.all(np.linalg.norm(points.position - center, axis=1) <= radius * (1 + 1e-5) + 1e-6)
    # The letters of all points, in order, are the parts of the unit interval.
    borders = np.concatenate([[0], np.cumsum(weights / weights.sum())])
    numbers = (np.arange(count) + 0.5) / count
    clear = np.abs(numbers[:, None] - borders).min(axis=1) > 1e-9
    assert np.array_equal(points.attractorlet[clear], (np.searchsorted(borders, numbers, side="right") - 1)[clear])


def test_no_attractor_is_an_error():
    with pytest.raises(IFSError, match="norm"):
        point_cloud(IFS([[[2, 0, 0], [0, 0.5, 0]]]), 10)


@pytest.mark.parametrize(
    ("count", "weights"), [(-1, None), (10, [1, 1]), (10, [1, -1, 1]), (10, [0, 0, 0]), (10, [1, 1, np.nan])]
)
def test_what_makes_no_sense_is_an_error(count, weights):
    with pytest.raises(ValueError, match=r"points|weights"):
        point_cloud(SHAPES["gasket"], count, weights)


def test_points_in_a_space_are_those_of_the_plane_moved_and_scaled():
    plane = point_cloud(SHAPES["Barnsley fern"], 2000)
    space = point_cloud(SHAPES["Barnsley fern"], 2000, placing=(0.5, -2.0, 4.0))
    assert space.position.shape == (2000, 3)
    assert not space.position[:, 2].any()
    assert np.allclose(space.position[:, :2] * 4 + (0.5, -2.0), plane.position, atol=1e-5)
    assert np.allclose(space.radius * 4, plane.radius, rtol=1e-5)
    assert np.array_equal(space.attractorlet, plane.attractorlet)

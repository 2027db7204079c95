import numpy as np
import pytest
from hypothesis import given, strategies

from core import enclosure
from core.space.enclosure import grows, norm, shrinking_words

from .reference import CORNERS, dense, random_ifs, tetrahedron


@given(strategies.integers(0, 2**32 - 1), strategies.floats(0, 16))
def test_the_norm_is_an_upper_bound_and_close(seed, alike):
    random = np.random.default_rng(seed)
    left, right = np.linalg.qr(random.normal(size=(2, 3, 3)))[0]
    values = np.sort(0.7 + 10**-alike * random.uniform(-0.5, 0.5, 3))
    values[0] = random.choice([values[0], values[1]])
    linear = left @ np.diag(values) @ right
    exact = np.linalg.norm(linear, 2)
    assert exact * (1 - 4e-16) <= norm(linear.ravel()) <= exact * (1 + 1e-7)


@pytest.mark.parametrize("linear", [np.zeros((3, 3)), np.eye(3), np.diag([1.0, 1.0, 0.0]), np.diag([1.0, 0.0, 0.0])])
def test_the_norm_of_plain_maps(linear):
    assert norm(linear.ravel()) == pytest.approx(np.linalg.norm(linear, 2), abs=1e-7)
    assert norm(linear.ravel()) >= np.linalg.norm(linear, 2)


@given(strategies.integers(0, 2**32 - 1), strategies.sampled_from([0.5, 0.999, 1.001, 1.5]))
def test_what_grows_has_a_spectral_radius_of_one(seed, radius):
    linear = np.random.default_rng(seed).normal(size=(3, 3))
    linear *= radius / np.abs(np.linalg.eigvals(linear)).max()
    assert grows(linear.ravel()) == (radius > 1)


@pytest.mark.parametrize("linear", [np.eye(3), np.diag([1.0, 0.5, 0.5]), [[0, -1, 0], [1, 0, 0], [0, 0, 0.5]]])
def test_a_spectral_radius_of_exactly_one_grows(linear):
    assert grows(np.asarray(linear, dtype=float).ravel())
    assert not grows((1 - 1e-6) * np.asarray(linear, dtype=float).ravel())


@pytest.mark.parametrize("seed", range(10))
def test_the_ball_holds_the_attractor(seed):
    ifs = random_ifs(seed, high=0.9)
    center, radius = ifs.enclosing_ball
    points, _, spacing = dense(ifs.maps)
    assert np.linalg.norm(points - center, axis=1).max() <= radius
    assert radius <= 3 * (np.linalg.norm(points - center, axis=1).max() + spacing)


def test_the_ball_of_a_tetrahedron_is_its_own():
    center, radius = tetrahedron(1 / 2).enclosing_ball
    assert center == pytest.approx(CORNERS.mean(axis=0))
    assert radius == pytest.approx((3 / 8) ** 0.5)


def test_maps_whose_norms_exceed_one_may_still_shrink():
    linear = np.array([[[0.5, 3.0, 0.0], [0.0, 0.5, 0.0], [0.0, 0.0, 0.5]]]).reshape(-1, 9)
    assert shrinking_words(linear)[0] == enclosure.COVERED
    assert shrinking_words(2.1 * linear)[0] == enclosure.NO_ATTRACTOR

import numpy as np
import pytest
from hypothesis import given, strategies

from core.affine import rotation
from core.space.affine import axis_and_angle, of_eigenvalues, polar, turned

MATRICES = strategies.integers(0, 2**32 - 1).map(lambda seed: np.random.default_rng(seed).normal(size=(5, 3, 3)))


@given(MATRICES, strategies.integers(0, 3))
def test_polar_takes_apart_maps_of_any_rank(matrices, rank):
    left, values, right = np.linalg.svd(matrices)
    values[:, rank:] = 0
    linear = (left * values[:, None, :]) @ right
    orthogonal, stretch = polar(linear)
    assert orthogonal @ np.swapaxes(orthogonal, -1, -2) == pytest.approx(np.tile(np.eye(3), (5, 1, 1)), abs=1e-12)
    assert stretch == pytest.approx(np.swapaxes(stretch, -1, -2), abs=1e-14)
    assert np.linalg.eigvalsh(stretch).min() >= -1e-12
    assert orthogonal @ stretch == pytest.approx(linear, abs=1e-12)


@given(MATRICES)
def test_a_flat_map_is_oriented_like_the_other(matrices):
    like = np.linalg.qr(matrices)[0]
    flat = like @ np.diag([0.5, 0.25, 0.0])
    assert polar(flat, like)[0] == pytest.approx(like, abs=1e-10)
    assert polar(np.zeros((5, 3, 3)), like)[0] == pytest.approx(like, abs=1e-12)


@given(MATRICES)
def test_an_axis_and_an_angle_make_the_turn(matrices):
    turn = np.linalg.qr(matrices)[0]
    turn *= np.linalg.det(turn)[:, None, None]
    axis, angle = axis_and_angle(turn)
    assert (axis[:, 2] >= -1e-9).all()
    assert (np.abs(angle) <= np.pi).all()
    assert turned(axis, angle) == pytest.approx(turn, abs=1e-12)


def test_an_upright_turn_is_that_of_the_plane():
    angles = np.linspace(-3.1, np.pi, 40)
    turn = np.tile(np.eye(3), (40, 1, 1))
    turn[:, :2, :2] = rotation(angles)
    axis, found = axis_and_angle(turn)
    assert axis == pytest.approx(np.tile([0.0, 0.0, 1.0], (40, 1)), abs=1e-12)
    assert found[:-1] == pytest.approx(angles[:-1])
    assert abs(found[-1]) == pytest.approx(np.pi)


def test_no_turn_has_an_angle_of_zero():
    axis, angle = axis_and_angle(np.eye(3)[None])
    assert angle[0] == 0
    assert np.linalg.norm(axis[0]) == 1


@given(MATRICES)
def test_a_function_of_eigenvalues(matrices):
    symmetric = matrices + np.swapaxes(matrices, -1, -2)
    assert of_eigenvalues(symmetric, np.square) == pytest.approx(symmetric @ symmetric, abs=1e-11)

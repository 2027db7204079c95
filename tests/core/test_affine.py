"""Affine maps: algebra by property, polar decomposition against numpy's SVD and the paper's iteration."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from core.affine import (
    compose,
    determinant,
    from_parameters,
    invert,
    polar,
    polar_by_iteration,
    rotation,
    singular_values,
    spectral_radius,
    through,
    to_parameters,
    transform,
)

numbers = st.floats(-4, 4).map(lambda x: 0.0 if abs(x) < 1e-100 else x)
maps = arrays(float, (2, 3), elements=numbers)
linears = arrays(float, (2, 2), elements=numbers)
points = arrays(float, 2, elements=numbers)


def conditioned(condition, angle=0.7, tilt=-1.9):
    """A matrix with singular values 1 and 1/condition."""
    return rotation(angle) @ np.diag([1.0, 1.0 / condition]) @ rotation(tilt).T


@given(maps, maps, points)
def test_compose_is_application_in_turn(outer, inner, point):
    np.testing.assert_allclose(
        transform(compose(outer, inner), point), transform(outer, transform(inner, point)), atol=1e-12
    )


@given(maps, points)
def test_invert_undoes(one, point):
    if singular_values(one[:, :2])[1] < 1e-3:
        return
    np.testing.assert_allclose(transform(invert(one), transform(one, point)), point, atol=1e-9)


@given(maps, arrays(float, (3, 2), elements=numbers))
def test_through_finds_the_map_of_three_points(one, corners):
    sides = corners[1:] - corners[0]
    if singular_values(sides)[1] < 1e-2:
        return
    np.testing.assert_allclose(through(corners, transform(one, corners)), one, atol=1e-7)


def test_through_refuses_points_on_a_line():
    with pytest.raises(np.linalg.LinAlgError):
        through([(0, 0), (1, 0), (2, 0)], [(0, 0), (1, 0), (0, 1)])


@given(linears)
def test_singular_values_are_numpys(linear):
    expected = np.linalg.svd(linear, compute_uv=False)
    np.testing.assert_allclose(singular_values(linear), expected, atol=1e-14 * max(1, expected[0]))


@given(linears)
def test_spectral_radius_is_numpys(linear):
    expected = np.abs(np.linalg.eigvals(linear)).max()
    # The eigenvalues of a matrix near a defective one move by the square root of a rounding error.
    np.testing.assert_allclose(spectral_radius(linear), expected, atol=1e-7)


@given(linears)
def test_polar_rebuilds_any_matrix(linear):
    angle, reflects, stretch = polar(linear)
    rebuilt = rotation(angle, reflects) @ stretch
    assert np.abs(rebuilt - linear).max() <= 1e-14 * max(np.abs(linear).max(), 1e-300)
    assert np.array_equal(stretch, stretch.T)
    scale = np.abs(linear).max()
    assert np.linalg.eigvalsh(stretch).min() >= -1e-14 * scale
    assert reflects == (determinant(linear) < 0)


@given(linears)
def test_polar_stretch_has_the_singular_values(linear):
    _, _, stretch = polar(linear)
    expected = np.linalg.svd(linear, compute_uv=False)
    np.testing.assert_allclose(np.sort(np.linalg.eigvalsh(stretch))[::-1], expected, atol=1e-13)


def test_polar_of_nothing_has_no_angle():
    for zero in (0.0, -0.0):
        angle, reflects, stretch = polar(np.full((2, 2), zero))
        assert angle == 0 and not reflects and not stretch.any()


def test_polar_of_a_stack_is_polar_of_each():
    stack = np.random.default_rng(1).normal(size=(5, 3, 2, 2))
    angle, reflects, stretch = polar(stack)
    for index in np.ndindex(5, 3):
        one = polar(stack[index])
        assert (angle[index], reflects[index]) == (one[0], one[1])
        np.testing.assert_array_equal(stretch[index], one[2])


@pytest.mark.parametrize("condition", [1.0, 1e3, 1e6, 1e15])
@pytest.mark.parametrize("sign", [1, -1])
def test_polar_at_any_conditioning(condition, sign):
    linear = conditioned(condition) @ np.diag([1, sign])
    angle, reflects, stretch = polar(linear)
    np.testing.assert_allclose(rotation(angle, reflects) @ stretch, linear, atol=1e-14)


def test_the_papers_iteration_agrees_and_slows_down_with_conditioning():
    counts = []
    for condition in (1.0, 1e3, 1e6):
        linear = conditioned(condition)
        orthogonal, stretch, iterations = polar_by_iteration(linear)
        angle, reflects, expected = polar(linear)
        np.testing.assert_allclose(orthogonal, rotation(angle, reflects), atol=1e-9 * condition**0.5)
        np.testing.assert_allclose(stretch, expected, atol=1e-9 * condition**0.5)
        counts.append(iterations)
    assert counts[0] < counts[1] < counts[2]


def test_the_papers_iteration_fails_on_singular_maps_and_the_closed_form_does_not():
    flat = np.array([[0.0, 0.0], [0.0, 0.16]])
    with pytest.raises(np.linalg.LinAlgError):
        polar_by_iteration(flat)
    angle, reflects, stretch = polar(flat)
    np.testing.assert_allclose(rotation(angle, reflects) @ stretch, flat, atol=1e-16)


@given(maps)
def test_parameters_round_trip_whatever_the_map(one):
    np.testing.assert_allclose(from_parameters(to_parameters(one)), one, atol=1e-14)


@given(st.floats(-3, 3), st.floats(0.01, 2), st.floats(-2, 2), st.floats(-1, 1), numbers, numbers)
def test_maps_round_trip_from_parameters(angle, scale_x, scale_y, shear, e, f):
    parameters = np.array([angle, scale_x, scale_y, shear, e, f])
    np.testing.assert_allclose(to_parameters(from_parameters(parameters)), parameters, atol=1e-12)

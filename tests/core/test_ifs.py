"""The IFS: what it refuses and how it says so, whether it has an attractor, and where that lies."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from core.ifs import IFS, WEIGHT_FLOOR, Contractivity, IFSError
from core.shapes import SHAPES
from tests.core.reference import at, chaos_game, dense, largest_spectral_radius, norms

every_shape = pytest.mark.parametrize("name", SHAPES)


def of_linear(*linear):
    """Return an IFS with these linear parts and all different translations."""
    linear = np.array(linear, dtype=float)
    translation = np.stack([np.arange(len(linear)), np.arange(len(linear)) ** 2 - 1.0], axis=-1)
    return IFS(np.concatenate([linear, translation[..., None]], axis=-1))


@st.composite
def systems(draw, norm=0.8):
    """Draw random IFSs of 1 to 5 maps, each of at most a norm, flat and reflecting ones among them."""
    count = draw(st.integers(1, 5))
    seed = draw(st.integers(0, 2**32 - 1))
    random = np.random.default_rng(seed)
    maps = random.normal(size=(count, 2, 3))
    maps[:, :, :2] *= (norm * random.uniform(0.05, 1, count) / norms(maps))[:, None, None]
    if draw(st.booleans()):
        maps[0, 1] = 2 * maps[0, 0]
        maps[0] *= norm / max(norm, norms(maps[:1])[0])
    return IFS(maps)


@st.composite
def long_systems(draw):
    """Draw IFSs seen through a shearing change of coordinates, so that norms above 1 occur with an attractor."""
    ifs = draw(systems(0.75))
    shear = draw(st.floats(1.5, 8))
    frame = np.array([[1, shear], [0, 1]])
    linear = frame @ ifs.linear @ np.linalg.inv(frame)
    return IFS(np.concatenate([linear, ifs.maps[:, :, 2:]], axis=-1))


# --- what it refuses


@pytest.mark.parametrize(
    ("maps", "weights", "said"),
    [
        ([], None, ["fern", "shape (0,)", "(N, 2, 3)"]),
        (np.empty((0, 2, 3)), None, ["fern", "no maps", "add"]),
        (np.zeros((2, 3)), None, ["fern", "shape (2, 3)", "(N, 2, 3)"]),
        (np.zeros((4, 3, 3)), None, ["fern", "shape (4, 3, 3)"]),
        (np.zeros((4, 6)), None, ["fern", "shape (4, 6)"]),
        ([[1, 2], [3]], None, ["fern", "array of numbers"]),
        ("maple", None, ["fern", "numbers"]),
        ([[["a", 0, 0], [0, 1, 0]]], None, ["fern", "numbers"]),
        (None, None, ["fern", "shape ()"]),
        (np.zeros((2, 2, 3)), [1, 2, 3], ["fern", "2 maps", "(3,)", "one weight a map"]),
        (np.zeros((2, 2, 3)), 1.0, ["fern", "2 maps", "one weight a map"]),
        (np.zeros((2, 2, 3)), [[1], [1, 2]], ["fern", "weights", "numbers"]),
        (np.zeros((2, 2, 3)), [1, -0.5], ["fern", "map 2", "-0.5", "zero or more"]),
        (np.zeros((2, 2, 3)), [1, np.nan], ["fern", "map 2", "NaN or infinity"]),
        (np.zeros((2, 2, 3)), [np.inf, 1], ["fern", "map 1", "NaN or infinity"]),
        (np.zeros((2, 2, 3)), [0, 0], ["fern", "weights are all zero"]),
    ],
)
def test_what_is_wrong_is_said_with_where(maps, weights, said):
    with pytest.raises(IFSError) as error:
        IFS(maps, weights, name="fern")
    for words in said:
        assert words in str(error.value)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("place", [(0, 0, 0), (1, 0, 2), (2, 1, 1)])
def test_a_number_that_is_not_finite_is_named_by_its_map(bad, place):
    maps = np.zeros((3, 2, 3))
    maps[place] = bad
    with pytest.raises(IFSError, match=f"map {place[0] + 1} holds NaN or infinity"):
        IFS(maps)


def test_an_error_is_a_value_error_and_needs_no_name():
    with pytest.raises(ValueError, match=r"^The IFS: maps have the shape"):
        IFS(np.zeros(3))


def test_the_arrays_are_copies_that_cannot_be_written():
    maps, weights = np.zeros((2, 2, 3)), np.array([1.0, 3.0])
    ifs = IFS(maps, weights)
    maps[:] = 7
    weights[:] = 7
    assert not ifs.maps.any()
    assert ifs.weights.tolist() == [0.25, 0.75]
    for array in (ifs.maps, ifs.weights, ifs.linear, ifs.translation):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1
    assert maps.flags.writeable
    assert weights.flags.writeable


def test_lists_of_whole_numbers_become_floats():
    assert IFS([[[0, 0, 1], [0, 0, 2]]]).maps.dtype == np.float64


# --- weights


@given(systems())
def test_default_weights_are_areas_with_a_floor(ifs):
    areas = np.abs(np.linalg.det(ifs.linear))
    assert ifs.weights.sum() == pytest.approx(1, abs=1e-14)
    assert (ifs.weights > 0).all()
    if areas.sum() > 0:
        raised = np.maximum(areas, WEIGHT_FLOOR * areas.sum())
        assert ifs.weights == pytest.approx(raised / raised.sum(), rel=1e-9)


def test_flat_maps_get_drawn_too():
    fern = SHAPES["Barnsley fern"]
    maps = np.array(fern.maps)
    maps[0, 0, :2] = 0
    assert IFS(maps).weights.min() == pytest.approx(0.01, rel=0.05)
    assert IFS(np.zeros((3, 2, 3))).weights.tolist() == [1 / 3] * 3


def test_given_weights_are_scaled_to_one_and_may_be_zero():
    assert IFS(np.zeros((3, 2, 3)), [2, 0, 6]).weights.tolist() == [0.25, 0, 0.75]


# --- contractivity by words


@pytest.mark.parametrize("scale", [0.05, 1, 2.2])
def test_a_norm_above_one_does_not_rule_an_attractor_out(scale):
    ifs = of_linear(scale * np.array([[0, 2], [0.1, 0]]), 0.2 * np.eye(2))
    assert largest_spectral_radius(ifs.linear) < 1
    assert ifs.contractivity == Contractivity.CONTRACTIVE
    ifs.require_attractor()
    points, _, _ = dense(ifs.maps)
    center, radius = ifs.enclosing_disc
    assert np.linalg.norm(points - center, axis=1).max() <= radius


def test_maps_that_contract_alone_but_not_together_are_refused():
    ifs = of_linear([[0, 2], [0, 0]], [[0, 0], [2, 0]])
    assert [largest_spectral_radius(linear[None]) for linear in ifs.linear] == [0, 0]
    assert ifs.contractivity == Contractivity.NO_ATTRACTOR
    with pytest.raises(IFSError) as error:
        ifs.require_attractor()
    for words in ("map 1", "norm 2", "in turn with the others", "below 1"):
        assert words in str(error.value)


@pytest.mark.parametrize("size", [1.0, 1.01, 30.0])
@pytest.mark.parametrize("angle", [0.0, 1.0, np.pi])
def test_a_map_that_does_not_contract_is_named_with_its_norm(size, angle):
    turn = size * np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    ifs = of_linear(0.5 * np.eye(2), turn, 0.2 * np.eye(2))
    assert ifs.contractivity == Contractivity.NO_ATTRACTOR
    with pytest.raises(IFSError) as error:
        ifs.require_attractor()
    assert "map 2" in str(error.value)
    assert f"{size:.4g}" in str(error.value)
    for attribute in ("enclosing_disc", "fixed_points", "bounds"):
        with pytest.raises(IFSError, match="map 2"):
            getattr(ifs, attribute)


def test_the_named_map_is_the_one_that_grows_not_the_one_of_largest_norm():
    ifs = of_linear([[0, 9], [0.01, 0]], [[1.1, 0], [0, 0.1]])
    with pytest.raises(IFSError, match=r"map 2 does not contract: its norm is 1\.1 "):
        ifs.require_attractor()


def test_what_cannot_be_decided_is_undecided_and_says_so():
    # It takes words of hundreds of letters to come below the norm 1.
    ifs = of_linear([[0.99, 3], [0, 0.99]], [[0.99, -3], [0, 0.99]])
    assert ifs.contractivity == Contractivity.UNDECIDED
    with pytest.raises(IFSError, match=r"could not be shown .* below 1"):
        ifs.require_attractor()


@given(st.integers(0, 2**32 - 1), st.integers(1, 4), st.floats(0.3, 1.6))
@settings(max_examples=150)
def test_contractivity_agrees_with_the_spectral_radii_of_words(seed, count, size):
    linear = np.random.default_rng(seed).normal(size=(count, 2, 2)) * size / 2
    ifs = of_linear(*linear)
    radius = largest_spectral_radius(linear, 6)
    if radius >= 1 + 1e-9:
        assert ifs.contractivity != Contractivity.CONTRACTIVE
    if np.linalg.norm(linear, 2, axis=(1, 2)).max() < 0.9:
        assert ifs.contractivity == Contractivity.CONTRACTIVE
    if ifs.contractivity == Contractivity.NO_ATTRACTOR:
        # The word found may be longer than those tried here, but then it is close.
        assert radius > 0.9


@given(st.integers(0, 2**32 - 1), st.integers(2, 3))
@settings(max_examples=50)
def test_the_words_of_a_contractive_ifs_shrink(seed, count):
    linear = np.random.default_rng(seed).normal(size=(count, 2, 2)) * 0.6
    ifs = of_linear(*linear)
    assume(ifs.contractivity == Contractivity.CONTRACTIVE)
    longest = np.linalg.norm(np.linalg.matrix_power(linear, 400), 2, axis=(1, 2))
    assert longest.max() < 1
    points = chaos_game(ifs, 200)
    assert np.isfinite(points).all()


# --- what is drawn of it


def test_all_is_drawn_by_default():
    ifs = SHAPES["gasket"]
    assert ifs.opacity.tolist() == [1, 1, 1]
    assert ifs.drawn.all()
    assert ifs.allowed.all()
    assert not ifs.opacity.flags.writeable


def test_hidden_maps_may_come_anywhere_but_first():
    ifs = IFS(SHAPES["gasket"].maps, opacity=[0, 0.5, 1], transitions=[[1, 1, 0], [1, 1, 1], [0, 1, 1]])
    assert ifs.drawn.tolist() == [False, True, True]
    assert ifs.allowed.tolist() == [*ifs.follows.tolist(), [False, True, True]]


@pytest.mark.parametrize(
    ("opacity", "said"),
    [
        ([1, 1], "3 maps but opacities of shape"),
        ([1, 2, 1], "opacity of map 2 is 2; use 0 to 1"),
        ([1, 1, -0.5], "opacity of map 3 is -0.5; use 0 to 1"),
        ([0, 0, 0], "all its maps are hidden; give at least one an opacity above 0"),
        ([1, np.nan, 1], "opacity of map 2 holds NaN or infinity"),
        (["a", 1, 1], "not an array of numbers"),
    ],
)
def test_opacities_that_make_no_sense_are_named(opacity, said):
    with pytest.raises(IFSError, match=said):
        IFS(SHAPES["gasket"].maps, opacity=opacity)


# --- where the attractor lies


def assert_encloses(ifs):
    points = np.concatenate([dense(ifs.maps, 4000)[0], chaos_game(ifs, 2000)])
    center, radius = ifs.enclosing_disc
    slack = 1e-9 * max(radius, np.abs(points).max())
    assert np.linalg.norm(points - center, axis=1).max() <= radius + slack
    x0, y0, x1, y1 = ifs.bounds
    assert (points >= np.array([x0, y0]) - slack).all()
    assert (points <= np.array([x1, y1]) + slack).all()


def test_a_map_that_enlarges_before_it_shrinks_keeps_its_bounds():
    linear = [[3.66931481, -24.37144164], [0.56450997, -3.74945256]]
    assert_encloses(IFS([np.column_stack([linear, [-0.63111373, -1.26222745]])]))


@given(systems())
@settings(max_examples=60)
def test_disc_and_bounds_hold_the_attractor(ifs):
    assert_encloses(ifs)


@given(long_systems())
@settings(max_examples=40)
def test_disc_and_bounds_hold_the_attractor_with_norms_above_one(ifs):
    assume(ifs.contractivity == Contractivity.CONTRACTIVE)
    assert_encloses(ifs)


def test_norms_above_one_were_among_them():
    frame = np.array([[1, 8], [0, 1]])
    linear = frame @ (0.6 * np.array([[[0, -1], [1, 0]], [[1, 0], [0, -1]]])) @ np.linalg.inv(frame)
    ifs = of_linear(*linear)
    assert ifs.norms.max() > 5
    assert ifs.contractivity == Contractivity.CONTRACTIVE
    assert_encloses(ifs)


@every_shape
def test_disc_and_bounds_hold_each_shape_tightly(name):
    ifs = SHAPES[name]
    assert_encloses(ifs)
    points, _, spacing = dense(ifs.maps, 30_000)
    low, high = points.min(axis=0), points.max(axis=0)
    size = (high - low).max()
    assert np.abs(np.array(ifs.bounds) - np.concatenate([low, high])).max() <= spacing + 0.03 * size
    # Half the diagonal of a box is more than the least radius that holds what is in it.
    assert ifs.enclosing_disc[1] <= 1.6 * np.linalg.norm(high - low) / 2


@pytest.mark.parametrize(
    ("name", "box"),
    [("gasket", (0, 0, 1, 0.75**0.5)), ("square", (0, 0, 1, 1)), ("Cantor dust", (0, 0, 1, 1))],
)
def test_known_bounds(name, box):
    assert SHAPES[name].bounds == pytest.approx(box, abs=2e-3)
    x0, y0, x1, y1 = SHAPES[name].bounds
    assert x0 <= box[0]
    assert y0 <= box[1]
    assert x1 >= box[2]
    assert y1 >= box[3]


@given(systems(), st.floats(-100, 100), st.floats(-100, 100), st.floats(0.01, 100))
@settings(max_examples=40)
def test_disc_moves_with_the_attractor(ifs, x, y, size):
    shift = np.array([x, y])
    maps = np.array(ifs.maps)
    maps[:, :, 2] = size * maps[:, :, 2] + shift - maps[:, :, :2] @ shift
    center, radius = ifs.enclosing_disc
    moved, moved_radius = IFS(maps).enclosing_disc
    assert moved_radius == pytest.approx(size * radius, rel=1e-6, abs=1e-9)
    assert moved == pytest.approx(size * center + shift, rel=1e-6, abs=1e-6)


def test_one_point_has_a_disc_of_no_size():
    ifs = IFS([[[0.5, 0, 1], [0, 0.5, 2]], [[0.2, 0, 1.6], [0, 0.2, 3.2]]])
    center, radius = ifs.enclosing_disc
    assert center == pytest.approx([2, 4])
    assert radius == pytest.approx(0, abs=1e-14)
    assert ifs.bounds == pytest.approx((2, 4, 2, 4))


@given(systems())
def test_fixed_points_stay_where_they_are(ifs):
    fixed = ifs.fixed_points
    assert fixed.shape == (ifs.count, 2)
    assert at(ifs.maps, fixed) == pytest.approx(fixed, rel=1e-9, abs=1e-9)
    center, radius = ifs.enclosing_disc
    assert np.linalg.norm(fixed - center, axis=1).max() <= radius * (1 + 1e-9) + 1e-12


def test_parts_of_the_maps():
    ifs = SHAPES["Barnsley fern"]
    assert np.array_equal(np.concatenate([ifs.linear, ifs.translation[..., None]], axis=-1), ifs.maps)
    assert ifs.norms == pytest.approx(np.linalg.norm(ifs.linear, 2, axis=(1, 2)))

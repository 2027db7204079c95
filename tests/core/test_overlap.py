"""The kernels that compare attractorlets: what they certify must hold for points of the attractor."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from core import decision, overlap
from core.connectedness import connectedness
from core.decision import decide_column
from core.enclosure import outer_polygon
from core.heap import sift_down, sift_up
from core.ifs import IFS
from core.overlap import (
    APART,
    MEET,
    UNKNOWN,
    normalize,
    pair_test,
    polygon_distance,
    set_child,
    set_piece,
    surely_one_piece,
)
from core.shapes import SHAPES
from tests.core.reference import at, cover, dense

seeds = st.integers(0, 2**32 - 1)


def unit_maps(ifs):
    """Rows of the linear parts, and the translations that put the enclosing disc at the origin with radius 1."""
    linear = np.ascontiguousarray(ifs.linear).reshape(-1, 4)
    center, radius = ifs.enclosing_disc
    unit = np.empty((ifs.count, 2))
    normalize(linear, np.ascontiguousarray(ifs.translation), *center, radius, unit)
    return linear, unit


def together(linear, unit):
    return np.concatenate([linear.reshape(-1, 2, 2), unit[..., None]], axis=-1)


def random_ifs(seed, count=3, low=0.1, high=0.75):
    random = np.random.default_rng(seed)
    linear = random.normal(size=(count, 2, 2))
    linear *= (random.uniform(low, high, count) / np.linalg.norm(linear, 2, axis=(1, 2)))[:, None, None]
    return IFS(np.concatenate([linear, random.normal(size=(count, 2, 1))], axis=-1))


@given(seeds)
def test_normalized_maps_have_the_same_attractor_in_the_unit_disc(seed):
    ifs = random_ifs(seed)
    points, _, _ = dense(together(*unit_maps(ifs)), 1000)
    center, radius = ifs.enclosing_disc
    assert np.linalg.norm(points, axis=1).max() <= 1 + 1e-9
    assert points * radius + center == pytest.approx(dense(ifs.maps, 1000)[0], abs=1e-9 * radius)


@given(seeds, st.lists(st.integers(0, 2), min_size=1, max_size=8))
def test_pieces_are_the_images_under_words(seed, word):
    linear, unit = unit_maps(random_ifs(seed))
    piece, child = np.empty(7), np.empty(7)
    set_piece(linear, unit, word[0], piece)
    for letter in word[1:]:
        set_child(linear, unit, letter, piece, child)
        piece[:] = child
    composed = np.eye(3)
    for letter in word:
        composed = composed @ np.vstack([together(linear, unit)[letter], [0, 0, 1]])
    assert piece[:4].reshape(2, 2) == pytest.approx(composed[:2, :2], abs=1e-14)
    assert piece[4:6] == pytest.approx(composed[:2, 2], abs=1e-13)
    assert piece[6] == pytest.approx(np.linalg.norm(composed[:2, :2], 2), abs=1e-14)


@given(seeds)
@settings(max_examples=60)
def test_polygons_are_never_further_apart_than_their_points(seed):
    random = np.random.default_rng(seed)
    linear, unit = unit_maps(random_ifs(seed))
    _, corners = outer_polygon(linear, unit, 1.0, 16, 1e-3)
    points, _, _ = dense(together(linear, unit), 400)
    words = []
    for _ in range(2):
        length = random.integers(1, 4)
        piece, child = np.empty(7), np.empty(7)
        set_piece(linear, unit, random.integers(3), piece)
        for _ in range(length):
            set_child(linear, unit, random.integers(3), piece, child)
            piece[:] = child
        words.append(piece)
    one, other = (points @ word[:4].reshape(2, 2).T + word[4:6] for word in words)
    nearest = np.linalg.norm(one[:, None] - other[None], axis=-1).min()
    assert polygon_distance(*words, corners, np.inf) <= nearest + 1e-12
    # Stopping early may only give a lower bound that is enough.
    early = polygon_distance(*words, corners, 0.0)
    assert early <= nearest + 1e-12
    assert (early > 0) == (polygon_distance(*words, corners, np.inf) > 0)


@pytest.mark.parametrize("shift", [0.5, 1.999, 2.001, 3.0])
def test_polygons_of_two_squares(shift):
    corners = np.array([[1.0, 1], [-1, 1], [-1, -1], [1, -1]])
    one = np.array([1.0, 0, 0, 1, 0, 0, 1])
    other = np.array([1.0, 0, 0, 1, shift, 0, 1])
    found = polygon_distance(one, other, corners, np.inf)
    assert found <= max(shift - 2, 0) + 1e-12
    assert (found > 0) == (shift > 2)


@pytest.mark.parametrize("with_polygons", [False, True])
@given(seeds)
@settings(max_examples=50)
def test_a_pair_called_apart_is_apart_and_one_called_meeting_is_near(with_polygons, seed):
    linear, unit = unit_maps(random_ifs(seed))
    points, letters, spacing = dense(together(linear, unit), 1500)
    corners = outer_polygon(linear, unit, 1.0, 16, 1e-3)[1] if with_polygons else np.empty((0, 2))
    first, second, key = np.empty((decision.STACK, 7)), np.empty((decision.STACK, 7)), np.empty(decision.STACK)
    tolerance = 0.01
    for i, j in ((0, 1), (0, 2), (1, 2)):
        outcome = pair_test(linear, unit, i, j, tolerance, corners, 4000, first, second, key)
        apart = np.linalg.norm(points[letters == i][:, None] - points[letters == j][None], axis=-1).min()
        if outcome == APART:
            assert apart > 1e-13
        if outcome == MEET:
            assert apart - 2 * spacing <= 2 * tolerance
        reverse = pair_test(linear, unit, j, i, tolerance, corners, 4000, first, second, key)
        assert {outcome, reverse} != {MEET, APART} or apart <= 2 * tolerance + 2 * spacing


def test_a_pair_test_gives_up_at_its_budget():
    linear, unit = unit_maps(SHAPES["Lévy curve"])
    first, second, key = np.empty((decision.STACK, 7)), np.empty((decision.STACK, 7)), np.empty(decision.STACK)
    assert pair_test(linear, unit, 0, 1, 1e-12, np.empty((0, 2)), 3, first, second, key) == UNKNOWN
    assert pair_test(linear, unit, 0, 1, 1e-12, np.empty((0, 2)), 4000, first[:4], second[:4], key[:4]) in (
        UNKNOWN,
        MEET,
    )


@given(st.lists(st.floats(0, 1), min_size=1, max_size=6), st.randoms(use_true_random=False))
def test_the_area_certificate_holds_for_every_way_to_take_sides(areas, random):
    count = len(areas)
    labels = np.arange(count)
    for _ in range(random.randrange(count)):
        i, j = random.randrange(count), random.randrange(count)
        labels[labels == labels[j]] = labels[i]
    areas = np.array(areas)
    # What the kernel takes as a component's name is the label of one of its own members.
    components = np.unique(labels)
    sums = []
    for sides in range(1, 2 ** len(components) - 1):
        left = np.isin(labels, [c for k, c in enumerate(components) if sides >> k & 1])
        sums.append(areas[left].max() + areas[~left].max())
    expected = len(components) == 1 or min(sums) >= 1 + overlap.SLACK
    assert surely_one_piece(labels, areas) == expected


@given(st.lists(st.floats(0, 1) | st.integers(0, 2).map(float), min_size=1, max_size=60))
def test_the_heap_gives_the_least_first(values):
    key = np.array(values)
    order = np.empty(len(key), np.int64)
    for k in range(len(key)):
        order[k] = k
        sift_up(order, key, k)
    found = []
    for length in range(len(key) - 1, -1, -1):
        found.append(key[order[0]])
        order[0] = order[length]
        sift_down(order, key, length)
    assert found == sorted(values)


@pytest.mark.parametrize("with_gap", [False, True])
def test_a_column_is_its_nodes_one_by_one(with_gap):
    linear = np.ascontiguousarray(random_ifs(12, 4, 0.3, 0.9).linear).reshape(-1, 4)
    random = np.random.default_rng(4)
    translations = random.normal(size=(30, 4, 2))
    state, gap, labels = decide_column(linear, translations, 1 / 300, with_gap)
    assert len(np.unique(state)) > 1
    for k in range(30):
        ifs = IFS(np.concatenate([linear.reshape(-1, 2, 2), translations[k, ..., None]], axis=-1))
        verdict = connectedness(ifs)
        assert verdict.state == state[k]
        assert np.array_equal(verdict.components, labels[k])
        if with_gap:
            assert verdict.gap == tuple(gap[k])
        elif state[k] == decision.DISCONNECTED:
            assert np.isnan(gap[k]).all()


@given(seeds, st.sampled_from([1 / 30, 1 / 300, 1e-6]))
@settings(max_examples=60)
def test_the_gap_is_above_zero_exactly_where_disconnected(seed, tolerance):
    verdict = connectedness(random_ifs(seed, 4), tolerance)
    assert (verdict.gap[0] > 0) == (verdict.state == decision.DISCONNECTED)
    assert verdict.gap[0] <= verdict.gap[1]


@given(seeds)
@settings(max_examples=30)
def test_components_are_named_by_their_lowest_map(seed):
    verdict = connectedness(random_ifs(seed, 5))
    for i, label in enumerate(verdict.components):
        assert label == np.flatnonzero(verdict.components == label)[0]
        assert label <= i
    assume(verdict.state != decision.UNDECIDED)
    assert (len(np.unique(verdict.components)) == 1) == (verdict.state == decision.CONNECTED)


def test_the_reference_covers_the_attractor():
    """The yardstick itself: points by another cover, shifted within each piece, stay within the spacing."""
    for name in ("gasket", "Barnsley fern", "maple leaf"):
        maps = SHAPES[name].maps
        points, letters, spacing = dense(maps, 3000)
        words, others = cover(maps, 0.02)
        for letter in range(len(maps)):
            near = points[letters == letter]
            for sample in at(words[others == letter], SHAPES[name].fixed_points[-1])[::7]:
                assert np.linalg.norm(near - sample, axis=1).min() <= spacing

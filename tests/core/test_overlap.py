"""The kernels that compare attractorlets: what they certify must hold for points of the attractor."""

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from core import decision, overlap
from core.connectedness import connectedness
from core.deciding import column_steps, decide_frames
from core.heap import sift_down, sift_up
from core.ifs import IFS
from core.overlap import APART, MEET, UNKNOWN, pair_test, surely_one_piece
from core.polygon import outer_polygon
from core.shapes import SHAPES
from core.tree import View, empty_tree, plant
from tests.core.random_maps import random_ifs, unit_maps
from tests.core.reference import at, cover, dense, linkage

seeds = st.integers(0, 2**32 - 1)


def outcome_of(linear, unit, i, j, tolerance, corners, budget=4000, stack=overlap.STACK, capacity=10_000):
    tree = empty_tree(capacity)
    plant(tree, linear, unit, np.zeros_like(unit))
    room = np.empty(stack, np.int32), np.empty(stack, np.int32), np.empty(stack)
    view = View(0.0, 0.0, 0.0, 1.0, 1e-12)
    return pair_test(
        tree, np.ones((len(linear), len(linear)), dtype=bool), view, i, j, tolerance, corners, budget, *room
    )


@pytest.mark.parametrize("with_polygons", [False, True])
@given(seeds)
@settings(max_examples=50)
def test_a_pair_called_apart_is_apart_and_one_called_meeting_is_near(with_polygons, seed):
    linear, unit = unit_maps(random_ifs(seed))
    points, letters, spacing = dense(np.concatenate([linear.reshape(-1, 2, 2), unit[..., None]], axis=-1), 1500)
    corners = outer_polygon(linear, unit, 1.0, 16, 1e-3)[1] if with_polygons else np.empty((0, 2))
    tolerance = 0.01
    for i, j in ((0, 1), (0, 2), (1, 2)):
        outcome = outcome_of(linear, unit, i, j, tolerance, corners)
        apart = np.linalg.norm(points[letters == i][:, None] - points[letters == j][None], axis=-1).min()
        if outcome == APART:
            assert apart > 1e-13
        if outcome == MEET:
            assert apart - 2 * spacing <= 2 * tolerance
        reverse = outcome_of(linear, unit, j, i, tolerance, corners)
        assert {outcome, reverse} != {MEET, APART} or apart <= 2 * tolerance + 2 * spacing


def test_a_pair_test_gives_up_at_its_budget_and_where_there_is_no_room():
    linear, unit = unit_maps(SHAPES["Lévy curve"])
    none = np.empty((0, 2))
    assert outcome_of(linear, unit, 0, 1, 1e-12, none) == MEET
    assert outcome_of(linear, unit, 0, 1, 1e-12, none, budget=3) == UNKNOWN
    assert outcome_of(linear, unit, 0, 1, 1e-12, none, stack=4) == UNKNOWN
    assert outcome_of(linear, unit, 0, 1, 1e-12, none, capacity=20) == UNKNOWN


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


def finished(steps):
    while True:
        try:
            next(steps)
        except StopIteration as ended:
            return ended.value


@pytest.mark.parametrize("with_gap", [False, True])
def test_a_column_is_its_nodes_one_by_one(with_gap):
    linear = np.ascontiguousarray(random_ifs(12, 4, 0.3, 0.9).linear).reshape(-1, 4)
    random = np.random.default_rng(4)
    start, drift = random.normal(size=(2, 4, 2))
    along = np.linspace(-2, 2, 40)
    state, gap, labels = finished(
        column_steps(linear, start, drift, along, np.ones((4, 4), dtype=bool), 1 / 300, with_gap)
    )
    assert len(np.unique(state)) > 1
    translations = start + along[:, None, None] * drift
    frames = decide_frames(
        np.tile(linear, (40, 1, 1)), translations, np.ones((40, 4, 4), dtype=bool), 1 / 300, with_gap
    )
    assert np.array_equal(frames[0], state)
    assert np.array_equal(frames[2], labels)
    assert frames[1] == pytest.approx(gap, abs=1e-9, nan_ok=True)
    for k in range(0, 40, 3):
        verdict = connectedness(IFS(np.concatenate([linear.reshape(-1, 2, 2), translations[k, ..., None]], axis=-1)))
        assert verdict.state == state[k]
        assert np.array_equal(verdict.components, labels[k])
        if with_gap:
            assert verdict.gap == pytest.approx(tuple(gap[k]), abs=1e-9)
        elif state[k] == decision.DISCONNECTED:
            assert np.isnan(gap[k]).all()


@given(seeds, st.floats(-12, 12))
@settings(max_examples=30)
def test_a_shape_far_away_gets_the_same_verdict(seed, exponent):
    ifs = random_ifs(seed)
    away = np.random.default_rng(seed).normal(size=2) * 10**exponent
    moved = IFS(np.concatenate([ifs.linear, (ifs.translation + away - ifs.linear @ away)[..., None]], axis=-1))
    here, there = connectedness(ifs), connectedness(moved)
    if exponent < 6 or (here.gap[0] > 0.1 and exponent < 11):
        assert here.state == there.state
    # Far away all that is known for certain must still be true.
    assert there.state != decision.DISCONNECTED or here.gap[1] > 0


@pytest.mark.parametrize("ratio, place", [(-1.0, 1 / 2), (-2.0, 1 / 3), (-3.0, 1 / 4)])
def test_a_shape_that_collapses_on_the_way_is_one_point_there(ratio, place):
    random = np.random.default_rng(1)
    linear, follows = np.tile([0.5, 0, 0, 0.5], (3, 1)), np.ones((3, 3), dtype=bool)
    for _ in range(40):
        start = random.normal(size=(3, 2))
        start -= start.mean(axis=0)
        steps = column_steps(linear, start, (ratio - 1) * start, np.array([-1, place, 2, 2]), follows, 1 / 300, True)
        assert finished(steps)[0][1] == decision.CONNECTED


def test_many_maps_are_decided():
    side = 16
    squares = [[[1 / side, 0, x / side], [0, 1 / side, y / side]] for x in range(side) for y in range(side)]
    assert connectedness(IFS(squares)).state == decision.CONNECTED
    apart = np.array(squares)
    apart[:, :, :2] *= 0.98
    assert connectedness(IFS(apart)).state == decision.DISCONNECTED


def test_a_ring_with_a_speck_has_the_gap_of_the_speck():
    """The ring's own maps meet at the tolerance only, which is all that is known of their gaps."""
    angles = 2 * np.pi * np.arange(16) / 16
    scale, tolerance = 0.1619, 0.01363
    ring = [[[scale, 0, np.cos(angle)], [0, scale, np.sin(angle)]] for angle in angles]
    center = np.array([1 + scale, 0.0])
    speck = [[[1e-4, 0, center[0]], [0, 1e-4, center[1]]]]
    ifs = IFS(np.array(ring + speck))
    points, letters, spacing = dense(ifs.maps, 6000)
    gap, diameter = linkage(points, letters, ifs.count), 2 * ifs.enclosing_disc[1]
    low, high = connectedness(ifs, tolerance).gap
    assert low * diameter <= gap * (1 + 1e-9)
    assert gap - 2 * spacing <= high * diameter


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

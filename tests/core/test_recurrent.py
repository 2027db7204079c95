"""Connectedness of recurrent IFSs, against points of the attractor that are compared one with another."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.connectedness import Connectedness, connectedness, index_buffer, object_based
from core.ifs import IFS
from core.locus import compute_locus
from core.morph import Morph
from core.report import check_frames
from core.shapes import SHAPES
from tests.core.reference import allowed_points, dense, groups_within

CONNECTED, DISCONNECTED, UNDECIDED = Connectedness.CONNECTED, Connectedness.DISCONNECTED, Connectedness.UNDECIDED
SQUARE = SHAPES["square"]


def recurrent(ifs, transitions):
    return IFS(ifs.maps, ifs.weights, transitions=np.array(transitions, dtype=float))


@given(st.integers(0, 2**32 - 1), st.integers(2, 4))
@settings(max_examples=120, deadline=None)
def test_verdicts_hold_for_the_points(seed, count):
    random = np.random.default_rng(seed)
    linear = random.normal(size=(count, 2, 2))
    linear *= (random.uniform(0.2, 0.8, count) / np.linalg.norm(linear, 2, axis=(1, 2)))[:, None, None]
    transitions = (random.random((count, count)) < 0.7) * random.uniform(0.1, 1, (count, count))
    for i in range(count):
        transitions[i, (i + 1) % count] = 1.0
    ifs = IFS(np.concatenate([linear, random.normal(size=(count, 2, 1))], axis=-1), transitions=transitions)
    tolerance = 1 / 50
    verdict = connectedness(ifs, tolerance)
    points, slack = allowed_points(ifs, 4000)
    diameter = 2 * ifs.enclosing_disc[1]
    if verdict.state == CONNECTED:
        assert groups_within(points, tolerance * diameter + 2 * slack) == 1
    if verdict.state == DISCONNECTED and verdict.gap[0] * diameter > 2 * slack:
        assert groups_within(points, verdict.gap[0] * diameter - 2 * slack) > 1


def test_all_transitions_make_no_difference():
    for name in ("gasket", "terdragon", "Cantor dust"):
        ifs = SHAPES[name]
        free, same = connectedness(ifs), connectedness(recurrent(ifs, np.full((ifs.count, ifs.count), 0.5)))
        assert free.state == same.state
        assert free.gap == same.gap


def test_a_square_less_one_transition_stays_whole_and_less_many_does_not():
    assert connectedness(recurrent(SQUARE, np.ones((4, 4)) - np.diag([1, 0, 0, 0]))).state == CONNECTED
    only_itself_or_opposite = np.array([[1, 0, 0, 1], [0, 1, 1, 0], [0, 1, 1, 0], [1, 0, 0, 1]])
    # Then each quarter is made of its two opposite corners alone: the two diagonals.
    assert connectedness(recurrent(SQUARE, only_itself_or_opposite)).state != DISCONNECTED
    in_turn = np.eye(4) + np.eye(4, k=1) + np.eye(4, k=-3)
    assert connectedness(recurrent(SQUARE, in_turn)).gap[0] > 0


def test_attractorlets_that_meet_do_not_do_if_they_are_in_pieces_themselves():
    """Two copies, each of the same two far apart points' neighbourhoods, that lie on one another."""
    maps = [[[0.4, 0, 0], [0, 0.4, 0]], [[0.4, 0, 0.6], [0, 0.4, 0]], [[0.4, 0, 0.01], [0, 0.4, 0]]]
    free = IFS(maps)
    assert connectedness(free).state == DISCONNECTED
    bridged = IFS([[[0.5, 0, 0], [0, 0.5, 0]], [[0.5, 0, 0.5], [0, 0.5, 0]]])
    assert connectedness(bridged).state == CONNECTED
    # Either half is again a segment; but after the left one only the left may come, so points are left of it.
    points = recurrent(bridged, [[1, 0], [1, 1]])
    assert connectedness(points).state == DISCONNECTED


def test_a_morph_keeps_transitions_that_forbid_nothing():
    often = recurrent(SQUARE, np.ones((4, 4)) + 2 * np.eye(4))
    assert np.array_equal(Morph(SQUARE, often).at(0.5, 0.5).transitions, np.ones((4, 4)) + np.eye(4))
    assert Morph(SQUARE, SQUARE).at(0.5, 0.5).transitions is None


def test_a_morph_between_two_graphs_is_decided_as_any_other():
    one = recurrent(SQUARE, np.ones((4, 4)) - np.diag([1, 0, 0, 0]))
    other = recurrent(SQUARE, np.ones((4, 4)) - np.diag([0, 0, 0, 1]))
    morph = Morph(one, other)
    check = check_frames(morph, np.column_stack([np.linspace(0, 1, 5)] * 2 + [np.zeros(5)]))
    assert (check.state == CONNECTED).all()
    locus = compute_locus(morph, 13)
    for u, v in ((0.0, 0.0), (1.0, 1.0), (0.5, -0.5), (-1.0, 2.0)):
        row, column = locus.node(u, v)
        assert locus.state[row, column] == connectedness(morph.at(u, v)).state


# --- hidden maps


@given(st.integers(0, 2**32 - 1), st.integers(2, 5))
@settings(max_examples=120, deadline=None)
def test_verdicts_on_what_is_drawn_hold_for_its_points(seed, count):
    random = np.random.default_rng(seed)
    linear = random.normal(size=(count, 2, 2))
    linear *= (random.uniform(0.3, 0.85, count) / np.linalg.norm(linear, 2, axis=(1, 2)))[:, None, None]
    opacity = random.random(count) < 0.6
    opacity[random.integers(count)] = True
    ifs = IFS(np.concatenate([linear, random.normal(size=(count, 2, 1))], axis=-1), opacity=opacity)
    tolerance = 1 / 50
    verdict = connectedness(ifs, tolerance)
    points, letters, slack = dense(ifs.maps, 4000)
    points = points[ifs.drawn[letters]]
    diameter = 2 * ifs.enclosing_disc[1]
    if verdict.state == CONNECTED:
        assert groups_within(points, tolerance * diameter + 2 * slack) == 1
    if verdict.state == DISCONNECTED and verdict.gap[0] * diameter > 2 * slack:
        assert groups_within(points, verdict.gap[0] * diameter - 2 * slack) > 1
    assert np.array_equal(verdict.components < 0, ~ifs.drawn)


@pytest.mark.parametrize(
    ("name", "opacity", "state", "components"),
    [
        ("gasket", [0, 1, 1], CONNECTED, [-1, 1, 1]),
        ("Koch curve", [0, 1, 1, 0], CONNECTED, [-1, 1, 1, -1]),
        ("Koch curve", [0, 1, 0, 1], DISCONNECTED, [-1, 1, -1, 3]),
        ("Koch curve", [1, 0, 1, 1], DISCONNECTED, [0, -1, 2, 2]),
        # A small opacity is enough to hold a shape together.
        ("Koch curve", [1, 0.01, 1, 1], CONNECTED, [0, 0, 0, 0]),
        ("Cantor dust", [0, 0, 1, 0], DISCONNECTED, [-1, -1, 2, -1]),
    ],
)
def test_only_what_is_drawn_has_to_hang_together(name, opacity, state, components):
    ifs = replace(SHAPES[name], opacity=opacity)
    verdict = connectedness(ifs)
    assert verdict.state == state
    assert verdict.components.tolist() == components
    for other in (index_buffer, object_based):
        assert other(ifs).state == other(SHAPES[name]).state


def test_the_gap_is_that_of_what_is_drawn():
    """The outer quarters of a segment, with the middle half hidden; and with one of its quarters."""
    quarters = [[[0.25, 0, k / 4], [0, 0.25, 0]] for k in range(4)]
    for opacity, gap in (([1, 0, 0, 1], 0.5), ([1, 0, 1, 1], 0.25), ([1, 1, 0, 1], 0.25)):
        verdict = connectedness(IFS(quarters, opacity=opacity))
        assert verdict.state == DISCONNECTED
        low, high = verdict.gap
        diameter = 2 * IFS(quarters).enclosing_disc[1]
        assert low * diameter <= gap + 1e-9
        assert high * diameter >= gap - 1e-9
        assert high - low < 0.1


def test_a_drawn_part_may_be_whole_where_the_attractor_is_not():
    """A square of nine whose middle is covered: one more map puts a speck far away, and copies of it into each part."""
    ninths = [[[1 / 2, 0, x / 4], [0, 1 / 2, y / 4]] for x in range(3) for y in range(3)]
    speck = [[0.01, 0, 1.2], [0, 0.01, 0.5]]
    assert connectedness(IFS([*ninths, speck])).state == DISCONNECTED
    ifs = IFS([*ninths, speck], opacity=[0, 0, 0, 0, 1, 0, 0, 0, 0, 0])
    assert connectedness(ifs).state == DISCONNECTED, "the speck in the middle one is drawn"


def test_a_morph_that_hides_a_map_at_one_end_is_decided_as_it_is_drawn():
    hidden = replace(SHAPES["Koch curve"], opacity=[1, 0, 1, 1])
    morph = Morph(hidden, SHAPES["Koch curve"])
    check = check_frames(morph, np.column_stack([np.linspace(0, 1, 5)] * 2 + [np.zeros(5)]))
    assert check.state.tolist() == [DISCONNECTED] + [CONNECTED] * 4
    locus = compute_locus(morph, 13)
    assert (locus.state[:, locus.u <= 0] == DISCONNECTED).all()
    # A map that is behind the others on its own is hidden as long as it has not begun.
    behind = np.zeros((1, 11))
    behind[0, :2], behind[0, 4] = 0.5, -0.5
    assert check_frames(morph, behind).state.tolist() == [DISCONNECTED]
    assert not morph.at(np.array([0.5, 0, 0.5, 0.5]), 0.5).drawn[1]


@pytest.mark.parametrize(
    "transitions, said",
    [
        (np.ones((2, 2)), "shape"),
        (-np.ones((4, 4)), "negative"),
        (np.diag([1, 1, 1, 0]), "may be applied after map 4"),
        (np.array([[1, 1, 1, 0]] * 4), "map 4 may not be applied"),
        (np.full((4, 4), np.nan), "transitions of map 1"),
    ],
)
def test_transitions_that_make_no_sense_are_named(transitions, said):
    with pytest.raises(ValueError, match=said):
        recurrent(SQUARE, transitions)

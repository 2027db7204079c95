"""Keys moved and removed by hand."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.curve import Keys
from core.handles import move_key, remove_key

PLACE = st.tuples(st.floats(-2, 3), st.floats(-2, 3)).map(np.array)


def straight(values, times=None):
    values = np.array(values, dtype=float)
    thirds = np.diff(values, axis=0) / 3
    right = values + np.append(thirds, thirds[-1:], axis=0)
    left = values - np.insert(thirds, 0, thirds[0], axis=0)
    return Keys(np.arange(len(values)) / 1.0 if times is None else np.array(times), values, left, right)


def corner(before, key, after):
    """Cosine between the directions into and out of a key."""
    before, after = key - before, after - key
    return before @ after / np.linalg.norm(before) / np.linalg.norm(after)


@given(st.lists(PLACE, min_size=2, max_size=6), st.data())
def test_straight_paths_stay_straight(values, data):
    keys = straight(values)
    index = data.draw(st.integers(0, len(values) - 1))
    target = data.draw(PLACE)
    moved = move_key(keys, index, target)
    expected = np.array(values, dtype=float)
    expected[index] = target
    times = np.linspace(0, len(values) - 1, 50)
    joined = np.stack([np.interp(times, keys.time, expected[:, axis]) for axis in (0, 1)], axis=1)
    np.testing.assert_allclose(moved.at(times), joined, atol=3e-3)
    np.testing.assert_array_equal(keys.value, values)


@given(PLACE, st.integers(0, 2))
def test_handles_of_curved_pieces_go_with_their_key(target, index):
    keys = straight([(0, 0), (1, 0), (1, 1)])
    keys.handle_right[0] += (0.1, 0.4)
    keys.handle_left[1] += (0.3, 0.2)
    keys.handle_right[1] += (0.2, -0.3)
    keys.handle_left[2] += (0.3, 0.2)
    moved = move_key(keys, index, target)
    step = np.zeros((3, 2))
    step[index] = target - keys.value[index]
    for name in ("value", "handle_left", "handle_right"):
        np.testing.assert_allclose(getattr(moved, name), getattr(keys, name) + step, atol=1e-12)


@pytest.mark.parametrize("index", [0, 1])
def test_smooth_keys_stay_smooth_where_a_straight_piece_turns(index):
    """A straight piece that runs into a bend without a corner, as planned paths have it."""
    keys = straight([(0, 0), (1, 0), (2, 1)])
    keys.handle_right[1] = 1.5, 0.0
    keys.handle_left[2] = 2.0, 0.5
    moved = move_key(keys, index, np.array([0.3, 0.4]))
    np.testing.assert_allclose(moved.at(np.array([0.5])), [(moved.value[0] + moved.value[1]) / 2], atol=1e-9)
    assert corner(moved.handle_left[1], moved.value[1], moved.handle_right[1]) == pytest.approx(1)
    assert np.linalg.norm(moved.handle_right[1] - moved.value[1]) == pytest.approx(0.5)


def test_removing_a_key_of_a_straight_path_leaves_a_straight_one():
    left = remove_key(straight([(0, 0), (1, 0), (1, 1), (0, 1)]), 1)
    times = np.linspace(0, 3, 20)
    expected = np.stack([np.interp(times, [0, 2, 3], column) for column in ([0, 1, 0], [0, 1, 1])], axis=1)
    np.testing.assert_allclose(left.at(times), expected, atol=1e-12)


def test_removing_a_key_keeps_the_slopes_beside_it():
    keys = straight([(0, 0), (1, 0), (1, 1)], times=(0.0, 1.0, 3.0))
    keys.handle_right[0] = 0.0, 0.5
    left = remove_key(keys, 1)
    assert len(left.time) == 2
    step = 1e-6
    for time, sign in ((0.0, 1), (3.0, -1)):
        times = np.array([time, time + sign * step])
        np.testing.assert_allclose(np.diff(left.at(times), axis=0), np.diff(keys.at(times), axis=0), atol=1e-10)


@pytest.mark.parametrize("index", [0, 2])
def test_removing_an_end_leaves_the_rest_as_it_was(index):
    keys = straight([(0, 0), (1, 0), (1, 1)])
    left = remove_key(keys, index)
    times = np.linspace(1, 2, 5) if index == 0 else np.linspace(0, 1, 5)
    np.testing.assert_allclose(left.at(times), keys.at(times), atol=1e-12)

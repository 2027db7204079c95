"""Keys of a Bezier path moved and removed by hand: what was straight stays straight, what was smooth stays smooth."""

from __future__ import annotations

import numpy as np

from .curve import Keys

STRAIGHT = 1e-3
"""A handle this close to its chord, as a share of the chord's length, lies on it."""

SMOOTH = 0.9999
"""Least cosine between the two handles of a smooth key."""


def move_key(keys: Keys, index: int, value: np.ndarray) -> Keys:
    """Move a key of a path in the plane to another place, at the same time.

    Straight pieces beside it stay straight. Elsewhere its handles go with it, and a smooth key with a straight piece on
    one side turns its other handle with that piece.

    Parameters
    ----------
    keys : Keys
        With values (K, 2).
    index : int
    value : (2,)
        The new place.

    Returns
    -------
    Keys
    """
    moved = Keys(keys.time, keys.value.copy(), keys.handle_left.copy(), keys.handle_right.copy())
    step = np.asarray(value, dtype=float) - keys.value[index]
    for array in (moved.value, moved.handle_left, moved.handle_right):
        array[index] += step
    straight = {piece for piece in (index - 1, index) if _is_straight(keys, piece)}
    for piece in straight:
        _straighten(moved, piece)
    for key in range(max(index - 1, 0), min(index + 2, len(keys.time))):
        if _is_smooth(keys, key):
            if key - 1 in straight and not _is_straight(keys, key):
                _turn(moved.handle_right, moved.value[key] - moved.handle_left[key], moved, key)
            if key in straight and not _is_straight(keys, key - 1):
                _turn(moved.handle_left, moved.value[key] - moved.handle_right[key], moved, key)
    return moved


def remove_key(keys: Keys, index: int) -> Keys:
    """Remove a key; the piece in its place keeps the slopes at its ends, and is straight if both in its place were."""
    straight = _is_straight(keys, index - 1) and _is_straight(keys, index)
    arrays = keys.time, keys.value, keys.handle_left, keys.handle_right
    rest = Keys(*(np.delete(array, index, axis=0) for array in arrays))
    if not 0 < index < len(keys.time) - 1:
        return rest
    whole = keys.time[index + 1] - keys.time[index - 1]
    first, second = index - 1, index
    if straight:
        _straighten(rest, first)
        return rest
    # A handle lies a third of its piece away, so that on a longer piece the same slope takes it further.
    longer = whole / (keys.time[index] - keys.time[index - 1]), whole / (keys.time[index + 1] - keys.time[index])
    rest.handle_right[first] = rest.value[first] + longer[0] * (rest.handle_right[first] - rest.value[first])
    rest.handle_left[second] = rest.value[second] + longer[1] * (rest.handle_left[second] - rest.value[second])
    return rest


def _is_straight(keys: Keys, piece: int) -> bool:
    """Whether both handles of a piece lie at the thirds of its chord; False where there is no such piece."""
    if not 0 <= piece < len(keys.time) - 1:
        return False
    start, end = keys.value[piece], keys.value[piece + 1]
    off = np.abs(
        [keys.handle_right[piece] - (2 * start + end) / 3, keys.handle_left[piece + 1] - (start + 2 * end) / 3]
    )
    return bool(off.max() <= STRAIGHT * np.abs(end - start).max() + 1e-6)


def _straighten(keys: Keys, piece: int) -> None:
    start, end = keys.value[piece], keys.value[piece + 1]
    keys.handle_right[piece] = (2 * start + end) / 3
    keys.handle_left[piece + 1] = (start + 2 * end) / 3


def _is_smooth(keys: Keys, key: int) -> bool:
    """Whether the path runs through a key without a corner."""
    before, after = keys.value[key] - keys.handle_left[key], keys.handle_right[key] - keys.value[key]
    lengths = np.linalg.norm(before) * np.linalg.norm(after)
    return bool(lengths > 0 and before @ after >= SMOOTH * lengths)


def _turn(handles: np.ndarray, direction: np.ndarray, keys: Keys, key: int) -> None:
    """Turn a handle of a key into a direction, at the length that it has."""
    size = np.linalg.norm(direction)
    if size > 0:
        handles[key] = keys.value[key] + np.linalg.norm(handles[key] - keys.value[key]) / size * direction

"""Curves through keys in time, the cubic Bezier curves that an F-curve has."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, eq=False)
class Keys:
    """Keys of a cubic Bezier curve in time, as an F-curve has them.

    The handles lie at exactly a third of the interval in time, so that time is linear along each piece.

    Attributes
    ----------
    time : (K,)
        Ascending.
    value, handle_left, handle_right : (K, ...)
        Values of the keys and of the handles before and after them.
    """

    time: np.ndarray
    value: np.ndarray
    handle_left: np.ndarray
    handle_right: np.ndarray

    def at(self, t: np.ndarray) -> np.ndarray:
        """Values at the times t (F,), held at the first and the last key."""
        t = np.clip(t, self.time[0], self.time[-1])
        k = np.clip(np.searchsorted(self.time, t, side="right") - 1, 0, len(self.time) - 2)
        x = (t - self.time[k]) / (self.time[k + 1] - self.time[k])
        x = x.reshape(x.shape + (1,) * (self.value.ndim - 1))
        return bezier(self.value[k], self.handle_right[k], self.handle_left[k + 1], self.value[k + 1], x)


def smooth_keys(time: np.ndarray, value: np.ndarray) -> Keys:
    """Keys of a smooth curve that does not overshoot, through values (K, ...) at times (K,)."""
    slope = slopes(time, value)
    column = (-1,) + (1,) * (value.ndim - 1)
    before = np.diff(time, prepend=time[0]).reshape(column)
    after = np.diff(time, append=time[-1]).reshape(column)
    return Keys(time, value, value - slope * before / 3, value + slope * after / 3)


def slopes(times: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Slopes (K, ...) at keys of a curve that does not overshoot.

    They are harmonic means of those on both sides (Fritsch & Butland 1984).
    """
    secants = np.diff(values, axis=0) / np.diff(times).reshape((-1,) + (1,) * (values.ndim - 1))
    found = np.zeros(values.shape)
    before, after = secants[:-1], secants[1:]
    rising = before * after > 0
    found[1:-1][rising] = 2 * before[rising] * after[rising] / (before[rising] + after[rising])
    return found


def bezier(p0: np.ndarray, p1: np.ndarray, p2: np.ndarray, p3: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Cubic with control values p0 to p3, at x in [0, 1]; equal controls give themselves, and ends are exact."""
    inside = p0 + x * (3 * (p1 - p0) + x * (3 * (p0 - 2 * p1 + p2) + x * (p3 - p0 + 3 * (p1 - p2))))
    return np.where(x == 1, p3, inside)

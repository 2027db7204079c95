"""Decides attractors by the kernels for the plane, for recurrent shapes or for space, whichever their maps ask for."""

from __future__ import annotations

from collections.abc import Generator

import numpy as np

from . import decision
from .recurrent import decide_recurrent
from .space import decision as space_decision
from .states import CONNECTED

Decided = tuple[np.ndarray, np.ndarray, np.ndarray]


def column_steps(
    linear: np.ndarray,
    start: np.ndarray,
    drift: np.ndarray,
    along: np.ndarray,
    allowed: np.ndarray,
    tolerance: float,
    with_gap: bool,
) -> Generator[None, None, Decided]:
    """States of attractors that share their linear parts, as those of one u do, in steps of a few milliseconds.

    Parameters
    ----------
    linear : (N, 4), or (N, 9) in space
    start, drift : (N, 2), or (N, 3)
    along : (V,)
        The translations of attractor k are ``start + along[k] * drift``.
    allowed : (N + 1, N) bool
        See `IFS.allowed`. In space all letters follow all.
    tolerance : float
        Relative to the enclosing diameter.
    with_gap : bool
        Whether to measure the gaps.

    Returns
    -------
    state : (V,) uint8
    gap : (V, 2)
        Brackets relative to the enclosing diameter; NaN where there is no attractor or the gap was not asked for.
    labels : (V, N) int64
        Components of attractorlets that are known to meet.
    """
    nodes, count = len(along), len(linear)
    state, gap, labels = np.empty(nodes, np.uint8), np.empty((nodes, 2)), np.empty((nodes, count), np.int64)
    if not allowed.all():
        for node in range(nodes):
            translation = start + along[node] * drift
            one = decide_frames(linear[None], translation[None], allowed[None], tolerance, with_gap)
            state[node], gap[node], labels[node] = (each[0] for each in one)
            yield
        return state, gap, labels
    kernels = space_decision if _in_space(start) else decision
    desk, done = kernels.empty_desk(count), 0
    while done < nodes:
        done = kernels.decide_drift(
            desk, linear, start, drift, along, float(tolerance), bool(with_gap), done, state, gap, labels
        )
        yield
    return state, gap, labels


def decide_frames(
    linear: np.ndarray, translation: np.ndarray, allowed: np.ndarray, tolerance: float, with_gap: bool
) -> Decided:
    """States of attractors of any maps, such as the frames of a path.

    Parameters
    ----------
    linear : (F, N, 4), or (F, N, 9) in space
    translation : (F, N, 2), or (F, N, 3)
    allowed : (F, N + 1, N) bool
    tolerance, with_gap
        As above.

    Returns
    -------
    As `column_steps`.
    """
    tolerance, with_gap = float(tolerance), bool(with_gap)
    if _in_space(translation):
        drawn = np.ascontiguousarray(allowed[:, -1])
        return space_decision.decide_each(linear, translation, drawn, tolerance, with_gap)
    # Two kernels, for few who use the one ever need the other, and compiling takes its time.
    if allowed.all():
        return decision.decide_each(linear, translation, tolerance, with_gap)
    return decide_recurrent(linear, translation, np.ascontiguousarray(allowed), tolerance, with_gap)


def are_connected(
    linear: np.ndarray,
    translation: np.ndarray,
    allowed: np.ndarray,
    tolerance: float,
    tolerated: np.ndarray | float = 0.0,
) -> np.ndarray:
    """Which of some attractors (F,) are connected at the tolerance, or gape by no more than is `tolerated` (F,).

    Other arguments as in `decide_frames`.
    """
    with_gap = bool(np.any(tolerated > tolerance))
    state, gap, _ = decide_frames(linear, translation, allowed, tolerance, with_gap)
    return (state == CONNECTED) | (gap[:, 1] <= tolerated)


def _in_space(translation: np.ndarray) -> bool:
    return translation.shape[-1] == 3

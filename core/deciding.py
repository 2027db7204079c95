"""Decides attractors by the kernels for the plane or those for space, whichever their maps act on."""

from __future__ import annotations

from collections.abc import Generator

import numpy as np

from . import decision
from .space import decision as space_decision
from .states import CONNECTED


def column_steps(
    linear: np.ndarray,
    start: np.ndarray,
    drift: np.ndarray,
    along: np.ndarray,
    follows: np.ndarray,
    tolerance: float,
    with_gap: bool,
) -> Generator[None, None, tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """States, gaps and labels of attractors that share their linear parts: see `decision.column_steps`.

    In space linear parts are (N, 9), translations (N, 3), and all letters follow all.
    """
    if start.shape[-1] == 2:
        return decision.column_steps(linear, start, drift, along, follows, tolerance, with_gap)
    return space_decision.column_steps(linear, start, drift, along, tolerance, with_gap)


def decide_frames(
    linear: np.ndarray, translation: np.ndarray, follows: np.ndarray, tolerance: float, with_gap: bool
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """States, gaps and labels of the attractors of any maps: see `decision.decide_frames`."""
    if translation.shape[-1] == 2:
        return decision.decide_frames(linear, translation, follows, tolerance, with_gap)
    return space_decision.decide_frames(linear, translation, tolerance, with_gap)


def are_connected(linear: np.ndarray, translation: np.ndarray, follows: np.ndarray, tolerance: float) -> np.ndarray:
    """Which of some attractors (F,) are connected at the tolerance; arguments as in `decide_frames`."""
    return decide_frames(linear, translation, follows, tolerance, False)[0] == CONNECTED

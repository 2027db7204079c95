"""What gaps are tolerated between two shapes: where an end is in pieces itself, its own, ever less on the way.

A shape that begins in pieces would else have to become whole between the first frame and the second.
"""

from __future__ import annotations

import numpy as np

from .connectedness import Connectedness, connectedness
from .ifs import IFS

SLACK = 1.1
"""By how much more than the gap of an end is tolerated, so that what is like the end passes for certain."""


def tolerated_at_ends(shapes: tuple[IFS, IFS], tolerance: float) -> np.ndarray:
    """Gaps (2,) that are tolerated at the two ends of a morph; between them it is what lies between.

    Parameters
    ----------
    shapes : (IFS, IFS)
        The two ends.
    tolerance : float
        What is tolerated anyway, relative to the enclosing diameter as all gaps are.
    """
    return np.array([_tolerated(ifs, tolerance) for ifs in shapes])


def tolerated_gaps(at_ends: np.ndarray, times: np.ndarray) -> np.ndarray:
    """Gaps (F,) that are tolerated at the times (F,), 0 and 1 being the ends."""
    return np.interp(times, [0.0, 1.0], at_ends)


def _tolerated(ifs: IFS, tolerance: float) -> float:
    verdict = connectedness(ifs, tolerance)
    return max(tolerance, SLACK * verdict.gap[1]) if verdict.state == Connectedness.DISCONNECTED else tolerance

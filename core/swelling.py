"""How much a morph must swell to stay in one piece: least swell, and a smooth curve above it."""

from __future__ import annotations

from collections.abc import Generator

import numpy as np

from . import parallel
from .connectedness import Connectedness
from .curve import smooth_keys
from .deciding import are_connected, column_steps
from .morph import Morph
from .report import family

LEVELS = 64
"""Swell is tried at 0, 1/64, 2/64 ... 1, and the first that works is the least: more may be worse, for connectedness
is not monotone in swell."""

STRIDE, LONG_STRIDE = 1, 8
"""By how many of these at a time it is looked for the first; the latter where a look takes long, which is in space and
where shapes are recurrent or hide maps."""

NEVER = 2.0
"""Least swell where no swell up to 1 is known to work."""

CHUNK = 8


def least_swell_steps(
    morph: Morph,
    places: np.ndarray,
    tolerance: float,
    at_least: np.ndarray | float = 0.0,
    threads: int | None = None,
    tolerated: np.ndarray | float = 0.0,
) -> Generator[float, None, np.ndarray]:
    """Least swell (F,) that makes the shape connected at each of some places, from `at_least` on; in steps.

    Places are as `morph.spread` takes them; the swell in them does not count. Gaps up to `tolerated` are let pass.
    """
    start, tolerated = (np.broadcast_to(each, len(places)) for each in (at_least, tolerated))

    def search(first: int) -> list[float]:
        chunk = range(first, min(first + CHUNK, len(places)))
        return [_least(morph, places[k], start[k], tolerance, tolerated[k]) for k in chunk]

    found = yield from parallel.steps(search, range(0, len(places), CHUNK), threads)
    return np.concatenate(found) if found else np.empty(0)


def _least(morph: Morph, place: np.ndarray, start: float, tolerance: float, tolerated: float) -> float:
    swells = np.append(start, np.arange(np.floor(start * LEVELS) + 1, LEVELS + 1) / LEVELS)
    places = np.tile(place, (len(swells), 1))
    places[:, 2] = swells
    linear, translation, allowed = family(morph, places)

    def holds(k: int) -> bool:
        here = slice(k, k + 1)
        return bool(are_connected(linear[here], translation[here], allowed[here], tolerance, tolerated)[0])

    stride = STRIDE if morph.DIMENSION == 2 and allowed.all() else LONG_STRIDE
    for found in sorted({*range(0, len(swells), stride), len(swells) - 1}):
        if holds(found):
            # Back over what was passed by, by halves.
            low, high = max(-1, found - stride), found
            while high - low > 1:
                middle = (low + high) // 2
                low, high = (low, middle) if holds(middle) else (middle, high)
            return float(swells[high])
    return NEVER


def least_swell_field_steps(
    morph: Morph,
    u: np.ndarray,
    v: np.ndarray,
    tolerance: float,
    levels: int = 16,
    threads: int | None = None,
    tolerated: np.ndarray | float = 0.0,
) -> Generator[float, None, np.ndarray]:
    """Least swell (V, U) over a grid, to the next of `levels`; infinite where there is no attractor; in steps.

    Gaps up to `tolerated` (U,) are let pass.
    """
    tolerated = np.broadcast_to(tolerated, len(u))
    swells = np.arange(levels + 1) / levels
    linear = np.ascontiguousarray(morph.linear(u[:, None, None], swells[:, None]))
    linear = linear.reshape(len(u), levels + 1, morph.count, -1)
    start = morph.translation(0.0)
    drift = morph.translation(1.0) - start
    allowed = morph.allowed_at(u[:, None])

    def column(k: int) -> Generator[None, None, np.ndarray]:
        least = np.full(len(v), NEVER)
        still = np.arange(len(v))
        for level, swell in enumerate(swells):
            state, gap, _ = yield from column_steps(
                linear[k, level], start, drift, v[still], allowed[k], tolerance, tolerated[k] > tolerance
            )
            holds = (state == Connectedness.CONNECTED) | (gap[:, 1] <= tolerated[k])
            least[still[holds]] = swell
            if level == 0:
                least[still[state == Connectedness.NO_ATTRACTOR]] = np.inf
            still = still[~holds & (state != Connectedness.NO_ATTRACTOR)]
            if len(still) == 0:
                break
        return least

    columns = yield from parallel.steps(column, range(len(u)), threads)
    return np.stack(columns, axis=1)


def envelope(needed: np.ndarray, spacing: int) -> tuple[np.ndarray, np.ndarray]:
    """Keys of a smooth curve that is nowhere below `needed`.

    A curve without overshoot through keys each as high as anything up to both its neighbours cannot dip below. The
    ends keep their own values, so near them keys are added where the curve would be too low.

    Parameters
    ----------
    needed : (F,)
        Least swell of each frame.
    spacing : int
        Frames between keys.

    Returns
    -------
    frame : (K,) int
    swell : (K,)
    """
    last = len(needed) - 1
    keys = {0: needed[0], last: needed[last]}
    if not needed.any():
        return np.array([0, last]), np.array([needed[0], needed[last]])
    for frame in range(spacing, last - spacing // 2, spacing):
        keys[frame] = needed[max(1, frame - spacing) : min(last, frame + spacing + 1)].max()
    every = np.arange(last + 1)
    while True:
        frames = np.array(sorted(keys))
        swells = np.array([keys[k] for k in frames])
        missing = needed - smooth_keys(frames, swells).at(every)
        worst = int(np.argmax(missing))
        if missing[worst] <= 1e-9:
            break
        # A new key changes the slopes beside it, so all frames are looked at again.
        keys[worst] = needed[worst]
    # A key level with both its neighbours changes nothing.
    level = np.zeros(len(frames), dtype=bool)
    level[1:-1] = (swells[1:-1] == swells[:-2]) & (swells[1:-1] == swells[2:])
    return frames[~level], swells[~level]

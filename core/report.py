"""Frame by frame, is the morph in one piece? And what that comes to, in numbers and in plain words."""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass

import numpy as np

from . import parallel
from .connectedness import Connectedness, connectedness
from .deciding import decide_frames
from .morph import Morph, spread

CHUNK = 16
"""Frames checked in one chunk of work."""


@dataclass(frozen=True, eq=False)
class FrameCheck:
    """The states of a run of frames.

    Attributes
    ----------
    uv_swell : (F, 3) or (F, 3 + 2N)
        What was checked: a place of each frame, see `morph.spread`.
    state : (F,) uint8
        Values of `Connectedness`.
    gap : (F, 2)
        Brackets relative to the enclosing diameter; NaN without an attractor.
    tolerance : float
    widest : float
        Length of the widest gap of a disconnected frame, in units of the plane; 0 if there is none.
    """

    uv_swell: np.ndarray
    state: np.ndarray
    gap: np.ndarray
    tolerance: float
    widest: float = 0.0

    def count(self, state: Connectedness) -> int:
        """Frames that have this state."""
        return int(np.count_nonzero(self.state == state))

    @property
    def share_disconnected(self) -> float:
        """Share of the frames in which the shape is in pieces, or has no attractor at all."""
        broken = self.count(Connectedness.DISCONNECTED) + self.count(Connectedness.NO_ATTRACTOR)
        return broken / len(self.state)

    @property
    def worst_gap(self) -> float:
        """The widest gap of a disconnected frame, relative to the enclosing diameter; 0 if there is none."""
        gaps = self.gap[self.state == Connectedness.DISCONNECTED]
        return float(gaps.mean(axis=1).max()) if len(gaps) else 0.0

    @property
    def most_swell(self) -> float:
        """The greatest swell of a frame."""
        return float(self.uv_swell[:, 2].max())

    @property
    def mean_swell(self) -> float:
        """The mean swell over the frames."""
        return float(self.uv_swell[:, 2].mean())

    def gap_text(self, pixel: float | None = None) -> str:
        """The widest gap in words, also in pixels of a picture if the length of one in the plane is given."""
        words = f"the widest gap {100 * self.worst_gap:.1f}% of the shape's size"
        return words if pixel is None else f"{words} or {self.widest / pixel:.1f} pixels"

    def text(self, pixel: float | None = None) -> str:
        """What was found, in a plain sentence or two, a line each; `pixel` as for `gap_text`."""
        return "\n".join([_sentence("The keyed path", self, pixel), *_swell_sentences(self)])


@dataclass(frozen=True, eq=False)
class PathReport:
    """What a path costs, beside the straight line from (0,0) to (1,1) without swell.

    Attributes
    ----------
    path, straight : FrameCheck
        Frame by frame.
    tolerated : (F,)
        Gaps of the frames that are let pass, see `tolerated`.
    method : str
        How the path was found, one of `path.METHODS`.
    reason : str
        A sentence on why it is as it is, or nothing.
    flips : tuple of int
        Maps that reflect at one end only and pass through a line, in space through a plane (see `Morph.flips`).
    turned_over : tuple of int
        Maps that reflect at one end only and turn over through space (see `Morph.turned_over`).
    """

    path: FrameCheck
    straight: FrameCheck
    tolerated: np.ndarray
    method: str
    reason: str
    flips: tuple[int, ...]
    turned_over: tuple[int, ...] = ()

    def text(self, pixel: float | None = None, names: Sequence[str] = ()) -> str:
        """The report in a few plain sentences, a line each.

        Parameters
        ----------
        pixel : float, optional
            As for `FrameCheck.gap_text`.
        names : sequence of str
            Of the maps; “map 1” and so on if there are none.
        """
        lines = [_sentence("The path", self.path, pixel)]
        if self.reason:
            lines.append(self.reason)
        lines += self._failures()
        lines += _swell_sentences(self.path)
        if self.method != "straight unswollen":
            lines.append(_sentence("The straight line without swell", self.straight, pixel))
        for done, flipped in (("Flattened half-way", self.flips), ("Turned over through space", self.turned_over)):
            if flipped:
                maps = ", ".join(names[i] if names else f"map {i + 1}" for i in flipped)
                lines.append(f"{done}, since only one end reflects: {maps}.")
        return "\n".join(lines)

    @property
    def broken(self) -> int:
        """Frames that are neither known to be in one piece nor let pass."""
        passed = (self.tolerated > self.path.tolerance) & (self.path.gap[:, 0] <= self.tolerated)
        return int(np.count_nonzero((self.path.state != Connectedness.CONNECTED) & ~passed))

    def _failures(self) -> list[str]:
        """What swell could not mend, or was not to."""
        state, lines = self.path.state, []
        ends = [name for name, at in (("initial", 0), ("final", -1)) if state[at] != Connectedness.CONNECTED]
        if ends:
            lines.append(f"The {' and the '.join(ends)} shape is not in one piece itself.")
        if (self.tolerated > self.path.tolerance).any():
            lines.append("Gaps as wide as there are let pass on the way, less and less towards the other end.")
        undecided_ends = np.count_nonzero(state[[0, -1]] == Connectedness.UNDECIDED)
        if self.method != "straight unswollen" and self.broken > undecided_ends:
            lines.append(f"At {self.broken - undecided_ends} frames no swell was found that mends the shape.")
        return lines


def check_frames(
    morph: Morph,
    uv_swell: np.ndarray,
    tolerance: float = 1 / 300,
    threads: int | None = None,
    progress: Callable[[float], bool | None] | None = None,
) -> FrameCheck:
    """Decide for each frame whether the shape is in one piece.

    Parameters
    ----------
    morph : Morph
    uv_swell : (F, 3) or (F, 3 + 2N)
        A place of each frame, see `morph.spread`.
    tolerance : float
        Relative to the enclosing diameter of each frame's attractor.

    Raises
    ------
    ValueError
        If there are no frames.
    """
    return parallel.finish(check_frames_steps(morph, uv_swell, tolerance, threads), progress)


def check_frames_steps(
    morph: Morph, uv_swell: np.ndarray, tolerance: float = 1 / 300, threads: int | None = None
) -> Generator[float, None, FrameCheck]:
    """`check_frames` in steps, each yielding the share done."""
    uv_swell = np.asarray(uv_swell, dtype=float)
    if len(uv_swell) == 0:
        raise ValueError("There are no frames to check.")
    linear, translation, allowed = family(morph, uv_swell)

    def check(start: int) -> tuple[np.ndarray, np.ndarray]:
        frames = slice(start, start + CHUNK)
        return decide_frames(linear[frames], translation[frames], allowed[frames], float(tolerance), True)[:2]

    chunks = yield from parallel.steps(check, range(0, len(uv_swell), CHUNK), threads)
    state, gap = (np.concatenate([chunk[k] for chunk in chunks]) for k in (0, 1))
    for end, shape in enumerate(morph.shapes):
        there = (uv_swell[:, :3] == (end, end, 0)).all(axis=1) & ~uv_swell[:, 3:].any(axis=1)
        there &= state == Connectedness.UNDECIDED
        if there.any():
            # The shape is easier to decide as it was before its maps were split or listed again.
            verdict = connectedness(shape, tolerance)
            state[there], gap[there] = verdict.state, verdict.gap
    return FrameCheck(uv_swell, state, gap, float(tolerance), _widest(morph, uv_swell, state, gap))


def _widest(morph: Morph, uv_swell: np.ndarray, state: np.ndarray, gap: np.ndarray) -> float:
    """Length of the widest gap, as a share of its shape the widest as well."""
    gaps = np.where(state == Connectedness.DISCONNECTED, gap.mean(axis=1), 0.0)
    frame = int(np.argmax(gaps))
    if gaps[frame] == 0:
        return 0.0
    _, radius = morph.at(*spread(uv_swell[frame], morph.count)).enclosing_disc
    return float(gaps[frame] * 2 * radius)


def family(morph: Morph, places: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Linear parts (F, N, 4), translations (F, N, 2), and `IFS.allowed` (F, N + 1, N), as kernels take them.

    At places (F, 3) or (F, 3 + 2N), see `morph.spread`. In space linear parts are (F, N, 9) and translations (F, N, 3).
    """
    u, v, swell = spread(places, morph.count)
    linear = np.ascontiguousarray(morph.linear(u, swell)).reshape(len(places), morph.count, morph.DIMENSION**2)
    return linear, np.ascontiguousarray(morph.translation(v)), morph.allowed_at(u)


def _sentence(subject: str, check: FrameCheck, pixel: float | None) -> str:
    frames = len(check.state)
    pixels = round(1 / check.tolerance)
    broken = check.count(Connectedness.DISCONNECTED)
    parts = []
    if broken:
        parts.append(f"{broken} in pieces ({100 * broken / frames:.0f}%, {check.gap_text(pixel)})")
    if check.count(Connectedness.UNDECIDED):
        parts.append(f"{check.count(Connectedness.UNDECIDED)} undecided")
    if check.count(Connectedness.NO_ATTRACTOR):
        parts.append(f"{check.count(Connectedness.NO_ATTRACTOR)} without an attractor")
    connected = check.count(Connectedness.CONNECTED)
    whole = f"{connected if parts else 'all'} in one piece ({100 * connected / frames:.0f}%)"
    parts.insert(0, whole)
    return f"{subject}: {frames} frames, {', '.join(parts)}, at 1/{pixels} of the shape's size."


def _swell_sentences(check: FrameCheck) -> list[str]:
    if check.most_swell == 0:
        return []
    return [f"Swell: {check.most_swell:.2f} at most, {check.mean_swell:.3f} on average."]

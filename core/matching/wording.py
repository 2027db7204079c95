"""Symmetries in words, and words as they are written."""

from __future__ import annotations

import numpy as np

from ..affine import determinant
from ..joining import Word
from ..space.affine import axis_and_angle
from .pairs import Symmetry

ROUND = 1e-3
"""Components of an axis that are this close to whole numbers are these."""

LARGEST = 5
"""Of the whole numbers by which an axis is named."""


def word_text(word: Word) -> str:
    """The letters of a word, counted from 1."""
    return " ".join(str(letter + 1) for letter in word)


def symmetry_text(symmetry: Symmetry | None) -> str:
    """A symmetry in words, nothing for the identity.

    ``turned by 120°`` or ``mirrored at 90°``; in space ``turned by 120° about (1, 1, 1)``,
    ``mirrored along (1, 0, 0)``, or both, ``turned by 90° about (0, 0, 1) and mirrored along it``.
    """
    if symmetry is None:
        return "any"
    linear = np.array(symmetry)[:, :-1]
    reflects = determinant(linear) < 0
    if len(linear) == 3:
        return _in_space(linear, reflects)
    degrees = _degrees(np.arctan2(linear[1, 0], linear[0, 0]))
    if reflects:
        # The axis lies at half the angle.
        return f"mirrored at {degrees / 2 % 180:g}°"
    return f"turned by {degrees:g}°" if degrees else ""


def _in_space(linear: np.ndarray, reflects: bool) -> str:
    # A turn with a mirroring is minus a turn, one by half a turn more or less.
    (axis,), (angle,) = axis_and_angle((-linear if reflects else linear)[None])
    if reflects:
        angle = np.remainder(angle, 2 * np.pi) - np.pi
    degrees = _degrees(angle)
    if reflects and degrees == 180:
        return "mirrored through its middle"
    turn = f"turned by {degrees:g}° about {_direction(axis)}" if degrees else ""
    if not reflects:
        return turn
    return f"{turn} and mirrored along it" if turn else f"mirrored along {_direction(axis)}"


def _degrees(angle: float) -> float:
    """An angle to a tenth of a degree; half a turn is the same both ways."""
    degrees = round(float(np.degrees(angle)), 1)
    return 180.0 if degrees == -180 else degrees


def _direction(axis: np.ndarray) -> str:
    """An axis by three numbers, whole and small ones if there are."""
    scaled = axis / np.abs(axis).max()
    for factor in range(1, LARGEST + 1):
        whole = np.round(scaled * factor)
        if np.abs(scaled * factor - whole).max() < ROUND * factor:
            return f"({', '.join(f'{number:.0f}' for number in whole + 0.0)})"
    return f"({', '.join(f'{number:.2f}' for number in np.round(scaled, 2) + 0.0)})"

"""Flames made symmetric by maps that only turn or mirror, as contractive IFSs with the same attractor and measure.

Such a flame has maps w_i and isometries g about the origin beside them. It draws the measure mu with
``mu = sum p_i w_i mu + sum q_g g mu``. If the isometries generate a finite group G, that is the measure of the maps
``h w_i`` with the weights ``c_h p_i``, where ``c = (1 - sum q_g g)^-1`` is applied to the identity of the group; and
these maps contract where the w_i do.
"""

from __future__ import annotations

import numpy as np

LARGEST_GROUP = 48
LARGEST_ORDER = 24

ROUNDING = 1e-5
"""Flame programs write six digits."""


def symmetry_maps(kind: int) -> np.ndarray:
    """Linear parts (K, 2, 2) of the maps that ``<symmetry kind="...">`` adds, each with the weight 1.

    A kind of n adds the turns by multiples of 1/n, and -n the mirroring of x too; after `flam3_add_symmetry` of flam3.
    """
    order = abs(kind)
    turns = [_turn(k / order) for k in range(1, order)]
    mirror = [np.diag([-1.0, 1.0])] if kind < 0 else []
    return np.array([*mirror, *turns]).reshape(-1, 2, 2)


def isometry(matrix: np.ndarray) -> np.ndarray | None:
    """Return the turn or mirroring (2, 2) of finite order that a map (2, 3) is, rounding aside; None if it is none."""
    linear, translation = matrix[:, :2], matrix[:, 2]
    if np.abs(translation).max() > ROUNDING or np.abs(linear @ linear.T - np.eye(2)).max() > ROUNDING:
        return None
    share = np.arctan2(linear[1, 0], linear[0, 0]) / (2 * np.pi)
    reflects = np.linalg.det(linear) < 0
    for order in range(1, LARGEST_ORDER + 1):
        steps = round(share * order)
        if abs(share - steps / order) < ROUNDING:
            return _turn(steps / order) @ np.diag([1.0, -1.0 if reflects else 1.0])
    return None


def unfold(
    linear: np.ndarray, frequencies: np.ndarray, opacities: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray] | None:
    """Return the group that isometries generate, and how often each of its elements follows a map of the others.

    Parameters
    ----------
    linear : (K, 2, 2)
        The isometries.
    frequencies : (K,)
        Their probabilities q_g, together less than 1.
    opacities : (K,)
        Shares with which the points are drawn that an isometry is applied to last.

    Returns
    -------
    group : (G, 2, 2)
        Its elements, the identity first.
    shares : (G,)
        c_h, with the sum ``1 / (1 - sum q_g)``.
    seen : (G,)
        What is drawn of them by the isometries, ``sum q_g o_g c_k`` over those that take an element k to h.

    None if the group is larger than is sensible.
    """
    group = [np.eye(2)]
    for element in group:
        for generator in linear:
            product = generator @ element
            if _find(group, product) is None:
                group.append(product)
        if len(group) > LARGEST_GROUP:
            return None
    follow, drawn = np.zeros((2, len(group), len(group)))
    for generator, frequency, opacity in zip(linear, frequencies, opacities, strict=True):
        for k, element in enumerate(group):
            follow[_find(group, generator @ element), k] += frequency
            drawn[_find(group, generator @ element), k] += frequency * opacity
    shares = np.linalg.solve(np.eye(len(group)) - follow, np.eye(len(group))[0])
    return np.array(group), shares, drawn @ shares


def _turn(share: float) -> np.ndarray:
    angle = 2 * np.pi * share
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])


def _find(group: list[np.ndarray], element: np.ndarray) -> int | None:
    return next((k for k, other in enumerate(group) if np.abs(other - element).max() < 1e-9), None)

"""Symmetries in words."""

import numpy as np
import pytest

from core.matching import symmetry_text
from core.matching.symmetry import symmetries
from core.shapes import SHAPES
from core.space.affine import turned
from core.space.shapes import SPACE_SHAPES

DIAGONAL = np.ones(3) / 3**0.5


def text_of(linear):
    return symmetry_text(tuple(map(tuple, np.column_stack([linear, np.zeros(len(linear))]).tolist())))


def test_symmetries_have_names():
    texts = {text_of(symmetry[:, :2]) for symmetry in symmetries(SHAPES["square"])}
    assert {"", "turned by 90°", "turned by -90°", "turned by 180°", "mirrored at 0°", "mirrored at 90°"} <= texts
    assert symmetry_text(None) == "any"


@pytest.mark.parametrize(
    ("linear", "text"),
    [
        (np.eye(3), ""),
        (turned(DIAGONAL, np.array(2 * np.pi / 3)), "turned by 120° about (1, 1, 1)"),
        (turned(np.array([0, 0, 1.0]), np.array(-np.pi / 2)), "turned by -90° about (0, 0, 1)"),
        (np.diag([1.0, -1, -1]), "turned by 180° about (1, 0, 0)"),
        (np.diag([1.0, -1, 1]), "mirrored along (0, 1, 0)"),
        (-np.eye(3), "mirrored through its middle"),
        (
            turned(np.array([0, 0, 1.0]), np.array(np.pi / 2)) @ np.diag([1.0, 1, -1]),
            "turned by 90° about (0, 0, 1) and mirrored along it",
        ),
        (turned(np.array([0.6, 0, 0.8]), np.array(1.0)), "turned by 57.3° about (3, 0, 4)"),
        (turned(np.array([0.48, 0.6, 0.64]), np.array(1.0)), "turned by 57.3° about (0.75, 0.94, 1.00)"),
    ],
)
def test_symmetries_of_space_have_names(linear, text):
    assert text_of(linear) == text


@pytest.mark.parametrize("name", ["Sierpinski tetrahedron", "cross in space", "pyramid"])
def test_no_two_have_the_same_name(name):
    found = symmetries(SPACE_SHAPES[name])
    assert len({text_of(symmetry[:, :3]) for symmetry in found}) == len(found)

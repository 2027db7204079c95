import numpy as np
import pytest
from scipy.spatial import cKDTree

from core.connectedness import Connectedness, connectedness
from core.shapes import SHAPES
from core.space.shapes import SPACE_SHAPES

from .reference import dense

DIMENSIONS = {
    "Sierpinski tetrahedron": 2,
    "turned tetrahedron": 2,
    "pyramid": np.log(5) / np.log(2),
    "octahedron flake": np.log(6) / np.log(2),
    "cross in space": np.log(7) / np.log(3),
    "Mosely snowflake": np.log(18) / np.log(3),
    "Menger sponge": np.log(20) / np.log(3),
}
"""Known from the literature."""


@pytest.mark.parametrize("name", SPACE_SHAPES)
def test_shapes_have_their_names_and_are_in_one_piece(name):
    assert SPACE_SHAPES[name].name == name
    assert connectedness(SPACE_SHAPES[name]).state == Connectedness.CONNECTED
    assert name not in SHAPES


@pytest.mark.parametrize("name", DIMENSIONS)
def test_dimensions(name):
    norms = SPACE_SHAPES[name].norms
    assert np.log(len(norms)) / -np.log(norms[0]) == pytest.approx(DIMENSIONS[name])
    assert norms == pytest.approx(np.full(len(norms), norms[0]))


def test_the_turned_tetrahedron_is_the_tetrahedron():
    plain, _, spacing = dense(SPACE_SHAPES["Sierpinski tetrahedron"].maps)
    other, _, _ = dense(SPACE_SHAPES["turned tetrahedron"].maps)
    assert cKDTree(plain).query(other)[0].max() <= spacing
    assert not np.allclose(SPACE_SHAPES["turned tetrahedron"].linear[0], np.eye(3) / 2)


def test_the_fern_stands_upright():
    _, bottom, _, _, top, _ = SPACE_SHAPES["fern in space"].bounds
    assert bottom == pytest.approx(0, abs=0.1)
    assert top > 5

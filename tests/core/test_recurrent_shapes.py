"""The library of recurrent shapes: in one piece, symmetric, and less than what they were without their rule."""

import numpy as np
import pytest

from core.connectedness import Connectedness, connectedness
from core.ifs import IFS
from core.recurrent_shapes import RECURRENT_SHAPES
from core.shapes import SHAPES
from core.space.shapes import SPACE_SHAPES
from tests.core.reference import allowed_points, hausdorff, recurrent_in_pieces

every_shape = pytest.mark.parametrize("name", RECURRENT_SHAPES)


@every_shape
def test_they_are_connected(name):
    ifs = RECURRENT_SHAPES[name]
    assert ifs.is_recurrent
    assert connectedness(ifs, 1e-4).state == Connectedness.CONNECTED
    assert not recurrent_in_pieces(ifs, 1e-3, 20_000)


@every_shape
def test_turned_by_a_corner_they_stay_the_same(name):
    ifs = RECURRENT_SHAPES[name]
    points, spacing = allowed_points(ifs)
    angle = 2 * np.pi / ifs.count
    turned = points @ np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    assert hausdorff(points, turned) <= 2 * spacing


@every_shape
def test_the_rule_leaves_something_out(name):
    ifs = RECURRENT_SHAPES[name]
    (points, spacing), (free, _) = allowed_points(ifs), allowed_points(IFS(ifs.maps))
    assert hausdorff(points, free) > 4 * spacing


def test_a_side_of_the_hollow_square_is_a_segment():
    points, spacing = allowed_points(RECURRENT_SHAPES["hollow square"], 20_000)
    low = points[points[:, 1] < points[:, 1].min() + 2 * spacing, 0]
    assert np.diff(np.sort(low)).max() <= 4 * spacing
    assert np.ptp(low) == pytest.approx(np.sqrt(2), abs=4 * spacing)


def test_every_shape_of_the_library_has_a_name_of_its_own():
    names = [*SHAPES, *RECURRENT_SHAPES, *SPACE_SHAPES]
    assert len(set(names)) == len(names)

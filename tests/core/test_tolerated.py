"""Shapes that are in pieces themselves may stay so on the way, less and less."""

import numpy as np
import pytest

from core.connectedness import Connectedness, connectedness
from core.deciding import are_connected
from core.ifs import IFS
from core.morph import Morph
from core.path import METHODS, plan_path
from core.shapes import SHAPES
from core.tolerated import tolerated_at_ends, tolerated_gaps

FINE = 1 / 300
DUST = IFS([[[0.3, 0, 0], [0, 0.3, 0]], [[0.3, 0, 0.7], [0, 0.3, 0]]])
UPRIGHT = IFS([[[0.3, 0, 0], [0, 0.3, 0]], [[0.3, 0, 0], [0, 0.3, 0.7]]])
SEGMENT = IFS([[[0.5, 0, 0], [0, 0.5, 0]], [[0.5, 0, 0.5], [0, 0.5, 0]]])


def test_shapes_in_one_piece_tolerate_nothing_more():
    assert tolerated_at_ends((SHAPES["gasket"], SHAPES["terdragon"]), FINE).tolist() == [FINE, FINE]


def test_a_shape_in_pieces_tolerates_its_own_gap():
    # Between 0.3 and 0.7 there is nothing, and the shape is 1 wide.
    first, last = tolerated_at_ends((DUST, SEGMENT), FINE)
    gap = connectedness(DUST).gap
    assert gap == pytest.approx((0.4, 0.4), rel=0.06)
    assert first == pytest.approx(1.1 * gap[1])
    assert last == FINE


def test_what_is_tolerated_counts_as_connected():
    maps = np.stack([DUST.maps, SEGMENT.maps, DUST.maps])
    parts = maps[..., :2].reshape(3, 2, 4), np.ascontiguousarray(maps[..., 2]), np.ones((3, 3, 2), dtype=bool)
    assert are_connected(*parts, FINE).tolist() == [False, True, False]
    assert are_connected(*parts, FINE, np.array([0.45, 0.0, 0.35])).tolist() == [True, True, False]


def test_between_the_ends_it_is_what_lies_between():
    gaps = tolerated_gaps(np.array([0.4, 0.1]), np.array([-1, 0, 0.5, 1, 2]))
    assert gaps == pytest.approx([0.4, 0.4, 0.25, 0.1, 0.1])


@pytest.mark.parametrize("method", [method for method in METHODS if method != "per map"])
def test_a_shape_in_pieces_that_stays_as_it_is_does_not_swell(method):
    report = plan_path(Morph(DUST, DUST), frames=24, method=method).report
    assert (report.path.most_swell, report.broken, report.path.count(Connectedness.DISCONNECTED)) == (0, 0, 24)
    assert "The initial and the final shape is not in one piece itself." in report.text()
    assert "let pass" in report.text()
    assert "no swell was found" not in report.text()


def test_dust_gathers_little_by_little():
    # The shapes between are turned, so that they fall apart further than either end.
    path = plan_path(Morph(DUST, UPRIGHT, winding=[1, 0]), frames=120, method="straight")
    swell = path.report.path.uv_swell[:, 2]
    assert np.abs(np.diff(swell)).max() < 0.1
    assert path.report.broken == 0


def test_what_gapes_more_than_the_ends_is_broken():
    report = plan_path(Morph(SHAPES["turned gasket"], SHAPES["gasket"]), frames=24, method="straight unswollen").report
    assert report.broken == report.path.count(Connectedness.DISCONNECTED) > 0
    assert "let pass" not in report.text()

"""The match of shapes in space: in one piece, no worse than the naive way, and what is locked stays."""

import numpy as np
import pytest

from core.cloud import point_cloud
from core.ifs import IFSError
from core.matching import Pair, match, morph_of_pairs
from core.matching.symmetry import symmetries
from core.shapes import SHAPES
from core.space.morph import SpaceMorph
from core.space.shapes import SPACE_SHAPES
from tests.core.space.reference import in_pieces

ALL = SHAPES | SPACE_SHAPES
MATCHES = {}
PAIRS = [
    ("turned tetrahedron", "Sierpinski tetrahedron"),
    ("pyramid", "turned tetrahedron"),
    ("gasket", "Sierpinski tetrahedron"),
]
every_pair = pytest.mark.parametrize("names", PAIRS, ids=" to ".join)


def match_of(names):
    if names not in MATCHES:
        MATCHES[names] = match(*(ALL[name] for name in names), frames=60, budget=100_000)
    return MATCHES[names]


@every_pair
def test_no_frame_is_in_pieces(names):
    found = match_of(names)
    assert isinstance(found.morph, SpaceMorph)
    assert found.report.disconnected == 0
    for t in np.linspace(0, 1, 60)[::12]:
        assert not in_pieces(found.morph.at(*found.path.at(t)).maps, 1 / 300)


@every_pair
def test_it_swells_no_more_than_the_straight_line(names):
    report = match_of(names).report
    assert report.most_swell <= report.straight_swell[0]
    assert report.mean_swell <= report.straight_swell[1]


@every_pair
def test_the_report_and_the_pairs_say_what_was_done(names):
    found = match_of(names)
    assert found.report.text().startswith(f"{len(found.pairs)} pairs of {ALL[names[0]].count} initial maps")
    again = morph_of_pairs(*(ALL[name] for name in names), found.pairs)
    for u in (0, 0.4, 1):
        assert np.array_equal(again.at(u, u).maps, found.morph.at(u, u).maps)


def test_a_turn_is_undone_by_a_symmetry():
    """The turned tetrahedron differs from the tetrahedron by a symmetry of one map alone."""
    assert match_of(PAIRS[0]).report.most_swell == 0


def test_it_is_the_same_again_with_any_number_of_threads():
    again = match(*(ALL[name] for name in PAIRS[1]), frames=60, budget=100_000, threads=1)
    assert again.pairs == match_of(PAIRS[1]).pairs


def test_locked_pairs_stay():
    names = PAIRS[0]
    turn = tuple(map(tuple, symmetries(ALL[names[1]])[5].tolist()))
    locked = (Pair((0,), (2,), None, turn, 1), Pair((1,), (0,), None, None, None))
    found = match(*(ALL[name] for name in names), frames=12, locked=locked, budget=20_000)
    assert (found.pairs[0].initial, found.pairs[0].final) == ((0,), (2,))
    assert (found.pairs[0].final_symmetry, found.pairs[0].winding) == (turn, 1)
    assert (found.pairs[1].initial, found.pairs[1].final) == ((1,), (0,))
    with pytest.raises(IFSError, match="no symmetry"):
        match(*(ALL[name] for name in names), frames=12, locked=[Pair((0,), (0,), ((0, 1, 0), (1, 0, 0)))])


def test_maps_of_the_plane_that_flip_turn_over():
    """Two maps of equal orientation to two of mixed, without a symmetry that helps."""
    mixed = SHAPES["Hata tree"].maps.copy()
    mixed[1, :, 1] *= -1
    found = match(type(SHAPES["gasket"])(mixed), SHAPES["Heighway dragon"], frames=24, budget=20_000, flip="turned")
    assert found.report.flips == found.report.path.turned_over != ()
    assert "Turned over through space" in found.report.text()
    for u in (0, 1):
        assert np.abs(point_cloud(found.morph.at(u, u), 2000).position[:, 2]).max() < 1e-6

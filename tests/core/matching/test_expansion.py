"""Splitting and doubling leave the attractor as it is."""

import pytest
from scipy.spatial import cKDTree

from core.ifs import IFS
from core.joining import word_map
from core.matching.expansion import is_cover, split_all, split_to, uncovered, word_weight
from core.shapes import SHAPES
from tests.core.reference import at, dense


@pytest.mark.parametrize("name", ["terdragon", "Hata tree", "Barnsley fern", "Lévy curve"])
@pytest.mark.parametrize("count", [1, 5, 9, 16])
def test_a_split_shape_is_the_same_shape(name, count):
    ifs = SHAPES[name]
    words = split_to(ifs, count)
    assert is_cover(ifs, words)
    assert len(words) <= max(count, ifs.count)
    assert sum(word_weight(ifs, word) for word in words) == pytest.approx(1)
    split = IFS([word_map(ifs, word) for word in words])
    (points, _, spacing), (others, _, other_spacing) = dense(ifs.maps), dense(split.maps)
    assert cKDTree(points).query(others)[0].max() <= spacing
    assert cKDTree(others).query(points)[0].max() <= other_spacing


def test_the_largest_piece_is_split_first():
    assert split_to(SHAPES["spiral"], 3) == [(0, 0), (0, 1), (1,)]
    assert split_to(SHAPES["gasket"], 5) == [(0, 0), (0, 1), (0, 2), (1,), (2,)]
    assert split_to(SHAPES["gasket"], 9) == split_all(SHAPES["gasket"])
    assert split_to(SHAPES["gasket"], 4) == [(0,), (1,), (2,)]


def test_the_last_letter_is_applied_first():
    fern = SHAPES["Barnsley fern"]
    point = [0.3, 0.7]
    assert at(word_map(fern, (1, 2)), point) == pytest.approx(at(fern.maps[1], at(fern.maps[2], point)))


@pytest.mark.parametrize(
    ("words", "whole"),
    [
        ([(0,), (1,)], True),
        ([(0,), (1,), (1,)], True),
        ([(0, 0), (0, 1), (1,)], True),
        ([(0,)], False),
        ([(0, 0), (1,)], False),
        ([(0,), (0, 0), (0, 1), (1,)], False),
        ([()], False),
    ],
)
def test_a_cover_has_every_piece(words, whole):
    assert is_cover(SHAPES["spiral"], words) == whole


@pytest.mark.parametrize(
    ("words", "missing"),
    [
        ([(0,), (1,)], []),
        ([], [(0,), (1,)]),
        ([(0,), (0,)], [(1,)]),
        ([(0, 1)], [(0, 0), (1,)]),
        ([(0, 1, 1), (1,)], [(0, 0), (0, 1, 0)]),
    ],
)
def test_what_is_missing_completes_a_cover(words, missing):
    assert uncovered(SHAPES["spiral"], words) == missing
    assert is_cover(SHAPES["spiral"], words + missing)

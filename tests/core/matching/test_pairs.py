"""Pairs: a morph made of them has the shapes for ends, and they survive being stored."""

import json
from functools import cache

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from core.ifs import IFSError
from core.matching import Pair, morph_of_pairs, pairs_from_plain, pairs_to_plain, symmetry_text
from core.matching.expansion import split_to
from core.matching.pairs import reversed_pairs
from core.matching.symmetry import symmetries
from core.shapes import SHAPES
from tests.core.reference import at, dense


def pairs_by_chance(initial, final, seed):
    random = np.random.default_rng(seed)
    words = [split_to(SHAPES[name], random.integers(1, 9)) for name in (initial, final)]
    count = max(map(len, words)) + random.integers(3)
    chosen = [[words[end][k % len(words[end])] for k in random.permutation(count)] for end in (0, 1)]
    gauges = [random.choice(symmetries_of(name), count).tolist() for name in (initial, final)]
    gauges = [[as_tuple(symmetry) for symmetry in each] for each in gauges]
    winding = random.integers(-1, 2, count)
    return tuple(Pair(*row[:4], int(row[4])) for row in zip(*chosen, *gauges, winding, strict=True))


def as_tuple(symmetry):
    return tuple(tuple(float(entry) for entry in row) for row in symmetry)


@cache
def symmetries_of(name):
    return symmetries(SHAPES[name])


@cache
def points_of(name):
    points, _, spacing = dense(SHAPES[name].maps, 3000)
    return points, spacing


chances = given(
    st.sampled_from(["gasket", "Hata tree", "square", "Barnsley tree"]),
    st.sampled_from(["Koch curve", "pentigasket", "terdragon"]),
    st.integers(0, 10**6),
)


@chances
def test_the_ends_of_the_morph_have_the_attractors_of_the_shapes(initial, final, seed):
    """The attractor is the one compact set that the maps take to itself together (Hutchinson 1981)."""
    morph = morph_of_pairs(SHAPES[initial], SHAPES[final], pairs_by_chance(initial, final, seed))
    for made, name in ((morph.initial, initial), (morph.final, final)):
        points, spacing = points_of(name)
        images = at(made.maps[:, None], points).reshape(-1, 2)
        assert cKDTree(points).query(images)[0].max() <= spacing + 1e-9
        assert cKDTree(images).query(points)[0].max() <= spacing + 1e-9


@chances
def test_doubled_pieces_share_their_weight(initial, final, seed):
    pairs = pairs_by_chance(initial, final, seed)
    morph = morph_of_pairs(SHAPES[initial], SHAPES[final], pairs)
    for first in range(SHAPES[initial].count):
        listed = [k for k, pair in enumerate(pairs) if pair.initial[0] == first]
        assert morph.initial.weights[listed].sum() == pytest.approx(SHAPES[initial].weights[first])


@chances
def test_pairs_survive_json(initial, final, seed):
    pairs = pairs_by_chance(initial, final, seed)
    assert pairs_from_plain(json.loads(json.dumps(pairs_to_plain(pairs)))) == pairs


def test_an_open_lock_survives_json():
    lock = Pair((0,), (1, 2), None, None, None)
    assert pairs_from_plain(json.loads(json.dumps(pairs_to_plain([lock])))) == (lock,)


@chances
def test_reversed_pairs_run_backwards(initial, final, seed):
    pairs = pairs_by_chance(initial, final, seed)
    forth = morph_of_pairs(SHAPES[initial], SHAPES[final], pairs)
    back = morph_of_pairs(SHAPES[final], SHAPES[initial], reversed_pairs(SHAPES[initial], SHAPES[final], pairs))
    for u, v in ((0, 0), (0.3, 0.6), (1, 1)):
        assert np.allclose(forth.at(u, v).maps, back.at(1 - u, 1 - v).maps, atol=1e-9)


@pytest.mark.parametrize(
    "pairs",
    [
        [],
        [Pair((0,), (0,))],
        [Pair((0,), (0,)), Pair((1,), (1,)), Pair((2,), (3,))],
        [Pair((0,), (0,)), Pair((1,), (1,)), Pair((), (2,))],
    ],
)
def test_pairs_that_fit_no_more_say_so(pairs):
    with pytest.raises(IFSError, match=r"[Mm]atch again"):
        morph_of_pairs(SHAPES["gasket"], SHAPES["terdragon"], pairs)


def test_symmetries_have_names():
    texts = {symmetry_text(as_tuple(symmetry)) for symmetry in symmetries(SHAPES["square"])}
    assert {"", "turned by 90°", "turned by -90°", "turned by 180°", "mirrored at 0°", "mirrored at 90°"} <= texts
    assert symmetry_text(None) == "any"

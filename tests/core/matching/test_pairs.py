"""Pairs: a morph made of them has the shapes for ends, and they survive being stored."""

import json
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from core.cloud import point_cloud
from core.connectedness import Connectedness, connectedness
from core.ifs import IFS, IFSError
from core.matching import Pair, morph_of_pairs, pairs_from_plain, pairs_to_plain
from core.matching.expansion import split_to
from core.matching.pairs import IDENTITY, reversed_pairs
from core.matching.symmetry import symmetries
from core.raster import TOTAL_MASS, render
from core.report import check_frames
from core.shapes import SHAPES
from core.space.lifting import FLIPS
from core.space.shapes import SPACE_SHAPES
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
def test_the_ends_show_what_the_shapes_show(initial, final, seed):
    """However maps are split, doubled and turned, the same pixels are drawn, and as brightly."""
    random = np.random.default_rng(seed)
    shapes = []
    for name in (initial, final):
        opacity = random.choice([0.0, 0.5, 1.0], SHAPES[name].count)
        opacity[random.integers(len(opacity))] = 1.0
        shapes.append(replace(SHAPES[name], opacity=opacity))
    morph = morph_of_pairs(*shapes, pairs_by_chance(initial, final, seed))
    for made, shape in ((morph.initial, shapes[0]), (morph.final, shapes[1])):
        x0, y0, x1, y1 = replace(shape, opacity=None).bounds
        window = x0 - 0.0123, y0 - 0.0234, x1 + 0.0345, y1 + 0.0456
        pictures = [render(ifs, (40, 40), window) > 0 for ifs in (made, shape)]
        # Points lie elsewhere in pieces that are turned, and touch other pixels of the border.
        assert np.count_nonzero(pictures[0] != pictures[1]) <= 0.1 * np.count_nonzero(pictures[1])
        masses = [render(ifs, (40, 40), window, "density").sum() / TOTAL_MASS for ifs in (made, shape)]
        assert masses[0] == pytest.approx(masses[1], abs=1e-9)


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


NEVER_AFTER = IFS(SHAPES["gasket"].maps, transitions=[[1, 1, 1], [1, 1, 1], [1, 0, 1]])
"""Map 2 is never applied after map 3."""


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ([(0,), (1,), (4,), (2,)], "Pair 3 names a map that the initial shape does not have; it has 3"),
        ([(0,), (1,), (2,), (-1, 0)], "Pair 4 names a map"),
        ([(0,), (1,)], "since none has “3”; add"),
        ([(0,), (1,), (2, 0)], "since none has “3 2”, “3 3”; add"),
        ([(2, 2)], "since none has “1”, “2”, “3 1” and others; add"),
        ([(0, 0, 0)], "since none has “1 1 2”, “1 1 3”, “1 2” and others; add"),
        ([(0,), (1,), (2, 1), (2, 0), (2, 2), (2,)], "Pair 6 has all of map “3” of the initial shape, and pair 3 a"),
        ([(0,), (2,), (1, 0), (1, 1), (1, 2)], "Pair 5 names “2 3”, but map 2 of the initial shape may not be applied"),
    ],
)
def test_what_does_not_fit_is_named(words, said):
    with pytest.raises(IFSError, match=said):
        morph_of_pairs(NEVER_AFTER, SHAPES["square"], [Pair(word, (k % 4,)) for k, word in enumerate(words)])
    # The same at the other end.
    with pytest.raises(IFSError, match=said.replace("initial", "final")):
        morph_of_pairs(SHAPES["gasket"], NEVER_AFTER, [Pair((k % 3,), word) for k, word in enumerate(words * 3)])


@pytest.mark.parametrize("flip", FLIPS)
def test_a_pair_that_flips_turns_over_or_is_flattened(flip):
    """The gasket through one mirroring of it, for one map: that one must flip."""
    mirroring = next(each for each in symmetries_of("gasket") if np.linalg.det(each[:, :2]) < 0)
    pairs = [Pair((k,), (k,), final_symmetry=as_tuple(mirroring) if k == 1 else IDENTITY) for k in range(3)]
    morph = morph_of_pairs(SHAPES["gasket"], SHAPES["gasket"], pairs, flip=flip)
    assert (morph.turned_over, morph.flips) == (((1,), ()) if flip == "turned" else ((), (1,)))
    dimension = 3 if flip == "turned" else 2
    assert dimension == morph.DIMENSION
    points, spacing = points_of("gasket")
    for u in (0, 1):
        shown = point_cloud(morph.at(u, u), 2000).position.astype(float)
        assert np.abs(shown[:, 2:]).max(initial=0) < 1e-6
        assert cKDTree(points).query(shown[:, :2])[0].max() <= spacing + 1e-6
    sizes = np.linalg.svd(morph.linear(0.5)[1], compute_uv=False)
    assert sizes == pytest.approx([0.5] * 3 if flip == "turned" else [0.5, 0], abs=1e-12)


def test_a_shape_of_the_plane_is_paired_with_one_in_space():
    initial, final = SHAPES["gasket"], SPACE_SHAPES["Sierpinski tetrahedron"]
    turn = as_tuple(symmetries(final)[3])
    pairs = (Pair((0,), (0,)), Pair((1,), (1,), final_symmetry=turn), Pair((2,), (2,)), Pair((2,), (3,)))
    morph = morph_of_pairs(initial, final, pairs)
    assert np.allclose(morph.at(1, 1).linear[1], final.linear[1] @ np.array(turn)[:, :3])
    assert (point_cloud(morph.at(0, 0), 500).position[:, 2] == 0).all()
    back = morph_of_pairs(final, initial, reversed_pairs(initial, final, pairs))
    for u, v in ((0, 0), (0.3, 0.6), (1, 1)):
        assert np.allclose(morph.at(u, v).maps, back.at(1 - u, 1 - v).maps, atol=1e-9)


def test_a_symmetry_of_other_dimensions_is_said():
    with pytest.raises(IFSError, match="no symmetry"):
        morph_of_pairs(SHAPES["gasket"], SHAPES["gasket"], [Pair((k,), (k,), as_tuple(np.eye(3, 4))) for k in range(3)])


def test_an_end_is_decided_as_the_shape_that_it_is():
    """Listed seven times, the two maps of this shape are too many to decide at once."""
    shape = IFS(
        [
            [
                [0.34729951837593337, 0.5047519256790244, -0.3690192733216323],
                [-0.5047519256790244, 0.34729951837593337, -0.18175311820789686],
            ],
            [
                [0.777008606652451, 0.14128919017921174, -0.0528536078415085],
                [-0.14128919017921174, 0.777008606652451, -0.421311751874185],
            ],
        ]
    )
    morph = morph_of_pairs(shape, shape, [Pair((k % 2,), (k % 2,)) for k in range(7)])
    assert connectedness(shape).state == Connectedness.CONNECTED
    assert connectedness(morph.initial).state == Connectedness.UNDECIDED
    check = check_frames(morph, [[0, 0, 0], [1, 1, 0], [0, 0, 0.01], [0.5, 0.5, 0]])
    assert check.state[:2].tolist() == [Connectedness.CONNECTED] * 2
    assert (check.gap[:2] == connectedness(shape).gap).all()

"""The match of recurrent shapes: scored as they are drawn, their graphs kept, and no frame in pieces."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core.connectedness import Connectedness, connectedness
from core.ifs import IFS, IFSError
from core.matching import Pair, match, morph_of_pairs
from core.matching.expansion import is_closed, is_cover, split_all, split_to
from core.matching.problem import End, Problem
from core.matching.recurrent import RecurrentProblem, problem_of
from core.matching.scoring import LEVELS, NEVER
from core.matching.symmetry import symmetries
from core.shapes import SHAPES
from tests.core.reference import allowed_points, hausdorff, recurrent_in_pieces


def recurrent(name, transitions):
    return IFS(SHAPES[name].maps, None, name, np.array(transitions, dtype=float))


NEVER_TWICE = recurrent("square", np.ones((4, 4)) - np.eye(4))
GASKET = recurrent("gasket", [[1, 0.5, 1], [1, 1, 2], [1, 0, 1]])
PAIRS = [(SHAPES["gasket"], GASKET), (GASKET, SHAPES["square"]), (NEVER_TWICE, SHAPES["terdragon"])]
MATCHES = {}


def match_of(which):
    if which not in MATCHES:
        MATCHES[which] = match(*PAIRS[which], frames=60, budget=60_000)
    return MATCHES[which]


every_pair = pytest.mark.parametrize("which", range(len(PAIRS)))


@every_pair
def test_no_frame_is_in_pieces(which):
    found = match_of(which)
    assert found.report.disconnected == 0
    for t in np.linspace(0, 1, 60)[::6]:
        assert not recurrent_in_pieces(found.morph.at(*found.path.at(t)), 1 / 300)


@every_pair
def test_ends_are_the_shapes(which):
    morph = match_of(which).morph
    for given_end, end in zip(PAIRS[which], (morph.at(0, 0), morph.at(1, 1)), strict=True):
        (points, spacing), (others, other_spacing) = allowed_points(given_end), allowed_points(end)
        assert hausdorff(points, others) <= spacing + other_spacing


@every_pair
def test_the_report_says_that_maps_are_taken_apart(which):
    found = match_of(which)
    assert found.morph.count > len(found.pairs)
    assert f"in {found.morph.count} parts, for they allow different transitions." in found.report.text()


@every_pair
def test_the_pairs_make_the_morph_again(which):
    found = match_of(which)
    again = morph_of_pairs(*PAIRS[which], found.pairs)
    for u in (0, 0.4, 1):
        assert np.array_equal(again.at(u, u).maps, found.morph.at(u, u).maps)
        assert np.array_equal(again.at(u, u).transitions, found.morph.at(u, u).transitions)


def test_it_is_the_same_again_with_any_number_of_threads():
    again = match(*PAIRS[1], frames=60, budget=60_000, threads=1)
    assert again.pairs == match_of(1).pairs
    assert again.report.text() == match_of(1).report.text()


def ends_of(*shapes):
    return [End(ifs, symmetries(ifs), [(k,) for k in range(ifs.count)]) for ifs in shapes]


def test_swells_are_those_of_the_morph():
    problem = problem_of(*ends_of(NEVER_TWICE, SHAPES["gasket"]), 1 / 300)
    random = np.random.default_rng(5)
    times = np.linspace(0.1, 0.9, 5)
    for start in [problem.starts()[0], problem.shuffled(random)]:
        candidate = problem.evaluate([start])[0]
        morph = morph_of_pairs(NEVER_TWICE, SHAPES["gasket"], problem.pairs(candidate))
        for time, swell in zip(times, problem.swells(candidate, times), strict=True):
            if swell < NEVER:
                assert connectedness(morph.at(time, time, swell)).state == Connectedness.CONNECTED
            if swell > 0:
                assert connectedness(morph.at(time, time, 0.0)).state != Connectedness.CONNECTED
            assert swell in (*LEVELS, NEVER)


def test_where_nothing_is_forbidden_scores_are_those_of_plain_shapes():
    ends = ends_of(SHAPES["terdragon"], SHAPES["gasket"])
    plain, same = Problem(*ends, 1 / 300), RecurrentProblem(*ends, 1 / 300)
    random = np.random.default_rng(2)
    starts = [plain.shuffled(random) for _ in range(4)]
    for one, other in zip(plain.evaluate(starts), same.evaluate(starts), strict=True):
        assert one.score == pytest.approx(other.score)
        assert np.array_equal(one.swells, other.swells)
    best = plain.evaluate(starts[:1])[0]
    assert same.best_of(starts, best).score == pytest.approx(plain.best_of(starts, best).score)


@settings(max_examples=20)
@given(st.integers(2, 4), st.integers(0, 10**6), st.integers(1, 12))
def test_a_split_recurrent_shape_is_the_same_shape(count, seed, most):
    random = np.random.default_rng(seed)
    linear = random.normal(size=(count, 2, 2))
    linear *= (random.uniform(0.2, 0.7, count) / np.linalg.norm(linear, 2, axis=(1, 2)))[:, None, None]
    allowed = (random.random((count, count)) < 0.4) | np.eye(count, dtype=bool)[random.permutation(count)]
    ifs = IFS(np.concatenate([linear, random.uniform(-1, 1, (count, 2, 1))], axis=-1), transitions=allowed / 1.0)
    for words in (split_to(ifs, most), split_all(ifs)):
        assert is_cover(ifs, words)
        if not is_closed(ifs, words):
            assert words == split_all(ifs)
            continue
        split = morph_of_pairs(ifs, ifs, [Pair(word, word) for word in words]).initial
        (points, spacing), (others, other_spacing) = allowed_points(ifs, 3000), allowed_points(split, 3000)
        assert hausdorff(points, others) <= spacing + other_spacing
    assert len(split_to(ifs, most)) <= max(count, most)


def test_words_that_a_shape_forbids_are_no_pieces_of_it():
    words = [(0, 0), (0, 1), (0, 2), (0, 3), (1,), (2,), (3,)]
    with pytest.raises(IFSError, match="pieces"):
        match(NEVER_TWICE, SHAPES["gasket"], frames=12, initial_words=words)
    assert is_cover(NEVER_TWICE, words[1:])


def test_a_split_after_which_nothing_leads_to_a_piece_is_said():
    """Map 1 follows map 0 alone, and no piece ends in 0 once that is split."""
    ifs = recurrent("gasket", [[0, 0, 1], [1, 0, 0], [1, 1, 1]])
    words = [(0, 1), (0, 2), (1,), (2,)]
    assert is_cover(ifs, words)
    assert not is_closed(ifs, words)
    with pytest.raises(IFSError, match="split fewer"):
        morph_of_pairs(ifs, ifs, [Pair(word, word) for word in words])


def test_a_symmetry_of_all_is_none_of_what_follows_a_map():
    turned = tuple(map(tuple, symmetries(SHAPES["square"])[1].tolist()))
    with pytest.raises(IFSError, match="recurrent"):
        morph_of_pairs(NEVER_TWICE, NEVER_TWICE, [Pair((k,), (k,), turned) for k in range(4)])


# --- hidden maps


def test_a_shape_that_hides_maps_is_matched_as_it_is_drawn():
    """The snowflake without its middle is whole, and so must be what it becomes."""
    initial = replace(SHAPES["Koch snowflake"], opacity=[0, 1, 1, 1, 1, 1, 1])
    final = replace(SHAPES["Sierpinski carpet"], opacity=[1, 1, 1, 1, 1, 1, 1, 0])
    assert isinstance(
        problem_of(*(End(ifs, symmetries(ifs), [(0,)]) for ifs in (initial, final)), 1 / 300), RecurrentProblem
    )
    found = match(initial, final, frames=30, budget=20_000)
    assert found.report.disconnected == 0
    for end, shape in ((found.morph.initial, initial), (found.morph.final, final)):
        letters = [pair.initial[0] if shape is initial else pair.final[0] for pair in found.pairs]
        assert end.opacity.tolist() == shape.opacity[letters].tolist()
    for t in np.linspace(0, 1, 30):
        assert connectedness(found.morph.at(*found.path.at(t))).state == Connectedness.CONNECTED


def test_a_shape_that_falls_to_pieces_as_it_is_drawn_is_said_to():
    broken = replace(SHAPES["Koch curve"], opacity=[1, 0, 1, 1])
    found = match(broken, SHAPES["Koch curve"], frames=10, budget=5_000)
    assert found.report.path.path.state[0] == Connectedness.DISCONNECTED
    assert "9 in one piece (90%), 1 in pieces" in found.report.text()

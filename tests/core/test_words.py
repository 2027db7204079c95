"""Cuts: that they are cuts, that windows only leave out what they do not show, and the dimensions of known shapes."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.grammar import cumulated, free_grammar, set_grammar
from core.shapes import SHAPES
from core.words import (
    EVERYWHERE,
    IDENTITY,
    LETTER,
    MASS,
    SIZE,
    WORD_MASS,
    cut_dimensions,
    cut_words,
    unit_maps,
)

MEASURED = np.zeros(0)
PLENTY = 10**6


def cut(ifs, limit, norms=MEASURED, window=EVERYWHERE, budget=PLENTY, root=IDENTITY):
    maps, _, _ = unit_maps(ifs, 1e-9)
    return cut_words(root, maps, norms, 2.0, limit, free_grammar(ifs.weights), 0, window, budget)


def test_maps_are_the_same_seen_from_the_unit_disc():
    ifs = SHAPES["Barnsley fern"]
    maps, center, radius = unit_maps(ifs, 1e-9)
    places = np.random.default_rng(1).uniform(-1, 1, (5, 2))
    seen = np.einsum("nij,pj->npi", maps.reshape(-1, 2, 3), np.c_[places, np.ones(5)])
    images = np.einsum("nij,pj->npi", ifs.linear, center + radius * places) + ifs.translation[:, None]
    assert np.allclose(center + radius * seen, images)


@pytest.mark.parametrize("name", ["gasket", "terdragon", "Barnsley fern", "maple leaf"])
def test_a_cut_shares_out_all_mass_by_the_weights(name):
    ifs = SHAPES[name]
    words = cut(ifs, 0.1)
    assert np.all(words[:, MASS] == np.round(words[:, MASS]))
    assert words[:, MASS].sum() == WORD_MASS
    shares = np.bincount(words[:, LETTER].astype(int), weights=words[:, MASS]) / WORD_MASS
    assert np.allclose(shares, ifs.weights, atol=2 / WORD_MASS)


def test_words_end_where_they_get_small_and_not_before():
    ifs = SHAPES["Rauzy fractal"]
    words = cut(ifs, 0.1)
    sizes = 2 * np.linalg.norm(words[:, [0, 1, 3, 4]].reshape(-1, 2, 2), 2, axis=(1, 2))
    assert np.allclose(words[:, SIZE], sizes)
    assert np.all(sizes <= 0.1)
    # A similarity scales all sizes, so the word without its last letter is larger by the ratio of one of the maps.
    assert np.all(sizes > 0.1 * ifs.norms.min())


def test_every_word_has_a_letter():
    assert len(cut(SHAPES["gasket"], 100.0)) == 3


def test_norms_decide_the_cut_instead_of_the_maps():
    fern = SHAPES["Barnsley fern"]
    norms = np.array([0.3, 0.85, 0.4, 0.4])
    words = cut(fern, 0.2, norms)
    assert np.array_equal(words[:, SIZE], cut(SHAPES["square"], 0.2, norms)[:, SIZE])
    assert np.all(words[:, SIZE] <= 0.2)


def test_a_window_leaves_out_only_what_it_does_not_show():
    ifs = SHAPES["terdragon"]
    window = np.array([0.1, -0.2, 0.4, 0.15])
    every, shown = cut(ifs, 0.05), cut(ifs, 0.05, window=window)
    reach = np.linalg.norm(every[:, [0, 1, 3, 4]].reshape(-1, 2, 2), axis=2)
    low, high = every[:, [2, 5]] - reach, every[:, [2, 5]] + reach
    expected = every[((high >= window[:2]) & (low <= window[2:])).all(axis=1)]
    assert 0 < len(shown) < len(every)
    assert np.array_equal(shown, expected)


def test_a_cut_is_given_up_beyond_its_budget():
    assert len(cut(SHAPES["square"], 2.0**-5, budget=100)) == 101


@given(st.lists(st.floats(0, 1), min_size=1, max_size=8).filter(lambda weights: sum(weights) > 1e-6))
def test_borders_part_the_whole_interval(weights):
    borders = cumulated(np.array(weights))
    assert borders[0] == 0
    assert borders[-1] == 1
    assert np.all(np.diff(borders) >= 0)
    assert np.allclose(np.diff(borders), np.array(weights) / sum(weights), atol=1e-12)


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("gasket", np.log(3) / np.log(2)),
        ("Koch curve", np.log(4) / np.log(3)),
        ("Cantor dust", np.log(4) / np.log(3)),
        ("Sierpinski carpet", np.log(8) / np.log(3)),
        ("terdragon", 2),
        ("square", 2),
    ],
)
def test_the_dimension_of_similarities_is_morans(name, expected):
    ifs = SHAPES[name]
    assert cut_dimensions(unit_maps(ifs, 1e-9)[0], MEASURED, free_grammar(ifs.weights)) == pytest.approx(
        (expected, expected), rel=2e-3
    )
    assert cut_dimensions(unit_maps(ifs, 1e-9)[0], ifs.norms, free_grammar(ifs.weights)) == pytest.approx(
        (expected, expected), rel=2e-3
    )


def test_a_flat_attractor_fills_less_than_its_words_multiply():
    flat = np.array([[0.5, 0.0, -0.5, 0.0, 0.0, 0.0], [0.5, 0.0, 0.5, 0.0, 0.0, 0.0], [0.5, 0.0, 0.0, 0.0, 0.0, 0.0]])
    growth, dimension = cut_dimensions(flat, MEASURED, free_grammar(np.ones(3)))
    assert growth == pytest.approx(np.log(3) / np.log(2), rel=2e-3)
    assert dimension == pytest.approx(1, rel=2e-3)


def test_words_that_hardly_shrink_have_no_end():
    maps = np.tile([0.99, 0.0, 0.0, 0.0, 0.99, 0.0], (4, 1))
    assert cut_dimensions(maps, MEASURED, free_grammar(np.ones(4))) == (np.inf, np.inf)


def test_one_map_makes_one_point():
    maps = np.array([[0.5, 0.0, 0.0, 0.0, 0.5, 0.0]])
    assert cut_dimensions(maps, MEASURED, free_grammar(np.ones(1))) == pytest.approx((0, 0), abs=2e-3)


def test_the_dimension_of_a_recurrent_ifs_is_that_of_its_graph():
    """Quarters of the square of which none follows itself: three go on from each, so they triple at every half."""
    ifs = SHAPES["square"]
    grammar = set_grammar(ifs.weights, np.ones((4, 4)) - np.eye(4))
    expected = np.log(3) / np.log(2)
    for norms in (MEASURED, ifs.norms):
        found = cut_dimensions(unit_maps(ifs, 1e-9)[0], norms, grammar)
        assert found == pytest.approx((expected, expected), rel=2e-3)

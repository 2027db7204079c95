"""The kernels that say where an attractor can be, on their own."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from core import enclosure
from core.enclosure import cover, enclosing_disc, shrinking_words
from core.shapes import SHAPES
from tests.core import reference

seeds = st.integers(0, 2**32 - 1)


def rows(ifs):
    return np.ascontiguousarray(ifs.linear).reshape(-1, 4), np.ascontiguousarray(ifs.translation)


def every(linear):
    """All letters may come after all."""
    return np.ones((len(linear), len(linear)), dtype=bool)


def free_cover(linear, limit, budget):
    return cover(linear, every(linear), limit, budget)


@given(seeds, st.floats(-8, 2))
@settings(max_examples=60)
def test_norm_and_spectral_radius_are_numpys(seed, exponent):
    random = np.random.default_rng(seed)
    linear = random.normal(size=(2, 2))
    if seed % 3 == 0:
        linear[1] = linear[0] * random.normal()
    linear[0] *= 10**exponent
    norm = np.linalg.norm(linear, 2)
    assert enclosure.norm(*linear.ravel()) == pytest.approx(norm, rel=1e-12)
    radius = np.abs(np.linalg.eigvals(linear)).max()
    # Twofold eigenvalues move with the root of the rounding.
    assert enclosure.spectral_radius(*linear.ravel()) == pytest.approx(radius, rel=1e-9, abs=1e-7 * norm)


@pytest.mark.parametrize("name", ["gasket", "Barnsley fern", "spiral", "Koch snowflake", "Pythagoras tree"])
@pytest.mark.parametrize("limit", [0.5, 0.9])
def test_a_cover_holds_one_prefix_of_every_address(name, limit):
    linear, _ = rows(SHAPES[name])
    outcome, parent, letter, product, size = free_cover(linear, limit, 20_000)
    assert outcome == enclosure.COVERED
    words = []
    for k in range(len(parent)):
        words.append((*(words[parent[k]] if parent[k] >= 0 else ()), int(letter[k])))
        matrix = np.eye(2)
        for i in words[-1]:
            matrix = matrix @ SHAPES[name].linear[i]
        assert product[k].reshape(2, 2) == pytest.approx(matrix, abs=1e-14)
        assert size[k] == pytest.approx(np.linalg.norm(matrix, 2), rel=1e-12)
    leaves = {word for word, short in zip(words, size <= limit, strict=True) if short}
    # A random address runs into exactly one word of the cover.
    random = np.random.default_rng(0)
    for _ in range(200):
        address = tuple(random.integers(len(linear), size=200).tolist())
        assert sum(address[: len(word)] == word for word in leaves) == 1
    # The shares of the addresses that start with each word sum to one: none is missing and none twice.
    assert sum(float(len(linear)) ** -len(word) for word in leaves) == pytest.approx(1)


def test_a_cover_gives_up_at_its_budget():
    linear = np.array([[0.99, 0, 0, 0.99], [0, -0.99, 0.99, 0]])
    assert free_cover(linear, 0.5, 100)[0] == enclosure.UNDECIDED
    assert len(free_cover(linear, 0.5, 100)[1]) <= 100
    assert free_cover(linear, 0.9, 10_000)[0] == enclosure.COVERED


def test_a_budget_below_the_number_of_maps_is_no_harm():
    linear = np.tile([0.3, 0, 0, 0.3], (50, 1))
    assert free_cover(linear, 0.5, 3)[0] == enclosure.COVERED


def test_a_word_that_grows_rules_an_attractor_out():
    assert free_cover(np.array([[0.0, 2, 0, 0], [0, 0, 2, 0]]), 0.5, 1000)[0] == enclosure.NO_ATTRACTOR
    assert free_cover(np.array([[1.0, 0, 0, 0.1]]), 0.5, 1000)[0] == enclosure.NO_ATTRACTOR
    assert free_cover(np.array([[0.999, 0, 0, 0.1]]), 0.5, 1000)[0] == enclosure.COVERED


def test_any_cover_gives_a_disc_that_holds_the_attractor():
    for name in ("Barnsley fern", "spiral", "terdragon", "maple leaf"):
        ifs = SHAPES[name]
        points, _, _ = reference.dense(ifs.maps)
        linear, translation = rows(ifs)
        for limit in (0.3, 0.5, 0.95):
            outcome, *words = free_cover(linear, limit, 50_000)
            assert outcome == enclosure.COVERED
            x, y, radius = enclosing_disc(linear, translation, *words, limit)
            assert np.linalg.norm(points - (x, y), axis=1).max() <= radius


def test_the_tight_cover_is_taken_where_it_is_short():
    assert shrinking_words(rows(SHAPES["gasket"])[0], np.ones((3, 3), dtype=bool))[-1] == enclosure.TIGHT_NORM
    slow = np.array([[0.95, 0, 0, 0.95], [0, -0.95, 0.95, 0], [0.95, 0, 0, -0.95]])
    assert shrinking_words(slow, every(slow))[-1] == enclosure.CONTRACTIVE_NORM


def test_words_of_a_recurrent_ifs_have_only_letters_that_may_come_after_each_other():
    linear, _ = rows(SHAPES["gasket"])
    follows = np.array([[1, 1, 0], [0, 1, 1], [1, 0, 1]], dtype=bool)
    outcome, parent, letter, _, size = cover(linear, follows, 0.1, 20_000)
    assert outcome == enclosure.COVERED
    assert all(follows[letter[parent[k]], letter[k]] for k in range(len(parent)) if parent[k] >= 0)
    assert np.count_nonzero(size <= 0.1) == 3 * 2**3


def test_a_map_that_may_not_follow_itself_may_grow():
    linear = np.array([[1.5, 0, 0, 1.5], [0.2, 0, 0, 0.2]])
    assert cover(linear, every(linear), 0.5, 1000)[0] == enclosure.NO_ATTRACTOR
    in_turn = np.array([[0, 1], [1, 0]], dtype=bool)
    assert cover(linear, in_turn, 0.5, 1000)[0] == enclosure.COVERED
    assert cover(3 * linear, in_turn, 0.5, 1000)[0] == enclosure.NO_ATTRACTOR


@pytest.mark.parametrize("count, scale", [(2, 0.999), (4, 0.99), (28, 0.96)])
def test_maps_that_hardly_contract_are_words_enough(count, scale):
    linear = np.tile([scale, 0, 0, scale], (count, 1))
    outcome, _, letter, _, size, limit = shrinking_words(linear, every(linear))
    assert outcome == enclosure.COVERED
    assert (size <= limit).all()
    assert len(letter) == count or limit < 0.95

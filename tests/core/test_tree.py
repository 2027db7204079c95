"""Words that grow where they are looked at: they must be the compositions of the maps."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from core.tree import View, center, children, empty_tree, plant
from tests.core.random_maps import grown, random_ifs, unit_maps


@given(
    st.integers(0, 2**32 - 1),
    st.lists(st.lists(st.integers(0, 2), min_size=1, max_size=8), max_size=6),
    st.floats(-1, 2),
)
def test_words_are_compositions_and_their_translations_drift(seed, words, along):
    ifs = random_ifs(seed)
    linear, start = unit_maps(ifs)
    drift = np.random.default_rng(seed).normal(size=start.shape)
    tree, places = grown(linear, start, words, drift)
    maps = np.concatenate([linear.reshape(-1, 2, 2), (start + along * drift)[..., None]], axis=-1)
    middle = np.array([0.3, -0.8])
    for word, place in zip(words, places, strict=True):
        composed = np.eye(3)
        for letter in word:
            composed = composed @ np.vstack([maps[letter], [0, 0, 1]])
        assert tree.word[place, :4].reshape(2, 2) == pytest.approx(composed[:2, :2], abs=1e-13)
        assert tree.word[place, 8] == pytest.approx(np.linalg.norm(composed[:2, :2], 2), abs=1e-13)
        found = center(tree, place, View(*middle, along, 1.0, 0.0))
        assert found == pytest.approx(composed[:2, :2] @ middle + composed[:2, 2], abs=1e-12)


def test_children_are_made_once_and_only_where_there_is_room():
    linear, unit = unit_maps(random_ifs(1))
    tree = empty_tree(8)
    plant(tree, linear, unit, np.zeros_like(unit))
    follows = np.ones((3, 3), dtype=bool)
    assert children(tree, follows, 1) == children(tree, follows, 1) == (3, 6)
    assert tree.used[0] == 6
    assert children(tree, follows, 0) == (-1, -1)
    plant(tree, linear, unit, np.zeros_like(unit))
    assert children(tree, follows, 0) == (3, 6)
    follows[2, 1] = False
    plant(tree, linear, unit, np.zeros_like(unit))
    assert children(tree, follows, 2) == (3, 5)
    assert tree.last[3:5].tolist() == [0, 2]

"""What may come after what, and how often, against the chain of the chaos game itself."""

import random

import numpy as np
import pytest

from core.grammar import free_grammar, game_grammar, long_run, set_grammar, state_count, word_grammar

WEIGHTS = np.array([0.5, 0.3, 0.2])
NEVER_TWICE = np.array([[0.0, 1.0, 2.0], [1.0, 0.0, 1.0], [3.0, 1.0, 0.0]])


def game(weights, transitions, count, seed=1):
    """Return the letters of a long game, as one writes it down first."""
    chance, letter, letters = random.Random(seed), 0, []
    for _ in range(count):
        letter = chance.choices(range(len(weights)), weights * transitions[letter])[0]
        letters.append(letter)
    return np.array(letters)


def test_words_share_out_the_mass_as_often_as_the_game_spells_them_backwards():
    letters = game(WEIGHTS, NEVER_TWICE, 200_000)
    grammar = word_grammar(WEIGHTS, NEVER_TWICE)
    used = np.bincount(letters) / len(letters)
    assert grammar.shares[-1] == pytest.approx(used, abs=0.01)
    for i in range(3):
        before = letters[:-1][letters[1:] == i]
        expected = np.bincount(before, minlength=3) / len(before)
        assert grammar.shares[grammar.state[i]] == pytest.approx(expected, abs=0.01)


def test_without_transitions_or_with_all_alike_words_share_by_the_weights():
    for grammar in (free_grammar(WEIGHTS), word_grammar(WEIGHTS, None), word_grammar(WEIGHTS, np.full((3, 3), 0.7))):
        assert state_count(grammar) == 1
        assert grammar.allowed.all()
        assert np.allclose(grammar.shares, WEIGHTS)


def test_letters_that_go_on_alike_share_a_state():
    transitions = np.ones((4, 4))
    transitions[0, 1:3] = 0
    grammar = set_grammar(np.ones(4), transitions)
    assert state_count(grammar) == 2
    assert grammar.state[1] == grammar.state[2] != grammar.state[0] == grammar.state[3]
    assert np.array_equal(grammar.allowed[grammar.state], transitions.T > 0)
    assert grammar.allowed[-1].all()


def test_the_game_goes_on_by_weights_times_transitions():
    grammar = game_grammar(WEIGHTS, NEVER_TWICE)
    assert np.allclose(grammar.shares[grammar.state[0]], [0, 0.3 / 0.7, 0.4 / 0.7])
    assert np.allclose(grammar.borders[grammar.state[1]], np.cumsum([0, 0.5 / 0.7, 0, 0.2 / 0.7]))


def test_the_long_run_of_games_that_end_in_different_places():
    # The first letter is left for one of the others, and these are kept for ever.
    chances = np.array([[0.5, 0.125, 0.375], [0, 1, 0], [0, 0, 1]])
    assert long_run(np.array([0.4, 0.3, 0.3]), chances) == pytest.approx([0, 0.4, 0.6], abs=1e-12)


def test_letters_that_take_turns_are_used_as_often():
    assert long_run(np.array([1.0, 0.0]), np.array([[0.0, 1.0], [1.0, 0.0]])) == pytest.approx([0.5, 0.5])


def test_letters_without_weight_are_never_used_and_still_have_words_after_them():
    grammar = word_grammar(np.array([1.0, 1.0, 0.0]), np.ones((3, 3)) - np.eye(3))
    assert grammar.shares[-1] == pytest.approx([0.5, 0.5, 0.0])
    assert np.allclose(grammar.shares.sum(axis=1), 1)

"""Which letters may come after which in a word, and what share of it each takes.

Where all maps follow each other freely, all words go on alike. In a recurrent IFS (Barnsley, Elton & Hardin 1989,
"Recurrent iterated function systems") a word goes on as its last letter says. Letters after which all goes on alike
share a *state*, so that what is known of a state is worked out once; of a plain IFS there is one.
"""

from __future__ import annotations

from collections import namedtuple

import numpy as np

Grammar = namedtuple("Grammar", "state allowed shares borders")
"""The state (N,) after each letter; for each state, and in the last row for the empty word, which letters may come
next (R, N) bool, in what shares (R, N), and the borders (R, N + 1) of these, see `cumulated`. A plain IFS has R = 1."""

ALIKE = 12
"""Digits in which the shares of two letters must agree for them to have one state."""

DOUBLINGS = 60
"""2 to the power of this is how many steps of a chain its long run is taken from."""


def cumulated(weights: np.ndarray) -> np.ndarray:
    """Borders (N + 1,) of the parts, 0 to 1, that the maps have in an address."""
    borders = np.concatenate([[0.0], np.minimum(np.cumsum(weights / weights.sum()), 1.0)])
    borders[np.flatnonzero(weights)[-1] + 1 :] = 1.0
    return borders


def free_grammar(weights: np.ndarray) -> Grammar:
    """The grammar of a plain IFS of weights (N,), with one state."""
    count = len(weights)
    # A copy, since kernels are compiled anew for arrays that cannot be written to.
    shares = np.array(weights, dtype=float)[None]
    return Grammar(np.zeros(count, np.int64), np.ones((1, count), bool), shares, cumulated(weights)[None])


def state_count(grammar: Grammar) -> int:
    """How many states there are, that of the empty word aside if it is no letter's."""
    return int(grammar.state.max()) + 1


def word_grammar(weights: np.ndarray, transitions: np.ndarray | None, opacity: np.ndarray | None = None) -> Grammar:
    """How words go on, from the outermost letter inwards, and how they share out the measure of the chaos game.

    A point of the game has, as its address, the letters that led to it, the last one first. If pi is how often each
    letter is used in the long run, an address starts with i in the share pi_i, and k comes after i in the share
    ``pi_k P_ki / pi_i``: the chain of the game, reversed.

    Parameters
    ----------
    weights : (N,)
    transitions : (N, N), optional
        See `core.ifs.IFS`.
    opacity : (N,), optional
        By which the shares of the first letters are multiplied, so that there are none of hidden ones.
    """
    if transitions is None:
        grammar = free_grammar(weights)
        return grammar if opacity is None else _beginning(grammar, _dimmed(weights, opacity))
    chances = _chances(weights, transitions)
    used = long_run(weights, chances)
    first = used if opacity is None else _dimmed(used, opacity)
    return _grammar(transitions.T > 0, _normalised((used[:, None] * chances).T, transitions.T > 0), first)


def _dimmed(shares: np.ndarray, opacity: np.ndarray) -> np.ndarray:
    """Shares (N,) times opacities; these alone if all that is drawn has none."""
    dimmed = shares * opacity
    return dimmed if dimmed.any() else opacity


def set_grammar(weights: np.ndarray, transitions: np.ndarray | None) -> Grammar:
    """How words go on, for the attractor itself, on which no share has any bearing; as `word_grammar`."""
    if transitions is None or transitions.all():
        return free_grammar(weights)
    return _grammar(transitions.T > 0, (transitions.T > 0) / 1.0, np.ones(len(weights)))


def game_grammar(weights: np.ndarray, transitions: np.ndarray | None) -> Grammar:
    """How the chaos game goes on after each letter, the last row being how often it uses each; as `word_grammar`."""
    if transitions is None:
        return free_grammar(weights)
    chances = _chances(weights, transitions)
    return _grammar(transitions > 0, chances, long_run(weights, chances))


def long_run(weights: np.ndarray, chances: np.ndarray) -> np.ndarray:
    """How often each letter is used in a long game that starts with one drawn by the weights.

    Parameters
    ----------
    weights : (N,)
    chances : (N, N)
        That each letter comes next after each; rows add up to 1.
    """
    # Staying put every other time leaves the long run as it is and keeps letters from taking turns for ever.
    many = (np.eye(len(chances)) + chances) / 2
    for _ in range(DOUBLINGS):
        many = many @ many
        many /= many.sum(axis=1, keepdims=True)
    return weights / weights.sum() @ many


def _chances(weights: np.ndarray, transitions: np.ndarray) -> np.ndarray:
    return _normalised(weights * transitions, transitions)


def _normalised(rows: np.ndarray, otherwise: np.ndarray) -> np.ndarray:
    """Rows that add up to 1, taken from others where there is nothing in one."""
    rows = np.where(rows.any(axis=1, keepdims=True), rows, otherwise)
    return rows / rows.sum(axis=1, keepdims=True)


def _grammar(allowed: np.ndarray, shares: np.ndarray, first: np.ndarray) -> Grammar:
    """Gather letters into states, by what may come after them (N, N) and in what shares (N, N)."""
    rows = np.concatenate([allowed, np.round(shares, ALIKE)], axis=1)
    _, member, state = np.unique(rows, axis=0, return_index=True, return_inverse=True)
    borders = np.array([cumulated(row) for row in shares[member]])
    state = state.reshape(-1).astype(np.int64)
    return _beginning(Grammar(state, allowed[member], shares[member], borders), first)


def _beginning(grammar: Grammar, first: np.ndarray) -> Grammar:
    """The grammar of some states with a last row for the empty word, whose letters come in shares (N,) of their own."""
    return Grammar(
        grammar.state,
        np.concatenate([grammar.allowed, np.ones((1, len(first)), bool)]),
        np.concatenate([grammar.shares, first[None]]),
        np.concatenate([grammar.borders, cumulated(first)[None]]),
    )

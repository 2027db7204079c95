"""Pairs: which piece of the initial shape becomes which piece of the final one, and how. A list of them is a morph."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from ..affine import compose
from ..ifs import IFS, IFSError
from ..joining import Word, word_map
from ..morph import Morph
from ..space.lifting import in_one_space, morph_between
from .expansion import is_closed, is_cover, uncovered, word_weight

IDENTITY = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0))
"""The symmetry that every shape has; it stands for that of space as well."""

MISSING_NAMED = 3
"""Words of a shape that are in no pair, of those that a sentence names."""

Symmetry = tuple[tuple[float, ...], ...]
"""Rows of a map: two of three numbers, in space three of four."""


@dataclass(frozen=True)
class Pair:
    """A map of the initial shape and the map of the final shape that it becomes.

    Attributes
    ----------
    initial, final : tuple of int
        Words: (2,) is map 2, counted from 0, as it is; (2, 0) is the part of it that map 0 makes, after a split. A word
        may be in several pairs: then it is listed twice or more, and its weight shared.
    initial_symmetry, final_symmetry : ((a, b, e), (c, d, f)), in space three rows of four, or None
        A map that takes the end's attractor to itself, applied before the word's. None leaves it open, in a lock.
    winding : int or None
        Whole turns beyond the shorter way round. None leaves it open, in a lock.
    """

    initial: Word
    final: Word
    initial_symmetry: Symmetry | None = IDENTITY
    final_symmetry: Symmetry | None = IDENTITY
    winding: int | None = 0

    def plain(self) -> dict:
        """Lists and numbers only, as JSON and Blender's properties take them."""
        return {
            "initial": list(self.initial),
            "final": list(self.final),
            "initial_symmetry": _listed(self.initial_symmetry),
            "final_symmetry": _listed(self.final_symmetry),
            "winding": self.winding,
        }

    @classmethod
    def from_plain(cls, plain: dict) -> Pair:
        """The pair that `plain` was made of."""
        return cls(
            tuple(int(letter) for letter in plain["initial"]),
            tuple(int(letter) for letter in plain["final"]),
            _tupled(plain["initial_symmetry"]),
            _tupled(plain["final_symmetry"]),
            None if plain["winding"] is None else int(plain["winding"]),
        )


def pairs_to_plain(pairs: Sequence[Pair]) -> list[dict]:
    """Pairs as lists and numbers only."""
    return [pair.plain() for pair in pairs]


def pairs_from_plain(plain: Sequence[dict]) -> tuple[Pair, ...]:
    """Pairs from what `pairs_to_plain` gave."""
    return tuple(Pair.from_plain(each) for each in plain)


def morph_of_pairs(
    initial: IFS, final: IFS, pairs: Sequence[Pair], scheme: str = "polar", flip: str = "projected"
) -> Morph:
    """The morph that pairs stand for, without any search.

    Its ends have one map a pair, or several where the shapes allow different transitions (see `joining`), and the same
    attractors as the shapes given. A shape of the plane that becomes one of space, or the other way round, lies in
    space too, and so do its symmetries.

    Parameters
    ----------
    initial, final, pairs
    scheme, flip : str
        See `space.lifting.morph_between`.

    Raises
    ------
    IFSError
        If a pair names a map that there is not, or a piece of a shape is in no pair.
    """
    winding = np.array([pair.winding or 0 for pair in pairs])
    morph = morph_between(*_ends(*in_one_space(initial, final), pairs), scheme, winding, flip)
    morph.shapes = initial, final
    return morph


def reversed_pairs(initial: IFS, final: IFS, pairs: Sequence[Pair]) -> tuple[Pair, ...]:
    """The pairs of the morph from `final` to `initial` that runs backwards through the one these pairs stand for."""
    swapped = [Pair(pair.final, pair.initial, pair.final_symmetry, pair.initial_symmetry) for pair in pairs]
    # Half a turn goes counter-clockwise both ways unless it is wound back.
    winding = np.round((-_turning(initial, final, pairs) - _turning(final, initial, swapped)) / (2 * np.pi))
    return tuple(replace(pair, winding=int(turns)) for pair, turns in zip(swapped, winding, strict=True))


def _turning(initial: IFS, final: IFS, pairs: Sequence[Pair]) -> np.ndarray:
    """Radians (P,) that the maps of pairs turn by; what may follow them has no bearing on it."""
    winding = np.array([pair.winding or 0 for pair in pairs])
    ends = [replace(end, transitions=None) for end in _ends(*in_one_space(initial, final), pairs)]
    return morph_between(*ends, winding=winding).turning


def shares(words: Sequence[Word]) -> np.ndarray:
    """Share (N,) of its word's weight that each of a list of words has."""
    counts = Counter(words)
    return np.array([1 / counts[word] for word in words])


def as_map(symmetry: Symmetry | None, ifs: IFS) -> np.ndarray:
    """A symmetry of a shape as a map (2, 3), or (3, 4) in space; the identity if it is open."""
    if symmetry is None or symmetry == IDENTITY:
        return np.eye(ifs.DIMENSION, ifs.DIMENSION + 1)
    rows = np.array(symmetry, dtype=float)
    if rows.shape != ifs.maps.shape[1:]:
        raise IFSError("A pair turns a map by what is no symmetry of its shape; match again, or reset it.")
    return rows


def _ends(initial: IFS, final: IFS, pairs: Sequence[Pair]) -> tuple[IFS, IFS]:
    return (
        _end(initial, [(pair.initial, pair.initial_symmetry) for pair in pairs], "initial"),
        _end(final, [(pair.final, pair.final_symmetry) for pair in pairs], "final"),
    )


def _end(ifs: IFS, listed: list[tuple[Word, Symmetry | None]], name: str) -> IFS:
    words = [word for word, _ in listed]
    letters = [letter for word in words for letter in word]
    if not words or min(map(len, words)) == 0 or min(letters) < 0 or max(letters) >= ifs.count:
        wrong = (k for k, word in enumerate(words, 1) if not word or min(word) < 0 or max(word) >= ifs.count)
        raise IFSError(
            f"Pair {next(wrong, 1)} names a map that the {name} shape does not have; it has {ifs.count}. "
            "Write another, or match again."
        )
    if not is_cover(ifs, words):
        raise IFSError(_cover_problem(ifs, words, name))
    if not is_closed(ifs, words):
        raise IFSError(f"The {name} shape is recurrent, and no map leads to some of these pieces; split fewer maps.")
    maps = np.array([word_map(ifs, word) for word in words])
    gauges = np.array([as_map(symmetry, ifs) for _, symmetry in listed])
    weights = np.array([word_weight(ifs, word) for word in words]) * shares(words)
    # Split often enough, weights of zero alone may be left.
    weights = weights if weights.sum() > 0 else None
    if ifs.is_recurrent and not (gauges == as_map(None, ifs)).all():
        raise IFSError(
            f"The {name} shape is recurrent: no symmetry may turn its maps; match again, or clear the pairs."
        )
    # The piece of a word lies in the attractorlet of its first letter, the map that is applied last.
    opacity = ifs.opacity[[word[0] for word in words]]
    return type(ifs)(compose(maps, gauges), weights, ifs.name, _transitions(ifs, words), opacity)


def _cover_problem(ifs: IFS, words: list[Word], name: str) -> str:
    """Say what keeps words from being all of a shape, none of it twice."""
    for k, word in enumerate(words, 1):
        for i, j in pairwise(word):
            if not ifs.follows[i, j]:
                return (
                    f"Pair {k} names {_quoted(word)}, but map {i + 1} of the {name} shape may not be applied after "
                    f"map {j + 1}, so there is no such part; write another, or match again."
                )
    for k, word in enumerate(words):
        part = next((j for j, other in enumerate(words) if word == other[: len(word)] != other), None)
        if part is not None:
            return (
                f"Pair {k + 1} has all of map {_quoted(word)} of the {name} shape, and pair {part + 1} a part of it; "
                "split the one, join the parts of the other, or match again."
            )
    missing = [_quoted(word) for word in uncovered(ifs, words)]
    return (
        f"The pairs do not make up the whole {name} shape, since none has {', '.join(missing[:MISSING_NAMED])}"
        f"{' and others' if len(missing) > MISSING_NAMED else ''}; add what is missing, or match again."
    )


def _quoted(word: Word) -> str:
    return f"“{' '.join(str(letter + 1) for letter in word)}”"


def _transitions(ifs: IFS, words: list[Word]) -> np.ndarray | None:
    """Transitions (P, P) between words: all their letters are applied in turn, the last one first."""
    if ifs.transitions is None:
        return None
    first, last = ([word[end] for word in words] for end in (0, -1))
    chances = ifs.transitions @ ifs.weights
    chances = ifs.transitions / np.where(chances > 0, chances, 1.0)[:, None]
    within = [np.prod([chances[k, i] for i, k in pairwise(word)]) for word in words]
    return ifs.transitions[np.ix_(first, last)] * within


def _listed(symmetry: Symmetry | None) -> list | None:
    return None if symmetry is None else [list(row) for row in symmetry]


def _tupled(symmetry: list | None) -> Symmetry | None:
    return None if symmetry is None else tuple(tuple(float(entry) for entry in row) for row in symmetry)

"""What a person has settled beforehand: splits and locked pairs, in the terms of a search."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..ifs import IFS, IFSError
from ..joining import Word
from .expansion import is_cover, parts
from .pairs import Pair, Symmetry, as_map
from .problem import Lock
from .wording import word_text

SAME = 1e-6
"""Two symmetries whose entries differ by less than this, in units of the shape, are one."""


def settled_words(ifs: IFS, name: str, words: Sequence[Word] | None, locked: Sequence[Word]) -> list[Word] | None:
    """The words to use at one end: those given, or as few as the locked ones need; None if nothing is settled.

    Raises
    ------
    IFSError
        If the words are not those of all of the shape, or a locked one is not among them.
    """
    for word in locked:
        if not word or min(word) < 0 or max(word) >= ifs.count:
            raise IFSError(f"A locked pair names a map that the {name} shape does not have; it has {ifs.count}.")
    if words is None:
        if not locked:
            return None
        words = [(i,) for i in range(ifs.count)]
        prefixes = {word[:length] for word in locked for length in range(1, len(word))}
        while split := [word for word in words if word in prefixes]:
            at = words.index(split[0])
            words[at : at + 1] = parts(ifs, words[at])
    words = [tuple(int(letter) for letter in word) for word in words]
    named = all(word and min(word) >= 0 and max(word) < ifs.count for word in words)
    if not named or len(set(words)) < len(words) or not is_cover(ifs, words):
        raise IFSError(f"The words given for the {name} shape are not all of its pieces, each once; give every piece.")
    for word in locked:
        if tuple(word) not in words:
            raise IFSError(
                f"A locked pair uses the piece {word_text(word)} of the {name} shape, which is split further or not at "
                "all."
            )
    return words


def locks_of(pairs: Sequence[Pair], ends: Sequence) -> tuple[Lock, ...]:
    """Locked pairs as the search takes them.

    Parameters
    ----------
    pairs : sequence of Pair
    ends : (End, End)

    Raises
    ------
    IFSError
        If a symmetry is none of the shape's.
    """
    locks = []
    for pair in pairs:
        words = tuple(end.words.index(tuple(word)) for end, word in zip(ends, (pair.initial, pair.final), strict=True))
        symmetries = tuple(
            _index(symmetry, end.ifs, end.symmetries)
            for end, symmetry in zip(ends, (pair.initial_symmetry, pair.final_symmetry), strict=True)
        )
        locks.append(Lock(words, symmetries, pair.winding))
    return tuple(locks)


def _index(symmetry: Symmetry | None, ifs: IFS, symmetries: np.ndarray) -> int | None:
    if symmetry is None:
        return None
    scale = np.append(np.ones(ifs.DIMENSION), max(ifs.enclosing_disc[1], 1e-300))
    apart = np.abs((symmetries - as_map(symmetry, ifs)) / scale).max(axis=(1, 2))
    if apart.min() > SAME:
        raise IFSError("A locked pair turns or mirrors a map by what is no symmetry of its shape; open or reset it.")
    return int(np.argmin(apart))

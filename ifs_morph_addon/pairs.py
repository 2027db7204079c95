"""The pairs on an object to those of core and back.

Properties hold single precision, which could take a map the other way round where it turns by just half a turn. So
symmetries are read as those of the shape that are nearest.
"""

import re
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from functools import lru_cache

import numpy as np

from ..core.ifs import IFS, IFSError
from ..core.matching import Pair, morph_of_pairs, symmetry_text, word_text
from ..core.matching.expansion import uncovered
from ..core.matching.pairs import IDENTITY, as_map
from ..core.matching.symmetry import symmetries

NEAR = 1e-4
"""Entries of a symmetry, in units of the shape, that differ by less are of the same one. Others are far apart."""

LETTER = re.compile(r"0*[1-9][0-9]{0,8}")
"""Number of a map, in the text of a word."""

STORED = ("initial", "final", "winding", "locked")
"""What a pair stores beside its symmetries."""

SYMMETRIES = {2: ("initial_symmetry", "final_symmetry"), 3: ("initial_symmetry_in_space", "final_symmetry_in_space")}
"""Where a pair stores its symmetries, by dimensions."""

SIGNS = {
    "turned by ": "\N{ANTICLOCKWISE OPEN CIRCLE ARROW}",
    " and mirrored along it": "\N{LEFT RIGHT ARROW}",
    "mirrored at ": "\N{LEFT RIGHT ARROW}",
    "mirrored along ": "\N{LEFT RIGHT ARROW}",
    "mirrored through its middle": "\N{LEFT RIGHT ARROW}",
    " about ": " ",
    ", ": ",",
}
"""Of symmetries, where there is room for a sign only."""

UNFIT = "The pairs do not fit the maps, so map k becomes map k for now."


def stored(matching) -> tuple[Pair, ...]:
    """Pairs as they are stored; raises IFSError if a word is none."""
    return _pairs(*plain(matching))


def plain(matching) -> tuple:
    """All that the morph depends on, as texts and bytes, which are quick to read; it need not make sense."""
    items, dimension = matching.pairs, _dimension(matching)
    numbers = len(items) * dimension * (dimension + 1)
    arrays = [np.empty(numbers, np.float32), np.empty(numbers, np.float32), np.empty(len(items), np.int32)]
    for name, values in zip((*SYMMETRIES[dimension], "winding"), arrays, strict=True):
        items.foreach_get(name, values)
    words = tuple((item.initial, item.final) for item in items)
    return dimension, words, *(values.tobytes() for values in arrays)


def _dimension(stored) -> int:
    """Dimensions of the morph whose object something is stored on."""
    settings = stored.id_data.ifs_morph
    return 3 if settings.initial.in_space or settings.final.in_space else 2


def no_symmetry(dimension: int) -> tuple:
    """Rows of the map that changes nothing."""
    return _rows(np.eye(dimension, dimension + 1).tolist())


def _pairs(dimension: int, words, initial: bytes, final: bytes, winding: bytes) -> tuple[Pair, ...]:
    shape = -1, dimension, dimension + 1
    symmetries = [np.frombuffer(each, np.float32).reshape(shape).tolist() for each in (initial, final)]
    listed = []
    for (first, last), before, after, turns in zip(
        words, *symmetries, np.frombuffer(winding, np.int32).tolist(), strict=True
    ):
        try:
            listed.append(Pair(word_of(first), word_of(last), _rows(before), _rows(after), turns))
        except IFSError as error:
            raise IFSError(f"Pair {len(listed) + 1}: {error}") from None
    return tuple(listed)


def word_of(text: str) -> tuple[int, ...]:
    """Word, counted from 0, of the text of it, counted from 1; raises IFSError."""
    parts = text.split()
    if not parts or not all(LETTER.fullmatch(part) for part in parts):
        raise IFSError(f"“{text}” is no map: write its number, or several with spaces for a part of it.")
    return tuple(int(part) - 1 for part in parts)


def require_word(ifs: IFS, word: tuple[int, ...]) -> None:
    """Raise IFSError unless a shape has the maps of a word."""
    if max(word) >= ifs.count:
        raise IFSError(f"“{word_text(word)}” is no map of a shape that has {ifs.count}.")


def _rows(matrix) -> tuple:
    return tuple(tuple(row) for row in matrix)


def described(item) -> str:
    """The symmetries of a stored pair in words; nothing if it makes use of none."""
    texts = [symmetry_text(_rows(getattr(item, name))) for name in SYMMETRIES[_dimension(item)]]
    return ", ".join(f"{end} {text}" for end, text in zip(("initial", "final"), texts, strict=True) if text)


def line(item) -> str:
    """A stored pair in as few signs as a list has room for: ``3 1 → 2 ↺120° +1``."""
    ends = []
    for end, name in zip((item.initial, item.final), SYMMETRIES[_dimension(item)], strict=True):
        text = symmetry_text(_rows(getattr(item, name)))
        for words, sign in SIGNS.items():
            text = text.replace(words, sign)
        ends.append(f"{end} {text}".strip())
    turns = f" {item.winding:+d}" if item.winding else ""
    return f"{ends[0]} \N{RIGHTWARDS ARROW} {ends[1]}{turns}"


def fitted(initial: IFS, final: IFS, matching) -> tuple[Pair, ...] | None:
    """Pairs that are stored for two shapes, their symmetries to the last digit; None if they do not fit them."""
    return _fitted(initial, final, plain(matching))[0]


def problem(initial: IFS, final: IFS, matching) -> str:
    """Which stored pair does not fit two shapes, and why, in one sentence; empty if all fit."""
    return _fitted(initial, final, plain(matching))[1]


@lru_cache(maxsize=16)
def _fitted(initial: IFS, final: IFS, stored_pairs: tuple) -> tuple[tuple[Pair, ...] | None, str]:
    try:
        pairs = tuple(
            replace(
                pair,
                initial_symmetry=_exact(pair.initial_symmetry, initial, f"Pair {k} turns its initial map"),
                final_symmetry=_exact(pair.final_symmetry, final, f"Pair {k} turns its final map"),
            )
            for k, pair in enumerate(_pairs(*stored_pairs), 1)
        )
        morph_of_pairs(initial, final, pairs, "elementwise")
    except IFSError as error:
        return None, str(error)
    return pairs, ""


def _exact(symmetry, ifs: IFS, turned: str):
    """Return the symmetry of a shape that is nearest; raises IFSError, which begins with `turned`, if none is near."""
    if symmetry == no_symmetry(ifs.DIMENSION):
        return symmetry
    index = _index(symmetry, ifs)
    if index is None:
        raise IFSError(f"{turned} by what is no symmetry of the shape any more; choose its next one, or match again.")
    return _rows(symmetries_of(ifs)[index].tolist())


def _index(symmetry, ifs: IFS) -> int | None:
    known, given = symmetries_of(ifs), as_map(symmetry, ifs)
    scale = np.append(np.ones(ifs.DIMENSION), max(ifs.enclosing_disc[1], np.abs(given[:, -1]).max(), 1e-300))
    apart = np.abs((known - given) / scale).max(axis=(1, 2))
    return int(np.argmin(apart)) if apart.min() < NEAR else None


def next_symmetry(ifs: IFS, symmetry) -> tuple:
    """Return the symmetry of a shape that follows one of it, and after the last the first, which leaves it as it is.

    Raises
    ------
    IFSError
        If the shape has no symmetry but that one, or no attractor.
    """
    known = symmetries_of(ifs)
    if len(known) == 1 and symmetry == no_symmetry(ifs.DIMENSION):
        raise IFSError("This shape has no symmetries: no turn or mirroring takes it to itself.")
    index = _index(symmetry, ifs)
    if index is None:
        index = -1  # What is no symmetry any more gives way to the identity.
    return _rows(known[(index + 1) % len(known)].tolist())


@lru_cache(maxsize=16)
def symmetries_of(ifs: IFS) -> np.ndarray:
    """Symmetries (G, 2, 3), or (G, 3, 4), of a shape, the identity first; raises IFSError without an attractor."""
    ifs.require_attractor()
    return symmetries(ifs)


def in_order(initial: IFS, final: IFS) -> tuple[Pair, ...]:
    """Map k and map k, the shorter list again from its first."""
    return tuple(Pair((k % initial.count,), (k % final.count,)) for k in range(max(initial.count, final.count)))


def write(matching, pairs: Sequence[Pair], locked: Sequence[bool]) -> None:
    """Store pairs in place of those that are there.

    Raises
    ------
    IFSError
        If the object is a library override with more pairs in its library. Then nothing has changed.
    """
    collection, removed = matching.pairs, []
    while len(collection) > len(pairs):
        last = len(collection) - 1
        removed.append(_values(collection[last]))
        try:
            collection.remove(last)
        except TypeError as error:
            # It is still there, and those that were removed come back.
            for values in reversed(removed[:-1]):
                _fill(collection.add(), values)
            raise IFSError(
                f"This library override has {len(collection)} pairs, some of them its library's, and cannot have "
                f"{len(pairs)}; make the object local first."
            ) from error
    while len(collection) < len(pairs):
        collection.add()
    dimension = _dimension(matching)
    for item, pair, lock in zip(collection, pairs, locked, strict=True):
        values = {"initial": word_text(pair.initial), "final": word_text(pair.final)}
        for name, symmetry in zip(SYMMETRIES[dimension], (pair.initial_symmetry, pair.final_symmetry), strict=True):
            values[name] = no_symmetry(dimension) if symmetry in (None, IDENTITY) else symmetry
        _fill(item, {**values, "winding": pair.winding or 0, "locked": lock})
    matching.active_index = max(0, min(matching.active_index, len(pairs) - 1))


def append(matching, initial: IFS, final: IFS) -> int | None:
    """Add a pair of what is in none yet, and make it the active one; an end that lacks nothing is the active pair's.

    Returns the number of the pair that was doubled, if nothing was missing.
    """
    active = max(0, min(matching.active_index, len(matching.pairs) - 1))
    like = _values(matching.pairs[active])
    values, doubled = {**like, "locked": False}, active
    for k, (end, ifs) in enumerate((("initial", initial), ("final", final))):
        missing = uncovered(ifs, _words(matching, end, ifs.count))
        if missing:
            doubled = None
            values |= {end: word_text(missing[0]), "winding": 0}
            values |= {names[k]: no_symmetry(dimension) for dimension, names in SYMMETRIES.items()}
    _fill(matching.pairs.add(), values)
    matching.active_index = len(matching.pairs) - 1
    return doubled


def _words(matching, end: str, count: int) -> list[tuple[int, ...]]:
    """Words of one end, those left out that name no map of a shape with so many."""
    words = []
    for item in matching.pairs:
        with suppress(IFSError):
            words.append(word_of(getattr(item, end)))
    return [word for word in words if max(word) < count]


def remove(matching, index: int) -> None:
    """Remove a pair; the one after it is the active one then.

    Raises
    ------
    IFSError
        If the object is a library override and the pair its library's.
    """
    try:
        matching.pairs.remove(index)
    except TypeError as error:
        raise IFSError("A library override keeps the pairs of its library; make the object local first.") from error
    matching.active_index = max(0, min(index, len(matching.pairs) - 1))


def exchange_maps(matching, end: str, first: int, second: int) -> None:
    """Have pairs go on to name the same maps after two maps of a shape have changed places."""
    places = {first: second, second: first}
    for item in matching.pairs:
        try:
            word = word_of(getattr(item, end))
        except IFSError:
            continue  # It names no map.
        setattr(item, end, word_text(tuple(places.get(letter, letter) for letter in word)))


def _values(item) -> dict:
    # Matrices would follow the item, and be gone with it.
    symmetries = {name: _rows(getattr(item, name)) for names in SYMMETRIES.values() for name in names}
    return {name: getattr(item, name) for name in STORED} | symmetries


def _fill(item, values: dict) -> None:
    for name, value in values.items():
        setattr(item, name, value)

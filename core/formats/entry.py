"""What a file of shapes holds, whichever format it has: its entries, and what could not be read."""

from __future__ import annotations

import re
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass, field, replace

import numpy as np

from ..ifs import IFS, IFSError
from ..space.ifs import SpaceIFS

NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?", re.ASCII)
"""A number as programs write it; Python's own reading would also take underscores, words and other digits."""

LARGEST_NUMBER = 1e100
"""Larger ones are a mistake, and their products overflow."""

LARGEST_COUNT = 1000
"""More maps than that are a mistake, too."""

NO_SHAPES = (
    "There are no shapes: neither entries “name { a b c d e f p ... }”, as Fractint has them, nor flames, "
    "<flame> ... </flame>."
)


class FormatError(IFSError):
    """A file of shapes cannot be read or written; the message says what, where and what to do."""


@dataclass(frozen=True, eq=False)
class Entry:
    """One shape of a file, with all that the file says of it.

    Parameters
    ----------
    name : str
        Unique within the file.
    maps : (N, 2, 3) or (N, 3, 4)
        ``[[a, b, e], [c, d, f]]`` each, y pointing up; with a third row and column in space.
    weights : (N,), optional
        How often each map is used, as the file says, not scaled; None where the file does not say.
    transitions : (N, N), optional
        After map i, map j follows with a probability proportional to ``weights[j] * transitions[i, j]``. None stands
        for ones throughout, a plain IFS; a flame calls them chaos.
    colors : (N,), optional
        Place of each map's color in the palette, from 0 to 1.
    color_speeds : (N,), optional
        Share of a map's own color in its attractorlet, the rest being the color of the point before.
    opacities : (N,), optional
        How visible each map's attractorlet is, from 0 to 1. None stands for ones.
    palette : (K, 3) uint8, optional
        Red, green and blue from 0 to 255.
    notes : tuple of str
        Sentences on what the file says and the shape does not show.
    """

    name: str
    maps: np.ndarray
    weights: np.ndarray | None = None
    transitions: np.ndarray | None = None
    colors: np.ndarray | None = None
    color_speeds: np.ndarray | None = None
    opacities: np.ndarray | None = None
    palette: np.ndarray | None = None
    notes: tuple[str, ...] = field(default=())

    @property
    def count(self) -> int:
        """N, the number of maps."""
        return len(self.maps)

    @property
    def dimension(self) -> int:
        """2 for shapes of the plane, 3 for shapes in space."""
        return self.maps.shape[1]

    @property
    def known_weights(self) -> np.ndarray:
        """The weights (N,), or where the file has none the areas or volumes of the maps, none too small."""
        if self.weights is not None:
            return self.weights
        return self._kind(self.maps).weights

    @property
    def _kind(self) -> type[IFS]:
        return IFS if self.dimension == 2 else SpaceIFS

    @classmethod
    def of(cls, name: str, ifs: IFS, **more) -> Entry:
        """Return the entry of an IFS, with `more` of the parameters above."""
        opacities = None if (ifs.opacity == 1).all() else ifs.opacity
        return cls(name, ifs.maps, ifs.weights, ifs.transitions, opacities=opacities, **more)

    def ifs(self) -> IFS:
        """Return the shape as an IFS, a recurrent one if it has transitions, a `SpaceIFS` if it lies in space.

        Raises
        ------
        IFSError
            If it has transitions that leave no map to follow another, or any in space, or hides all its maps.
        """
        return self._kind(self.maps, self.weights, self.name, self.transitions, self.opacities)


@dataclass(frozen=True)
class Reading:
    """What was found in a file.

    Parameters
    ----------
    entries : tuple of Entry
        In the order of the file; names are unique.
    problems : tuple of str
        A sentence for each entry that could not be read, and for each thing that an entry read does not show.
    """

    entries: tuple[Entry, ...]
    problems: tuple[str, ...]

    @property
    def shapes(self) -> dict[str, IFS]:
        """The entries that are IFSs, by name."""
        found = {}
        for entry in self.entries:
            with suppress(IFSError):
                found[entry.name] = entry.ifs()
        return found


def reading(entries: Iterable[Entry], problems: Iterable[str]) -> Reading:
    """Put a reading together: give entries of one name a number, and list their notes after the other problems."""
    entries = with_unique_names(entries)
    notes = (note for entry in entries for note in entry.notes)
    return Reading(entries, (*problems, *notes))


def with_unique_names(entries: Iterable[Entry]) -> tuple[Entry, ...]:
    """Give entries whose name another has the first number from 2 that makes it differ from those before."""
    unique: dict[str, Entry] = {}
    last: dict[str, int] = {}
    for entry in entries:
        name, number = entry.name, last.get(entry.name, 1)
        while name in unique:
            number += 1
            name = f"{entry.name} {number}"
        last[entry.name] = number
        unique[name] = replace(entry, name=name)
    return tuple(unique.values())


def called(name: str) -> str:
    """Quote a name for a sentence, on one line and not too long."""
    return f"“{' '.join(name.split())[:60]}”"


def number(word: str) -> float:
    """Read one number; raises FormatError with the words that follow a colon."""
    word = word.replace("\N{MINUS SIGN}", "-")
    if not NUMBER.fullmatch(word):
        raise FormatError(f"“{word[:40]}” is not a number.")
    if abs(float(word)) > LARGEST_NUMBER:
        raise FormatError(f"{word[:40]} is too large a number.")
    return float(word)


def require_writable(entry: Entry) -> None:
    """Raise FormatError unless an entry is sound and reads back as it is, whatever the format."""
    maps = np.asarray(entry.maps)
    if maps.ndim != 3 or maps.shape[1:] not in ((2, 3), (3, 4)) or len(maps) == 0:
        raise FormatError(
            f"{called(entry.name)} has maps of shape {maps.shape}; (N, 2, 3) or (N, 3, 4) can be written."
        )
    if len(maps) > LARGEST_COUNT:
        raise FormatError(f"{called(entry.name)} has {len(maps)} maps; at most {LARGEST_COUNT} can be written.")
    if not (np.abs(maps) <= LARGEST_NUMBER).all():
        raise FormatError(f"{called(entry.name)} holds NaN, infinity or a number beyond {LARGEST_NUMBER:g}.")
    weights = entry.known_weights
    if weights.shape != (len(maps),) or not (weights <= LARGEST_NUMBER).all():
        raise FormatError(f"{called(entry.name)} has {len(maps)} maps; give each a weight that is a sensible number.")
    for k in np.flatnonzero(weights <= 0):
        raise FormatError(
            f"{called(entry.name)}, map {k + 1}: the weight is {weights[k]:g}, which other programs take for a map "
            "that is not there; give it a weight above zero."
        )

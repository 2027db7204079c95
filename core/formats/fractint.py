"""Fractint's .ifs files: entries ``name { a b c d e f p ... }`` of maps of the plane, or of space after ``(3D)``.

Only the numbers and their order count. Line breaks, commas, comments from a semicolon on and letter case are free, and
programs differ in whether they write the probability; so how many numbers make up a map is worked out here.
"""

from __future__ import annotations

import json
import re
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from .entry import (
    LARGEST_COUNT,
    NO_SHAPES,
    NUMBER,
    Entry,
    FormatError,
    Reading,
    called,
    number,
    reading,
    require_writable,
)

IN_SPACE = re.compile(r"\(\s*3\s*d\s*\)", re.IGNORECASE)
NAME_COMMENT = re.compile(r'\s*name:\s*(".*")\s*')
"""A comment of our own: the whole name of an entry, where Fractint's names are too plain for it."""

ROUNDING = 0.1
"""How far from one the probabilities of an entry may sum, for they are often written with two decimals."""

PERCENT = 100


@dataclass
class _Block:
    """One ``name { ... }`` as it stands in the file."""

    name: str
    line: int
    in_space: bool = False
    is_remark: bool = False
    rows: list[tuple[int, list[str]]] = field(default_factory=list)
    closed: bool = False

    @property
    def place(self) -> str:
        return f"{called(self.name)}, line {self.line}"

    @property
    def looks_like_maps(self) -> bool:
        """Whether most of its words are numbers, as not in the braces of other kinds of files."""
        words = [word for _, row in self.rows for word in row]
        return 2 * sum(map(bool, map(NUMBER.fullmatch, words))) > len(words)


def read_ifs(text: str, name: str = "unnamed") -> Reading:
    """Read all entries of an .ifs file.

    Parameters
    ----------
    text : str
        The whole file. Fractint's first version wrote nothing but the numbers of a single shape; so do many people.
    name : str
        What to call an entry without a name.

    Returns
    -------
    Reading
        With a problem for each entry that is broken.

    Raises
    ------
    FormatError
        If there is no entry at all, as in files of other kinds.
    """
    entries, problems, found = [], [], False
    if "{" not in text and re.search(r"\d", re.sub(r";.*", "", text)):
        text = f"{{{text}\n}}"
    for block in _blocks(text, name):
        if block.is_remark:
            continue
        found = found or block.looks_like_maps
        try:
            entries.append(_entry(block))
        except FormatError as error:
            problems.append(str(error))
    if not found:
        raise FormatError(NO_SHAPES)
    return reading(entries, problems)


def _blocks(text: str, unnamed: str) -> Iterator[_Block]:
    """Cut a file into blocks, following its lines so that each number can be found again."""
    heading: list[str] = []
    block = None
    for line, content in enumerate(re.split(r"\r\n|\r|\n", text), 1):
        code, _, comment = content.partition(";")
        for piece in re.split(r"([{}])", code):
            if piece == "{":
                if block is not None:
                    # This one was never closed; the last words before the brace name the next entry.
                    named = block.rows and not all(map(NUMBER.fullmatch, block.rows[-1][1]))
                    heading = [" ".join(block.rows.pop()[1])] if named else []
                    yield block
                block = _opened(heading, line, unnamed)
            elif piece == "}":
                if block is not None:
                    block.closed = True
                    yield block
                block, heading = None, []
            elif block is None:
                heading.append(piece)
            else:
                block.in_space = block.in_space or bool(IN_SPACE.search(piece))
                if words := re.sub(r"[,\x1a]", " ", IN_SPACE.sub(" ", piece)).split():
                    block.rows.append((line, words))
        if block is not None and not block.rows and (match := NAME_COMMENT.fullmatch(comment)):
            block.name = _unquoted(match[1], block.name)
    if block is not None:
        yield block


def _opened(heading: list[str], line: int, unnamed: str) -> _Block:
    """Start a block whose name is in the lines before its brace, the nearest one that has any text."""
    in_space = False
    for text in reversed(heading):
        in_space = in_space or bool(IN_SPACE.search(text))
        name = " ".join(IN_SPACE.sub(" ", text).split())
        if name:
            return _Block(name, line, in_space, is_remark=name.casefold() == "comment")
    return _Block(unnamed, line, in_space)


def _unquoted(quoted: str, otherwise: str) -> str:
    try:
        name = json.loads(quoted)
    except ValueError:
        return otherwise
    return name if isinstance(name, str) else otherwise


def _entry(block: _Block) -> Entry:
    """Turn a block's words into maps."""
    if not block.closed:
        raise FormatError(f"{block.place}: the entry ends without a closing brace.")
    if not block.rows:
        raise FormatError(f"{block.place}: the entry has no maps.")
    rows = [[_number(word, block, line) for word in words] for line, words in block.rows]
    notes: tuple[str, ...] = ()
    size = 12 if block.in_space else 6
    columns = _columns(rows, size)
    if columns == 13:
        size = 12
    numbers = np.concatenate(rows)
    if columns is not None:
        table = numbers.reshape(-1, columns)
    elif {len(row) for row in rows} == {size, size + 1}:
        table = np.array([row[:size] for row in rows])
        notes = (f"{called(block.name)}: not every map has a probability, so they are taken from the maps' areas.",)
    else:
        raise FormatError(_uneven(block, rows, size))
    if len(table) > LARGEST_COUNT:
        raise FormatError(f"{block.place}: the entry has {len(table)} maps; more than {LARGEST_COUNT} are not read.")
    weights = table[:, size] if table.shape[1] > size else None
    entry = Entry(block.name, _maps(table[:, :size]), notes=notes)
    return entry if weights is None else _weighted(entry, weights, block)


def _number(word: str, block: _Block, line: int) -> float:
    try:
        return number(word)
    except FormatError as error:
        raise FormatError(f"{called(block.name)}, line {line}: {error}") from None


def _columns(rows: list[list[float]], size: int) -> int | None:
    """How many numbers make up a map: `size`, or one more where there are probabilities; None if that does not tell.

    The count of all numbers decides where it can, unless each line is a map, some with a probability and some without.
    Where it fits both ways, probabilities that sum to one decide, then the lines, then probabilities that nearly sum to
    one. Some people write them in percent.
    """
    numbers = np.concatenate(rows)
    counts = {len(row) for row in rows}

    def sums_to_one(columns: int, tolerance: float) -> bool:
        if len(numbers) % columns:
            return False
        last = numbers[columns - 1 :: columns]
        return bool((last >= 0).all() and min(abs(last.sum() - 1), abs(last.sum() / PERCENT - 1)) <= tolerance)

    if size == 6 and counts == {13} and not sums_to_one(7, 1e-6):
        return 13
    if counts == {size, size + 1} and not sums_to_one(size + 1, 1e-6):
        return None
    fits = [columns for columns in (size + 1, size) if len(numbers) % columns == 0]
    if len(fits) < 2:
        return fits[0] if fits else None
    if sums_to_one(size + 1, 1e-6):
        return size + 1
    for columns in fits:
        if counts == {columns}:
            return columns
    return size + 1 if sums_to_one(size + 1, ROUNDING) else size


def _uneven(block: _Block, rows: list[list[float]], size: int) -> str:
    """Say which line of an entry has too many or too few numbers."""
    letters = "a to l" if size == 12 else "a to f"
    needed = f"a map takes {size + 1} ({letters} and the probability), or {size} without it"
    counts = Counter(len(row) for row in rows)
    usual = counts.most_common(1)[0][0]
    odd = [(line, row) for (line, _), row in zip(block.rows, rows, strict=True) if len(row) != usual]
    if usual in (size, size + 1) and len(odd) == 1:
        line, row = odd[0]
        return f"{called(block.name)}, line {line}: {_counted(len(row))} in this line; {needed}."
    return f"{block.place}: the entry has {_counted(sum(map(len, rows)))}; {needed}."


def _counted(count: int) -> str:
    return "1 number" if count == 1 else f"{count} numbers"


def _maps(table: np.ndarray) -> np.ndarray:
    """Maps (N, 2, 3) or (N, 3, 4) from rows of their linear parts and then their translations."""
    side = 2 if table.shape[1] == 6 else 3
    linear = table[:, : side * side].reshape(-1, side, side)
    return np.concatenate([linear, table[:, side * side :, None]], axis=2)


def _weighted(entry: Entry, weights: np.ndarray, block: _Block) -> Entry:
    """Give an entry its probabilities; maps that are never used are left out, as they are when Fractint draws."""
    for k in np.flatnonzero(weights < 0):
        raise FormatError(f"{block.place}: the probability of map {k + 1} is negative.")
    used = weights > 0
    if not used.any():
        return entry
    notes = [
        f"{called(block.name)}, map {k + 1}: its probability is 0, so it is never drawn and is left out."
        for k in np.flatnonzero(~used)
    ]
    return replace(entry, maps=entry.maps[used], weights=weights[used], notes=(*entry.notes, *notes))


def write_ifs(entries: Iterable[Entry]) -> str:
    """Write entries as an .ifs file that reads back equal. Colors have no place in it.

    Raises
    ------
    FormatError
        If an entry has chaos, a map that is hidden or faint, or one without weight.
    """
    taken: set[str] = set()
    blocks = []
    for entry in entries:
        require_writable(entry)
        if entry.transitions is not None:
            raise FormatError(
                f"{called(entry.name)} has chaos, for which an .ifs file has no place; write a .flame file."
            )
        if entry.opacities is not None and (entry.opacities != 1).any():
            k = int(np.argmax(entry.opacities != 1))
            opacity = entry.opacities[k]
            raise FormatError(
                f"{called(entry.name)}, map {k + 1}: it has an opacity of {opacity:g}, for which an .ifs file "
                "has no place; write a .flame file."
            )
        # Fractint ends a name at a space, and takes names that differ in case for one.
        plain = re.sub(r"[^A-Za-z0-9_.+-]", "_", entry.name) or "_"
        if plain.casefold() == "comment":
            plain += "_"
        while plain.casefold() in taken:
            plain += "_"
        taken.add(plain.casefold())
        lines = [f"{plain} (3D) {{" if entry.dimension == 3 else f"{plain} {{"]
        if plain != entry.name:
            lines.append(f"  ; name: {json.dumps(entry.name)}")
        side = entry.dimension
        for matrix, weight in zip(np.asarray(entry.maps, dtype=float), entry.known_weights, strict=True):
            numbers = [*matrix[:, :side].ravel(), *matrix[:, side], weight]
            lines.append("  " + " ".join(repr(float(each)) for each in numbers))
        blocks.append("\n".join([*lines, "}\n"]))
    return "\n".join(blocks)

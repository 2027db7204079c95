"""Files of shapes that people have: Fractint's .ifs and the .flame of the fractal flame programs.

Names are kept, problems are sentences, and what is written reads back equal to the bit.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from pathlib import Path

from ..ifs import IFS, IFSError
from .entry import Entry, FormatError, Reading
from .flame import read_flames
from .flame_writing import palette_of, write_flames
from .fractint import read_ifs, write_ifs

__all__ = [
    "SUFFIXES",
    "Entry",
    "FormatError",
    "Reading",
    "palette_of",
    "read_file",
    "read_shapes",
    "read_text",
    "write_file",
    "write_shapes",
    "write_text",
]

SUFFIXES = (".ifs", ".flame", ".flam3")

FLAME = re.compile(r"<\s*(jwf-)?(flame|xform|finalxform)\b", re.IGNORECASE)

LARGEST_FILE = 64 * 2**20
"""Bytes beyond which a file is surely something else."""

PROBLEMS_SHOWN = 10


def read_text(text: str, name: str = "unnamed") -> Reading:
    """Read shapes from text in either format, such as the clipboard holds.

    Parameters
    ----------
    text : str
    name : str
        What to call a shape that is nothing but numbers.

    Raises
    ------
    FormatError
        If it has no entry of either format. Entries that are there and broken are problems of the reading.
    """
    if not text.strip():
        raise FormatError("There is no text; copy the entries of an .ifs file or a flame first.")
    # A comment of an .ifs file may speak of flames, and an entity of a flame ends like a comment begins.
    code = re.sub(r";[^\r\n]*", "", text)
    if FLAME.search(code) or (code.lstrip("\ufeff \t\r\n").startswith("<") and FLAME.search(text)):
        return read_flames(text)
    return read_ifs(text, name)


def read_file(path: str | Path) -> Reading:
    """Read the shapes of a file, whatever its suffix says.

    Raises
    ------
    FormatError
        If the file cannot be opened or has no entry of either format.
    """
    path = Path(path)
    try:
        if path.stat().st_size > LARGEST_FILE:
            raise FormatError(f"“{path.name}” has more than {LARGEST_FILE // 2**20} MB; it is no file of shapes.")
        data = path.read_bytes()
    except (OSError, ValueError) as error:
        raise FormatError(f"“{path.name}” cannot be read: {error}.") from error
    try:
        return read_text(_decoded(data), path.stem)
    except FormatError as error:
        raise FormatError(f"“{path.name}”: {error}") from error


def read_shapes(path: str | Path) -> dict[str, IFS]:
    """Read the IFSs in a file, of the plane or of space; `read_file` also gives the other entries, and what is wrong.

    Parameters
    ----------
    path : str or Path
        An .ifs or a .flame file.

    Returns
    -------
    dict
        IFSs by name, in the order of the file; flames with chaos are recurrent.

    Raises
    ------
    FormatError
        If there are none; the message says why.
    """
    found = read_file(path)
    if not found.shapes:
        reasons = [*found.problems, *(_reason(entry) for entry in found.entries)]
        more = [f"There are {len(reasons) - PROBLEMS_SHOWN} more problems."] if len(reasons) > PROBLEMS_SHOWN else []
        head = f"“{Path(path).name}” has no shape that can be used."
        raise FormatError("\n".join([head, *reasons[:PROBLEMS_SHOWN], *more]))
    return found.shapes


def write_text(entries: Iterable[Entry], suffix: str) -> str:
    """Write entries in the format of a suffix of `SUFFIXES`.

    Raises
    ------
    FormatError
        If there are none, or one of them has no place in the format.
    """
    entries = list(entries)
    if not entries:
        raise FormatError("There are no shapes to write.")
    if suffix.lower() == ".ifs":
        return write_ifs(entries)
    if suffix.lower() in SUFFIXES:
        return write_flames(entries)
    raise FormatError(f"“{suffix}” is no format of shapes; use {', '.join(SUFFIXES)}.")


def write_file(path: str | Path, entries: Iterable[Entry]) -> None:
    """Write entries into a file whose suffix says the format; nothing is written unless all of them can be.

    Raises
    ------
    FormatError
        As `write_text`, and if the file cannot be written.
    """
    path = Path(path)
    text = write_text(entries, path.suffix)
    try:
        path.write_bytes(text.encode("utf-8"))
    except (OSError, ValueError) as error:
        raise FormatError(f"“{path.name}” cannot be written: {error}.") from error


def write_shapes(path: str | Path, shapes: Mapping[str, IFS]) -> None:
    """Write IFSs by name into an .ifs or a .flame file.

    Raises
    ------
    FormatError
        As `write_file`.
    """
    write_file(path, [Entry.of(name, ifs) for name, ifs in shapes.items()])


def _reason(entry: Entry) -> str:
    """Say why an entry is no IFS of the plane."""
    try:
        entry.ifs()
    except IFSError as error:
        return str(error)
    return ""


def _decoded(data: bytes) -> str:
    """Decode a file: by its byte order mark, as UTF-8, or else as Latin-1, which takes any bytes."""
    for mark, encoding in ((b"\xff\xfe", "utf-16"), (b"\xfe\xff", "utf-16"), (b"\xef\xbb\xbf", "utf-8-sig")):
        if data.startswith(mark):
            return data.decode(encoding, errors="replace")
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError:
        return data.decode("latin-1")

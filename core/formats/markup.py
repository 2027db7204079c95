"""The tags of a .flame file, read leniently: programs write several roots, bare ampersands and attributes run together.

Nothing but tags is understood. Declarations are skipped, so that a file can neither define entities nor name others.
"""

from __future__ import annotations

import html
import re
from bisect import bisect_right
from collections.abc import Iterator
from dataclasses import dataclass

COMMENT = re.compile(r"<!--(?:(?!-->).)*+(?:-->|\Z)", re.DOTALL)
TAG = re.compile(r"<(/?)\s*([A-Za-z][\w.:-]*+)((?:[^<>\"']|\"[^\"]*\"|'[^']*')*+)>")
WORDS = re.compile(r"(?:[A-Za-z_][\w.]*+\s*+)*+/?\s*")
"""What may be left of a tag without its attributes: JWildfire has some with spaces in their names."""

OPENING = re.compile(r"<\s*+/?\s*+([A-Za-z][\w.:-]*)")
ATTRIBUTE = re.compile(r"(?<![\w.:#-])([\w.:#-]++)\s*+=\s*+(?:\"([^\"]*)\"|'([^']*)')")


@dataclass(frozen=True)
class Tag:
    """One tag and the text up to the next one.

    `kind` is ``"open"``, ``"close"``, ``"empty"`` for one that closes itself, or ``"broken"`` for one that cannot be
    read, whose name is then all that is known. Attributes are pairs in the order of the file, as programs repeat them.
    """

    kind: str
    name: str
    attributes: tuple[tuple[str, str], ...]
    text: str
    line: int
    is_sound: bool = True
    """Whether there is nothing in the tag that makes no sense, as after a missing quote."""


def tags(text: str) -> Iterator[Tag]:
    """Read the tags of a file, with the lines they stand in."""
    text = COMMENT.sub(lambda match: re.sub(r"[^\r\n]", " ", match[0]), text)
    line_ends = [match.end() for match in re.finditer(r"\r\n|\r|\n", text)]
    start = text.find("<")
    while start >= 0:
        line = bisect_right(line_ends, start) + 1
        match = TAG.match(text, start)
        if match:
            following = text.find("<", match.end())
            between = text[match.end() : following if following >= 0 else len(text)]
            yield _tag(match, between, line)
        else:
            following = text.find("<", start + 1)
            if opening := OPENING.match(text, start):
                yield Tag("broken", opening[1].lower(), (), "", line)
        start = following


def _tag(match: re.Match, text: str, line: int) -> Tag:
    closing, name, inside = match.groups()
    kind = "close" if closing else "empty" if inside.rstrip().endswith("/") else "open"
    attributes = tuple(
        (key, html.unescape(double if single is None else single))
        for key, double, single in ((pair[1], pair[2], pair[3]) for pair in ATTRIBUTE.finditer(inside))
    )
    is_sound = WORDS.fullmatch(ATTRIBUTE.sub("", inside).strip()) is not None
    return Tag(kind, name.lower(), attributes, text, line, is_sound)


def quoted(text: str) -> str:
    """Write a text as the value of an attribute."""
    for character, escape in (("&", "&amp;"), ("<", "&lt;"), (">", "&gt;"), ('"', "&quot;")):
        text = text.replace(character, escape)
    return '"' + re.sub(r"[\t\n\r]", lambda match: f"&#{ord(match[0])};", text) + '"'


def is_writable(text: str) -> bool:
    """Whether a text has only characters that XML allows."""
    return not re.search(r"[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]", text)

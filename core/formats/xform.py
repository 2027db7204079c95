"""One transform of a flame, an ``<xform>``: its affine parts, and whether all that it does is affine.

A flame's transform takes a point through `coefs`, then sums up variations of the result, then goes through `post`. It
is an affine map if `linear` is the only variation that moves points in the plane (Draves & Reckase 2003, The Fractal
Flame Algorithm, Section 3).
"""

from __future__ import annotations

import re

import numpy as np

from ..affine import compose
from .entry import LARGEST_NUMBER, FormatError, number
from .markup import Tag

LINEAR = {"linear", "linear3D"}
BEFORE_OR_AFTER = {"pre_linear", "post_linear"}
"""Scale by their weight before and after the sum of variations."""

DEPTH = re.compile(r"(pre_|post_)?(flatten|zscale|ztranslate|zcone|zblur)(_wf)?")
"""Variations that change nothing but z."""

OTHER = re.compile(
    r"weight|color|symmetry|color_speed|color_type|targetcolor|animate|animate_origin|opacity|coefs|post|chaos|plotmode"
    r"|name|var|var1|var_color|enabled|antialias_\w+|material\w*|mod_\w+|wfield_\w+|motion_\w+|(yz|zx)(Coefs|Post)\w*"
    r"|(xy)?(Coefs|Post)\w+"
)
"""Attributes that are no variations."""

NEARLY_NUMBER = re.compile(r"(?=.*\d)[\d.,eE+-]+|[+-]?(inf|infinity|nan)", re.IGNORECASE)
"""What other programs take for some number, such as the part before a comma; attributes with words are no weights."""

IDENTITY = np.eye(2, 3)


class Xform:
    """The attributes of one transform, with the words that a problem with it begins with.

    Parameters
    ----------
    tag : Tag
    called : str
        Such as ``“fern”, map 2``.
    """

    def __init__(self, tag: Tag, called: str) -> None:
        self.called = called
        # JWildfire writes a variation's second use as linear#2#.
        self.pairs = [(re.sub(r"#\d+#", "", name), value) for name, value in tag.attributes]
        self.values = dict(self.pairs)
        if tag.kind == "broken" or not tag.is_sound:
            raise FormatError(f"{called} (line {tag.line}): the tag cannot be read; look for a quote that is missing.")

    def numbers(self, name: str, default: list[float]) -> list[float]:
        """Numbers of an attribute; raises FormatError."""
        if name not in self.values:
            return default
        return [self._number(name, word) for word in self.values[name].replace(",", " ").split()]

    def number(self, name: str, default: float) -> float:
        """The first number of an attribute, where a comma may be meant for a point; raises FormatError."""
        words = self.values.get(name, "").split()
        return self._number(name, words[0]) if words else default

    def _number(self, name: str, word: str) -> float:
        try:
            return number(word)
        except FormatError as error:
            raise FormatError(f"{self.called}: in {name}, {error}") from None

    def affine(self, name: str) -> np.ndarray:
        """Affine part (2, 3) that the attribute `coefs` or `post` holds column by column; raises FormatError."""
        numbers = self.numbers(name, [1, 0, 0, 1, 0, 0])
        if len(numbers) != 6:
            raise FormatError(f"{self.called}: {name} has {len(numbers)} numbers instead of 6.")
        return np.array(numbers).reshape(3, 2).T

    @property
    def color_speed(self) -> float:
        """Share of the map's own color; `symmetry` is the older way to say it."""
        return self.number("color_speed", (1 - self.number("symmetry", 0.0)) / 2)

    @property
    def opacity(self) -> float:
        """How visible the map's attractorlet is."""
        return self.number("opacity", 0.0 if self.values.get("plotmode", "").casefold() == "off" else 1.0)

    def map(self) -> np.ndarray:
        """Return the transform as an affine map (2, 3), y still pointing down.

        Raises
        ------
        FormatError
            If the transform is not affine; the message names the variations that are not.
        """
        scale = self._scale()
        for plane in ("yz", "zx"):
            for part in ("Coefs", "Post"):
                if self.numbers(plane + part, [1, 0, 0, 1, 0, 0]) != [1, 0, 0, 1, 0, 0]:
                    raise FormatError(f"{self.called}: it turns out of the plane ({plane}{part}), which is not read.")
        result, post = self.affine("coefs"), self.affine("post")
        with np.errstate(over="ignore", invalid="ignore"):
            if scale != 1:
                result = result * scale
            if not np.array_equal(post, IDENTITY):
                result = compose(post, result)
        if not (np.abs(result) <= LARGEST_NUMBER).all():
            raise FormatError(f"{self.called}: its numbers are too large.")
        return result

    def _scale(self) -> float:
        """The factor by which the variations scale; raises FormatError for any that do not scale."""
        total, factor, others = 0.0, 1.0, []
        for name, weight in self._variations():
            if name in LINEAR:
                total += weight
            elif name in BEFORE_OR_AFTER:
                factor *= weight
            else:
                others.append(name)
        if others:
            names = " and ".join([", ".join(others[:-1]), others[-1]] if len(others) > 1 else others)
            verb = "are not linear variations" if len(others) > 1 else "is not a linear variation"
            raise FormatError(f"{self.called}: {names} {verb}, so it is no affine map.")
        return total * factor

    def _variations(self):
        """Names and weights of the variations, those without effect left out."""
        if "var" in self.values:
            # The oldest files list the weights of all variations by number, linear first.
            weights = self.numbers("var", [])
            yield from ((f"variation {k}" if k else "linear", weight) for k, weight in enumerate(weights) if weight)
        if "var1" in self.values:
            kind = int(self.number("var1", 0))
            yield f"variation {kind}" if kind else "linear", 1.0
        for name, value in self.pairs:
            if OTHER.fullmatch(name) or DEPTH.fullmatch(name):
                continue
            known = name in LINEAR or name in BEFORE_OR_AFTER
            if not known and not NEARLY_NUMBER.fullmatch(value.strip()):
                continue
            weight = self._number(name, value.strip())
            if name.endswith("_fx_priority"):
                if name.removesuffix("_fx_priority") in LINEAR and weight:
                    yield f"{name.removesuffix('_fx_priority')} ahead of or after the others", weight
            elif weight and not self._is_parameter(name):
                yield name, weight

    def _is_parameter(self, name: str) -> bool:
        """Whether an attribute belongs to another one: julian_power to julian."""
        owners = (name[: match.start()] for match in re.finditer("_", name))
        return any(owner in self.values and not OTHER.fullmatch(owner) for owner in owners)

"""Fractal flames of Apophysis, flam3, Fractorium, JWildfire and their like, so far as all their maps are affine.

In a flame y points down; here it points up, so every map is mirrored on its way in and out. A final transform F draws
F(A) instead of the attractor A, which is the attractor of the maps ``F w F^-1``. The camera of a flame is left alone.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from ..affine import compose, invert
from .entry import LARGEST_COUNT, LARGEST_NUMBER, NO_SHAPES, NUMBER, Entry, FormatError, Reading, called, reading
from .markup import Tag, tags
from .symmetry import isometry, symmetry_maps, unfold
from .xform import IDENTITY, Xform

FLAMES = ("flame", "jwf-flame")

MIRROR = np.array([[1.0, -1.0, 1.0], [-1.0, 1.0, -1.0]])
"""Factors that turn a map (2, 3) with y down into the same map with y up, and back."""

LARGEST_CONDITION = 1e8
"""Final transforms flatter than this leave too few digits of the maps."""


@dataclass
class _Flame:
    """What was found between ``<flame>`` and ``</flame>``, or within a layer of JWildfire's."""

    name: str
    line: int
    attributes: dict[str, str]
    xforms: list[Tag | int] = field(default_factory=list)
    """Transforms, and the kinds of symmetry between them, in the order of the file."""
    finals: list[Tag] = field(default_factory=list)
    palette: dict[int, np.ndarray] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)
    layers: list[_Flame] = field(default_factory=list)
    ending: str = "the file ends before its </flame>"

    @property
    def called(self) -> str:
        """The name, for a sentence."""
        return called(self.name)


def read_flames(text: str) -> Reading:
    """Read all flames of a file.

    Parameters
    ----------
    text : str
        The whole file.

    Returns
    -------
    Reading
        With a problem for each flame that is not affine, and for each thing that a flame does and the shape does not.

    Raises
    ------
    FormatError
        If there is no flame at all.
    """
    entries, problems, found = [], [], False
    for flame in _flames(text):
        found = True
        layers = [layer for layer in flame.layers if layer.attributes.get("visible", "1").strip() != "0"]
        if flame.layers and not layers:
            problems.append(f"{flame.called} (line {flame.line}): all its layers are hidden.")
        for layer in layers if flame.layers else [flame]:
            try:
                entries.append(_entry(layer))
            except FormatError as error:
                problems += str(error).split("\n")
    if not found:
        raise FormatError(NO_SHAPES)
    return reading(entries, problems)


# ---- the elements of a file ------------------------------------------------------------------------------------------


def _flames(text: str) -> Iterator[_Flame]:
    """Gather the tags of each flame."""
    flame, part, count = None, None, 0
    for tag in tags(text):
        if tag.name in FLAMES and tag.kind != "close":
            if flame is not None:
                flame.ending = f"the next flame begins in line {tag.line} before its </flame>"
                yield flame
            count += 1
            attributes = dict(tag.attributes)
            flame = part = _Flame(attributes.get("name") or f"flame {count}", tag.line, attributes)
            if tag.kind != "open":
                unreadable = "its tag cannot be read; look for a quote that is missing"
                flame.ending = unreadable if tag.kind == "broken" else ""
                yield flame
                flame = None
        elif tag.name in FLAMES:
            if flame is not None:
                flame.ending = ""
                yield flame
            flame = None
        elif tag.name in ("xform", "finalxform") and flame is None and tag.kind != "close":
            # Editors put transforms on the clipboard by themselves.
            count += 1
            flame = part = _Flame(f"flame {count}", tag.line, {}, ending="")
            _add(part, tag)
        elif flame is not None:
            if tag.name == "layer":
                part = flame
                if tag.kind == "open":
                    attributes = dict(tag.attributes)
                    name = attributes.get("name") or f"{flame.name} layer {len(flame.layers) + 1}"
                    part = _Flame(name, tag.line, attributes, ending="")
                    flame.layers.append(part)
            else:
                _add(part, tag)
    if flame is not None:
        yield flame


def _add(flame: _Flame, tag: Tag) -> None:
    """Add an element to the flame that it stands in."""
    if tag.kind == "close":
        return
    if tag.name == "xform":
        flame.xforms.append(tag)
    elif tag.name == "finalxform":
        flame.finals.append(tag)
    elif tag.name == "symmetry":
        kind = dict(tag.attributes).get("kind", "").strip()
        if re.fullmatch(r"[+-]?\d{1,3}", kind) and int(kind):
            flame.xforms.append(int(kind))
        else:
            flame.notes.append(f"{flame.called}: its symmetry is drawn by lot, and is left out.")
    elif tag.name == "motion":
        flame.notes.append(f"{flame.called}: its motion is left out.")
    elif tag.name in ("palette", "colors", "color"):
        _add_colors(flame, tag)


def _add_colors(flame: _Flame, tag: Tag) -> None:
    """Read the palette of a flame: hexadecimal text, hexadecimal data, or an element for each color."""
    attributes = dict(tag.attributes)
    if tag.name == "color":
        channels = attributes.get("rgb", attributes.get("rgba", "")).split()[:3]
        index = attributes.get("index", "")
        if re.fullmatch("[0-9]{1,3}", index) and len(channels) == 3 and all(map(NUMBER.fullmatch, channels)):
            flame.palette[int(index)] = np.clip(np.round(np.array(channels, float)), 0, 255).astype(np.uint8)
        return
    # In <colors> the first of four bytes means nothing, in an RGBA palette the last one.
    digits = re.sub(r"\s", "", attributes.get("data", tag.text))
    first, width = (2, 8) if tag.name == "colors" else (0, 8 if attributes.get("format") == "RGBA" else 6)
    if not digits:
        return  # One of flam3's own palettes, by its number.
    if re.fullmatch(r"[0-9A-Fa-f]+", digits) and len(digits) % width == 0:
        table = np.frombuffer(bytes.fromhex(digits), np.uint8).reshape(-1, width // 2)
        flame.palette = dict(enumerate(table[:, first // 2 : first // 2 + 3]))
    else:
        flame.notes.append(f"{flame.called}: its palette cannot be read, and is left out.")


# ---- from a flame to an entry ----------------------------------------------------------------------------------------


def _entry(flame: _Flame) -> Entry:
    """Turn a flame into an entry; raises FormatError with all that stands in the way, map by map."""
    if flame.ending:
        raise FormatError(f"{flame.called} (line {flame.line}): {flame.ending}.")
    if not any(isinstance(item, Tag) for item in flame.xforms):
        raise FormatError(f"{flame.called} (line {flame.line}): the flame has no transforms.")
    maps, rows, problems = [], [], []
    for item in flame.xforms:
        if isinstance(item, int):
            rows += [_Row(color=color) for color in _symmetry_colors(item)]
            maps += [np.column_stack([linear, [0.0, 0.0]]) for linear in symmetry_maps(item)]
            continue
        try:
            xform = Xform(item, f"{flame.called}, map {len(maps) + 1}")
            rows.append(_Row.of(xform))
            maps.append(xform.map())
        except FormatError as error:
            problems.append(str(error))
            maps.append(IDENTITY)
    try:
        final = _final(flame)
    except FormatError as error:
        problems.append(str(error))
    if problems:
        raise FormatError("\n".join(problems))
    if len(maps) > LARGEST_COUNT:
        raise FormatError(f"{flame.called} has {len(maps)} maps; more than {LARGEST_COUNT} are not read.")
    entry = _unfolded(_used(_tabled(flame, np.array(maps), rows)))
    if not np.array_equal(final, IDENTITY):
        with np.errstate(over="ignore", invalid="ignore"):
            entry = replace(entry, maps=compose(compose(final, entry.maps), invert(final)))
        if not (np.abs(entry.maps) <= LARGEST_NUMBER).all():
            raise FormatError(f"{flame.called}, final transform: its numbers are too large.")
    return replace(entry, maps=entry.maps * MIRROR)


@dataclass(frozen=True)
class _Row:
    """What a flame says of one map besides where it takes points; a map of a symmetry by default."""

    weight: float | None = 1.0
    color: float = 0.0
    color_speed: float = 0.0
    opacity: float = 1.0
    chaos: tuple[float, ...] = ()

    @staticmethod
    def of(xform: Xform) -> _Row:
        """Read the attributes of a transform; raises FormatError."""
        weight = xform.number("weight", 0.0) if "weight" in xform.values else None
        chaos = xform.numbers("chaos", [])
        if min([weight or 0.0, *chaos]) < 0:
            raise FormatError(f"{xform.called}: its weight or chaos is negative.")
        opacity = min(max(xform.opacity, 0.0), 1.0)
        return _Row(weight, xform.number("color", 0.0), xform.color_speed, opacity, tuple(chaos))


def _symmetry_colors(kind: int) -> list[float]:
    """Return the colors of the maps that a symmetry adds, as flam3 spreads them."""
    order = abs(kind)
    turns = [(k - 1) / (order - 2) if order > 2 else 0.0 for k in range(1, order)]
    return [1.0, *turns] if kind < 0 else turns


def _final(flame: _Flame) -> np.ndarray:
    """Return the map (2, 3) that the final transforms are, one after the other; raises FormatError."""
    final, part = IDENTITY, f"{flame.called}, final transform"
    for tag in flame.finals:
        xform = Xform(tag, part)
        if xform.values.get("enabled", "1").strip() == "0" or xform.opacity == 0:
            continue
        if xform.opacity != 1:
            raise FormatError(f"{part}: an opacity of {xform.opacity:g} draws two shapes at once.")
        with np.errstate(over="ignore", invalid="ignore"):
            final = compose(xform.map(), final)
        if not (np.abs(final) <= LARGEST_NUMBER).all():
            raise FormatError(f"{part}: its numbers are too large.")
        if np.linalg.cond(final[:, :2]) > LARGEST_CONDITION:
            raise FormatError(f"{part}: it is flat, and what it leaves of the shape need not be an attractor.")
    return final


def _tabled(flame: _Flame, maps: np.ndarray, rows: list[_Row]) -> Entry:
    """Put the rows into arrays, and note what the shape will not show."""
    count = len(maps)
    transitions = np.ones((count, count))
    for following, row in zip(transitions, rows, strict=True):
        following[: len(row.chaos)] = row.chaos[:count]
    opacities = np.array([row.opacity for row in rows])
    solo = flame.attributes.get("soloxform", "").strip()
    if re.fullmatch(r"\d{1,6}", solo):
        opacities = (np.arange(count) == int(solo)).astype(float)
    notes = list(dict.fromkeys(flame.notes))
    if flame.attributes.get("post_symmetry_type", "NONE").upper() != "NONE":
        notes.append(f"{flame.called}: the copies that its post symmetry adds are left out.")
    weights = np.array([row.weight or 0.0 for row in rows])
    return Entry(
        flame.name,
        maps,
        weights=weights if weights.any() else None,
        transitions=None if (transitions == 1).all() else transitions,
        colors=np.array([row.color for row in rows]),
        color_speeds=np.array([row.color_speed for row in rows]),
        opacities=None if (opacities == 1).all() else opacities,
        palette=np.array([flame.palette[k] for k in sorted(flame.palette)]) if flame.palette else None,
        notes=tuple(notes),
    )


def _used(entry: Entry) -> Entry:
    """Leave out the maps without weight, and those that no map leads to, which a flame never uses.

    Raises FormatError if there is a map that nothing may follow.
    """
    weighted = entry.weights > 0 if entry.weights is not None else np.ones(entry.count, bool)
    notes = [f"{called(entry.name)}, map {k + 1}: it has no weight and is left out." for k in np.flatnonzero(~weighted)]
    used = weighted
    if entry.transitions is not None:
        used = _reached(entry.transitions > 0, weighted)
        for k in np.flatnonzero(used if used.any() else weighted):
            if not entry.transitions[k, weighted].any():
                raise FormatError(
                    f"{called(entry.name)}: no map may be applied after map {k + 1}, which chaos forbids."
                )
        notes += [
            f"{called(entry.name)}, map {k + 1}: chaos lets no map lead to it, so it is never drawn and is left out."
            for k in np.flatnonzero(weighted & ~used)
        ]
    entry = replace(entry, notes=(*entry.notes, *notes))
    return entry if used.all() else _chosen(entry, np.flatnonzero(used))


def _reached(allowed: np.ndarray, maps: np.ndarray) -> np.ndarray:
    """Which (N,) of some maps are applied again and again: those that some of these may come before."""
    reached = maps & allowed[maps].any(axis=0)
    return reached if (reached == maps).all() else _reached(allowed, reached)


def _chosen(entry: Entry, indices: np.ndarray) -> Entry:
    """Return the entry with the maps of some indices, which may repeat."""
    chosen = {
        name: None if array is None else array[indices]
        for name in ("maps", "weights", "colors", "color_speeds", "opacities")
        for array in (getattr(entry, name),)
    }
    transitions = None if entry.transitions is None else entry.transitions[np.ix_(indices, indices)]
    if transitions is not None and (transitions == 1).all():
        transitions = None
    return replace(entry, **chosen, transitions=transitions)


def _unfolded(entry: Entry) -> Entry:
    """Replace the maps that only turn or mirror, and have no color of their own, by more of the other maps."""
    isometries = [
        isometry(matrix) if speed == 0 else None for matrix, speed in zip(entry.maps, entry.color_speeds, strict=True)
    ]
    others = np.array([k for k, linear in enumerate(isometries) if linear is None], dtype=int)
    if len(others) in (0, entry.count) or entry.transitions is not None:
        return entry
    weights = np.ones(entry.count) if entry.weights is None else entry.weights
    frequencies = np.delete(weights, others) / weights.sum()
    opacities = np.ones(entry.count) if entry.opacities is None else entry.opacities
    linear = np.array([linear for linear in isometries if linear is not None])
    unfolded = unfold(linear, frequencies, np.delete(opacities, others))
    if unfolded is None or len(unfolded[0]) * len(others) > LARGEST_COUNT:
        return entry
    group, shares, seen = unfolded
    turned = np.concatenate([group @ entry.maps[k, :, :2] for k in others])
    moved = np.concatenate([group @ entry.maps[k, :, 2] for k in others])
    result = _chosen(entry, np.repeat(others, len(group)))
    # Drawn are the points that an isometry is applied to last, and those that none is.
    seen = seen + np.outer(opacities[others], np.arange(len(group)) == 0)
    return replace(
        result,
        maps=np.concatenate([turned, moved[:, :, None]], axis=2),
        weights=np.outer(weights[others], shares).ravel(),
        opacities=None if entry.opacities is None else np.minimum(seen / shares, 1.0).ravel(),
    )

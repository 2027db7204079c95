"""Shapes on objects to entries of files and back: colors become places in a palette, numbers keep their digits."""

import numpy as np
from mathutils import Color

from ..core.formats import Entry, palette_of
from ..core.ifs import IFSError
from .conversion import (
    MOST_RECURRENT,
    frame_colors,
    frame_of,
    morph_of,
    shape_colors,
    shape_ifs,
    shape_maps,
    shape_opacity,
    shape_transitions,
    write_shape,
)

LARGEST = 1e6
"""Beyond this the properties of a map do not go."""


def require_storable(entry: Entry) -> None:
    """Raise IFSError unless an entry can become the shape of an object."""
    ifs = entry.ifs()
    if ifs.transitions is not None and ifs.count > MOST_RECURRENT:
        raise IFSError(
            f"“{entry.name}” has chaos and {ifs.count} maps; "
            f"a recurrent shape on an object has {MOST_RECURRENT} at most."
        )
    for k in np.flatnonzero(np.abs(ifs.maps).max(axis=(1, 2)) > LARGEST):
        raise IFSError(f"“{entry.name}”, map {k + 1}: a map on an object has no numbers beyond {LARGEST:g}.")


def write_entry(shape, entry: Entry) -> None:
    """Fill a shape with an entry: its maps, weights and opacities, and its colors where it has a palette.

    Raises
    ------
    IFSError
        If the entry is more than a shape can hold, or the shape is a library override with another number of maps.
    """
    require_storable(entry)
    write_shape(shape, entry.ifs())
    if entry.colors is None or entry.palette is None:
        return
    places = np.clip(np.round(entry.colors * (len(entry.palette) - 1)), 0, len(entry.palette) - 1).astype(int)
    for item, color in zip(shape.maps, entry.palette[places] / 255, strict=True):
        item.color = Color(color).from_srgb_to_scene_linear()


def shape_entry(shape, name: str) -> Entry:
    """Return a shape as an entry; raises IFSError."""
    ifs = shape_ifs(shape)
    weights = ifs.weights if any(item.weight for item in shape.maps) else None
    transitions = shape_transitions(shape)
    transitions = None if transitions is None else _decimal(transitions)
    opacity = _decimal(shape_opacity(shape))
    return _entry(shape.name or name, _decimal(shape_maps(shape)), weights, transitions, opacity, shape_colors(shape))


def frame_entry(settings, name: str) -> Entry:
    """Return the shape that a morph has at its (u,v) and swell as an entry; raises IFSError."""
    ifs = frame_of(settings, morph_of(settings))
    return _entry(name, ifs.maps, ifs.weights, ifs.transitions, ifs.opacity, frame_colors(settings)[:, :3])


def _entry(name, maps, weights, transitions, opacity, colors) -> Entry:
    opacities = None if (opacity == 1).all() else opacity
    colors = [Color(color).from_scene_linear_to_srgb() for color in colors.tolist()]
    if len(colors) > 256:
        return Entry(name, maps, weights, transitions, opacities=opacities)
    places, palette = palette_of(np.array(colors))
    return Entry(name, maps, weights, transitions, colors=places, opacities=opacities, palette=palette)


def _decimal(values: np.ndarray) -> np.ndarray:
    """Numbers in single precision as the shortest decimals that stand for them: 0.1, not 0.10000000149."""
    return np.array([float(str(value)) for value in values.astype(np.float32).ravel()]).reshape(values.shape)

"""Write shapes as fractal flames that flam3, Apophysis, Fractorium and JWildfire open, and that read back equal."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from ..ifs import IFSError
from ..shading import attractorlet_colors
from .entry import Entry, FormatError, called, require_writable
from .flame import MIRROR
from .markup import is_writable, quoted

SIZE = (640, 480)
MARGIN = 0.9

PALETTE_COLORS = 256


def write_flames(entries: Iterable[Entry]) -> str:
    """Write entries as a .flame file, y turned to point down and a palette made where there is none.

    Raises
    ------
    FormatError
        If an entry lies in space, has a map without weight, or a name that XML cannot hold.
    """
    return "\n".join(['<flames name="IFS Morph">', *(_flame(entry) for entry in entries), "</flames>\n"])


def palette_of(colors: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Make a palette that runs through given colors.

    Parameters
    ----------
    colors : (N, 3)
        Red, green and blue from 0 to 1, N at most 256.

    Returns
    -------
    places : (N,)
        Place of each color, from 0 to 1.
    palette : (256, 3) uint8
    """
    places = np.round(np.linspace(0, PALETTE_COLORS - 1, len(colors))) / (PALETTE_COLORS - 1)
    steps = np.arange(PALETTE_COLORS) / (PALETTE_COLORS - 1)
    channels = [np.interp(steps, places, np.clip(channel, 0, 1)) for channel in np.asarray(colors).T]
    return places, np.round(255 * np.stack(channels, axis=1)).astype(np.uint8)


def _flame(entry: Entry) -> str:
    require_writable(entry)
    if entry.dimension == 3:
        raise FormatError(
            f"{called(entry.name)} lies in space, for which a .flame file has no place; write an .ifs file."
        )
    if not is_writable(entry.name):
        raise FormatError(f"The name {entry.name!r} has characters that no .flame file can hold; choose another.")
    places, palette = palette_of(attractorlet_colors(min(entry.count, PALETTE_COLORS))[:, :3])
    places = np.resize(places, entry.count)
    center, scale = _view(entry)
    lines = [
        f'  <flame name={quoted(entry.name)} version="IFS Morph" size="{SIZE[0]} {SIZE[1]}" center="{center}" '
        f'scale="{scale}" oversample="1" filter="0.5" quality="50" background="0 0 0" brightness="4" gamma="4" '
        'vibrancy="1">'
    ]
    flipped = np.asarray(entry.maps, dtype=float) * MIRROR
    colors = places if entry.colors is None else entry.colors
    weights = entry.known_weights
    for k in range(entry.count):
        parts = [f"weight={_text([weights[k]])} color={_text([colors[k]])}"]
        if entry.color_speeds is not None:
            parts.append(f"color_speed={_text([entry.color_speeds[k]])}")
        parts.append(f'linear="1" coefs={_text(flipped[k].T.ravel())}')
        if entry.transitions is not None:
            parts.append(f"chaos={_text(entry.transitions[k])}")
        if entry.opacities is not None:
            parts.append(f"opacity={_text([entry.opacities[k]])}")
        lines.append(f"    <xform {' '.join(parts)}/>")
    table = palette if entry.palette is None else entry.palette
    lines.append(f'    <palette count="{len(table)}" format="RGB">')
    lines += ["      " + row.tobytes().hex().upper() for row in np.array_split(table, -(-len(table) // 8))]
    return "\n".join([*lines, "    </palette>", "  </flame>"])


def _text(numbers: Iterable[float]) -> str:
    return '"' + " ".join(repr(float(each)) for each in numbers) + '"'


def _view(entry: Entry) -> tuple[str, str]:
    """Center and pixels to a unit of a camera that shows the whole shape."""
    try:
        left, bottom, right, top = entry.ifs().bounds
    except IFSError:
        left, bottom, right, top = -1.0, -1.0, 1.0, 1.0
    extents = max(right - left, 1e-6) / SIZE[0], max(top - bottom, 1e-6) / SIZE[1]
    return f"{(left + right) / 2:.6g} {-(bottom + top) / 2:.6g}", f"{MARGIN / max(extents):.6g}"

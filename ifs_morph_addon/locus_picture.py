"""The locus of an object, and the picture of it in the file.

The picture, where its nodes lie and what it was computed for are all in one image, and its pixels are packed: so they
fit each other in every saved file and after every undo.
"""

import bpy
import numpy as np

from ..core.ifs import IFSError
from ..core.locus import Locus, compute_locus_steps, nodes
from ..core.parallel import part
from .conversion import locus_fingerprint, morph_of, tolerance

BAND = 65536
"""Nodes that are colored in one step."""

COMPUTE_SHARE = 0.95
"""Share of the progress that the computing takes; the rest is coloring."""

WAITING = 0.2
"""Brightness of a picture that waits for its pixels."""

_last: dict[tuple[str, bool], Locus] = {}
"""The locus computed last, by its fingerprint and whether with gaps: planning needs more of it than its picture."""


def locus_steps(settings, gap: bool = True):
    """Yield the share done and return the locus of an object's morph; at once if it was the last one computed.

    The picture shows how wide the gaps are; planning a path needs the states alone, which take less time.
    """
    key = locus_fingerprint(settings)
    for with_gap in (True, gap):
        if (key, with_gap) in _last:
            return _last[key, with_gap]
    locus = yield from _steps(settings, settings.locus.resolution, gap)
    _last.clear()
    _last[key, gap] = locus
    return locus


def coarse_locus_steps(settings, resolution: int):
    """Yield the share done and return the locus with fewer nodes."""
    return (yield from _steps(settings, min(resolution, settings.locus.resolution), True))


def _steps(settings, resolution, gap):
    low, high = settings.locus.domain
    if not low < high:
        raise IFSError(f"The domain of the locus runs from {low:g} to {high:g}; its end must be above its start.")
    return (yield from compute_locus_steps(morph_of(settings), resolution, tolerance(settings), (low, high), gap=gap))


def forget() -> None:
    """Let go of the last locus."""
    _last.clear()


def is_current(settings) -> bool:
    """Whether the picture in the file is that of the morph as it is."""
    image = settings.locus.image
    return image is not None and image.ifs_morph_locus.inputs == locus_fingerprint(settings)


def colored_steps(locus: Locus):
    """Yield the share done and return the pixels (V, U, 4) of a locus."""
    pixels = np.empty((*locus.state.shape, 4), dtype=np.float32)
    height = max(1, BAND // len(locus.u))
    for first in range(0, len(locus.v), height):
        rows = slice(first, first + height)
        band = Locus(locus.u, locus.v[rows], locus.state[rows], locus.gap[rows], locus.tolerance)
        pixels[rows] = band.picture()
        yield min(1.0, (first + height) / len(locus.v))
    return pixels


def compute_steps(owner):
    """Yield the share done; compute the locus of an object, keep its picture in the file, and return the locus.

    The picture is a new image, so that undo brings the one before back.
    """
    locus = yield from part(locus_steps(owner.ifs_morph), 0.0, COMPUTE_SHARE)
    pixels = yield from part(colored_steps(locus), COMPUTE_SHARE, 1.0)
    settings = owner.ifs_morph.locus
    before = settings.image
    image = _new_image(owner, locus)
    write(image, pixels, locus_fingerprint(owner.ifs_morph))
    settings.image = image
    if before is not None and before.library is None and not _users(before):
        name = before.name
        before.user_remap(image)
        bpy.data.images.remove(before)
        image.name = name
    return locus


def _new_image(owner, locus):
    image = bpy.data.images.new(f"{owner.name} Locus", len(locus.u), len(locus.v), alpha=False)
    _place(image, locus.u, locus.v)
    return image


def _users(image) -> list:
    """Morph objects whose locus an image shows."""
    return [owner for owner in bpy.data.objects if owner.ifs_morph.locus.image == image]


def write(image, pixels, inputs: str) -> None:
    """Put the pixels (V, U, 4) of a locus into its image, for good."""
    show(image, pixels)
    image.pack()
    image.ifs_morph_locus.inputs = inputs


def show(image, pixels) -> None:
    """Put pixels into an image for the time being: the file keeps those of the last `write`."""
    image.pixels.foreach_set(pixels.ravel())
    image.update()


def put_back(image) -> None:
    """Show the pixels of the last `write` again."""
    if image.packed_file is not None:
        image.buffers_free()
        image.update()


def _place(image, u, v) -> None:
    picture = image.ifs_morph_locus
    picture.lowest = u[0], v[0]
    picture.spacing = u[1] - u[0]


def writable_picture(owner):
    """Image of an object's locus that is its own and has the nodes of its settings.

    Where either is not so it is made so, and then waits for the pixels: what it shows is of no morph.
    """
    settings = owner.ifs_morph.locus
    image = settings.image
    if image.library is not None or len(_users(image)) > 1:
        image = settings.image = image.copy()
    u, v = nodes(settings.resolution, tuple(settings.domain))
    picture = image.ifs_morph_locus
    placed = np.allclose((*picture.lowest, picture.spacing), (u[0], v[0], u[1] - u[0]), rtol=1e-6, atol=1e-6)
    if tuple(image.size) != (len(u), len(v)) or not placed:
        if image.packed_file is None and image.source == "GENERATED":
            image.generated_width, image.generated_height = len(u), len(v)
        else:
            image.scale(len(u), len(v))
        _place(image, u, v)
        picture.inputs = ""
        # What was scaled lies in the wrong place, and must not be saved there.
        image.pixels.foreach_set(np.full(4 * len(u) * len(v), WAITING, dtype=np.float32))
        image.pack()
    return image, u, v

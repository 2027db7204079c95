"""The attractor as an image on a plane."""

import bpy
import numpy as np

from ...core import raster, shading
from ...core.ifs import IFSError
from .. import compat
from ..conversion import NO_PICTURE, core_name, frame_colors, path_norms
from . import materials
from .placing import in_object

OWN_DATA = ("image", "spare_image", "material", "ramp")
"""Datablocks of the output settings that no two objects may share."""


RAMP = "fire"
"""The palette of a new color ramp."""


def add_mesh(name: str):
    """Make the plane's mesh; `draw` gives it the proportions of the window."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([(-0.5, -0.5, 0), (0.5, -0.5, 0), (0.5, 0.5, 0), (-0.5, 0.5, 0)], [], [(0, 1, 2, 3)])
    mesh.uv_layers.new().data.foreach_set("uv", np.float32([0, 0, 1, 0, 1, 1, 0, 1]))
    return mesh


def ensure(owner) -> None:
    """Make the datablocks that are missing, be it because the object is new or because somebody deleted them."""
    output = owner.ifs_morph.output
    complete = output.image and output.ramp and output.material and (output.spare_image or compat.NOTICES_IMAGES)
    if complete:
        return
    output.image = output.image or _new_image(owner)
    if not compat.NOTICES_IMAGES:
        output.spare_image = output.spare_image or _new_image(owner)
    output.ramp = output.ramp or _new_ramp(owner)
    output.material = output.material or materials.image_material(owner.name)
    connect(owner)


def repair(owner) -> None:
    """Give the object a new material if its own no longer shows the image."""
    output = owner.ifs_morph.output
    before = output.material
    if materials.image_node(before) is None:
        output.material = materials.image_material(owner.name)
    materials.fill_slot(owner, output.material, instead_of=before)
    connect(owner)


def _new_image(owner):
    width, height = owner.ifs_morph.output.resolution
    image = bpy.data.images.new(owner.name, width, height, alpha=True, float_buffer=True)
    # Pixels hold color times alpha, the only kind that all versions filter and show alike.
    image.alpha_mode = "PREMUL"
    return image


def _new_ramp(owner):
    texture = bpy.data.textures.new(f"{owner.name} Color Ramp", "BLEND")
    texture.use_color_ramp = True
    elements = texture.color_ramp.elements
    # A new ramp has two stops, which become the outer ones.
    first, *between, last = shading.PALETTES[RAMP]
    for element, (position, color) in zip(elements, (first, last), strict=True):
        element.position, element.color = position, color
    for position, color in between:
        elements.new(position).color = color
    return texture


def connect(owner) -> None:
    """Have the material show the image, and the object the material."""
    output = owner.ifs_morph.output
    materials.fill_slot(owner, output.material)
    materials.set_image(output.material, output.image)


def target(owner):
    """Datablock that the attractor goes into, or None if it is missing."""
    return owner.ifs_morph.output.image


def signature(owner, settings, morph, frame) -> tuple:
    """All that the picture depends on."""
    output = settings.output
    canvas = tuple(output.resolution), tuple(output.window), tuple(output.background)
    if frame is None:
        return canvas
    if frame.DIMENSION == 3:
        raise IFSError(NO_PICTURE)
    chances = None if frame.transitions is None else frame.transitions.tobytes()
    measure = frame.weights.tobytes(), frame.opacity.tobytes(), chances
    shape = frame.maps.tobytes(), *measure, _norms(owner, morph, frame).tobytes()
    look = output.mode, output.antialiasing, _colors(owner, settings).tobytes()
    tones = (output.curve, output.exposure, output.gamma) if output.mode == "DENSITY" else ()
    return canvas + shape + look + tones


def draw(owner, settings, morph, frame, for_render: bool, before: tuple):
    """Render the attractor, or none, into the image, whatever it showed before; the image that shows it."""
    output = settings.output
    pixels = _picture(owner, settings, morph, frame)
    image = _image_for(owner, for_render)
    width, height = output.resolution
    if tuple(image.size) != (width, height):
        image.generated_width, image.generated_height = width, height
    image.pixels.foreach_set(pixels.ravel())
    image.update()
    image.update_tag()
    _fit_plane(owner.data, output.window)
    return image


def _picture(owner, settings, morph, frame) -> np.ndarray:
    """Color times alpha, and alpha, of each pixel: float32 (H, W, 4), row 0 at the bottom."""
    output = settings.output
    width, height = output.resolution
    background = tuple(output.background)
    if frame is None:
        nothing = np.zeros((height, width), dtype=np.uint8)
        return shading.shade(nothing, "attractorlet", np.zeros((0, 4)), background, premultiplied=True)
    left, bottom, right, top = output.window
    if not (left < right and bottom < top):
        raise IFSError(
            "The window has no area: its right side must lie right of its left, and its top above its bottom."
        )
    mode, factor = output.mode.lower(), output.antialiasing
    samples = raster.render(
        frame,
        (factor * width, factor * height),
        (left, bottom, right, top),
        mode,
        norms=_norms(owner, morph, frame),
        dtype=np.uint8,
    )
    return shading.shade(
        samples,
        mode,
        _colors(owner, settings),
        background,
        factor,
        core_name(output.curve, shading.CURVES),
        output.exposure,
        output.gamma,
        premultiplied=True,
    )


def _norms(owner, morph, frame) -> np.ndarray:
    """Bounds (N,) on the maps' norms: those of the path, but for a frame that somebody took off it."""
    return np.maximum(path_norms(owner, morph), frame.norms)


def _colors(owner, settings) -> np.ndarray:
    """Colors that the mode needs: one, a ramp, or one for each attractorlet."""
    output = settings.output
    if output.mode == "SET":
        return np.float32(output.color)
    return _ramp(owner) if output.mode == "DENSITY" else frame_colors(settings)


def _ramp(owner) -> np.ndarray:
    """Colors (K, 4) of the object's ramp, from thin to dense."""
    ramp = owner.ifs_morph.output.ramp.color_ramp
    last = shading.RAMP_ENTRIES - 1
    return np.array([ramp.evaluate(k / last) for k in range(shading.RAMP_ENTRIES)], dtype=np.float32)


def _image_for(owner, for_render: bool):
    """Image to render into: the one that shows, or the spare one where a render would not notice new pixels."""
    output = owner.ifs_morph.output
    if for_render and output.spare_image is not None and not compat.NOTICES_IMAGES:
        output.image, output.spare_image = output.spare_image, output.image
        materials.set_image(output.material, output.image)
    return output.image


def _fit_plane(mesh, window) -> None:
    """Put the plane's corners where the window's are, if they are not there already."""
    if len(mesh.vertices) != 4:
        return  # Somebody shaped the mesh; the image then lies on it by its UV map.
    if not np.isfinite(window).all():
        return  # The message says so; the plane stays as it is.
    left, bottom, right, top = window
    corners = in_object(np.float32([(left, bottom), (right, bottom), (right, top), (left, top)]), window)
    before = np.empty(12, dtype=np.float32)
    mesh.vertices.foreach_get("co", before)
    if not np.array_equal(before, corners.ravel()):
        mesh.vertices.foreach_set("co", corners.ravel())
        mesh.update()
        mesh.update_tag()

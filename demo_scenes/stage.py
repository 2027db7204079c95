"""An empty Blender with the extension of this checkout, and the steps that the scenes have in common.

Everything is done through the extension's operators and properties, as in Blender's window.
"""

import importlib
import os
from pathlib import Path

import numpy as np

ROOT = Path(__file__).parents[1]
PACKAGE = "bl_ext.system.ifs_morph"
FPS = 30
BACKGROUND = 0.004, 0.005, 0.01

BY_LOCUS = ("compute_locus", "plan_path")
BY_MATCHING = ("morph", "compute_locus")
"""The extension's buttons that a scene has pressed: paired map by map as in the paper, or matched."""


def start():
    """Start Blender as a module, with this checkout for an extension; returns the extension's package."""
    extensions = ROOT / "out" / "blender" / "extensions"
    link = extensions / "system" / "ifs_morph"
    link.parent.mkdir(parents=True, exist_ok=True)
    if link.is_symlink():
        link.unlink()
    link.symlink_to(ROOT, target_is_directory=True)
    user = ROOT / "out" / "blender" / "user"
    user.mkdir(exist_ok=True)
    # Both are read once, when Blender is first imported.
    os.environ["BLENDER_SYSTEM_EXTENSIONS"] = str(extensions)
    os.environ["BLENDER_USER_RESOURCES"] = str(user)
    # Kernels compiled under Blender's name for the extension would not load under core's own.
    os.environ["NUMBA_CACHE_DIR"] = str(ROOT / "out" / "blender" / "kernels")
    import bpy  # isort: skip -- it brings the module below
    import addon_utils

    bpy.ops.wm.read_factory_settings(use_empty=True)
    if addon_utils.enable(PACKAGE) is None:
        raise SystemExit("Blender could not enable the extension: see the error above.")
    return importlib.import_module(PACKAGE)


def stop():
    """Disable the extension: Blender does not end well while a handler is registered."""
    import addon_utils

    addon_utils.disable(PACKAGE)


def add_morph(kind: str, initial: str, final: str, frames: int, size: int):
    """Open an empty file with one morph object between two shapes of the library; returns the object."""
    import bpy

    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = 1, frames
    scene.render.fps = FPS
    scene.render.resolution_x = scene.render.resolution_y = size
    scene.render.engine = "CYCLES"
    scene.cycles.samples = 4
    scene.cycles.use_denoising = False
    scene.render.use_persistent_data = True
    # Colors as they are; a film's response would gray the whites.
    scene.view_settings.view_transform = "Standard"
    scene.world = bpy.data.worlds.new("World")
    color_world(BACKGROUND)
    bpy.ops.object.ifs_morph_add(kind=kind)
    bpy.ops.ifs_morph.load_shape(end="INITIAL", shape=initial)
    bpy.ops.ifs_morph.load_shape(end="FINAL", shape=final)
    return bpy.context.object


def color_world(color: tuple[float, float, float]) -> None:
    """Light the scene from all sides in a color, which is also seen behind everything."""
    import bpy

    world = bpy.context.scene.world
    world.color = color
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs["Color"].default_value = *color, 1.0


def place(shape, scale: float, offset: tuple[float, float]) -> None:
    """Make a whole shape of an object larger or smaller, and then move it."""
    for item in shape.maps:
        matrix = np.array(item.matrix)
        matrix[:, 2] = scale * matrix[:, 2] + offset - matrix[:, :2] @ offset
        item.matrix = matrix


def frame(owner) -> None:
    """Fill the camera's view with the window of the morph."""
    import bpy

    camera = bpy.context.scene.camera
    camera.data.type = "ORTHO"
    # The window's larger side has length 1 in the object, and its middle is the origin.
    camera.data.ortho_scale = owner.scale.x
    camera.location.x, camera.location.z = owner.location.x, owner.location.z


def press(button: str) -> None:
    """Press a button of the extension for the active object."""
    import bpy

    getattr(bpy.ops.ifs_morph, button)()


def color_maps(owner, initial, final) -> None:
    """Give each map of both shapes of an object a color."""
    for shape, colors in ((owner.ifs_morph.initial, initial), (owner.ifs_morph.final, final)):
        for item, color in zip(shape.maps, colors, strict=True):
            item.color = color

"""Draw three morphs through space, six frames each: two between shapes in space, and a flat one whose maps turn over.

python -m demo_scenes.space
"""

import math

from PIL import Image

from . import stage
from .save import CELL, HERE, ROW, render

SIZE = 480
POINTS = 200_000
IN_SPACE = (("Sierpinski tetrahedron", "cross in space"), ("octahedron flake", "Menger sponge"))
MIRRORED = ((-1.0, 0.0, 1.0), (0.0, 1.0, 0.0))
"""Takes the gasket to itself."""


def main() -> None:
    """Build, morph and render all rows; what is said of their paths is printed."""
    stage.start()
    try:
        rows = [_in_space(*names) for names in IN_SPACE]
        rows.append(_turned_over())
    finally:
        stage.stop()
    sheet = Image.new("RGB", (CELL * len(ROW), CELL * len(rows)))
    for y, row in enumerate(rows):
        for x, picture in enumerate(row):
            sheet.paste(picture.resize((CELL, CELL), Image.Resampling.LANCZOS), (x * CELL, y * CELL))
    sheet.quantize(256).save(HERE / "space.png", optimize=True)


def _in_space(initial: str, final: str) -> list[Image.Image]:
    """One press of Morph, between two shapes in space."""
    import bpy

    owner = _scene(initial, final)
    bpy.ops.ifs_morph.morph()
    return _pictures(owner)


def _turned_over() -> list[Image.Image]:
    """The gasket to itself, each map through a mirroring of the shape: a half-turn out of the plane."""
    import bpy

    owner = _scene("gasket", "gasket")
    for name in "123":
        pair = owner.ifs_morph.matching.pairs.add()
        pair.initial = pair.final = name
        pair.final_symmetry = MIRRORED
    owner.ifs_morph.path.method = "STRAIGHT"
    bpy.ops.ifs_morph.plan_path()
    return _pictures(owner)


def _scene(initial: str, final: str):
    owner = stage.add_morph("POINTS", initial, final, max(ROW), SIZE)
    owner.ifs_morph.path.frame_end = max(ROW)
    owner.ifs_morph.output.point_count = POINTS
    stage.color_world((0.02, 0.024, 0.03))
    return owner


def _pictures(owner) -> list[Image.Image]:
    """The frames, seen from the left and above."""
    import bpy

    print(
        f"{owner.ifs_morph.initial.name} to {owner.ifs_morph.final.name}\n{owner.ifs_morph.path.report}\n", flush=True
    )
    camera = bpy.context.scene.camera
    camera.data.type = "ORTHO"
    camera.data.ortho_scale = 1.3 * owner.scale.x
    camera.rotation_euler = math.radians(70), 0.0, math.radians(-25)
    # It looks along its own z axis, from far enough away.
    bpy.context.view_layer.update()
    camera.location = owner.location + camera.rotation_euler.to_matrix().col[2] * 4 * owner.scale.x
    return [render(bpy.context.scene, frame) for frame in ROW]


if __name__ == "__main__":
    main()

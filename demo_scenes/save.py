"""Make anew what stands beside the scripts: each scene's .blend and still, and the README's picture.

python -m demo_scenes.save
"""

from importlib import import_module
from pathlib import Path

from PIL import Image

from . import SCENES, stage

HERE = Path(__file__).parent
FRAMES = 120
SIZE = 640
STILL = 78
"""Frame of the still."""

ROW = (1, 25, 49, 73, 97, 120)
"""Frames of the README's picture."""

CELL = 200


def main() -> None:
    """Build, plan, save and render every scene."""
    stage.start()
    rows = []
    try:
        for name in SCENES:
            rows.append(_save(name))
            size = (HERE / f"{name}.blend").stat().st_size / 1024
            print(f"{name}.blend: {size:.0f} KiB", flush=True)
    finally:
        stage.stop()
    sheet = Image.new("RGB", (CELL * len(ROW), CELL * len(rows)))
    for y, row in enumerate(rows):
        for x, picture in enumerate(row):
            sheet.paste(picture, (x * CELL, y * CELL))
    sheet.quantize(128).save(HERE / "morphs.png", optimize=True)


def _save(name: str) -> list[Image.Image]:
    """Save one scene and its still; returns its pictures for the README."""
    import bpy

    scene_script = import_module(f"{__package__}.{name}")
    owner = scene_script.build(FRAMES, SIZE)
    owner.ifs_morph.path.frame_end = FRAMES
    for button in scene_script.BUTTONS:
        stage.press(button)
    stage.frame(owner)
    scene = bpy.context.scene
    pictures = [render(scene, frame) for frame in (*ROW, STILL)]
    pictures.pop().quantize(256).save(HERE / f"{name}.png", optimize=True)
    scene.frame_set(1)
    if owner.ifs_morph.kind == "POINTS":
        # The points are rendered again when the file is opened.
        owner.data.clear_geometry()
    scene.render.filepath = "//"
    bpy.context.preferences.filepaths.save_version = 0
    bpy.ops.wm.save_as_mainfile(filepath=str(HERE / f"{name}.blend"), compress=True)
    return [picture.resize((CELL, CELL), Image.Resampling.LANCZOS) for picture in pictures]


def render(scene, frame: int) -> Image.Image:
    """Render one frame, as it is."""
    import bpy

    target = stage.ROOT / "out" / "still.png"
    scene.frame_set(frame)
    scene.render.image_settings.file_format = "PNG"
    scene.render.filepath = str(target)
    bpy.ops.render.render(write_still=True)
    return Image.open(target).convert("RGB")


if __name__ == "__main__":
    main()

"""Render a demo scene from beginning to end: locus, path, frames, animation, contact sheet, report.

python -m demo_scenes.render --scene turned_gasket_to_gasket --frames 120 --size 640
"""

import argparse
import os
import shutil
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from importlib import import_module
from pathlib import Path

from . import SCENES, stage
from .pictures import animate, contact_sheet, draw_locus

OUTPUT = stage.ROOT / "out" / "demo"


def main() -> None:
    """Read the command line and render."""
    arguments = _arguments()
    began = time.perf_counter()
    output = OUTPUT / arguments.scene
    shutil.rmtree(output, ignore_errors=True)
    (output / "frames").mkdir(parents=True)
    scene_script = import_module(f"{__package__}.{arguments.scene}")
    print(f"{scene_script.TITLE}: {arguments.frames} frames of {arguments.size} x {arguments.size} pixels", flush=True)

    addon = stage.start()
    try:
        import bpy

        log = output / "blender.log"
        owner = _step("building the scene", partial(scene_script.build, arguments.frames, arguments.size), log)
        owner.ifs_morph.locus.resolution = arguments.locus
        owner.ifs_morph.path.frame_end = arguments.frames
        for button in scene_script.BUTTONS:
            _step(f"pressing {button.replace('_', ' ').title()}", partial(stage.press, button), log)
        stage.frame(owner)
        fcurves = import_module(f"{addon.__name__}.ifs_morph_addon.fcurves")
        path = fcurves.sample_path(owner, range(1, arguments.frames + 1))
        draw_locus(owner.ifs_morph.locus.image, path, fcurves.sample_path(owner, fcurves.key_frames(owner)), output)
        bpy.ops.wm.save_as_mainfile(filepath=str(output / f"{arguments.scene}.blend"), compress=True)
        pictures = _render(bpy.context.scene, output / "frames", log)
        _step("writing the animation and the contact sheet", partial(_collect, pictures, path, output), log)
        print(f"\n{owner.ifs_morph.path.report}\n")
    finally:
        stage.stop()
    print(f"Done in {time.perf_counter() - began:.0f} s. See {output.relative_to(Path.cwd())}/:")
    for made in sorted(output.iterdir()):
        print(f"  {made.name}")


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description="Render a demo scene.")
    parser.add_argument("--scene", default=SCENES[0], help=f"one of {', '.join(SCENES)} (default: the first)")
    parser.add_argument("--frames", type=int, default=120, help="frames to render (default: 120)")
    parser.add_argument("--size", type=int, default=640, help="pixels along a side (default: 640)")
    parser.add_argument("--locus", type=int, default=511, help="nodes along a side of the locus (default: 511)")
    arguments = parser.parse_args()
    arguments.scene = arguments.scene.strip().replace(" ", "_").lower()
    if arguments.scene not in SCENES:
        parser.error(f"there is no scene “{arguments.scene}”; choose one of {', '.join(SCENES)}")
    if arguments.frames < 2:
        parser.error(f"{arguments.frames} frames make no animation; ask for 2 or more")
    if not 16 <= arguments.size <= 8192:
        parser.error(f"{arguments.size} pixels is not a size that can be rendered here; ask for 16 to 8192")
    return arguments


def _step(what: str, work: Callable, log: Path):
    print(f"- {what} ...", end="", flush=True)
    began = time.perf_counter()
    with _quiet(log):
        result = work()
    print(f" {time.perf_counter() - began:.1f} s", flush=True)
    return result


def _render(scene, folder: Path, log: Path) -> list[Path]:
    """Render every frame of the scene, showing how far it is."""
    import bpy

    scene.render.image_settings.file_format = "PNG"
    scene.render.filepath = f"{folder}/####"
    frames = scene.frame_end - scene.frame_start + 1
    began = time.perf_counter()

    def show(scene, _depsgraph) -> None:
        done = scene.frame_current - scene.frame_start + 1
        bar = "#" * (30 * done // frames)
        print(f"\r- rendering [{bar:<30}] {done}/{frames}", end="", file=sys.stderr, flush=True)

    bpy.app.handlers.render_write.append(show)
    try:
        with _quiet(log):
            bpy.ops.render.render(animation=True)
    finally:
        bpy.app.handlers.render_write.remove(show)
    print(file=sys.stderr)
    seconds = (time.perf_counter() - began) / frames
    print(f"- rendered {frames} frames, {seconds:.2f} s each", flush=True)
    return sorted(folder.glob("*.png"))


@contextmanager
def _quiet(log: Path) -> Iterator[None]:
    """Add what Blender prints to a file: its C code writes to the descriptor, behind Python's back."""
    sys.stdout.flush()
    kept = os.dup(1)
    with log.open("ab") as file:
        os.dup2(file.fileno(), 1)
    try:
        yield
    finally:
        sys.stdout.flush()
        os.dup2(kept, 1)
        os.close(kept)


def _collect(pictures: list[Path], path, output: Path) -> None:
    animate(pictures, output / "animation.webp", stage.FPS)
    contact_sheet(pictures, path, output / "contact_sheet.png")


if __name__ == "__main__":
    main()

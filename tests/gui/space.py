"""Shapes in space in a Blender with a window: morphed by one press, turned over, rendered, a picture of each step.

    blender --window-geometry 0 0 1600 900 --python tests/gui/space.py -- OUTPUT_FOLDER [SCREENSHOT COMMAND]

The command gets the picture's path appended; without one Blender itself takes the pictures. Needs the extension to be
installed. One thing is done at each tick of a timer, so that Blender draws in between. Ends by itself and prints PASSED
or FAILED.
"""

import subprocess
import sys
import traceback
from pathlib import Path

import addon_utils
import bpy

OUTPUT, *COMMAND = sys.argv[sys.argv.index("--") + 1 :]
OUTPUT = Path(OUTPUT)
MODULE = next(module.__name__ for module in addon_utils.modules() if module.__name__.endswith(".ifs_morph"))
MIRRORED = ((-1.0, 0.0, 1.0), (0.0, 1.0, 0.0))
"""Takes the gasket to itself."""


def window():
    return bpy.context.window_manager.windows[0]


def viewport():
    return next(area for area in window().screen.areas if area.type == "VIEW_3D")


def region(kind="WINDOW"):
    return next(region for region in viewport().regions if region.type == kind)


def press(operator, **options):
    """Press a button of the viewport, which makes a step of undo."""
    with bpy.context.temp_override(window=window(), area=viewport(), region=region()):
        return operator("INVOKE_DEFAULT", True, **options)


def settings():
    return bpy.context.view_layer.objects.active.ifs_morph


def picture(name):
    path = str(OUTPUT / f"{name}.png")
    if COMMAND:
        subprocess.run([*COMMAND, path], check=True)
    else:
        with bpy.context.temp_override(window=window()):
            bpy.ops.screen.screenshot(filepath=path)


def working():
    """Whether an operator is still busy."""
    return any(operator.bl_idname.startswith("IFS_MORPH") for operator in window().modal_operators)


def scroll(times):
    """Turn the wheel over the sidebar."""
    place = region("UI")
    x, y = place.x + place.width // 2, place.y + place.height // 2
    for _ in range(times):
        window().event_simulate(type="MOUSEMOVE", value="NOTHING", x=x, y=y)
        window().event_simulate(type="WHEELDOWNMOUSE", value="PRESS", x=x, y=y)
        yield


def add(initial, final):
    """Have nothing but a point cloud between two shapes, seen from the left and above."""
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    press(bpy.ops.object.ifs_morph_add, kind="POINTS")
    for end, shape in (("INITIAL", initial), ("FINAL", final)):
        press(bpy.ops.ifs_morph.load_shape, end=end, shape=shape)
    settings().path.frame_end = 48
    press(bpy.ops.view3d.view_axis, type="FRONT")
    yield
    for _ in range(2):
        press(bpy.ops.view3d.view_orbit, angle=0.4, type="ORBITLEFT")
    press(bpy.ops.view3d.view_orbit, angle=0.4, type="ORBITUP")
    press(bpy.ops.view3d.view_selected)
    yield


def rendered(name):
    """Render the current frame as the camera sees it."""
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.samples = 8
    scene.cycles.use_denoising = False
    scene.render.resolution_x = scene.render.resolution_y = 400
    scene.render.filepath = str(OUTPUT / f"{name}.png")
    press(bpy.ops.render.render, write_still=True)
    yield
    while bpy.app.is_job_running("RENDER"):
        yield
    assert Path(scene.render.filepath).exists()


def steps():
    """One thing after the other; yields whenever Blender is to draw."""
    while sys.modules[f"{MODULE}.ifs_morph_addon.preparation"].is_running():
        yield
    viewport().spaces.active.show_region_ui = True
    viewport().spaces.active.shading.color_type = "TEXTURE"
    yield
    region("UI").active_panel_category = "IFS Morph"
    yield
    yield from add("Sierpinski tetrahedron", "pyramid")
    picture("1_four_maps_and_five")
    press(bpy.ops.ifs_morph.morph)
    yield
    while working():
        yield
    assert "all in one piece" in settings().path.report
    bpy.context.scene.frame_set(24)
    press(bpy.ops.view3d.view_selected)
    yield
    picture("2_morphed")
    yield from rendered("3_rendered")
    yield from scroll(12)
    for _ in range(5):
        press(bpy.ops.ifs_morph.pair_symmetry, end="FINAL")
    yield
    picture("4_a_symmetry_of_space")

    yield from add("gasket", "gasket")
    for name in "123":
        pair = settings().matching.pairs.add()
        pair.initial = pair.final = name
        pair.final_symmetry = MIRRORED
    settings().path.method = "STRAIGHT"
    press(bpy.ops.ifs_morph.plan_path)
    yield
    while working():
        yield
    assert "Turned over through space" in settings().path.report
    for frame in (1, 12, 24, 36, 48):
        bpy.context.scene.frame_set(frame)
        yield
        picture(f"5_turning_over_{frame}")
    bpy.context.scene.frame_set(24)
    yield from rendered("6_rendered")


def tick(running=steps()):  # noqa: B008 -- one run of the steps, kept between the calls
    try:
        next(running)
        return 1.0
    except StopIteration:
        print("PASSED")
    except Exception:
        traceback.print_exc()
        picture("failed")
        print("FAILED")
    bpy.ops.wm.quit_blender()
    return None


if not addon_utils.check(MODULE)[1]:
    addon_utils.enable(MODULE)
bpy.context.preferences.view.show_splash = False
bpy.app.timers.register(tick, first_interval=3.0)

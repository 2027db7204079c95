"""A newcomer's first morph in a Blender with a window: add, compute, plan, play, render, with a picture of each step.

    blender --window-geometry 0 0 1600 900 --python tests/gui/first_morph.py -- OUTPUT_FOLDER [SCREENSHOT COMMAND]

The command gets the picture's path appended; without one Blender itself takes the pictures. Needs the extension to be
installed. One thing is done at each tick of a timer, so that Blender draws in between; operators are pressed as buttons
press them. Ends by itself and prints PASSED or FAILED.
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


def window():
    return bpy.context.window_manager.windows[0]


def area(kind):
    return max((area for area in window().screen.areas if area.type == kind), key=lambda area: area.width * area.height)


def region(area, kind="WINDOW"):
    return next(region for region in area.regions if region.type == kind)


def in_viewport():
    viewport = area("VIEW_3D")
    return bpy.context.temp_override(window=window(), area=viewport, region=region(viewport))


def morph():
    return bpy.context.view_layer.objects.active


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


def steps():
    """One thing after the other; yields whenever Blender is to draw."""
    viewport = area("VIEW_3D")
    viewport.spaces.active.show_region_ui = True
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    yield
    region(viewport, "UI").active_panel_category = "IFS Morph"
    yield
    picture("1_nothing_selected")
    with in_viewport():
        bpy.ops.object.ifs_morph_add("INVOKE_DEFAULT", kind="IMAGE")
        bpy.ops.view3d.view_axis(type="FRONT")
    yield
    with in_viewport():
        bpy.ops.view3d.view_selected()
    yield
    assert viewport.spaces.active.shading.color_type == "TEXTURE", "The plane is gray."
    picture("2_added")

    morph().ifs_morph.path.frame_end = 120
    while sys.modules[f"{MODULE}.ifs_morph_addon.preparation"].is_running():
        yield
    with in_viewport():
        bpy.ops.ifs_morph.compute_locus("INVOKE_DEFAULT")
    yield
    picture("3_computing")
    while working():
        yield
    assert morph().ifs_morph.locus.image is not None
    with in_viewport():
        bpy.ops.ifs_morph.plan_path("INVOKE_DEFAULT")
    yield
    while working():
        yield
    assert "all in one piece" in morph().ifs_morph.path.report.splitlines()[0]
    with in_viewport():
        bpy.ops.screen.area_split(direction="VERTICAL", factor=0.4)
    yield
    editor = min((area for area in window().screen.areas if area.type == "VIEW_3D"), key=lambda area: area.x)
    editor.type = "IMAGE_EDITOR"
    with bpy.context.temp_override(window=window(), area=area("VIEW_3D"), region=region(area("VIEW_3D"))):
        bpy.ops.ifs_morph.show_locus("INVOKE_DEFAULT")
    assert editor.spaces.active.image == morph().ifs_morph.locus.image
    yield
    with bpy.context.temp_override(window=window(), area=editor, region=region(editor)):
        bpy.ops.image.view_all(fit_view=True)
    bpy.context.scene.frame_set(45)
    yield
    picture("4_planned")

    with in_viewport():
        bpy.ops.screen.animation_play()
    for _ in range(4):
        yield
    picture("5_playing")
    with in_viewport():
        bpy.ops.screen.animation_cancel(restore_frame=False)
    yield

    scene = bpy.context.scene
    scene.render.engine = "BLENDER_WORKBENCH"
    scene.display.shading.color_type = "TEXTURE"
    scene.render.resolution_x = scene.render.resolution_y = 480
    scene.render.filepath = str(OUTPUT / "6_frame.png")
    with in_viewport():
        bpy.ops.render.render("INVOKE_DEFAULT", write_still=True)
    yield
    while bpy.app.is_job_running("RENDER"):
        yield
    assert Path(scene.render.filepath).exists()

    with in_viewport():
        bpy.ops.object.ifs_morph_add("INVOKE_DEFAULT", kind="POINTS")
        bpy.ops.ifs_morph.load_shape(end="INITIAL", shape="Barnsley fern")
        bpy.ops.ifs_morph.load_shape(end="FINAL", shape="maple leaf")
        bpy.ops.view3d.view_selected()
    yield
    picture("7_points")


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

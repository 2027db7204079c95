"""Follows docs/guide.md step by step in a Blender with a window, and takes its pictures.

    blender --enable-event-simulate --window-geometry 0 0 1600 900 --python tests/gui/guide.py -- OUTPUT_FOLDER

Needs X11, ImageMagick's `import`, and the extension installed. One thing is done at each tick of a timer, so that
Blender draws in between; operators are pressed as buttons press them. Ends by itself and prints PASSED or FAILED.
"""

import subprocess
import sys
import traceback
from pathlib import Path

import addon_utils
import bpy

OUTPUT = Path(sys.argv[sys.argv.index("--") + 1])
MODULE = next(module.__name__ for module in addon_utils.modules() if module.__name__.endswith(".ifs_morph"))
COLORS = 96
"""Of a picture, which makes it a third as large."""

FILE = """spiral { .8740 -.3181 .3181 .8740 0 0 .9  .1260 .3181 -.3181 .1260 .8740 .3181 .1 }
C curve { .5 -.5 .5 .5 0 0  .5 .5 -.5 .5 .5 .5 }
square in space { (3D) .5 0 0 0 .5 0 0 0 .5 0 0 0 .25  .5 0 0 0 .5 0 0 0 .5 .5 0 0 .25
 .5 0 0 0 .5 0 0 0 .5 0 .5 0 .25  .5 0 0 0 .5 0 0 0 .5 .5 .5 0 .25 }
"""


def window():
    return bpy.context.window_manager.windows[0]


def area(kind):
    return max((area for area in window().screen.areas if area.type == kind), key=lambda area: area.width * area.height)


def region(kind, part="WINDOW"):
    return next(region for region in area(kind).regions if region.type == part)


def within(kind):
    return bpy.context.temp_override(window=window(), area=area(kind), region=region(kind))


def press(operator, **options):
    """Press a button of the viewport, and wait until Blender has done what it does."""
    with within("VIEW_3D"):
        operator("INVOKE_DEFAULT", **options)
    yield
    while any(running.bl_idname.startswith("IFS_MORPH") for running in window().modal_operators):
        yield


def settings():
    return bpy.context.view_layer.objects.active.ifs_morph


def key(name):
    for value in ("PRESS", "RELEASE"):
        window().event_simulate(type=name, value=value)


def scroll(times):
    """Turn the wheel over the sidebar, down or up."""
    place = region("VIEW_3D", "UI")
    x, y = place.x + place.width // 2, place.y + place.height // 2
    wheel = "WHEELDOWNMOUSE" if times > 0 else "WHEELUPMOUSE"
    for _ in range(abs(times)):
        window().event_simulate(type="MOUSEMOVE", value="NOTHING", x=x, y=y)
        window().event_simulate(type=wheel, value="PRESS", x=x, y=y)
        yield


def picture(name, place=None):
    """Take a picture of an area or region, or of the whole window."""
    place = place or window()
    top = window().height - place.y - place.height if place != window() else 0
    crop = f"{place.width}x{place.height}+{place.x}+{top}"
    path = OUTPUT / f"{name}.png"
    subprocess.run(
        [
            "import",
            "-window",
            "root",
            "-crop",
            crop,
            "+repage",
            "+dither",
            "-colors",
            str(COLORS),
            "-strip",
            f"PNG8:{path}",
        ],
        check=True,
    )


def steps():
    """One thing after the other; yields whenever Blender is to draw."""
    while sys.modules[f"{MODULE}.ifs_morph_addon.preparation"].is_running():
        yield
    space = area("VIEW_3D").spaces.active
    space.show_region_ui = True
    space.overlay.show_relationship_lines = False
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    yield
    region("VIEW_3D", "UI").active_panel_category = "IFS Morph"
    yield

    # Any shape into any shape.
    yield from press(bpy.ops.object.ifs_morph_add, kind="IMAGE")
    yield from press(bpy.ops.ifs_morph.load_shape, end="INITIAL", shape="Hata tree")
    yield from press(bpy.ops.ifs_morph.load_shape, end="FINAL", shape="Gosper flowsnake")
    settings().output.mode = "ATTRACTORLET"
    settings().path.frame_end = 120
    yield from press(bpy.ops.ifs_morph.morph)
    assert "all in one piece" in settings().path.report
    bpy.context.scene.render.resolution_x = bpy.context.scene.render.resolution_y = 1080
    bpy.context.scene.frame_set(60)
    yield from press(bpy.ops.view3d.camera_to_view_selected)
    yield from press(bpy.ops.view3d.view_camera)
    yield
    picture("morph", area("VIEW_3D"))
    yield from scroll(14)
    picture("pairs", region("VIEW_3D", "UI"))
    yield from scroll(-30)

    # A path through the locus.
    bpy.data.objects.remove(bpy.context.view_layer.objects.active)
    yield from press(bpy.ops.object.ifs_morph_add, kind="IMAGE")
    settings().output.mode = "ATTRACTORLET"
    settings().path.frame_end = 120
    yield from press(bpy.ops.ifs_morph.compute_locus)
    yield from press(bpy.ops.ifs_morph.plan_path)
    assert "all in one piece" in settings().path.report
    with within("VIEW_3D"):
        bpy.ops.screen.area_split(direction="VERTICAL", factor=0.5)
    yield
    editor = min((area for area in window().screen.areas if area.type == "VIEW_3D"), key=lambda area: area.x)
    editor.type = "IMAGE_EDITOR"
    yield from press(bpy.ops.ifs_morph.show_locus)
    with within("IMAGE_EDITOR"):
        bpy.ops.image.view_all(fit_view=True)
    bpy.context.scene.frame_set(45)
    yield
    picture("locus", area("IMAGE_EDITOR"))

    # Maps as triangles.
    settings().edit_maps = True
    area("VIEW_3D").spaces.active.show_region_ui = False
    bpy.context.scene.camera.hide_set(True)
    yield from press(bpy.ops.view3d.view_axis, type="FRONT")
    yield from press(bpy.ops.view3d.view_selected)
    bpy.context.scene.frame_set(1)
    yield
    yield
    picture("maps", area("VIEW_3D"))
    settings().edit_maps = False

    # A file with several shapes, as if it had been dropped.
    (OUTPUT / "shapes.ifs").write_text(FILE)
    with within("VIEW_3D"):
        bpy.ops.ifs_morph.import_shapes("INVOKE_DEFAULT", directory=str(OUTPUT), files=[{"name": "shapes.ifs"}])
    yield
    picture("import", area("VIEW_3D"))
    key("RET")
    yield
    assert settings().final.name == "spiral"


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

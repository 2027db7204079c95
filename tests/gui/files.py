"""Shapes through the clipboard, dropped files and the file browser in a Blender with a window, with pictures.

    blender --enable-event-simulate --python tests/gui/files.py -- OUTPUT_FOLDER [SCREENSHOT COMMAND]

Works as `first_morph.py` does; key presses are simulated. Prints PASSED or FAILED.
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

SHAPES = """Levy { 0.5 -0.5 0.5 0.5 0 0
 0.5 0.5 -0.5 0.5 0.5 0.5 }
Heighway { 0.5 -0.5 0.5 0.5 0 0 0.5
 -0.5 -0.5 0.5 -0.5 1 0 0.5 }
broken { 1 2 3 }
"""


def window():
    return bpy.context.window_manager.windows[0]


def in_viewport():
    area = max((area for area in window().screen.areas if area.type == "VIEW_3D"), key=lambda area: area.width)
    region = next(region for region in area.regions if region.type == "WINDOW")
    return bpy.context.temp_override(window=window(), area=area, region=region)


def picture(name):
    path = str(OUTPUT / f"{name}.png")
    if COMMAND:
        subprocess.run([*COMMAND, path], check=True)
    else:
        with bpy.context.temp_override(window=window()):
            bpy.ops.screen.screenshot(filepath=path)


def press(key):
    for value in ("PRESS", "RELEASE"):
        window().event_simulate(type=key, value=value)


def settings():
    return bpy.context.view_layer.objects.active.ifs_morph


def steps():
    """One thing after the other; yields whenever Blender is to draw."""
    (OUTPUT / "some.ifs").write_text(SHAPES)
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    with in_viewport():
        area = bpy.context.area
        area.spaces.active.show_region_ui = True
        bpy.ops.object.ifs_morph_add("INVOKE_DEFAULT", kind="POINTS")
        bpy.ops.ed.undo_push(message="Add")
    yield
    next(region for region in area.regions if region.type == "UI").active_panel_category = "IFS Morph"
    yield
    picture("1_buttons")

    with in_viewport():
        bpy.ops.ifs_morph.copy_shape("INVOKE_DEFAULT", end="INITIAL", format="FLAME")
        assert "<flame name=" in bpy.context.window_manager.clipboard
        bpy.context.window_manager.clipboard = SHAPES
        bpy.ops.ifs_morph.paste_shape("INVOKE_DEFAULT", end="FINAL")
    yield
    picture("2_paste")
    press("RET")
    yield
    assert settings().final.name == "Levy", settings().final.name
    with in_viewport():
        bpy.ops.ed.undo()
    yield
    assert settings().final.name == "gasket", settings().final.name

    # What Blender calls when files are dropped.
    with in_viewport():
        bpy.ops.ifs_morph.import_shapes("INVOKE_DEFAULT", directory=str(OUTPUT), files=[{"name": "some.ifs"}])
    yield
    picture("3_dropped")
    press("RET")
    yield
    assert settings().final.name == "Levy", settings().final.name
    picture("4_adjust")

    with in_viewport():
        bpy.ops.ifs_morph.import_shapes("INVOKE_DEFAULT", target="INITIAL")
    yield
    browser = bpy.context.window_manager.windows[-1]
    area = next(area for area in browser.screen.areas if area.type == "FILE_BROWSER")
    area.spaces.active.params.directory = bytes(OUTPUT)
    area.spaces.active.params.filename = "some.ifs"
    yield
    picture("5_browser")
    with bpy.context.temp_override(window=browser, area=area, region=area.regions[-1]):
        bpy.ops.file.execute()
    yield
    yield
    picture("6_chosen")
    press("RET")
    yield
    assert settings().initial.name == "Levy", settings().initial.name
    with in_viewport():
        bpy.ops.ed.undo()
    yield
    assert (settings().initial.name, settings().final.name) == ("turned gasket", "Levy")


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

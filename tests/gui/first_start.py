"""The first start of the extension on a computer, in a Blender with a window that must not freeze meanwhile.

    blender --window-geometry 0 0 1600 900 --python tests/gui/first_start.py -- OUTPUT_FOLDER [SCREENSHOT COMMAND]

The command gets the picture's path appended; without one Blender itself takes the pictures. Needs the extension to be
installed but not enabled, and no compiled kernels; run a second time, it shows the second start. Ends by itself, prints
what took how long, and PASSED or FAILED.
"""

import importlib
import subprocess
import sys
import time
import traceback
from itertools import pairwise
from pathlib import Path

import addon_utils
import bpy

OUTPUT, *COMMAND = sys.argv[sys.argv.index("--") + 1 :]
OUTPUT = Path(OUTPUT)
MODULE = next(module.__name__ for module in addon_utils.modules() if module.__name__.endswith(".ifs_morph"))

TICK = 0.01
"""Seconds between the ticks of a timer that shows when the window does not answer."""

ticks = []


def tick():
    ticks.append(time.perf_counter())
    return TICK


def longest_gap(start, end):
    """Longest time in seconds between two ticks."""
    within = [start, *(at for at in ticks if start < at < end), end]
    return max(later - earlier for earlier, later in pairwise(within))


def in_viewport():
    window = bpy.context.window_manager.windows[0]
    area = next(area for area in window.screen.areas if area.type == "VIEW_3D")
    region = next(region for region in area.regions if region.type == "WINDOW")
    return bpy.context.temp_override(window=window, area=area, region=region)


def sidebar():
    with in_viewport():
        return next(region for region in bpy.context.area.regions if region.type == "UI")


def picture(name):
    path = str(OUTPUT / f"{name}.png")
    if COMMAND:
        subprocess.run([*COMMAND, path], check=True)
    else:
        with bpy.context.temp_override(window=bpy.context.window_manager.windows[0]):
            bpy.ops.screen.screenshot(filepath=path)


def pause(seconds):
    """Let Blender draw."""
    until = time.perf_counter() + seconds
    while time.perf_counter() < until:
        yield


def covered(image):
    """Share of the pixels of an image that are not transparent."""
    return sum(alpha > 0 for alpha in image.pixels[3::4]) / (image.size[0] * image.size[1])


def steps():
    """One thing after the other; yields whenever Blender is to draw."""
    with in_viewport():
        bpy.context.space_data.show_region_ui = True
        bpy.context.space_data.shading.color_type = "TEXTURE"
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    yield from pause(2)
    before = time.perf_counter()
    addon_utils.enable(MODULE)
    enabled = time.perf_counter()
    print(f"enabled in {enabled - before:.2f} s, numba imported: {'numba' in sys.modules}")
    preparation = importlib.import_module(f"{MODULE}.ifs_morph_addon.preparation")
    cold = preparation.is_running()
    yield from pause(1)
    sidebar().active_panel_category = "IFS Morph"
    yield from pause(1)

    added = time.perf_counter()
    with in_viewport():
        bpy.ops.object.ifs_morph_add("INVOKE_DEFAULT", kind="IMAGE")
        bpy.ops.view3d.view_axis(type="FRONT")
        bpy.ops.view3d.view_selected()
    print(f"added in {time.perf_counter() - added:.2f} s")
    image = bpy.context.view_layer.objects.active.ifs_morph.output.image
    if cold:
        assert not bpy.ops.ifs_morph.compute_locus.poll()
        waiting = time.perf_counter()
        while preparation.is_running() and preparation.share() < 0.2:
            yield
        gap = longest_gap(waiting, time.perf_counter())
        picture("1_preparing")
        waiting = time.perf_counter()
        while preparation.is_running():
            yield
        over = time.perf_counter()
        gap = max(gap, longest_gap(waiting, over))
        print(f"prepared in {over - enabled:.1f} s; longest gap between ticks meanwhile {gap:.3f} s")
    yield from pause(3)
    print(f"longest gap after that {longest_gap(over if cold else added, time.perf_counter()):.2f} s")
    assert 0.05 < covered(image) < 0.5, "the fractal is not in the picture"
    with in_viewport():
        assert bpy.ops.ifs_morph.compute_locus.poll()
    picture("2_shown" if cold else "3_second_start")


def work(running=steps()):  # noqa: B008 -- one run of the steps, kept between the calls
    try:
        next(running)
        return 0.05
    except StopIteration:
        print("PASSED")
    except Exception:
        traceback.print_exc()
        picture("failed")
        print("FAILED")
    bpy.ops.wm.quit_blender()
    return None


bpy.context.preferences.view.show_splash = False
bpy.app.timers.register(tick)
bpy.app.timers.register(work, first_interval=3.0)

"""Dragging in a Blender with a window: the corners of maps, (u,v), and keys of the path, with a picture of each step.

    blender --enable-event-simulate --window-geometry 0 0 1600 900 --python tests/gui/live_editing.py \
        -- OUTPUT_FOLDER [SCREENSHOT COMMAND]

The command gets the picture's path appended; without one Blender itself takes the pictures. Needs the extension to be
installed. A timer of 10 ms tells how long the window did not answer. Ends by itself and prints these times, and PASSED
or FAILED.
"""

import subprocess
import sys
import time
import traceback
from itertools import pairwise
from pathlib import Path

import addon_utils
import bpy
import numpy as np

OUTPUT, *COMMAND = sys.argv[sys.argv.index("--") + 1 :]
OUTPUT = Path(OUTPUT)
MODULE = next(module.__name__ for module in addon_utils.modules() if module.__name__.endswith(".ifs_morph"))

ticks = []
steps_taken = []


def watch():
    ticks.append(time.perf_counter())
    return 0.01


def part(name):
    return sys.modules[f"{MODULE}.ifs_morph_addon.{name}"]


def window():
    return bpy.context.window_manager.windows[0]


def area(kind):
    return max((area for area in window().screen.areas if area.type == kind), key=lambda area: area.width * area.height)


def region(area, kind="WINDOW"):
    return next(region for region in area.regions if region.type == kind)


def within(kind):
    space = area(kind)
    return bpy.context.temp_override(window=window(), area=space, region=region(space))


def in_viewport():
    return within("VIEW_3D")


def settings():
    return bpy.context.view_layer.objects.active.ifs_morph


def picture(name):
    path = str(OUTPUT / f"{name}.png")
    if COMMAND:
        subprocess.run([*COMMAND, path], check=True)
    else:
        with bpy.context.temp_override(window=window()):
            bpy.ops.screen.screenshot(filepath=path)
    ticks.clear()
    steps_taken.clear()


def say(what):
    """Say how long the window did not answer since the last picture, and how long the live locus worked at most."""
    gaps = [later - earlier for earlier, later in pairwise(ticks)]
    longest = f"longest gap {1e3 * max(gaps, default=0):.0f} ms, median {1e3 * float(np.median(gaps or [0])):.0f} ms"
    print(
        f"{what}: {longest}; longest step of {len(steps_taken)}: {1e3 * max(steps_taken, default=0):.0f} ms", flush=True
    )
    ticks.clear()
    steps_taken.clear()


def working():
    return any(operator.bl_idname.startswith("IFS_MORPH") for operator in window().modal_operators)


def following():
    return any(follower.is_busy for follower in part("live")._followers.values())


def corner(index, name):
    """Pixel of a corner in the window."""
    owner = bpy.context.view_layer.objects.active
    with in_viewport():
        place = part("corners").places(owner)[index, part("corners").NAMES.index(name)]
        x, y = part("editors.map_space").to_region(bpy.context, owner, [place])[0]
        return round(float(x)) + bpy.context.region.x, round(float(y)) + bpy.context.region.y


def on_locus(uv):
    """Pixel of a (u,v) in the window."""
    with within("IMAGE_EDITOR"):
        x, y = part("editors.locus_space").to_region(bpy.context.space_data.image, bpy.context.region, [uv])[0]
        return round(float(x)) + bpy.context.region.x, round(float(y)) + bpy.context.region.y


def mouse(kind, value, at, **modifiers):
    window().event_simulate(type=kind, value=value, x=at[0], y=at[1], **modifiers)


def drag(start, end, count=12, halfway=None, cancel=False, **modifiers):
    """Drag with the left mouse button, drawing in between."""
    for _ in range(2):
        mouse("MOUSEMOVE", "NOTHING", (start[0] + 1, start[1]))
        yield
        mouse("MOUSEMOVE", "NOTHING", start)
        yield
    mouse("LEFTMOUSE", "PRESS", start, **modifiers)
    yield
    at = start
    for share in np.linspace(0, 1, count + 1)[1:].tolist():
        at = tuple(round((1 - share) * s + share * e) for s, e in zip(start, end, strict=True))
        mouse("MOUSEMOVE", "NOTHING", at, **modifiers)
        yield
        if halfway and share >= 0.5:
            say("while dragging")
            picture(halfway)
            halfway = None
    if cancel:
        mouse("ESC", "PRESS", at)
        yield
        mouse("ESC", "RELEASE", at)
    mouse("LEFTMOUSE", "RELEASE", at)
    yield


def close(found, wanted, tolerance=0.02):
    assert np.allclose(found, wanted, atol=tolerance), f"{np.array(found)} instead of {np.array(wanted)}"


def steps():
    """One thing after the other; yields whenever Blender is to draw."""
    while part("preparation").is_running():
        yield
    viewport = area("VIEW_3D")
    viewport.spaces.active.show_region_ui = True
    viewport.spaces.active.shading.color_type = "TEXTURE"
    viewport.spaces.active.overlay.show_relationship_lines = False
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    yield
    region(viewport, "UI").active_panel_category = "IFS Morph"
    with in_viewport():
        bpy.ops.object.ifs_morph_add("INVOKE_DEFAULT", kind="IMAGE")
        bpy.ops.view3d.view_axis(type="FRONT")
    yield
    with in_viewport():
        bpy.ops.screen.area_split(direction="VERTICAL", factor=0.4)
    yield
    editor = min((area for area in window().screen.areas if area.type == "VIEW_3D"), key=lambda area: area.x)
    editor.type = "IMAGE_EDITOR"
    with in_viewport():
        bpy.ops.view3d.view_selected()
        # Away from the sidebar.
        bpy.context.region_data.view_distance *= 1.9
        bpy.context.region_data.view_location.x += 0.6
        bpy.ops.ifs_morph.compute_locus("INVOKE_DEFAULT")
    yield
    while working():
        yield
    with in_viewport():
        bpy.ops.ifs_morph.show_locus("INVOKE_DEFAULT")
    editor.spaces.active.show_region_ui = True
    yield
    with within("IMAGE_EDITOR"):
        bpy.ops.image.view_all(fit_view=True)
    region(area("IMAGE_EDITOR"), "UI").active_panel_category = "IFS Morph"
    yield

    # --- a corner of a map
    settings().edit_maps = True
    with in_viewport():
        bpy.ops.ed.undo_push(message="before")
    yield
    picture("1_triangles")
    before = np.array(settings().initial.maps[1].matrix)
    start = corner(1, "X")
    end = start[0] + 60, start[1] + 80
    for _ in drag(start, end, 24, "2_dragging"):
        yield
    after = np.array(settings().initial.maps[1].matrix)
    assert not np.allclose(before, after), "The drag changed nothing."
    assert settings().initial.active_index == 1
    close(after[:, 2], before[:, 2], 1e-5)
    say("end of the drag")
    while following():
        yield
    say("the full locus after it")
    assert part("locus_picture").is_current(settings())
    picture("3_full_locus")

    for operator, wanted in ((bpy.ops.ed.undo, before), (bpy.ops.ed.redo, after), (bpy.ops.ed.undo, before)):
        with in_viewport():
            operator()
        yield
        close(settings().initial.maps[1].matrix, wanted, 1e-6)
    while following():
        yield
    assert part("locus_picture").is_current(settings())
    picture("4_undone")

    start, first = corner(0, "WHOLE"), np.array(settings().initial.maps[0].matrix)
    for _ in drag(start, (start[0] + 80, start[1]), cancel=True):
        yield
    close(settings().initial.maps[0].matrix, first, 1e-6)
    close(settings().initial.maps[1].matrix, before, 1e-6)
    target = corner(2, "ORIGIN")
    start = corner(1, "X")
    for _ in drag(start, (target[0] + 4, target[1] - 3), ctrl=True):
        yield
    corners = part("corners").places(bpy.context.view_layer.objects.active)
    close(corners[1, 1], corners[2, 0], 1e-5)
    with in_viewport():
        bpy.ops.ed.undo()
    yield
    while following():
        yield

    # --- (u,v)
    settings().edit_maps = False
    for _ in drag(on_locus(settings().uv), on_locus((0.5, 0.2)), halfway="5_dragging_uv"):
        yield
    close(settings().uv, (0.5, 0.2))
    for _ in drag(on_locus(settings().uv), on_locus((0, 0)), cancel=True):
        yield
    close(settings().uv, (0.5, 0.2))

    # --- keys of the path
    editor.spaces.active.show_region_ui = False
    settings().path.frame_end = 60
    with in_viewport():
        bpy.ops.ifs_morph.plan_path("INVOKE_DEFAULT")
    yield
    while working():
        yield
    bpy.context.scene.frame_set(20)
    yield
    owner = bpy.context.view_layer.objects.active
    frames = part("fcurves").key_frames(owner)
    picture("6_planned")
    at = part("fcurves").sample_path(owner, [40])[0, :2]
    point = on_locus(at)
    mouse("MOUSEMOVE", "NOTHING", point)
    yield
    mouse("LEFTMOUSE", "PRESS", point, ctrl=True)
    yield
    mouse("LEFTMOUSE", "RELEASE", point, ctrl=True)
    yield
    added = part("path_keys").selected_frames(owner)
    assert len(added) == 1, added
    assert abs(added[0] - 40) <= 2, added
    assert len(part("fcurves").key_frames(owner)) == len(frames) + 1
    start = on_locus(part("fcurves").sample_path(owner, added)[0, :2])
    for _ in drag(start, (start[0] - 30, start[1] + 40), halfway="7_dragging_a_key"):
        yield
    moved = on_locus(part("fcurves").sample_path(owner, added)[0, :2])
    close(moved, (start[0] - 30, start[1] + 40), 1.5)
    picture("8_key_moved")
    mouse("X", "PRESS", moved)
    yield
    mouse("X", "RELEASE", moved)
    yield
    assert part("fcurves").key_frames(owner) == frames
    with in_viewport():
        bpy.ops.ed.undo()
    yield
    owner = bpy.context.view_layer.objects.active
    assert len(part("fcurves").key_frames(owner)) == len(frames) + 1
    picture("9_key_back")

    # --- scrubbing at full HD
    settings().output.resolution = 1920, 1080
    yield
    for mode in ("SET", "ATTRACTORLET"):
        settings().output.mode = mode
        settings().output.antialiasing = 1 if mode == "SET" else 2
        yield
        times = []
        for frame in range(2, 60, 3):
            started = time.perf_counter()
            bpy.context.scene.frame_set(frame)
            times.append(time.perf_counter() - started)
            yield
        print(f"frame change at 1920x1080, {mode}: median {1e3 * np.median(times):.0f} ms", flush=True)
    picture("10_scrubbed")

    # --- a slow locus
    with in_viewport():
        bpy.ops.ifs_morph.clear_path()
        bpy.ops.ifs_morph.load_shape(end="INITIAL", shape="Barnsley fern")
        bpy.ops.ifs_morph.load_shape(end="FINAL", shape="maple leaf")
    settings().output.resolution = 512, 512
    settings().edit_maps = True
    yield
    for _ in range(100):
        yield
    say("the locus of fern to leaf")
    picture("11_fern")
    part("live").forget()


def tick(running=steps()):  # noqa: B008 -- one run of the steps, kept between the calls
    try:
        next(running)
        return 0.08
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
follow = part("live").Follower.step


def timed(follower):
    started = time.perf_counter()
    try:
        return follow(follower)
    finally:
        steps_taken.append(time.perf_counter() - started)


part("live").Follower.step = timed
bpy.context.preferences.view.show_splash = False
bpy.app.timers.register(watch)
bpy.app.timers.register(tick, first_interval=3.0)

"""One press of Morph in a Blender with a window: shapes with different numbers of maps, Esc, pairs edited and undone.

    blender --enable-event-simulate --window-geometry 0 0 1600 900 --python tests/gui/matching.py \
        -- OUTPUT_FOLDER [SCREENSHOT COMMAND]

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


def event(kind, over="WINDOW"):
    """Have a person press a key over the viewport or its sidebar."""
    place = region(over)
    x, y = place.x + place.width // 2, place.y + place.height // 2
    window().event_simulate(type="MOUSEMOVE", value="NOTHING", x=x, y=y)
    window().event_simulate(type=kind, value="PRESS", x=x, y=y)


def scroll(kind, times):
    """Turn the wheel over the sidebar."""
    for _ in range(times):
        event(kind, over="UI")
        yield


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


def undo():
    with bpy.context.temp_override(window=window(), area=viewport(), region=region()):
        bpy.ops.ed.undo()


def words():
    return [(item.initial, item.final) for item in settings().matching.pairs]


def steps():
    """One thing after the other; yields whenever Blender is to draw."""
    while sys.modules[f"{MODULE}.ifs_morph_addon.preparation"].is_running():
        yield
    viewport().spaces.active.show_region_ui = True
    viewport().spaces.active.shading.color_type = "TEXTURE"
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    yield
    region("UI").active_panel_category = "IFS Morph"
    yield
    press(bpy.ops.object.ifs_morph_add, kind="IMAGE")
    settings().output.mode = "ATTRACTORLET"
    press(bpy.ops.view3d.view_axis, type="FRONT")
    yield
    press(bpy.ops.view3d.view_selected)
    press(bpy.ops.ifs_morph.load_shape, end="INITIAL", shape="Koch curve")
    press(bpy.ops.ifs_morph.load_shape, end="FINAL", shape="gasket")
    settings().path.frame_end = 120
    yield
    picture("1_four_maps_and_three")

    settings().matching.budget = "THOROUGH"
    press(bpy.ops.ifs_morph.morph)
    for _ in range(4):
        yield
    picture("2_searching")
    event("ESC")
    while working():
        yield
    yield
    # There is a first answer after a moment; Esc keeps it, or changes nothing if it comes before that.
    first = words()
    settings().matching.budget = "QUICK"
    picture("3_escaped")
    press(bpy.ops.ifs_morph.morph)
    yield
    while working():
        yield
    yield
    assert len(words()) >= 4
    assert "all in one piece" in settings().path.report
    bpy.context.scene.frame_set(60)
    yield
    picture("4_morphed")
    print("after Esc:", len(first), "in the end:", len(words()))
    print(settings().path.report)

    yield from scroll("WHEELDOWNMOUSE", 12)
    picture("5_list_of_pairs")
    before = words()
    press(bpy.ops.ifs_morph.pair_swap, direction="DOWN")
    yield
    assert words() != before
    picture("6_swapped")
    press(bpy.ops.ifs_morph.pairs_lock, action="LOCK")
    press(bpy.ops.ifs_morph.pair_split, end="INITIAL")
    press(bpy.ops.ifs_morph.pair_symmetry, end="FINAL")
    settings().matching.pairs[0].winding = 1
    yield
    picture("7_split_turned_wound_locked")
    for _ in range(4):
        undo()
        yield
    assert words() == before

    # Pairs by hand; each press is one step of undo.
    operators, history = bpy.ops.ifs_morph, [before]
    for operator, options in (
        (operators.pair_split, {"end": "INITIAL"}),
        (operators.pair_join, {"end": "INITIAL"}),
        (operators.pair_add, {}),
        (operators.pair_remove, {}),
        (operators.clear_pairs, {}),
        (operators.pair_add, {}),
    ):
        press(operator, **options)
        yield
        history.append(words())
    picture("8_begun_by_hand")
    assert history[1] != before == history[2] == history[4]
    assert len(history[3]) == len(before) + 1
    assert history[5:] == [[], [("1", "1"), ("2", "2"), ("3", "3"), ("4", "1")]]
    while len(history) > 1:
        history.pop()
        undo()
        yield
        assert words() == history[-1]
    press(bpy.ops.ifs_morph.map_remove, end="FINAL")
    yield
    yield from scroll("WHEELUPMOUSE", 12)
    picture("9_do_not_fit")


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

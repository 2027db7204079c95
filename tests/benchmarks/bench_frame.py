"""What a frame costs in Blender, relative to what it costs Blender alone to take the result."""

import json

import pytest

from tests.benchmarks.measuring import ROOT, python

pytest.importorskip("bpy")

MORPHS = [("gasket", "turned gasket"), ("terdragon", "gasket")]
MOST = {"gasket": 8, "terdragon": 12}
"""Times that a frame near the initial shape may cost as much as writing its pixels."""

ROUNDS = 40

FRAMES = """
import importlib, json, sys, time
import bpy
import addon_utils
import numpy as np

addon_utils.enable("bl_ext.system.ifs_morph")
handlers = importlib.import_module("bl_ext.system.ifs_morph.ifs_morph_addon.handlers")
kind, initial, final, rounds, threads = sys.argv[1:]
if threads == "one":
    importlib.import_module("bl_ext.system.ifs_morph.core.parallel").thread_count = lambda threads=None: 1
bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
scene = bpy.context.scene
bpy.ops.object.ifs_morph_add(kind=kind)
bpy.ops.ifs_morph.load_shape(end="INITIAL", shape=initial)
bpy.ops.ifs_morph.load_shape(end="FINAL", shape=final)
owner = bpy.context.object
output = owner.ifs_morph.output
output.mode, output.resolution, output.point_count = "SET", (1920, 1080), 1_000_000
bpy.ops.ifs_morph.key_straight()
bpy.context.view_layer.update()
bpy.app.handlers.frame_change_post.remove(handlers.on_frame)

pixels = np.ones(4 * 1920 * 1080, np.float32)
fields = {"position": ("vector", 3, np.float32), "radius": ("value", 1, np.float32),
          "color": ("color", 4, np.float32), "attractorlet": ("value", 1, np.int32)}
values = {name: (field, np.ones(width * 1_000_000, dtype)) for name, (field, width, dtype) in fields.items()}


def write(names):
    if kind == "IMAGE":
        return output.image.pixels.foreach_set(pixels)
    for name in names:
        owner.data.attributes[name].data.foreach_set(*values[name])


def seconds(function, *arguments):
    started = time.perf_counter()
    function(*arguments)
    return time.perf_counter() - started


least = {"writing": 1.0, "writing all": 1.0, "handler": 1.0}
for k in range(int(rounds) + 1):
    frame = 2 + k / 8
    scene.frame_set(int(frame), subframe=frame % 1)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    times = {
        "writing": seconds(write, ["position"]),
        "writing all": seconds(write, fields),
        "handler": seconds(handlers.on_frame, scene, depsgraph),
    }
    if k > 0:  # The first compiles kernels and writes what stays the same from then on.
        least = {name: min(least[name], times[name]) for name in least}
bpy.app.handlers.frame_change_post.append(handlers.on_frame)
addon_utils.disable("bl_ext.system.ifs_morph")
print("FIGURES", json.dumps(least))
"""


@pytest.fixture
def least_times(tmp_path, monkeypatch):
    """Return a function that plays a morph in a Blender of its own; least seconds by what was done."""
    (tmp_path / "system").mkdir()
    (tmp_path / "system" / "ifs_morph").symlink_to(ROOT)
    monkeypatch.setenv("BLENDER_SYSTEM_EXTENSIONS", str(tmp_path))
    monkeypatch.setenv("BLENDER_USER_RESOURCES", str(tmp_path))

    def play(*what):
        printed = python(FRAMES, *what)
        return json.loads(next(line for line in printed.splitlines() if line.startswith("FIGURES"))[8:])

    return play


@pytest.mark.parametrize("initial, final", MORPHS)
def test_set_at_1920_x_1080(figure, least_times, initial, final):
    """The frame handler, with what a new object has: antialiasing 2, so that 3840 x 2160 samples are drawn."""
    times = least_times("IMAGE", initial, final, ROUNDS, "all")
    figure("handler over pixels.foreach_set", times["handler"] / times["writing"], at_most=MOST[initial])
    times = least_times("IMAGE", initial, final, ROUNDS, "one")
    figure("the same by one thread", times["handler"] / times["writing"])


@pytest.mark.parametrize("initial, final", MORPHS)
def test_one_million_points(figure, least_times, initial, final):
    """The frame handler: positions and radii anew, colors and letters as they were."""
    times = least_times("POINTS", initial, final, ROUNDS, "all")
    figure("handler over writing positions", times["handler"] / times["writing"], at_most=6)
    figure("handler over writing all attributes", times["handler"] / times["writing all"])
    times = least_times("POINTS", initial, final, ROUNDS, "one")
    figure("over positions, by one thread", times["handler"] / times["writing"])

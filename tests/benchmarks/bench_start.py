"""What the extension adds to Blender's start: the first time on a computer, and every other time."""

import json
import os
import subprocess
import sys

import pytest

from release.zips import build

INSTALL = """
import sys
import bpy
bpy.ops.extensions.package_install_files(filepath=sys.argv[1], repo="user_default", overwrite=True)
"""

START = """
import importlib, json, sys, time
sys.modules["scipy"] = None  # Blender has none, and numba imports it where it is.
started = time.perf_counter()
import bpy
import addon_utils
bpy.ops.wm.read_factory_settings(use_empty=True)
blender = time.perf_counter()
addon_utils.enable("bl_ext.user_default.ifs_morph")
enabled = time.perf_counter()
part = lambda name: importlib.import_module(f"bl_ext.user_default.ifs_morph.{name}")
"""

# As a window does it, whose timers call `look`.
PREPARE = """
preparation, handlers = part("ifs_morph_addon.preparation"), part("ifs_morph_addon.handlers")
preparation.start(part("core.kernels").folder(), handlers.on_prepared)
bpy.ops.object.ifs_morph_add(kind="IMAGE")
held = [enabled - blender]
pause = 0
while pause is not None:
    time.sleep(pause)
    began = time.perf_counter()
    pause = preparation.look()
    held.append(time.perf_counter() - began)
ready = time.perf_counter()
bpy.context.view_layer.update()
held.append(time.perf_counter() - ready)
found = [ready - enabled, max(held)]
"""

SHOW = """
bpy.ops.object.ifs_morph_add(kind="IMAGE")
settings = bpy.context.object.ifs_morph
settings.output.resolution = 1920, 1080
settings.output.mode = "SET"
bpy.ops.ifs_morph.load_shape(end="INITIAL", shape="gasket")
bpy.context.view_layer.update()
shown = time.perf_counter()
assert any(settings.output.image.pixels[3::4])
found = [blender - started, enabled - blender, shown - enabled]
"""

END = """
addon_utils.disable("bl_ext.user_default.ifs_morph")
print("FOUND", json.dumps(found))
"""


@pytest.fixture
def blender(tmp_path):
    """Return a function that runs a script in a Blender whose user has just installed the extension."""
    user = tmp_path / "user"
    user.mkdir()
    # As with every Python but one that is told otherwise, modules are compiled once.
    left_out = ("NUMBA_CACHE_DIR", "PYTHONDONTWRITEBYTECODE")
    environment = {name: value for name, value in os.environ.items() if name not in left_out}
    environment |= {"BLENDER_USER_RESOURCES": str(user), "PYTHONPYCACHEPREFIX": str(tmp_path / "modules")}

    def run(script, *arguments):
        command = [sys.executable, "-c", script, *map(str, arguments)]
        result = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
        assert result.returncode == 0, result.stdout + result.stderr
        return [json.loads(line.removeprefix("FOUND")) for line in result.stdout.splitlines() if "FOUND" in line]

    run(INSTALL, build(platform=None, output=tmp_path))
    return run


def test_start(figure, blender):
    prepared, held = blender(START + PREPARE + END)[0]
    figure("first time: all prepared after", prepared, " s")
    figure("first time: longest time without an answer", held, " s")
    itself, enabled, shown = min((blender(START + SHOW + END)[0] for _ in range(3)), key=lambda found: sum(found[1:]))
    figure("Blender's own start", itself, " s")
    figure("enabling", enabled, " s")
    figure("a first frame of 1920x1080", shown, " s")
    figure("enabling and first frame", enabled + shown, " s", at_most=2)

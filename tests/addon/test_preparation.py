"""The first use on a computer: kernels are compiled beside Blender, what needs them waits, then goes on by itself."""

import importlib
import json
import time
from pathlib import Path

import bpy
import pytest

from tests.addon import another_blender
from tests.addon.interface import PACKAGE, reason, sidebar
from tests.addon.support import add, picture, show

addon_utils = importlib.import_module("addon_utils")  # on the path since bpy was imported

USE_ALL = """
import importlib, json
import numpy as np
kernels = importlib.import_module("bl_ext.user_default.ifs_morph.core.kernels")
warm_up = importlib.import_module("bl_ext.user_default.ifs_morph.core.warm_up")
warm_up.run(*warm_up.PARTS)

def compiled():
    return {
        f"{name} {kernel.__name__} {types}"
        for name, module in list(sys.modules.items())
        if name.startswith("bl_ext.user_default.ifs_morph.core.")
        for kernel in vars(module).values()
        if isinstance(kernel, kernels.Kernel) and kernel.is_compiled
        for types in kernel.dispatcher.overloads
    }

before = compiled()
bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
for final in ("gasket", "terdragon", "Barnsley fern", "hollow square"):
    bpy.ops.object.ifs_morph_add(kind="IMAGE")
    owner = bpy.context.object
    settings = owner.ifs_morph
    settings.output.resolution = 96, 64
    settings.locus.resolution = 22
    settings.path.frame_start, settings.path.frame_end = 1, 12
    if final == "Barnsley fern":
        bpy.ops.ifs_morph.load_shape(end="INITIAL", shape="maple leaf")
    if final == "hollow square":
        bpy.ops.ifs_morph.load_shape(end="INITIAL", shape="square")
    bpy.ops.ifs_morph.load_shape(end="FINAL", shape=final)
    for mode in ("SET", "DENSITY", "ATTRACTORLET"):
        for antialiasing in (1, 2):
            settings.output.mode, settings.output.antialiasing = mode, antialiasing
            bpy.context.view_layer.update()
    bpy.ops.ifs_morph.compute_locus()
    for method in ("PLANNED", "STRAIGHT"):
        settings.path.method = method
        bpy.ops.ifs_morph.plan_path()
    bpy.ops.ifs_morph.check_path()
    bpy.context.scene.frame_set(5)
bpy.ops.object.ifs_morph_add(kind="POINTS")
bpy.context.object.ifs_morph.output.point_count = 2000
bpy.context.view_layer.update()
print("COMPILED", len(before))
print("LATE", json.dumps(sorted(compiled() - before)))
"""


@pytest.fixture
def preparation(extension):
    """Give the module, and end what a test has started."""
    module = extension.ifs_morph_addon.preparation
    yield module
    module.end()


@pytest.fixture
def endless(preparation, monkeypatch, tmp_path):
    """Start a process that would never be over."""
    monkeypatch.setattr(preparation, "SCRIPT", "import time\nprint('at work', flush=True)\ntime.sleep(1000)")
    calls = []
    preparation.start(tmp_path, lambda: calls.append("over"))
    assert preparation.is_running()
    return calls


def wait(preparation):
    while preparation.look() is not None:
        time.sleep(0.05)


def test_all_that_the_extension_calls_is_prepared(extension):
    printed = another_blender.run(USE_ALL)
    late = next(line for line in printed.splitlines() if line.startswith("LATE"))
    assert json.loads(late.removeprefix("LATE ")) == []


def test_a_process_prepares_and_leaves_a_mark(extension, preparation):
    core = extension.core
    folder = core.kernels.folder()
    core.warm_up._mark(folder).unlink(missing_ok=True)
    assert not core.warm_up.is_done(folder)
    calls = []
    preparation.start(folder, lambda: calls.append(preparation.is_running()))
    wait(preparation)
    assert calls == [False]
    assert core.warm_up.is_done(folder)


def test_a_mark_of_other_sources_does_not_count(extension, tmp_path, monkeypatch):
    warm_up = extension.core.warm_up
    warm_up._mark(tmp_path).write_text(warm_up._state())
    assert warm_up.is_done(tmp_path)
    monkeypatch.setattr(extension.core.kernels, "fingerprint", lambda module: "other")
    assert not warm_up.is_done(tmp_path)


def test_what_needs_kernels_waits_and_says_so(extension, scene, preparation, endless):
    owner = add("IMAGE")
    assert not picture(owner)[..., :3].any(), "nothing is drawn yet"
    assert "Preparing IFS Morph for this computer, the first time only" in sidebar(owner, extension)
    assert "Preparing IFS Morph" in reason(bpy.ops.ifs_morph.compute_locus)
    assert preparation.look() > 0
    assert endless == []


def test_waiting_ends_by_itself(extension, scene, preparation, monkeypatch, tmp_path):
    monkeypatch.setattr(preparation, "SCRIPT", "")
    preparation.start(tmp_path, extension.ifs_morph_addon.handlers.on_prepared)
    owner = add("IMAGE")
    window = tuple(owner.ifs_morph.output.window)
    wait(preparation)
    show()
    assert picture(owner)[..., 3].any()
    assert tuple(owner.ifs_morph.output.window) != window, "it is fitted now"
    assert "Preparing" not in sidebar(owner, extension)
    assert bpy.ops.ifs_morph.compute_locus.poll()


def test_renders_do_not_wait(scene, endless, tmp_path):
    owner = add("IMAGE")
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.samples = 1
    scene.render.resolution_x = scene.render.resolution_y = 16
    scene.render.filepath = str(tmp_path / "picture.png")
    bpy.ops.render.render(write_still=True)
    assert picture(owner)[..., 3].any()


def test_a_process_that_fails_holds_nothing_up(preparation, monkeypatch, tmp_path, capfd):
    monkeypatch.setattr(preparation, "SCRIPT", "raise SystemExit('no luck')")
    calls = []
    preparation.start(tmp_path, lambda: calls.append(preparation.is_running()))
    wait(preparation)
    assert calls == [False]
    assert "no luck" in capfd.readouterr().out


def test_a_process_that_takes_too_long_is_given_up(preparation, monkeypatch, endless):
    processes = preparation._running[0].processes
    assert len(processes) > 1
    monkeypatch.setattr(preparation, "LONGEST", 0.0)
    wait(preparation)
    assert None not in [process.poll() for process in processes]
    assert endless == ["over"]


@pytest.mark.parametrize("python", ["", "/usr/bin/blender", "/nowhere/python3"])
def test_without_a_python_to_start_nothing_waits(preparation, monkeypatch, tmp_path, capfd, python):
    monkeypatch.setattr("sys.executable", python)
    preparation.start(tmp_path, None)
    assert not preparation.is_running()
    assert "could not prepare ahead" in capfd.readouterr().out


def test_disabling_ends_the_process(extension, endless, preparation):
    processes = preparation._running[0].processes
    assert len(processes) > 1
    addon_utils.disable(PACKAGE)
    try:
        assert None not in [process.poll() for process in processes]
        assert not preparation.is_running()
        assert not bpy.app.timers.is_registered(preparation.look)
    finally:
        addon_utils.enable(PACKAGE)
    assert endless == []


def test_kernels_lie_in_the_users_folder_of_the_extension(extension, preparation, monkeypatch):
    monkeypatch.delenv("NUMBA_CACHE_DIR")
    preparation.begin(None)
    folder = extension.core.kernels.folder()
    assert folder == Path(bpy.utils.extension_path_user(PACKAGE, path="kernels"))
    assert not folder.is_relative_to(Path(extension.__file__).parent)


def test_kernels_lie_in_a_temporary_folder_where_that_cannot_be_written(extension, preparation, monkeypatch, tmp_path):
    monkeypatch.delenv("NUMBA_CACHE_DIR")
    (tmp_path / "file").touch()
    monkeypatch.setattr(bpy.utils, "extension_path_user", lambda *_, path: str(tmp_path / "file" / path))
    preparation.begin(None)
    assert extension.core.kernels.folder() == Path(bpy.app.tempdir, "kernels")

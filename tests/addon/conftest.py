"""Gives the tests the extension as a user has it: built into a zip, installed by Blender from the zip, enabled.

The ``bpy`` module reads its user folder once, when it is first imported, so this file chooses the folder before
any test module imports ``bpy``. Processes that run at the same time have a folder each.
"""

import fcntl
import importlib
import os
import shutil
from importlib.metadata import version
from itertools import count
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
OUTPUT = ROOT / "out" / "tests"
PACKAGE = "bl_ext.user_default.ifs_morph"


def _is_mine(folder: Path) -> bool:
    """Take the folder until this process ends, unless another one has taken it."""
    lock = os.open(folder.with_suffix(".lock"), os.O_CREAT | os.O_RDWR)
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        os.close(lock)
        return False
    return True


def _empty_user_folder() -> Path:
    parent = OUTPUT / f"bpy-{version('bpy')}"
    parent.mkdir(parents=True, exist_ok=True)
    folder = next(parent / str(number) for number in count() if _is_mine(parent / str(number)))
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    return folder


os.environ["BLENDER_USER_RESOURCES"] = str(_empty_user_folder())


@pytest.fixture(scope="session")
def extension(tmp_path_factory):
    """Install and enable the extension; its package, e.g. for ``extension.ifs_morph_addon.conversion``."""
    import addon_utils
    import bpy

    from release.zips import build

    package = build(platform=None, output=tmp_path_factory.mktemp("packages"))
    bpy.ops.extensions.package_install_files(
        filepath=str(package), repo="user_default", enable_on_install=True, overwrite=True
    )
    assert addon_utils.check(PACKAGE)[1], f"{PACKAGE} is not enabled: see the error printed above"
    yield importlib.import_module(PACKAGE)
    # Blender crashes or hangs at exit while a Python handler is registered.
    addon_utils.disable(PACKAGE)


@pytest.fixture
def scene(extension):
    """Open a new, empty file, the extension still enabled; its scene."""
    import bpy

    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    return bpy.context.scene

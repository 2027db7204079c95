"""The zip for this machine does its work in a Blender that has no numba of its own: most users' Blender.

The test runs a Python that sees everything of this environment but numba, and installs the zip in it as a user would.
"""

import os
import platform
import subprocess
import sys
import sysconfig
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

INSTALL = """
import sys
import bpy, addon_utils
bpy.ops.extensions.package_install_files(
    filepath=sys.argv[1], repo="user_default", enable_on_install=True, overwrite=True
)
bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
"""
RENDER = """
import numba
print("numba from", numba.__file__)
scene = bpy.context.scene
scene.render.engine = "CYCLES"
scene.cycles.samples = 4
scene.render.resolution_x = scene.render.resolution_y = 96
scene.render.film_transparent = True
scene.render.filepath = sys.argv[2]
bpy.ops.object.ifs_morph_add(kind="IMAGE")
bpy.ops.render.render(write_still=True)
"""
DISABLE = """
addon_utils.disable("bl_ext.user_default.ifs_morph")
"""


@pytest.fixture
def run(tmp_path):
    """Run a program in a Python without numba, with a user folder of its own; what it prints."""
    packages = tmp_path / "packages"
    packages.mkdir()
    for path in Path(sysconfig.get_path("purelib")).iterdir():
        if not path.name.startswith(("numba", "llvmlite")):
            (packages / path.name).symlink_to(path)
    user_folder = tmp_path / "user"
    user_folder.mkdir()
    environment = {**os.environ, "PYTHONPATH": str(packages), "BLENDER_USER_RESOURCES": str(user_folder)}

    def run(program, *arguments):
        # -S leaves the environment's own packages out.
        command = [sys.executable, "-S", "-c", program, *map(str, arguments)]
        result = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
        assert result.returncode == 0, result.stdout + result.stderr
        assert "Traceback" not in result.stderr, result.stderr
        return result.stdout

    run.user_folder = user_folder
    return run


@pytest.fixture
def here():
    """Name the platform of this machine as Blender does."""
    system = {"Linux": "linux", "Windows": "windows", "Darwin": "macos"}[platform.system()]
    machine = "arm64" if platform.machine().lower() in {"arm64", "aarch64"} else "x64"
    return f"{system}-{machine}"


def test_the_zip_brings_its_own_numba_and_renders(run, package, here, tmp_path):
    picture = tmp_path / "picture.png"
    printed = run(INSTALL + RENDER + DISABLE, package(here), picture)
    assert f"numba from {run.user_folder}" in printed
    alpha = np.asarray(Image.open(picture).convert("RGBA"))[..., 3]
    assert 0.05 < (alpha > 0).mean() < 0.5, "the fractal is not in the picture"

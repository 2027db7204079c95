"""Builds one zip of the extension with Blender's own tool, which the ``bpy`` module carries.

The tool's ``--split-platforms`` silently drops wheels that it cannot place. So each zip is built from a
staged copy of its own, whose manifest names the platform, the wheels and every file. Equal sources make equal
zips: the list of files is sorted, and times and permissions are the same everywhere.
"""

import importlib.util
import os
import shutil
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

from .wheels import ROOT, download

OUTPUT = ROOT / "out" / "packages"
MANIFEST = "blender_manifest.toml"
CONTENTS = ("__init__.py", "LICENSE", "README.md", "core", "ifs_morph_addon")
TIME_STAMP = 946684800  # the start of the year 2000


def manifest() -> dict:
    """Return the extension's manifest."""
    return tomllib.loads((ROOT / MANIFEST).read_text(encoding="utf-8"))


def build(platform: str | None, output: Path = OUTPUT) -> Path:
    """Build and validate the zip of one platform.

    Parameters
    ----------
    platform : str or None
        A key of ``wheels.PLATFORMS``. None builds the zip without wheels, for a Blender that
        has numba of its own.
    output : Path
        The folder to write to.

    Returns
    -------
    Path
        The zip.
    """
    output.mkdir(parents=True, exist_ok=True)
    about = manifest()
    package = output / f"{about['id']}-{about['version']}-{platform or 'no-wheels'}.zip"
    with tempfile.TemporaryDirectory(dir=output, prefix=".stage-") as folder:
        stage = Path(folder)
        _stage(stage, platform)
        blender_tool("build", "--source-dir", stage, "--output-filepath", package)
    blender_tool("validate", package, "--valid-tags", _scripts() / "modules/_bpy_internal/extensions/tags.py")
    return package


def blender_tool(*arguments) -> None:
    """Run Blender's command line for extensions.

    Raises
    ------
    RuntimeError
        The tool failed; the message is what it printed.
    """
    tool = _scripts() / "addons_core/bl_pkg/cli/blender_ext.py"
    environment = {**os.environ, "TZ": "UTC"}  # a zip holds local times
    command = [sys.executable, tool, *arguments]
    result = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    if result.returncode != 0:
        raise RuntimeError(f"Blender refuses to {arguments[0]}:\n{result.stdout}{result.stderr}")


def _scripts() -> Path:
    bpy = Path(importlib.util.find_spec("bpy").origin).parent
    (scripts,) = bpy.glob("*/scripts")
    return scripts


def _stage(stage: Path, platform: str | None) -> None:
    for name in CONTENTS:
        if (ROOT / name).is_dir():
            shutil.copytree(ROOT / name, stage / name, ignore=shutil.ignore_patterns("__pycache__", ".*"))
        else:
            shutil.copy(ROOT / name, stage)

    if platform is not None:
        (stage / "wheels").mkdir()
        for wheel in download(platform):
            shutil.copy(wheel, stage / "wheels")

    files = {path.relative_to(stage).as_posix() for path in stage.rglob("*") if path.is_file()}
    wheels = {path for path in files if path.startswith("wheels/")}
    text = (ROOT / MANIFEST).read_text(encoding="utf-8")
    if platform is not None:
        text = f"platforms = {_toml({platform})}\nwheels = {_toml(wheels)}\n\n{text}"
    # Blender's tool adds the manifest and the wheels to the paths by itself.
    text = f"{text}\n[build]\npaths = {_toml(files - wheels)}\n"
    (stage / MANIFEST).write_text(text, encoding="utf-8")

    for path in stage.rglob("*"):
        path.chmod(0o755 if path.is_dir() else 0o644)
        os.utime(path, (TIME_STAMP, TIME_STAMP))


def _toml(items: set[str]) -> str:
    return "[\n" + "".join(f'    "{item}",\n' for item in sorted(items)) + "]"

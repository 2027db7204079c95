"""Builds one zip of the extension with Blender's own tool, which the ``bpy`` module carries.

The tool's ``--split-platforms`` silently drops wheels that it cannot place. So each zip is built from a staged
copy of its own, whose manifest names just its platform and its wheels. Equal sources make equal zips.
"""

import importlib.util
import json
import shutil
import subprocess
import sys
import tempfile
import tomllib
import zipfile
from pathlib import Path

from .wheels import ROOT, download

OUTPUT = ROOT / "out" / "packages"
MANIFEST = "blender_manifest.toml"
CONTENTS = ("__init__.py", "LICENSE", "README.md", "core", "ifs_morph_addon")


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
        blender_tool("build", "--source-dir", stage, "--output-filepath", stage / package.name)
        _write_in_order(stage / package.name, package)
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
    result = subprocess.run([sys.executable, tool, *arguments], capture_output=True, text=True, check=False)
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

    text = (ROOT / MANIFEST).read_text(encoding="utf-8")
    if platform is not None:
        (stage / "wheels").mkdir()
        for wheel in download(platform):
            shutil.copy(wheel, stage / "wheels")
        wheels = sorted(f"wheels/{path.name}" for path in (stage / "wheels").iterdir())
        # Ahead of the manifest's own text, which ends in a table; a list of names reads the same in JSON and TOML.
        text = f"platforms = {json.dumps([platform])}\nwheels = {json.dumps(wheels, indent=4)}\n\n{text}"
    (stage / MANIFEST).write_text(text, encoding="utf-8")


def _write_in_order(source: Path, target: Path) -> None:
    """Copy a zip without what depends on the machine: the order, the times and the permissions of its files."""
    with zipfile.ZipFile(source) as old, zipfile.ZipFile(target, "w") as new:
        for entry in sorted(old.infolist(), key=lambda entry: entry.filename):
            plain = zipfile.ZipInfo(entry.filename)
            plain.compress_type = entry.compress_type
            plain.external_attr = 0o644 << 16
            new.writestr(plain, old.read(entry))

"""Downloads the wheels that Blender lacks: numba and its compiler, but never numpy, which Blender brings."""

import subprocess
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).parents[1]
CACHE = ROOT / "out" / "wheels"
PACKAGES = ("llvmlite", "numba")
PYTHON_VERSIONS = ("3.11", "3.13")  # of Blender 4.2 to 5.0, and of 5.1 and later

# Blender's name of a platform -> the tags of the wheels that run on it.
PLATFORMS = {
    "linux-x64": ("manylinux_2_28_x86_64", "manylinux_2_27_x86_64", "manylinux2014_x86_64"),
    "windows-x64": ("win_amd64",),
    "macos-arm64": ("macosx_12_0_arm64", "macosx_11_0_arm64"),
}


def requirements() -> dict[str, str]:
    """Return the exact requirement of each bundled package, as pinned in pyproject.toml."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    pins = {line.partition("==")[0]: line for line in project["dependencies"]}
    return {package: pins[package] for package in PACKAGES}


def download(platform: str) -> list[Path]:
    """Return the wheels of one platform, for every Python version, fetching those that are not there yet.

    Raises
    ------
    subprocess.CalledProcessError
        pip found no such wheel, or no network; it has printed which.
    """
    return [
        _wheel(requirement, platform, python_version)
        for requirement in requirements().values()
        for python_version in PYTHON_VERSIONS
    ]


def _wheel(requirement: str, platform: str, python_version: str) -> Path:
    folder = CACHE / platform
    abi = "cp" + python_version.replace(".", "")
    pattern = f"{requirement.replace('==', '-')}-{abi}-{abi}-*.whl"
    if not any(folder.glob(pattern)):
        print(f"downloading {requirement} for {platform}, Python {python_version}", flush=True)
        command = [sys.executable, "-m", "pip", "download", requirement, "--dest", folder]
        command += ["--quiet", "--disable-pip-version-check", "--no-deps", "--only-binary", ":all:"]
        command += ["--implementation", "cp", "--python-version", python_version, "--abi", abi]
        for tag in PLATFORMS[platform]:
            command += ["--platform", tag]
        subprocess.run(command, check=True)
    (wheel,) = folder.glob(pattern)
    return wheel

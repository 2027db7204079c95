"""Says what is wrong with the contents of a zip: a wheel too few, a test or a cache too many."""

import re
import tomllib
import zipfile
from itertools import product
from pathlib import Path, PurePosixPath

from .wheels import PYTHON_VERSIONS, requirements
from .zips import CONTENTS, MANIFEST

# What a wheel's name ends with, if it runs on the platform.
PLATFORM_TAGS = {
    "linux-x64": r"manylinux[0-9_]*_x86_64",
    "windows-x64": r"win_amd64",
    "macos-arm64": r"macosx_[0-9]+_[0-9]+_arm64",
}
REFUSED_SUFFIXES = {".pyc", ".nbi", ".nbc", ".blend", ".blend1", ".zip", ".so", ".dll"}


def wheels(package: Path) -> list[str]:
    """Return the file names of the wheels in a zip."""
    with zipfile.ZipFile(package) as archive:
        return sorted(PurePosixPath(name).name for name in archive.namelist() if name.endswith(".whl"))


def problems(package: Path, platform: str | None) -> list[str]:
    """Return a sentence for each thing in a zip that should not be there, or that is missing.

    Parameters
    ----------
    package : Path
        The zip.
    platform : str or None
        The platform that the zip is for; None if it should hold no wheels.
    """
    with zipfile.ZipFile(package) as archive:
        names = archive.namelist()
        about = tomllib.loads(archive.read(MANIFEST).decode("utf-8"))
    found = [sentence for name in names if (sentence := _problem_of_file(name))]

    expected = {*CONTENTS, MANIFEST} | ({"wheels"} if platform else set())
    tops = {PurePosixPath(name).parts[0] for name in names}
    found += [f"{name} is missing" for name in sorted(expected - tops)]
    found += [f"{name} does not belong in the extension" for name in sorted(tops - expected)]

    found += _problems_of_wheels(wheels(package), platform)
    if about.get("platforms", []) != ([platform] if platform else []):
        found.append(f"the manifest is for the platforms {about.get('platforms')}, not for {platform}")
    if sorted(about.get("wheels", [])) != sorted(name for name in names if name.endswith(".whl")):
        found.append("the manifest does not list the wheels that are there")
    return found


def _problem_of_file(name: str) -> str | None:
    path = PurePosixPath(name)
    if any(part.startswith(".") or part in ("__pycache__", "tests") for part in path.parts):
        return f"{name} is a hidden file, a cache or a test"
    if path.suffix in REFUSED_SUFFIXES:
        return f"{name} is not a source"
    return None


def _problems_of_wheels(names: list[str], platform: str | None) -> list[str]:
    if platform is None:
        return [f"{name} is in a zip without wheels" for name in names]
    tag = PLATFORM_TAGS[platform]
    missing = [
        (requirement.replace("==", "-"), "cp" + version.replace(".", ""))
        for requirement, version in product(requirements().values(), PYTHON_VERSIONS)
    ]
    found = []
    for name in names:
        match = re.fullmatch(rf"(.+-.+)-(cp\d+)-\2-{tag}(?:\.{tag})*\.whl", name)
        if match and match.groups() in missing:
            missing.remove(match.groups())
        else:
            found.append(f"{name} does not belong in the zip for {platform}")
    return found + [f"there is no wheel of {package} for {python} on {platform}" for package, python in missing]

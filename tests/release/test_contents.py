"""Each thing that must not be in a zip, or must not be missing, is found: tried on small zips made for it."""

import zipfile

import pytest

from release.contents import problems
from release.wheels import requirements

NUMBA = requirements()["numba"].replace("==", "-")
LLVMLITE = requirements()["llvmlite"].replace("==", "-")
FILES = ["__init__.py", "LICENSE", "README.md", "core/ifs.py", "ifs_morph_addon/__init__.py"]
WHEELS = [
    f"wheels/{package}-{python}-{python}-manylinux_2_27_x86_64.manylinux_2_28_x86_64.whl"
    for package in (NUMBA, LLVMLITE)
    for python in ("cp311", "cp313")
]


@pytest.fixture
def found(tmp_path):
    """Make a zip for Linux of empty files; what is wrong with it."""

    def found(files, listed_wheels=WHEELS, platforms=("linux-x64",), platform="linux-x64"):
        package = tmp_path / "package.zip"
        with zipfile.ZipFile(package, "w") as archive:
            manifest = f"platforms = {list(platforms)}\nwheels = {list(listed_wheels)}\n"
            archive.writestr("blender_manifest.toml", manifest)
            for name in files:
                archive.writestr(name, "")
        return problems(package, platform)

    return found


def test_nothing_is_wrong_with_a_good_zip(found):
    assert found(FILES + WHEELS) == []
    assert found(FILES, listed_wheels=(), platforms=(), platform=None) == []


@pytest.mark.parametrize(
    "name",
    [
        "core/__pycache__/ifs.cpython-313.pyc",
        "core/ifs.pyc",
        "core/.hidden",
        ".gitignore",
        "tests/test_ifs.py",
        "core/tests/test_ifs.py",
        "demo_scenes/fern.blend",
        "ifs_morph_addon/fern.blend",
        "notes.txt",
        "out/ifs_morph.zip",
    ],
)
def test_what_does_not_belong_is_found(found, name):
    assert any(name.split("/")[0] in sentence for sentence in found([*FILES, *WHEELS, name]))


@pytest.mark.parametrize("name", FILES)
def test_what_is_missing_is_found(found, name):
    assert found([other for other in FILES if other != name] + WHEELS) == [f"{name.split('/')[0]} is missing"]


@pytest.mark.parametrize("wheel", WHEELS)
def test_a_missing_wheel_is_found(found, wheel):
    left = [other for other in WHEELS if other != wheel]
    (sentence,) = found(FILES + left, listed_wheels=left)
    assert sentence.startswith("there is no wheel of")


@pytest.mark.parametrize(
    "name",
    [
        "numpy-2.5.5-cp313-cp313-manylinux_2_28_x86_64.whl",
        f"{NUMBA}-cp313-cp313-win_amd64.whl",
        f"{NUMBA}-cp313-cp313-manylinux_2_28_aarch64.whl",
        f"{NUMBA}-cp312-cp312-manylinux_2_28_x86_64.whl",
        "numba-0.1.0-cp313-cp313-manylinux_2_28_x86_64.whl",
    ],
)
def test_a_wheel_too_many_is_found(found, name):
    wheels = [*WHEELS, f"wheels/{name}"]
    assert found(FILES + wheels, listed_wheels=wheels) == [f"{name} does not belong in the zip for linux-x64"]


def test_a_manifest_that_lists_other_wheels_is_found(found):
    assert found(FILES + WHEELS, listed_wheels=WHEELS[:-1]) == ["the manifest does not list the wheels that are there"]


def test_a_manifest_for_another_platform_is_found(found):
    (sentence,) = found(FILES + WHEELS, platforms=("windows-x64",))
    assert "windows-x64" in sentence


def test_wheels_in_the_zip_without_wheels_are_found(found):
    assert len(found(FILES + WHEELS[:1], listed_wheels=WHEELS[:1], platforms=(), platform=None)) == 2

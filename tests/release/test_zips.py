"""The zips that users install hold what they should, and Blender accepts them."""

import tomllib
import zipfile

import pytest

from release.contents import problems, wheels
from release.wheels import PLATFORMS
from release.zips import ROOT, blender_tool, build, manifest


@pytest.mark.parametrize("platform", [*PLATFORMS, None])
def test_a_zip_holds_what_it_should(package, platform):
    assert problems(package(platform), platform) == []
    assert len(wheels(package(platform))) == (4 if platform else 0)


@pytest.mark.parametrize("platform", PLATFORMS)
def test_the_wheels_are_whole(package, platform):
    with zipfile.ZipFile(package(platform)) as archive:
        for name in archive.namelist():
            if name.endswith(".whl"):
                with archive.open(name) as file, zipfile.ZipFile(file) as wheel:
                    assert any(member.endswith(".dist-info/METADATA") for member in wheel.namelist())


def test_every_module_is_in_the_zip(package):
    with zipfile.ZipFile(package(None)) as archive:
        packed = {name for name in archive.namelist() if name.startswith(("core/", "ifs_morph_addon/"))}
    sources = {
        path.relative_to(ROOT).as_posix()
        for folder in ("core", "ifs_morph_addon")
        for path in (ROOT / folder).rglob("*.py")
    }
    assert packed >= sources


def test_equal_sources_make_equal_zips(package, tmp_path):
    assert build(None, tmp_path).read_bytes() == package(None).read_bytes()


def test_the_zip_is_named_after_the_version(package):
    assert package("linux-x64").name == f"ifs_morph-{manifest()['version']}-linux-x64.zip"


def test_the_project_has_the_version_of_the_extension():
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert project["version"] == manifest()["version"]


def test_what_blender_refuses_is_an_error(tmp_path):
    (tmp_path / "blender_manifest.toml").write_text('schema_version = "1.0.0"\n', encoding="utf-8")
    with pytest.raises(RuntimeError, match="tagline"):
        blender_tool("validate", tmp_path)

"""The arrows between modules: which may import which. Read from the sources, whether or not they ever run."""

import ast
from collections.abc import Iterator
from importlib.util import resolve_name
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]

# Each module of the core may import those above it.
CORE = (
    "parallel",
    "kernel_cache",
    "kernels",
    "affine",
    "states",
    "enclosure",
    "tree",
    "polygon",
    "ifs",
    "grammar",
    "words",
    "shapes",
    "recurrent_shapes",
    "joining",
    "morph",
    "heap",
    "overlap",
    "gap",
    "recurrent_overlap",
    "recurrent",
    "decision",
    # Shapes in space, from their maps to their states.
    "space",
    "deciding",
    "connectedness",
    "tolerated",
    "locus",
    "report",
    "route",
    "curve",
    "handles",
    "band",
    "swelling",
    "path",
    # It ends with the path through the morph that it found.
    "matching",
    "pieces",
    "chaos",
    "spreading",
    "drawing",
    "cloud",
    "raster",
    "shading",
    "formats",
    "warm_up",
)


def modules(package: str) -> dict[str, Path]:
    """Name every module of a package as Blender does: within the extension's own package."""
    names = {}
    for path in sorted((ROOT / package).rglob("*.py")):
        parts = path.relative_to(ROOT).with_suffix("").parts
        names[".".join(("extension", *parts)).removesuffix(".__init__")] = path
    return names


def imports(name: str, path: Path) -> Iterator[str]:
    """Absolute names of what a module imports, at its top or within a function."""
    package = name if path.name == "__init__.py" else name.rpartition(".")[0]
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = resolve_name("." * node.level + (node.module or ""), package)
            yield from (f"{base}.{alias.name}" for alias in node.names)


def part_of_core(name: str) -> str | None:
    """``path`` for ``extension.core.path.plan_path``; None for what is not in the core."""
    return name.split(".")[2] if name.startswith("extension.core.") else None


CORE_MODULES = modules("core")
ADDON_MODULES = modules("ifs_morph_addon")


def test_the_sources_are_found():
    assert {"extension.core", "extension.core.affine"} <= CORE_MODULES.keys()
    assert {"extension.ifs_morph_addon", "extension.ifs_morph_addon.compat"} <= ADDON_MODULES.keys()


@pytest.mark.parametrize("name", [name for name in CORE_MODULES if part_of_core(name)])
def test_core_imports_only_what_stands_above_it(name):
    part = part_of_core(name)
    assert part in CORE, f"say in CORE where core.{part} stands"
    allowed = {*CORE[: CORE.index(part)], part}
    used = {other for imported in imports(name, CORE_MODULES[name]) if (other := part_of_core(imported))}
    assert used <= allowed


@pytest.mark.parametrize("name", CORE_MODULES)
def test_core_knows_nothing_of_blender(name):
    for imported in imports(name, CORE_MODULES[name]):
        top = imported.split(".")[0]
        assert top not in {"bpy", "bl_ext", "addon_utils", "mathutils", "gpu", "blf", "core", "ifs_morph_addon"}
        assert top != "extension" or part_of_core(imported), f"{name} reaches out of the core: {imported}"


@pytest.mark.parametrize("name", ADDON_MODULES)
def test_the_addon_imports_its_own_modules_relatively(name):
    """Blender takes an absolute import of a module of an extension for a violation of its policy."""
    own = {"core", "ifs_morph_addon", "bl_ext", "release", "tests", "demo_scenes"}
    assert own.isdisjoint(imported.split(".")[0] for imported in imports(name, ADDON_MODULES[name]))


def test_numba_waits_until_a_kernel_is_called():
    """Whoever imports numba has all others wait for it that import the extension."""
    users = {
        name
        for name, path in (CORE_MODULES | ADDON_MODULES).items()
        if "numba" in {imported.split(".")[0] for imported in imports(name, path)}
    }
    assert users == {"extension.core.kernels", "extension.core.kernel_cache"}


def test_no_modules_of_the_addon_import_each_other_in_a_circle():
    arrows = {
        name: {other for imported in imports(name, path) if (other := _module(imported)) not in (None, name)}
        for name, path in ADDON_MODULES.items()
    }
    while leaves := [name for name in arrows if not arrows[name] & arrows.keys()]:
        for name in leaves:
            del arrows[name]
    assert not arrows, f"a circle among {sorted(arrows)}"


def _module(imported: str) -> str | None:
    """The module of the add-on that an imported name stands for or is taken from."""
    return next((name for name in (imported, imported.rpartition(".")[0]) if name in ADDON_MODULES), None)


@pytest.mark.parametrize("package", ["core", "release", "demo_scenes", "tests"])
def test_nothing_imports_the_addon_from_the_checkout(package):
    """Only the extension's own __init__.py does; programs and tests use the installed extension."""
    for name, path in modules(package).items():
        tops = {imported.removeprefix("extension.").split(".")[0] for imported in imports(name, path)}
        assert "ifs_morph_addon" not in tops, f"{name} imports the add-on"

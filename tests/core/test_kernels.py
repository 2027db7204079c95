"""Kernels are compiled late, kept where something can be written, and never used when a source has changed."""

import ast
import json
import os
import shutil
import subprocess
import sys
from importlib.util import resolve_name
from pathlib import Path

import pytest

from core import kernels

CORE = Path(kernels.__file__).parent

SQUARE = """
from .kernels import njit

@njit(nogil=True, cache=True)
def square(x):
    return x * x
"""
TWICE = """
from .kernels import njit
from .square import square

@njit(nogil=True, cache=True)
def twice_squared(x):
    return 2 * square(x)
"""
CALL = """
import json, sys
from maths import twice
before = "numba" in sys.modules
result = twice.twice_squared(3.0)
stats = twice.twice_squared.dispatcher.stats
print(json.dumps([before, result, sum(stats.cache_hits.values()), sum(stats.cache_misses.values()), stats.cache_path]))
"""


@pytest.fixture
def package(tmp_path):
    """Make a small package with two kernels, one calling the other."""
    folder = tmp_path / "maths"
    folder.mkdir()
    for name in ("kernels", "kernel_cache"):
        shutil.copy(CORE / f"{name}.py", folder)
    (folder / "__init__.py").touch()
    (folder / "square.py").write_text(SQUARE)
    (folder / "twice.py").write_text(TWICE)
    return folder


def call(package, **environment):
    """Call the kernel in a process of its own."""
    inherited = {name: value for name, value in os.environ.items() if name != "NUMBA_CACHE_DIR"}
    result = subprocess.run(
        [sys.executable, "-c", CALL],
        cwd=package.parent,
        env={**inherited, **environment},
        capture_output=True,
        text=True,
        check=True,
    )
    return json.loads(result.stdout)


def test_numba_is_imported_when_a_kernel_is_called(package):
    imported_before, result, *_ = call(package)
    assert not imported_before
    assert result == 18


def test_a_kernel_is_compiled_once_until_a_source_changes(package, tmp_path):
    kept = tmp_path / "kept"

    def again():
        return call(package, NUMBA_CACHE_DIR=str(kept))[1:]

    hit, miss = [1, 0, str(kept)], [0, 1, str(kept)]
    assert again() == [18, *miss]
    (package / "other.py").write_text("from .square import square\n")
    assert again() == [18, *hit]
    # A change in a kernel that it calls.
    (package / "square.py").write_text(SQUARE.replace("x * x", "x * x * x"))
    assert again() == [54, *miss]
    for path in kept.iterdir():
        path.write_bytes(b"")
    assert again() == [54, *miss], "what cannot be read is compiled again"


def test_kernels_that_two_processes_keep_at_once_are_not_mixed_up(tmp_path):
    from core.kernel_cache import _CacheFile

    files = [_CacheFile(str(tmp_path), "kernel", "stamp") for _ in range(2)]
    index = tmp_path / "kernel.nbi"
    files[0].save(("integers",), "for integers")
    first = index.read_bytes()
    index.unlink()  # as the second process found it, before the first one was done
    files[1].save(("numbers",), "for numbers")
    assert files[0].load(("integers",)) is None
    index.write_bytes(first)
    assert files[0].load(("integers",)) == "for integers"


def test_kernels_work_where_nothing_can_be_written(package):
    shutil.rmtree(package / "__pycache__", ignore_errors=True)
    (package / "__pycache__").touch()
    assert call(package)[1:] == [18, 0, 1, None]


def test_the_environment_chooses_before_the_program_and_that_before_the_sources(tmp_path, monkeypatch):
    monkeypatch.setattr(kernels, "_place", {})
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "environment"))
    kernels.keep_in(tmp_path / "program")
    assert kernels.folder() == tmp_path / "environment"
    monkeypatch.delenv("NUMBA_CACHE_DIR")
    assert kernels.folder() == tmp_path / "program"
    kernels.keep_in(tmp_path / "file" / "below")
    (tmp_path / "file").touch()
    assert kernels.folder() == CORE / "__pycache__"


def with_kernels():
    paths = [path for path in CORE.rglob("*.py") if "@njit" in path.read_text()]
    return [".".join(path.relative_to(CORE).with_suffix("").parts) for path in paths]


@pytest.mark.parametrize("module", with_kernels())
def test_a_fingerprint_covers_all_that_a_module_imports(module):
    seen, left = set(), {module}
    while left:
        name = left.pop()
        seen.add(name)
        for node in ast.parse(source(name).read_text()).body:
            if isinstance(node, ast.ImportFrom) and node.level > 0:
                place = resolve_name("." * node.level + (node.module or ""), f"core.{name}".rpartition(".")[0])
                names = [place, *(f"{place}.{alias.name}" for alias in node.names)]
                left |= {each.removeprefix("core.") for each in names if source(each.removeprefix("core.")).exists()}
        left -= seen
    assert kernels._imported(module) == seen


def source(module):
    return CORE.joinpath(*module.split(".")).with_suffix(".py")

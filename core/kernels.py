"""Compiles kernels when they are first called, and keeps them for the next time.

`njit` is numba's, but for three things. numba is not imported before a kernel is called: a program that opens a window
should not wait for it. A compiled kernel is kept until a source that it was made from changes, be it that of another
kernel which it calls; numba itself looks at one file only. And it is kept where the program says, since the sources may
lie where nothing can be written.
"""

from __future__ import annotations

import os
import re
import sys
import tempfile
import threading
from collections.abc import Callable
from functools import cache, update_wrapper
from hashlib import sha256
from pathlib import Path

SOURCES = Path(__file__).parent

_place: dict[str, Path] = {}
"""The folder that `keep_in` was told, if any."""

_lock = threading.RLock()


class Kernel:
    """A function that is compiled when it is first called, from Python or from another kernel."""

    def __init__(self, function: Callable, options: dict) -> None:
        update_wrapper(self, function)
        self._options = options
        self._dispatcher = None

    def __call__(self, *arguments):
        """Call the compiled function."""
        return (self._dispatcher or self.dispatcher)(*arguments)

    @property
    def dispatcher(self):
        """Numba's object for the function."""
        with _lock:
            if self._dispatcher is None:
                self._dispatcher = _dispatcher(self.__wrapped__, self._options)
            return self._dispatcher

    @property
    def is_compiled(self) -> bool:
        """Whether the function was compiled, or found compiled, for any arguments."""
        return self._dispatcher is not None and len(self._dispatcher.overloads) > 0

    @property
    def _numba_type_(self):
        """What numba asks for where one kernel calls another."""
        return self.dispatcher._numba_type_


def njit(cache: bool = False, **options) -> Callable[[Callable], Kernel]:
    """Decorate a kernel; the options are those of ``numba.njit``, with `cache` as described above."""
    return lambda function: Kernel(function, {"cache": cache, **options})


def _dispatcher(function: Callable, options: dict):
    import numba

    from .kernel_cache import KernelCache

    options = dict(options)
    keep = options.pop("cache")
    dispatcher = numba.njit(**options)(function)
    place = folder() if keep else None
    if place is not None:
        dispatcher._cache = KernelCache(
            function, str(place), fingerprint(function.__module__.removeprefix(f"{__package__}."))
        )
    return dispatcher


def keep_in(folder: Path | None) -> None:
    """Say where to keep kernels that are compiled from now on; None for beside the sources."""
    _place.clear()
    if folder is not None:
        _place["chosen"] = Path(folder)


def folder() -> Path | None:
    """Where kernels are kept, or None if nothing can be written.

    The environment's NUMBA_CACHE_DIR, else what `keep_in` was told, else beside the sources as Python does.
    """
    wished = os.environ.get("NUMBA_CACHE_DIR")
    places = [Path(wished)] if wished else []
    return next(filter(is_writable, [*places, *_place.values(), SOURCES / "__pycache__"]), None)


def is_writable(folder: Path) -> bool:
    """Whether files can be made in a folder, which is made if it does not exist."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=folder).close()
    except OSError:
        return False
    return True


@cache
def fingerprint(module: str) -> str:
    """Short text that changes with the source of a module of the core, and with those of all that it imports."""
    digest = sha256(repr(sys.version_info[:2]).encode())
    for name in sorted(_imported(module)):
        digest.update(_source(name))
    return digest.hexdigest()[:16]


@cache
def _imported(module: str) -> frozenset[str]:
    """A module and those that it imports, directly or not; all imports of modules with kernels are at line starts."""
    text = _source(module).decode("utf-8")
    names = set()
    for dots, name, imported in re.findall(r"^from (\.+)([\w.]*) import ([\w, ]*)", text, re.MULTILINE):
        place = [*module.split(".")[: -len(dots)], *filter(None, name.split("."))]
        names.add(".".join(place))
        names.update(".".join([*place, part.split(" as ")[0]]) for part in imported.split(", ") if part)
    return frozenset({module}).union(*(_imported(name) for name in names if _path(name).exists()))


def _source(module: str) -> bytes:
    return _path(module).read_bytes()


def _path(module: str) -> Path:
    return SOURCES.joinpath(*module.split(".")).with_suffix(".py")

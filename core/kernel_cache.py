"""Tells numba where to keep a compiled kernel, and when one that was kept must not be used any more.

The only module that knows how numba keeps compiled functions. It is imported at the first call of a kernel.
"""

from __future__ import annotations

from contextlib import suppress
from functools import partial
from hashlib import sha256
from zlib import crc32

from numba.core.caching import CompileResultCacheImpl, FunctionCache, IndexDataCacheFile, _CacheLocator


class KernelCache(FunctionCache):
    """Keeps one kernel, for each type of arguments and processor, in a folder.

    Parameters
    ----------
    function : callable
        What is compiled.
    folder : str
        Must exist.
    stamp : str
        Changes with everything that the compiled code depends on; what was kept with another one is made anew.
    """

    def __init__(self, function, folder: str, stamp: str) -> None:
        self._impl_class = partial(_Files, place=_Place(function, folder, stamp))
        super().__init__(function)
        self._cache_file = _CacheFile(folder, self._impl.filename_base, stamp)

    def load_overload(self, signature, target_context):
        """The kept kernel, or None where there is none or it cannot be read."""
        try:
            return super().load_overload(signature, target_context)
        except Exception:  # Whatever a damaged file makes numba or pickle say.
            with suppress(OSError):
                self.flush()
            return None

    def save_overload(self, signature, data) -> None:
        """Keep a kernel; one that cannot be kept, on a full disk say, is compiled again the next time."""
        with suppress(OSError):
            super().save_overload(signature, data)


class _CacheFile(IndexDataCacheFile):
    """Names a kernel's file after its arguments, so that processes that compile at once do not mix up theirs.

    Numba counts the files, and two processes may count to the same number. What is lost here is at worst one's line in
    the index, and that kernel is compiled again.
    """

    def save(self, key, data) -> None:
        name = self._data_name(crc32(repr(key).encode()))
        self._save_data(name, data)
        self._save_index({**self._load_index(), key: name})


class _Files(CompileResultCacheImpl):
    def __init__(self, function, place: _Place) -> None:
        self._locator_classes = [place]
        super().__init__(function)


class _Place(_CacheLocator):
    """Answers numba's questions about one kernel."""

    def __init__(self, function, folder: str, stamp: str) -> None:
        self._package = function.__module__.rpartition(".")[0]
        self._folder, self._stamp = folder, stamp

    def from_function(self, *_) -> _Place:
        return self

    def get_cache_path(self) -> str:
        return self._folder

    def get_source_stamp(self) -> str:
        return self._stamp

    def get_disambiguator(self) -> str:
        """Part of the file's name: a compiled kernel knows its package, so no two may share one."""
        return sha256(self._package.encode()).hexdigest()[:6]

"""Has processes of their own compile the kernels when Blender's window opens with them the first time on a computer.

That takes about a minute, during which a window would freeze. What was compiled is kept in the user's folder of
the extension. Until the processes are over, whatever needs kernels waits and says so, but renders; they must not be
wrong, and Blender compiles for them as it goes. It does the same without a window, and where no process can be had.
"""

import os
import subprocess
import sys
import tempfile
import time
import traceback
from collections.abc import Callable
from pathlib import Path

import bpy

from .. import __package__ as base_package
from ..core import kernels, warm_up

LONGEST = 600.0
"""Seconds after which the processes are given up."""

INTERVAL = 0.25
"""Seconds between two looks at them."""

USUAL = 30.0
ENOUGH_TO_TELL = 0.1
"""What preparing takes in seconds, about, and the share from which on its own pace tells better."""

# The extension's own package needs Blender, so empty ones of the same names stand in for it and its parents.
SCRIPT = """
import importlib, sys, types
part, package, folder, *sys.path = sys.argv[1:]
parts = package.split(".")
for end in range(1, len(parts) + 1):
    module = types.ModuleType(".".join(parts[:end]))
    module.__path__ = [folder]
    sys.modules[module.__name__] = module
importlib.import_module(package + ".core.warm_up").main(part)
"""

_running: list["_Preparation"] = []
"""The preparation that runs, if any."""


class _Preparation:
    def __init__(self, folder: Path, when_over: Callable[[], None]):
        self.folder, self.when_over = folder, when_over
        self.since, self.share = time.time(), 0.0
        self.loading = warm_up.load()
        self.processes: list[subprocess.Popen] = []
        self.output = tempfile.TemporaryFile()  # noqa: SIM115 -- closed in `close`
        try:
            for part in warm_up.PARTS:
                self.processes.append(
                    subprocess.Popen(
                        _command(part),
                        env={**os.environ, "NUMBA_CACHE_DIR": str(folder)},
                        stdin=subprocess.DEVNULL,
                        stdout=self.output,
                        stderr=subprocess.STDOUT,
                        creationflags=_creation_flags(),
                    )
                )
        except OSError:
            self.close()
            raise

    @property
    def elapsed(self) -> float:
        return time.time() - self.since

    def goes_on(self) -> bool:
        """Whether the processes still work. Once they do not, leaves a mark, or says what became of them."""
        if self.output.closed:
            return False
        codes = [process.poll() for process in self.processes]
        if None in codes and not any(codes) and self.elapsed < LONGEST:
            return True
        said = self.close()
        if any(code != 0 for code in codes):
            print(f"IFS Morph: could not prepare ahead, so its first use will take a minute.\n{said}")
        else:
            warm_up.mark_done(self.folder)
        return False

    def close(self) -> str:
        """End the processes that still run; what all said."""
        if self.output.closed:
            return ""
        for process in self.processes:
            process.kill()
            process.wait()
        with self.output as output:
            output.seek(0)
            return output.read().decode(errors="replace")


def _command(part: str) -> list[str]:
    python = sys.executable or ""
    if not Path(python).name.lower().startswith("python"):
        raise OSError(f"“{python}” is no Python")
    # Python's own compiled modules belong where Blender has them, too.
    options = ["-I", "-B"] if sys.dont_write_bytecode else ["-I"]
    if sys.pycache_prefix:
        options += ["-X", f"pycache_prefix={sys.pycache_prefix}"]
    extension = str(Path(warm_up.__file__).parents[1])
    return [python, *options, "-c", SCRIPT, part, base_package, extension, *filter(None, sys.path)]


def _creation_flags() -> int:
    """Keep Windows from opening a console and from putting the process before Blender."""
    if sys.platform != "win32":
        return 0
    return subprocess.CREATE_NO_WINDOW | subprocess.BELOW_NORMAL_PRIORITY_CLASS


def begin(when_over: Callable[[], None]) -> None:
    """Say where kernels are kept, and prepare them if they are missing and there is a window to wait for them.

    `when_over` is called once whatever had to wait can go on.
    """
    kernels.keep_in(_user_folder())
    folder = kernels.folder()
    if not (bpy.app.background or folder is None or warm_up.is_done(folder)):
        start(folder, when_over)


def _user_folder() -> Path:
    try:
        folder = Path(bpy.utils.extension_path_user(base_package, path="kernels"))
    except ValueError:
        return Path(bpy.app.tempdir, "kernels")  # Run from somewhere else than an extensions repository.
    return folder if kernels.is_writable(folder) else Path(bpy.app.tempdir, "kernels")


def start(folder: Path, when_over: Callable[[], None]) -> None:
    """Start the processes, and look after them from a timer."""
    try:
        _running.append(_Preparation(folder, when_over))
    except OSError as error:
        print(f"IFS Morph: could not prepare ahead, so its first use will take a minute: {error}")
        return
    bpy.app.timers.register(look, first_interval=INTERVAL, persistent=True)


def look() -> float | None:
    """See how far the processes are, and let the window show it; seconds until the next look."""
    preparation = _running[0]
    try:
        if preparation.goes_on():
            preparation.share = warm_up.share_done(preparation.folder, preparation.since)
            _show(message())
            return INTERVAL
        for _ in preparation.loading:
            return 0.0
    except Exception:
        traceback.print_exc()  # Whatever it was, nobody must wait for ever.
    end()
    preparation.when_over()
    return None


def end() -> None:
    """End the processes, if they run, and wait for nothing any more."""
    if bpy.app.timers.is_registered(look):
        bpy.app.timers.unregister(look)
    while _running:
        _running.pop().close()
        _show(None)


def is_running() -> bool:
    """Whether what needs kernels has to wait."""
    return bool(_running)


def share() -> float:
    """Share of the preparation that is over; 1 where none runs."""
    return _running[0].share if _running else 1.0


def message() -> str:
    """What there is to wait for, in one sentence; empty if there is nothing."""
    if not _running:
        return ""
    left = _running[0].elapsed * (1 - share()) / share() if share() > ENOUGH_TO_TELL else USUAL
    return f"Preparing IFS Morph for this computer, the first time only. About {max(5 * round(left / 5), 5)} s left."


def _show(text: str | None) -> None:
    """Put a text into the status bar, or Blender's own, and draw sidebars again."""
    for window in bpy.context.window_manager.windows:
        window.workspace.status_text_set(text)
        for area in window.screen.areas:
            for region in area.regions:
                if (area.type, region.type) == ("VIEW_3D", "UI"):
                    region.tag_redraw()

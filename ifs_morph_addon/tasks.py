"""Long work inside an operator: a step at a time in the window, in one go without one.

The work is a generator that yields the share done. In the window a timer steps it, so that Blender stays responsive and
Esc stops it; nothing of the file may change before the generator's last step.
"""

import time

import bpy

from ..core.ifs import IFSError

STEP_SECONDS = 0.04
"""Shortest time that a timer event works; the core's own steps take about as long again."""


_running: list[str] = []
"""Name of the task that works in the window now, if any."""


def is_running() -> bool:
    """Whether a task works in the window, which needs the file as it is."""
    return bool(_running)


class LongTask:
    """Mixin for operators.

    Subclasses have ``work(context)``, a generator that yields the share done in [0, 1], changes the file only after its
    last yield, and says what came of it by `self.report`.
    """

    on_escape = "Cancel"
    """What Esc does, for the status bar."""

    def execute(self, context):
        """Work to the end, as scripts and background runs want it."""
        try:
            for _share in self.work(context):
                pass
        except IFSError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}

    def invoke(self, context, event):
        """Start to work while the window shows the progress."""
        if bpy.app.background:
            return self.execute(context)
        self._steps = self.work(context)
        window_manager = context.window_manager
        window_manager.progress_begin(0, 100)
        self._timer = window_manager.event_timer_add(0.01, window=context.window)
        window_manager.modal_handler_add(self)
        _running.append(self.bl_idname)
        self._show(context, 0.0)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        """Work a little at each tick of the timer; Esc and the right mouse button interrupt."""
        if event.type in {"ESC", "RIGHTMOUSE"} and event.value == "PRESS":
            return self.interrupt(context)
        if event.type != "TIMER":
            return {"RUNNING_MODAL"}
        started = time.perf_counter()
        try:
            while time.perf_counter() - started < STEP_SECONDS:
                share = next(self._steps)
        except StopIteration:
            self._close(context)
            return {"FINISHED"}
        except IFSError as error:
            self._close(context)
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        except BaseException:
            self._close(context)
            raise
        self._show(context, share)
        return {"RUNNING_MODAL"}

    def interrupt(self, context):
        """Stop where it is, on Esc: leave everything as it was, unless a task has something to keep by then."""
        self.cancel(context)
        self.report({"INFO"}, f"{self.bl_label} cancelled")
        return {"CANCELLED"}

    def cancel(self, context):
        """Stop and leave everything as it was; Blender calls this too, when it closes a file."""
        self._steps.close()
        self._close(context)

    def _show(self, context, share):
        context.window_manager.progress_update(100 * share)
        context.workspace.status_text_set(f"{self.bl_label}: {100 * share:.0f} %   (Esc: {self.on_escape})")

    def _close(self, context):
        _running.remove(self.bl_idname)
        window_manager = context.window_manager
        window_manager.event_timer_remove(self._timer)
        window_manager.progress_end()
        context.workspace.status_text_set(None)
        for area in context.screen.areas:
            area.tag_redraw()

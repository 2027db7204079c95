"""Dragging with the left mouse button: live, one undo step each, Esc or the right mouse button puts everything back."""

PRECISION = 0.1
"""Share of the mouse's way that counts while Shift is held."""

MOVES = {"MOUSEMOVE", "LEFT_CTRL", "RIGHT_CTRL", "LEFT_SHIFT", "RIGHT_SHIFT"}


class Drag:
    """Mixin for operators that follow the mouse from its press to its release.

    Subclasses have ``grab(context, pixel)``, which says whether there is something to drag, ``follow(context, pixel,
    snap)`` with whether Ctrl is held, and then one of ``put_back(context)`` and ``confirm(context)``.
    """

    hint = ""

    def invoke(self, context, event):
        """Take hold of what is under the mouse; leave the click to others if there is nothing."""
        self._pixel = self._mouse = event.mouse_region_x, event.mouse_region_y
        if not self.grab(context, self._pixel):
            return {"PASS_THROUGH"}
        context.window_manager.modal_handler_add(self)
        context.workspace.status_text_set(self.hint)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        """Follow the mouse."""
        if event.type in {"ESC", "RIGHTMOUSE"} and event.value == "PRESS":
            self.cancel(context)
            return {"CANCELLED"}
        if event.type == "LEFTMOUSE" and event.value == "RELEASE":
            context.workspace.status_text_set(None)
            self.confirm(context)
            return {"FINISHED"}
        if event.type in MOVES:
            mouse = event.mouse_region_x, event.mouse_region_y
            share = PRECISION if event.shift else 1.0
            # Way by way, so that nothing jumps when Shift is pressed in the middle of a drag.
            self._pixel = tuple(p + share * (m - b) for p, m, b in zip(self._pixel, mouse, self._mouse, strict=True))
            self._mouse = mouse
            self.follow(context, self._pixel, event.ctrl)
        return {"RUNNING_MODAL"}

    def cancel(self, context):
        """Put everything back; Blender calls this too, when it closes a file."""
        context.workspace.status_text_set(None)
        self.put_back(context)

"""Drag (u,v) and the keys of the path over the picture of the locus, add keys and remove them."""

import bpy
import numpy as np

from .. import fcurves, path_keys
from ..conversion import fit_window
from ..operators.poll import editable_morph
from . import locus_space
from .dragging import Drag


def _has_editable_path(cls, context) -> bool:
    if not editable_morph(cls, context):
        return False
    problem = _obstacle(context.object)
    if problem:
        cls.poll_message_set(problem)
    return problem is None


def _obstacle(owner) -> str | None:
    """Why no key of an object's path can be edited, or None."""
    if not fcurves.has_path(owner):
        return "(u,v) has no keys; plan a path first, or key it by hand"
    return fcurves.obstacle(owner)


class IFSMORPH_OT_drag_on_locus(Drag, bpy.types.Operator):
    """Drag the cross to morph, or a key to move the path. Shift: precisely. Ctrl: along the path, through its frames"""

    bl_idname = "ifs_morph.drag_on_locus"
    bl_label = "Drag on Locus"
    bl_options = {"REGISTER", "UNDO"}

    hint = "Release: Confirm    Esc: Cancel    Shift: Precisely    Ctrl: Along the Path"

    key: bpy.props.BoolProperty(name="Key", description="Move the key at the frame rather than (u,v) itself")
    frame: bpy.props.FloatProperty(name="Frame", description="Frame of the key")
    uv: bpy.props.FloatVectorProperty(name="UV", description="Where to go", size=2, precision=4)

    poll = classmethod(editable_morph)

    def execute(self, context):
        """Move the key, or (u,v)."""
        owner = context.object
        if not self.key:
            owner.ifs_morph.uv = self.uv
            return {"FINISHED"}
        problem = _obstacle(owner)
        if problem:
            self.report({"ERROR"}, f"{problem}.")
            return {"CANCELLED"}
        path_keys.prepare(owner)
        path_keys.move(owner, path_keys.read(owner), self.frame, self.uv)
        path_keys.select(owner, self.frame)
        fit_window(owner)
        return {"FINISHED"}

    def grab(self, context, pixel):
        """Take the key or the cross under the mouse."""
        owner = locus_space.editable_owner(context)
        handle = locus_space.handle_at(context, pixel)
        if handle is None:
            return False
        kind, frame = handle
        self.key = kind == "KEY"
        if self.key:
            problem = _obstacle(owner)
            if problem:
                self.report({"WARNING"}, f"{problem}.")
                return False
            path_keys.prepare(owner)
            path_keys.select(owner, frame)
            self.frame = frame
            self._before = path_keys.read(owner)
            self.uv = fcurves.sample_path(owner, [frame])[0, :2]
        else:
            self._before = tuple(owner.ifs_morph.uv), context.scene.frame_current
            self.uv = owner.ifs_morph.uv
        # The handle need not be exactly under the mouse, and is not to jump there.
        self._offset = np.array(self.uv) - self._place(context, pixel)
        context.area.tag_redraw()
        return True

    def follow(self, context, pixel, snap):
        """Go where the mouse goes."""
        owner = context.object
        frame = locus_space.frame_at(context, pixel, reach=np.inf) if snap and not self.key else None
        if frame is not None:
            context.scene.frame_set(frame)
            self.uv = owner.ifs_morph.uv
            return
        self.uv = self._place(context, pixel) + self._offset
        if self.key:
            path_keys.move(owner, self._before, self.frame, self.uv)
        else:
            owner.ifs_morph.uv = self.uv
        context.area.tag_redraw()

    def put_back(self, context):
        """Put the key or (u,v) back."""
        if self.key:
            path_keys.restore(context.object, self._before)
            return
        uv, frame = self._before
        if context.scene.frame_current != frame:
            context.scene.frame_set(frame)
        context.object.ifs_morph.uv = uv

    def confirm(self, context):
        """Fit the window to the new path; key (u,v) where Blender keys automatically."""
        owner = context.object
        if self.key:
            fit_window(owner)
        elif context.scene.tool_settings.use_keyframe_insert_auto and fcurves.obstacle(owner) is None:
            path_keys.key(owner, context.scene.frame_current, owner.ifs_morph.uv)
            fit_window(owner)

    def _place(self, context, pixel):
        return locus_space.from_region(context.space_data.image, context.region, pixel)


class IFSMORPH_OT_add_path_key(bpy.types.Operator):
    """Add a key to the path where it is, without changing its course"""

    bl_idname = "ifs_morph.add_path_key"
    bl_label = "Add Path Key"
    bl_options = {"REGISTER", "UNDO"}

    frame: bpy.props.IntProperty(name="Frame", description="Frame of the key")

    poll = classmethod(_has_editable_path)

    def invoke(self, context, event):
        """Add a key under the mouse, if the path is there; leave the click to others if it is not."""
        pixel = event.mouse_region_x, event.mouse_region_y
        frame = locus_space.frame_at(context, pixel) if locus_space.editable_owner(context) else None
        if frame is None:
            return {"PASS_THROUGH"}
        self.frame = frame
        return self.execute(context)

    def execute(self, context):
        """Add a key."""
        owner = context.object
        frames = fcurves.key_frames(owner)
        if not frames[0] < self.frame < frames[-1]:
            self.report(
                {"ERROR"},
                f"The path runs from frame {frames[0]:g} to {frames[-1]:g}; frame {self.frame} is not inside.",
            )
            return {"CANCELLED"}
        path_keys.add(owner, self.frame)
        _redraw(context)
        return {"FINISHED"}


class IFSMORPH_OT_remove_path_keys(bpy.types.Operator):
    """Remove the selected keys of the path; it goes on without them"""

    bl_idname = "ifs_morph.remove_path_keys"
    bl_label = "Remove Path Keys"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        """Need selected keys, and in an Image Editor the locus, for other pictures have other uses for the keys."""
        if not _has_editable_path(cls, context):
            return False
        space = context.space_data
        if space is not None and space.type == "IMAGE_EDITOR" and not locus_space.editable_owner(context):
            cls.poll_message_set("Show the locus in this editor first")
            return False
        if not path_keys.selected_frames(context.object):
            cls.poll_message_set("Click a key of the path to select it")
            return False
        return True

    def execute(self, context):
        """Remove the keys."""
        owner = context.object
        path_keys.remove(owner, path_keys.selected_frames(owner))
        fit_window(owner)
        _redraw(context)
        return {"FINISHED"}


def _redraw(context):
    if context.area is not None:
        context.area.tag_redraw()


CLASSES = (IFSMORPH_OT_drag_on_locus, IFSMORPH_OT_add_path_key, IFSMORPH_OT_remove_path_keys)

register, unregister = bpy.utils.register_classes_factory(CLASSES)

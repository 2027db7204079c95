"""Makes the path and the current (u,v) over the picture of the locus answer to the mouse and the keyboard."""

import bpy
import gpu

from .. import fcurves
from . import drawing, locus_space

HOVERED = (1.0, 1.0, 1.0, 1.0)

_keymap_items: list = []


class IFSMORPH_GT_path(bpy.types.Gizmo):
    """The cross and the keys of the path"""

    bl_idname = "IFSMORPH_GT_path"

    __slots__ = ("hovered",)

    def setup(self):
        """Begin with nothing under the mouse."""
        self.hovered = None

    def test_select(self, context, location):
        """Find the key or the cross under the mouse."""
        before = self.hovered
        self.hovered = locus_space.handle_at(context, location)
        if self.hovered != before:
            context.region.tag_redraw()
        return -1 if self.hovered is None else 0

    def draw(self, context):
        """Draw a frame around what is under the mouse; the overlay draws the rest."""
        owner = locus_space.editable_owner(context)
        if owner is None or self.hovered is None:
            return
        kind, frame = self.hovered
        place = tuple(owner.ifs_morph.uv) if kind == "CURRENT" else fcurves.sample_path(owner, [frame])[0, :2]
        x, y = locus_space.to_region(context.space_data.image, context.region, [place])[0]
        scale = context.preferences.system.ui_scale
        reach = (locus_space.CROSS + 3 if kind == "CURRENT" else locus_space.REACH) * scale
        box = [(x - reach, y - reach), (x + reach, y - reach), (x + reach, y + reach), (x - reach, y + reach)]
        gpu.state.blend_set("ALPHA")
        drawing.lines(box, HOVERED, 1.5 * scale, "LINE_LOOP")
        gpu.state.blend_set("NONE")


class IFSMORPH_GGT_path(bpy.types.GizmoGroup):
    """The handles of the active morph's path, where its locus is shown"""

    bl_idname = "IFSMORPH_GGT_path"
    bl_label = "IFS Morph Path"
    bl_space_type = "IMAGE_EDITOR"
    bl_region_type = "WINDOW"
    bl_options = {"PERSISTENT"}

    @classmethod
    def poll(cls, context):
        """Show over the locus and nowhere else."""
        return locus_space.editable_owner(context) is not None

    def setup(self, context):
        """Make one gizmo for all handles; a press on one starts the operator."""
        gizmo = self.gizmos.new(IFSMORPH_GT_path.bl_idname)
        gizmo.target_set_operator("ifs_morph.drag_on_locus")
        gizmo.use_draw_modal = True


CLASSES = (IFSMORPH_GT_path, IFSMORPH_GGT_path)


def register():
    """Register the handles, and the keys that add and remove keys of the path."""
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    keymap = bpy.context.window_manager.keyconfigs.addon.keymaps.new("Image", space_type="IMAGE_EDITOR")
    for operator, key, modifiers in (
        ("ifs_morph.add_path_key", "LEFTMOUSE", {"ctrl": True}),
        ("ifs_morph.remove_path_keys", "X", {}),
        ("ifs_morph.remove_path_keys", "DEL", {}),
    ):
        _keymap_items.append((keymap, keymap.keymap_items.new(operator, key, "PRESS", **modifiers)))


def unregister():
    """Take them off again."""
    while _keymap_items:
        keymap, item = _keymap_items.pop()
        keymap.keymap_items.remove(item)
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)

"""The maps of a shape as triangles in the viewport, whose corners can be dragged."""

import bpy
import gpu
import numpy as np

from .. import corners
from ..conversion import edited_shape
from . import drawing, map_space

EDGE = (0.0, 0.0, 0.0, 0.7)
UNIT = (0.6, 0.6, 0.6, 0.6)
HOVERED = (1.0, 1.0, 1.0, 1.0)
FAINT, STRONG = 0.06, 0.22
"""How much a triangle is filled, and that of the active map."""


class IFSMORPH_GT_maps(bpy.types.Gizmo):
    """Triangles of all maps of the edited shape"""

    bl_idname = "IFSMORPH_GT_maps"

    __slots__ = ("hovered",)

    def setup(self):
        """Begin with nothing under the mouse."""
        self.hovered = None

    def test_select(self, context, location):
        """Find the corner under the mouse."""
        before = self.hovered
        self.hovered = map_space.handle_at(context, location)
        if self.hovered != before:
            context.region.tag_redraw()
        return -1 if self.hovered is None else 0

    def draw(self, context):
        """Draw the triangles, the active one last and over the others."""
        owner = map_space.edited_owner(context)
        if owner is None:
            return
        shape = edited_shape(owner)
        places = corners.places(owner)
        flat = np.concatenate([places.reshape(-1, 2), corners.unit_triangle(owner)])
        pixels = map_space.to_region(context, owner, flat)
        triangles, unit = pixels[:-3].reshape(-1, 4, 2), pixels[-3:]
        scale = context.preferences.system.ui_scale
        gpu.state.blend_set("ALPHA")
        if not np.isnan(unit).any():
            drawing.lines(unit, UNIT, scale, "LINE_LOOP")
        order = sorted(range(len(triangles)), key=lambda index: index == shape.active_index)
        for index in order:
            if not np.isnan(triangles[index]).any():
                self._draw_triangle(triangles[index], index, shape, scale)
        gpu.state.blend_set("NONE")

    def _draw_triangle(self, points, index, shape, scale):
        color = tuple(shape.maps[index].color)
        active = index == shape.active_index
        drawing.area(points[:3], (*color, STRONG if active else FAINT))
        drawing.lines(points[:3], EDGE, (5 if active else 3.5) * scale, "LINE_LOOP")
        drawing.lines(points[:3], (*color, 1.0), (2.5 if active else 1.5) * scale, "LINE_LOOP")
        for corner, (name, point) in enumerate(zip(corners.NAMES, points, strict=True)):
            # The origin is larger than the ends of the axes, and x than y, so that a reflection can be seen.
            size = (11, 8, 6, 6)[corner] * scale
            hovered = self.hovered == (index, name)
            drawing.dots([point], EDGE, size + 3 * scale)
            drawing.dots([point], HOVERED if hovered else (*color, 1.0), size)


class IFSMORPH_GGT_maps(bpy.types.GizmoGroup):
    """The triangles of the active morph's maps, while they are edited"""

    bl_idname = "IFSMORPH_GGT_maps"
    bl_label = "IFS Morph Maps"
    bl_space_type = "VIEW_3D"
    bl_region_type = "WINDOW"
    bl_options = {"PERSISTENT"}

    @classmethod
    def poll(cls, context):
        """Show while the panel says so."""
        return map_space.edited_owner(context) is not None

    def setup(self, context):
        """Make one gizmo for all triangles; a press on a corner starts the operator."""
        gizmo = self.gizmos.new(IFSMORPH_GT_maps.bl_idname)
        gizmo.target_set_operator("ifs_morph.drag_map")
        gizmo.use_draw_modal = True


register, unregister = bpy.utils.register_classes_factory((IFSMORPH_GT_maps, IFSMORPH_GGT_maps))

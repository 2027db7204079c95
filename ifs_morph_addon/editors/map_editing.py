"""Drag the corners of a map's triangle in the viewport."""

import bpy
import numpy as np

from .. import corners
from ..conversion import edited_shape
from ..operators.poll import ENDS, editable_morph, shape_of
from ..outputs.placing import frame_size
from ..property_options import hold_window, release_window
from . import map_space
from .dragging import Drag

STEPS = 10
"""Steps of the grid that Ctrl snaps to, along the triangle that stands for no change."""


class IFSMORPH_OT_drag_map(Drag, bpy.types.Operator):
    """Drag a corner of a map's triangle to change the map, its middle to move it. Ctrl: snap. Shift: precisely"""

    bl_idname = "ifs_morph.drag_map"
    bl_label = "Drag Map"
    bl_options = {"REGISTER", "UNDO"}

    hint = "Release: Confirm    Esc: Cancel    Shift: Precisely    Ctrl: Snap to Corners and Grid"

    end: bpy.props.EnumProperty(name="End", description="Which shape to change", items=ENDS)
    index: bpy.props.IntProperty(name="Map", description="Which of its maps to change, from zero", min=0)
    corner: bpy.props.EnumProperty(
        name="Corner",
        description="What of the map's triangle to move",
        items=(
            ("ORIGIN", "Origin", "The corner that is the origin's image"),
            ("X", "X", "The end of the x axis"),
            ("Y", "Y", "The end of the y axis"),
            ("WHOLE", "Whole", "All of it, by its middle"),
        ),
    )
    place: bpy.props.FloatVectorProperty(
        name="Place", description="Where to move it, in the plane of the attractor", size=2, precision=4
    )

    poll = classmethod(editable_morph)

    def execute(self, context):
        """Change the map."""
        shape = shape_of(self, context)
        if self.index >= len(shape.maps):
            self.report({"ERROR"}, f"The shape has {len(shape.maps)} maps; there is no map {self.index + 1}.")
            return {"CANCELLED"}
        self._change(context)
        return {"FINISHED"}

    def grab(self, context, pixel):
        """Take the corner under the mouse."""
        owner = map_space.edited_owner(context)
        handle = map_space.handle_at(context, pixel)
        under = None if handle is None else map_space.from_region(context, owner, pixel)
        if under is None:
            return False
        self.index, self.corner = handle
        self.end = owner.ifs_morph.edited_end
        shape = edited_shape(owner)
        self._before = [tuple(row) for row in shape.maps[self.index].matrix], shape.active_index
        self.place = corners.places(owner)[self.index, corners.NAMES.index(self.corner)]
        self._offset = np.array(self.place) - under
        shape.active_index = self.index
        hold_window(owner)
        return True

    def follow(self, context, pixel, snap):
        """Go where the mouse goes."""
        owner = context.object
        under = map_space.from_region(context, owner, pixel)
        if under is None:
            return
        place = under + self._offset
        self.place = self._snapped(context, owner, place) if snap else place
        self._change(context)

    def put_back(self, context):
        """Give the map its matrix back."""
        shape = shape_of(self, context)
        shape.maps[self.index].matrix, shape.active_index = self._before
        release_window(context.object)

    def confirm(self, context):
        """Fit the window to what has become of the shape."""
        release_window(context.object)

    def _change(self, context):
        corners.drag(context.object, shape_of(self, context).maps[self.index], self.corner, np.array(self.place))

    def _snapped(self, context, owner, place):
        """Go to the corner of another map that is near, or to the nearest place of a grid."""
        others = np.delete(corners.places(owner)[:, :3], self.index, axis=0).reshape(-1, 2)
        pixels = map_space.to_region(context, owner, np.vstack([place, others]))
        distances = np.nan_to_num(np.linalg.norm(pixels[1:] - pixels[0], axis=1), nan=np.inf)
        reach = map_space.REACH * context.preferences.system.ui_scale
        if len(others) and distances.min() <= reach:
            return others[distances.argmin()]
        step = frame_size(owner.ifs_morph.output.window) / STEPS
        return np.round(place / step) * step


register, unregister = bpy.utils.register_classes_factory((IFSMORPH_OT_drag_map,))

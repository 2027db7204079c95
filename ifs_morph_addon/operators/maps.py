"""Add, remove, duplicate and reorder the maps of a shape."""

import bpy

from ..conversion import MOST_RECURRENT, fit_window
from ..fcurves import rearrange_offsets
from ..pairs import exchange_maps
from ..property_options import window_held
from .poll import ENDS, editable_morph, shape_of

STORED = ("name", "matrix", "matrix_in_space", "weight", "opacity", "color", "winding", "transitions")
"""What a map stores; the rest of its properties follows."""


class _MapOperator:
    bl_options = {"REGISTER", "UNDO"}

    end: bpy.props.EnumProperty(name="End", description="Which shape to change", items=ENDS)

    poll = classmethod(editable_morph)

    def execute(self, context):
        """Change the list of maps, and have the picture follow."""
        shape = shape_of(self, context)
        try:
            problem = self.change(shape)
        except TypeError:
            # Blender's word for a collection that is a library override.
            problem = "A library override keeps the maps of its library in their order; make the object local first."
        if problem:
            self.report({"ERROR"}, problem)
            return {"CANCELLED"}
        fit_window(context.object)
        context.object.update_tag()
        return {"FINISHED"}

    def have_paths_follow(self, owner, origins) -> None:
        """Have initial maps keep paths of their own where the list changes; with pairs it is these that have them."""
        if self.end == "INITIAL" and len(owner.ifs_morph.matching.pairs) == 0:
            rearrange_offsets(owner, origins)


def reorder_transitions(shape, change) -> None:
    """Have the transitions of all maps follow a change of the list: `change` takes the numbers of one to new ones."""
    with window_held(shape.id_data):
        for item in shape.maps:
            item.transitions = change(list(item.transitions))[:MOST_RECURRENT]


class IFSMORPH_OT_map_add(_MapOperator, bpy.types.Operator):
    """Add a map to the shape: its whole at half its size"""

    bl_idname = "ifs_morph.map_add"
    bl_label = "Add Map"

    def change(self, shape):
        """Append a map and make it the active one."""
        item = shape.maps.add()
        item.name = f"Map {len(shape.maps)}"
        shape.active_index = len(shape.maps) - 1


class IFSMORPH_OT_map_remove(_MapOperator, bpy.types.Operator):
    """Remove the active map from the shape"""

    bl_idname = "ifs_morph.map_remove"
    bl_label = "Remove Map"

    def change(self, shape):
        """Remove the active map; the one after it becomes active."""
        if not 0 <= shape.active_index < len(shape.maps):
            return "There is no active map to remove."
        rows = [k for k in range(len(shape.maps)) if k != shape.active_index]
        shape.maps.remove(shape.active_index)
        self.have_paths_follow(shape.id_data, rows)
        reorder_transitions(shape, lambda row: [*row[: shape.active_index], *row[shape.active_index + 1 :], 1.0])
        shape.active_index = max(0, min(shape.active_index, len(shape.maps) - 1))
        return None


class IFSMORPH_OT_map_duplicate(_MapOperator, bpy.types.Operator):
    """Duplicate the active map"""

    bl_idname = "ifs_morph.map_duplicate"
    bl_label = "Duplicate Map"

    def change(self, shape):
        """Put a copy after the active map and make it the active one."""
        index = shape.active_index
        if not 0 <= index < len(shape.maps):
            return "There is no active map to duplicate."
        copy, source = shape.maps.add(), shape.maps[index]
        for name in STORED:
            setattr(copy, name, getattr(source, name))
        place = shape.active_index = len(shape.maps) - 1
        try:
            shape.maps.move(place, index + 1)
            place = shape.active_index = index + 1
        except TypeError:
            pass  # In a library override the copy stays at the end.
        reorder_transitions(shape, lambda row: [*row[:place], *row[index : index + 1], *row[place:-1]])
        rows = list(range(len(shape.maps) - 1))
        self.have_paths_follow(shape.id_data, [*rows[:place], index, *rows[place:]])
        return None


class IFSMORPH_OT_map_move(_MapOperator, bpy.types.Operator):
    """Move the active map in the list. Pairs move with it; without pairs map k becomes map k"""

    bl_idname = "ifs_morph.map_move"
    bl_label = "Move Map"

    direction: bpy.props.EnumProperty(
        name="Direction",
        description="Where to move the map",
        items=(("UP", "Up", "Towards the start"), ("DOWN", "Down", "Towards the end")),
    )

    def change(self, shape):
        """Swap the active map with its neighbor."""
        index = shape.active_index
        target = index + (-1 if self.direction == "UP" else 1)
        if not (0 <= index < len(shape.maps) and 0 <= target < len(shape.maps)):
            return "The map is at the end of the list already."
        shape.maps.move(index, target)
        places = list(range(MOST_RECURRENT))
        if max(index, target) < MOST_RECURRENT:
            places[index], places[target] = target, index
        reorder_transitions(shape, lambda row: [row[place] for place in places])
        shape.active_index = target
        owner = shape.id_data
        with window_held(owner):
            exchange_maps(owner.ifs_morph.matching, self.end.lower(), index, target)
            rows = list(range(len(shape.maps)))
            rows[index], rows[target] = target, index
            self.have_paths_follow(owner, rows)
        return None


CLASSES = (IFSMORPH_OT_map_add, IFSMORPH_OT_map_remove, IFSMORPH_OT_map_duplicate, IFSMORPH_OT_map_move)

register, unregister = bpy.utils.register_classes_factory(CLASSES)

"""The sidebar tab IFS Morph: one panel for each thing that an animator thinks of."""

import bpy

from .. import fcurves, live, locus_picture, outputs, preparation
from ..conversion import MOST_RECURRENT, has_pairs, pairs_problem, path_fingerprint, shape_problem
from .files import draw_file_buttons
from .pairs import IFSMORPH_PT_pairs
from .path import IFSMORPH_PT_offsets, IFSMORPH_PT_path
from .presets import IFSMORPH_PT_output_presets
from .sidebar import SidebarPanel
from .text import sentence

MOST_IN_GRID = 8
"""Maps whose transitions are drawn as a grid."""


class IFSMORPH_PT_main(SidebarPanel, bpy.types.Panel):
    """The active morph, or how to add one."""

    bl_label = "IFS Morph"

    @classmethod
    def poll(cls, context):
        """Show always, so that the tab says what to do."""
        return True

    def draw(self, context):
        """Draw the place in the morph, and what is wrong with it."""
        layout = self.layout
        if preparation.is_running():
            sentence(layout, context, preparation.message(), icon="TIME")
            layout.progress(factor=preparation.share(), text=f"{100 * preparation.share():.0f} %")
        owner = context.object
        if owner is None or owner.ifs_morph.kind == "NONE":
            column = layout.column()
            column.operator("object.ifs_morph_add", text="Add Image Plane", icon="FILE_IMAGE").kind = "IMAGE"
            column.operator("object.ifs_morph_add", text="Add Point Cloud", icon="POINTCLOUD_DATA").kind = "POINTS"
            return
        settings = owner.ifs_morph
        column = layout.column()
        button = column.row()
        button.scale_y = 1.6
        button.operator("ifs_morph.morph", icon="SHADERFX")
        row = column.row(align=True)
        row.prop(settings.matching, "budget", expand=True)
        layout.use_property_split = True
        column = layout.column()
        column.use_property_decorate = False
        column.prop(settings, "scheme")
        row = column.row()
        row.active = settings.scheme != "ELEMENTWISE"
        row.prop(settings.matching, "choose_scheme")
        column = layout.column(align=True)
        column.prop(settings, "uv", index=0, text="U")
        column.prop(settings, "uv", index=1, text="V")
        column.prop(settings, "swell")
        problem = shape_problem(settings) or outputs.message(owner) or pairs_problem(settings)
        if problem and not preparation.is_running():
            sentence(layout, context, problem, icon="ERROR")
        if owner.library is not None:
            sentence(
                layout,
                context,
                "This object is linked from a library and cannot be changed.",
                icon="LIBRARY_DATA_DIRECT",
            )


class IFSMORPH_PT_report(SidebarPanel, bpy.types.Panel):
    """What was found about the path."""

    bl_label = "Report"
    bl_parent_id = "IFSMORPH_PT_main"

    @classmethod
    def poll(cls, context):
        """There is one once a path was keyed or checked."""
        return super().poll(context) and bool(context.object.ifs_morph.path.report)

    def draw(self, context):
        """Draw the report, and whether it is out of date."""
        layout = self.layout
        owner = context.object
        path = owner.ifs_morph.path
        current = path.inputs == path_fingerprint(owner.ifs_morph)
        if not current or not fcurves.has_path(owner):
            sentence(layout, context, "The report is out of date: the morph has changed since.", icon="INFO")
        box = layout.box()
        box.active = current
        for line in path.report.splitlines():
            sentence(box, context, line)


class _ShapePanel(SidebarPanel):
    bl_parent_id = "IFSMORPH_PT_main"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        """Draw the library, the list of maps, and the active map."""
        layout = self.layout
        shape = getattr(context.object.ifs_morph, self.shape)
        end = self.shape.upper()
        row = layout.row(align=True)
        row.menu(f"IFSMORPH_MT_library_{self.shape}", text=_title(shape.name) or "Library", icon="ASSET_MANAGER")
        draw_file_buttons(row, end)

        row = layout.row()
        row.template_list("IFSMORPH_UL_maps", self.shape, shape, "maps", shape, "active_index", rows=5)
        column = row.column(align=True)
        column.operator("ifs_morph.map_add", text="", icon="ADD").end = end
        column.operator("ifs_morph.map_remove", text="", icon="REMOVE").end = end
        column.separator()
        column.operator("ifs_morph.map_duplicate", text="", icon="DUPLICATE").end = end
        column.separator()
        for direction, icon in (("UP", "TRIA_UP"), ("DOWN", "TRIA_DOWN")):
            button = column.operator("ifs_morph.map_move", text="", icon=icon)
            button.end, button.direction = end, direction

        if 0 <= shape.active_index < len(shape.maps):
            draw = self.draw_map_in_space if shape.in_space else self.draw_map
            draw(layout, shape.maps[shape.active_index])

    def draw_map_in_space(self, layout, item):
        """Draw the active map of a shape in space as a matrix."""
        column = layout.column()
        column.use_property_split = True
        column.use_property_decorate = False
        column.prop(item, "weight")
        column.prop(item, "opacity")
        layout.label(text="Matrix:")
        draw_matrix(layout, item, "matrix_in_space", 4)

    def draw_map(self, layout, item):
        """Draw the active map as turn, stretch and shear, and as a matrix."""
        column = layout.column()
        column.use_property_split = True
        column.use_property_decorate = False
        column.prop(item, "translation")
        column.prop(item, "rotation")
        column.prop(item, "scale")
        column.prop(item, "shear")
        column.prop(item, "weight")
        column.prop(item, "opacity")
        layout.label(text="Matrix:")
        draw_matrix(layout, item, "matrix", 3)


def draw_matrix(layout, item, name, columns):
    """Draw the numbers of a map's matrix, which has one row less than columns."""
    grid = layout.column(align=True)
    for first in range(0, columns * (columns - 1), columns):
        row = grid.row(align=True)
        for index in range(first, first + columns):
            row.prop(item, name, index=index, text="")


class IFSMORPH_PT_initial(_ShapePanel, bpy.types.Panel):
    """The initial shape."""

    bl_label = "Initial Shape"
    shape = "initial"


class IFSMORPH_PT_final(_ShapePanel, bpy.types.Panel):
    """The final shape."""

    bl_label = "Final Shape"
    shape = "final"


class _TransitionsPanel(SidebarPanel):
    bl_label = "Transitions"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context):
        """Draw the switch."""
        self.layout.prop(getattr(context.object.ifs_morph, self.shape), "recurrent", text="")

    def draw(self, context):
        """Draw a row for each map, or that of the active map where there is no room for all."""
        layout = self.layout
        shape = getattr(context.object.ifs_morph, self.shape)
        layout.active = shape.recurrent
        count = len(shape.maps)
        if count > MOST_RECURRENT:
            sentence(layout, context, f"A recurrent shape has {MOST_RECURRENT} maps at most.", icon="INFO")
        elif count <= MOST_IN_GRID:
            sentence(layout, context, "Row: the map applied. Column: how often each is applied next.")
            grid = layout.column(align=True)
            for item in shape.maps:
                row = grid.row(align=True)
                for k in range(count):
                    row.prop(item, "transitions", index=k, text="")
        elif 0 <= shape.active_index < count:
            item = shape.maps[shape.active_index]
            sentence(layout, context, f"How often each map is applied next after {item.name}.")
            column = layout.column(align=True)
            column.use_property_split = True
            column.use_property_decorate = False
            for k, following in enumerate(shape.maps):
                column.prop(item, "transitions", index=k, text=following.name)


class IFSMORPH_PT_initial_transitions(_TransitionsPanel, bpy.types.Panel):
    """Which map of the initial shape may be applied after which."""

    bl_parent_id = "IFSMORPH_PT_initial"
    shape = "initial"


class IFSMORPH_PT_final_transitions(_TransitionsPanel, bpy.types.Panel):
    """Which map of the final shape may be applied after which."""

    bl_parent_id = "IFSMORPH_PT_final"
    shape = "final"


class IFSMORPH_PT_edit_maps(SidebarPanel, bpy.types.Panel):
    """The maps as triangles in the viewport."""

    bl_label = "Edit Maps in Viewport"
    bl_parent_id = "IFSMORPH_PT_main"

    def draw_header(self, context):
        """Draw the switch."""
        self.layout.prop(context.object.ifs_morph, "edit_maps", text="")

    def draw(self, context):
        """Draw which shape is edited, and how."""
        layout = self.layout
        settings = context.object.ifs_morph
        layout.active = settings.edit_maps
        layout.row().prop(settings, "edited_end", expand=True)
        if settings.edit_maps:
            text = "Drag a corner to change a map, its middle to move it. Ctrl snaps, Shift is precise."
            sentence(layout, context, text)


class IFSMORPH_PT_winding(SidebarPanel, bpy.types.Panel):
    """How often the maps turn on the way."""

    bl_label = "Winding"
    bl_parent_id = "IFSMORPH_PT_main"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        """Pairs have windings of their own."""
        return super().poll(context) and not has_pairs(context.object.ifs_morph)

    def draw(self, context):
        """Draw each map's winding."""
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        settings = context.object.ifs_morph
        column = layout.column(align=True)
        column.active = settings.scheme != "ELEMENTWISE"
        for item in settings.final.maps:
            column.prop(item, "winding", text=item.name)


class IFSMORPH_PT_locus(SidebarPanel, bpy.types.Panel):
    """The connectedness locus."""

    bl_label = "Connectedness Locus"
    bl_parent_id = "IFSMORPH_PT_main"

    def draw(self, context):
        """Draw the settings, the buttons, and the picture."""
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        settings = context.object.ifs_morph
        locus = settings.locus
        layout.prop(locus, "resolution")
        layout.prop(settings, "gap_resolution")
        column = layout.column(align=True)
        column.prop(locus, "domain", index=0, text="Domain From")
        column.prop(locus, "domain", index=1, text="To")
        layout.prop(locus, "live")
        layout.operator("ifs_morph.compute_locus", icon="IMAGE_DATA")
        if locus.image is not None:
            layout.operator("ifs_morph.show_locus", icon="WINDOW")
        draw_locus_state(layout, context)


def draw_locus_state(layout, context) -> None:
    """Say if the picture of the locus is a preview, or one of the morph as it was."""
    owner = context.object
    locus = owner.ifs_morph.locus
    if locus.image is None or locus_picture.is_current(owner.ifs_morph):
        return
    if not live.shows_preview(owner):
        text = "The locus is out of date: the morph has changed since."
    elif locus.resolution > live.MOST_NODES:
        text = "This is a preview. Compute the locus for the full resolution."
    else:
        text = "This is a preview; the full locus follows."
    sentence(layout, context, text, icon="INFO")


class IFSMORPH_PT_output(SidebarPanel, bpy.types.Panel):
    """What the attractor becomes."""

    bl_label = "Output"
    bl_parent_id = "IFSMORPH_PT_main"

    def draw_header_preset(self, context):
        """Draw the menu of presets."""
        IFSMORPH_PT_output_presets.draw_panel_header(self.layout)

    def draw(self, context):
        """Draw what the kind of the object needs."""
        layout = self.layout
        layout.use_property_split = True
        settings = context.object.ifs_morph
        if settings.kind == "IMAGE":
            self.draw_image(layout, settings.output)
        else:
            self.draw_points(layout, settings.output)
            layout.prop(settings, "flip")
        layout.operator("ifs_morph.repair_output", icon="FILE_REFRESH")

    def draw_image(self, layout, output):
        """Draw what an image needs."""
        layout.prop(output, "mode")
        column = layout.column(align=True)
        column.prop(output, "resolution", index=0, text="Resolution X")
        column.prop(output, "resolution", index=1, text="Y")
        layout.prop(output, "antialiasing")
        if output.mode == "SET":
            layout.prop(output, "color")
        if output.mode == "DENSITY":
            layout.prop(output, "curve")
            layout.prop(output, "exposure")
            if output.curve == "GAMMA":
                layout.prop(output, "gamma")
            if output.ramp is not None:
                layout.template_color_ramp(output.ramp, "color_ramp", expand=True)
        layout.prop(output, "background")

    def draw_points(self, layout, output):
        """Draw what points need."""
        layout.prop(output, "point_count")
        layout.prop(output, "point_radius")
        layout.prop(output, "point_color")
        if output.point_color == "SINGLE":
            layout.prop(output, "color")


class IFSMORPH_PT_window(SidebarPanel, bpy.types.Panel):
    """The part of the plane that the image shows."""

    bl_label = "Fit Window"
    bl_parent_id = "IFSMORPH_PT_output"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        """Only images have a window."""
        return super().poll(context) and context.object.ifs_morph.kind == "IMAGE"

    def draw_header(self, context):
        """Draw the switch."""
        self.layout.prop(context.object.ifs_morph.output, "fit_window", text="")

    def draw(self, context):
        """Draw the window's sides."""
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        output = context.object.ifs_morph.output
        column = layout.column(align=True)
        column.active = not output.fit_window
        for index, text in ((0, "Left"), (1, "Bottom"), (2, "Right"), (3, "Top")):
            column.prop(output, "window", index=index, text=text)


def _title(name: str) -> str:
    return name[:1].upper() + name[1:]


CLASSES = (
    IFSMORPH_PT_main,
    IFSMORPH_PT_report,
    IFSMORPH_PT_initial,
    IFSMORPH_PT_final,
    IFSMORPH_PT_initial_transitions,
    IFSMORPH_PT_final_transitions,
    IFSMORPH_PT_edit_maps,
    IFSMORPH_PT_pairs,
    IFSMORPH_PT_winding,
    IFSMORPH_PT_locus,
    IFSMORPH_PT_path,
    IFSMORPH_PT_offsets,
    IFSMORPH_PT_output,
    IFSMORPH_PT_window,
)

register, unregister = bpy.utils.register_classes_factory(CLASSES)

"""Add a morph object that can be seen and rendered at once."""

import math

import bpy

from ...core.shapes import SHAPES
from .. import outputs
from ..conversion import fit_window, write_shape

DEFAULT_MORPH = ("turned gasket", "gasket")

CAMERA_MARGIN = 1.15


class IFSMORPH_OT_add(bpy.types.Operator):
    """Add an object that shows one fractal becoming another"""

    bl_idname = "object.ifs_morph_add"
    bl_label = "Add IFS Morph"
    bl_options = {"REGISTER", "UNDO"}

    kind: bpy.props.EnumProperty(
        name="Kind",
        description="What shows the fractal",
        items=(
            ("IMAGE", "Image Plane", "A plane with the fractal as its texture"),
            ("POINTS", "Point Cloud", "A cloud of points of the fractal"),
        ),
    )
    size: bpy.props.FloatProperty(
        name="Size", description="Larger side of the fractal", subtype="DISTANCE", default=2.0, min=0.001
    )
    add_camera: bpy.props.BoolProperty(
        name="Add Camera", description="Add a camera that frames the object if the scene has none", default=True
    )
    add_light: bpy.props.BoolProperty(
        name="Add Light", description="Add a sun if points would be dark without", default=True
    )

    @classmethod
    def poll(cls, context):
        """Need object mode and a collection that may be changed."""
        if context.mode != "OBJECT":
            cls.poll_message_set("Switch to Object Mode first")
            return False
        if context.scene.library is not None or context.collection.library is not None:
            cls.poll_message_set("The active collection is linked from a library; choose another one")
            return False
        return True

    def execute(self, context):
        """Add the object, and a camera and a light where they are missing."""
        name = f"IFS Morph {bpy.types.UILayout.enum_item_name(self, 'kind', self.kind)}"
        output = outputs.KINDS[self.kind]
        owner = bpy.data.objects.new(name, output.add_mesh(name))
        settings = owner.ifs_morph
        settings.kind = self.kind
        for shape, source in zip((settings.initial, settings.final), DEFAULT_MORPH, strict=True):
            write_shape(shape, SHAPES[source])
        settings.path.frame_start, settings.path.frame_end = context.scene.frame_start, context.scene.frame_end
        fit_window(owner)
        # The plane of the fractal stands upright and faces the front.
        owner.rotation_euler.x = math.pi / 2
        owner.scale = (self.size,) * 3
        owner.location = context.scene.cursor.location
        context.collection.objects.link(owner)
        output.ensure(owner)
        for other in context.selected_objects:
            other.select_set(False)
        owner.select_set(True)
        context.view_layer.objects.active = owner
        # While Blender renders in the window, the viewport must not evaluate another frame into the same image.
        context.scene.render.use_lock_interface = True
        if self.add_camera and context.scene.camera is None:
            self._frame(context, owner)
        if self.add_light and self.kind == "POINTS" and not _is_lit(context.scene):
            _light(context)
        if self.kind == "IMAGE":
            _show_textures(context.space_data)
        return {"FINISHED"}

    def _frame(self, context, owner):
        """Add a camera in front of the fractal."""
        camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
        render = context.scene.render
        width = render.resolution_x * render.pixel_aspect_x
        height = render.resolution_y * render.pixel_aspect_y
        # A camera's angle spans the longer side of the picture.
        reach = CAMERA_MARGIN * self.size / 2 * max(width, height) / min(width, height)
        distance = reach / math.tan(camera.data.angle / 2)
        place = context.scene.cursor.location
        camera.location = place.x, place.y - distance, place.z
        camera.rotation_euler = math.pi / 2, 0.0, 0.0
        context.collection.objects.link(camera)
        context.scene.camera = camera


def _show_textures(space):
    """Have a solid viewport show textures: an image plane would be plain gray."""
    if space is not None and space.type == "VIEW_3D" and space.shading.type == "SOLID":
        space.shading.color_type = "TEXTURE"


def _is_lit(scene):
    return any(other.type == "LIGHT" for other in scene.objects)


def _light(context):
    sun = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
    sun.data.energy = 3.0
    sun.location = context.scene.cursor.location
    sun.location.y -= 3.0
    sun.rotation_euler = math.radians(60), 0.0, math.radians(-20)
    context.collection.objects.link(sun)


register, unregister = bpy.utils.register_classes_factory((IFSMORPH_OT_add,))

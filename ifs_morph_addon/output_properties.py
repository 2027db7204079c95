"""What is stored on an object about its output: how the attractor is shown, and the data that it is shown by."""

import bpy
from bpy.props import (
    BoolProperty,
    EnumProperty,
    FloatProperty,
    FloatVectorProperty,
    IntProperty,
    IntVectorProperty,
    PointerProperty,
)

from .property_options import LEAF, STILL, redraw, refit


class IFSMorphOutputSettings(bpy.types.PropertyGroup):
    """How the attractor becomes an image or a point cloud, and the data that it becomes."""

    mode: EnumProperty(
        name="Mode",
        description="What the picture shows",
        items=(
            ("SET", "Set", "The attractor in one color"),
            ("DENSITY", "Density", "How densely the points of the attractor lie, through a color ramp"),
            ("ATTRACTORLET", "Attractorlets", "Each attractorlet in the color of its map"),
        ),
        default="ATTRACTORLET",
        options=STILL,
        override=LEAF,
        update=redraw,
    )
    resolution: IntVectorProperty(
        name="Resolution",
        description="Width and height of the image in pixels",
        size=2,
        subtype="XYZ",
        default=(1024, 1024),
        min=8,
        max=16384,
        soft_max=4096,
        options=STILL,
        override=LEAF,
        update=refit,
    )
    antialiasing: IntProperty(
        name="Antialiasing",
        description="Samples along each side of a pixel",
        default=2,
        min=1,
        max=4,
        options=STILL,
        override=LEAF,
        update=redraw,
    )
    color: FloatVectorProperty(
        name="Color",
        description="Color of the attractor",
        subtype="COLOR",
        size=4,
        min=0.0,
        max=1.0,
        default=(0.9, 0.9, 0.9, 1.0),
        override=LEAF,
        update=redraw,
    )
    background: FloatVectorProperty(
        name="Background",
        description="Color where there is no attractor; transparent at alpha zero",
        subtype="COLOR",
        size=4,
        min=0.0,
        max=1.0,
        default=(0.0, 0.0, 0.0, 0.0),
        override=LEAF,
        update=redraw,
    )
    curve: EnumProperty(
        name="Curve",
        description="How density becomes brightness",
        items=(
            ("LOG", "Logarithm", "Show dense and thin parts alike"),
            ("GAMMA", "Gamma", "Brightness is a power of the density"),
            ("LINEAR", "Linear", "Brightness is the density"),
        ),
        default="LOG",
        options=STILL,
        override=LEAF,
        update=redraw,
    )
    exposure: FloatProperty(
        name="Exposure",
        description="Brightness of the density, in stops",
        default=0.0,
        min=-50.0,
        max=50.0,
        soft_min=-10.0,
        soft_max=10.0,
        override=LEAF,
        update=redraw,
    )
    gamma: FloatProperty(
        name="Gamma",
        description="Lifts thin parts above 1 and darkens them below",
        default=2.2,
        min=0.05,
        soft_max=5.0,
        override=LEAF,
        update=redraw,
    )
    ramp: PointerProperty(
        type=bpy.types.Texture,
        name="Color Ramp",
        description="Texture that holds the color ramp from thin to dense",
        options=STILL,
        override=LEAF,
        update=redraw,
    )
    fit_window: BoolProperty(
        name="Fit Window",
        description="Choose the window so that every shape of the morph fits in it",
        default=True,
        options=STILL,
        override=LEAF,
        update=refit,
    )
    window: FloatVectorProperty(
        name="Window",
        description="Least x, least y, largest x and largest y of the part of the plane that the image shows",
        size=4,
        default=(-0.1, -0.1, 1.1, 1.1),
        min=-1e9,
        max=1e9,
        precision=3,
        options=STILL,
        override=LEAF,
        update=redraw,
    )
    depth: FloatVectorProperty(
        name="Depth",
        description="Least and largest z of the points of a shape in space; zero twice for shapes of the plane",
        size=2,
        default=(0.0, 0.0),
        min=-1e9,
        max=1e9,
        precision=3,
        options=STILL,
        override=LEAF,
        update=redraw,
    )
    point_count: IntProperty(
        name="Points",
        description="Number of points of the attractor",
        default=100_000,
        min=1,
        soft_max=2_000_000,
        max=50_000_000,
        options=STILL,
        override=LEAF,
        update=redraw,
    )
    point_radius: FloatProperty(
        name="Radius",
        description="Radius of the points, as a multiple of the size that just covers the attractor",
        default=1.0,
        min=0.0,
        soft_max=10.0,
        override=LEAF,
        update=redraw,
    )
    point_color: EnumProperty(
        name="Color By",
        description="What the color of a point shows",
        items=(
            ("ATTRACTORLET", "Attractorlet", "The color of the map whose attractorlet the point belongs to"),
            ("SINGLE", "Single Color", "One color for all points"),
        ),
        default="ATTRACTORLET",
        options=STILL,
        override=LEAF,
        update=redraw,
    )
    image: PointerProperty(
        type=bpy.types.Image,
        name="Image",
        description="The image that the attractor is rendered into",
        options=STILL,
        override=LEAF,
    )
    spare_image: PointerProperty(
        type=bpy.types.Image,
        name="Spare Image",
        description="Takes turns with the image where Blender would not notice a change of its pixels",
        options={"HIDDEN"},
        override=LEAF,
    )
    nodes: PointerProperty(
        type=bpy.types.NodeTree,
        name="Node Group",
        description="The geometry nodes that turn vertices into points",
        options=STILL,
        override=LEAF,
    )
    material: PointerProperty(
        type=bpy.types.Material,
        name="Material",
        description="The material that shows the output",
        options=STILL,
        override=LEAF,
    )
